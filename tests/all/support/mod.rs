//! What tests of several rooms use: meshes, random numbers, the command, models, oracles, property-test settings.

mod command;
mod folds;
mod geometry;
mod gltf;
mod lit;
pub(crate) mod meshes;
mod models;
pub(crate) mod oracle;
mod progress;
mod property;
mod random;
mod sources;
mod tables;
mod threads;

pub(crate) use command::{
    bytes, code, command, expect, folder, json, lodmark, put, refused, split, stderr, stdout, text,
};
pub(crate) use folds::faults;
pub(crate) use geometry::{
    angle_between, aperture, at, distance, distance_by_descent, distance_to_all, faces, lattice,
    mesh_of, mixture, moved, square,
};
pub(crate) use gltf::GltfBuilder;
pub(crate) use lit::lit_errors;
pub(crate) use meshes::{framed, live, scene_of, snapshot};
pub(crate) use models::{asset_file, model, read_model};
pub(crate) use oracle::say;
pub(crate) use progress::{Impatient, Recorder, StopsAfter};
pub(crate) use property::{bound_cases, bound_count, bound_seed, bounded, cases};
pub(crate) use random::Random;
pub(crate) use tables::rows;
pub(crate) use threads::{collapse, on_threads, same_on_all_threads};
