//! `lodmark visibility` and `lodmark merge-visibility`: what views all around a mesh see of it.

mod chart;
mod measure;
mod merge;

pub(super) use measure::{VisibilityArgs, parse_cameras, run};
pub(super) use merge::{MergeArgs, finish, read, run as run_merge};
