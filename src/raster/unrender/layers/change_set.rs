//! [`ChangeSet`]: a change of the mesh with all that is the same in every view.

use glam::DVec3;

use super::super::{Added, Model, SceneEdit};
use crate::raster::FaceGeometry;

/// No vertex, or no entry.
const NONE: u32 = u32::MAX;

/// A corner of a face after the change.
#[derive(Clone, Copy, Debug)]
pub(super) struct Corner {
    /// The vertex.
    pub(super) vertex: u32,
    /// Its entry in [`SceneEdit::moved`].
    moved: u32,
    /// Its entry in [`SceneEdit::normals`].
    shaded: u32,
}

impl Corner {
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

/// A face after the change.
#[derive(Clone, Copy, Debug)]
pub(super) struct After {
    pub(super) id: u32,
    pub(super) corners: [Corner; 3],
    pub(super) positions: [DVec3; 3],
    pub(super) colors: [[f64; 3]; 3],
    /// Normal and centroid, for flat shading; zeros where no view needs them.
    pub(super) geometry: FaceGeometry,
}

/// Fate of a triangle in a change.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Fate {
    /// Nothing.
    Stays,
    /// It leaves its place: all of its fragments go.
    Goes,
    /// It stays where it is, but looks different: the index in [`ChangeSet::restyled`].
    Restyled(usize),
}

/// A change, sorted out.
#[derive(Clone, Debug)]
pub(super) struct ChangeSet {
    /// Triangles that disappear or change their shape.
    pub(super) gone: Vec<u32>,
    /// Triangles that appear or have changed their shape.
    pub(super) fresh: Vec<After>,
    /// Triangles that stay where they are and look different.
    pub(super) restyled: Vec<After>,
    /// Vertices of fresh triangles that do not move.
    pub(super) rim: Vec<u32>,
    /// Vertices of gone triangles that are not in the rim.
    pub(super) inside: Vec<u32>,
    /// Entries of [`SceneEdit::moved`] that fresh triangles use.
    pub(super) moved: Vec<u32>,
    /// By triangle: 0 stays, 1 goes, more is restyled.
    fates: Vec<u16>,
}

impl ChangeSet {
    /// Buffers for a model with this number of triangles.
    pub(super) fn new(triangles: usize) -> Self {
        Self {
            gone: Vec::new(),
            fresh: Vec::new(),
            restyled: Vec::new(),
            rim: Vec::new(),
            inside: Vec::new(),
            moved: Vec::new(),
            // One more for samples that nothing covers.
            fates: vec![0; triangles + 1],
        }
    }

    /// By triangle: 1 where it goes. For tight loops; see [`ChangeSet::fate`].
    #[inline]
    pub(super) fn fates(&self) -> &[u16] {
        &self.fates
    }

    /// True where the triangle goes.
    #[inline]
    pub(super) fn goes(&self, id: u32) -> bool {
        self.fates[id as usize] == 1
    }

    /// The fate of a triangle.
    #[inline]
    pub(super) fn fate(&self, id: u32) -> Fate {
        match self.fates[id as usize] {
            0 => Fate::Stays,
            1 => Fate::Goes,
            index => Fate::Restyled(usize::from(index) - 2),
        }
    }

    /// Sorts out a change of the model; `flat` where a view needs the geometry of faces.
    pub(super) fn fill(&mut self, model: &Model, edit: &SceneEdit, flat: bool) {
        self.forget();
        self.gone.extend_from_slice(&edit.removed);
        for &id in &edit.removed {
            self.fates[id as usize] = 1;
        }
        for face in &edit.added {
            let after = after(model, edit, face, flat);
            let index = self.restyled.len() + 2;
            if self.goes(face.id)
                && model.corners[face.id as usize] == face.corners
                && after.corners.iter().all(|c| c.moved().is_none())
                && index <= usize::from(u16::MAX)
            {
                self.fates[face.id as usize] = index as u16;
                self.restyled.push(after);
            } else {
                self.fresh.push(after);
            }
        }
        let fates = &self.fates;
        self.gone.retain(|&id| fates[id as usize] == 1);
        let note = |list: &mut Vec<u32>, v: u32| {
            if !list.contains(&v) {
                list.push(v);
            }
        };
        for corner in self.fresh.iter().flat_map(|face| face.corners) {
            match corner.moved() {
                Some(_) => note(&mut self.moved, corner.moved),
                None => note(&mut self.rim, corner.vertex),
            }
        }
        for v in self.gone.iter().flat_map(|&id| model.corners[id as usize]) {
            if !self.rim.contains(&v) {
                note(&mut self.inside, v);
            }
        }
    }

    /// Undoes the marks of the last change.
    fn forget(&mut self) {
        for &id in &self.gone {
            self.fates[id as usize] = 0;
        }
        for face in &self.restyled {
            self.fates[face.id as usize] = 0;
        }
        self.gone.clear();
        self.fresh.clear();
        self.restyled.clear();
        self.rim.clear();
        self.inside.clear();
        self.moved.clear();
    }
}

fn after(model: &Model, edit: &SceneEdit, face: &Added, flat: bool) -> After {
    let entry = |list: &[(u32, DVec3)], v: u32| {
        let found = list.iter().position(|e| e.0 == v);
        found.map_or(NONE, |i| i as u32)
    };
    let corners = face.corners.map(|vertex| Corner {
        vertex,
        moved: entry(&edit.moved, vertex),
        shaded: entry(&edit.normals, vertex),
    });
    let positions = corners.map(|c| match c.moved() {
        Some(i) => edit.moved[i].1,
        None => model.positions[c.vertex as usize],
    });
    let geometry = if flat {
        FaceGeometry::new(positions)
    } else {
        FaceGeometry {
            area_normal: DVec3::ZERO,
            normal: DVec3::ZERO,
            centroid: DVec3::ZERO,
        }
    };
    After {
        id: face.id,
        corners,
        positions,
        colors: face.colors,
        geometry,
    }
}
