//! The options of a run, resolved: the same options and input give the same bytes.

use serde::{Deserialize, Serialize};

use super::{
    MethodOptions, Normals, Target,
    image::{DrivingShading, EngineName, ImageOptions, Preset, Size, Start},
    memoryless::MemorylessOptions,
    methods::ErrorLimit,
    quadric::QuadricOptions,
    tangents::Tangents,
    tolerance::ToleranceOptions,
    view_bounded::ViewBoundedOptions,
    visibility::VisibilityOptions,
    weights::Weights,
};
use crate::{
    Error, Result,
    collapse::{Locks, Rules, Schedule, Topology},
    view::ViewsName,
};

/// Everything a result depends on besides the input.
///
/// Made by the constructor of a method, then changed step by step. A step that
/// means nothing to the method is an error of [`Options::check`], and so of the run.
///
/// ```
/// # use lodmark::simplify::{image::Preset, Options, Target};
/// let options = Options::image(Target::triangles(1_333)).preset(Preset::Fast);
/// assert!(options.check().is_ok());
/// ```
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
#[non_exhaustive]
pub struct Options {
    /// The method.
    pub method: MethodOptions,
    /// When to stop.
    pub target: Target,
    /// Stop before the root mean square of the luma differences over the driving views exceeds this many levels;
    /// only for the image-driven method.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub error_rms: Option<f64>,
    /// The rules that collapses obey.
    pub rules: Rules,
    /// Every mesh of a document gets the share of the target that it has of the triangles.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub per_mesh: bool,
    /// Curves of the input whose vertices stay where they are.
    #[serde(default, skip_serializing_if = "Locks::is_none")]
    pub locks: Locks,
    /// Weights of the vertices of the input: what weighs more keeps more triangles.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub weights: Option<Weights>,
    /// When edges are evaluated again.
    pub schedule: Schedule,
    /// Measure the true rank of every n-th collapse among all legal ones; 0 is off. Changes no result.
    #[serde(default)]
    pub measure_rank: u64,
    /// Move vertices after the last collapse where faces lie folded onto each other and those of the original do not;
    /// only for methods that know neither pictures nor a guarantee.
    #[serde(default)]
    pub unfold: bool,
    /// The stored normals of the result. Of a run that is over: [`Normals::Carry`] where the input has none.
    #[serde(
        default = "Normals::carried",
        skip_serializing_if = "Normals::are_carried"
    )]
    pub normals: Normals,
    /// The stored tangents of the result. Of a run that is over: [`Tangents::Carry`] where the input has no texture
    /// coordinates or no normals.
    #[serde(default, skip_serializing_if = "Tangents::are_carried")]
    pub tangents: Tangents,
    /// The first step that meant nothing to the method.
    #[serde(skip)]
    pub(crate) foreign: Option<&'static str>,
    /// The rules that have to give way were settled for this mesh.
    #[serde(skip)]
    pub(crate) settled: bool,
}

/// # Constructors
impl Options {
    /// A method with the rules and the schedule that go with its options, down to `target`.
    #[must_use]
    pub fn new(method: impl Into<MethodOptions>, target: Target) -> Self {
        let method = method.into();
        let own = method.as_run();
        Self {
            rules: own.rules(),
            per_mesh: false,
            locks: Locks::default(),
            weights: None,
            schedule: own.schedule(),
            unfold: own.only_orders(),
            method,
            target,
            error_rms: None,
            measure_rank: 0,
            normals: Normals::default(),
            tangents: Tangents::default(),
            foreign: None,
            settled: false,
        }
    }

    /// Image-driven simplification with the default preset, down to `target`.
    #[must_use]
    pub fn image(target: Target) -> Self {
        Self::new(ImageOptions::default(), target)
    }

    /// Memoryless simplification with its defaults, down to `target`.
    #[must_use]
    pub fn memoryless(target: Target) -> Self {
        Self::new(MemorylessOptions::default(), target)
    }

    /// Quadric error metrics with their defaults, down to `target`.
    #[must_use]
    pub fn quadric(target: Target) -> Self {
        Self::new(QuadricOptions::default(), target)
    }

    /// Visibility-guided simplification with its defaults, down to `target`.
    #[must_use]
    pub fn visibility(target: Target) -> Self {
        Self::new(VisibilityOptions::default(), target)
    }

    /// Simplification within a distance: as far as the distance allows, or down to `target`.
    #[must_use]
    pub fn tolerance(own: ToleranceOptions, target: Target) -> Self {
        Self::new(own, target)
    }

    /// View-bounded simplification: as far as the angle allows, or down to `target`.
    #[must_use]
    pub fn view_bounded(own: ViewBoundedOptions, target: Target) -> Self {
        Self::new(own, target)
    }
}

/// # Steps for every method
impl Options {
    /// When to stop, instead of the constructor's target.
    #[must_use]
    pub fn target(mut self, target: Target) -> Self {
        self.target = target;
        self
    }

    /// Whether seams may break, holes close and parts merge; by default only as far as the target needs.
    #[must_use]
    pub fn topology(mut self, topology: Topology) -> Self {
        self.rules.topology = topology;
        self
    }

    /// Gives every mesh of a document the share of the target that it has of the triangles, instead of dividing the target
    /// by what is seen. Nothing changes for other files, or where only an error limits the run.
    #[must_use]
    pub fn per_mesh(mut self) -> Self {
        self.per_mesh = true;
        self
    }

    /// Keeps the vertices of edges with one triangle where they are.
    #[must_use]
    pub fn lock_border(mut self) -> Self {
        self.locks.border = true;
        self
    }

    /// Keeps the vertices of edges where they are at which texture coordinates or colours jump.
    #[must_use]
    pub fn lock_seams(mut self) -> Self {
        self.locks.seams = true;
        self
    }

    /// Keeps the vertices of edges between materials, or between the parts of a document, where they are.
    #[must_use]
    pub fn lock_materials(mut self) -> Self {
        self.locks.materials = true;
        self
    }

    /// When edges are evaluated again; by default as the method or its preset has it.
    #[must_use]
    pub fn schedule(mut self, schedule: Schedule) -> Self {
        self.schedule = schedule;
        self
    }

    /// Measures the true rank of every n-th collapse among all legal ones: slow, changes no result. 0 is off.
    #[must_use]
    pub fn measure_rank(mut self, every: u64) -> Self {
        self.measure_rank = every;
        self
    }

    /// Stops before the root mean square of the luma differences over the driving views exceeds `levels`, 0 to 255;
    /// only for the image-driven method.
    #[must_use]
    pub fn error_rms(mut self, levels: f64) -> Self {
        self.error_rms = Some(levels);
        self
    }

    /// The way in which a result gets its stored normals where the input has some; by default they are fitted to those. An
    /// input that has no more triangles than wanted is copied with its own.
    #[must_use]
    pub fn normals(mut self, normals: Normals) -> Self {
        self.normals = normals;
        self
    }

    /// The way in which a result gets its stored tangents; by default it has those that the collapses carried. An input that
    /// has no more triangles than wanted is copied with its own.
    #[must_use]
    pub fn tangents(mut self, tangents: Tangents) -> Self {
        self.tangents = tangents;
        self
    }

    /// Leaves folds and flipped faces as the collapses made them; only for methods that know neither pictures
    /// nor a guarantee.
    #[must_use]
    pub fn keep_folds(mut self) -> Self {
        if self.unfold {
            self.unfold = false;
        } else if !self.method.as_run().only_orders() {
            self.refuse("keep_folds");
        }
        self
    }

    fn refuse(&mut self, step: &'static str) {
        self.foreign.get_or_insert(step);
    }
}

/// # Steps for the image-driven method
impl Options {
    /// Sets every option of the method that no other step has set, the schedule among them, to those of a recipe. An
    /// option that has the value of the recipe before counts as not set.
    #[must_use]
    pub fn preset(mut self, preset: Preset) -> Self {
        if let MethodOptions::Image(own) = &mut self.method {
            if self.schedule == own.preset.schedule() {
                self.schedule = preset.schedule();
            }
            let unset = own.shading == own.preset.options().shading;
            let shading = if unset {
                preset.options().shading
            } else {
                own.shading
            };
            own.follow(preset, shading);
        } else {
            self.refuse("preset");
        }
        self
    }

    /// The shading of the driving pictures, with the weights that the preset has for it; by default lit where the mesh
    /// stores normals, else flat, as the published method always is.
    #[must_use]
    pub fn shading(self, shading: DrivingShading) -> Self {
        self.image_step("shading", |own| own.follow(own.preset, shading))
    }

    /// The driving views.
    #[must_use]
    pub fn views(self, views: ViewsName) -> Self {
        self.image_step("views", |own| own.views = views)
    }

    /// Width and height of the driving pictures in pixels, 1 to 4096.
    #[must_use]
    pub fn size(self, pixels: u32) -> Self {
        self.image_step("size", |own| own.size = Size::Pixels(pixels))
    }

    /// Samples in a pixel of the driving pictures along each axis: 1, 2 or 4.
    #[must_use]
    pub fn samples(self, samples: u32) -> Self {
        self.image_step("samples", |own| own.samples = samples)
    }

    /// Driving views that look through the front into the interior.
    #[must_use]
    pub fn interior_views(self, count: usize) -> Self {
        self.image_step("interior_views", |own| own.interior_views = count)
    }

    /// Where images take over from the memoryless method.
    #[must_use]
    pub fn start(self, start: Start) -> Self {
        self.image_step("start", |own| own.start = start)
    }

    /// Sweeps that move vertices and flip edges after the last collapse; 0 is none.
    #[must_use]
    pub fn polish(self, sweeps: u32) -> Self {
        self.image_step("polish", |own| own.polish.sweeps = sweeps)
    }

    /// The engine by which pictures follow the mesh; never changes a result.
    #[must_use]
    pub fn engine(self, engine: EngineName) -> Self {
        self.image_step("engine", |own| own.engine = engine)
    }

    fn image_step(mut self, name: &'static str, step: impl FnOnce(&mut ImageOptions)) -> Self {
        if let MethodOptions::Image(own) = &mut self.method {
            step(own);
        } else {
            self.refuse(name);
        }
        self
    }
}

/// # Steps for methods by quadrics
impl Options {
    /// Planes with uncertainty (Trettner & Kobbelt 2020); for the quadric and the visibility-guided method.
    #[must_use]
    pub fn probabilistic(mut self) -> Self {
        match &mut self.method {
            MethodOptions::Quadric(own) => *own = own.with_uncertainty(),
            MethodOptions::Visibility(own) => own.quadric = own.quadric.with_uncertainty(),
            _ => self.refuse("probabilistic"),
        }
        self
    }

    /// Distances in space and in texture coordinates and colours (Garland & Heckbert 1998), which new vertices get from the
    /// same minimum; for the quadric method.
    #[must_use]
    pub fn attributes(mut self) -> Self {
        match &mut self.method {
            MethodOptions::Quadric(own) => own.attributes = true,
            _ => self.refuse("attributes"),
        }
        self
    }
}

impl Options {
    /// Tests every option that has a range, and that the method has a use for every step.
    ///
    /// # Errors
    /// [`Error::Usage`] that names the option, its value and the range.
    pub fn check(&self) -> Result<()> {
        let (own, name) = (self.method.as_run(), self.method.name());
        if let Some(step) = self.foreign {
            return Err(Error::Usage(format!(
                "{step} means nothing to the method `{name}`; leave it out or choose another method"
            )));
        }
        self.target.of(1)?;
        if self.unfold && !own.only_orders() {
            return Err(Error::Usage(format!(
                "unfold means nothing to the method `{name}`: it judges every change itself; leave it out"
            )));
        }
        if let Some(weights) = &self.weights {
            weights.check()?;
        }
        require_within("normal-cosine", self.rules.normal_cosine, 0.0, 0.999)?;
        require_within("fold-cosine", self.rules.fold_cosine, -1.0, 0.999)?;
        match (self.error_rms, own.error()) {
            (Some(rms), ErrorLimit::Pictures) => require_within("error-rms", rms, 0.0, 255.0)?,
            (Some(_), _) => {
                return Err(Error::Usage(format!(
                    "the method `{name}` cannot honour --error-rms, which is measured on images; use the method `image`"
                )));
            }
            (None, ErrorLimit::Own) => {}
            (None, _) if self.target == Target::ErrorOnly => {
                return Err(Error::Usage(
                    "no target; expected a number of triangles, a ratio or an error".into(),
                ));
            }
            (None, _) => {}
        }
        own.check()
    }
}

/// Refuses an option outside its range.
pub(super) fn require_within(name: &str, value: f64, low: f64, high: f64) -> Result<()> {
    if value >= low && value <= high {
        Ok(())
    } else {
        Err(Error::Usage(format!(
            "{name} is {value}; expected a number from {low} to {high}"
        )))
    }
}
