//! View cells: the convex sets of viewpoints that a guarantee is given for (Eisemann & Décoret 2007, section 3).
//!
//! A [`ViewCell`] is a point, a segment, a line, a convex polygon, a plane, a convex polyhedron or a half-space. It is
//! made by a constructor that refuses what is no cell, or read from a [`mod@file`]. Positions are in the units of the
//! mesh that is judged.

mod distance;
pub mod file;
mod hull;
mod shape;

pub use shape::{CORNER_LIMIT, Shape, ViewCell};
