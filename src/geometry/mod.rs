//! Geometry that several rooms share: symmetric matrices, boxes, triangles, and the one tree over triangles.
//!
//! Knows nothing of meshes. `f64` with `+ - * /` in one written order; units are those of the positions. The verifier
//! (`bound::verify`) uses none of this, so that it can find what is wrong here.

mod box3;
mod sym3;
mod triangle;
mod triangle_tree;

pub use box3::Box3;
pub use sym3::Sym3;
pub use triangle::{Triangle, area_normal, axis_across, closest_point, double_area, part_weights};
pub use triangle_tree::{TreeItem, TriangleTree};
