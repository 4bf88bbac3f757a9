//! The wedges of a new vertex: corners that share one, and its values.
//!
//! Algorithm (seams of Lindstrom & Turk 2000, section 3.3, by classes of corners), for each channel by itself so that
//! a normal discontinuity does not tear texture coordinates: corners of the star at one end with equal values are one
//! class; a face that holds both ends unites the classes of its two corners; every class gets one value. The value is
//! interpolated along the edge at the foot of the new position, clamped to the edge; at an end it is exactly that
//! end's. Normals are made unit again. A value that either end lacks is absent.

use std::cmp::Ordering;

use glam::DVec3;

use super::{Blend, WedgeRows, same_bits};
use crate::{
    collapse::{EdgeStar, LiveMesh, Patch, pinch::Forest},
    mesh::{Channel, ChannelKind},
    num::{Each, Precision},
};

/// A corner of the star at one end of its edge.
#[derive(Clone, Copy, Debug)]
struct Corner {
    face: usize,
    end: usize,
    wedge: u32,
    class: usize,
}

/// Corners that are compared pair by pair; more are sorted, so that those around a hub do not cost their square.
const FEW: usize = 48;

/// Buffers of [`transfer`]; all are equal.
#[derive(Clone, Debug, Default)]
pub(in crate::rooms::collapse) struct WedgeScratch {
    corners: Vec<Corner>,
    values: Vec<f64>,
    /// For every class, the first wedge of a corner at either end of the edge.
    firsts: Vec<[Option<u32>; 2]>,
    /// The new rows, by their values.
    order: Vec<u32>,
}

impl PartialEq for WedgeScratch {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

/// Gives the new vertex its wedges in `patch.added` and appends their rows to `patch.rows`.
pub(in crate::rooms::collapse) fn transfer(
    live: &LiveMesh,
    star: &EdgeStar,
    position: DVec3,
    patch: &mut Patch,
) {
    let rows = live.rows();
    if rows.stride == 0 {
        return;
    }
    let mut scratch = std::mem::take(&mut patch.scratch);
    let WedgeScratch {
        corners,
        values,
        firsts,
        order,
    } = &mut scratch;
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
    values.clear();
    values.resize(corners.len() * rows.stride, 0.0);
    let t = foot(star, position);
    for &channel in &rows.channels {
        classify(rows, channel, corners);
        firsts.clear();
        firsts.resize(corners.len(), [None; 2]);
        for corner in corners.iter() {
            firsts[corner.class][corner.end].get_or_insert(corner.wedge);
        }
        for (i, corner) in corners.iter().enumerate() {
            let ends = firsts[corner.class].each(|first| first.map(|w| rows.value(channel, w)));
            let into = &mut values[i * rows.stride + channel.offset..][..channel.kind.width()];
            match ends {
                [Some(a), Some(b)] => interpolate(channel.kind, live.precision(), a, b, t, into),
                [Some(a), None] | [None, Some(a)] => into.copy_from_slice(a),
                [None, None] => {}
            }
        }
    }
    order.clear();
    let mut added = 0;
    for (i, corner) in corners.iter().enumerate() {
        let face = &star.faces[corner.face];
        if !face.survives {
            continue;
        }
        while patch.added[added].id != face.id {
            added += 1;
        }
        let row = &values[i * rows.stride..][..rows.stride];
        let id = if same_bits(row, rows.row(corner.wedge)) {
            corner.wedge
        } else {
            rows.count() + appended(row, &mut patch.rows, order)
        };
        patch.added[added].wedges[face.apex()] = id;
    }
    patch.scratch = scratch;
}

/// The number of a row among those of a patch, to which it is appended where it is new. `order` has the known ones by
/// their values.
fn appended(row: &[f64], rows: &mut Vec<f64>, order: &mut Vec<u32>) -> u32 {
    let stride = row.len();
    let known = |&r: &u32| compare_bits(&rows[r as usize * stride..][..stride], row);
    match order.binary_search_by(known) {
        Ok(at) => order[at],
        Err(at) => {
            let new = order.len() as u32;
            rows.extend_from_slice(row);
            order.insert(at, new);
            new
        }
    }
}

fn compare_bits(a: &[f64], b: &[f64]) -> Ordering {
    a.iter()
        .map(|x| x.to_bits())
        .cmp(b.iter().map(|x| x.to_bits()))
}

/// Numbers the classes of corners in one channel: a class is the index of its first corner.
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

/// The foot of `position` on the edge: 0 at its first end, 1 at its second.
fn foot(star: &EdgeStar, position: DVec3) -> f64 {
    let [u, w] = star.points;
    if position == u {
        return 0.0;
    }
    if position == w {
        return 1.0;
    }
    let along = w - u;
    let t = (position - u).dot(along) / along.dot(along);
    if t.is_finite() {
        t.clamp(0.0, 1.0)
    } else {
        0.5
    }
}

#[expect(clippy::float_cmp, reason = "exactly at an end, the end's own bits")]
fn interpolate(
    kind: ChannelKind,
    precision: Precision,
    a: &[f64],
    b: &[f64],
    t: f64,
    into: &mut [f64],
) {
    if a.iter().chain(b).any(|x| x.is_nan()) {
        into.fill(f64::NAN);
    } else if t == 0.0 {
        into.copy_from_slice(a);
    } else if t == 1.0 {
        into.copy_from_slice(b);
    } else {
        let blend = Blend {
            values: [a, b],
            weights: [1.0 - t, t],
        };
        // Opposite normals cancel: keep the first end's rather than none.
        blend.write(kind, precision, a, into);
    }
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
