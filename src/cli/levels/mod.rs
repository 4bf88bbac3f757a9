//! `lodmark levels`: methods against each other from fine to coarse, as in Figure 4 of Zhang & Turk 2002.
//!
//! Every method runs once, down to the coarsest level; the levels above it come from its history. Those of geometric
//! methods are bit-equal to runs of their own with folds kept (`simplify --keep-folds`): unfolding happens once, after
//! the last collapse, and would set the coarsest level apart. Deviations for the image-driven method: pictures take over
//! where they would for the finest level, and only the coarsest level is polished.

mod chart;
mod judge;

use std::path::PathBuf;

use serde_json::json;

use super::{
    Common, Verdict, file_help, guidance_args::GuidanceArgs, input, report, table,
    terminal::Terminal,
};
use crate::{
    Error, Result,
    collapse::Topology,
    encode::atomic,
    io,
    mesh::{Mesh, canonical},
    metric::{
        report::{CompareOptions, Judge},
        surface::DEFAULT_SAMPLES,
    },
    simplify::{
        MethodName, MethodOptions, Options as RunOptions, Outcome, Target, image::Start,
        simplify_guided, simplify_with, visibility::VisibilityOptions,
    },
    visibility::Visibility,
};
use judge::Level;

/// Compare methods over a range of levels: image error, distance, a table and a chart
#[derive(Debug, clap::Args)]
#[command(after_long_help = file_help::paragraphs(&["\
Writes levels.csv and levels.svg into DIR. The image error is equation 5.11 of Zhang & Turk 2002: the root of the summed \
squared luma differences, flat, from the 20 corners of a dodecahedron; rms is the same per pixel, in levels. Distances \
are the larger of both ways, in % of the diagonal of the original's bounding box. `less` says how much less image error \
a method has than the first one, in %; 0 where neither has any. Its mean leaves out levels that either did not reach. \
Folds are kept at every level, as by simplify --keep-folds.", file_help::PARTIAL]))]
pub(super) struct LevelsArgs {
    /// The mesh to simplify: .obj, .ply, .stl, .glb or .gltf
    #[arg(value_name = "IN")]
    input: PathBuf,
    /// Folder for the results; made if missing
    #[arg(value_name = "DIR")]
    folder: PathBuf,
    /// Methods without an error of their own; the others are measured by the first one
    #[arg(long, value_enum, value_delimiter = ',', value_name = "NAME,...")]
    #[arg(default_value = "quadric,visibility")]
    methods: Vec<MethodName>,
    /// The levels, in % of the triangles
    #[arg(long, value_delimiter = ',', value_name = "PERCENT,...", default_value = "50,25,12,6,3,1.5,0.75", value_parser = parse_percent)]
    levels: Vec<f64>,
    /// Width and height of the images
    #[arg(long, value_name = "PIXELS", default_value_t = 512)]
    size: u32,
    /// Samples per pixel along each axis: 1, 2 or 4
    #[arg(long, value_name = "N", default_value_t = 2)]
    samples: u32,
    /// Points on each surface that distances are measured at [default: 500000]
    #[arg(long, value_name = "N", conflicts_with = "no_distance", value_parser = clap::value_parser!(u32).range(1..=100_000_000))]
    distance_samples: Option<u32>,
    /// Do not measure distances
    #[arg(long)]
    no_distance: bool,
    /// Let holes close and parts merge
    #[arg(long)]
    topology_free: bool,
    #[command(flatten)]
    guidance: GuidanceArgs,
    /// Write every level too, as METHOD-PERCENT.ply
    #[arg(long)]
    meshes: bool,
    /// Do not unite vertices with equal positions
    #[arg(long)]
    no_weld: bool,
}

/// The refusal of a method that is held to an error and has no levels.
fn bounded(method: MethodName) -> Error {
    Error::Usage(format!(
        "the method `{}` keeps to an error and has no levels; expected image, memoryless, quadric or visibility",
        method.name()
    ))
}

fn parse_percent(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(percent) if percent > 0.0 && percent <= 100.0 => Ok(percent),
        Ok(_) => Err(format!(
            "{text} % is no level; expected above 0 and up to 100"
        )),
        Err(_) => Err("expected numbers such as 50,25,12.5".into()),
    }
}

impl LevelsArgs {
    /// Refuses what makes no sense before anything is read; the levels from fine to coarse.
    fn check(&self) -> Result<Vec<f64>> {
        for (i, method) in self.methods.iter().enumerate() {
            if self.methods[..i].contains(method) {
                let told = "--methods names a method twice; expected different ones";
                return Err(Error::Usage(told.into()));
            }
        }
        if let Some(&method) = self.methods.iter().find(|m| m.defaults().is_none()) {
            return Err(bounded(method));
        }
        if !self.methods.contains(&MethodName::Visibility)
            && let Some(name) = self.guidance.first_given()
        {
            return Err(Error::Usage(format!(
                "{name} means nothing without the method `visibility`; leave it out or add it to --methods"
            )));
        }
        let mut levels = self.levels.clone();
        levels.sort_by(|a, b| b.total_cmp(a));
        levels.dedup();
        Ok(levels)
    }

    fn distance_samples(&self) -> Option<u32> {
        (!self.no_distance).then(|| self.distance_samples.unwrap_or(DEFAULT_SAMPLES))
    }

    /// Equation 5.11 and distances.
    fn judged_by(&self) -> CompareOptions {
        CompareOptions {
            views: None,
            size: self.size,
            samples: self.samples,
            image_error: true,
            distance_samples: self.distance_samples(),
            folds: false,
            ..CompareOptions::default()
        }
    }

    /// Runs a method down to the last of `targets`; `visibility` was measured before, where it is given.
    fn run(
        &self,
        method: MethodName,
        mesh: &Mesh,
        targets: &[usize],
        visibility: Option<&Visibility>,
        terminal: &Terminal,
    ) -> Result<Outcome> {
        let (Some(&finest), Some(&coarsest)) = (targets.first(), targets.last()) else {
            return Err(Error::Internal("no levels".into()));
        };
        let amount = Target::Triangles(coarsest as u64);
        let own = method.defaults().ok_or_else(|| bounded(method))?;
        let mut options = RunOptions::new(own, amount);
        options.unfold = false;
        options.rules.topology = if self.topology_free {
            Topology::Free
        } else {
            Topology::Preserve
        };
        match &mut options.method {
            MethodOptions::Image(own) => {
                own.start = Start::Triangles(Start::Auto.triangles(Some(finest)) as u64);
            }
            MethodOptions::Visibility(own) => {
                *own = VisibilityOptions {
                    quadric: own.quadric,
                    ..self.guidance.options()
                };
                if let Some(visibility) = visibility {
                    return simplify_guided(mesh, &options, visibility, terminal);
                }
            }
            _ => {}
        }
        simplify_with(mesh, &options, terminal)
    }
}

pub(super) fn run(options: &LevelsArgs, common: &Common, terminal: &Terminal) -> Result<Verdict> {
    let percents = options.check()?;
    let mesh = input::read(&options.input, !options.no_weld, terminal)?;
    input::require_triangles(&options.input, &mesh)?;
    let mesh = canonical(&mesh).mesh;
    input::require_triangles(&options.input, &mesh)?;
    let visibility = options.guidance.read(&mesh)?;
    let count = mesh.triangles().len();
    let folder = &options.folder;
    atomic::folder(folder)?;
    let (csv, svg) = (folder.join("levels.csv"), folder.join("levels.svg"));
    input::require_outputs([&csv, &svg].into_iter().chain(&common.json))?;
    let targets = percents.iter().map(|p| Target::ratio(p / 100.0).of(count));
    let targets = targets
        .filter_map(Result::transpose)
        .collect::<Result<Vec<_>>>()?;
    let judge = Judge::new(&mesh, &options.judged_by())?;
    let (mut runs, mut reached) = (Vec::new(), Vec::new());
    for &method in &options.methods {
        let outcome = options.run(method, &mesh, &targets, visibility.as_ref(), terminal)?;
        let levels = judge::levels_of(&mesh, &outcome, (&percents, &targets), terminal)?;
        for level in levels.iter().filter(|_| options.meshes) {
            let name = format!("{}-{}.ply", level.method, level.percent);
            io::write(&folder.join(name), &level.mesh)?;
        }
        reached.extend(levels);
        runs.push(json!({ "options": outcome.options, "v_mesh": outcome.v_mesh() }));
    }
    let levels = judge::judged(&judge, &reached, terminal)?;
    atomic::write_bytes(&csv, judge::csv(&levels).as_bytes())?;
    let title = format!("{}, {count} triangles", options.input.display());
    atomic::write_bytes(&svg, chart::svg(&title, &levels).as_bytes())?;
    let means = judge::means(&levels);
    let less = means
        .iter()
        .map(|&(name, mean)| json!({ "method": name, "percent": mean }));
    let less: Vec<_> = less.collect();
    report(
        common,
        "levels",
        json!({
            "input": options.input, "levels": percents, "size": options.size, "samples": options.samples,
            "distance_samples": options.distance_samples(), "runs": runs,
        }),
        json!({ "triangles_in": count, "levels": levels, "mean_less_image_error": less }),
    )?;
    terminal.finish();
    show(&levels, &means, terminal);
    answer!("{} and {}: written", csv.display(), svg.display());
    Ok(Verdict::Good)
}

fn show(levels: &[Level], means: &[(&'static str, f64)], terminal: &Terminal) {
    let head = "method|level %|triangles|image error|RMS|mean %|max %|less %";
    let mut rows = vec![table::head(head)];
    for level in levels {
        if !level.reached {
            terminal.say(&format!(
                "{}: no edge may be collapsed any more at {} triangles, above the {} of {} %; try --topology-free",
                level.method, level.triangles, level.target, level.percent
            ));
        }
        rows.push(vec![
            level.method.into(),
            level.percent.to_string(),
            level.triangles.to_string(),
            format!("{:.1}", level.image_error),
            format!("{:.4}", level.rms),
            table::number(level.distance_mean.map(|d| 100.0 * d), 5),
            table::number(level.distance_max.map(|d| 100.0 * d), 4),
            table::number(level.less, 2),
        ]);
    }
    answer!("{}", table::aligned(&rows));
    for (name, mean) in means {
        answer!("{name}: {mean:.2} % less image error on average over the levels that are reached");
    }
}
