//! A mesh in units of a frame.

use glam::DVec3;

use super::Mesh;
use crate::num::Frame;

/// A [`Mesh`] with positions in units of a [`Frame`]: what is drawn, and measured where magnitude matters.
///
/// Another type than the mesh of a file, so that no frame units come into a file. The coordinates need not be
/// representable as `f32` any more (a subnormal one is not in file units); the precision is still that of the *file*.
#[derive(Clone, Debug, PartialEq)]
pub struct FramedMesh(Mesh);

impl FramedMesh {
    /// Positions in frame units.
    #[must_use]
    pub fn positions(&self) -> &[DVec3] {
        self.0.positions()
    }

    /// Vertices of every triangle.
    #[must_use]
    pub fn triangles(&self) -> &[[u32; 3]] {
        self.0.triangles()
    }

    /// The corner positions of a triangle in frame units.
    ///
    /// # Panics
    /// Where there is no such triangle.
    #[must_use]
    pub fn corners(&self, triangle: usize) -> [DVec3; 3] {
        self.0.corners(triangle)
    }

    /// The mesh for what works in any unit and writes no file.
    #[must_use]
    pub fn in_frame_units(&self) -> &Mesh {
        &self.0
    }
}

impl Mesh {
    /// The same mesh with positions in units of `frame`: an exact scaling.
    #[must_use]
    pub fn enter_frame(&self, frame: Frame) -> FramedMesh {
        FramedMesh(self.in_frame(frame))
    }
}
