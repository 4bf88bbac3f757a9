//! Methods of simplification, one folder each, and the run that they share.
//!
//! [`simplify`] takes a mesh and [`Options`] and gives an [`Outcome`]: the mesh, the history of its making and why it
//! ended. A method's folder has its `options`, its `run`, its `report` where it tells more than a mesh, and the parts
//! of the method itself; `methods` lists them. [`memoryless`] and [`quadric`] are the baselines; other methods place
//! vertices by them: [`mod@image`], [`tolerance`] and [`view_bounded`] by the first, [`visibility`] by the second.
//! Whatever the method, [`mod@normals`] gives the result its stored normals in the end, and [`mod@tangents`] its tangents.

pub mod billboards;
mod concessions;
pub mod image;
pub mod memoryless;
mod methods;
pub mod normals;
mod options;
mod outcome;
pub mod quadric;
mod recorded;
mod repair_folds;
mod run;
pub mod tangents;
mod target;
pub mod tolerance;
pub mod view_bounded;
pub mod visibility;
mod weights;

/// The history that an [`Outcome`] carries to rebuild any level, the type that rebuilds it, and the enums of
/// [`Options`].
pub use crate::collapse::{History, Locks, Replay, Rules, Schedule, Stop, Topology};
pub use methods::{MethodName, MethodOptions, Report};
pub use normals::{Normals, NormalsReport};
pub use options::Options;
pub use outcome::{Outcome, Phase};
pub use run::{simplify, simplify_with};
pub use tangents::{Tangents, TangentsReport};
pub use target::Target;
pub use visibility::simplify_guided;
pub use weights::{Weights, WeightsReport};
