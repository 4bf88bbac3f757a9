//! View sets: directions, presets, sizes, names.

use super::*;

#[test]
fn the_directions_are_those_of_the_published_polyhedra() {
    let dodecahedron = named_sets::dodecahedron();
    assert_eq!(dodecahedron.len(), 20);
    for (i, v) in [
        (0, [-1.0, -1.0, -1.0]),
        (4, [1.0, -1.0, -1.0]),
        (8, [0.0, -0.618_033_988_749_894_9, -1.618_033_988_749_895]),
        (13, [-0.618_033_988_749_894_9, 1.618_033_988_749_895, 0.0]),
        (18, [1.618_033_988_749_895, 0.0, -0.618_033_988_749_894_9]),
    ] {
        let expected = DVec3::from_array(v) / sqrt(3.0);
        assert!(
            (dodecahedron[i] - expected).length() < 1e-15,
            "{i}: {}",
            dodecahedron[i]
        );
    }
    let evaluation = named_sets::rhombicuboctahedron();
    assert_eq!(evaluation.len(), 24);
    for (i, v) in [
        (0, [-2.414_213_562_373_095, -1.0, -1.0]),
        (9, [-1.0, -2.414_213_562_373_095, 1.0]),
        (22, [1.0, 1.0, -2.414_213_562_373_095]),
    ] {
        let expected = DVec3::from_array(v).normalize();
        assert!(
            (evaluation[i] - expected).length() < 1e-15,
            "{i}: {}",
            evaluation[i]
        );
    }
    // Every vertex of a regular dodecahedron has three neighbours at cos = sqrt 5 / 3; of the other solid, four.
    for (set, cosine, neighbours) in [
        (dodecahedron, sqrt(5.0) / 3.0, 3),
        (
            evaluation,
            1.0 - 2.0 / (2.414_213_562_373_095_f64 * 2.414_213_562_373_095 + 2.0),
            4,
        ),
    ] {
        for a in &set {
            let near = set.iter().filter(|b| (a.dot(**b) - cosine).abs() < 1e-12);
            assert_eq!(near.count(), neighbours, "{a}");
        }
    }
}

#[test]
fn the_subdivided_octahedron_has_the_published_counts_and_sums() {
    for (k, n, z, diagonal) in [
        (0, 6, 1.0, 1.732_050_807_568_877_2),
        (1, 18, 3.828_427_124_746_19, 4.181_540_550_352_055_5),
        (2, 66, 15.586_651_631_673_504, 16.239_219_961_374_562),
        (3, 258, 62.738_578_679_618_93, 64.616_999_976_080_75),
        (4, 1026, 251.376_471_066_484, 258.164_488_950_067_2),
        (5, 4098, f64::NAN, f64::NAN),
    ] {
        let set = named_sets::octahedron(k);
        assert_eq!(set.len(), n);
        assert!(set.iter().all(|d| (d.length() - 1.0).abs() < 1e-15));
        let sum = |axis: DVec3| set.iter().map(|d| d.dot(axis).max(0.0)).sum::<f64>();
        if n < 4098 {
            assert!((sum(DVec3::Z) - z).abs() < 1e-9 * z, "{k}");
            assert!(
                (sum(DVec3::ONE.normalize()) - diagonal).abs() < 1e-9 * diagonal,
                "{k}"
            );
            assert_eq!(
                named_sets::octahedron(k + 1)[..n],
                set,
                "a refinement keeps its prefix"
            );
        }
        let (_, faces) = named_sets::octahedron_faces(k);
        assert_eq!(faces.len(), 8 << (2 * k));
        let outward = |f: &[u32; 3]| {
            let [a, b, c] = f.map(|v| set[v as usize]);
            (b - a).cross(c - a).dot(a) > 0.0
        };
        assert!(faces.iter().all(outward));
    }
}

#[test]
fn spirals_cover_the_sphere_evenly_with_any_number_of_views() {
    for n in [1, 2, 7, 24, 42, 100, 501] {
        let set = named_sets::spiral(n);
        assert_eq!(set.len(), n as usize);
        assert!(set.iter().all(|d| (d.length() - 1.0).abs() < 1e-15), "{n}");
        if n < 20 {
            continue;
        }
        // Every point of the sphere has a direction nearby: no farther than twice the radius of a fair share.
        let share = 2.0 / sqrt(f64::from(n));
        for probe in named_sets::octahedron(3) {
            let nearest = set.iter().map(|d| (*d - probe).length());
            let nearest = nearest.fold(f64::INFINITY, f64::min);
            assert!(nearest < 1.5 * share, "{n}: {probe} is {nearest} away");
        }
        let closest = set.iter().enumerate().flat_map(|(i, a)| {
            let rest = set[i + 1..].iter();
            rest.map(move |b| (*a - *b).length())
        });
        let closest = closest.fold(f64::INFINITY, f64::min);
        assert!(closest > 0.8 * share, "{n}: {closest}");
    }
}

#[test]
fn turned_directions_keep_their_angles_and_never_come_back() {
    let set = named_sets::spiral(12);
    assert_eq!(named_sets::turned(&set, 0), set);
    let rounds: Vec<_> = (0..40).map(|r| named_sets::turned(&set, r)).collect();
    for (r, turned) in rounds.iter().enumerate() {
        for i in 0..set.len() {
            for j in 0..set.len() {
                assert!((turned[i].dot(turned[j]) - set[i].dot(set[j])).abs() < 1e-14);
            }
            let hand = |s: &[DVec3]| s[i].cross(s[(i + 1) % 12]).dot(s[(i + 2) % 12]);
            assert!((hand(turned) - hand(&set)).abs() < 1e-14, "no mirror image");
        }
        for earlier in &rounds[..r] {
            assert!(
                (turned[0] - earlier[0]).length() > 1e-3
                    || (turned[5] - earlier[5]).length() > 1e-3
            );
        }
    }
}

#[test]
fn presets_are_those_of_the_paper() {
    let s = unit_sphere();
    let costs = ViewSet::costs(&s).expect("views");
    assert_eq!(
        (costs.width, costs.height, costs.samples, costs.background),
        (256, 256, 1, 128)
    );
    assert_eq!(
        (costs.views.len(), costs.subpixel),
        (20, SubpixelBits::Eight)
    );
    let evaluation = ViewSet::evaluation(&s).expect("views");
    assert_eq!(
        (evaluation.width, evaluation.height, evaluation.samples),
        (512, 512, 2)
    );
    assert_eq!(evaluation.views.len(), 24);
    for view in costs.views.iter().chain(&evaluation.views) {
        let Eye::Point(eye) = view.eye else {
            panic!("perspective")
        };
        assert!((eye.length() - 2.0).abs() < 1e-15);
        assert_eq!(
            (view.near, view.far, view.cull, view.light),
            (1.0, 3.0, Cull::None, Light::Headlight)
        );
    }
}

#[test]
fn interior_views_are_spread_evenly() {
    let fronts = |k| {
        let set = ViewSet::costs(&unit_sphere())
            .expect("views")
            .with_interior_views(k)
            .expect("at most 20");
        let culled = set
            .views
            .iter()
            .enumerate()
            .filter(|(_, v)| v.cull == Cull::Front);
        culled.map(|(i, _)| i).collect::<Vec<_>>()
    };
    assert_eq!(fronts(0), [0_usize; 0]);
    assert_eq!(fronts(4), [4, 9, 14, 19]);
    assert_eq!(fronts(20), (0..20).collect::<Vec<_>>());
    for k in 0..=20 {
        assert_eq!(fronts(k).len(), k);
    }
    let refused = ViewSet::costs(&unit_sphere())
        .expect("views")
        .with_interior_views(21);
    assert!(matches!(refused, Err(Error::Usage(_))));
}

#[test]
fn images_without_pixels_or_beyond_the_bits_of_the_rasterizer_are_refused() {
    let s = unit_sphere();
    for (width, height, samples, fine) in [
        (0, 1, 1, false),
        (1, 0, 1, false),
        (4096, 4096, 1, true),
        (4097, 1, 1, false),
        (2048, 1, 2, true),
        (1, 2049, 2, false),
        (1024, 1024, 4, true),
        (1025, 1, 4, false),
        (8, 8, 3, false),
        (8, 8, 0, false),
        (u32::MAX, u32::MAX, 4, false),
    ] {
        let set = ViewSet::around(&s, &[DVec3::X], width, height, Projection::Perspective)
            .and_then(|set| set.with_samples(samples));
        assert_eq!(set.is_ok(), fine, "{width} x {height} x {samples}");
    }
    let none = ViewSet::around(&s, &[], 8, 8, Projection::Perspective);
    assert!(matches!(none, Err(Error::Usage(_))));
}

#[test]
fn names_of_view_sets_read_back_as_written() {
    for text in [
        "dodecahedron",
        "rhombicuboctahedron",
        "octahedron:0",
        "octahedron:5",
        "spiral:1",
        "spiral:4098",
        "a/b.json",
    ] {
        let name: ViewsName = text.parse().expect(text);
        assert_eq!(name.to_string(), text);
    }
    assert_eq!(
        "views.json".parse::<ViewsName>().ok(),
        Some(ViewsName::File("views.json".into()))
    );
    for text in [
        "",
        "cube",
        "octahedron",
        "octahedron:",
        "octahedron:6",
        "octahedron:-1",
        "Dodecahedron",
        "spiral:0",
        "spiral:4099",
        "spiral:x",
    ] {
        assert!(
            matches!(text.parse::<ViewsName>(), Err(Error::Usage(_))),
            "{text}"
        );
    }
    let set = resolve(
        &ViewsName::Octahedron(2),
        &unit_sphere(),
        [480, 480],
        Projection::Orthographic,
    );
    assert_eq!(set.map(|s| s.views.len()).ok(), Some(66));
}
