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
    raster::{FaceGeometry, Scene, SceneEdit},
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
    points: [DVec3; 3],
    area_normal: DVec3,
}

impl ShadedFace {
    fn new(id: u32, corners: [u32; 3], points: [DVec3; 3]) -> Self {
        Self {
            id,
            corners,
            points,
            area_normal: FaceGeometry::new(points).area_normal,
        }
    }
}

/// Translates patches of the mesh to edits of the pictures; the buffers are reused.
#[derive(Clone, Debug)]
pub(super) struct Translator {
    /// The last patch, for an un-rendering engine.
    pub(super) edit: SceneEdit,
    vertices: Vec<u32>,
    faces: Vec<ShadedFace>,
}

impl Translator {
    /// For pictures with these numbers; `flat` where one of them needs the geometry of faces.
    pub(super) fn new(slots: &Slots, flat: bool) -> Self {
        let triangles = slots.triangles.iter().filter(|&&slot| slot != NONE).count();
        Self {
            edit: SceneEdit::new(triangles, flat || slots.color.is_some()),
            vertices: Vec::new(),
            faces: Vec::new(),
        }
    }

    /// Translates `patch`; the same before and after `live` has applied it. `gouraud` adds the changed normals and the
    /// triangles that they touch.
    pub(super) fn fill(&mut self, slots: &Slots, live: &LiveMesh, patch: &Patch, gouraud: bool) {
        self.edit.clear();
        if let Some(m) = patch.moved {
            self.edit
                .moved
                .push((slots.vertices[m.vertex as usize], m.to));
        }
        if gouraud {
            self.find_shaded(slots, live, patch);
        }
        let numbers = |corners: [u32; 3]| corners.each(|v| slots.vertices[v as usize]);
        for face in &patch.added {
            let (id, corners) = (slots.triangles[face.id as usize], numbers(face.corners));
            let colors = slots.colors(live, &patch.rows, face.wedges);
            let points = patch.after(live, face);
            self.edit.add(id, corners, points, colors);
        }
        if gouraud {
            // Other faces at these vertices look different too.
            let removed = |id: u32| patch.removed.binary_search_by_key(&id, |f| f.id).is_ok();
            for face in self.faces.iter().filter(|f| !removed(f.id)) {
                let (id, corners) = (slots.triangles[face.id as usize], numbers(face.corners));
                let colors = slots.colors(live, &patch.rows, live.wedges(face.id));
                self.edit.restyle(id, corners, face.points, colors);
            }
        }
        for face in &patch.removed {
            let id = slots.triangles[face.id as usize];
            self.edit.remove(id, numbers(face.corners));
        }
    }

    /// Finds the vertices whose normals may change with their new normals, and all faces at them after the change.
    fn find_shaded(&mut self, slots: &Slots, live: &LiveMesh, patch: &Patch) {
        // (1) All vertices of the removed faces, but for the one that is gone.
        self.vertices.clear();
        let corners = patch.removed.iter().flat_map(|face| face.corners);
        self.vertices
            .extend(corners.filter(|&v| Some(v) != patch.gone));
        self.vertices.sort_unstable();
        self.vertices.dedup();
        // (2) All faces at them, by ascending id.
        self.faces.clear();
        let removed = |id: u32| patch.removed.binary_search_by_key(&id, |f| f.id).is_ok();
        let added = patch.added.iter();
        let added = added.map(|f| ShadedFace::new(f.id, f.corners, patch.after(live, f)));
        self.faces.extend(added);
        for &v in &self.vertices {
            for id in live.triangles_at(v).filter(|&id| !removed(id)) {
                if let (Some(corners), Some(points)) = (live.triangle(id), live.points(id)) {
                    self.faces.push(ShadedFace::new(id, corners, points));
                }
            }
        }
        self.faces.sort_unstable_by_key(|f| f.id);
        self.faces.dedup_by_key(|f| f.id);
        // (3) The new normals, summed by ascending id.
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
            let mut change = Translator::new(&slots, true);
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
