//! The shared part of every run: the mesh that is collapsed, its history and its phases.

use super::{
    MethodOptions, Options, Outcome, Phase, Report, WeightsReport, normals,
    repair_folds::repair_folds, tangents,
};
use crate::{
    Error, Progress, Result, Silent,
    collapse::{
        Concession, Counters, Engine, LiveMesh, Method, Recorder, Rules, Stop, TileOptions,
        Tileable, Tiling, collapse_in_tiles,
    },
    mesh::Mesh,
    parallel,
    view::frame_of,
};

/// Simplifies a mesh; the result has no more triangles than wanted, or says why not.
///
/// The mesh is taken as it is: weld it and put it in canonical order first. Triangle and vertex ids of the history
/// are those of `mesh`. O(n log n) for the geometric methods; the image-driven method also draws: its time grows with
/// the pixels that the collapses change.
///
/// # Errors
/// [`Error::Usage`] for options out of range, [`Error::Input`] for a view file that cannot be used.
pub fn simplify(mesh: &Mesh, options: &Options) -> Result<Outcome> {
    simplify_with(mesh, options, &Silent)
}

/// Simplifies a mesh as [`simplify`] does, and reports to `progress`, which may interrupt it.
///
/// # Errors
/// As [`simplify`]; [`Error::Interrupted`].
pub fn simplify_with(mesh: &Mesh, options: &Options, progress: &dyn Progress) -> Result<Outcome> {
    start(mesh, options, progress, &|own, run| own.as_run().run(run))
}

/// Simplifies with options that were checked, from a thread of the pool.
pub(super) fn simplify_in_pool(
    mesh: &Mesh,
    options: &Options,
    progress: &dyn Progress,
) -> Result<Outcome> {
    in_pool(mesh, options, progress, &|own, run| own.as_run().run(run))
}

/// The part of a run that is its method's.
pub(super) type Body<'a> = dyn Fn(&MethodOptions, Run<'_>) -> Result<Outcome> + Sync + 'a;

/// Checks the options and runs them, with a `body` in place of the method's own.
pub(super) fn start(
    mesh: &Mesh,
    options: &Options,
    progress: &dyn Progress,
    body: &Body<'_>,
) -> Result<Outcome> {
    options.check()?;
    // From a thread of the pool, handing work to another costs a microsecond; from outside, many.
    parallel::in_pool(|| in_pool(mesh, options, progress, body))
}

fn in_pool(
    mesh: &Mesh,
    options: &Options,
    progress: &dyn Progress,
    body: &Body<'_>,
) -> Result<Outcome> {
    let mut run = Run::new(mesh, options, progress)?;
    if mesh.triangles().len() <= run.least() {
        let report = options.method.as_run().report_of_copy(mesh);
        return run.outcome(Stop::TargetAboveInput, report);
    }
    run.settle_concessions()?;
    body(&options.method, run)
}

/// A run between its phases.
pub(super) struct Run<'a> {
    pub(super) mesh: &'a Mesh,
    pub(super) live: LiveMesh,
    pub(super) options: Options,
    /// Triangles to reach; `None` where only an error limits the run.
    pub(super) target: Option<usize>,
    /// Number of locked vertices.
    locked: usize,
    /// Number of pieces that a view sees, where that was asked.
    pub(super) seen_pieces: Option<usize>,
    pub(super) recorder: Recorder,
    pub(super) phases: Vec<Phase>,
    pub(super) progress: &'a dyn Progress,
}

/// The state that a phase counts on from.
#[derive(Clone, Debug)]
pub(super) struct PhaseStart {
    triangles: usize,
    counters: Counters,
}

impl<'a> Run<'a> {
    pub(super) fn new(
        mesh: &'a Mesh,
        options: &Options,
        progress: &'a dyn Progress,
    ) -> Result<Self> {
        let frame = frame_of(mesh);
        let mut live = LiveMesh::new(mesh, frame);
        if let Some(weights) = &options.weights {
            live.weigh(weights.of_mesh(mesh)?);
        }
        live.lock(options.locks);
        let count = mesh.triangles().len();
        let mut target = options.target.of(count)?;
        if let Some(triangles) = target.filter(|_| options.per_mesh) {
            let share = triangles as f64 / count.max(1) as f64;
            target = live.set_shares(share).or(target);
        }
        Ok(Self {
            mesh,
            locked: live.locked_vertices(),
            live,
            seen_pieces: None,
            options: options
                .clone()
                .normals(options.normals.of(mesh))
                .tangents(options.tangents.of(mesh)),
            target,
            recorder: Recorder::new(mesh, frame),
            phases: Vec::new(),
            progress,
        })
    }

    /// The number of triangles to stop at: one where only an error limits the run.
    pub(super) fn least(&self) -> usize {
        self.target.unwrap_or(1)
    }

    /// Collapses tile by tile while the mesh is large, then as a whole, and ends the run.
    pub(super) fn collapse(
        mut self,
        name: &'static str,
        method: &mut dyn Tileable,
        report: Report,
    ) -> Result<Outcome> {
        let least = self.least();
        let before = self.collapse_in_tiles(method, Tiling::default(), least)?;
        let stop = self.phase(name, method, least, before)?;
        self.finish(stop, report)
    }

    /// Collapses tile by tile until the mesh is small enough for one queue; the start of the phase that follows.
    pub(super) fn collapse_in_tiles(
        &mut self,
        method: &mut dyn Tileable,
        tiling: Tiling,
        triangles: usize,
    ) -> Result<PhaseStart> {
        let mut start = self.phase_start();
        collapse_in_tiles(
            &mut self.live,
            method,
            TileOptions {
                tiling,
                rules: self.options.rules,
                schedule: self.options.schedule,
                triangles,
            },
            &mut start.counters,
            &mut self.recorder,
            self.progress,
        )?;
        Ok(start)
    }

    /// The start of a phase that nothing has come before.
    pub(super) fn phase_start(&self) -> PhaseStart {
        PhaseStart {
            triangles: self.live.triangle_count(),
            counters: Counters::default(),
        }
    }

    /// Collapses under one method until `triangles` are left or no more is possible. Where that is the target of the run,
    /// more and more gives way, as [`Rules::steps`] has it: each step that collapses anything is a phase.
    pub(super) fn phase(
        &mut self,
        name: &'static str,
        method: &mut dyn Method,
        triangles: usize,
        start: PhaseStart,
    ) -> Result<Stop> {
        let mut stop = self.step(name, method, triangles, (self.options.rules, start))?;
        for rules in self.options.rules.steps().skip(1) {
            let stuck = matches!(&stop, Stop::NoLegalCollapse { refusals } if !refusals.by_bound());
            if !stuck || self.target != Some(triangles) {
                break;
            }
            if rules.concession == Concession::UnseenPieces {
                self.expend_unseen()?;
            }
            let start = self.phase_start();
            stop = self.step(name, method, triangles, (rules, start))?;
        }
        let kept = if self.options.rules.drop_pieces {
            0
        } else {
            self.live.used_materials()
        };
        let pieces = self.seen_pieces.unwrap_or(0).max(kept);
        if matches!(stop, Stop::NoLegalCollapse { .. }) && pieces > triangles {
            stop = Stop::VisiblePieces { pieces };
        }
        Ok(stop)
    }

    /// Collapses under one method and the rules of one step.
    fn step(
        &mut self,
        name: &'static str,
        method: &mut dyn Method,
        triangles: usize,
        (rules, start): (Rules, PhaseStart),
    ) -> Result<Stop> {
        let live = std::mem::take(&mut self.live);
        let mut engine = Engine::new(live, rules, self.options.schedule)
            .with_counters(start.counters)
            .with_rank_measured(self.options.measure_rank);
        let stop = engine.run(method, triangles, &mut self.recorder, self.progress);
        let (live, counters) = engine.into_parts();
        self.live = live;
        let concession = Some(rules.concession).filter(|&c| c != Concession::None);
        let triangles_out = self.live.triangle_count();
        if concession.is_none() || triangles_out < start.triangles {
            self.phases.push(Phase {
                method: name,
                concession,
                triangles_in: start.triangles,
                triangles_out,
                counters,
            });
        }
        stop
    }

    /// Repairs folds where the options ask for it, and ends the run. Normals follow from the mesh that is then there.
    pub(super) fn finish(mut self, stop: Stop, report: Report) -> Result<Outcome> {
        if self.options.unfold {
            repair_folds(
                &mut self.live,
                self.mesh,
                self.options.rules,
                &mut self.recorder,
                self.progress,
            )?;
        }
        self.outcome(stop, report)
    }

    fn outcome(self, stop: Stop, report: Report) -> Result<Outcome> {
        let mut options = self.options;
        options.rules.concession = Concession::None;
        options.settled = false;
        let json = serde_json::to_string(&options).map_err(|e| Error::Internal(e.to_string()))?;
        let history = self.recorder.finish(json);
        let (mesh, normals, tangents) = match stop {
            Stop::TargetAboveInput => (self.mesh.clone(), None, None),
            _ if history.is_empty() => (self.live.to_mesh()?, None, None),
            _ => {
                let carried = self.live.to_mesh()?;
                let (mesh, normals) =
                    normals::settle(self.mesh, carried, options.normals, self.progress)?;
                let (mesh, tangents) = tangents::settle(mesh, options.tangents)?;
                (mesh, normals, tangents)
            }
        };
        let weights = options.weights.as_ref();
        let weights = weights.map(|w| WeightsReport::of(w, self.mesh, &self.live, &mesh));
        Ok(Outcome {
            mesh,
            history,
            stop,
            locked_vertices: self.locked,
            weights,
            phases: self.phases,
            options,
            normals,
            tangents,
            report,
        })
    }
}
