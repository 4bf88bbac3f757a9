//! Makes a chain: every level by a run of its own, measured, with the distance from which on it may be shown.
//!
//! A level is, bit for bit, the result of `simplify` for as many triangles: no level is worse than a run of its own,
//! polished and held against geometry as that is. The price is that every level comes down from the input by the geometric
//! method again; only visibility is measured once. Views and sizes of the driving pictures follow from the target, so that
//! no two levels have the same.

use super::{
    LevelReport, Levels, Screen,
    certificate::certified_distance,
    judge::{evaluation_views, judged, silhouette_error},
    levels::{Plan, counts},
    switch_distance::{Lookout, Seen},
};
use crate::{
    Error, Progress, Result, Silent,
    mesh::{ChannelKind, Mesh},
    num::Frame,
    raster::Scene,
    simplify::{MethodOptions, Options, Outcome, Stop, Target, simplify_guided, simplify_with},
    view::{Sphere, ViewSet, frame_of},
    visibility::{Visibility, measure},
};

/// Fewest triangles that halving goes down to, and searching for a distance.
const LEAST: usize = 8;

/// Largest silhouette error of a level of a chain that is halved, as a share of the covered area.
const SILHOUETTE_ERROR: f64 = 0.05;

/// Steps of the ladder of sizes that make a half.
const STEPS: u32 = 4;

/// Sizes by the one before, for each step: 2^(-i/4).
const SIZES: [f64; STEPS as usize] = [
    1.0,
    0.840_896_415_253_714_6,
    std::f64::consts::FRAC_1_SQRT_2,
    0.594_603_557_501_360_5,
];

/// A chain of levels of detail.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Chain {
    /// The levels from fine to coarse; the first is the input itself.
    pub levels: Vec<Level>,
    /// The centre of the minimum bounding sphere of the input, in file units: distances are from there.
    pub center: [f64; 3],
    /// Its radius, in file units.
    pub radius: f64,
    /// The screen that switch distances are for.
    pub screen: Screen,
    /// Distances that no smaller mesh than that of the level before can be shown from; only where distances were asked for.
    pub left_out: Vec<f64>,
}

/// A level of a chain.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Level {
    /// The mesh, in file units.
    pub mesh: Mesh,
    /// Number of triangles that was asked for.
    pub target: usize,
    /// Why the run ended.
    pub stop: Stop,
    /// The options of the run, resolved; `None` for the input itself.
    pub options: Option<Options>,
    /// The errors of the level and the distances that follow from them.
    pub report: LevelReport,
}

/// Makes levels of detail of a mesh by a method, whose target does not count.
///
/// The mesh is taken as it is: weld it and put it in canonical order first. The same bits for every number of threads.
/// Cost: a run of [`simplify`](fn@crate::simplify) for every level (for distances, some ten), and pictures.
///
/// # Errors
/// [`Error::Usage`] for a mesh without triangles, options out of range, an error limit, a method that keeps to a bound,
/// levels that do not fall, and what [`simplify`](fn@crate::simplify) says.
pub fn chain(mesh: &Mesh, options: &Options, levels: &Levels) -> Result<Chain> {
    chain_with(mesh, options, levels, &Silent)
}

/// [`chain`](fn@chain), watched by `progress`, which may interrupt it.
///
/// # Errors
/// As [`chain`](fn@chain); [`Error::Interrupted`].
pub fn chain_with(
    mesh: &Mesh,
    options: &Options,
    levels: &Levels,
    progress: &dyn Progress,
) -> Result<Chain> {
    let options = checked(options)?;
    levels.check_for(mesh, &options)?;
    let sphere = Sphere::of_mesh(mesh)
        .ok_or_else(|| Error::Usage("a mesh without triangles has no levels".into()))?;
    let frame = frame_of(mesh);
    let original = Scene::of(&mesh.enter_frame(frame));
    let in_frame = sphere.enter_frame(frame);
    let lookout = Lookout {
        original: &original,
        sphere: in_frame,
        screen: levels.screen,
    };
    let mut maker = Maker {
        mesh,
        options,
        visibility: None,
        frame,
        views: evaluation_views(&in_frame, levels.size)?,
        lookout,
        progress,
    };
    let input = mesh.triangles().len();
    let mut left_out = Vec::new();
    let mut made = match &levels.plan {
        Plan::Halving => maker.halved(input)?,
        Plan::Targets(targets) => maker.all_of(&counts(targets, input)?)?,
        Plan::Distances(distances) => maker.for_distances(distances, &mut left_out)?,
    };
    maker.look(&mut made)?;
    Ok(Chain {
        levels: maker.finished(made, levels)?,
        center: sphere.center.to_array(),
        radius: sphere.radius,
        screen: levels.screen,
        left_out,
    })
}

impl Levels {
    /// Refuses a plan that a mesh cannot have, and options that no chain can, before any work.
    ///
    /// # Errors
    /// As [`chain`](fn@chain).
    pub(crate) fn check_for(&self, mesh: &Mesh, options: &Options) -> Result<()> {
        self.check()?;
        checked(options)?;
        match &self.plan {
            Plan::Targets(targets) => counts(targets, mesh.triangles().len()).map(drop),
            _ => Ok(()),
        }
    }
}

/// The options of any level; refuses those that no chain can have.
fn checked(options: &Options) -> Result<Options> {
    let name = options.method.name();
    if options.method.is_bounded() || options.error_rms.is_some() {
        return Err(Error::Usage(format!(
            "the method `{name}` would keep to an error and has no levels; expected image, memoryless, quadric or \
             visibility, and no error"
        )));
    }
    let options = options.clone().target(Target::triangles(1));
    options.check()?;
    Ok(options)
}

/// A level in the making.
struct Made {
    target: usize,
    mesh: Mesh,
    stop: Stop,
    options: Options,
    scene: Scene,
    silhouette_error: f64,
    /// The worst that is seen from its switch distance, once that is known; `None` inside where there is none.
    seen: Option<Option<Seen>>,
}

impl Made {
    fn triangles(&self) -> usize {
        self.mesh.triangles().len()
    }
}

/// The original and the options that levels are made of.
struct Maker<'a> {
    mesh: &'a Mesh,
    options: Options,
    visibility: Option<Visibility>,
    frame: Frame,
    views: ViewSet,
    lookout: Lookout<'a>,
    progress: &'a dyn Progress,
}

impl Maker<'_> {
    /// A level of at most so many triangles, without its switch distance.
    fn make(&mut self, target: usize) -> Result<Made> {
        let options = self
            .options
            .clone()
            .target(Target::triangles(target as u64));
        // Levels need no history, which is as large as the input.
        let Outcome {
            mesh,
            stop,
            options,
            ..
        } = if let MethodOptions::Visibility(own) = &options.method {
            let visibility = match self.visibility.take() {
                Some(known) => known,
                None => measure(self.mesh, &own.measure, self.progress)?,
            };
            let visibility = self.visibility.insert(visibility);
            simplify_guided(self.mesh, &options, visibility, self.progress)?
        } else {
            simplify_with(self.mesh, &options, self.progress)?
        };
        let scene = Scene::of(&mesh.enter_frame(self.frame));
        let original = self.lookout.original;
        Ok(Made {
            target,
            silhouette_error: silhouette_error(original, &scene, &self.views, self.progress)?,
            mesh,
            stop,
            options,
            scene,
            seen: None,
        })
    }

    fn all_of(&mut self, counts: &[usize]) -> Result<Vec<Made>> {
        counts.iter().map(|&count| self.make(count)).collect()
    }

    /// Half the triangles each, as [`Levels::halving`] says.
    fn halved(&mut self, input: usize) -> Result<Vec<Made>> {
        let (mut made, mut last) = (Vec::new(), input);
        while last > LEAST {
            let level = self.make(last.div_ceil(2).max(LEAST))?;
            let triangles = level.triangles();
            if triangles >= last || level.silhouette_error > SILHOUETTE_ERROR {
                break;
            }
            let stuck = triangles > level.target;
            last = triangles;
            made.push(level);
            if stuck {
                break;
            }
        }
        Ok(made)
    }

    /// For each distance the coarsest level that may be shown from there; `left_out` gets those that have none of their own.
    fn for_distances(&mut self, distances: &[f64], left_out: &mut Vec<f64>) -> Result<Vec<Made>> {
        let mut made: Vec<Made> = Vec::new();
        for &distance in distances {
            let last = made
                .last()
                .map_or(self.mesh.triangles().len(), Made::triangles);
            match self.coarsest(last, self.frame.enter_length(distance))? {
                Some(level) => made.push(level),
                None => left_out.push(distance),
            }
        }
        Ok(made)
    }

    /// The coarsest level below `finer` triangles that may be shown from a distance: halved as often as that holds, then
    /// bisected.
    fn coarsest(&mut self, finer: usize, distance: f64) -> Result<Option<Made>> {
        let mut best = None;
        let (mut low, mut high) = (0_u32, None);
        while high.is_none_or(|high| high - low > 1) {
            let step = high.map_or(low + STEPS, |high| (low + high) / 2);
            let scale = f64::from(1_u32 << (step / STEPS).min(31));
            let size = SIZES[(step % STEPS) as usize] / scale;
            let target = ((size * finer as f64).ceil() as usize).max(LEAST);
            let level = (target < finer).then(|| self.seen(target)).transpose()?;
            let fits = |level: &Made| {
                let seen = level.seen.flatten();
                level.triangles() < finer && seen.is_some_and(|seen| seen.distance <= distance)
            };
            let level = level.filter(fits);
            let is_last = level
                .as_ref()
                .is_some_and(|l| l.target == LEAST || l.triangles() > l.target);
            match level {
                Some(level) => (low, best) = (step, Some(level)),
                None => high = Some(step),
            }
            if is_last {
                break;
            }
        }
        Ok(best)
    }

    /// A level with its switch distance.
    fn seen(&mut self, target: usize) -> Result<Made> {
        let mut made = [self.make(target)?];
        self.look(&mut made)?;
        let [made] = made;
        Ok(made)
    }

    /// Measures the switch distances that are not known, all at once.
    fn look(&self, made: &mut [Made]) -> Result<()> {
        let open = made.iter().filter(|level| level.seen.is_none());
        let scenes: Vec<&Scene> = open.map(|level| &level.scene).collect();
        let found = self.lookout.switch_distances(&scenes, self.progress)?;
        let open = made.iter_mut().filter(|level| level.seen.is_none());
        for (level, seen) in open.zip(found) {
            level.seen = Some(seen);
        }
        Ok(())
    }

    /// The levels with all of their reports, the input first.
    fn finished(&self, made: Vec<Made>, levels: &Levels) -> Result<Vec<Level>> {
        let meshes: Vec<&Mesh> = made.iter().map(|level| &level.mesh).collect();
        let errors: Vec<f64> = made.iter().map(|level| level.silhouette_error).collect();
        let reports = judged(self.mesh, &meshes, &errors, levels, self.progress)?;
        let channels = self.mesh.attributes();
        let mut found = vec![Level {
            mesh: self.mesh.clone(),
            target: self.mesh.triangles().len(),
            stop: Stop::TargetAboveInput,
            options: None,
            report: LevelReport::of_input(channels.channel(ChannelKind::Normal).is_some()),
        }];
        let own = levels.certify.then(|| self.mesh.enter_frame(self.frame));
        for (level, mut report) in made.into_iter().zip(reports) {
            let radius = self.lookout.sphere.radius;
            if let Some(seen) = level.seen.flatten() {
                let shares = levels.screen.shares(radius, seen.distance);
                report.see(seen, shares, self.frame);
            }
            let mesh = level.mesh;
            if let Some(own) = &own {
                let framed = mesh.enter_frame(self.frame);
                let pair = [own, &framed];
                let proved = certified_distance(pair, radius, &levels.screen, self.progress)?;
                report.certified_distance = Some(self.frame.leave_length(proved, 1));
            }
            found.push(Level {
                mesh,
                target: level.target,
                stop: level.stop,
                options: Some(level.options),
                report,
            });
        }
        Ok(found)
    }
}
