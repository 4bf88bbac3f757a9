//! Weights of vertices, 0 to 1: collapses that move a vertex are the dearer the more it weighs, and one of weight 1 is
//! locked. Not in the papers.
//!
//! The law: where `w` is the larger weight of the ends of an edge that are not locked, the queue sees every key of its
//! collapse (cost of pictures, geometric cost, squared length) divided by `1 - w` where it is positive, and multiplied by
//! `1 - w` where it is negative: a change for the better stays one, but is less wanted. What costs nothing goes on
//! costing nothing, and the next key decides. A vertex that is merged into another leaves it the larger weight.
//!
//! `1 - w` is a whole number of 1/65536, at least one of them: counts stay integers, and the keys of edges that weigh the
//! same are in the order that they would have without weights, those of negative counts that round to one value excepted,
//! which their second key then parts. Weights are in the queue alone: methods, limits of errors and reports see the true
//! costs.

use super::LiveMesh;

/// Parts of 1 in which weights are measured.
const WHOLE: u32 = 1 << 16;

/// The factor by which the collapses of an edge are dearer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Price {
    /// `1 - w` in 1/65536: 1 to 65536.
    rest: u32,
}

impl Price {
    /// The price of weight `weight`, 0 to 1.
    #[must_use]
    pub fn of_weight(weight: f32) -> Self {
        let rest = (1.0 - f64::from(weight)) * f64::from(WHOLE);
        // `as` takes NaN and what is negative to 0.
        let rest = (rest + 0.5) as u32;
        Self {
            rest: rest.clamp(1, WHOLE),
        }
    }

    /// An exact cost at this price: rounded down, at most the largest number there is.
    #[must_use]
    pub fn of_count(self, cost: i64) -> i64 {
        let (rest, whole) = (i128::from(self.rest), i128::from(WHOLE));
        let cost = i128::from(cost);
        let dear = if cost > 0 {
            cost * whole / rest
        } else {
            (cost * rest).div_euclid(whole)
        };
        i64::try_from(dear).unwrap_or(i64::MAX)
    }

    /// A cost at this price.
    #[must_use]
    pub fn of(self, cost: f64) -> f64 {
        let (rest, whole) = (f64::from(self.rest), f64::from(WHOLE));
        if cost > 0.0 {
            cost * (whole / rest)
        } else {
            cost * (rest / whole)
        }
    }
}

impl LiveMesh {
    /// Gives every vertex its weight, and locks those of weight 1. Weights that are all 0 are none.
    ///
    /// # Panics
    /// Where there are not as many as vertex ids.
    pub fn weigh(&mut self, weights: &[f32]) {
        assert_eq!(weights.len(), self.positions.len(), "a weight per vertex");
        if weights.iter().all(|&weight| weight <= 0.0) {
            return;
        }
        self.weights = weights.to_vec();
        for (locked, &weight) in self.locked.iter_mut().zip(weights) {
            *locked |= weight >= 1.0;
        }
    }

    /// The weight of a vertex: the largest of all that became it.
    #[must_use]
    pub fn weight(&self, vertex: u32) -> f32 {
        self.weights.get(vertex as usize).copied().unwrap_or(0.0)
    }

    /// The weights of the vertices that triangles use, by ascending id as [`LiveMesh::to_mesh`] keeps them.
    #[must_use]
    pub fn weights_in_use(&self) -> Vec<f32> {
        let ids = 0..self.vertex_ids();
        let used = ids.filter(|&v| self.valence(v) > 0);
        used.map(|v| self.weight(v)).collect()
    }

    /// The price of the collapses of an edge; `None` where nothing makes them dearer.
    #[inline]
    pub(super) fn price(&self, ends: [u32; 2]) -> Option<Price> {
        if self.weights.is_empty() {
            return None;
        }
        let free = ends.into_iter().filter(|&v| !self.is_locked(v));
        let weight = free.map(|v| self.weight(v)).fold(0.0, f32::max);
        Some(Price::of_weight(weight))
    }

    /// Leaves `keep` the larger weight when `gone` becomes it.
    pub(super) fn take_weight(&mut self, keep: u32, gone: u32) {
        let gone = self.weight(gone);
        if let Some(weight) = self.weights.get_mut(keep as usize) {
            *weight = weight.max(gone);
        }
    }
}
