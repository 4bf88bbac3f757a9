//! Classes of corners: which corners of a star share one value of a channel after its edge collapses.
//!
//! Corners of the star at one end with equal values are one class; a face that holds both ends unites the classes of its
//! two corners; faces that the texture shows mirrored are parted from those that it shows as they are.

use std::cmp::Ordering;

use super::{WedgeRows, texture_area};
use crate::{
    collapse::{EdgeStar, LiveMesh, pinch::Forest},
    mesh::{Channel, ChannelKind},
};

/// A corner of the star at one end of its edge.
#[derive(Clone, Copy, Debug)]
pub(super) struct Corner {
    pub(super) face: usize,
    pub(super) end: usize,
    pub(super) wedge: u32,
    pub(super) class: usize,
}

/// The sides from which the texture shows the faces of a class.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Side {
    /// Some face is shown as it is.
    upright: bool,
    /// The first corner of a face that is not shown mirrored, and the first of one that is.
    firsts: [Option<usize>; 2],
}

/// Corners that are compared pair by pair; more are sorted, so that those around a hub do not cost their square.
const FEW: usize = 48;

/// Collects the corners of a star at either end of its edge.
pub(super) fn corners_of(live: &LiveMesh, star: &EdgeStar, corners: &mut Vec<Corner>) {
    corners.clear();
    for (face, f) in star.faces.iter().enumerate() {
        let wedges = live.wedges(f.id);
        for end in 0..2 {
            if f.at[end] < 3 {
                corners.push(Corner {
                    face,
                    end,
                    wedge: wedges[usize::from(f.at[end])],
                    class: 0,
                });
            }
        }
    }
}

/// Numbers the classes of the corners of a star in one channel: a class is the index of its first corner.
pub(super) fn divide(
    live: &LiveMesh,
    star: &EdgeStar,
    channel: Channel,
    corners: &mut [Corner],
    sides: &mut Vec<Side>,
) {
    classify(live.rows(), channel, corners);
    if matches!(channel.kind, ChannelKind::TexCoord(_)) {
        part_mirrored(live, star, channel, corners, sides);
    }
}

/// Makes a class of its own of the corners whose faces the texture shows mirrored, where others of their class are shown
/// as they are.
fn part_mirrored(
    live: &LiveMesh,
    star: &EdgeStar,
    channel: Channel,
    corners: &mut [Corner],
    sides: &mut Vec<Side>,
) {
    let area = |c: &Corner| {
        let wedges = live.wedges(star.faces[c.face].id);
        texture_area(live.rows(), channel, wedges)
    };
    sides.clear();
    sides.resize(corners.len(), Side::default());
    for (i, corner) in corners.iter().enumerate() {
        let side = &mut sides[corner.class];
        let area = area(corner);
        side.upright |= area > 0.0;
        let first = &mut side.firsts[usize::from(area < 0.0)];
        first.get_or_insert(i);
    }
    for corner in corners {
        let side = sides[corner.class];
        if let (true, [_, Some(_)]) = (side.upright, side.firsts) {
            let first = side.firsts[usize::from(area(corner) < 0.0)];
            corner.class = first.unwrap_or(corner.class);
        }
    }
}

/// Numbers the classes of corners by their values alone.
fn classify(rows: &WedgeRows, channel: Channel, corners: &mut [Corner]) {
    if corners.len() > FEW {
        classify_many(rows, channel, corners);
    } else {
        classify_few(rows, channel, corners);
    }
}

/// [`classify`] by comparing all pairs.
fn classify_few(rows: &WedgeRows, channel: Channel, corners: &mut [Corner]) {
    for (i, corner) in corners.iter_mut().enumerate() {
        corner.class = i;
    }
    for i in 1..corners.len() {
        for j in 0..i {
            let (a, b) = (corners[i], corners[j]);
            let united = if a.face == b.face {
                true
            } else {
                a.end == b.end && rows.same(channel, a.wedge, b.wedge)
            };
            if united && a.class != b.class {
                let (keep, drop) = (a.class.min(b.class), a.class.max(b.class));
                for c in corners[..=i].iter_mut().filter(|c| c.class == drop) {
                    c.class = keep;
                }
            }
        }
    }
}

/// [`classify`] by sorting; corners of one face are neighbours.
fn classify_many(rows: &WedgeRows, channel: Channel, corners: &mut [Corner]) {
    let value = |i: usize| rows.value(channel, corners[i].wedge);
    let compare = |&i: &usize, &j: &usize| {
        let ends = corners[i].end.cmp(&corners[j].end);
        ends.then_with(|| compare_bits(value(i), value(j)))
    };
    let mut order: Vec<usize> = (0..corners.len()).collect();
    order.sort_unstable_by(compare);
    let mut forest = Forest::of(corners.len());
    for pair in order.windows(2) {
        if compare(&pair[0], &pair[1]).is_eq() {
            forest.unite(pair[0], pair[1]);
        }
    }
    for i in 1..corners.len() {
        if corners[i].face == corners[i - 1].face {
            forest.unite(i, i - 1);
        }
    }
    for (i, corner) in corners.iter_mut().enumerate() {
        corner.class = forest.root(i);
    }
}

/// Orders values by their bits.
pub(super) fn compare_bits(a: &[f64], b: &[f64]) -> Ordering {
    a.iter()
        .map(|x| x.to_bits())
        .cmp(b.iter().map(|x| x.to_bits()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::{Attributes, Mesh, generate};

    /// Corners as of a star with `count` faces, of which every fifth has both ends, with few different values.
    fn corners(count: usize, wedges: u32, seed: u32) -> Vec<Corner> {
        let mut x = seed;
        let mut next = |below: u32| {
            x = x.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (x >> 8) % below
        };
        let ends = |face: usize| {
            if face.is_multiple_of(5) {
                0..2
            } else {
                face % 2..face % 2 + 1
            }
        };
        let corner = |face, end| (face, end);
        let all = (0..count).flat_map(|face| ends(face).map(move |end| corner(face, end)));
        all.map(|(face, end)| Corner {
            face,
            end,
            wedge: next(wedges),
            class: 0,
        })
        .collect()
    }

    #[test]
    fn classes_found_by_sorting_are_those_of_comparing_all_pairs() {
        let rows = WedgeRows::of(textured().attributes());
        for (seed, wedges) in (0..40).zip([2, 5, 12, 40].into_iter().cycle()) {
            let mut pairs = corners(30, wedges, seed);
            let mut sorted = pairs.clone();
            for &channel in rows.channels() {
                classify_few(&rows, channel, &mut pairs);
                classify_many(&rows, channel, &mut sorted);
                let classes = |corners: &[Corner]| -> Vec<usize> {
                    corners.iter().map(|c| c.class).collect()
                };
                assert_eq!(classes(&pairs), classes(&sorted), "{seed}");
            }
        }
    }

    /// 40 wedges, of which some have equal values.
    fn textured() -> Mesh {
        let mut parts = generate::grid(4, 4, generate::Height::Polynomial).into_parts();
        let corners =
            (0..parts.triangles.len() as u32).map(|t| [0, 1, 2].map(|k| (3 * t + k) % 40));
        let values = (0..40).flat_map(|w| [f64::from(w % 7) * 0.125, f64::from(w % 2)]);
        let kinds = [ChannelKind::TexCoord(0)];
        parts.attributes =
            Attributes::new(&kinds, values.collect(), corners.collect()).expect("valid");
        Mesh::new(parts).expect("valid")
    }
}
