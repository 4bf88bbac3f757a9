//! From a mesh and options to an outcome.

use super::{
    MethodOptions, Options, Outcome, Phase,
    image::{
        self, Contest, EngineName, ImageDriven, ImageOptions, Limits, Original, PictureScratch,
        Pictures, PolishCounters, Start,
    },
    memoryless::Memoryless,
    quadric::QuadricMethod,
    repair_folds::unfold,
    tolerance::{Guarantee, ToleranceMethod, ToleranceOptions},
    view_bounded::{ViewBounded, ViewBoundedOptions},
    visibility::{VisibilityMethod, VisibilityOptions},
};
use crate::{
    Error, Progress, Result,
    bound::correspondence::Correspondence,
    collapse::{
        Counters, Engine, LiveMesh, Method, Observer, Patch, Recorder, Stop, TileOptions, Tileable,
        Tiling, collapse_in_tiles,
    },
    mesh::Mesh,
    parallel,
    raster::{BucketEngine, LayerEngine, Unrender},
    view::{ViewsName, frame_of},
    visibility::{self, Visibility},
};

/// Simplifies a mesh; the result has no more triangles than wanted, or says why not.
///
/// The mesh is taken as it is: weld it and put it in canonical order first. Triangle and vertex ids of the history
/// are those of `mesh`. O(n log n) for the geometric methods; the image-driven method also draws: its time grows with
/// the pixels that the collapses change.
///
/// # Errors
/// [`Error::Usage`] for options out of range, [`Error::Input`] for a view file that cannot be used,
/// [`Error::Interrupted`].
pub fn simplify(mesh: &Mesh, options: &Options, progress: &dyn Progress) -> Result<Outcome> {
    start(mesh, options, None, progress)
}

/// As [`simplify`] with the method [`MethodOptions::Visibility`], by a visibility of this very mesh that was measured
/// before: it is measured once, and guides any number of runs. The result is that of [`simplify`] with the options
/// that it was measured with, and its [`Outcome::options`] have them.
///
/// # Errors
/// As [`simplify`]; [`Error::Usage`] for another method, and for a visibility of another number of triangles.
pub fn simplify_guided(
    mesh: &Mesh,
    options: &Options,
    visibility: &Visibility,
    progress: &dyn Progress,
) -> Result<Outcome> {
    let MethodOptions::Visibility(own) = &options.method else {
        return Err(Error::Usage(format!(
            "the method `{}` has no use for a visibility; use the method `visibility`",
            options.method.name()
        )));
    };
    let options = Options {
        method: MethodOptions::Visibility(VisibilityOptions {
            measure: *visibility.options(),
            ..own.clone()
        }),
        ..options.clone()
    };
    start(mesh, &options, Some(visibility), progress)
}

fn start(
    mesh: &Mesh,
    options: &Options,
    visibility: Option<&Visibility>,
    progress: &dyn Progress,
) -> Result<Outcome> {
    options.check()?;
    // From a thread of the pool, handing work to another costs a microsecond; from outside, many.
    parallel::in_pool(|| in_pool(mesh, options, visibility, progress))
}

fn in_pool(
    mesh: &Mesh,
    options: &Options,
    visibility: Option<&Visibility>,
    progress: &dyn Progress,
) -> Result<Outcome> {
    let triangles = options.target.triangles(mesh.triangles().len())?;
    let mut run = Run::new(mesh, options, progress);
    if mesh.triangles().len() <= triangles {
        if matches!(options.method, MethodOptions::ViewBounded(_)) {
            let all = (0..mesh.triangles().len()).map(|t| mesh.corners(t));
            run.correspondence = Some(Correspondence::identity(all.collect()));
        }
        return run.finish(Stop::TargetAboveInput);
    }
    let stop = match &options.method {
        MethodOptions::Memoryless(own) => {
            let mut method = Memoryless::new(&run.live, *own);
            run.in_tiles("memoryless", &mut method, triangles)?
        }
        MethodOptions::Quadric(own) => {
            let mut method = QuadricMethod::new(&run.live, own);
            run.in_tiles("quadric", &mut method, triangles)?
        }
        MethodOptions::Image(own) => match own.engine {
            EngineName::Layers => run.image::<LayerEngine>(own, triangles)?,
            EngineName::Buckets => run.image::<BucketEngine>(own, triangles)?,
        },
        MethodOptions::Visibility(own) => run.guided(own, visibility, triangles)?,
        MethodOptions::Tolerance(own) => run.within_distance(own, triangles)?,
        MethodOptions::ViewBounded(own) => run.view_bounded(own, triangles)?,
    };
    if options.unfold {
        unfold(
            &mut run.live,
            mesh,
            options.rules,
            &mut run.recorder,
            progress,
        )?;
    }
    let contest = run.contest.take();
    let outcome = run.finish(stop)?;
    match contest {
        Some(contest) => contest.decide(mesh, outcome, |mesh, options| {
            in_pool(mesh, options, None, progress)
        }),
        None => Ok(outcome),
    }
}

/// Lets pictures follow, and a history record, what is done to a mesh without a look at them.
struct Following<'a, E: Unrender> {
    pictures: &'a mut Pictures<E>,
    scratch: PictureScratch<E::Scratch>,
    recorder: &'a mut Recorder,
}

impl<E: Unrender> Observer for Following<'_, E> {
    fn committed(&mut self, live: &LiveMesh, patch: &Patch) {
        self.pictures.commit(live, patch, &mut self.scratch);
        self.recorder.committed(live, patch);
    }
}

/// A run between its phases.
struct Run<'a> {
    mesh: &'a Mesh,
    live: LiveMesh,
    options: Options,
    recorder: Recorder,
    phases: Vec<Phase>,
    v_mesh: Option<f64>,
    polish: Option<PolishCounters>,
    error_rms: Option<f64>,
    guarantee: Option<Guarantee>,
    correspondence: Option<Correspondence>,
    contest: Option<Contest>,
    progress: &'a dyn Progress,
}

impl<'a> Run<'a> {
    fn new(mesh: &'a Mesh, options: &Options, progress: &'a dyn Progress) -> Self {
        let frame = frame_of(mesh);
        Self {
            mesh,
            live: LiveMesh::new(mesh, frame),
            options: options.clone(),
            recorder: Recorder::new(mesh, frame),
            phases: Vec::new(),
            v_mesh: None,
            polish: None,
            error_rms: None,
            guarantee: None,
            correspondence: None,
            contest: None,
            progress,
        }
    }

    /// Collapses tile by tile while the mesh is large, then as a whole.
    fn in_tiles(
        &mut self,
        name: &'static str,
        method: &mut dyn Tileable,
        triangles: usize,
    ) -> Result<Stop> {
        let before = self.tiles(method, Tiling::default(), triangles)?;
        self.phase(name, method, triangles, before)
    }

    /// Collapses tile by tile until the mesh is small enough for one queue; what a phase counts on from.
    fn tiles(
        &mut self,
        method: &mut dyn Tileable,
        tiling: Tiling,
        triangles: usize,
    ) -> Result<(usize, Counters)> {
        let triangles_in = self.live.triangle_count();
        let mut counters = Counters::default();
        collapse_in_tiles(
            &mut self.live,
            method,
            TileOptions {
                tiling,
                rules: self.options.rules,
                schedule: self.options.schedule,
                triangles,
            },
            &mut counters,
            &mut self.recorder,
            self.progress,
        )?;
        Ok((triangles_in, counters))
    }

    /// Collapses under one method until the target or its end; counts on from `before`.
    fn phase(
        &mut self,
        name: &'static str,
        method: &mut dyn Method,
        triangles: usize,
        (triangles_in, counters): (usize, Counters),
    ) -> Result<Stop> {
        let live = std::mem::take(&mut self.live);
        let mut engine = Engine::new(live, self.options.rules, self.options.schedule)
            .with_counters(counters)
            .with_rank_measured(self.options.measure_rank);
        let stop = engine.run(method, triangles, &mut self.recorder, self.progress);
        let (live, counters) = engine.into_parts();
        self.live = live;
        self.phases.push(Phase {
            method: name,
            triangles_in,
            triangles_out: self.live.triangle_count(),
            counters,
        });
        stop
    }

    /// Lindstrom & Turk 2000: memoryless down to the start of the image-driven part, then by images.
    fn image<E: Unrender>(&mut self, own: &ImageOptions, triangles: usize) -> Result<Stop> {
        let own = &ImageOptions {
            size: own.size.pixels(triangles).into(),
            ..own.clone()
        };
        let limit = self.options.error_rms;
        let (mesh, progress) = (self.mesh, self.progress);
        let frame = self.live.frame();
        let framed = mesh.enter_frame(frame);
        // Views that cannot be used are told before any work.
        let set = own.views(&framed, frame, 0)?;
        let draw = || {
            Original::draw(
                framed,
                frame,
                set,
                own,
                own.is_contested(limit.is_none()),
                progress,
            )
        };
        let start = own.start.triangles(triangles);
        let mut original = if self.live.triangle_count() > start {
            // A target above the start is reached before pictures take over.
            let until = start.max(triangles);
            let mut method = Memoryless::new(&self.live, own.placement);
            let before = self.tiles(&mut method, Tiling::COARSE, until)?;
            // One queue keeps one core busy.
            let queue = || self.phase("memoryless", &mut method, until, before);
            let (collapsed, drawn) = parallel::join(queue, draw);
            collapsed?;
            drawn?
        } else {
            progress.step("draw", 0, 0)?;
            draw()?
        };
        let drive =
            |live: &_| ImageDriven::<E>::new(original.reference(), live, own.placement, limit);
        let mut method = drive(&self.live);
        let mut start = Start::Triangles(start as u64);
        // Where an error limits the run, pre-simplification must not use up more than half of it.
        let too_far = limit.is_some_and(|rms| method.error().rms() > 0.5 * rms);
        if too_far && !self.phases.is_empty() {
            *self = Self::new(mesh, &self.options, progress);
            method = drive(&self.live);
            start = Start::Input;
        }
        self.options.method = MethodOptions::Image(ImageOptions {
            start,
            ..own.clone()
        });
        if let Some(held_out) = original.take_held_out() {
            self.contest = Some(Contest {
                held_out,
                start: self.live.to_mesh()?,
            });
        }
        let sum = method.error().sum() as f64;
        let deviation = original.deviation(&self.live, own.swept_weight);
        let price = deviation.map_or(0.0, |d| d.price(sum));
        let mut method = method.with_swept_price(price).with_glance(own.glance);
        let before = (self.live.triangle_count(), Counters::default());
        let stop = self.phase("image", &mut method, triangles, before)?;
        let mut pictures = method.into_pictures();
        if own.polish.sweeps > 0 {
            // The limit is one for the views that the user was told.
            let turns =
                self.options.error_rms.is_none() && !matches!(own.views, ViewsName::File(_));
            let mut fresh = |live: &LiveMesh, round: u32| {
                let turned = turns.then(|| original.turned(own, round, progress));
                let turned = turned.transpose()?;
                Ok(turned.map(|reference| Pictures::<E>::new(&reference, live)))
            };
            // What collapses turned over, polishing only keeps from getting worse. Turning back looks at no picture.
            let turned = self.options.error_rms.is_none()
                && original.sides().is_some_and(|sides| {
                    let points = |t| self.live.points(t as u32);
                    let is_flipped = |t| points(t).is_some_and(|face| sides.is_flipped(face));
                    parallel::any(self.live.triangle_ids() as usize, &is_flipped)
                });
            if turned {
                let mut following = Following {
                    scratch: pictures.lone_scratch(),
                    pictures: &mut pictures,
                    recorder: &mut self.recorder,
                };
                let rules = self.options.rules;
                unfold(
                    &mut self.live,
                    self.mesh,
                    rules,
                    &mut following,
                    self.progress,
                )?;
            }
            let deviation = original.deviation(&self.live, own.polish.deviation_weight);
            let counters;
            (pictures, counters) = image::polish(
                &mut self.live,
                pictures,
                own.polish,
                Limits {
                    rules: self.options.rules,
                    deviation: deviation.as_ref(),
                    falling: self.options.error_rms.is_some(),
                    sides: original.sides(),
                },
                &mut fresh,
                &mut self.recorder,
                self.progress,
            )?;
            self.polish = Some(counters);
        }
        self.error_rms = Some(pictures.error().rms());
        Ok(stop)
    }

    /// Zhang & Turk 2002: by a visibility that is at hand, or is measured now.
    fn guided(
        &mut self,
        own: &VisibilityOptions,
        visibility: Option<&Visibility>,
        triangles: usize,
    ) -> Result<Stop> {
        let measured;
        let visibility = match visibility {
            Some(visibility) => visibility,
            None => {
                measured = visibility::measure(self.mesh, &own.measure, self.progress)?;
                &measured
            }
        };
        let mut method = VisibilityMethod::new(&self.live, own, visibility.triangles())?;
        self.v_mesh = Some(visibility.mesh());
        self.in_tiles("visibility", &mut method, triangles)
    }

    /// Cox & Chibelushi 2005: one phase for every local bound.
    fn within_distance(&mut self, own: &ToleranceOptions, triangles: usize) -> Result<Stop> {
        self.progress.step("prepare", 0, 0)?;
        let mut method = ToleranceMethod::new(&self.live, *own)?;
        self.guarantee = Some(method.guarantee());
        let mut stop = Stop::TargetReached;
        for bound in method.local_bounds() {
            method.set_local_bound(bound);
            let before = (self.live.triangle_count(), Counters::default());
            stop = self.phase("tolerance", &mut method, triangles, before)?;
            if stop == Stop::TargetReached {
                break;
            }
        }
        Ok(stop)
    }

    /// Eisemann & Décoret 2007: within an angle for all viewers in a cell.
    fn view_bounded(&mut self, own: &ViewBoundedOptions, triangles: usize) -> Result<Stop> {
        let mut method = ViewBounded::new(&self.live, own, self.progress)?;
        let before = (self.live.triangle_count(), Counters::default());
        let stop = self.phase("view-bounded", &mut method, triangles, before)?;
        self.correspondence = Some(method.into_correspondence(&self.live)?);
        Ok(stop)
    }

    fn finish(self, stop: Stop) -> Result<Outcome> {
        let json =
            serde_json::to_string(&self.options).map_err(|e| Error::Internal(e.to_string()))?;
        let mesh = match stop {
            Stop::TargetAboveInput => self.mesh.clone(),
            _ => self.live.to_mesh()?,
        };
        Ok(Outcome {
            mesh,
            history: self.recorder.finish(json),
            stop,
            phases: self.phases,
            polish: self.polish,
            options: self.options,
            v_mesh: self.v_mesh,
            error_rms: self.error_rms,
            guarantee: self.guarantee,
            correspondence: self.correspondence,
            comparison: None,
        })
    }
}
