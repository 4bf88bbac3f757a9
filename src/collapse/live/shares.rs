//! Shares: a target of its own for every mesh of a document.

use super::LiveMesh;
use crate::mesh::Materials;

/// The meshes of a document, and the triangles that each is to keep.
#[derive(Clone, Debug, Default)]
pub(super) struct Shares {
    /// The mesh of every material (a part of a document is one).
    mesh_of: Vec<usize>,
    /// Triangles of every mesh at first, now, and at last.
    counts: Vec<[usize; 3]>,
}

impl Shares {
    /// The meshes of the document; none where there are fewer than two.
    fn of(materials: &Materials) -> Self {
        let Some(asset) = &materials.asset else {
            return Self::default();
        };
        let mut meshes = Vec::new();
        let mesh_of = materials.names.iter().map(|name| {
            let part = asset.parts.iter().find(|part| part.name == *name);
            let mesh = part.map(|part| part.mesh);
            meshes.iter().position(|&m| m == mesh).unwrap_or_else(|| {
                meshes.push(mesh);
                meshes.len() - 1
            })
        });
        let mesh_of = mesh_of.collect();
        if meshes.len() < 2 {
            return Self::default();
        }
        Self {
            mesh_of,
            counts: vec![[0; 3]; meshes.len()],
        }
    }

    fn mesh(&self, material: u32) -> Option<usize> {
        self.mesh_of.get(material as usize).copied()
    }

    /// A triangle of a material comes or goes.
    pub(super) fn count(&mut self, material: u32, comes: bool) {
        if let Some([_, now, _]) = self.mesh(material).map(|mesh| &mut self.counts[mesh]) {
            *now = if comes { *now + 1 } else { *now - 1 };
        }
    }
}

impl LiveMesh {
    /// Gives every mesh of the document this share of its triangles at first as its target, and returns their sum; `None`
    /// where there are fewer than two meshes.
    pub fn set_shares(&mut self, share: f64) -> Option<usize> {
        if self.shares.counts.is_empty() {
            self.shares = Shares::of(&self.materials);
            for t in 0..self.triangle_ids() {
                if self.triangle(t).is_some() {
                    self.shares.count(self.materials.of(t as usize), true);
                }
            }
            for [first, now, _] in &mut self.shares.counts {
                *first = *now;
            }
        }
        for [first, _, last] in &mut self.shares.counts {
            *last = ((*first as f64 * share).ceil() as usize).max(1);
        }
        self.shares_sum()
    }

    /// The sum of the targets of all meshes, where they have some.
    fn shares_sum(&self) -> Option<usize> {
        let last = self.shares.counts.iter().map(|[_, _, last]| last);
        (!self.shares.counts.is_empty()).then(|| last.sum())
    }

    /// True where no more than `triangles` are left, and no mesh has more than its share where that is the sum of them.
    pub(in crate::rooms::collapse) fn is_small_enough(&self, triangles: usize) -> bool {
        let all = || self.shares.counts.iter().all(|[_, now, last]| now <= last);
        self.triangle_count() <= triangles
            && (self.shares_sum().is_none_or(|sum| sum < triangles) || all())
    }

    /// True where one of these triangles belongs to a mesh that has no more than its share.
    pub(in crate::rooms::collapse) fn has_its_share(
        &self,
        mut triangles: impl Iterator<Item = u32>,
    ) -> bool {
        let counts = &self.shares.counts;
        !counts.is_empty()
            && triangles.any(|t| {
                let mesh = self.shares.mesh(self.material(t));
                mesh.is_some_and(|mesh| counts[mesh][1] <= counts[mesh][2])
            })
    }
}
