//! Memoryless simplification: Lindstrom & Turk 1998 (placement) and 1999 (cost).

mod method;
mod vertex_sums;

pub use method::{ConstraintOrder, Memoryless, MemorylessOptions, Objective, Placement, propose};
