//! Attributes of the new vertex: which corners share a wedge, and its values.
//!
//! Algorithm (seams of Lindstrom & Turk 2000, section 3.3, by classes of corners), for each channel by itself so that
//! a normal discontinuity does not tear texture coordinates: corners of the star at one end with equal values are one
//! class; a face that holds both ends unites the classes of its two corners; every class gets one value. The value is
//! interpolated along the edge at the foot of the new position, clamped to the edge; at an end it is exactly that
//! end's. Normals are made unit again. A value that either end lacks is absent.

use std::cmp::Ordering;

use glam::DVec3;

use super::{EdgeStar, LiveMesh, Patch, StarFace, pinch::Forest};
use crate::{
    mesh::{Attributes, Channel, ChannelKind},
    num::{Precision, math},
};

/// The values of all wedges, rows that patches appended included.
#[derive(Clone, Debug, Default)]
pub struct WedgeRows {
    channels: Vec<Channel>,
    stride: usize,
    values: Vec<f64>,
}

impl WedgeRows {
    /// A copy of the rows of `attributes`.
    #[must_use]
    pub fn of(attributes: &Attributes) -> Self {
        Self {
            channels: attributes.channels().to_vec(),
            stride: attributes.stride(),
            values: attributes.values().to_vec(),
        }
    }

    /// The channels.
    #[must_use]
    pub fn channels(&self) -> &[Channel] {
        &self.channels
    }

    /// The meanings of the channels.
    #[must_use]
    pub fn kinds(&self) -> Vec<ChannelKind> {
        self.channels.iter().map(|c| c.kind).collect()
    }

    /// Values in a row; 0 where there are no attributes.
    #[must_use]
    pub fn stride(&self) -> usize {
        self.stride
    }

    /// Number of rows.
    #[must_use]
    pub fn count(&self) -> u32 {
        self.values.len().checked_div(self.stride).unwrap_or(0) as u32
    }

    /// The values of a wedge.
    ///
    /// # Panics
    /// Where there is no such wedge.
    #[must_use]
    pub fn row(&self, wedge: u32) -> &[f64] {
        &self.values[wedge as usize * self.stride..][..self.stride]
    }

    /// True where a channel is one whose discontinuities are features.
    #[must_use]
    pub fn has_feature_channels(&self) -> bool {
        self.channels.iter().any(|c| makes_features(c.kind))
    }

    pub(super) fn append(&mut self, rows: &[f64]) {
        self.values.extend_from_slice(rows);
    }

    pub(super) fn truncate(&mut self, values: usize) {
        self.values.truncate(self.values.len() - values);
    }

    pub(super) fn value(&self, channel: Channel, wedge: u32) -> &[f64] {
        &self.row(wedge)[channel.offset..][..channel.kind.width()]
    }

    pub(super) fn same(&self, channel: Channel, a: u32, b: u32) -> bool {
        a == b || same_bits(self.value(channel, a), self.value(channel, b))
    }
}

/// Normals differ at almost every edge of a flat-shaded export; that alone is no feature.
pub(super) fn makes_features(kind: ChannelKind) -> bool {
    kind != ChannelKind::Normal
}

pub(super) fn same_bits(a: &[f64], b: &[f64]) -> bool {
    a.iter().zip(b).all(|(x, y)| x.to_bits() == y.to_bits())
}

/// True where attributes or materials differ between the star's faces at the edge `ends`, or its texture is mirrored
/// there; `faces` has at least those of the star at that edge, in its order.
#[must_use]
pub(super) fn is_feature<'a>(
    live: &LiveMesh,
    faces: impl Iterator<Item = &'a StarFace>,
    ends: [u32; 2],
) -> bool {
    let corner = |f: &StarFace, v: u32| f.corners.iter().position(|&c| c == v);
    let at_edge = |f: &StarFace| Some([corner(f, ends[0])?, corner(f, ends[1])?]);
    let mut at = faces.filter_map(|f| Some((f, at_edge(f)?)));
    let Some((first, first_at)) = at.next() else {
        return false;
    };
    at.any(|(other, other_at)| {
        let faces = [first, other].map(|f| (f.id, live.wedges(f.id)));
        differ(live, faces, [first_at, other_at], makes_features)
    })
}

/// True where two faces, given with their wedges, differ along a common edge in their material, in the values of a
/// channel that `counts` at either end (`at`: which corners those are, the same end first), or where one of them is
/// mirrored in texture space.
pub(super) fn differ(
    live: &LiveMesh,
    faces: [(u32, [u32; 3]); 2],
    at: [[usize; 2]; 2],
    counts: impl Fn(ChannelKind) -> bool,
) -> bool {
    let [(f, a), (g, b)] = faces;
    if live.material(f) != live.material(g) {
        return true;
    }
    let rows = live.rows();
    rows.channels.iter().filter(|c| counts(c.kind)).any(|&c| {
        let differs = |end: usize| !rows.same(c, a[at[0][end]], b[at[1][end]]);
        let mirrored = || {
            // Faces that run along the edge the same way show different sides.
            let forward = |at: [usize; 2]| (at[0] + 1) % 3 == at[1];
            let side = if forward(at[0]) == forward(at[1]) {
                -1.0
            } else {
                1.0
            };
            matches!(c.kind, ChannelKind::TexCoord(_))
                && side * texture_area(rows, c, a) * texture_area(rows, c, b) < 0.0
        };
        differs(0) || differs(1) || mirrored()
    })
}

/// Twice the signed area of a triangle in texture space; NaN where it has no texture coordinates.
#[must_use]
pub fn texture_area(rows: &WedgeRows, channel: Channel, wedges: [u32; 3]) -> f64 {
    let [a, b, c] = wedges.map(|w| {
        let value = rows.value(channel, w);
        [value[0], value[1]]
    });
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

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
pub(super) struct WedgeScratch {
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
pub(super) fn transfer(live: &LiveMesh, star: &EdgeStar, position: DVec3, patch: &mut Patch) {
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
            let ends = firsts[corner.class].map(|first| first.map(|w| rows.value(channel, w)));
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
        return classify_many(rows, channel, corners);
    }
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
        for ((x, &a), &b) in into.iter_mut().zip(a).zip(b) {
            *x = ((1.0 - t) * a + t * b).clamp(a.min(b), a.max(b));
        }
        if kind == ChannelKind::Normal {
            let n = DVec3::new(into[0], into[1], into[2]);
            // Opposite normals cancel: keep the first end's rather than none.
            let n = math::unit(n).unwrap_or(DVec3::new(a[0], a[1], a[2]));
            into.copy_from_slice(&[n.x, n.y, n.z]);
        }
        for x in into.iter_mut() {
            *x = precision.round(*x);
        }
    }
}
