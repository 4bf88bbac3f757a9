//! The edit of the scene in the pictures that a patch of the mesh makes.
//!
//! The pictures number vertices and triangles without gaps, in the order of the mesh's own ids, so that ties of depth
//! are decided the same way. With Gouraud shading a collapse changes the normals of the whole link, and with them the
//! shading of one more ring of triangles (Lindstrom & Turk 2000, footnote 3).

use glam::DVec3;

use crate::{
    collapse::{LiveMesh, NONE, Patch},
    mesh::{Channel, ChannelKind},
    num::{Each, math::unit},
    raster::{Added, FaceGeometry, Scene, SceneEdit},
};

/// Numbers of the mesh's triangles and vertices in the pictures.
#[derive(Clone, Debug)]
pub(super) struct Slots {
    triangles: Vec<u32>,
    vertices: Vec<u32>,
    color: Option<Channel>,
}

impl Slots {
    /// Numbers the living triangles and their vertices, and gives the scene that they are.
    pub(super) fn of(live: &LiveMesh) -> (Self, Scene) {
        let channels = live.rows().channels();
        let color = [ChannelKind::Color, ChannelKind::ColorAlpha];
        let mut slots = Self {
            triangles: vec![NONE; live.triangle_ids() as usize],
            vertices: vec![NONE; live.vertex_ids() as usize],
            color: channels.iter().copied().find(|c| color.contains(&c.kind)),
        };
        let (mut positions, mut triangles, mut colors) = (Vec::new(), Vec::new(), Vec::new());
        for id in 0..live.triangle_ids() {
            let Some(corners) = live.triangle(id) else {
                continue;
            };
            slots.triangles[id as usize] = triangles.len() as u32;
            if slots.color.is_some() {
                colors.push(slots.colors(live, &[], live.wedges(id)));
            }
            triangles.push(corners.each(|v| {
                let slot = &mut slots.vertices[v as usize];
                if *slot == NONE {
                    *slot = positions.len() as u32;
                    positions.push(live.position(v));
                }
                *slot
            }));
        }
        let ids = (0..triangles.len() as u32).collect();
        (
            slots,
            Scene::new(positions, triangles, ids).with_colors(colors),
        )
    }

    /// Corner colours of a triangle with these wedges; `rows` holds wedges that the mesh does not have yet.
    fn colors(&self, live: &LiveMesh, rows: &[f64], wedges: [u32; 3]) -> [[f64; 3]; 3] {
        let Some(channel) = self.color else {
            return [[1.0; 3]; 3];
        };
        wedges.each(|w| {
            let row = if w < live.wedge_count() {
                live.rows().row(w)
            } else {
                let stride = live.rows().stride();
                &rows[(w - live.wedge_count()) as usize * stride..][..stride]
            };
            let v = &row[channel.offset..];
            if v[0].is_nan() {
                [1.0; 3]
            } else {
                [v[0], v[1], v[2]]
            }
        })
    }
}

/// A triangle after the change, at a vertex whose normal may change.
#[derive(Clone, Copy, Debug)]
struct ShadedFace {
    id: u32,
    corners: [u32; 3],
    area_normal: DVec3,
}

/// Translates patches of the mesh to edits of the pictures; the buffers are reused.
#[derive(Clone, Debug, Default)]
pub(super) struct Translator {
    /// The last patch, for an un-rendering engine.
    pub(super) edit: SceneEdit,
    vertices: Vec<u32>,
    faces: Vec<ShadedFace>,
}

impl Translator {
    /// Translates `patch`; the same before and after `live` has applied it. `gouraud` adds the changed normals and the
    /// triangles that they touch.
    pub(super) fn fill(&mut self, slots: &Slots, live: &LiveMesh, patch: &Patch, gouraud: bool) {
        self.edit.removed.clear();
        self.edit.added.clear();
        self.edit.moved.clear();
        self.edit.normals.clear();
        let triangle = |id: u32| slots.triangles[id as usize];
        self.edit
            .removed
            .extend(patch.removed.iter().map(|face| triangle(face.id)));
        self.edit.added.extend(patch.added.iter().map(|face| Added {
            id: triangle(face.id),
            corners: face.corners.each(|v| slots.vertices[v as usize]),
            colors: slots.colors(live, &patch.rows, face.wedges),
        }));
        self.edit.moved.extend(
            patch
                .moved
                .iter()
                .map(|m| (slots.vertices[m.vertex as usize], m.to)),
        );
        if gouraud {
            self.shade(slots, live, patch);
        }
    }

    fn shade(&mut self, slots: &Slots, live: &LiveMesh, patch: &Patch) {
        // (1) The vertices whose normals can change: all of the removed faces, but for the one that is gone.
        self.vertices.clear();
        let corners = patch.removed.iter().flat_map(|face| face.corners);
        self.vertices
            .extend(corners.filter(|&v| Some(v) != patch.gone));
        self.vertices.sort_unstable();
        self.vertices.dedup();
        // (2) All faces at them after the change, by ascending id.
        self.faces.clear();
        let removed = |id: u32| patch.removed.binary_search_by_key(&id, |f| f.id).is_ok();
        for face in &patch.added {
            let points = patch.after(live, face);
            self.faces.push(ShadedFace {
                id: face.id,
                corners: face.corners,
                area_normal: FaceGeometry::new(points).area_normal,
            });
        }
        let own = self.faces.len();
        for &v in &self.vertices {
            for id in live.triangles_at(v).filter(|&id| !removed(id)) {
                if let (Some(corners), Some(points)) = (live.triangle(id), live.points(id)) {
                    self.faces.push(ShadedFace {
                        id,
                        corners,
                        area_normal: FaceGeometry::new(points).area_normal,
                    });
                }
            }
        }
        // (3) Those that are not part of the patch look different too.
        self.faces[own..].sort_unstable_by_key(|f| f.id);
        self.faces.dedup_by_key(|f| f.id);
        for face in &self.faces[own..] {
            let id = slots.triangles[face.id as usize];
            self.edit.removed.push(id);
            self.edit.added.push(Added {
                id,
                corners: face.corners.each(|v| slots.vertices[v as usize]),
                colors: slots.colors(live, &patch.rows, live.wedges(face.id)),
            });
        }
        // (4) The new normals, summed by ascending id.
        self.faces.sort_unstable_by_key(|f| f.id);
        for &v in &self.vertices {
            let at = self.faces.iter().filter(|f| f.corners.contains(&v));
            let sum = at.fold(DVec3::ZERO, |sum, f| sum + f.area_normal);
            let normal = unit(sum).unwrap_or(DVec3::ZERO);
            self.edit.normals.push((slots.vertices[v as usize], normal));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        collapse::{Changes, EdgeStar, Rules, Site},
        mesh::{canonical, generate},
        view::frame_of,
    };

    #[test]
    fn the_normals_of_a_change_are_those_of_the_changed_mesh_to_the_last_bit() {
        let mesh = canonical(&generate::textured_torus(14, 9)).mesh;
        let mut live = LiveMesh::new(&mesh, frame_of(&mesh));
        let mut tested = 0;
        for edge in (0..live.edge_ids()).step_by(3) {
            let mut star = EdgeStar::default();
            if !star.gather(&live, edge) {
                continue;
            }
            let Ok(site) = Site::new(&live, &star, Rules::default()) else {
                continue;
            };
            let middle = site.fixed().unwrap_or_else(|| star.midpoint());
            let Ok(position) = site.admit(middle) else {
                continue;
            };
            let mut patch = Patch::default();
            site.patch(position, &mut patch);
            let (slots, _) = Slots::of(&live);
            let mut change = Translator::default();
            change.fill(&slots, &live, &patch, true);
            let before = change.edit.normals.clone();
            live.apply(&patch, &mut Changes::default());
            change.fill(&slots, &live, &patch, true);
            assert_eq!(
                change.edit.normals, before,
                "the same before and after the commit"
            );
            let ids: Vec<u32> = (0..live.triangle_ids())
                .filter(|&t| live.triangle(t).is_some())
                .collect();
            let triangles = ids.iter().filter_map(|&t| live.triangle(t)).collect();
            let fresh = Scene::new(live.positions().to_vec(), triangles, ids);
            for &(slot, normal) in &before {
                let vertex = slots.vertices.iter().position(|&s| s == slot);
                let expected = fresh.normals()[vertex.expect("a numbered vertex")];
                assert_eq!(
                    normal.to_array().map(f64::to_bits),
                    expected.to_array().map(f64::to_bits)
                );
                tested += 1;
            }
        }
        assert!(tested > 100, "{tested}");
    }
}
