//! `lodmark lod`: a chain of levels of detail, with what an engine needs to switch between them.

use std::path::{Path, PathBuf};

use serde_json::json;

use super::{Common, Verdict, input, report, table, terminal::Terminal};
use crate::{
    Error, Result,
    chain::{self, Chain, Levels, Screen, chain_with},
    collapse::Topology,
    encode::atomic,
    mesh::canonical,
    metric::surface::DEFAULT_SAMPLES,
    simplify::{
        MethodName, Normals, Options as RunOptions, Target,
        image::{DrivingShading, Preset},
    },
};

/// Names of level files that a report may not have: halving makes no more.
const MOST: usize = 40;

/// Write a chain of levels of detail, and the distances from which on each may be shown
#[derive(Debug, clap::Args)]
#[command(after_long_help = HELP)]
pub(super) struct LodArgs {
    /// The mesh: .obj, .ply, .stl, .glb or .gltf
    #[arg(value_name = "IN")]
    input: PathBuf,
    /// Folder for NAME_LOD0.EXT, NAME_LOD1.EXT, ... and NAME.lod.json, if IN is NAME.EXT; made if missing
    #[arg(value_name = "DIR")]
    folder: PathBuf,
    /// The levels below the input from fine to coarse: shares such as 0.25, or numbers of triangles [default: halves, until
    /// the silhouette error would exceed 5 % of the covered area or 8 triangles are left]
    #[arg(long, value_delimiter = ',', value_name = "LEVEL,...", value_parser = parse_level)]
    levels: Vec<Target>,
    /// Instead of sizes, the distances from the middle from which on the levels are to be shown: each gets as few triangles
    /// as --error-px and --error-rms let be from there on
    #[arg(
        long,
        value_delimiter = ',',
        value_name = "LENGTH,...",
        conflicts_with = "levels"
    )]
    #[arg(allow_negative_numbers = true)]
    distances: Vec<f64>,
    /// Largest displacement of the silhouette from the switch distance on, in pixels
    #[arg(long, value_name = "PIXELS", default_value_t = Screen::default().error_px, allow_negative_numbers = true)]
    error_px: f64,
    /// Largest RMS of luma from the switch distance on, over a square picture as high as the screen, 0 to 255
    #[arg(long, value_name = "LEVELS", default_value_t = Screen::default().error_rms, allow_negative_numbers = true)]
    error_rms: f64,
    /// Height of the screen in pixels
    #[arg(long, value_name = "PIXELS", default_value_t = Screen::default().height)]
    screen_height: u32,
    /// Angle from the lower to the upper side of the screen, in degrees
    #[arg(long, value_name = "DEGREES", default_value_t = Screen::default().fov_deg, allow_negative_numbers = true)]
    fov: f64,
    /// Prove, besides, from which distance on no silhouette is displaced by more than --error-px (slow)
    #[arg(long)]
    certify: bool,
    /// The rule that orders the collapses: image, memoryless, quadric or visibility
    #[arg(long, value_enum, default_value_t = MethodName::Image)]
    method: MethodName,
    /// The recipe of the method `image` [default: default]
    #[arg(long, value_enum)]
    preset: Option<Preset>,
    /// The shading that levels will be seen with (method image) [default: lit where the mesh stores normals, else flat]
    #[arg(long, value_enum)]
    shading: Option<DrivingShading>,
    /// Whether seams may break, holes close and parts merge; auto: only as far as a level needs
    #[arg(long, value_enum, default_value_t = Topology::Auto)]
    topology: Topology,
    /// Let whole pieces vanish though they are seen, where a level needs it
    #[arg(long)]
    drop_pieces: bool,
    /// The stored normals of the levels, where IN has some
    #[arg(long, value_enum, default_value_t = Normals::Fit)]
    normals: Normals,
    /// Width and height of the pictures that levels are judged in
    #[arg(long, value_name = "PIXELS", default_value_t = 512, value_parser = clap::value_parser!(u32).range(1..=2048))]
    size: u32,
    /// Points on each surface that distances are measured at
    #[arg(long, value_name = "N", default_value_t = DEFAULT_SAMPLES, value_parser = clap::value_parser!(u32).range(1..=100_000_000))]
    distance_samples: u32,
    /// Do not unite vertices with equal positions
    #[arg(long)]
    no_weld: bool,
}

const HELP: &str = "\
Level 0 is the input as lodmark reads it: welded, in canonical order. Every other level is, bit for bit, what `lodmark \
simplify` gives for as many triangles. Images that a glTF file holds are written once, beside the levels.

NAME.lod.json has for each level its file with two hashes, triangles, vertices, image errors and distances as `lodmark \
compare` measures them, and switch_distance: the least distance of the viewer from the middle of the minimum bounding \
sphere of the input (`sphere`) from which on, in all of 24 directions, the silhouette is displaced by at most --error-px and \
luma differs by at most --error-rms. It is measured by rendering input and level as they are seen from there, and is no \
nearer than where the sphere fills the height of the screen; null where there is none. Seen from there the sphere has, by \
its diameter, the share screen_height of the height of the screen (Unity) or screen_diameter (Unreal), and the share \
coverage of the area of a 16:9 screen (MSFT_lod): where a level begins; it ends where the next one begins. geometric_error \
is a length (3D Tiles). The displacement is the largest distance, in pixels, from what one of both covers to what the other \
one covers. certified_distance is what --certify proves, for silhouettes alone.

Example: three levels for a screen of 1440 lines, in the format of the input:
  lodmark lod helmet.glb out --levels 0.5,0.2,0.05 --screen-height 1440 --fov 50";

/// A share, with a point in it, or a number of triangles.
fn parse_level(text: &str) -> Result<Target, String> {
    let told =
        || format!("`{text}` is no level; expected a share such as 0.25 or a number of triangles");
    if let Ok(count) = text.parse::<u64>() {
        return match count {
            0 => Err(told()),
            _ => Ok(Target::triangles(count)),
        };
    }
    match text.parse::<f64>() {
        Ok(share) if share > 0.0 && share < 1.0 => Ok(Target::ratio(share)),
        _ => Err(told()),
    }
}

impl LodArgs {
    /// The options of a run.
    fn run_options(&self) -> Result<RunOptions> {
        let own = self.method.defaults().ok_or_else(|| {
            Error::Usage(format!(
                "the method `{}` keeps to an error and has no levels; expected image, memoryless, quadric or visibility",
                self.method.name()
            ))
        })?;
        let mut options = RunOptions::new(own, Target::triangles(1))
            .topology(self.topology)
            .normals(self.normals);
        if let Some(preset) = self.preset {
            options = options.preset(preset);
        }
        if let Some(shading) = self.shading {
            options = options.shading(shading);
        }
        options.rules.drop_pieces = self.drop_pieces;
        options.check()?;
        Ok(options)
    }

    /// The plan of the chain.
    fn plan(&self) -> Levels {
        let levels = match (self.levels.as_slice(), self.distances.as_slice()) {
            ([], []) => Levels::halving(),
            ([], distances) => Levels::distances(distances.iter().copied()),
            (targets, _) => Levels::targets(targets.iter().copied()),
        };
        let screen = Screen::new(self.screen_height, self.fov);
        let screen = screen.accept(self.error_px, self.error_rms);
        let levels = levels
            .screen(screen)
            .judged(self.size, self.distance_samples);
        match self.certify {
            true => levels.certify(),
            false => levels,
        }
    }

    /// Refuses files that cannot be written, before long work.
    fn require_outputs(&self, name: &Path, json: Option<&PathBuf>) -> Result<()> {
        let mut outputs = vec![self.folder.join(chain::manifest_name(name)?)];
        for level in 0..MOST.max(self.levels.len() + 1) {
            outputs.push(self.folder.join(chain::level_name(name, level)?));
        }
        input::require_outputs(outputs.iter().chain(json))
    }
}

pub(super) fn run(options: &LodArgs, common: &Common, terminal: &Terminal) -> Result<Verdict> {
    let (own, levels) = (options.run_options()?, options.plan());
    let name = Path::new(options.input.file_name().unwrap_or_default());
    chain::level_name(name, 0)?;
    let mesh = input::read(&options.input, !options.no_weld, terminal)?;
    input::require_triangles(&options.input, &mesh)?;
    let mesh = canonical(&mesh).mesh;
    input::require_triangles(&options.input, &mesh)?;
    levels.check_for(&mesh, &own)?;
    atomic::folder(&options.folder)?;
    options.require_outputs(name, common.json.as_ref())?;
    let chain = chain_with(&mesh, &own, &levels, terminal)?;
    let written = chain::write(&chain, &options.folder, name)?;
    for note in &written.notes {
        terminal.say(note);
    }
    let found = &written.content;
    report(
        common,
        "lod",
        json!({
            "input": options.input, "folder": options.folder, "levels": options.levels,
            "distances": options.distances, "certify": options.certify, "size": options.size,
            "distance_samples": options.distance_samples, "run": own,
        }),
        json!({
            "triangles_in": mesh.triangles().len(), "manifest": written.manifest, "sphere": found["sphere"],
            "screen": found["screen"], "levels": found["levels"],
        }),
    )?;
    terminal.finish();
    show(&chain, terminal);
    answer!("{}: written", written.manifest.display());
    Ok(Verdict::Good)
}

fn show(chain: &Chain, terminal: &Terminal) {
    let head =
        "level|triangles|vertices|RMS|silhouette %|max distance|switch distance|screen height";
    let mut rows = vec![table::head(head)];
    for (number, level) in chain.levels.iter().enumerate() {
        let (triangles, report) = (level.mesh.triangles().len(), &level.report);
        if triangles > level.target {
            terminal.say(&format!(
                "level {number}: no edge may be collapsed any more at {triangles} triangles, above the {} asked for; try \
                 --topology free",
                level.target
            ));
        }
        if report.switch_distance.is_none() {
            terminal.say(&format!(
                "level {number}: differs by more than what is accepted from every distance; try a larger --error-rms"
            ));
        }
        rows.push(vec![
            number.to_string(),
            triangles.to_string(),
            level.mesh.positions().len().to_string(),
            format!("{:.3}", report.rms_lit.unwrap_or(report.rms_flat)),
            format!("{:.2}", 100.0 * report.silhouette_error),
            format!("{:.4e}", report.distance_max),
            table::number(report.switch_distance, 4),
            table::number(report.shares.map(|shares| shares.screen_height), 4),
        ]);
    }
    for distance in &chain.left_out {
        terminal.say(&format!(
            "no level for the distance {distance}: nothing smaller than the level before may be shown from there"
        ));
    }
    answer!("{}", table::aligned(&rows));
}
