//! The sums over the star of an edge that place the new vertex and price it, and the linear constraints in between.

use glam::DVec3;

use super::{ConstraintOrder, MemorylessOptions};
use crate::{
    collapse::{Admitted, BoundaryEdge, EdgeStar, Proposal, Refusal, Site},
    geometry::Sym3,
    num::math,
};

/// Places and prices the collapse of a site; also the placement and second key of the image-driven method.
///
/// # Errors
/// The rule that forbids it.
pub fn propose(site: &Site<'_>, options: &MemorylessOptions) -> Result<Proposal, Refusal> {
    let objective = Objective::of(site.star, options);
    let position = match site.fixed() {
        Some(position) => site.admit(position)?,
        None => {
            let optimum = objective.place().position.ok_or(Refusal::Unplaced);
            match optimum.and_then(|position| site.admit(position)) {
                Ok(position) => position,
                Err(_) => best_of_three(site, &objective)?,
            }
        }
    };
    let lost = site.seam_loss(position);
    let price = options.volume_weight * SEAM_PRICE * (lost * lost * lost);
    Ok(Proposal {
        position,
        primary: 0,
        secondary: objective.cost(site.star, position.position()) + price,
    })
}

/// The squared volume that stands for a unit of area, cubed, in the wrong chart: as if it had moved off the surface by
/// its own width (the volume of a tetrahedron is a third of area times height).
const SEAM_PRICE: f64 = 1.0 / 9.0;

/// The cheapest admitted position of midpoint and ends, the earlier on a tie.
fn best_of_three(site: &Site<'_>, objective: &Objective) -> Result<Admitted, Refusal> {
    let mut best = None;
    let mut refusal = Refusal::Unplaced;
    let [u, w] = site.star.points;
    for candidate in [site.star.midpoint(), u, w] {
        match site.admit(candidate) {
            Ok(admitted) => {
                let cost = objective.cost(site.star, admitted.position());
                if best.is_none_or(|(least, _)| cost < least) {
                    best = Some((cost, admitted));
                }
            }
            Err(reason) => refusal = reason,
        }
    }
    best.map(|(_, admitted)| admitted).ok_or(refusal)
}

/// The objective of an edge: sums over its star, relative to the midpoint of the edge.
#[derive(Clone, Copy, Debug, Default)]
pub struct Objective {
    origin: DVec3,
    normal_sum: DVec3,
    volume_sum: f64,
    volume: Gradient,
    boundary: Option<Boundary>,
    shape: Gradient,
    weights: [f64; 2],
    order: ConstraintOrder,
}

#[derive(Clone, Copy, Debug, Default)]
struct Boundary {
    edge_sum: DVec3,
    moment_sum: DVec3,
    area: Gradient,
}

/// The place that the constraints determine.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Placement {
    /// The position in frame units; `None` where the constraints determine none.
    pub position: Option<DVec3>,
    /// Constraints accepted after boundary (or volume) preservation, after both, after their optimisation, and after
    /// the shape of triangles.
    pub accepted: [usize; 4],
}

impl Objective {
    /// The sums over a star; O(faces).
    #[must_use]
    pub fn of(star: &EdgeStar, options: &MemorylessOptions) -> Self {
        let origin = star.midpoint();
        let mut sums = Self {
            origin,
            boundary: (!star.boundary.is_empty()).then(|| Boundary::of(&star.boundary, origin)),
            weights: [
                options.volume_weight,
                (1.0 - options.volume_weight) * star.length2(),
            ],
            order: options.lt_order,
            ..Self::default()
        };
        for face in &star.faces {
            let (n, l) = (face.normal, face.normal.dot(face.points[0] - origin));
            sums.normal_sum += n;
            sums.volume_sum += l;
            sums.volume.add_outer(1.0, n, n * -l);
        }
        let count = star.spokes.len() as f64;
        sums.shape.h = Sym3([count, 0.0, 0.0, count, 0.0, count]);
        for spoke in &star.spokes {
            sums.shape.c -= spoke.point - origin;
        }
        sums
    }

    /// The sums of a star without boundary edges, relative to the midpoint of its edge, but for the shape of triangles.
    pub(super) fn without_boundary(
        normal_sum: DVec3,
        volume_sum: f64,
        volume: Gradient,
        volume_weight: f64,
    ) -> Self {
        Self {
            normal_sum,
            volume_sum,
            volume,
            weights: [volume_weight, 0.0],
            ..Self::default()
        }
    }

    /// The position that the constraints determine.
    #[must_use]
    pub fn place(&self) -> Placement {
        self.solve::<true>()
    }

    /// As [`Objective::place`], where sums are far from the limits of doubles; faster.
    pub(super) fn place_quickly(&self) -> Placement {
        self.solve::<false>()
    }

    fn solve<const UNIT: bool>(&self) -> Placement {
        let mut constraints = Constraints::<UNIT>::default();
        let mut accepted = [0; 4];
        let keep_volume = |c: &mut Constraints<UNIT>| c.offer(self.normal_sum, self.volume_sum);
        let keep_boundary = |c: &mut Constraints<UNIT>| {
            if let Some(boundary) = &self.boundary {
                let (e, m) = (boundary.edge_sum, boundary.moment_sum);
                let mut gradient = Gradient::default();
                gradient.add_cross(1.0, e, e.cross(m));
                c.minimise(&gradient);
            }
        };
        if self.order == ConstraintOrder::Cgal {
            keep_boundary(&mut constraints);
            accepted[0] = constraints.count;
            keep_volume(&mut constraints);
        } else {
            keep_volume(&mut constraints);
            accepted[0] = constraints.count;
            keep_boundary(&mut constraints);
        }
        accepted[1] = constraints.count;
        constraints.minimise(&self.optimum());
        accepted[2] = constraints.count;
        constraints.minimise(&self.shape);
        accepted[3] = constraints.count;
        Placement {
            position: constraints.solve().map(|v| v + self.origin),
            accepted,
        }
    }

    /// [`Objective::optimum`] as its matrix and vector, relative to the midpoint of the edge.
    pub(in super::super) fn quadratic(&self) -> (Sym3, DVec3) {
        let gradient = self.optimum();
        (gradient.h, gradient.c)
    }

    /// Swept volumes and swept boundary areas as one objective. 9 = (1/2) / (1/18), the ratio of their Hessians.
    fn optimum(&self) -> Gradient {
        let [volume, area] = self.weights;
        let mut both = Gradient::default();
        for (h, v) in both.h.0.iter_mut().zip(self.volume.h.0) {
            *h = volume * v;
        }
        both.c = self.volume.c * volume;
        if let Some(boundary) = &self.boundary {
            both.h.add_weighted(9.0 * area, &boundary.area.h);
            both.c += boundary.area.c * (9.0 * area);
        }
        both
    }

    /// Sum of the squared volumes that the faces sweep when the new vertex lies at `position` (length^6).
    ///
    /// Summed face by face: the expanded quadratic form loses the small costs of flat areas to cancellation.
    #[must_use]
    pub fn volume_error(&self, star: &EdgeStar, position: DVec3) -> f64 {
        let mut sum = 0.0;
        for face in &star.faces {
            let six_volumes = face.normal.dot(position - face.points[0]);
            sum += six_volumes * six_volumes;
        }
        sum / 36.0
    }

    /// Sum of the squared areas that the boundary edges sweep (length^4).
    #[must_use]
    pub fn boundary_error(&self, star: &EdgeStar, position: DVec3) -> f64 {
        let mut sum = 0.0;
        for edge in &star.boundary {
            let two_areas = (edge.to - edge.from).cross(position - edge.from);
            sum += two_areas.dot(two_areas);
        }
        sum / 4.0
    }

    /// The edge cost (length^6).
    #[must_use]
    pub fn cost(&self, star: &EdgeStar, position: DVec3) -> f64 {
        self.weights[0] * self.volume_error(star, position)
            + self.weights[1] * self.boundary_error(star, position)
    }
}

impl Boundary {
    fn of(edges: &[BoundaryEdge], origin: DVec3) -> Self {
        let mut sums = Self::default();
        for edge in edges {
            let (s, t) = (edge.from - origin, edge.to - origin);
            let (e, m) = (t - s, t.cross(s));
            sums.edge_sum += e;
            sums.moment_sum += m;
            sums.area.add_cross(1.0, e, e.cross(m));
        }
        sums
    }
}

/// cos^2 and sin^2 of one degree, the least angle between constraints.
const COS2: f64 = 0.999_695_413_509_547_9;
const SIN2: f64 = 3.045_864_904_520_854_5e-4;

/// A symmetric 3x3 matrix and a vector: the gradient `H v + c` of a quadratic function.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Gradient {
    pub(super) h: Sym3,
    pub(super) c: DVec3,
}

impl Gradient {
    /// Adds `weight * n n^T` and `weight * c`.
    fn add_outer(&mut self, weight: f64, n: DVec3, c: DVec3) {
        self.h.add_weighted(weight, &Sym3::outer(n));
        self.c += c * weight;
    }

    /// Adds `weight * ([e]x)^T [e]x` and `weight * c`.
    fn add_cross(&mut self, weight: f64, e: DVec3, c: DVec3) {
        let ee = e.dot(e);
        let products = [
            ee - e.x * e.x,
            -e.x * e.y,
            -e.x * e.z,
            ee - e.y * e.y,
            -e.y * e.z,
            ee - e.z * e.z,
        ];
        self.h.add_weighted(weight, &Sym3(products));
        self.c += c * weight;
    }
}

/// Up to three accepted rows `a . v = b`; of unit length where `UNIT`, which only guards against overflow.
#[derive(Clone, Copy, Debug, Default)]
struct Constraints<const UNIT: bool> {
    rows: [DVec3; 3],
    values: [f64; 3],
    count: usize,
}

impl<const UNIT: bool> Constraints<UNIT> {
    /// Accepts the row where it is compatible with those before it.
    fn offer(&mut self, a: DVec3, b: f64) {
        let a2 = a.dot(a);
        if !(a2 > 0.0 && a2 < f64::INFINITY && b.is_finite()) {
            return;
        }
        let compatible = match self.count {
            0 => true,
            1 => {
                let d = self.rows[0].dot(a);
                d * d <= self.rows[0].dot(self.rows[0]) * a2 * COS2
            }
            2 => {
                let n = self.rows[0].cross(self.rows[1]);
                let d = n.dot(a);
                d * d > n.dot(n) * a2 * SIN2
            }
            _ => false,
        };
        if compatible {
            (self.rows[self.count], self.values[self.count]) = if UNIT {
                let l = math::sqrt(a2);
                (a / l, b / l)
            } else {
                (a, b)
            };
            self.count += 1;
        }
    }

    /// Adds the conditions for the minimum of a quadratic function in the directions that are still free.
    fn minimise(&mut self, gradient: &Gradient) {
        match self.count {
            0 => {
                for axis in [DVec3::X, DVec3::Y, DVec3::Z] {
                    self.descend(gradient, axis);
                }
            }
            1 => {
                let a = self.rows[0];
                let (x, y, z) = (a.x.abs(), a.y.abs(), a.z.abs());
                let q = if x >= y && x >= z {
                    DVec3::new(-a.z / a.x, 0.0, 1.0)
                } else if y >= z {
                    DVec3::new(0.0, -a.z / a.y, 1.0)
                } else {
                    DVec3::new(1.0, 0.0, -a.x / a.z)
                };
                self.descend(gradient, q);
                self.descend(gradient, a.cross(q));
            }
            2 => self.descend(gradient, self.rows[0].cross(self.rows[1])),
            _ => {}
        }
    }

    /// Offers that the derivative along `direction` vanishes.
    fn descend(&mut self, gradient: &Gradient, direction: DVec3) {
        self.offer(gradient.h.times(direction), -direction.dot(gradient.c));
    }

    fn solve(&self) -> Option<DVec3> {
        if self.count < 3 {
            return None;
        }
        let [a, b, c] = self.rows;
        let (bc, ca, ab) = (b.cross(c), c.cross(a), a.cross(b));
        let v = (bc * self.values[0] + ca * self.values[1] + ab * self.values[2]) / a.dot(bc);
        v.is_finite().then_some(v)
    }
}
