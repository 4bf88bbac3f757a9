//! `lodmark simplify`: one reduced mesh.

mod distance_args;
mod run_log;
mod view_bound_args;

use std::{io::Write, path::PathBuf};

use clap::{ArgGroup, ValueEnum};
use serde::Serialize;

use super::{Common, Verdict, guidance_args::GuidanceArgs, input, report, terminal::Terminal};
use crate::{
    Error, Result,
    collapse::{Schedule, Topology},
    encode::atomic,
    io,
    mesh::{self, content_sha256},
    simplify::{
        MethodOptions, Options as RunOptions, Stop, Target,
        image::{
            Comparison, DrivingShading, EngineName, ImageOptions, Polish, PolishCounters, Preset,
            Size, Start,
        },
        memoryless::MemorylessOptions,
        quadric::QuadricOptions,
        simplify_guided, simplify_with,
        tolerance::Guarantee,
        visibility::VisibilityOptions,
    },
    view::ViewsName,
};
use distance_args::DistanceArgs;
use view_bound_args::ViewBoundArgs;

/// Write a mesh with fewer triangles that looks the same
#[derive(Debug, clap::Args)]
#[command(group(ArgGroup::new("amount").args(["triangles", "ratio"])))]
pub(super) struct SimplifyArgs {
    /// The mesh to simplify: .obj, .ply or .stl
    #[arg(value_name = "IN")]
    input: PathBuf,
    /// Where to write the result; an existing file is replaced
    #[arg(value_name = "OUT")]
    output: PathBuf,
    /// Simplify to at most this many triangles
    #[arg(long, short = 't', value_name = "N", allow_negative_numbers = true, value_parser = input::parse_triangles::<u64>)]
    triangles: Option<u64>,
    /// Simplify to at most this share of the triangles, above 0 and up to 1
    #[arg(long, value_name = "R", allow_negative_numbers = true)]
    ratio: Option<f64>,
    /// Stop before the RMS luma difference over the driving views exceeds this, 0 to 255 (method image)
    #[arg(long, value_name = "LEVELS", allow_negative_numbers = true)]
    error_rms: Option<f64>,
    /// What orders the collapses
    #[arg(long, value_enum, default_value_t = Method::Image)]
    method: Method,
    /// Image method: the recipe [default: default]
    #[arg(long, value_enum)]
    preset: Option<PresetName>,
    /// Image method: dodecahedron, rhombicuboctahedron, octahedron:K, spiral:N, or a view file [default: by preset]
    #[arg(long, value_name = "SET|FILE")]
    views: Option<ViewsName>,
    /// Image method: width and height of the driving images [default: by preset]
    #[arg(long, value_name = "PIXELS")]
    size: Option<u32>,
    /// Image method: samples per pixel along each axis of the driving images: 1, 2 or 4 [default: by preset]
    #[arg(long, value_name = "N")]
    samples: Option<u32>,
    /// Image method: the shading that the result will be seen with [default: flat]
    #[arg(long, value_enum)]
    shading: Option<ShadingName>,
    /// Image method: how many of the views look through the front into the interior
    #[arg(long, value_name = "K")]
    interior_views: Option<usize>,
    /// Image method: triangles at which images take over from the memoryless method, or `none`
    #[arg(long, value_name = "N|none", value_parser = parse_start)]
    start_triangles: Option<Start>,
    /// Image method: sweeps that move vertices and flip edges after the last collapse; 0 is none [default: by preset]
    #[arg(long, value_name = "SWEEPS")]
    polish: Option<u32>,
    /// Image method: how pictures follow the mesh; never changes a result
    #[arg(long, value_enum)]
    engine: Option<EngineChoice>,
    /// When edges are evaluated again; eager is slow and for comparison [default: by preset]
    #[arg(long, value_enum)]
    evaluation: Option<Evaluation>,
    /// Measure the true rank of every K-th collapse among all legal ones; slow, changes no result
    #[arg(long, value_name = "K", default_value_t = 0)]
    measure_rank: u64,
    /// Leave folds and flipped faces as the collapses made them; then every level of the history is a direct run's
    #[arg(long)]
    keep_folds: bool,
    /// Whether holes may close and parts may merge
    #[arg(long, value_enum, default_value_t = TopologyName::Preserve)]
    topology: TopologyName,
    /// Quadric and visibility methods: planes with uncertainty (Trettner & Kobbelt 2020)
    #[arg(long)]
    probabilistic: bool,
    #[command(flatten)]
    guidance: GuidanceArgs,
    #[command(flatten)]
    view_bound: ViewBoundArgs,
    #[command(flatten)]
    within: DistanceArgs,
    /// Write the history of collapses, moves and flips, for `lodmark replay`
    #[arg(long, value_name = "FILE")]
    history: Option<PathBuf>,
    /// Do not unite vertices with equal positions
    #[arg(long)]
    no_weld: bool,
    /// Exit with code 6, writing nothing, where the target is not reached
    #[arg(long)]
    strict: bool,
}

/// Methods by name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Method {
    /// By what a collapse does to pictures (Lindstrom & Turk 2000)
    Image,
    /// By swept volumes (Lindstrom & Turk 1998/99)
    Memoryless,
    /// By distances to planes (Garland & Heckbert 1997/98)
    Quadric,
    /// By distances to planes, weighted by how visible they are (Zhang & Turk 2002)
    Visibility,
    /// Within a distance of the input, guaranteed (after Cox & Chibelushi 2005)
    Tolerance,
    /// Within an angle for all viewers in a cell (after Eisemann & Décoret 2007)
    ViewBounded,
}

/// [`Preset`] by name.
#[derive(Clone, Copy, Debug, ValueEnum)]
enum PresetName {
    /// The published method to the letter
    Paper,
    /// Few small pictures and one sweep of polishing
    Fast,
    /// 42 views and polishing: the best meshes for the time that geometric methods take
    Default,
    /// More views, larger pictures and more polishing: several times the time for a few percent
    Best,
}

/// [`DrivingShading`] by name.
#[derive(Clone, Copy, Debug, ValueEnum)]
enum ShadingName {
    /// One intensity per triangle
    Flat,
    /// Interpolated intensities
    Gouraud,
    /// Every other view interpolated, for a result that is seen both ways
    Mixed,
}

/// [`EngineName`] by name.
#[derive(Clone, Copy, Debug, ValueEnum)]
enum EngineChoice {
    /// All fragments of every sample, sorted
    Layers,
    /// Row and column buckets: the published way, much slower
    Buckets,
}

/// [`Schedule`] by name.
#[derive(Clone, Copy, Debug, ValueEnum)]
enum Evaluation {
    /// At the front of the queue
    Lazy,
    /// At once at the new vertex, otherwise lazy
    Semi,
    /// At once
    Eager,
}

/// [`Topology`] by name.
#[derive(Clone, Copy, Debug, ValueEnum)]
enum TopologyName {
    /// Holes, handles and parts stay
    Preserve,
    /// Any edge may collapse
    Free,
}

fn parse_start(text: &str) -> Result<Start, String> {
    if text == "none" {
        return Ok(Start::Input);
    }
    match text.parse() {
        Ok(0) | Err(_) => Err("expected a number of triangles, at least 1, or `none`".into()),
        Ok(n) => Ok(Start::Triangles(n)),
    }
}

/// What the report says about the result.
#[derive(Debug, Serialize)]
struct Summary<'a> {
    input: &'a PathBuf,
    output: &'a PathBuf,
    triangles_in: usize,
    triangles_out: usize,
    vertices_out: usize,
    method: &'static str,
    stop: &'a Stop,
    error_rms: Option<f64>,
    /// V(M) of the input; only for the method that is guided by it.
    v_mesh: Option<f64>,
    phases: &'a [crate::simplify::Phase],
    /// What is proved about the distance from the input; only for the method that keeps one.
    #[serde(skip_serializing_if = "Option::is_none")]
    guarantee: Option<Guarantee>,
    #[serde(skip_serializing_if = "Option::is_none")]
    polish: Option<&'a PolishCounters>,
    /// Of images and geometry, where they were close.
    #[serde(skip_serializing_if = "Option::is_none")]
    comparison: Option<Comparison>,
    content_sha256: String,
}

impl SimplifyArgs {
    /// The options of the library; refuses what the method cannot honour.
    fn resolve(&self) -> Result<RunOptions> {
        let target = match (self.triangles, self.ratio) {
            (Some(n), _) => Target::Triangles(n),
            (None, Some(r)) => Target::Ratio(r),
            (None, None)
                if self.error_rms.is_some()
                    || self.view_bound.has_error()
                    || self.within.has_error() =>
            {
                Target::ErrorOnly
            }
            (None, None) => {
                return Err(Error::Usage(
                    "no target; give --triangles N, --ratio R or an error that the method honours: --error-rms LEVELS, \
                     --error E, --error-abs LENGTH, --error-deg DEGREES or --error-px PIXELS"
                        .into(),
                ));
            }
        };
        let preset = match self.preset.unwrap_or(PresetName::Default) {
            PresetName::Paper => Preset::Paper,
            PresetName::Fast => Preset::Fast,
            PresetName::Default => Preset::Default,
            PresetName::Best => Preset::Best,
        };
        let method = match self.method {
            Method::Image => MethodOptions::Image(self.image(preset)),
            Method::Memoryless => MethodOptions::Memoryless(MemorylessOptions::default()),
            Method::Quadric => MethodOptions::Quadric(self.quadric()),
            Method::Visibility => MethodOptions::Visibility(VisibilityOptions {
                quadric: self.quadric(),
                ..self.guidance.options()
            }),
            Method::ViewBounded => MethodOptions::ViewBounded(self.view_bound.options()?),
            Method::Tolerance => MethodOptions::Tolerance(self.within.options()?),
        };
        self.refuse_foreign(&method)?;
        let mut options = RunOptions::new(method, target);
        options.error_rms = self.error_rms;
        options.measure_rank = self.measure_rank;
        options.unfold &= !self.keep_folds;
        options.schedule = match self.evaluation {
            Some(Evaluation::Lazy) => Schedule::Lazy,
            Some(Evaluation::Semi) => Schedule::Semi,
            Some(Evaluation::Eager) => Schedule::Eager,
            None => options.schedule,
        };
        options.rules.topology = match self.topology {
            TopologyName::Preserve => Topology::Preserve,
            TopologyName::Free => Topology::Free,
        };
        options.check()?;
        Ok(options)
    }

    fn quadric(&self) -> QuadricOptions {
        if self.probabilistic {
            QuadricOptions::probabilistic()
        } else {
            QuadricOptions::default()
        }
    }

    fn image(&self, preset: Preset) -> ImageOptions {
        let default = preset.shaded(match self.shading {
            None | Some(ShadingName::Flat) => DrivingShading::Flat,
            Some(ShadingName::Gouraud) => DrivingShading::Gouraud,
            Some(ShadingName::Mixed) => DrivingShading::Mixed,
        });
        ImageOptions {
            views: self.views.clone().unwrap_or(default.views),
            size: self.size.map_or(default.size, Size::Pixels),
            samples: self.samples.unwrap_or(default.samples),
            interior_views: self.interior_views.unwrap_or(default.interior_views),
            start: self.start_triangles.unwrap_or(default.start),
            polish: Polish {
                sweeps: self.polish.unwrap_or(default.polish.sweeps),
                ..default.polish
            },
            engine: match self.engine {
                None => default.engine,
                Some(EngineChoice::Layers) => EngineName::Layers,
                Some(EngineChoice::Buckets) => EngineName::Buckets,
            },
            ..default
        }
    }

    /// An option that the chosen method would ignore is an error.
    fn refuse_foreign(&self, method: &MethodOptions) -> Result<()> {
        let image = [
            ("--preset", self.preset.is_some()),
            ("--views", self.views.is_some()),
            ("--size", self.size.is_some()),
            ("--samples", self.samples.is_some()),
            ("--shading", self.shading.is_some()),
            ("--interior-views", self.interior_views.is_some()),
            ("--start-triangles", self.start_triangles.is_some()),
            ("--polish", self.polish.is_some()),
            ("--engine", self.engine.is_some()),
        ];
        let quadric = [("--probabilistic", self.probabilistic)];
        let ordering = [("--keep-folds", self.keep_folds)];
        let guidance = self.guidance.given();
        let bound = self.view_bound.given();
        let distance = self.within.given();
        let foreign: &[(&str, bool)] = match method {
            MethodOptions::Image(_) => {
                &[quadric.as_slice(), &ordering, &guidance, &bound, &distance].concat()
            }
            MethodOptions::Memoryless(_) => {
                &[image.as_slice(), &quadric, &guidance, &bound, &distance].concat()
            }
            MethodOptions::Quadric(_) => &[image.as_slice(), &guidance, &bound, &distance].concat(),
            MethodOptions::Visibility(_) => &[image.as_slice(), &bound, &distance].concat(),
            MethodOptions::Tolerance(_) => {
                &[image.as_slice(), &quadric, &ordering, &guidance, &bound].concat()
            }
            MethodOptions::ViewBounded(_) => {
                &[image.as_slice(), &quadric, &ordering, &guidance, &distance].concat()
            }
        };
        if let Some((name, _)) = foreign.iter().find(|(_, given)| *given) {
            return Err(Error::Usage(format!(
                "{name} means nothing to the method `{}`; leave it out or choose another --method",
                method.name()
            )));
        }
        if let (
            MethodOptions::Image(ImageOptions {
                views: ViewsName::File(path),
                ..
            }),
            true,
        ) = (
            method,
            self.size.is_some()
                || self.samples.is_some()
                || self.shading.is_some()
                || self.interior_views.is_some(),
        ) {
            return Err(Error::Usage(format!(
                "--size, --samples, --shading and --interior-views are part of the view file {}; leave them out",
                path.display()
            )));
        }
        Ok(())
    }
}

pub(super) fn run(options: &SimplifyArgs, common: &Common, terminal: &Terminal) -> Result<Verdict> {
    let resolved = options.resolve()?;
    io::writable_format(&options.output)?;
    let outputs = [
        Some(&options.output),
        options.history.as_ref(),
        options.view_bound.output(),
        common.json.as_ref(),
    ];
    input::require_outputs(outputs.into_iter().flatten())?;
    let mesh = input::read(&options.input, !options.no_weld, terminal)?;
    input::require_triangles(&options.input, &mesh)?;
    let triangles_in = mesh.triangles().len();
    let canonical = mesh::canonical(&mesh);
    drop(mesh);
    if canonical.degenerate > 0 {
        terminal.say(&format!(
            "{}: left out {} triangles that use a vertex twice",
            options.input.display(),
            canonical.degenerate
        ));
    }
    let outcome = match options.guidance.read(&canonical.mesh)? {
        Some(visibility) => simplify_guided(&canonical.mesh, &resolved, &visibility, terminal)?,
        None => simplify_with(&canonical.mesh, &resolved, terminal)?,
    };
    run_log::tell(&options.input, triangles_in, &outcome, terminal);
    let bounded = matches!(
        outcome.options.method,
        MethodOptions::ViewBounded(_) | MethodOptions::Tolerance(_)
    ) && outcome.options.target == Target::ErrorOnly;
    let short = !matches!(outcome.stop, Stop::TargetReached | Stop::TargetAboveInput);
    if options.strict && short && !bounded {
        return Err(Error::TargetNotReached(format!(
            "{} triangles are left, more than asked for, and nothing was written; without --strict they would be",
            outcome.mesh.triangles().len()
        )));
    }
    for note in io::write(&options.output, &outcome.mesh)? {
        terminal.say(&format!("{}: {note}", options.output.display()));
    }
    if let Some(path) = &options.history {
        let bytes = outcome.history.to_bytes();
        atomic::write(path, |file: &mut dyn Write| file.write_all(&bytes))?;
    }
    options.view_bound.write(&canonical.mesh, &outcome)?;
    let summary = Summary {
        input: &options.input,
        output: &options.output,
        triangles_in,
        triangles_out: outcome.mesh.triangles().len(),
        vertices_out: outcome.mesh.positions().len(),
        method: outcome.options.method.name(),
        stop: &outcome.stop,
        error_rms: outcome.error_rms(),
        v_mesh: outcome.v_mesh(),
        guarantee: outcome.guarantee(),
        phases: &outcome.phases,
        polish: outcome.polish(),
        comparison: outcome.comparison(),
        content_sha256: content_sha256(&outcome.mesh),
    };
    report(common, "simplify", &outcome.options, &summary)?;
    answer!(
        "{}: {} -> {} triangles, {} vertices",
        options.output.display(),
        summary.triangles_in,
        summary.triangles_out,
        summary.vertices_out
    );
    Ok(Verdict::Good)
}
