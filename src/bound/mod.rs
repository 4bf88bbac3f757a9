//! Guarantees: how far a simplification is from its original, as a bound that holds and not as an estimate.
//!
//! Eisemann & Décoret 2007 bound the angle under which a viewer in a view cell can see the difference; Cox &
//! Chibelushi 2005 keep a collapse inside a tolerance volume. A verifier that shares no code with either checks their
//! claims.

pub mod correspondence;
pub mod envelope;
pub mod face;
pub mod heuristics;
pub mod nearest_triangle;
pub mod planar;
pub mod point;
pub mod region;
pub mod surface;
pub mod switch_distance;
pub mod tolerance;
pub mod verify;
pub mod view_cell;
