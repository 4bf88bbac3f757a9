//! Sums over the faces around every vertex, from which the memoryless cost of an edge follows without a look at its star.
//!
//! The planes of the faces at a vertex `u` pass through it: seen from `u`, the volume that a face sweeps when the
//! vertex moves to `v` is `n . (v - u) / 6`, without a constant. So the sums of Lindstrom & Turk 1998 over the star of
//! an edge are those at one end plus those at the other minus those of the faces at both, of which each has `n` only.
//! Only for edges whose star has no boundary edge; the sums follow every collapse, recomputed from the faces by
//! ascending id. Units: as the frame's, `n` is twice a face's area along its normal.

use glam::DVec3;

use super::{MemorylessOptions, Objective, objective::Gradient};
use crate::{
    collapse::{LiveMesh, Patch, legality::STAR_LIMIT},
    geometry::{self, Sym3},
    num::Each,
};

/// Most faces of a patch that are looked through for their vertices; beyond that those are sorted.
const FEW: usize = 48;

/// The sums at one vertex.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Fan {
    /// Sum of `n n^T`.
    matrix: Sym3,
    /// Sum of `n`.
    normal: DVec3,
}

impl Fan {
    fn add(&mut self, n: DVec3) {
        self.normal += n;
        self.matrix.add(&Sym3::outer(n));
    }
}

/// The sums at every vertex of a mesh. Empty: nothing can be estimated.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Fans {
    fans: Vec<Fan>,
    ids: Vec<u32>,
    touched: Vec<u32>,
    /// By how much the matrix of every touched vertex grew.
    growth: Vec<Sym3>,
}

impl Fans {
    /// The sums of a mesh; O(n).
    pub(super) fn of(live: &LiveMesh) -> Self {
        let mut fans = vec![Fan::default(); live.vertex_ids() as usize];
        for t in 0..live.triangle_ids() {
            if let Some(corners) = live.triangle(t) {
                let n = area_normal(live, corners);
                for v in corners {
                    fans[v as usize].add(n);
                }
            }
        }
        Self {
            fans,
            ..Self::default()
        }
    }

    /// Brings the sums up to date where `live` has just applied `patch`.
    pub(super) fn follow(&mut self, live: &LiveMesh, patch: &Patch) {
        if self.fans.is_empty() {
            return;
        }
        let mut touched = std::mem::take(&mut self.touched);
        touched.clear();
        self.growth.clear();
        let corners = patch.removed.iter().flat_map(|f| f.corners);
        if patch.removed.len() > FEW {
            touched.extend(corners);
            touched.sort_unstable();
            touched.dedup();
        } else {
            for v in corners {
                if !touched.contains(&v) {
                    touched.push(v);
                }
            }
        }
        for &v in &touched {
            // Its edges are no candidates; a collapse that brings it below the limit comes by here.
            if live.valence(v) <= STAR_LIMIT {
                let before = self.fans[v as usize].matrix;
                self.collect(live, v);
                let after = self.fans[v as usize].matrix;
                self.growth
                    .push(Sym3(std::array::from_fn(|i| after.0[i] - before.0[i])));
            } else {
                self.growth.push(Sym3::default());
            }
        }
        self.touched = touched;
    }

    /// False where the cost of an edge rose by the last collapse, as far as its midpoint tells.
    pub(super) fn may_fall(&self, live: &LiveMesh, edge: u32) -> bool {
        let Some(ends) = live.edge(edge).filter(|_| !self.fans.is_empty()) else {
            return true;
        };
        let along = live.position(ends[1]) - live.position(ends[0]);
        let mut growth = 0.0;
        for (&v, matrix) in self.touched.iter().zip(&self.growth) {
            if ends.contains(&v) {
                growth += along.dot(matrix.times(along));
            }
        }
        growth < 0.0
    }

    fn collect(&mut self, live: &LiveMesh, vertex: u32) {
        self.ids.clear();
        self.ids.extend(live.triangles_at(vertex));
        self.ids.sort_unstable();
        let mut fan = Fan::default();
        for &t in &self.ids {
            if let Some(corners) = live.triangle(t) {
                fan.add(area_normal(live, corners));
            }
        }
        self.fans[vertex as usize] = fan;
    }

    /// The memoryless cost of an edge at the place that the constraints determine, whatever the rules say to it (at
    /// the midpoint where they determine none); `None` where its star may have a boundary.
    ///
    /// Equal to the cost of the same place summed over the star but for rounding. O(faces at an end).
    pub(super) fn estimate(
        &self,
        live: &LiveMesh,
        edge: u32,
        options: &MemorylessOptions,
    ) -> Option<f64> {
        let [u, w] = live.edge(edge)?;
        let (at_u, at_w) = (*self.fans.get(u as usize)?, *self.fans.get(w as usize)?);
        if live.faces_at_edge(edge) != 2 || !live.has_closed_fan(u) || !live.has_closed_fan(w) {
            return None;
        }
        if live.valence(u) + live.valence(w) > STAR_LIMIT {
            return None;
        }
        let mut shared = Fan::default();
        for t in live.triangles_at(u) {
            if let Some(corners) = live.triangle(t).filter(|c| c.contains(&w)) {
                shared.add(area_normal(live, corners));
            }
        }
        let (p, q) = (live.position(u), live.position(w));
        let half = (q - p) * 0.5;
        let mut volume = Gradient::default();
        for i in 0..6 {
            volume.h.0[i] = at_u.matrix.0[i] + at_w.matrix.0[i] - shared.matrix.0[i];
        }
        volume.c = at_u.matrix.times(half) - at_w.matrix.times(half);
        let normal_sum = at_u.normal + at_w.normal - shared.normal;
        let volume_sum = (at_w.normal - at_u.normal).dot(half);
        let objective =
            Objective::without_boundary(normal_sum, volume_sum, volume, options.volume_weight);
        let v = objective.place_quickly().position.unwrap_or(DVec3::ZERO);
        let (from_u, from_w) = (v + half, v - half);
        let swept = from_u.dot(at_u.matrix.times(from_u)) + from_w.dot(at_w.matrix.times(from_w))
            - v.dot(shared.matrix.times(v));
        let cost = options.volume_weight * (swept.max(0.0) / 36.0);
        cost.is_finite().then_some(cost)
    }
}

fn area_normal(live: &LiveMesh, corners: [u32; 3]) -> DVec3 {
    geometry::area_normal(corners.each(|v| live.position(v)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        Silent,
        collapse::{EdgeStar, Engine, Observer, Rules, Schedule},
        mesh::{canonical, generate},
        simplify::memoryless::Memoryless,
        view::frame_of,
    };

    /// The estimate of every edge against the sums over its star; how many edges have one.
    fn compare(live: &LiveMesh, fans: &Fans) -> usize {
        let options = MemorylessOptions::default();
        let (mut star, mut estimated) = (EdgeStar::default(), 0);
        for edge in 0..live.edge_ids() {
            if !star.gather(live, edge) {
                continue;
            }
            let Some(estimate) = fans.estimate(live, edge, &options) else {
                let inside = star.boundary.is_empty() && star.edge_faces == 2;
                assert!(!inside, "edge {edge} has no estimate");
                continue;
            };
            let objective = Objective::of(&star, &options);
            // Where the shape of triangles decides, the estimate is that of the midpoint.
            let placement = objective.place();
            let place = match placement.position {
                Some(position) if placement.accepted[2] == 3 => position,
                _ => star.midpoint(),
            };
            let cost = objective.cost(&star, place);
            let scale = star.faces.iter().map(|f| f.normal.dot(f.normal));
            let noise = 1e-13 * scale.sum::<f64>() * (place - star.points[0]).length_squared();
            assert!(
                (cost - estimate).abs() <= 1e-6 * cost + noise,
                "edge {edge}: {estimate} instead of {cost}"
            );
            estimated += 1;
        }
        estimated
    }

    /// Follows every collapse, and compares with a fresh collection.
    struct Witness(Fans);

    impl Observer for Witness {
        fn committed(&mut self, live: &LiveMesh, patch: &Patch) {
            self.0.follow(live, patch);
            let fresh = Fans::of(live);
            for v in 0..live.vertex_ids() {
                if live.valence(v) > 0 {
                    let (a, b) = (self.0.fans[v as usize], fresh.fans[v as usize]);
                    assert_eq!(a, b, "vertex {v}");
                }
            }
        }
    }

    #[test]
    fn sums_that_follow_collapses_are_those_of_a_fresh_start_and_give_the_costs_of_rings() {
        for mesh in [
            generate::torus(1.0, 0.4, 16, 9),
            generate::grid(9, 9, generate::Height::Polynomial),
        ] {
            let mesh = canonical(&mesh).mesh;
            let live = LiveMesh::new(&mesh, frame_of(&mesh));
            let mut witness = Witness(Fans::of(&live));
            let before = compare(&live, &witness.0);
            let mut method = Memoryless::new(&live, MemorylessOptions::default());
            let mut engine = Engine::new(live, Rules::default(), Schedule::Eager);
            for triangles in [mesh.triangles().len() / 2, mesh.triangles().len() / 4] {
                let end = engine.run(&mut method, triangles, &mut witness, &Silent);
                end.expect("nobody interrupts");
                compare(engine.live(), &witness.0);
            }
            assert!(before > 40, "{before}");
        }
    }

    #[test]
    fn a_method_without_sums_estimates_nothing() {
        let mesh = canonical(&generate::icosphere(1)).mesh;
        let live = LiveMesh::new(&mesh, frame_of(&mesh));
        let options = MemorylessOptions::default();
        assert_eq!(Fans::default().estimate(&live, 0, &options), None);
        assert!(Fans::of(&live).estimate(&live, 0, &options).is_some());
    }
}
