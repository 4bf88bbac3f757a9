//! Validity regions in the plane, exactly: points and faces seen from a segment, a line, or one viewpoint.
//!
//! Eisemann & Décoret 2007, sections 4 and 5, with the formulas corrected where the print is wrong. [`Aperture`] is the
//! error a viewer accepts, [`ViewerSegment`] where the viewer may stand. [`segment_extent`] says how far a point may move
//! in a direction, [`segment_error`] how wrong a given position is, [`Projection::interval`] which lines a face may be
//! projected on. Everything is closed form; "exact" means to the rounding of `f64`.

mod aperture;
mod face;
mod interval;
mod point;
mod points;
mod viewer_segment;
mod widest;

pub use aperture::Aperture;
pub use face::Projection;
pub use interval::{Disc, Interval};
pub use point::{Extent, Tangent, segment_extent, tangents, viewpoint_extent};
pub use points::{Rays, segment_extents};
pub use viewer_segment::ViewerSegment;
pub use widest::{WidestAngle, segment_error};
