//! The engine of collapses: adjacency, topology, queues, histories, seams, tiles.

pub(crate) mod engine;
mod high_valence;
pub(crate) mod history;
mod seams;
mod texture_coordinates;
mod tiles;
