//! `lodmark simplify`: one reduced mesh.

mod distance_args;
mod image_args;
pub(super) mod option_table;
mod run_log;
mod view_bound_args;
mod weight_args;

use std::{io::Write, path::PathBuf};

use clap::{ArgGroup, ArgMatches};
use serde::Serialize;

use super::{
    Common, Verdict, file_help, guidance_args::GuidanceArgs, input, report, terminal::Terminal,
};
use crate::{
    Error, Result,
    collapse::{Schedule, Topology},
    encode::atomic,
    io,
    mesh::content_sha256,
    simplify::{
        MethodName, Normals, NormalsReport, Options as RunOptions, Outcome, Stop, Tangents,
        TangentsReport, Target, WeightsReport,
        image::{Comparison, PolishCounters},
        simplify_guided, simplify_with,
        tolerance::Guarantee,
    },
};
use distance_args::DistanceArgs;
use image_args::ImageArgs;
use view_bound_args::ViewBoundArgs;
use weight_args::WeightSource;

/// Write a mesh with fewer triangles that looks the same
#[derive(Debug, clap::Args)]
#[command(after_long_help = file_help::paragraphs(&[file_help::WEIGHTS, &file_help::cells(), &file_help::views(), file_help::HISTORY, file_help::PARTIAL, file_help::CORRESPONDENCE]))]
#[command(group(ArgGroup::new("amount").args(["triangles", "ratio"])))]
pub(super) struct SimplifyArgs {
    /// The mesh to simplify: .obj, .ply, .stl, .glb or .gltf
    #[arg(value_name = "IN")]
    input: PathBuf,
    /// Where to write the result; an existing file is replaced
    #[arg(value_name = "OUT")]
    output: PathBuf,
    /// Simplify to at most this many triangles
    #[arg(help_heading = "Target", long, short = 't', value_name = "N", allow_negative_numbers = true, value_parser = input::parse_triangles::<u64>)]
    triangles: Option<u64>,
    /// Simplify to at most this share of the triangles, above 0 and up to 1
    #[arg(
        help_heading = "Target",
        long,
        value_name = "R",
        allow_negative_numbers = true
    )]
    ratio: Option<f64>,
    /// Stop before the RMS luma difference over the driving views exceeds this, 0 to 255 (method image)
    #[arg(
        help_heading = "Target",
        long,
        value_name = "LEVELS",
        allow_negative_numbers = true
    )]
    error_rms: Option<f64>,
    /// The rule that orders the collapses
    #[arg(long, value_enum, default_value_t = MethodName::Image)]
    method: MethodName,
    /// The schedule by which edges are evaluated again; eager is slow and for comparison [default: by preset]
    #[arg(long, value_enum, hide_short_help = true)]
    evaluation: Option<Schedule>,
    /// Measure the true rank of every K-th collapse among all legal ones; slow, changes no result
    #[arg(long, value_name = "K", default_value_t = 0, hide_short_help = true)]
    measure_rank: u64,
    /// Leave folds and flipped faces as the collapses made them; then every level of the history is a direct run's
    #[arg(long, hide_short_help = true)]
    keep_folds: bool,
    /// Whether seams may break, holes close and parts merge; auto: only as far as the target needs, pieces that no view sees
    /// before holes
    #[arg(long, value_enum, default_value_t = Topology::Auto)]
    topology: Topology,
    /// Let whole pieces vanish though they are seen, where the target needs it
    #[arg(long)]
    drop_pieces: bool,
    /// Give every mesh of a glTF file the share of the target that it has of the triangles
    #[arg(help_heading = "Target", long)]
    per_mesh: bool,
    /// Keep the vertices of open borders where they are
    #[arg(long)]
    lock_border: bool,
    /// Keep the vertices of texture and colour seams where they are
    #[arg(long)]
    lock_seams: bool,
    /// Keep the vertices between materials, or between the parts of a document, where they are
    #[arg(long)]
    lock_materials: bool,
    /// Keep more triangles where vertices weigh more, and those of weight 1 where they are: a .npy file, or a colour channel
    /// of IN such as COLOR_0.r
    #[arg(long, value_name = "FILE|CHANNEL", value_parser = weight_args::parse)]
    weights: Option<WeightSource>,
    #[command(flatten)]
    image: ImageArgs,
    /// The stored normals of the result, where IN has some
    #[arg(long, value_enum, default_value_t = Normals::Fit)]
    normals: Normals,
    /// The stored tangents of the result
    #[arg(long, value_enum, default_value_t = Tangents::Carry)]
    tangents: Tangents,
    /// Planes with uncertainty (Trettner & Kobbelt 2020)
    #[arg(long, hide_short_help = true)]
    probabilistic: bool,
    /// Distances in space, texture coordinates and colours, instead of in space alone (Garland & Heckbert 1998)
    #[arg(long, hide_short_help = true)]
    attributes: bool,
    #[command(flatten)]
    guidance: GuidanceArgs,
    #[command(flatten)]
    view_bound: ViewBoundArgs,
    #[command(flatten)]
    within: DistanceArgs,
    /// Write the history of collapses, moves and flips, for `lodmark replay`
    #[arg(help_heading = "Output", long, value_name = "FILE")]
    history: Option<PathBuf>,
    /// Do not unite vertices with equal positions
    #[arg(long)]
    no_weld: bool,
    /// Exit with code 6, writing nothing, where the target is not reached
    #[arg(help_heading = "Output", long)]
    strict: bool,
}

/// The result, for the report.
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
    /// Vertices that locks kept where they are.
    #[serde(skip_serializing_if = "is_zero")]
    locked_vertices: usize,
    /// Vertices that weights held and their means; only where some were given.
    #[serde(skip_serializing_if = "Option::is_none")]
    weights: Option<WeightsReport>,
    /// Triangles that the scene draws, each as often as its part is shown; only where that is not the number stored.
    #[serde(skip_serializing_if = "Option::is_none")]
    triangles_drawn: Option<[usize; 2]>,
    /// The proven distance from the input; only for the method that keeps one.
    #[serde(skip_serializing_if = "Option::is_none")]
    guarantee: Option<Guarantee>,
    #[serde(skip_serializing_if = "Option::is_none")]
    polish: Option<&'a PolishCounters>,
    /// The price of normals that are not the carried ones.
    #[serde(skip_serializing_if = "Option::is_none")]
    normals: Option<NormalsReport>,
    /// The account of tangents that were made.
    #[serde(skip_serializing_if = "Option::is_none")]
    tangents: Option<TangentsReport>,
    /// Of images and geometry, where they were close.
    #[serde(skip_serializing_if = "Option::is_none")]
    comparison: Option<Comparison>,
    /// One sentence for everything that reading or writing could not keep.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    notes: Vec<String>,
    content_sha256: String,
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde wants a reference")]
fn is_zero(count: &usize) -> bool {
    *count == 0
}

impl SimplifyArgs {
    /// The options of the library.
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
        let method = option_table::method_options(self)?;
        let mut options = RunOptions::new(method, target);
        options.error_rms = self.error_rms;
        options.measure_rank = self.measure_rank;
        options.normals = self.normals;
        options.tangents = self.tangents;
        options.unfold &= !self.keep_folds;
        options.schedule = self.evaluation.unwrap_or(options.schedule);
        options.rules.topology = self.topology;
        options.rules.drop_pieces = self.drop_pieces;
        options.per_mesh = self.per_mesh;
        options.locks.border = self.lock_border;
        options.locks.seams = self.lock_seams;
        options.locks.materials = self.lock_materials;
        options.check()?;
        Ok(options)
    }
}

/// Refuses an outcome that is short of its target.
fn require_target(outcome: &Outcome) -> Result<()> {
    let own = &outcome.options;
    let bounded = own.method.is_bounded() && own.target == Target::ErrorOnly;
    let reached = matches!(outcome.stop, Stop::TargetReached | Stop::TargetAboveInput);
    if reached || bounded {
        return Ok(());
    }
    Err(Error::TargetNotReached(format!(
        "{} triangles are left, more than asked for, and nothing was written; without --strict they would be",
        outcome.mesh.triangles().len()
    )))
}

pub(super) fn run(
    options: &SimplifyArgs,
    matches: &ArgMatches,
    common: &Common,
    terminal: &Terminal,
) -> Result<Verdict> {
    option_table::refuse_foreign(options.method, matches)?;
    let mut resolved = options.resolve()?;
    io::writable_format(&options.output)?;
    let beside = io::written_beside(&options.output);
    let outputs = [
        Some(&options.output),
        beside.as_ref(),
        options.history.as_ref(),
        options.view_bound.output(),
        common.json.as_ref(),
    ];
    input::require_outputs(outputs.into_iter().flatten())?;
    let read = input::read_with_notes(&options.input, !options.no_weld, terminal)?;
    input::require_triangles(&options.input, &read.mesh)?;
    let triangles_in = read.mesh.triangles().len();
    let canonical = input::canonical(&options.input, &read.mesh, terminal);
    if let Some(source) = &options.weights {
        resolved = resolved.weights(source.read(&options.input, &read, &canonical)?);
    }
    let (mesh, mut notes) = (canonical.mesh, read.notes);
    let outcome = match options.guidance.read(&mesh)? {
        Some(visibility) => simplify_guided(&mesh, &resolved, &visibility, terminal)?,
        None => simplify_with(&mesh, &resolved, terminal)?,
    };
    run_log::tell(&options.input, triangles_in, &outcome, terminal);
    if options.tangents == Tangents::Recompute {
        run_log::tell_tangents(outcome.tangents, terminal);
    }
    if options.strict {
        require_target(&outcome)?;
    }
    for note in io::write(&options.output, &outcome.mesh)? {
        terminal.say(&format!("{}: {note}", options.output.display()));
        notes.push(note);
    }
    if let Some(path) = &options.history {
        let bytes = outcome.history.to_bytes();
        atomic::write(path, |file: &mut dyn Write| file.write_all(&bytes))?;
    }
    options.view_bound.write(&mesh, &outcome)?;
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
        locked_vertices: outcome.locked_vertices,
        weights: outcome.weights,
        triangles_drawn: run_log::triangles_drawn(&mesh, &outcome),
        polish: outcome.polish(),
        normals: outcome.normals,
        tangents: outcome.tangents,
        comparison: outcome.comparison(),
        notes,
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
