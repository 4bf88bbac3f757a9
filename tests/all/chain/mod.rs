//! Chains of levels of detail: sizes, switch distances, files.

mod files;
mod levels;
mod switch_distance;
