//! The JSON view file: exact round trips and hostile input.

use lodmark::view::file;

use super::*;

proptest! {
    #![proptest_config(crate::support::cases(256))]

    #[test]
    fn a_view_file_gives_back_every_bit(
        numbers in prop::collection::vec(-1e3..1e3, 23), exponent in -200_i32..200,
        size in [1_u32..1025, 1_u32..1025], samples in prop::sample::select(vec![1_u32, 2, 4]),
        (cull, light, specular) in (0_usize..3, 0_usize..3, any::<bool>()), background in any::<u8>(),
    ) {
        let n = |i: usize| Frame { exponent }.leave_length(numbers[i], 1);
        let v = |i: usize| DVec3::new(n(i), n(i + 1), n(i + 2));
        let mut matrix = [[0.0; 4]; 4];
        for (i, x) in matrix.iter_mut().flatten().enumerate() {
            *x = n(i);
        }
        matrix[0][0] = -0.0;
        let view = View {
            matrix,
            eye: if cull == 0 { Eye::Axis(DVec3::new(0.6, -0.0, 0.8)) } else { Eye::Point(v(16)) },
            near: n(22).abs().max(1e-300),
            far: n(22).abs() * 3.1 + 1.0,
            cull: [Cull::None, Cull::Back, Cull::Front][cull],
            shading: Shading {
                interpolation: [Interpolation::Gouraud, Interpolation::Lit][usize::from(background % 2)],
                two_sided: specular,
                specular: specular.then_some(Specular { strength: 0.1 + 0.2, exponent: 20 }),
            },
            light: [Light::Headlight, Light::Point(v(19)), Light::Direction(DVec3::Z)][light],
        };
        let set = ViewSet {
            width: size[0], height: size[1], samples, subpixel: SubpixelBits::Sixteen, background, views: vec![view; 2],
        };
        let text = file::to_json(&set, &[]).expect("finite");
        let read = file::from_json(&text, "-").expect("our own file");
        prop_assert_eq!(&read, &set);
        prop_assert!(read.views[0].matrix[0][0].is_sign_negative(), "-0 is kept");
        prop_assert_eq!(file::to_json(&file::from_json(&text, "-").expect("again"), &[]).expect("finite"), text);
    }

    #[test]
    fn a_damaged_view_file_never_panics(at in any::<prop::sample::Index>(), byte in any::<u8>(), cut in any::<bool>()) {
        let mut text = file::to_json(&two_views(), &[]).expect("finite").into_bytes();
        let at = at.index(text.len());
        if cut { text.truncate(at) } else { text[at] = byte }
        let _ = file::from_json(&String::from_utf8_lossy(&text), "-");
    }
}

fn two_views() -> ViewSet {
    let mut set = ViewSet::costs(&unit_sphere()).expect("views");
    set.views.truncate(2);
    set
}

#[test]
fn the_example_of_a_view_file_is_read_and_an_error_shows_it() {
    let size = [256, 256];
    let set = file::from_json(file::EXAMPLE, "-").expect("a whole file");
    let view = View::orthographic(&unit_sphere(), DVec3::Z, DVec3::Y, size).expect("a view");
    assert_eq!((set.views, [set.width, set.height]), (vec![view], size));
    let refused = file::from_json("{}", "views.json").expect_err("no view file");
    assert!(refused.to_string().contains(file::EXAMPLE), "{refused}");
}

#[test]
fn a_view_file_is_read_from_where_it_was_written() {
    let folder = crate::support::folder();
    let path = folder.path().join("views.json");
    let set = ViewSet::evaluation(&unit_sphere()).expect("views");
    let hash = file::ImageHashes::from([("luma".to_owned(), "00ff".to_owned())]);
    let text = file::to_json(&set, &vec![hash; 24]).expect("finite");
    std::fs::write(&path, text).expect("written");
    let name: ViewsName = path.to_string_lossy().parse().expect("a file");
    let read = resolve(&name, &unit_sphere(), [1, 1], Projection::Perspective).expect("our own");
    assert_eq!(read, set);
    let missing = file::read(folder.path().join("none.json"));
    assert!(matches!(missing, Err(Error::Io { .. })));
}

#[test]
fn a_hostile_view_file_is_refused_with_what_and_where() {
    let good = file::to_json(&two_views(), &[]).expect("finite");
    let one = format!("{:016x}", two_views().views[0].matrix[0][0].to_bits());
    for (from, to, message) in [
        ("\"schema\": 1", "\"schema\": 2", "schema 2"),
        ("\"schema\": 1,", "", "missing field `schema`"),
        ("\"width\": 256,", "", "missing field `width`"),
        ("\"width\": 256", "\"width\": 0", "0 x 256"),
        (
            "\"width\": 256",
            "\"width\": 1000000000",
            "1000000000 x 256",
        ),
        ("\"width\": 256", "\"width\": -1", "line 3"),
        (
            "\"width\": 256",
            "\"width\": 256, \"depht\": 1",
            "unknown field `depht`",
        ),
        (
            "\"two_sided\": true",
            "\"two_sided\": true, \"x\": 1",
            "unknown field `x`",
        ),
        ("\"samples\": 1", "\"samples\": 3", "3 samples"),
        ("\"subpixel_bits\": 8", "\"subpixel_bits\": 9", "8 or 16"),
        ("\"down\"", "\"up\"", "y_direction is `up`"),
        ("0 near, 1 far", "reversed", "depth is `reversed`"),
        ("\"background\": 128", "\"background\": 256", "line"),
        ("\"near\": 1.0", "\"near\": 5.0", "view 0: near 5"),
        ("\"near\": 1.0", "\"near\": -1.0", "view 0: near -1"),
        (
            "\"cull\": \"none\"",
            "\"cull\": \"some\"",
            "unknown variant `some`",
        ),
        (&one, "7ff8000000000000", "view 0: matrix entry 0 is NaN"),
        (&one, "7ff0000000000000", "view 0: matrix entry 0 is inf"),
        (&one, "+ff0000000000000", "view 0: matrix entry 0 is `+ff"),
        (&one, "xyz", "16 hexadecimal digits"),
        (&one, "3fd0000000000000", "view 0: matrix_f32"),
        ("\"point\": [", "\"axis\": [", "view 0: eye.axis has length"),
        (
            "\"headlight\"",
            "{\"direction\": [0, 0, 2]}",
            "view 0: light.direction",
        ),
        (
            "\"flat\",",
            "\"flat\", \"specular\": {\"strength\": 2, \"exponent\": 1},",
            "strength 2",
        ),
    ] {
        let bad = good.replacen(from, to, 1);
        assert_ne!(bad, good, "{from} is in the file");
        let refused = file::from_json(&bad, "views.json").expect_err(message);
        assert!(matches!(refused, Error::Input { .. }));
        let text = refused.to_string();
        assert!(
            text.starts_with("views.json: ") && text.contains(message),
            "{text}"
        );
    }
    let mut none = two_views();
    none.views.clear();
    let refused = file::from_json(&file::to_json(&none, &[]).expect("finite"), "-");
    assert!(
        refused
            .expect_err("no views")
            .to_string()
            .contains("no views")
    );
    for text in [
        "",
        "[]",
        "{}",
        "null",
        "{\"schema\": 1e99}",
        &"[".repeat(100_000),
    ] {
        assert!(matches!(
            file::from_json(text, "-"),
            Err(Error::Input { .. })
        ));
    }
}

#[test]
fn a_view_that_is_not_finite_is_not_written() {
    let mut set = two_views();
    set.views[1].near = f64::NAN;
    assert!(matches!(file::to_json(&set, &[]), Err(Error::Internal(_))));
}
