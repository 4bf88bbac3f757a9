//! Visibility-guided simplification: Zhang & Turk 2002, section 5.
//!
//! A vertex carries two quadrics. `Q`, that of [`quadric`](super::quadric), decides where the new vertex lies. `Q_v`,
//! in which the planes of a face and of its boundary edges count by the square of its visibility (equations 5.8 to
//! 5.10), decides which edge is next; it never places, because it is singular where nothing is seen. Both are sums
//! over the ends of an edge. Deviation: the cost is `Q_v + 1e-6 Q`. Where nothing is seen all `Q_v` are 0, and the
//! second term lets such parts keep their shape as long as possible, as under the method without visibility.
//! Weights belong to the triangles of the input; nothing is measured again during a run. Costs: as those of the
//! quadric method, in frame units.

mod method;
mod options;
mod report;
mod run;

pub use method::VisibilityMethod;
pub use options::{TIE_WEIGHT, VisibilityOptions};
pub use report::VisibilityReport;
pub use run::simplify_guided;
