//! Wavefront OBJ, in and out.
//!
//! `tobj` parses the vertices and faces, because the project's dependencies are settled; a good half of this folder prepares
//! what it gets wrong or does not tell ([`normal_form`]).

mod lines;
mod normal_form;
mod read;
mod write;

pub(super) use read::read;
pub(super) use write::encode;
