//! The search for a better place of a vertex: along its normal and two tangents, judged by the pictures, and where it would be
//! near the original with all of its faces.

use glam::DVec3;

use super::{
    super::{PictureScratch, Pictures},
    Limits,
};
use crate::{
    collapse::{Freedom, LiveMesh, Patch, Rules, Star, check_folds, check_uv_orientation},
    num::math,
    raster::ViewSubset,
};

/// Farthest that a parabola is followed along one axis, in steps.
const REACH: f64 = 2.0;

/// Farthest that a vertex goes for the surface, as a share of the mean length of its edges.
const FARTHEST: f64 = 0.3;

/// Most positions that are drawn for the sake of the surface. A third costs time and brings nothing that can be measured.
const LOOKS: usize = 2;

/// Buffers of one thread.
#[derive(Debug)]
pub(super) struct Search {
    pub(super) star: Star,
    pub(super) patch: Patch,
    pub(super) pictures: PictureScratch,
}

/// Positions that a search tries.
#[derive(Clone, Copy, Debug)]
pub(super) struct Probe {
    /// Distance, in mean edge lengths at the vertex.
    pub(super) step: f64,
    /// Angle of the tangents about the normal, in radians.
    pub(super) turn: f64,
}

/// Result of a search.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Found {
    /// The better position, and what going there would add to the error, if there is one: negative unless the surface is
    /// worth it.
    pub(super) better: Option<(DVec3, i64)>,
    /// Positions whose pictures were drawn.
    pub(super) evaluations: u64,
}

impl Search {
    pub(super) fn new(pictures: &Pictures) -> Self {
        Self {
            star: Star::default(),
            patch: Patch::default(),
            pictures: pictures.scratch(false),
        }
    }

    /// Fills the patch with the move of the star's vertex to `to`, rounded; `None` where that is not allowed or no move.
    pub(super) fn prepare(&mut self, live: &LiveMesh, to: DVec3, rules: Rules) -> Option<DVec3> {
        let Self { star, patch, .. } = self;
        let to = star.admit(live, to, rules).ok()?;
        if to == star.point {
            return None;
        }
        star.patch(live, to, patch);
        check_uv_orientation(live, patch).ok()?;
        check_folds(live, patch, rules).ok()?;
        Some(to)
    }

    /// Looks for a better position of `vertex` at distances of `step` times the mean length of its edges; `turn` is the
    /// angle of the tangents.
    ///
    /// Both ways along every axis, and then where the parabolas through the costs along the axes are lowest (at most
    /// [`REACH`] steps away along each): a step of Newton's method with a diagonal matrix. The best of all that, and
    /// where the surface counts, what [`Search::weigh`] finds beside it.
    pub(super) fn run(
        &mut self,
        live: &LiveMesh,
        pictures: &Pictures,
        limits: Limits<'_>,
        vertex: u32,
        Probe { step, turn }: Probe,
    ) -> Found {
        let rules = limits.rules;
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
        let origin = self.star.point;
        let mut lowest = origin;
        let mut expected = Parabolas::default();
        for (axis, parabola) in basis(normal, turn).iter().zip(&mut expected.0).take(axes) {
            let ways = [1.0, -1.0];
            let costs = ways.map(|t| {
                let to = origin + *axis * (t * length);
                self.try_position(live, pictures, rules, to, &mut found)
            });
            if let [Some(f), Some(b)] = costs.map(|cost| cost.map(|c| c as f64)) {
                lowest += *axis * (lowest_of_parabola(f, b) * length);
                *parabola = Parabola {
                    axis: *axis / length,
                    slope: 0.5 * (f - b),
                    curvature: 0.5 * (f + b),
                };
            }
        }
        self.try_position(live, pictures, rules, lowest, &mut found);
        let image = found.better.take();
        self.weigh(
            live,
            pictures,
            limits,
            (image, normal),
            &expected,
            &mut found,
        );
        found
    }

    /// The best of the position that is best for the pictures, that which [fits](super::super::DistancePenalty::fit) the surface, the
    /// middle of the two, and the one's place along the tangents with the other's height. Of the last three at most
    /// [`LOOKS`] are drawn, and only where the parabolas and the surface promise something of them.
    fn weigh(
        &mut self,
        live: &LiveMesh,
        pictures: &Pictures,
        limits: Limits<'_>,
        (image, normal): (Option<(DVec3, i64)>, DVec3),
        expected: &Parabolas,
        found: &mut Found,
    ) {
        let sum = pictures.sum() as f64;
        let origin = self.star.point;
        let fit = limits.deviation.and_then(|d| d.fit(live, &self.star));
        let fit = fit.map(|step| {
            let [far, most] = [math::length(step), FARTHEST * self.star.mean_edge(live)];
            if far > most {
                step * (most / far)
            } else {
                step
            }
        });
        let between = image.zip(fit).map(|((to, _), fit)| {
            let step = to - origin;
            [
                origin + (step - normal * step.dot(normal)) + normal * fit.dot(normal),
                origin + (step + fit) * 0.5,
            ]
        });
        let places = [
            fit.map(|step| origin + step),
            between.map(|[to, _]| to),
            between.map(|[_, to]| to),
        ];
        let mut before = None;
        let mut promising = places.map(|to| {
            let to = self.prepare(live, to?, limits.rules)?;
            let cost = expected.cost(to - origin) as i64;
            if limits.falling && cost > 0 {
                return None;
            }
            let balance = limits.balance(live, &self.patch, (cost, sum), &mut before);
            Some((balance, to))
        });
        let key = |p: &Option<(f64, DVec3)>| p.map_or(f64::INFINITY, |(balance, _)| balance);
        promising.sort_by(|a, b| key(a).total_cmp(&key(b)));
        let mut best = (0.0, 0);
        let mut judge = |hope: f64, to: DVec3, cost: Option<i64>| {
            if hope >= best.0 {
                return;
            }
            let Some(to) = self.prepare(live, to, limits.rules) else {
                return;
            };
            let cost = cost.unwrap_or_else(|| {
                found.evaluations += 1;
                pictures.cost(live, &self.patch, ViewSubset::All, &mut self.pictures)
            });
            if limits.falling && cost > 0 {
                return;
            }
            let balance = limits.balance(live, &self.patch, (cost, sum), &mut before);
            if (balance, cost) < best && limits.keeps_sides(live, &self.patch) {
                best = (balance, cost);
                found.better = Some((to, cost));
            }
        };
        if let Some((to, cost)) = image {
            judge(f64::NEG_INFINITY, to, Some(cost));
        }
        for (hope, to) in promising.into_iter().flatten().take(LOOKS) {
            judge(hope, to, None);
        }
    }

    /// The cost at a position, where it is allowed; remembers the best.
    fn try_position(
        &mut self,
        live: &LiveMesh,
        pictures: &Pictures,
        rules: Rules,
        to: DVec3,
        found: &mut Found,
    ) -> Option<i64> {
        let to = self.prepare(live, to, rules)?;
        let cost = pictures.cost(live, &self.patch, ViewSubset::All, &mut self.pictures);
        found.evaluations += 1;
        if cost < found.better.map_or(0, |(_, best)| best) {
            found.better = Some((to, cost));
        }
        Some(cost)
    }
}

/// Expected image cost around a vertex: a parabola along every axis.
#[derive(Clone, Copy, Debug, Default)]
struct Parabolas([Parabola; 3]);

/// `slope t + curvature t^2` at `t` steps along an axis.
#[derive(Clone, Copy, Debug, Default)]
struct Parabola {
    /// The direction, over the length of a step.
    axis: DVec3,
    slope: f64,
    curvature: f64,
}

impl Parabolas {
    fn cost(&self, way: DVec3) -> f64 {
        let along = self.0.iter().map(|p| {
            let t = way.dot(p.axis);
            (p.slope + p.curvature * t) * t
        });
        along.sum()
    }
}

/// Where the parabola through (-1, `backward`), (0, 0) and (1, `forward`) is lowest within [`REACH`].
fn lowest_of_parabola(forward: f64, backward: f64) -> f64 {
    let curvature = forward + backward;
    if curvature > 0.0 {
        (0.5 * (backward - forward) / curvature).clamp(-REACH, REACH)
    } else if forward < backward {
        REACH
    } else {
        -REACH
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
