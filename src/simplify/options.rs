//! What to do, resolved: the same options and input give the same bytes.

use serde::{Deserialize, Serialize};

use super::{
    image::ImageOptions, memoryless::MemorylessOptions, quadric::QuadricOptions,
    tolerance::ToleranceOptions, view_bounded::ViewBoundedOptions, visibility::VisibilityOptions,
};
use crate::{
    Error, Result,
    collapse::{Rules, Schedule},
};

/// How far to simplify.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Amount {
    /// To at most this many triangles, at least 1.
    Triangles(u64),
    /// To at most this share of the input's triangles, in (0, 1].
    Ratio(f64),
    /// As far as the error limit of [`Options::error_rms`] lets it.
    ErrorOnly,
}

impl Amount {
    /// The number of triangles to reach from `input` triangles.
    ///
    /// # Errors
    /// [`Error::Usage`] for no triangles or a ratio outside (0, 1].
    pub fn triangles(self, input: usize) -> Result<usize> {
        match self {
            Self::Triangles(0) => Err(Error::Usage(
                "0 triangles make no mesh; expected at least 1".into(),
            )),
            Self::ErrorOnly => Ok(1),
            Self::Triangles(n) => Ok(usize::try_from(n).unwrap_or(usize::MAX)),
            Self::Ratio(r) if r > 0.0 && r <= 1.0 => {
                // Rounded up, and never 0: a ratio of a small mesh leaves something.
                Ok(((r * input as f64).ceil() as usize).max(1))
            }
            Self::Ratio(r) => Err(Error::Usage(format!(
                "the ratio {r} is not in (0, 1]; expected for example 0.1"
            ))),
        }
    }
}

/// Which method, with its options.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case", tag = "name")]
pub enum MethodOptions {
    /// Lindstrom & Turk 2000.
    Image(ImageOptions),
    /// Lindstrom & Turk 1998/99.
    Memoryless(MemorylessOptions),
    /// Garland & Heckbert 1997/98.
    Quadric(QuadricOptions),
    /// Zhang & Turk 2002.
    Visibility(VisibilityOptions),
    /// Cox & Chibelushi 2005.
    Tolerance(ToleranceOptions),
    /// Within an angle for the viewers in a cell.
    ViewBounded(ViewBoundedOptions),
}

impl MethodOptions {
    /// The method's name on the command line and in reports.
    #[must_use]
    pub const fn name(&self) -> &'static str {
        match self {
            Self::Image(_) => "image",
            Self::Memoryless(_) => "memoryless",
            Self::Quadric(_) => "quadric",
            Self::Visibility(_) => "visibility",
            Self::Tolerance(_) => "tolerance",
            Self::ViewBounded(_) => "view-bounded",
        }
    }

    /// Whether it knows neither pictures nor a guarantee: it orders collapses, and vertices may be moved afterwards.
    const fn only_orders(&self) -> bool {
        matches!(
            self,
            Self::Memoryless(_) | Self::Quadric(_) | Self::Visibility(_)
        )
    }
}

/// Everything a result depends on besides the input.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Options {
    /// The method.
    pub method: MethodOptions,
    /// When to stop.
    pub target: Amount,
    /// Stop before the root mean square of the luma differences over the driving views exceeds this many levels;
    /// only for methods that look at images.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub error_rms: Option<f64>,
    /// What a collapse may do.
    pub rules: Rules,
    /// When edges are evaluated again.
    pub schedule: Schedule,
    /// Measure the true rank of every so many-th collapse among all legal ones; 0 is off. Changes no result.
    #[serde(default)]
    pub measure_rank: u64,
    /// Move vertices after the last collapse where faces lie folded onto each other and those of the original do not;
    /// only for methods that neither look at images nor give a guarantee.
    #[serde(default)]
    pub unfold: bool,
}

impl Options {
    /// Image-driven simplification with the default preset, down to `target`.
    #[must_use]
    pub fn image(target: Amount) -> Self {
        let image = ImageOptions::default();
        Self {
            schedule: image.preset.schedule(),
            ..Self::new(MethodOptions::Image(image), target)
        }
    }

    /// Memoryless simplification with its defaults, down to `target`.
    ///
    /// Of the queues (lazy, semi, eager) and normal margins (0 to 0.2) that were tried, an eager queue with 0.05 was the
    /// one whose flat RMS and mean distance were within 1 % of CGAL's Lindstrom-Turk meshes at three levels of the
    /// bunny and one of the dragon. A lazy queue is faster and up to 2 % worse.
    #[must_use]
    pub fn memoryless(target: Amount) -> Self {
        let mut options = Self::new(
            MethodOptions::Memoryless(MemorylessOptions::default()),
            target,
        );
        options.schedule = Schedule::Eager;
        options.rules.normal_cosine = 0.05;
        options
    }

    /// Quadric error metrics with their defaults, down to `target`.
    #[must_use]
    pub fn quadric(target: Amount) -> Self {
        Self::new(MethodOptions::Quadric(QuadricOptions::default()), target)
    }

    /// Visibility-guided simplification with its defaults, down to `target`.
    #[must_use]
    pub fn visibility(target: Amount) -> Self {
        Self::new(
            MethodOptions::Visibility(VisibilityOptions::default()),
            target,
        )
    }

    /// Simplification within a distance: as far as it lets it, or down to `target`.
    #[must_use]
    pub fn tolerance(own: ToleranceOptions, target: Amount) -> Self {
        let mut options = Self::new(MethodOptions::Tolerance(own), target);
        options.schedule = Schedule::Eager;
        options.rules.normal_cosine = 0.05;
        options
    }

    /// View-bounded simplification: as far as the angle lets it, or down to `target`.
    #[must_use]
    pub fn view_bounded(own: ViewBoundedOptions, target: Amount) -> Self {
        let mut options = Self::new(MethodOptions::ViewBounded(own), target);
        options.rules.normal_cosine = 0.05;
        options
    }

    /// Images need a guard against folds in every step: Gouraud shading cannot see them. For the methods that only
    /// measure distances it cost 3 to 4 % of flat RMS on the dragon at 8,191 triangles; they are unfolded at the end.
    fn new(method: MethodOptions, target: Amount) -> Self {
        let mut rules = Rules::default();
        if !matches!(method, MethodOptions::Image(_)) {
            rules.fold_cosine = -1.0;
        }
        Self {
            unfold: method.only_orders(),
            method,
            target,
            error_rms: None,
            rules,
            measure_rank: 0,
            schedule: Schedule::Semi,
        }
    }

    /// Tests every option that has a range.
    ///
    /// # Errors
    /// [`Error::Usage`] that names the option, its value and the range.
    pub fn check(&self) -> Result<()> {
        let within = |name: &str, value: f64, low: f64, high: f64| {
            if value >= low && value <= high {
                Ok(())
            } else {
                Err(Error::Usage(format!(
                    "{name} is {value}; expected a number from {low} to {high}"
                )))
            }
        };
        let check_quadric = |q: &QuadricOptions| {
            within("boundary-weight", q.boundary_weight, 0.0, 1e12)?;
            match q.uncertainty {
                Some(u) => {
                    within("normal uncertainty", u.normal, 0.0, 1.0)?;
                    within("position uncertainty", u.position, 0.0, 1e6)
                }
                None => Ok(()),
            }
        };
        self.target.triangles(1)?;
        if self.unfold && !self.method.only_orders() {
            return Err(Error::Usage(format!(
                "unfold means nothing to the method `{}`: it judges every change itself; leave it out",
                self.method.name()
            )));
        }
        within("normal-cosine", self.rules.normal_cosine, 0.0, 0.999)?;
        within("fold-cosine", self.rules.fold_cosine, -1.0, 0.999)?;
        match (self.error_rms, &self.method) {
            (None, MethodOptions::Tolerance(_) | MethodOptions::ViewBounded(_)) => {}
            (None, _) if self.target == Amount::ErrorOnly => {
                return Err(Error::Usage(
                    "no target; expected a number of triangles, a ratio or an error".into(),
                ));
            }
            (Some(rms), MethodOptions::Image(_)) => within("error-rms", rms, 0.0, 255.0)?,
            (Some(_), other) => {
                return Err(Error::Usage(format!(
                    "the method `{}` cannot honour --error-rms, which is measured on images; use the method `image`",
                    other.name()
                )));
            }
            (None, _) => {}
        }
        match &self.method {
            MethodOptions::Image(image) => image.check(),
            MethodOptions::Memoryless(m) => within("volume-weight", m.volume_weight, 0.0, 1.0),
            MethodOptions::Quadric(q) => check_quadric(q),
            MethodOptions::ViewBounded(v) => v.check(),
            MethodOptions::Visibility(v) => {
                within("tie-weight", v.tie_weight, 0.0, 1.0)?;
                v.measure.check()?;
                check_quadric(&v.quadric)
            }
            MethodOptions::Tolerance(t) => t.check(),
        }
    }
}
