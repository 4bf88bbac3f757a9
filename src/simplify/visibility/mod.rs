//! Visibility-guided simplification: Zhang & Turk 2002, section 5.

mod method;

pub use method::{TIE_WEIGHT, VisibilityMethod, VisibilityOptions};
