//! Visibility: what the views see of a mesh, and the proof by ray casting that the images say so rightly.

pub mod rays;
