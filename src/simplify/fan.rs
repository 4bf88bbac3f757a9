//! Sums over the faces around every vertex, from which the memoryless cost of an edge follows without a look at its ring.
//!
//! The planes of the faces at a vertex `u` pass through it: seen from `u`, the volume that a face sweeps when the
//! vertex moves to `v` is `n . (v - u) / 6`, without a constant. So the sums of Lindstrom & Turk 1998 over the ring of
//! an edge are those at one end plus those at the other minus those of the faces at both, of which each has `n` only.
//! Only for edges whose ring has no boundary edge; the sums follow every collapse, recomputed from the faces by
//! ascending id. Units: as the frame's, `n` is twice a face's area along its normal.

use glam::DVec3;

use super::memoryless::{Gradient, MemorylessOptions, Objective};
use crate::collapse::{LiveMesh, Patch, legality::RING_LIMIT};

/// The sums at one vertex.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Fan {
    /// Sum of `n n^T`, as `[xx, xy, xz, yy, yz, zz]`.
    matrix: [f64; 6],
    /// Sum of `n`.
    normal: DVec3,
}

impl Fan {
    fn add(&mut self, n: DVec3) {
        self.normal += n;
        for (m, p) in self.matrix.iter_mut().zip(outer(n)) {
            *m += p;
        }
    }
}

fn outer(n: DVec3) -> [f64; 6] {
    [
        n.x * n.x,
        n.x * n.y,
        n.x * n.z,
        n.y * n.y,
        n.y * n.z,
        n.z * n.z,
    ]
}

/// The sums at every vertex of a mesh. Empty: nothing can be estimated.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Fans {
    fans: Vec<Fan>,
    ids: Vec<u32>,
    touched: Vec<u32>,
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
        for v in patch.removed.iter().flat_map(|f| f.corners) {
            if !touched.contains(&v) {
                touched.push(v);
            }
        }
        for &v in &touched {
            // Its edges are no candidates; a collapse that brings it below the limit comes by here.
            if live.valence(v) <= RING_LIMIT {
                self.collect(live, v);
            }
        }
        self.touched = touched;
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
    /// the midpoint where they determine none); `None` where its ring may have a boundary.
    ///
    /// Equal to the cost of the same place summed over the ring but for rounding. O(faces at an end).
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
        if live.valence(u) + live.valence(w) > RING_LIMIT {
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
            volume.h[i] = at_u.matrix[i] + at_w.matrix[i] - shared.matrix[i];
        }
        volume.c = product(&at_u.matrix, half) - product(&at_w.matrix, half);
        let normal_sum = at_u.normal + at_w.normal - shared.normal;
        let volume_sum = (at_w.normal - at_u.normal).dot(half);
        let objective =
            Objective::without_boundary(normal_sum, volume_sum, volume, options.volume_weight);
        let v = objective.place().position.unwrap_or(DVec3::ZERO);
        let (from_u, from_w) = (v + half, v - half);
        let swept = from_u.dot(product(&at_u.matrix, from_u))
            + from_w.dot(product(&at_w.matrix, from_w))
            - v.dot(product(&shared.matrix, v));
        let cost = options.volume_weight * (swept.max(0.0) / 36.0);
        cost.is_finite().then_some(cost)
    }
}

fn area_normal(live: &LiveMesh, corners: [u32; 3]) -> DVec3 {
    let [a, b, c] = corners.map(|v| live.position(v));
    (b - a).cross(c - a)
}

fn product([xx, xy, xz, yy, yz, zz]: &[f64; 6], v: DVec3) -> DVec3 {
    DVec3::new(
        xx * v.x + xy * v.y + xz * v.z,
        xy * v.x + yy * v.y + yz * v.z,
        xz * v.x + yz * v.y + zz * v.z,
    )
}
