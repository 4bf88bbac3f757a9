//! The methods of simplification, their options and their outcome.

pub mod image;
pub mod memoryless;
