//! An image-driven run: memoryless down to its start, then by images, then polished and held against geometry.

use super::{
    ImageDriven, ImageOptions, ImageReport, Limits, OriginalModel, PictureScratch, Pictures,
    PolishCounters, Start, fallback::Contest, polish,
};
use crate::{
    Progress, Result,
    collapse::{LiveMesh, Observer, Patch, Recorder, Rules, Schedule, Tiling},
    parallel,
    simplify::{
        Normals, Outcome, Report, Weights,
        memoryless::Memoryless,
        methods::{ErrorLimit, MethodRun},
        repair_folds::repair_folds,
        run::Run,
    },
    view::ViewsName,
};

impl MethodRun for ImageOptions {
    fn check(&self) -> Result<()> {
        self.check_ranges()
    }

    fn rules(&self) -> Rules {
        // A guard against folds in every step: Gouraud shading cannot see them.
        Rules::default()
    }

    fn schedule(&self) -> Schedule {
        self.preset.schedule()
    }

    fn error(&self) -> ErrorLimit {
        ErrorLimit::Pictures
    }

    fn run(&self, run: Run<'_>) -> Result<Outcome> {
        by_images(&self.resolved(run.target, run.mesh), run)
    }
}

/// Lindstrom & Turk 2000, in stages; `own` must have been resolved.
fn by_images(own: &ImageOptions, mut run: Run<'_>) -> Result<Outcome> {
    let (mesh, progress) = (run.mesh, run.progress);
    let limit = run.options.error_rms;
    let start = own.start.triangles(run.target);
    // (1) The start of images, and the pictures of the original.
    let mut original = approach(own, start, &mut run)?;
    let drive = |live: &_| {
        let pictures = Pictures::new(original.reference(), live, own.engine);
        ImageDriven::new(pictures, own.placement, limit)
    };
    let mut method = drive(&run.live);
    let mut resolved = Start::Triangles(start as u64);
    // Where an error limits the run, pre-simplification must not use up more than half of it.
    let too_far = limit.is_some_and(|rms| method.pictures().rms() > 0.5 * rms);
    if too_far && !run.phases.is_empty() {
        run = Run::new(mesh, &run.options, progress)?;
        run.settle_concessions()?;
        method = drive(&run.live);
        resolved = Start::Input;
    }
    run.options.method = ImageOptions {
        start: resolved,
        ..own.clone()
    }
    .into();
    // (2) Collapses by images.
    let weighed = run.options.weights.is_some();
    let contest = |held_out| -> Result<_> {
        Ok(Contest {
            own,
            held_out,
            mesh,
            options: run.options.clone(),
            start: run.live.to_mesh()?,
            start_weights: weighed.then(|| Weights::new(run.live.weights_in_use())),
        })
    };
    let contest = original.take_held_out().map(contest).transpose()?;
    let sum = method.pictures().sum() as f64;
    let deviation = original.deviation(&run.live, own.swept_weight);
    let price = deviation.map_or(0.0, |d| d.price(sum));
    let mut method = method
        .with_swept_price(price)
        .with_view_stride(own.view_stride);
    let before = run.phase_start();
    let stop = run.phase("image", &mut method, run.least(), before)?;
    let mut pictures = method.into_pictures();
    // (3) Moves and flips.
    let mut report = ImageReport::default();
    if own.polish.sweeps > 0 {
        turn_back(&original, &mut pictures, &mut run)?;
        let counters;
        (pictures, counters) = polish_by(own, &original, pictures, &mut run)?;
        report.polish = Some(counters);
    }
    report.error_rms = Some(pictures.rms());
    drop(pictures);
    let is_lit = original.reference().is_lit();
    if limit.is_some() && is_lit && run.options.normals == Normals::Fit {
        // The limit holds for the normals that the pictures showed.
        run.options.normals = Normals::Carry;
    }
    let triangles = run.least();
    let frame = run.live.frame();
    let mut images = run.finish(stop, Report::Image(report))?;
    if let (true, Some(_), Report::Image(report)) = (is_lit, images.normals, &mut images.report) {
        // The error is that of the mesh as it is returned, with the normals that it got at last.
        let last = LiveMesh::new(&images.mesh, frame);
        let pictures = Pictures::new(original.reference(), &last, own.engine);
        report.error_rms = Some(pictures.rms());
    }
    drop(original);
    // (4) The better one of images and geometry.
    match contest {
        Some(contest) => contest.decide(images, triangles, progress),
        None => Ok(images),
    }
}

/// Collapses by geometry down to `start` triangles, or to the target where that comes first, while the original is
/// drawn.
fn approach(own: &ImageOptions, start: usize, run: &mut Run<'_>) -> Result<OriginalModel> {
    let progress = run.progress;
    let frame = run.live.frame();
    let framed = run.mesh.enter_frame(frame);
    // Views that cannot be used are told before any work.
    let set = own.views(&framed, frame, 0)?;
    let contested = own.is_contested(run.options.error_rms.is_none());
    let draw = || OriginalModel::draw(framed, frame, set, own, contested, progress);
    if run.live.triangle_count() <= start {
        progress.step("draw", 0, 0)?;
        return draw();
    }
    let triangles = start.max(run.least());
    let mut method = Memoryless::new(&run.live, own.placement);
    let before = run.collapse_in_tiles(&mut method, Tiling::COARSE, triangles)?;
    // One queue keeps one core busy.
    let queue = || run.phase("memoryless", &mut method, triangles, before);
    let (collapsed, drawn) = parallel::join(queue, draw);
    collapsed?;
    drawn
}

/// Turns faces back that collapses turned over: polishing would only keep them from getting worse. Looks at no
/// picture, so only where no error of theirs is limited.
fn turn_back(original: &OriginalModel, pictures: &mut Pictures, run: &mut Run<'_>) -> Result<()> {
    let Some(sides) = original.sides().filter(|_| run.options.error_rms.is_none()) else {
        return Ok(());
    };
    let points = |t| run.live.points(t as u32);
    let is_flipped = |t| points(t).is_some_and(|face| sides.is_flipped(face));
    if !parallel::any(run.live.triangle_ids() as usize, &is_flipped) {
        return Ok(());
    }
    let mut following = Following {
        scratch: pictures.scratch(true),
        pictures,
        recorder: &mut run.recorder,
    };
    let rules = run.options.rules;
    repair_folds(&mut run.live, run.mesh, rules, &mut following, run.progress)
}

/// Polishes the mesh, with cameras that turn unless the user was told a limit for these views.
fn polish_by(
    own: &ImageOptions,
    original: &OriginalModel,
    pictures: Pictures,
    run: &mut Run<'_>,
) -> Result<(Pictures, PolishCounters)> {
    let limited = run.options.error_rms.is_some();
    let turns = !limited && !matches!(own.views, ViewsName::File(_));
    let progress: &dyn Progress = run.progress;
    let mut fresh = |live: &LiveMesh, round: u32| {
        let turned = turns.then(|| original.turned(own, round, progress));
        let turned = turned.transpose()?;
        Ok(turned.map(|reference| Pictures::new(&reference, live, own.engine)))
    };
    let deviation = original.deviation(&run.live, own.polish.deviation_weight);
    let limits = Limits {
        rules: run.options.rules,
        deviation: deviation.as_ref(),
        falling: limited,
        sides: original.sides(),
    };
    polish(
        &mut run.live,
        pictures,
        own.polish,
        limits,
        &mut fresh,
        &mut run.recorder,
        progress,
    )
}

/// Lets pictures follow, and a history record, changes that no picture was asked about.
struct Following<'a> {
    pictures: &'a mut Pictures,
    scratch: PictureScratch,
    recorder: &'a mut Recorder,
}

impl Observer for Following<'_> {
    fn committed(&mut self, live: &LiveMesh, patch: &Patch) {
        self.pictures.commit(live, patch, &mut self.scratch);
        self.recorder.committed(live, patch);
    }
}
