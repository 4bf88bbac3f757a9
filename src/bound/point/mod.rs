//! Validity regions of points (Eisemann & Décoret 2007, section 4): how far a point may move before a viewer in a view
//! cell sees it move by more than an angle, and under which angle a given move is seen at most.
//!
//! [`extent`] is the boundary of the validity region in a direction, [`error`] equation 1 for a given pair. Both come
//! with the viewpoint that decides, the *max viewpoint*, so that a user can look from there.

mod candidates;
mod edge;
mod error;
mod extent;
mod plane;
mod viewpoint;

pub use super::planar::Aperture;
pub use error::{PointError, error};
pub use extent::{Extent, extent};
pub use viewpoint::{angle_from, extent_from};
