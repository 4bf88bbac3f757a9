//! Weights of the vertices of an input: where a run keeps more triangles, and what must stay. The law by which they make
//! collapses dearer is that of [`Price`](crate::collapse::Price).

use std::sync::Arc;

use glam::DVec3;
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

use super::Options;
use crate::{Error, Result, collapse::LiveMesh, mesh::Mesh, num::Each};

/// A weight for every vertex of a mesh, from 0 (as the method has it) to 1 (the vertex stays where it is).
///
/// A record of options has their number and their SHA-256 instead (of the 32-bit floats, little-endian): weights that
/// were read from one say so when a run asks for them.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Weights {
    #[serde(skip)]
    of_vertices: Arc<[f32]>,
    vertices: usize,
    sha256: String,
}

impl Weights {
    /// Weights in the order of the vertices. O(n).
    #[must_use]
    pub fn new(of_vertices: Vec<f32>) -> Self {
        let mut hash = Sha256::new();
        for weight in &of_vertices {
            hash.update(weight.to_le_bytes());
        }
        let sha256 = hash.finalize().iter().map(|b| format!("{b:02x}")).collect();
        Self {
            vertices: of_vertices.len(),
            of_vertices: of_vertices.into(),
            sha256,
        }
    }

    /// The first vertex whose weight is no number from 0 to 1, with its weight.
    pub(crate) fn first_wrong(of_vertices: &[f32]) -> Option<(usize, f32)> {
        let mut all = of_vertices.iter().copied().enumerate();
        all.find(|(_, weight)| !(0.0..=1.0).contains(weight))
    }

    /// Tests that every weight is one.
    ///
    /// # Errors
    /// [`Error::Usage`] that names the first vertex with another one.
    pub(super) fn check(&self) -> Result<()> {
        match Self::first_wrong(&self.of_vertices) {
            Some((vertex, weight)) => Err(Error::Usage(format!(
                "the weight of vertex {vertex} is {weight}; expected a number from 0 to 1"
            ))),
            None => Ok(()),
        }
    }

    /// The weights, where they are those of the vertices of `mesh` by number.
    ///
    /// # Errors
    /// [`Error::Usage`] for another number, and for weights of which only the hash was recorded.
    pub(super) fn of_mesh(&self, mesh: &Mesh) -> Result<&[f32]> {
        if self.of_vertices.len() != self.vertices {
            return Err(Error::Usage(
                "the weights were recorded by their hash alone; give them again, with Options::weights".into(),
            ));
        }
        let (weights, vertices) = (self.vertices, mesh.positions().len());
        if weights != vertices {
            return Err(Error::Usage(format!(
                "{weights} weights for a mesh of {vertices} vertices; expected one for each, in the order of the mesh"
            )));
        }
        Ok(&self.of_vertices)
    }
}

/// The account of the weights of a run.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct WeightsReport {
    /// Number of vertices of the input that have weight 1.
    pub locked: usize,
    /// Number of those whose very places are vertices of the result: all of them, unless the input has vertices that no
    /// triangle uses, or none but such as repeat a vertex.
    pub held: usize,
    /// Mean weight of the vertices of the result, each with the largest weight of all that became it.
    pub mean_kept: f64,
    /// Mean weight of the vertices that are gone: of every two that became one, the lighter; 0 where none is gone.
    pub mean_removed: f64,
}

impl WeightsReport {
    /// The account of a run from `input` to `result`, which was `live` at last. O(n log n).
    pub(super) fn of(weights: &Weights, input: &Mesh, live: &LiveMesh, result: &Mesh) -> Self {
        // Adding +0 turns -0 into +0 and changes nothing else.
        let bits = |p: DVec3| (p + DVec3::ZERO).to_array().each(f64::to_bits);
        let mut places: Vec<_> = result.positions().iter().map(|&p| bits(p)).collect();
        places.sort_unstable();
        let all = input.positions().iter().zip(weights.of_vertices.iter());
        let locked = all.filter(|&(_, &weight)| weight >= 1.0);
        let held = locked
            .clone()
            .filter(|&(&p, _)| places.binary_search(&bits(p)).is_ok());
        let sum = |weights: &[f32]| weights.iter().map(|&w| f64::from(w)).sum::<f64>();
        let mut used = vec![false; input.positions().len()];
        let whole = |&&[a, b, c]: &&[u32; 3]| a != b && b != c && c != a;
        for &v in input.triangles().iter().filter(whole).flatten() {
            used[v as usize] = true;
        }
        let before = weights
            .of_vertices
            .iter()
            .zip(used)
            .filter(|&(_, used)| used);
        let before: Vec<f32> = before.map(|(&weight, _)| weight).collect();
        let after = live.weights_in_use();
        let gone = before.len().saturating_sub(after.len());
        let mean = |sum: f64, count: usize| sum / count.max(1) as f64;
        Self {
            locked: locked.clone().count(),
            held: held.count(),
            mean_kept: mean(sum(&after), after.len()),
            mean_removed: mean(sum(&before) - sum(&after), gone),
        }
    }
}

/// # The step for regions
impl Options {
    /// Keeps more triangles where vertices weigh more: one weight for every vertex of the mesh, 0 to 1. A vertex of weight 1
    /// stays where it is, whatever else gives way; below, a collapse costs `1 / (1 - w)` times as much, `w` being the
    /// larger weight of the two vertices that it puts together, of those that may move. A change for the better counts
    /// `1 - w` times. A new vertex has the larger weight of both.
    ///
    /// The order is that of the mesh. [`Mesh::read`] welds and reorders: take the weights from the places of its vertices,
    /// or from their colours.
    ///
    /// ```
    /// use lodmark::{Mesh, Options, Target, simplify};
    ///
    /// # let place = |i: u32| [(i % 17) as f32, (i / 17) as f32, ((i * i) % 7) as f32];
    /// # let corners: Vec<f32> = (0..289).flat_map(place).collect();
    /// # let quad = |i: u32| [i, i + 1, i + 17, i + 1, i + 18, i + 17];
    /// # let faces: Vec<u32> = (0..272).filter(|i| i % 17 < 16).flat_map(quad).collect();
    /// let mesh = Mesh::from_slices(&corners, &faces)?;
    /// // The left edge stays, its neighbourhood is worth ten times as much.
    /// let weight = |x: f64| if x == 0.0 { 1.0 } else if x < 4.0 { 0.9 } else { 0.0 };
    /// let weights = mesh.positions().iter().map(|p| weight(p.x)).collect();
    /// let options = Options::memoryless(Target::ratio(0.25)).weights(weights);
    /// let outcome = simplify(&mesh, &options)?;
    /// let held = outcome.weights.expect("weights were given");
    /// assert_eq!((held.locked, held.held), (17, 17));
    /// assert!(held.mean_removed < held.mean_kept);
    /// # Ok::<(), lodmark::Error>(())
    /// ```
    #[must_use]
    pub fn weights(mut self, of_vertices: Vec<f32>) -> Self {
        self.weights = Some(Weights::new(of_vertices));
        self
    }
}
