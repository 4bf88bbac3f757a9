//! The largest angle, or distance, between a surface and its replacement, over *all* points and not only the vertices.
//!
//! Testing vertices or edges bounds nothing (Eisemann & Décoret 2007, Figures 11 and 16). Here the surface is cut into
//! triangles that go to triangles by affine maps, each with an upper bound for all its points, and those with the
//! largest bounds are cut in four until the bound is near what is attained at a point.
//! Upper bound for a triangle with centroid `M0`, which goes to `S0`, at most `r` from its corners: moving viewer and
//! pair together, `angle(M0, V', S0 + d)` with `|V' - V| <= r` and `d` the change of the displacement; the first point
//! pair is exact over the cell, its gradient in `V` is `|M0 S0| / (|V M0| |V S0|)`, and `d` is seen under at most
//! `asin(|d| / |V S0|)`. The conservative bound of the notes (4.7), `asin(displacement / distance of the face)`, is
//! taken where it is smaller. Angles are radians, lengths in the units of the positions, magnitudes near 1.

use std::f64::consts::PI;

use glam::DVec3;

use super::{point::error, view_cell::ViewCell};
use crate::{
    Progress, Result,
    num::{
        Each,
        math::{asin, length},
    },
    parallel,
};

/// Given to every bound for the rounding of the computations behind it, relative to the bound and to the size of the
/// coordinates.
const ROUNDING: [f64; 2] = [1e-9, 1e-14];

/// Most times that a triangle is cut in four; where the surface touches the cell no depth would be enough.
const DEPTH: u8 = 20;

/// Triangles judged by one task between two reports.
const BATCH: usize = 16_384;

/// A triangle of a surface, or a part of one, and the triangle it goes to: corner to corner, linearly between.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pair {
    /// Corners on the original.
    pub from: [DVec3; 3],
    /// The corners that replace them.
    pub to: [DVec3; 3],
    /// The triangle of the original that this is a part of.
    pub triangle: u32,
}

impl Pair {
    /// The corner itself, and the middles of the two sides next to it; or all three middles.
    fn quarters(&self) -> [Self; 4] {
        let cut = |[a, b, c]: [DVec3; 3]| {
            let [ab, bc, ca] = [0.5 * a + 0.5 * b, 0.5 * b + 0.5 * c, 0.5 * c + 0.5 * a];
            [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
        };
        let (from, to) = (cut(self.from), cut(self.to));
        [0, 1, 2, 3].each(|i| Self {
            from: from[i],
            to: to[i],
            triangle: self.triangle,
        })
    }

    fn displacements(&self) -> [DVec3; 3] {
        [0, 1, 2].each(|i| self.to[i] - self.from[i])
    }

    /// The longest displacement of all its points: that of a corner.
    fn longest(&self) -> f64 {
        self.displacements()
            .each(length)
            .into_iter()
            .fold(0.0, f64::max)
    }
}

/// A replacement of a surface.
pub trait Replacement: Sync {
    /// A triangle inside the replacement that may stand for `from`, corner for corner; `None` where the map is given
    /// and not a matter of choice. Any triangle inside is legal, a near one is wanted: the nearest for the centroid.
    fn propose(&self, from: [DVec3; 3]) -> Option<[DVec3; 3]>;
}

/// A map that is given: parts of a triangle go where the whole goes.
#[derive(Clone, Copy, Debug)]
pub struct Given;

impl Replacement for Given {
    fn propose(&self, _: [DVec3; 3]) -> Option<[DVec3; 3]> {
        None
    }
}

/// A measure of the error between a point and its replacement.
#[derive(Clone, Copy, Debug)]
pub enum Measure<'a> {
    /// The largest angle under which a viewer in the cell sees both, in radians.
    Angle(&'a ViewCell),
    /// The distance between both.
    Distance,
}

/// Limits of the search: precision and pieces.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Effort {
    /// The bound may exceed what is attained by this share of it, above 0.
    pub precision: f64,
    /// Triangles and parts of triangles that are judged at most; the bound holds wherever the search ends.
    pub pieces: u64,
}

impl Default for Effort {
    /// 1 % and 20 million parts.
    fn default() -> Self {
        Self {
            precision: 0.01,
            pieces: 20_000_000,
        }
    }
}

/// A point, what stands for it, and what is seen of that.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Worst {
    /// The angle in radians, or the distance.
    pub value: f64,
    /// A point of the original.
    pub point: DVec3,
    /// Its replacement.
    pub replacement: DVec3,
    /// From where the angle is largest; `None` where the cell meets the segment between both, and for distances.
    pub viewpoint: Option<DVec3>,
    /// The triangle of the original.
    pub triangle: u32,
}

/// The error of a replacement: a bound, and the largest one attained.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfaceBound {
    /// No point of the surface has more: radians, at most pi, or a length. 0 for an empty surface.
    pub bound: f64,
    /// The point that has most of all that were looked at: `bound` is above it by at most the precision unless
    /// `pieces` ran out or the surface meets the cell. `None` where nothing is displaced.
    pub worst: Option<Worst>,
    /// Triangles and parts of them that were judged.
    pub pieces: u64,
}

#[derive(Clone, Copy)]
struct Judged {
    pair: Pair,
    depth: u8,
    upper: f64,
    worst: Worst,
}

/// Bounds what is measured between every point of the pairs and its replacement.
///
/// Where the replacement is a matter of choice (see [`Replacement::propose`]), a part takes the proposed triangle or
/// goes where the whole goes, whichever has the smaller bound: the result then holds for that map, which may tear the
/// surface between parts. Independent of the number of threads. Cost: some microseconds for each part and face of the
/// cell; parts are needed where the bound is within a factor of the largest.
///
/// # Errors
/// [`Error::Interrupted`](crate::Error::Interrupted).
pub fn measure(
    pairs: Vec<Pair>,
    replacement: &dyn Replacement,
    measure: Measure<'_>,
    effort: Effort,
    progress: &dyn Progress,
) -> Result<SurfaceBound> {
    let mut pieces = 0_u64;
    let mut open = Vec::new();
    let mut judge_all = |pairs: &[(Pair, u8)], into: &mut Vec<Judged>| -> Result<()> {
        for batch in pairs.chunks(BATCH) {
            pieces += batch.len() as u64;
            progress.step("bound", pieces, 0)?;
            let judged: Vec<Judged> = parallel::map_slice(batch, |&(pair, depth)| {
                judge(pair, depth, replacement, measure)
            });
            into.extend(judged);
        }
        Ok(())
    };
    let whole: Vec<(Pair, u8)> = pairs.into_iter().map(|pair| (pair, 0)).collect();
    judge_all(&whole, &mut open)?;
    drop(whole);
    let mut spent = open.len() as u64;
    loop {
        let upper = open.iter().map(|j| j.upper).fold(0.0, f64::max);
        let attained = open.iter().map(|j| j.worst.value).fold(0.0, f64::max);
        // From the top: what is far below may never have to be cut.
        let enough = ((1.0 + effort.precision) * attained).max(0.5 * upper);
        let cut = |j: &Judged| j.upper > enough && j.depth < DEPTH;
        let parts: Vec<(Pair, u8)> = open
            .iter()
            .filter(|j| cut(j))
            .flat_map(|j| j.pair.quarters().each(|pair| (pair, j.depth + 1)))
            .collect();
        if parts.is_empty() || spent + parts.len() as u64 > effort.pieces {
            break;
        }
        spent += parts.len() as u64;
        open.retain(|j| !cut(j));
        judge_all(&parts, &mut open)?;
    }
    let mut worst: Option<Worst> = None;
    for judged in &open {
        if judged.worst.value > worst.map_or(0.0, |w| w.value) {
            worst = Some(judged.worst);
        }
    }
    Ok(SurfaceBound {
        bound: open.iter().map(|j| j.upper).fold(0.0, f64::max),
        worst,
        pieces,
    })
}

/// The better of the map that the pair came with and the one that is proposed.
fn judge(pair: Pair, depth: u8, replacement: &dyn Replacement, measure: Measure<'_>) -> Judged {
    let inherited = || judge_map(pair, depth, measure);
    let Some(to) = replacement.propose(pair.from) else {
        return inherited();
    };
    let proposed = judge_map(Pair { to, ..pair }, depth, measure);
    // A whole triangle has not been mapped yet.
    if depth == 0 {
        return proposed;
    }
    let inherited = inherited();
    if inherited.upper < proposed.upper {
        inherited
    } else {
        proposed
    }
}

fn judge_map(pair: Pair, depth: u8, measure: Measure<'_>) -> Judged {
    let third = |[a, b, c]: [DVec3; 3]| {
        if a == b && b == c {
            a
        } else {
            (a + b + c) / 3.0
        }
    };
    let (point, replacement) = (third(pair.from), third(pair.to));
    let longest = pair.longest();
    let mut worst = Worst {
        value: 0.0,
        point,
        replacement,
        viewpoint: None,
        triangle: pair.triangle,
    };
    let upper = match measure {
        _ if longest <= 0.0 => 0.0,
        Measure::Distance => {
            worst.value = length(replacement - point);
            longest
        }
        Measure::Angle(cell) => {
            let found = error(cell, point, replacement);
            (worst.value, worst.viewpoint) = (found.radians, found.viewpoint);
            widest(cell, &pair, [point, replacement], longest, found.radians)
        }
    };
    Judged {
        pair,
        depth,
        upper: upper.max(worst.value),
        worst,
    }
}

/// An upper bound of the angle of all points of a pair, whose middle has the angle `exact`.
fn widest(
    cell: &ViewCell,
    pair: &Pair,
    [point, replacement]: [DVec3; 2],
    longest: f64,
    exact: f64,
) -> f64 {
    let mut bound = PI;
    let size = point
        .abs()
        .max_element()
        .max(replacement.abs().max_element());
    let conservative = longest / cell.distance_to_triangle(pair.from);
    if conservative < 1.0 {
        bound = asin(conservative);
    }
    let middle = replacement - point;
    let (mut radius, mut change) = (0.0_f64, 0.0_f64);
    for (corner, displacement) in pair.from.into_iter().zip(pair.displacements()) {
        radius = radius.max(length(corner - point));
        change = change.max(length(displacement - middle));
    }
    let near = cell.distance_to_point(point) - radius;
    let far = cell.distance_to_point(replacement) - radius;
    if near > 0.0 && far > change {
        let turned = radius * length(middle) / (near * far) + asin(change / far);
        bound = bound.min(exact + turned);
    }
    let nearest = near.min(far);
    if nearest > 0.0 {
        bound += ROUNDING[1] * size / nearest;
    }
    (bound + ROUNDING[0] * bound).min(PI)
}
