//! Image metrics: squared luma error, image differences, silhouette histograms.
#![expect(
    clippy::float_cmp,
    clippy::disallowed_methods,
    reason = "closed forms are met exactly, and are computed without the crate's own functions"
)]

use glam::DVec3;
use lodmark::{
    Silent,
    mesh::{Edges, Mesh},
    metric::{
        difference::{ImageComparison, compare, red_picture, signed_picture},
        luma::{SquaredError, ViewErrors, squared_error},
        silhouette::silhouette_histogram,
    },
    raster::Grid,
    view::Eye,
};
use proptest::prelude::*;

fn plane<T: Copy>(width: u32, values: &[T]) -> Grid<T> {
    Grid::new(width, values.len() as u32 / width, values.to_vec()).expect("whole rows")
}

/// Two images of one size.
fn pair() -> impl Strategy<Value = (Grid<u16>, Grid<u16>)> {
    (1_u32..9, 1_u32..9).prop_flat_map(|(width, height)| {
        let image = move || {
            prop::collection::vec(0_u16..=4 * 255, (width * height) as usize)
                .prop_map(move |v| plane(width, &v))
        };
        (image(), image())
    })
}

proptest! {
    #![proptest_config(crate::support::cases(256))]

    #[test]
    fn the_squared_error_is_the_sum_of_squares_pixel_by_pixel((a, b) in pair()) {
        let error = squared_error(&a, &b, 4).expect("same size");
        let mut sum = 0_i128;
        for y in 0..a.height() {
            for x in 0..a.width() {
                let d = i128::from(a.at(x, y)) - i128::from(b.at(x, y));
                sum += d * d;
            }
        }
        prop_assert_eq!(i128::from(error.sum), sum);
        prop_assert_eq!(error.pixels, u64::from(a.width() * a.height()));
        prop_assert_eq!(squared_error(&b, &a, 4).expect("same size"), error);
        // Levels are sums divided by 4: equation 1 in floating point.
        let mean: f64 = a.values().iter().zip(b.values())
            .map(|(&a, &b)| (f64::from(a) / 4.0 - f64::from(b) / 4.0).powi(2))
            .sum::<f64>() / error.pixels as f64;
        prop_assert!((error.rms() - mean.sqrt()).abs() < 1e-9);
    }

    #[test]
    fn a_set_of_views_is_one_mosaic(pairs in prop::collection::vec(pair(), 1..6)) {
        let views: Vec<SquaredError> =
            pairs.iter().map(|(a, b)| squared_error(a, b, 4).expect("same size")).collect();
        let errors = ViewErrors::new(views.clone()).expect("same samples");
        // One image that holds all pixels in one row.
        let row = |all: Vec<u16>| plane(all.len() as u32, &all);
        let (a, b) = (
            row(pairs.iter().flat_map(|p| p.0.values().to_vec()).collect()),
            row(pairs.iter().flat_map(|p| p.1.values().to_vec()).collect()),
        );
        let mosaic = squared_error(&a, &b, 4).expect("same size");
        prop_assert_eq!(errors.total(), mosaic);
        let (worst, error) = errors.worst();
        prop_assert_eq!(error, views[worst]);
        prop_assert!(views.iter().all(|v| v.rms() <= error.rms()));
        prop_assert!(views[..worst].iter().all(|v| v.rms() < error.rms()));
    }

    #[test]
    fn a_comparison_tells_where_and_how_much((a, b) in pair().prop_map(|(a, b)| (a.map(|v| v % 3), b.map(|v| v % 3)))) {
        let mut differing = Vec::new();
        for y in 0..a.height() {
            for x in 0..a.width() {
                if a.at(x, y) != b.at(x, y) {
                    differing.push((x, y, a.at(x, y).abs_diff(b.at(x, y))));
                }
            }
        }
        match compare(&a, &b) {
            ImageComparison::Equal => prop_assert!(differing.is_empty()),
            ImageComparison::Sizes { .. } => prop_assert!(false, "the sizes are equal"),
            ImageComparison::Pixels(d) => {
                prop_assert_eq!(d.count, differing.len() as u64);
                prop_assert_eq!(d.first, (differing[0].0, differing[0].1));
                prop_assert_eq!(&d.expected, &vec![u32::from(a.at(d.first.0, d.first.1))]);
                prop_assert_eq!(&d.actual, &vec![u32::from(b.at(d.first.0, d.first.1))]);
                prop_assert_eq!(d.largest[0], u32::from(differing.iter().map(|d| d.2).max().expect("some")));
                prop_assert_eq!(d.low.0, differing.iter().map(|d| d.0).min().expect("some"));
                prop_assert_eq!(d.low.1, differing.iter().map(|d| d.1).min().expect("some"));
                prop_assert_eq!(d.high.0, differing.iter().map(|d| d.0).max().expect("some"));
                prop_assert_eq!(d.high.1, differing.iter().map(|d| d.1).max().expect("some"));
            }
        }
    }
}

#[test]
fn of_equally_bad_views_the_first_is_the_worst() {
    let view = |sum| SquaredError {
        sum,
        pixels: 4,
        samples: 1,
    };
    let errors = ViewErrors::new([3, 7, 7, 1].map(view).to_vec()).expect("same samples");
    assert_eq!(errors.worst(), (1, view(7)));
}

#[test]
fn equal_images_have_no_finite_psnr() {
    let image = plane(2, &[1_u8, 2, 3, 4]);
    let error = squared_error(&image, &image, 1).expect("same size");
    assert!(error.is_zero());
    assert_eq!((error.rms(), error.psnr()), (0.0, None));
}

#[test]
fn psnr_has_its_textbook_values() {
    let (black, white) = (plane(2, &[0_u8; 4]), plane(2, &[255_u8; 4]));
    let error = squared_error(&black, &white, 1).expect("same size");
    assert_eq!((error.rms(), error.psnr()), (255.0, Some(0.0)));
    let grey = plane(2, &[1_u8; 4]);
    let error = squared_error(&black, &grey, 1).expect("same size");
    let psnr = error.psnr().expect("finite");
    assert!((psnr - 48.130_803_608_679_1).abs() < 1e-12, "{psnr}");
    // 2 of 4 samples of every pixel differ by one level: half a level.
    let halves = squared_error(&plane(1, &[0_u16]), &plane(1, &[2_u16]), 4).expect("same size");
    assert_eq!(halves.rms(), 0.5);
}

#[test]
fn images_that_cannot_be_compared_are_refused() {
    let square = plane(2, &[0_u8; 4]);
    for other in [plane(4, &[0_u8; 4]), plane(2, &[0_u8; 6])] {
        let error = squared_error(&square, &other, 1).expect_err("sizes differ");
        assert_eq!(error.exit_code(), 2, "{error}");
        assert!(error.to_string().contains("2 x 2"), "{error}");
        let found = compare(&square, &other);
        assert!(matches!(found, ImageComparison::Sizes { .. }));
        assert!(signed_picture(&square, &other, 1).is_err());
    }
    let nothing = Grid::filled(0, 0, 0_u8);
    assert!(squared_error(&nothing, &nothing, 1).is_err());
    assert!(squared_error(&square, &square, 0).is_err());
    let bright = plane(1, &[256_u16]);
    let refused = squared_error(&bright, &bright, 1);
    assert!(refused.is_err(), "256 is no level");
    assert!(ViewErrors::new(Vec::new()).is_err());
    let set = [square.clone(), square];
    assert!(ViewErrors::between(&set, &set[..1], 1).is_err());
}

#[test]
fn sums_of_different_samples_or_beyond_64_bits_do_not_add() {
    let error = |sum, samples| SquaredError {
        sum,
        pixels: 1,
        samples,
    };
    assert!(error(1, 1).combined(error(1, 4)).is_err());
    let overflow = error(u64::MAX, 1).combined(error(1, 1));
    assert_eq!(overflow.expect_err("too large").exit_code(), 4);
}

#[test]
fn a_comparison_is_a_sentence() {
    let expected = plane(3, &[[1_u8, 2, 3]; 6]);
    let mut actual = expected.clone();
    actual.values_mut()[4] = [1, 9, 0];
    assert_eq!(
        compare(&expected, &actual).to_string(),
        "1 of 6 pixels differ, first at (1, 1): expected (1, 2, 3), found (1, 9, 0); all in columns 1 to 1 and rows \
         1 to 1, by at most (0, 7, 3)"
    );
    assert!(compare(&expected, &expected.clone()).is_equal());
}

#[test]
fn a_difference_picture_is_grey_only_where_images_are_equal() {
    for scale in [1, 4, 255] {
        for e in 0..=255 {
            for a in 0..=255_u8 {
                let shown =
                    signed_picture(&plane(1, &[e]), &plane(1, &[a]), scale).expect("same size");
                let shown = shown.at(0, 0);
                assert_eq!(shown.cmp(&128), a.cmp(&e), "{e} became {a}");
                if scale == 1 && a.abs_diff(e) < 128 {
                    assert_eq!(i32::from(shown) - 128, i32::from(a) - i32::from(e));
                }
            }
        }
    }
}

fn cube() -> Mesh {
    super::surface::moved(&super::surface::cube(), |p| p * 2.0 - DVec3::ONE)
}

#[test]
fn a_cube_seen_from_in_front_of_a_face_has_the_four_edges_of_that_face() {
    let from = |eyes: &[Eye]| {
        let found = silhouette_histogram(&cube(), eyes, &Silent).expect("finite");
        found.counts().to_vec()
    };
    let near = Eye::Point(DVec3::new(0.0, 0.0, 5.0));
    assert_eq!(from(&[near]), [14, 4]);
    // Seen along the axis the other faces are edge-on: the edges of the back face coincide with those of the front.
    assert_eq!(from(&[Eye::Axis(DVec3::Z)]), [10, 8]);
    // Six edges of a cube's corner view, as a hexagon; inside the cube none.
    assert_eq!(from(&[Eye::Axis(DVec3::ONE)]), [12, 6]);
    assert_eq!(from(&[Eye::Point(DVec3::ZERO)]), [18, 0]);
    assert_eq!(from(&[near, near, Eye::Axis(DVec3::ONE)]), [10, 4, 2, 2]);
    let histogram = silhouette_histogram(&cube(), &[near, near], &Silent).expect("finite");
    assert_eq!((histogram.edges(), histogram.share(2)), (18, 4.0 / 18.0));
    assert_eq!(histogram.expectation(), 8.0 / 18.0);
    assert!(silhouette_histogram(&cube(), &[Eye::Axis(DVec3::NAN)], &Silent).is_err());
}

#[test]
fn a_boundary_edge_is_a_silhouette_from_both_sides_but_not_from_within_its_plane() {
    let corners = vec![DVec3::ZERO, DVec3::X, DVec3::Y];
    let one = Mesh::from_triangles(corners, vec![[0, 1, 2]]).expect("a triangle");
    for (axis, counts) in [(DVec3::Z, [0, 3]), (-DVec3::Z, [0, 3]), (DVec3::X, [3, 0])] {
        let found = silhouette_histogram(&one, &[Eye::Axis(axis)], &Silent).expect("finite");
        assert_eq!(found.counts(), counts, "from {axis}");
    }
}

proptest! {
    #![proptest_config(crate::support::cases(256))]

    #[test]
    fn silhouettes_are_closed_curves_and_know_no_winding(
        shape in prop::collection::vec(prop::array::uniform3(-1.0..1.0_f32), 8),
        eye in prop::array::uniform3(-3.0..3.0_f64).prop_map(DVec3::from_array),
        turned in prop::collection::vec(0_usize..6, 12),
    ) {
        let triangles = cube().triangles().to_vec();
        let positions: Vec<DVec3> =
            shape.iter().map(|p| DVec3::from_array(p.map(f64::from))).collect();
        let mesh = Mesh::from_triangles(positions.clone(), triangles.clone()).expect("valid");
        let eye = Eye::Point(eye);
        let expected = silhouette_histogram(&mesh, &[eye], &Silent).expect("finite");
        let orders = [[0, 1, 2], [1, 2, 0], [2, 0, 1], [0, 2, 1], [2, 1, 0], [1, 0, 2]];
        let shuffled: Vec<[u32; 3]> =
            triangles.iter().zip(&turned).map(|(t, &o)| orders[o].map(|i| t[i])).collect();
        let mesh = Mesh::from_triangles(positions.clone(), shuffled).expect("valid");
        prop_assert_eq!(&silhouette_histogram(&mesh, &[eye], &Silent).expect("finite"), &expected);
        // The definition, with the determinant of the closed and consistently wound original.
        let Eye::Point(at) = eye else { unreachable!() };
        let front = |t: u32| {
            let [a, b, c] = triangles[t as usize].map(|v| positions[v as usize] - at);
            a.dot(b.cross(c)) < 0.0
        };
        let mut degree = [0; 8];
        let mut count = 0;
        for (edge, at_edge) in Edges::of(&mesh).iter() {
            if front(at_edge[0]) != front(at_edge[1]) {
                count += 1;
                for v in edge {
                    degree[v as usize] += 1;
                }
            }
        }
        prop_assert_eq!(expected.counts()[1], count);
        prop_assert!(degree.iter().all(|d| d % 2 == 0));
    }
}

proptest! {
    #![proptest_config(crate::support::cases(256))]

    #[test]
    fn a_red_picture_is_grey_where_nothing_differs_and_redder_where_more_does(
        e: u8, a: u8, b: u8, scale in 1_u8..=255,
    ) {
        let pixel = |a: u8| red_picture(&plane(1, &[e]), &plane(1, &[a]), scale).expect("one pixel").at(0, 0);
        prop_assert_eq!(pixel(e), [e; 3]);
        let redness = |[r, g, blue]: [u8; 3]| {
            assert_eq!(g, blue);
            r - g
        };
        let shown = |a: u8| (u32::from(scale) * u32::from(e.abs_diff(a))).min(255);
        prop_assert_eq!(u32::from(redness(pixel(a))), shown(a));
        if e.abs_diff(a) <= e.abs_diff(b) {
            prop_assert!(redness(pixel(a)) <= redness(pixel(b)));
        }
        prop_assert!(pixel(a)[1] <= e, "never lighter than the reference");
    }
}

#[test]
fn a_red_picture_of_other_sizes_or_scale_0_is_refused() {
    let one = plane(1, &[7_u8]);
    assert!(red_picture(&one, &plane(2, &[7_u8, 8]), 1).is_err());
    assert!(red_picture(&one, &one, 0).is_err());
}
