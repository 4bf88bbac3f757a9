//! Locks: curves of the input whose vertices stay where they are, whatever else gives way. Weights lock single vertices
//! ([`super::weights`]).

use serde::{Deserialize, Serialize};

use super::{EdgeStar, LiveMesh, NONE, wedge};
use crate::{mesh::ChannelKind, num::Each};

/// Curves whose vertices keep their places, whatever else gives way.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Locks {
    /// Edges with one triangle.
    pub border: bool,
    /// Edges where texture coordinates or colours jump, or a texture is mirrored.
    pub seams: bool,
    /// Edges between materials, or between the parts of a document.
    pub materials: bool,
}

impl Locks {
    /// True where nothing is locked.
    #[must_use]
    pub fn is_none(&self) -> bool {
        *self == Self::default()
    }
}

impl EdgeStar {
    /// True where the collapse would leave a locked vertex without a face, and so without a place in the result; it
    /// `vanishes` where no face of the star stays.
    pub(super) fn takes_locked(&self, live: &LiveMesh, vanishes: bool) -> bool {
        if vanishes && self.ends.iter().any(|&v| live.is_locked(v)) {
            return true;
        }
        let gone = self.faces.iter().filter(|f| !f.survives);
        let mut beside = gone.clone().flat_map(|f| f.corners);
        beside.any(|v| {
            let around = || gone.clone().filter(|f| f.corners.contains(&v)).count();
            live.is_locked(v) && !self.ends.contains(&v) && around() >= live.valence(v)
        })
    }
}

impl LiveMesh {
    /// Locks the vertices of the chosen curves besides those that are locked. O(n log n).
    pub fn lock(&mut self, locks: Locks) {
        if locks.is_none() {
            return;
        }
        for edge in 0..self.edge_ids() {
            if let Some(ends) = self
                .edge(edge)
                .filter(|&ends| self.is_on(locks, edge, ends))
            {
                for v in ends {
                    self.set_locked(v, true);
                }
            }
        }
    }

    /// Number of locked vertices.
    #[must_use]
    pub fn locked_vertices(&self) -> usize {
        self.locked.iter().filter(|&&locked| locked).count()
    }

    fn is_on(&self, locks: Locks, edge: u32, ends: [u32; 2]) -> bool {
        let count = self.faces_at_edge(edge);
        if count < 2 {
            return locks.border;
        }
        let [near, far] = if self.valence(ends[0]) <= self.valence(ends[1]) {
            ends
        } else {
            [ends[1], ends[0]]
        };
        let mut faces = self.triangles_at(near).filter_map(|id| {
            let corners = self.triangle(id)?;
            let at = [near, far].each(|v| corners.iter().position(|&c| c == v));
            Some((id, [at[0]?, at[1]?]))
        });
        let Some((first, first_at)) = faces.next() else {
            return false;
        };
        let seam = |kind: ChannelKind| locks.seams && wedge::makes_features(kind);
        faces.any(|(other, other_at)| {
            let border = self.material(first) != self.material(other);
            border && locks.materials
                || !border
                    && self.wedges(first)[0] != NONE
                    && wedge::differ(
                        self,
                        [first, other].each(|id| (id, self.wedges(id))),
                        [first_at, other_at],
                        seam,
                    )
        })
    }
}
