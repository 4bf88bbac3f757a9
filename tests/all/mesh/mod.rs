//! Meshes: canonical order, findings, generated ones.

mod canonical;
mod findings;
mod generate;
