//! `lodmark visibility`: V(t), V(M), and what follows from them.

use std::{
    ops::Range,
    path::{Path, PathBuf},
};

use super::{chart, merge};
use crate::{
    Error, Result,
    cli::{Common, Verdict, file_help, has_extension, input, report, terminal::Terminal},
    encode::{atomic, npy},
    io,
    mesh::Mesh,
    visibility::{
        self, ConvergenceStep, MeasureOptions, PartialVisibility, Visibility, VisibilityTable,
        convergence, remove_hidden,
    },
};

/// Measure how visible every triangle is from all around (Zhang & Turk 2002)
#[derive(Debug, clap::Args)]
#[command(after_long_help = file_help::PARTIAL)]
pub(in crate::rooms::cli) struct VisibilityArgs {
    /// The mesh: .obj, .ply, .stl, .glb or .gltf; it is brought into canonical order first
    #[arg(value_name = "IN")]
    input: PathBuf,
    #[command(flatten)]
    choice: Choice,
    /// Write the mesh, white where never seen, over red and yellow to green, with V(t) of every face (.ply)
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
    /// Write which camera sees which triangle of --out, a row of bits for every camera, as .npy
    #[arg(long, value_name = "FILE")]
    table: Option<PathBuf>,
    /// Write the error of 6 to 1,026 cameras against 4,098 as FILE.csv and FILE.svg
    #[arg(long, value_name = "FILE")]
    convergence: Option<PathBuf>,
    /// Write the mesh without the triangles that no camera sees
    #[arg(long, value_name = "FILE")]
    remove_hidden: Option<PathBuf>,
    /// Keep this many rings of hidden triangles around the seen ones [default: 0]
    #[arg(long, value_name = "K", requires = "remove_hidden")]
    rings: Option<u32>,
    /// Write the counts: parts for merge-visibility, or, of all views, what simplify can read
    #[arg(long, value_name = "FILE")]
    partial: Option<PathBuf>,
    /// Draw only cameras A to B - 1, for --partial
    #[arg(long, value_name = "A..B", requires = "partial", value_parser = parse_range,
        conflicts_with_all = ["out", "table", "convergence", "remove_hidden", "from"])]
    view_range: Option<Range<u32>>,
    /// Take the counts of all views from this file instead of drawing them
    #[arg(long, value_name = "FILE", conflicts_with_all = ["Choice", "table", "convergence"])]
    from: Option<PathBuf>,
    /// Do not unite vertices with equal positions
    #[arg(long)]
    no_weld: bool,
}

/// The rules of the measurement.
#[derive(Debug, clap::Args)]
#[group(id = "Choice", multiple = true)]
struct Choice {
    /// The published method to the letter
    #[arg(long)]
    paper: bool,
    /// 6, 18, 66, 258, 1026 or 4098 [default: 258]
    #[arg(long, value_name = "N", value_parser = parse_cameras)]
    cameras: Option<u32>,
    /// Width and height of the ID buffers [default: 480]
    #[arg(long, value_name = "PIXELS")]
    size: Option<u32>,
    /// See the share of a triangle's samples that show it, instead of all or nothing
    #[arg(long)]
    fractional: bool,
    /// Measure the side that is seen better, for triangles turned either way
    #[arg(long)]
    two_sided: bool,
    /// Measure larger triangles in pieces with edges up to this [default: 8.9, with --paper 16]
    #[arg(long, value_name = "PIXELS|none", value_parser = parse_limit)]
    edge_limit: Option<EdgeLimit>,
    /// Sub-pixel bits: 8 or 16 [default: 8]
    #[arg(long, value_name = "BITS")]
    subpixel_bits: Option<u32>,
}

/// An `Option` in an `Option` means something else to clap.
#[derive(Clone, Copy, Debug)]
struct EdgeLimit(Option<f64>);

fn parse_range(text: &str) -> Result<Range<u32>, String> {
    let expected =
        || "expected A..B, the first camera and one past the last, such as 0..86".to_string();
    let (start, end) = text.split_once("..").ok_or_else(expected)?;
    let number = |text: &str| text.parse().map_err(|_| expected());
    Ok(number(start)?..number(end)?)
}

/// Parses a number of cameras into the number of subdivisions of the octahedron.
pub(in crate::rooms::cli) fn parse_cameras(text: &str) -> Result<u32, String> {
    let known = [6, 18, 66, 258, 1_026, 4_098_u32];
    let count: Option<u32> = text.parse().ok();
    let found = known.iter().position(|&k| Some(k) == count);
    let expected = || "expected 6, 18, 66, 258, 1026 or 4098 cameras".into();
    found.map(|k| k as u32).ok_or_else(expected)
}

fn parse_limit(text: &str) -> Result<EdgeLimit, String> {
    if text == "none" {
        return Ok(EdgeLimit(None));
    }
    let limit = text.parse().map(|limit| EdgeLimit(Some(limit)));
    limit.map_err(|_| "expected a number of pixels, or `none` for whole triangles".into())
}

impl Choice {
    fn resolve(&self) -> Result<MeasureOptions> {
        let default = match self.paper {
            true => MeasureOptions::paper(),
            false => MeasureOptions::default(),
        };
        let resolved = MeasureOptions {
            octahedron: self.cameras.unwrap_or(default.octahedron),
            size: self.size.unwrap_or(default.size),
            subpixel_bits: match self.subpixel_bits {
                Some(bits) => bits.try_into().map_err(Error::Usage)?,
                None => default.subpixel_bits,
            },
            fractional: self.fractional,
            two_sided: self.two_sided,
            edge_limit: self.edge_limit.map_or(default.edge_limit, |limit| limit.0),
            ..default
        };
        resolved.check()?;
        Ok(resolved)
    }
}

pub(crate) fn run(args: &VisibilityArgs, common: &Common, terminal: &Terminal) -> Result<Verdict> {
    let figure = args.convergence.as_ref();
    let figure = figure.map(|path| ["csv", "svg"].map(|kind| named(path, kind)));
    check_outputs(args, figure.as_ref(), common)?;
    let survey = args.from.as_deref().map(merge::read).transpose()?;
    let measurement = match &survey {
        Some(survey) => *survey.options(),
        None => args.choice.resolve()?,
    };
    let mesh = input::read(&args.input, !args.no_weld, terminal)?;
    input::require_triangles(&args.input, &mesh)?;
    let mesh = input::canonical(&args.input, &mesh, terminal).mesh;
    input::require_triangles(&args.input, &mesh)?;
    let resolved = serde_json::json!({ "input": args.input, "measurement": measurement });
    if let (Some(range), Some(path)) = (&args.view_range, &args.partial) {
        let part = PartialVisibility::of_views(&mesh, &measurement, range.clone(), terminal)?;
        merge::write(path, &part)?;
        report(common, "visibility", resolved, merge::summary(&part))?;
        merge::tell(path, &part);
        return Ok(Verdict::Good);
    }
    let (found, table) = measured(args, &mesh, &measurement, survey, terminal)?;
    let steps = match &figure {
        Some(_) => convergence(&mesh, &measurement, terminal)?,
        None => Vec::new(),
    };
    let kept = match &args.remove_hidden {
        Some(_) => Some(remove_hidden(&mesh, &found, args.rings.unwrap_or(0))?),
        None => None,
    };
    if let (Some(path), Some(table)) = (&args.table, &table) {
        npy::write_plane(path, table.packed())?;
    }
    if let Some(path) = &args.out {
        atomic::write_bytes(path, &visibility::ply::encode(&mesh, &found)?)?;
    }
    if let Some([csv, svg]) = &figure {
        atomic::write_bytes(csv, chart::csv(&steps).as_bytes())?;
        atomic::write_bytes(svg, chart::svg(&steps).as_bytes())?;
    }
    if let (Some(path), Some(kept)) = (&args.remove_hidden, &kept) {
        for note in io::write(path, kept)? {
            terminal.say(&format!("{}: {note}", path.display()));
        }
    }
    let numbers = Numbers {
        v_mesh: found.mesh(),
        never_seen_area: found.never_seen_area(),
        never_seen_triangles: found.never_seen(),
        cameras: measurement.cameras(),
        triangles: mesh.triangles().len(),
        triangles_kept: kept.as_ref().map(|m| m.triangles().len()),
        convergence: (!steps.is_empty()).then_some(&steps),
    };
    report(common, "visibility", resolved, &numbers)?;
    tell(&numbers, &measurement, &steps);
    Ok(Verdict::Good)
}

/// The findings, for the report.
#[derive(Debug, serde::Serialize)]
struct Numbers<'a> {
    v_mesh: f64,
    /// Share of the surface.
    never_seen_area: f64,
    never_seen_triangles: usize,
    cameras: u32,
    triangles: usize,
    #[serde(skip_serializing_if = "Option::is_none")]
    triangles_kept: Option<usize>,
    #[serde(skip_serializing_if = "Option::is_none")]
    convergence: Option<&'a Vec<ConvergenceStep>>,
}

/// Measures, or takes a measurement from its file; keeps the counts and the table where they are asked for.
fn measured(
    options: &VisibilityArgs,
    mesh: &Mesh,
    measurement: &MeasureOptions,
    survey: Option<PartialVisibility>,
    terminal: &Terminal,
) -> Result<(Visibility, Option<VisibilityTable>)> {
    let with_file = survey.is_some() || options.partial.is_some();
    if !with_file && options.table.is_none() {
        return Ok((visibility::measure(mesh, measurement, terminal)?, None));
    }
    let (survey, table) = match survey {
        Some(survey) => (survey, None),
        None if options.table.is_some() => {
            let (survey, table) = PartialVisibility::with_table(mesh, measurement, terminal)?;
            (survey, Some(table))
        }
        None => {
            let all = 0..measurement.cameras();
            let survey = PartialVisibility::of_views(mesh, measurement, all, terminal)?;
            (survey, None)
        }
    };
    let found = match &options.from {
        Some(path) => merge::finish(path, &survey, mesh)?,
        None => survey.finish(mesh)?,
    };
    if let Some(path) = &options.partial {
        merge::write(path, &survey)?;
    }
    Ok((found, table))
}

fn check_outputs(
    options: &VisibilityArgs,
    figure: Option<&[PathBuf; 2]>,
    common: &Common,
) -> Result<()> {
    if let Some(path) = &options.out
        && !has_extension(path, "ply")
    {
        return Err(Error::Usage(format!(
            "{}: colours and V(t) of faces are written as PLY only; choose a name that ends in .ply",
            path.display()
        )));
    }
    let mut beside = None;
    if let Some(path) = &options.remove_hidden {
        io::writable_format(path)?;
        beside = io::written_beside(path);
    }
    let single = [
        &beside,
        &options.out,
        &options.table,
        &options.remove_hidden,
        &options.partial,
        &common.json,
    ];
    let figure = figure.into_iter().flatten();
    input::require_outputs(single.into_iter().flatten().chain(figure))
}

/// `path` with an extension, which replaces only another of those of the figure: `bunny-0.5` has none.
fn named(path: &Path, extension: &str) -> PathBuf {
    if has_extension(path, "csv") || has_extension(path, "svg") {
        return path.with_extension(extension);
    }
    let mut name = path.as_os_str().to_owned();
    name.push(".");
    name.push(extension);
    name.into()
}

fn tell(numbers: &Numbers<'_>, measurement: &MeasureOptions, steps: &[ConvergenceStep]) {
    answer!("V(M)                {:.6}", numbers.v_mesh);
    answer!(
        "never seen          {} of {} triangles, {:.4} % of the area",
        numbers.never_seen_triangles,
        numbers.triangles,
        100.0 * numbers.never_seen_area
    );
    let (cameras, size) = (numbers.cameras, measurement.size);
    answer!("cameras             {cameras}, {size} x {size} pixels");
    if let Some(kept) = numbers.triangles_kept {
        answer!("kept                {kept} triangles");
    }
    for step in steps {
        let (cameras, mesh, error) = (step.cameras, step.mesh, step.error);
        answer!("with {cameras:4} cameras   V(M) {mesh:.6}, error {error:.6}");
    }
}
