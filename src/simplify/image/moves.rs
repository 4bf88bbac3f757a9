//! Where a vertex should go: a search along its normal and two tangents, judged by the pictures.

use glam::DVec3;

use super::{PictureScratch, Pictures};
use crate::{
    collapse::{Freedom, LiveMesh, Patch, Rules, Star, unfolded, unmirrored},
    num::math,
    raster::Unrender,
};

/// Buffers of one thread.
#[derive(Debug)]
pub(super) struct Search<S> {
    pub(super) star: Star,
    pub(super) patch: Patch,
    pub(super) pictures: PictureScratch<S>,
}

/// What a search found.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Found {
    /// The better position, and what going there would add to the error (negative), if there is one.
    pub(super) better: Option<(DVec3, i64)>,
    /// Positions whose pictures were drawn.
    pub(super) evaluations: u64,
}

impl<S> Search<S> {
    pub(super) fn new<E: Unrender<Scratch = S>>(pictures: &Pictures<E>) -> Self {
        Self {
            star: Star::default(),
            patch: Patch::default(),
            pictures: pictures.scratch(),
        }
    }

    /// Fills the patch with the move of the star's vertex; false where that is not allowed.
    pub(super) fn prepare(&mut self, live: &LiveMesh, to: DVec3, rules: Rules) -> Option<DVec3> {
        let Self { star, patch, .. } = self;
        let to = star.admit(live, to, rules).ok()?;
        if to == star.point {
            return None;
        }
        star.patch(live, to, patch);
        unmirrored(live, patch).ok()?;
        unfolded(live, patch).ok()?;
        Some(to)
    }

    /// Looks for a better position of `vertex` at distances of `step` times the mean length of its edges.
    ///
    /// One axis after the other, from the best position so far: forwards, else backwards; then at the lowest point of
    /// the parabola through the three costs.
    pub(super) fn run<E: Unrender<Scratch = S>>(
        &mut self,
        live: &LiveMesh,
        pictures: &Pictures<E>,
        rules: Rules,
        vertex: u32,
        step: f64,
        turn: f64,
    ) -> Found {
        let mut found = Found::default();
        self.star.gather(live, vertex);
        let axes = match self.star.freedom {
            Freedom::Fixed => return found,
            Freedom::Normal => 1,
            Freedom::Free => 3,
        };
        let Some(normal) = self.star.normal(live) else {
            return found;
        };
        let length = step * self.star.mean_edge(live);
        let basis = basis(normal, turn);
        let (mut best, mut at) = (0_i64, self.star.point);
        for axis in &basis[..axes] {
            let base = best;
            let origin = at;
            let mut cost = |search: &mut Self, t: f64| -> Option<(DVec3, i64)> {
                let to = search.prepare(live, origin + *axis * (t * length), rules)?;
                found.evaluations += 1;
                Some((to, pictures.cost(live, &search.patch, &mut search.pictures)))
            };
            let forward = cost(self, 1.0);
            let mut take = |candidate: Option<(DVec3, i64)>| {
                if let Some((to, c)) = candidate
                    && c < best
                {
                    (best, at) = (c, to);
                }
            };
            take(forward);
            let backward = if forward.is_some_and(|(_, c)| c < base) {
                None
            } else {
                cost(self, -1.0)
            };
            take(backward);
            if let (Some((_, f)), Some((_, b))) = (forward, backward) {
                // The parabola through (-1, b), (0, base) and (1, f).
                let (f, b) = ((f - base) as f64, (b - base) as f64);
                let t = 0.5 * (b - f) / (f + b);
                if f + b > 0.0 && t.abs() > 0.05 && t.abs() < 0.95 {
                    take(cost(self, t));
                }
            }
        }
        if best < 0 {
            found.better = Some((at, best));
        }
        found
    }
}

/// An orthonormal basis: the normal and two tangents, turned about it by `turn` radians.
fn basis(normal: DVec3, turn: f64) -> [DVec3; 3] {
    let n = normal.abs();
    let least = if n.x <= n.y && n.x <= n.z {
        DVec3::X
    } else if n.y <= n.z {
        DVec3::Y
    } else {
        DVec3::Z
    };
    let u = math::unit(normal.cross(least)).unwrap_or(DVec3::ZERO);
    let v = normal.cross(u);
    let (sin, cos) = (math::sin(turn), math::cos(turn));
    [normal, u * cos + v * sin, v * cos - u * sin]
}
