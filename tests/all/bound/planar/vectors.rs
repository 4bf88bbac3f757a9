//! Values that were checked against dense sampling by others.

use glam::DVec2;
use lodmark::bound::planar::{
    Aperture, Projection, ViewerSegment, segment_error, segment_extent, tangents, viewpoint_extent,
};

fn direction(gamma: f64) -> DVec2 {
    DVec2::from_angle(gamma)
}

fn aperture(angle: f64) -> Aperture {
    Aperture::radians(angle).expect("a checked value is below a right angle")
}

fn close(found: f64, expected: f64, what: &str) {
    let tolerance = 1e-9 * expected.abs().max(1e-3);
    assert!(
        (found - expected).abs() <= tolerance,
        "{what}: {found} and not {expected}"
    );
}

#[test]
fn one_viewpoint_allows_what_the_law_of_sines_says() {
    for (d, theta, expected) in [
        ([-1.0, 0.0], 0.3, 0.955_524_510_853_273_5),
        (
            [-0.894_427_190_999_915_9, -0.447_213_595_499_957_9],
            0.3,
            2.236_067_977_499_79,
        ),
    ] {
        let found = viewpoint_extent(
            DVec2::ZERO,
            DVec2::new(2.0, 1.0),
            DVec2::from_array(d),
            aperture(theta),
        );
        close(found, expected, "extent");
    }
}

#[test]
fn a_line_allows_the_checked_extents_from_the_checked_viewpoints() {
    type Entry = ((f64, f64), f64, f64, [(f64, f64); 2]);
    let entries: [Entry; 5] = [
        (
            (0.0, 1.0),
            0.0,
            0.2,
            [
                (0.100_334_672_085_450_55, 0.200_669_344_170_901_1),
                (9.966_644_423_259_236, 19.933_288_846_518_472),
            ],
        ),
        (
            (0.5, 2.0),
            1.2,
            0.1,
            [
                (2.020_408_798_267_352_4, 0.315_056_438_372_132_65),
                (-2.762_082_847_532_529_4, 0.730_839_736_403_740_9),
            ],
        ),
        (
            (-1.0, 3.0),
            -2.5,
            0.35,
            [
                (-6.546_755_530_632_015, 4.545_281_534_295_007_5),
                (-0.559_485_310_515_389_2, 1.050_873_560_348_723_4),
            ],
        ),
        (
            (0.0, 1.0),
            1.570_796_326_794_896_6,
            0.3,
            [
                (1.356_087_851_147_708_6, 0.838_974_260_030_410_3),
                (-1.356_087_851_147_708_8, 0.838_974_260_030_410_3),
            ],
        ),
        (
            (0.0, 1.0),
            -1.570_796_326_794_896_6,
            0.3,
            [
                (-0.737_415_351_928_462_3, 0.456_218_598_740_221_9),
                (0.737_415_351_928_462_4, 0.456_218_598_740_222),
            ],
        ),
    ];
    let line = ViewerSegment::on_x_axis(f64::NEG_INFINITY, f64::INFINITY);
    for ((x, y), gamma, theta, expected) in entries {
        let found = tangents(direction(gamma), aperture(theta));
        for (found, (at, length)) in found.into_iter().zip(expected) {
            let found = found.expect("both circles touch the line");
            close(x + y * found.offset, at, "viewpoint");
            close(y * found.length, length, "extent of one circle");
        }
        let smaller = expected[0].1.min(expected[1].1);
        let extent = segment_extent(&line, DVec2::new(x, y), direction(gamma), aperture(theta));
        close(extent.length, smaller, "extent");
        let mirrored = segment_extent(&line, DVec2::new(x, -y), direction(-gamma), aperture(theta));
        close(mirrored.length, smaller, "extent below the line");
    }
}

#[test]
fn a_segment_allows_the_checked_extents() {
    for (ends, (x, y), gamma, theta, expected) in [
        ([-1.0, 1.0], (0.0, 2.0), 0.3, 0.1, 0.207_871_414_720_272_46),
        ([2.0, 5.0], (0.0, 1.0), 2.9, 0.2, 20.143_960_254_285_7),
        (
            [-3.0, -2.0],
            (1.0, 1.5),
            -0.4,
            0.15,
            0.765_710_472_660_217_7,
        ),
        ([0.0, 0.5], (0.0, 4.0), 1.5, 0.05, 1.392_902_804_959_589_7),
    ] {
        let cell = ViewerSegment::on_x_axis(ends[0], ends[1]);
        let found = segment_extent(&cell, DVec2::new(x, y), direction(gamma), aperture(theta));
        close(found.length, expected, "extent");
        let turn = DVec2::from_angle(0.7);
        let placed = |p: DVec2| turn.rotate(p) + DVec2::new(3.0, -8.0);
        let cell = ViewerSegment::between(
            placed(DVec2::new(ends[1], 0.0)),
            placed(DVec2::new(ends[0], 0.0)),
        )
        .expect("finite ends");
        let d = turn.rotate(direction(gamma));
        let moved = segment_extent(&cell, placed(DVec2::new(x, y)), d, aperture(theta));
        close(moved.length, expected, "extent in another frame");
        let (here, there) = (
            found.viewpoint.expect("limited"),
            moved.viewpoint.expect("limited"),
        );
        close(placed(here).distance(there) + 1.0, 1.0, "viewpoint");
    }
}

#[test]
fn a_segment_sees_the_checked_errors() {
    for (ends, m, s, expected) in [
        ([-2.0, 2.0], (0.0, 1.0), (1.0, 2.0), 0.785_398_163_397_448_3),
        ([0.0, 5.0], (-1.0, 1.0), (1.0, 1.0), 1.570_796_326_794_896_6),
        ([3.0, 4.0], (0.0, 1.0), (1.0, 0.5), 0.080_961_470_720_839_58),
    ] {
        let cell = ViewerSegment::on_x_axis(ends[0], ends[1]);
        for mirror in [1.0, -1.0] {
            let (m, s) = (DVec2::new(m.0, mirror * m.1), DVec2::new(s.0, mirror * s.1));
            close(segment_error(&cell, m, s).angle, expected, "error");
            close(
                segment_error(&cell, s, m).angle,
                expected,
                "error, exchanged",
            );
        }
    }
}

#[test]
fn a_face_has_the_checked_intervals() {
    type Entry = ([f64; 2], (f64, f64), (f64, f64), f64, f64, [f64; 2]);
    let entries: [Entry; 14] = [
        (
            [-0.5, 0.5],
            (-1.0, 3.0),
            (1.0, 4.0),
            1.5707963267948966,
            0.05,
            [3.462840257874949, 3.4170528911263847],
        ),
        (
            [0.0, 1.0],
            (2.0, 1.0),
            (5.0, 2.0),
            1.2,
            0.1,
            [3.0743222262865872, 2.022174463122444],
        ),
        (
            [-1.0, 1.0],
            (4.0, 2.0),
            (4.5, 6.0),
            0.2,
            0.03,
            [5.330339988265079, 4.626249452070369],
        ),
        (
            [-2.0, -1.0],
            (1.0, 0.5),
            (3.0, 0.6),
            2.0,
            0.2,
            [-0.40327580083959086, 0.10330426708870466],
        ),
        (
            [-0.5, 0.5],
            (-1.0, 8.0),
            (-0.6, 8.1),
            1.81577498992176,
            0.05,
            [6.551962353199907, 10.23284694990621],
        ),
        (
            [-0.5, 0.5],
            (-1.0, 8.0),
            (-0.6, 8.1),
            1.9657749899217598,
            0.05,
            [6.741560350156972, 8.947091397098362],
        ),
        (
            [0.0, 1.0],
            (6.0, 3.0),
            (6.4, 3.6),
            2.5535900500422253,
            0.05,
            [-3.6589113814539265, -3.0128062285526473],
        ),
        (
            [0.0, 1.0],
            (6.0, 3.0),
            (6.4, 3.6),
            2.703590050042225,
            0.05,
            [-4.525184637422643, -3.9004032392783836],
        ),
        (
            [-1.0, 1.0],
            (12.0, 7.0),
            (12.5, 6.8),
            1.1902899496825314,
            0.04,
            [10.123036044160392, 11.880329758363196],
        ),
        (
            [-1.0, 1.0],
            (12.0, 7.0),
            (12.5, 6.8),
            1.3402899496825313,
            0.04,
            [8.839053379769672, 10.246444298050196],
        ),
        (
            [-2.0, -1.0],
            (1.0, 0.5),
            (3.0, 0.6),
            1.6207547225168393,
            0.2,
            [0.039866156551896986, 0.8931788592045271],
        ),
        (
            [-2.0, -1.0],
            (1.0, 0.5),
            (3.0, 0.6),
            1.7707547225168392,
            0.2,
            [-0.12312680329600081, 0.7135855849771284],
        ),
        (
            [-1.0, 1.0],
            (0.2, 10.0),
            (0.5, 10.2),
            2.1587989303424626,
            0.1,
            [6.819872891572379, 9.947038568950955],
        ),
        (
            [-1.0, 1.0],
            (0.2, 10.0),
            (0.5, 10.2),
            2.3087989303424625,
            0.1,
            [6.0339362191215455, 8.667297291315435],
        ),
    ];
    for (ends, m, n, gamma, theta, expected) in entries {
        let cell = ViewerSegment::on_x_axis(ends[0], ends[1]);
        let projection = Projection::new(&cell, direction(gamma), aperture(theta));
        let (m, n) = (DVec2::from(m), DVec2::from(n));
        for (a, b) in [(m, n), (n, m)] {
            let found = projection.interval(a, b);
            close(found.min, expected[0], "smallest offset");
            close(found.max, expected[1], "largest offset");
        }
    }
}
