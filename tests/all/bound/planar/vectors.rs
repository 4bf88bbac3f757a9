//! Values that were checked against dense sampling by others.

use glam::DVec2;
use lodmark::bound::planar::{
    Projection, ViewerSegment, segment_error, segment_extent, tangents, viewpoint_extent,
};

use crate::support::{aperture, rows};

fn close(found: f64, expected: f64, what: &str) {
    let tolerance = 1e-9 * expected.abs().max(1e-3);
    let off = (found - expected).abs();
    assert!(off <= tolerance, "{what}: {found} and not {expected}");
}

#[test]
fn one_viewpoint_allows_what_the_law_of_sines_says() {
    for [x, y, theta, expected] in rows(
        "-1.0                  0.0                  0.3  0.9555245108532735
         -0.8944271909999159  -0.4472135954999579   0.3  2.23606797749979",
    ) {
        let (point, d) = (DVec2::new(2.0, 1.0), DVec2::new(x, y));
        let found = viewpoint_extent(DVec2::ZERO, point, d, aperture(theta));
        close(found, expected, "extent");
    }
}

#[test]
fn a_line_allows_the_checked_extents_from_the_checked_viewpoints() {
    // A point, a direction, an angle, and for each of the two circles its viewpoint and its extent.
    let entries = rows(
        " 0.0 1.0  0.0                0.2   0.10033467208545055 0.2006693441709011   9.966644423259236  19.933288846518472
          0.5 2.0  1.2                0.1   2.0204087982673524  0.31505643837213265 -2.7620828475325294  0.7308397364037409
         -1.0 3.0 -2.5                0.35 -6.546755530632015   4.5452815342950075  -0.5594853105153892  1.0508735603487234
          0.0 1.0  1.5707963267948966 0.3   1.3560878511477086  0.8389742600304103  -1.3560878511477088  0.8389742600304103
          0.0 1.0 -1.5707963267948966 0.3  -0.7374153519284623  0.4562185987402219   0.7374153519284624  0.456218598740222",
    );
    let line = ViewerSegment::on_x_axis(f64::NEG_INFINITY, f64::INFINITY);
    for [x, y, gamma, theta, at, length, other_at, other_length] in entries {
        let (aperture, d) = (aperture(theta), DVec2::from_angle(gamma));
        let circles = [[at, length], [other_at, other_length]];
        for (found, [at, length]) in tangents(d, aperture).into_iter().zip(circles) {
            let found = found.expect("both circles touch the line");
            close(x + y * found.offset, at, "viewpoint");
            close(y * found.length, length, "extent of one circle");
        }
        let smaller = length.min(other_length);
        let extent = segment_extent(&line, DVec2::new(x, y), d, aperture);
        close(extent.length, smaller, "extent");
        let below = DVec2::from_angle(-gamma);
        let mirrored = segment_extent(&line, DVec2::new(x, -y), below, aperture);
        close(mirrored.length, smaller, "extent below the line");
    }
}

#[test]
fn a_segment_allows_the_checked_extents() {
    for [first, last, x, y, gamma, theta, expected] in rows(
        "-1  1  0 2    0.3 0.1   0.20787141472027246
          2  5  0 1    2.9 0.2  20.1439602542857
         -3 -2  1 1.5 -0.4 0.15  0.7657104726602177
          0  0.5 0 4   1.5 0.05  1.3929028049595897",
    ) {
        let cell = ViewerSegment::on_x_axis(first, last);
        let (point, d) = (DVec2::new(x, y), DVec2::from_angle(gamma));
        let found = segment_extent(&cell, point, d, aperture(theta));
        close(found.length, expected, "extent");
        let turn = DVec2::from_angle(0.7);
        let placed = |p: DVec2| turn.rotate(p) + DVec2::new(3.0, -8.0);
        let [from, to] = [last, first].map(|x| placed(DVec2::new(x, 0.0)));
        let cell = ViewerSegment::between(from, to).expect("finite ends");
        let moved = segment_extent(&cell, placed(point), turn.rotate(d), aperture(theta));
        close(moved.length, expected, "extent in another frame");
        let [here, there] = [found, moved].map(|e| e.viewpoint.expect("limited"));
        close(placed(here).distance(there) + 1.0, 1.0, "viewpoint");
    }
}

#[test]
fn a_segment_sees_the_checked_errors() {
    for [first, last, mx, my, sx, sy, expected] in rows(
        "-2 2   0 1  1 2    0.7853981633974483
          0 5  -1 1  1 1    1.5707963267948966
          3 4   0 1  1 0.5  0.08096147072083958",
    ) {
        let cell = ViewerSegment::on_x_axis(first, last);
        for mirror in [1.0, -1.0] {
            let (m, s) = (DVec2::new(mx, mirror * my), DVec2::new(sx, mirror * sy));
            close(segment_error(&cell, m, s).angle, expected, "error");
            close(segment_error(&cell, s, m).angle, expected, "exchanged");
        }
    }
}

#[test]
fn a_face_has_the_checked_intervals() {
    // The ends of the cell and of the face, the direction, the angle, the smallest and the largest offset.
    for [first, last, mx, my, nx, ny, gamma, theta, min, max] in rows(
        "-0.5  0.5 -1   3    1   4   1.5707963267948966 0.05  3.462840257874949    3.4170528911263847
          0    1    2   1    5   2   1.2                0.1   3.0743222262865872   2.022174463122444
         -1    1    4   2    4.5 6   0.2                0.03  5.330339988265079    4.626249452070369
         -2   -1    1   0.5  3   0.6 2.0                0.2  -0.40327580083959086  0.10330426708870466
         -0.5  0.5 -1   8   -0.6 8.1 1.81577498992176   0.05  6.551962353199907   10.23284694990621
         -0.5  0.5 -1   8   -0.6 8.1 1.9657749899217598 0.05  6.741560350156972    8.947091397098362
          0    1    6   3    6.4 3.6 2.5535900500422253 0.05 -3.6589113814539265  -3.0128062285526473
          0    1    6   3    6.4 3.6 2.703590050042225  0.05 -4.525184637422643   -3.9004032392783836
         -1    1   12   7   12.5 6.8 1.1902899496825314 0.04 10.123036044160392   11.880329758363196
         -1    1   12   7   12.5 6.8 1.3402899496825313 0.04  8.839053379769672   10.246444298050196
         -2   -1    1   0.5  3   0.6 1.6207547225168393 0.2   0.039866156551896986 0.8931788592045271
         -2   -1    1   0.5  3   0.6 1.7707547225168392 0.2  -0.12312680329600081  0.7135855849771284
         -1    1    0.2 10   0.5 10.2 2.1587989303424626 0.1  6.819872891572379    9.947038568950955
         -1    1    0.2 10   0.5 10.2 2.3087989303424625 0.1  6.0339362191215455   8.667297291315435",
    ) {
        let cell = ViewerSegment::on_x_axis(first, last);
        let projection = Projection::new(&cell, DVec2::from_angle(gamma), aperture(theta));
        let (m, n) = (DVec2::new(mx, my), DVec2::new(nx, ny));
        for (a, b) in [(m, n), (n, m)] {
            let found = projection.interval(a, b);
            close(found.min, min, "smallest offset");
            close(found.max, max, "largest offset");
        }
    }
}
