//! A proof that no viewer of a cell sees a piece and what stands for it under too large an angle.
//!
//! A point of the piece is a mean of its corners, a viewpoint one of the corners of the cell. So the cross product of
//! displacement and line of sight is a mean of those of all corners with all corners, and no longer than the longest of
//! them; the product of both lines of sight is at least the least of those. Where the one is small enough beside the other,
//! the angle is small enough for all points and viewpoints. Otherwise the larger of cell part and piece is halved, and the
//! proof is given up after a number of steps.

use glam::DVec3;

/// Steps for one piece.
const STEPS: u32 = 32;
/// Corners of a part: cuts of all connections make more than the hull needs.
const CORNERS: usize = 12;
/// A part of a limit that is given away for rounding.
const MARGIN: f64 = 1e-12;

/// Smallest and largest coordinates.
#[derive(Clone, Copy)]
struct Range {
    low: DVec3,
    high: DVec3,
}

impl Range {
    fn of(points: impl Iterator<Item = DVec3>) -> Self {
        let mut range = Self {
            low: DVec3::splat(f64::INFINITY),
            high: DVec3::splat(f64::NEG_INFINITY),
        };
        for p in points {
            range.low = range.low.min(p);
            range.high = range.high.max(p);
        }
        range
    }
}

/// Twice: corners of a piece, and corners of what stands for it.
type Pair = Vec<[DVec3; 2]>;

/// True where the square of the tangent of the angle is proven to be at most `limit2` for the whole piece and all
/// viewpoints in the hull of `cell`.
pub(super) fn proves(piece: &[[DVec3; 2]], cell: &[DVec3], limit2: f64) -> bool {
    let mut open: Vec<(Pair, Vec<DVec3>)> = vec![(piece.to_vec(), cell.to_vec())];
    for _ in 0..STEPS {
        let Some((piece, cell)) = open.pop() else {
            return true;
        };
        if piece.len() > CORNERS || cell.len() > CORNERS {
            return false;
        }
        if holds(&piece, &cell, limit2) {
            continue;
        }
        let cell_range = Range::of(cell.iter().copied());
        let piece_range = Range::of(piece.iter().map(|c| c[0]));
        let wide = |r: &Range| (r.high - r.low).max_element();
        if wide(&cell_range) * 0.25 > wide(&piece_range) {
            let axis = widest(&cell_range);
            let middle = 0.5 * (cell_range.low[axis] + cell_range.high[axis]);
            let [one, other] = cut(&cell, |v| v[axis] - middle, |a, b, t| a.lerp(b, t));
            open.push((piece.clone(), one));
            open.push((piece, other));
        } else {
            let axis = widest(&piece_range);
            let middle = 0.5 * (piece_range.low[axis] + piece_range.high[axis]);
            let between =
                |a: [DVec3; 2], b: [DVec3; 2], t| [a[0].lerp(b[0], t), a[1].lerp(b[1], t)];
            let [one, other] = cut(&piece, |c| c[0][axis] - middle, between);
            open.push((one, cell.clone()));
            open.push((other, cell));
        }
    }
    open.is_empty()
}

fn widest(range: &Range) -> usize {
    let d = range.high - range.low;
    if d.x >= d.y && d.x >= d.z {
        0
    } else if d.y >= d.z {
        1
    } else {
        2
    }
}

/// Two sets whose hulls cover the hull of `points`: those on either side, with where all connections cross.
fn cut<T: Copy>(
    points: &[T],
    side: impl Fn(&T) -> f64,
    between: impl Fn(T, T, f64) -> T,
) -> [Vec<T>; 2] {
    let (mut one, mut other) = (Vec::new(), Vec::new());
    for &p in points {
        if side(&p) <= 0.0 {
            one.push(p);
        } else {
            other.push(p);
        }
    }
    let mut crossings = Vec::new();
    for &a in &one {
        for &b in &other {
            let (da, db) = (side(&a), side(&b));
            crossings.push(between(a, b, da / (da - db)));
        }
    }
    one.extend_from_slice(&crossings);
    other.extend(crossings);
    [one, other]
}

fn holds(piece: &[[DVec3; 2]], cell: &[DVec3], limit2: f64) -> bool {
    let (mut across, mut along) = (0.0_f64, f64::INFINITY);
    for [p, _] in piece {
        for &v in cell {
            for [q, other] in piece {
                let product = (*other - *q).cross(*p - v);
                across = across.max(product.dot(product));
                for &w in cell {
                    along = along.min((*p - v).dot(*other - w));
                }
            }
        }
    }
    along > 0.0 && across <= limit2 * (1.0 - MARGIN) * (along * along)
}
