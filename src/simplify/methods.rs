//! The list of methods, and the trait that each has to implement: a new one adds its folder, a line to the list at the end of
//! this file and, where it tells more than a mesh, a variant of [`Report`].

use serde::{Deserialize, Serialize};

use super::{
    Outcome,
    image::{ImageOptions, ImageReport},
    memoryless::MemorylessOptions,
    quadric::QuadricOptions,
    run::Run,
    tolerance::{Guarantee, ToleranceOptions},
    view_bounded::{ViewBoundedOptions, ViewBoundedReport},
    visibility::{VisibilityOptions, VisibilityReport},
};
use crate::{
    Result,
    collapse::{Rules, Schedule},
    mesh::Mesh,
};

/// A method, as its options: they check themselves and run.
pub(super) trait MethodRun: Sync {
    /// Tests every option that has a range.
    ///
    /// # Errors
    /// [`crate::Error::Usage`] that names the option, its value and the range.
    fn check(&self) -> Result<()>;

    /// The rules for collapses that go with the method.
    fn rules(&self) -> Rules;

    /// The schedule that goes with the method.
    fn schedule(&self) -> Schedule;

    /// The error that the method can honour.
    fn error(&self) -> ErrorLimit {
        ErrorLimit::Nothing
    }

    /// Whether vertices may be moved after the last collapse: the method knows neither pictures nor a guarantee.
    fn only_orders(&self) -> bool {
        self.error() == ErrorLimit::Nothing
    }

    /// The report where the input already has no more triangles than wanted.
    fn report_of_copy(&self, _: &Mesh) -> Report {
        Report::Nothing
    }

    /// Simplifies from the prepared start of a run to its outcome.
    ///
    /// # Errors
    /// As [`super::simplify_with`].
    fn run(&self, run: Run<'_>) -> Result<Outcome>;
}

/// The error that a method can honour.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum ErrorLimit {
    /// None: the method needs a target.
    Nothing,
    /// That of pictures, [`Options::error_rms`](super::Options::error_rms).
    Pictures,
    /// The bound in its own options.
    Own,
}

/// The report of a method besides the mesh. Every method's folder says how its own is read from an [`Outcome`].
#[derive(Clone, Debug)]
#[non_exhaustive]
pub enum Report {
    /// Nothing: the method only orders collapses, or the input was returned as it is.
    Nothing,
    /// Of the image-driven method.
    Image(ImageReport),
    /// Of the visibility-guided method.
    Visibility(VisibilityReport),
    /// Of simplification within a distance.
    Tolerance(Guarantee),
    /// Of simplification within an angle.
    ViewBounded(ViewBoundedReport),
}

macro_rules! methods {
    ($($(#[doc = $doc:literal])+ $name:ident($options:ty) => $text:literal, $default:expr;)+) => {
        /// Which method, with its options.
        #[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
        #[serde(rename_all = "kebab-case", tag = "name")]
        #[non_exhaustive]
        pub enum MethodOptions { $($(#[doc = $doc])+ $name($options),)+ }

        /// A method by its name alone.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        #[cfg_attr(feature = "cli", derive(clap::ValueEnum))]
        #[non_exhaustive]
        pub enum MethodName { $($(#[doc = $doc])+ $name,)+ }

        impl MethodName {
            /// The name on the command line and in reports.
            #[must_use]
            pub const fn name(self) -> &'static str {
                match self { $(Self::$name => $text,)+ }
            }

            /// The method with its defaults; `None` where it needs a bound from the user.
            pub(crate) fn defaults(self) -> Option<MethodOptions> {
                match self { $(Self::$name => $default,)+ }
            }
        }

        impl MethodOptions {
            /// The method's name on the command line and in reports.
            #[must_use]
            pub const fn name(&self) -> &'static str {
                match self { $(Self::$name(_) => $text,)+ }
            }

            /// True where the method keeps to a bound of its own.
            pub(crate) fn is_bounded(&self) -> bool {
                self.as_run().error() == ErrorLimit::Own
            }

            pub(super) fn as_run(&self) -> &dyn MethodRun {
                match self { $(Self::$name(own) => own,)+ }
            }
        }

        $(impl From<$options> for MethodOptions {
            fn from(own: $options) -> Self {
                Self::$name(own)
            }
        })+
    };
}

methods! {
    /// By the change of pictures (Lindstrom & Turk 2000).
    Image(ImageOptions) => "image", Some(ImageOptions::default().into());
    /// By swept volumes (Lindstrom & Turk 1998/99).
    Memoryless(MemorylessOptions) => "memoryless", Some(MemorylessOptions::default().into());
    /// By distances to planes (Garland & Heckbert 1997/98).
    Quadric(QuadricOptions) => "quadric", Some(QuadricOptions::default().into());
    /// By distances to planes, weighted by how visible they are (Zhang & Turk 2002).
    Visibility(VisibilityOptions) => "visibility", Some(VisibilityOptions::default().into());
    /// Within a distance of the input, guaranteed (after Cox & Chibelushi 2005).
    Tolerance(ToleranceOptions) => "tolerance", None;
    /// Within an angle for all viewers in a cell (after Eisemann & Décoret 2007).
    ViewBounded(ViewBoundedOptions) => "view-bounded", None;
}
