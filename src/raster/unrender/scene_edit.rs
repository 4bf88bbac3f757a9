//! [`SceneEdit`]: a change of the mesh as the pictures see it, with all that is the same in every view; and the [`Model`]
//! that it changes.

use glam::DVec3;

use crate::{
    raster::{FaceGeometry, Scene},
    view::{Interpolation, ViewSet},
};

/// No entry.
const NONE: u32 = u32::MAX;

/// A corner of a triangle after an edit.
#[derive(Clone, Copy, Debug)]
pub(super) struct EditedCorner {
    pub(super) vertex: u32,
    moved: u32,
    shaded: u32,
}

impl EditedCorner {
    /// The entry of the vertex in [`SceneEdit::moved`], if it moves.
    #[inline]
    pub(super) fn moved(self) -> Option<usize> {
        (self.moved != NONE).then_some(self.moved as usize)
    }

    /// The entry of the vertex in [`SceneEdit::normals`], if its normal changes.
    #[inline]
    pub(super) fn shaded(self) -> Option<usize> {
        (self.shaded != NONE).then_some(self.shaded as usize)
    }
}

/// Attributes at the corners of a triangle that pictures show.
#[derive(Clone, Copy, Debug, Default)]
pub struct CornerValues {
    /// Red, green and blue; ignored where the model is white.
    pub colors: [[f64; 3]; 3],
    /// Unit normals, zero where the mesh stores none; ignored where the model has none.
    pub normals: [DVec3; 3],
}

/// A triangle after an edit.
#[derive(Clone, Copy, Debug)]
pub(super) struct EditedFace {
    pub(super) id: u32,
    pub(super) corners: [EditedCorner; 3],
    pub(super) positions: [DVec3; 3],
    pub(super) values: CornerValues,
    /// Normal and centroid, for flat shading; zeros where no view needs them.
    pub(super) geometry: FaceGeometry,
}

/// A change of the mesh, as the pictures see it: an edge collapse, a move, a flip, a removal. Reused as a buffer.
///
/// Filled after [`SceneEdit::clear`]: first what moves and the normals; then the triangles that come
/// ([`SceneEdit::add`]) or look different ([`SceneEdit::restyle`]), and those that go ([`SceneEdit::remove`]).
#[derive(Clone, Debug, Default)]
pub struct SceneEdit {
    /// New positions; every triangle at such a vertex goes.
    pub moved: Vec<(u32, DVec3)>,
    /// Where a view is Gouraud shaded: unit normals of all vertices that move (the light falls on them from elsewhere,
    /// even where their normals stay as they are) or whose normals change; every triangle at them goes or looks
    /// different.
    pub normals: Vec<(u32, DVec3)>,
    /// Triangles that disappear or change their shape.
    pub(super) gone: Vec<u32>,
    /// Triangles that appear or have changed their shape.
    pub(super) fresh: Vec<EditedFace>,
    /// Triangles that stay where they are and look different.
    pub(super) restyled: Vec<EditedFace>,
    /// Vertices of fresh triangles that do not move.
    pub(super) rim: Vec<u32>,
    /// Vertices of gone triangles that are not in the rim.
    pub(super) inside: Vec<u32>,
    /// Entries of `moved` that fresh triangles use.
    pub(super) movers: Vec<u32>,
    /// By triangle: 0 stays, 1 goes, more is restyled.
    fates: Vec<u16>,
    flat: bool,
}

impl SceneEdit {
    /// Buffers for a scene with this number of triangles; `flat` where a view needs the geometry of faces.
    pub fn new(triangles: usize, flat: bool) -> Self {
        Self {
            // One more for samples that nothing covers.
            fates: vec![0; triangles + 1],
            flat,
            ..Self::default()
        }
    }

    /// Forgets the last edit.
    pub fn clear(&mut self) {
        for &id in &self.gone {
            self.fates[id as usize] = 0;
        }
        for face in &self.restyled {
            self.fates[face.id as usize] = 0;
        }
        for list in [&mut self.moved, &mut self.normals] {
            list.clear();
        }
        for list in [
            &mut self.gone,
            &mut self.rim,
            &mut self.inside,
            &mut self.movers,
        ] {
            list.clear();
        }
        self.fresh.clear();
        self.restyled.clear();
    }

    /// A triangle comes, or has changed its shape: then it also goes.
    pub fn add(&mut self, id: u32, corners: [u32; 3], positions: [DVec3; 3], values: CornerValues) {
        let face = self.face(id, corners, positions, values);
        for corner in face.corners {
            match corner.moved() {
                Some(_) => note(&mut self.movers, corner.moved),
                None => note(&mut self.rim, corner.vertex),
            }
        }
        self.fresh.push(face);
    }

    /// A triangle stays where it is and looks different.
    pub fn restyle(
        &mut self,
        id: u32,
        corners: [u32; 3],
        positions: [DVec3; 3],
        values: CornerValues,
    ) {
        let Ok(fate) = u16::try_from(self.restyled.len() + 2) else {
            self.add(id, corners, positions, values);
            return self.remove(id, corners);
        };
        self.fates[id as usize] = fate;
        let face = self.face(id, corners, positions, values);
        self.restyled.push(face);
    }

    /// A triangle with these corners goes.
    pub fn remove(&mut self, id: u32, corners: [u32; 3]) {
        self.fates[id as usize] = 1;
        self.gone.push(id);
        for v in corners {
            if !self.rim.contains(&v) {
                note(&mut self.inside, v);
            }
        }
    }

    fn face(
        &self,
        id: u32,
        corners: [u32; 3],
        positions: [DVec3; 3],
        values: CornerValues,
    ) -> EditedFace {
        let entry = |list: &[(u32, DVec3)], v: u32| {
            let found = list.iter().position(|e| e.0 == v);
            found.map_or(NONE, |i| i as u32)
        };
        EditedFace {
            id,
            corners: corners.map(|vertex| EditedCorner {
                vertex,
                moved: entry(&self.moved, vertex),
                shaded: entry(&self.normals, vertex),
            }),
            positions,
            values,
            geometry: if self.flat {
                FaceGeometry::new(positions)
            } else {
                FaceGeometry::default()
            },
        }
    }

    /// The triangles that come or look different.
    pub(super) fn after(&self) -> impl Iterator<Item = &EditedFace> {
        self.fresh.iter().chain(&self.restyled)
    }

    /// The triangles that go or look different.
    pub(super) fn before(&self) -> impl Iterator<Item = u32> {
        let restyled = self.restyled.iter().map(|face| face.id);
        self.gone.iter().copied().chain(restyled)
    }

    /// By triangle: 1 where it goes. For tight loops; see [`SceneEdit::goes`].
    #[inline]
    pub(super) fn fates(&self) -> &[u16] {
        &self.fates
    }

    /// True where the triangle goes.
    #[inline]
    pub(super) fn goes(&self, id: u32) -> bool {
        self.fates[id as usize] == 1
    }

    /// The triangle as it looks after the edit, where it stays in its place and looks different.
    #[inline]
    pub(super) fn restyled(&self, id: u32) -> Option<&EditedFace> {
        let index = self.fates[id as usize].checked_sub(2)?;
        Some(&self.restyled[usize::from(index)])
    }
}

fn note(list: &mut Vec<u32>, entry: u32) {
    if !list.contains(&entry) {
        list.push(entry);
    }
}

/// The mesh that the pictures show: what does not depend on the view.
#[derive(Clone, Debug)]
pub struct Model {
    pub(super) positions: Vec<DVec3>,
    /// Vertices by triangle id.
    pub(super) corners: Vec<[u32; 3]>,
    /// Unit vertex normals; empty where no view needs them.
    pub(super) normals: Vec<DVec3>,
    /// Corner colours by triangle id; empty where everything is white.
    pub(super) colors: Vec<[[f64; 3]; 3]>,
    /// Stored corner normals by triangle id; empty where no view needs them, or the mesh stores none.
    pub(super) stored_normals: Vec<[DVec3; 3]>,
}

impl Model {
    /// The model of a scene whose ids count from 0 without gaps.
    pub fn new(scene: &Scene, set: &ViewSet) -> Self {
        let shaded = |by| set.views.iter().any(|v| v.shading.interpolation == by);
        Self {
            positions: scene.positions().to_vec(),
            corners: scene.triangles().to_vec(),
            normals: match shaded(Interpolation::Gouraud) {
                true => scene.normals().to_vec(),
                false => Vec::new(),
            },
            colors: scene.colors().to_vec(),
            stored_normals: match shaded(Interpolation::Lit) {
                true => scene.stored_normals().to_vec(),
                false => Vec::new(),
            },
        }
    }

    pub(super) fn apply(&mut self, edit: &SceneEdit) {
        for &(v, p) in &edit.moved {
            self.positions[v as usize] = p;
        }
        if !self.normals.is_empty() {
            let shaded = |v: u32| edit.normals.iter().any(|n| n.0 == v);
            debug_assert!(edit.moved.iter().all(|m| shaded(m.0)));
            for &(v, n) in &edit.normals {
                self.normals[v as usize] = n;
            }
        }
        for face in edit.after() {
            self.corners[face.id as usize] = face.corners.map(|c| c.vertex);
            if let Some(colors) = self.colors.get_mut(face.id as usize) {
                *colors = face.values.colors;
            }
            if let Some(normals) = self.stored_normals.get_mut(face.id as usize) {
                *normals = face.values.normals;
            }
        }
    }

    /// The corner colours of a face after an edit, where the model has any.
    #[inline]
    pub(super) fn colors_after<'a>(&self, face: &'a EditedFace) -> Option<&'a [[f64; 3]; 3]> {
        (!self.colors.is_empty()).then_some(&face.values.colors)
    }

    /// The stored corner normals of a face after an edit, where the model has any.
    #[inline]
    pub(super) fn normals_after<'a>(&self, face: &'a EditedFace) -> Option<&'a [DVec3; 3]> {
        (!self.stored_normals.is_empty()).then_some(&face.values.normals)
    }

    /// The position of a vertex after the change.
    #[inline]
    pub(super) fn position_after(&self, edit: &SceneEdit, vertex: u32) -> DVec3 {
        edit.moved
            .iter()
            .find(|m| m.0 == vertex)
            .map_or_else(|| self.positions[vertex as usize], |m| m.1)
    }
}

/// `(y0 - new)^2 - (y0 - old)^2`.
#[inline]
pub(super) fn difference(y0: u16, old: u16, new: u16) -> i64 {
    let (y0, old, new) = (i64::from(y0), i64::from(old), i64::from(new));
    (new - old) * (new + old - 2 * y0)
}
