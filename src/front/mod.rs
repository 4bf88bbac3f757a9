//! The front door: functions and options of the root that no room has in that form, and what their signatures need.
//!
//! They compose rooms as the command does and promise what their signatures say; the rooms behind them are free to
//! change.

mod compare;
mod history;
pub(crate) mod render;
pub mod verify;
mod visibility;

pub use compare::{compare, compare_with};
pub use render::{render, render_with};
pub use visibility::{visibility, visibility_with};

/// Options of everything, each made by a constructor or by default and changed step by step.
pub mod options {
    pub use super::render::RenderOptions;
    pub use crate::chain::{Levels, Screen};
    pub use crate::metric::report::CompareOptions;
    pub use crate::simplify::{
        MethodOptions, Normals, Rules, Schedule, Tangents, Topology, Weights,
        image::{DrivingShading, EngineName, ImageOptions, Polish, Size, Start},
        memoryless::{ConstraintOrder, MemorylessOptions, Objective, Placement},
        quadric::{QuadricOptions, Uncertainty, Weighting},
        tolerance::{Distance, ToleranceOptions},
        view_bounded::ViewBoundedOptions,
        visibility::VisibilityOptions,
    };
    pub use crate::visibility::{Alignment, CameraWeights, MeasureOptions, UnseenRule};
}

/// Findings: images, measures, and the account that runs give of themselves.
pub mod reports {
    pub use super::render::{Rendering, ViewImages};
    pub use crate::{
        chain::{Chain, Level, LevelReport, ScreenShares},
        collapse::{Counters, Reason, Refusals},
        metric::{
            appearance::WorstView,
            folds::Folds,
            luma::SquaredError,
            report::{
                CandidateReport, Comparison, DistanceReport, ErrorReport, ImageError, MeshShape,
                PictureReport, ViewReport,
            },
            silhouette::SilhouetteHistogram,
            surface::{Distances, OneSided, SurfaceDistance},
        },
        num::Grid,
        simplify::{
            NormalsReport, Phase, Report, TangentsReport, WeightsReport,
            image::{Comparison as Fallback, ImageReport, PolishCounters},
            tolerance::Guarantee,
            view_bounded::ViewBoundedReport,
            visibility::VisibilityReport,
        },
        visibility::Visibility,
    };
}

/// Cameras and what they draw, sets of views, and the cells of viewers that guarantees are given for.
pub mod views {
    pub use crate::{
        bound::view_cell::{Shape as CellShape, ViewCell},
        num::fixed::SubpixelBits,
        view::{
            Cull, Eye, Interpolation, Light, Projection, Shading, Specular, View, ViewSet,
            ViewsName,
        },
    };

    /// Reads view cells as the command does.
    pub use crate::bound::view_cell::file::read as read_cell;
    /// Reads and writes view files, the schema in which others draw the same images.
    pub use crate::view::file::{read as read_views, to_json as views_to_json};
}
