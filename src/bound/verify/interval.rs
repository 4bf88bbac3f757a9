//! A proof that no viewer of a cell sees a piece and what stands for it under too large an angle, by interval arithmetic.
//!
//! Over a piece and a box of viewpoints, displacement and line of sight lie in boxes; so do their cross product and the
//! product of the two lines of sight. Where the largest cross product is small enough beside the least product, the angle
//! is small enough for all points and viewpoints. Otherwise the larger of cell part and piece is halved, and the proof is
//! given up after a number of steps.

use glam::DVec3;

/// Steps for one piece.
const STEPS: u32 = 400;
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

    fn minus(self, other: Self) -> Self {
        Self {
            low: self.low - other.high,
            high: self.high - other.low,
        }
    }

    fn axis(&self, k: usize) -> [f64; 2] {
        [self.low[k], self.high[k]]
    }
}

fn product(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    let all = [a[0] * b[0], a[0] * b[1], a[1] * b[0], a[1] * b[1]];
    [
        all[0].min(all[1]).min(all[2]).min(all[3]),
        all[0].max(all[1]).max(all[2]).max(all[3]),
    ]
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
    let viewer = Range::of(cell.iter().copied());
    let sight = Range::of(piece.iter().map(|c| c[0])).minus(viewer);
    let other = Range::of(piece.iter().map(|c| c[1])).minus(viewer);
    let moved = Range::of(piece.iter().map(|c| c[1] - c[0]));
    let mut across = 0.0;
    for k in 0..3 {
        let (i, j) = ((k + 1) % 3, (k + 2) % 3);
        let [a, b] = [
            product(sight.axis(i), moved.axis(j)),
            product(sight.axis(j), moved.axis(i)),
        ];
        let largest = (a[1] - b[0]).abs().max((a[0] - b[1]).abs());
        across += largest * largest;
    }
    let along: f64 = (0..3)
        .map(|k| product(sight.axis(k), other.axis(k))[0])
        .sum();
    along > 0.0 && across <= limit2 * (1.0 - MARGIN) * (along * along)
}
