//! `lodmark check-rays`: the rasterizer against ray casting.

use std::path::PathBuf;

use super::{Common, Verdict, file_help, input, report, terminal::Terminal};
use crate::{
    Error, Progress, Result,
    encode::{
        png,
        sheet::{PADDING, sheet},
    },
    num::fixed::SubpixelBits,
    raster::{self, Grid, Scene},
    validate::rays::{Class, Classified, RayCaster, Shown, Tally, cap},
    view::{self, Cull, Projection, Sphere, ViewSet, ViewsName, frame_of},
};

/// Cast a ray through every pixel centre and hold the rasterizer's ID buffer against what it hits; exit code 1 when a
/// difference is not explained, or when more are than rounding should make
#[derive(Debug, clap::Args)]
#[command(after_long_help = file_help::views())]
pub(super) struct CheckRaysArgs {
    /// The mesh: .obj, .ply, .stl, .glb or .gltf
    #[arg(value_name = "IN")]
    input: PathBuf,
    /// dodecahedron, rhombicuboctahedron, octahedron:K, or a view file
    #[arg(long, value_name = "SET|FILE", default_value = "dodecahedron")]
    views: ViewsName,
    /// Width and height of the images; a view file says its own [default: 480]
    #[arg(long, value_name = "PIXELS")]
    size: Option<u32>,
    /// Orthographic instead of perspective views
    #[arg(long)]
    orthographic: bool,
    /// Sub-pixel bits of the rasterizer: 8 or 16 [default: 16]
    #[arg(long, value_name = "BITS")]
    subpixel_bits: Option<u32>,
    /// Largest share of pixels that may differ and be explained [default: 1e-4 at 16 sub-pixel bits, 5e-3 at 8]
    #[arg(long, value_name = "SHARE")]
    cap: Option<f64>,
    /// Write a sheet of all views in class colours
    #[arg(long, value_name = "FILE.png")]
    picture: Option<PathBuf>,
}

impl CheckRaysArgs {
    fn set(&self, sphere: &Sphere) -> Result<ViewSet> {
        let (size, projection) = (self.size.unwrap_or(480), Projection::of(self.orthographic));
        let mut set = view::resolve(&self.views, sphere, [size; 2], projection)?;
        if let ViewsName::File(path) = &self.views {
            if self.size.is_some() || self.orthographic {
                return Err(Error::Usage(format!(
                    "size and projection are part of the view file {}; leave them out",
                    path.display()
                )));
            }
        } else {
            set.subpixel = SubpixelBits::Sixteen;
        }
        if let Some(bits) = self.subpixel_bits {
            set.subpixel = bits.try_into().map_err(Error::Usage)?;
        }
        Ok(set)
    }
}

pub(super) fn run(args: &CheckRaysArgs, common: &Common, terminal: &Terminal) -> Result<Verdict> {
    if args.cap.is_some_and(|cap| !(0.0..=1.0).contains(&cap)) {
        let told = "--cap is a share of all pixels; expected 0 to 1";
        return Err(Error::Usage(told.into()));
    }
    input::require_outputs(args.picture.iter().chain(&common.json))?;
    let mesh = input::read(&args.input, true, terminal)?;
    input::require_triangles(&args.input, &mesh)?;
    let frame = frame_of(&mesh);
    let sphere = Sphere::of_mesh(&mesh)
        .ok_or_else(|| Error::Internal("a mesh with triangles has a bounding sphere".into()))?;
    let set = args.set(&sphere)?.enter_frame(frame);
    let cap = args.cap.unwrap_or(cap(set.subpixel));
    if args.picture.is_some() {
        require_sheet(&set)?;
    }
    let mesh = mesh.enter_frame(frame);
    let (scene, caster) = (Scene::of(&mesh), RayCaster::new(mesh.in_frame_units()));
    let (mut tally, mut pictures, mut dropped) = (Tally::default(), Vec::new(), 0);
    for (i, view) in set.views.iter().enumerate() {
        terminal.step("cast rays", i as u64, set.views.len() as u64)?;
        let picture = raster::keys(&scene, view, &set);
        dropped += picture.dropped;
        let rays = caster.keys(view, &set, terminal)?;
        let classified = caster.classify(&set, i, [&picture.keys, &rays], terminal)?;
        tally.add(&classified);
        if args.picture.is_some() {
            pictures.push((colored(&classified), format!("view {i}")));
        }
    }
    if dropped > 0 {
        terminal.say(&format!(
            "{dropped} triangles were not drawn: a coordinate is not finite in a view"
        ));
    }
    let verdict = Verdict::of(tally.passes(cap));
    if let Some(path) = &args.picture {
        let columns = columns(pictures.len()) as u32;
        png::write_rgb(path, &sheet(&pictures, columns, PADDING)?)?;
    }
    let mut views = set.views.iter();
    let perspective = views.any(|v| matches!(v.eye, view::Eye::Point(_)));
    let culled = set.views.iter().any(|v| v.cull != Cull::None);
    report(
        common,
        "check-rays",
        serde_json::json!({
            "input": args.input, "views": args.views.to_string(), "width": set.width, "height": set.height,
            "samples": set.samples, "subpixel_bits": set.subpixel.bits(), "perspective": perspective,
            "culled": culled, "cap": cap,
        }),
        serde_json::json!({
            "tally": tally, "explained": tally.explained(), "explained_share": tally.explained_share(),
            "unexplained": tally.unexplained(), "dropped": dropped, "passed": verdict == Verdict::Good,
        }),
    )?;
    tell(&tally, &set, cap, verdict);
    Ok(verdict)
}

/// The classes, the worst pixels, the verdict.
fn tell(tally: &Tally, set: &ViewSet, cap: f64, verdict: Verdict) {
    answer!(
        "{} views of {} x {} samples, {} sub-pixel bits: {} rays",
        tally.views,
        set.width * set.samples,
        set.height * set.samples,
        set.subpixel.bits(),
        tally.pixels
    );
    if tally.grid_exact_views > 0 {
        let exact = tally.grid_exact_views;
        answer!("{exact} of the views need no rounding: there nothing may differ");
    }
    for class in Class::all() {
        let count = tally.of(class);
        if count > 0 || class <= Class::Degenerate {
            let kind = match class {
                _ if class.is_bug() => "  NOT EXPLAINED",
                _ if class.is_explained() => "  explained",
                _ => "",
            };
            answer!("  {:12} {count:12}{kind}", class.name());
        }
    }
    for w in &tally.worst {
        let shown = |s: &Shown| match (s.triangle, s.inside) {
            (Some(id), Some(inside)) => {
                format!("triangle {id} (depth {}, {inside}/2^24 px inside)", s.depth)
            }
            (Some(id), None) => format!("triangle {id} (depth {})", s.depth),
            (None, _) => "nothing".into(),
        };
        let (class, view, x, y) = (w.class.name(), w.view, w.x, w.y);
        let (raster, ray) = (shown(&w.raster), shown(&w.rays));
        answer!("  {class}: view {view} pixel ({x}, {y}): raster {raster}, ray {ray}");
    }
    let judgement = match verdict {
        Verdict::Good => "the rasterizer shows what rays hit",
        Verdict::Negative => "NOT what rays hit",
    };
    answer!(
        "{} unexplained, {} explained ({:.2e} of all, at most {cap:.0e} expected): {judgement}",
        tally.unexplained(),
        tally.explained(),
        tally.explained_share()
    );
}

/// A picture of the classes; a pixel that differs is a cross, bugs on top.
fn colored(view: &Classified) -> Grid<[u8; 3]> {
    let mut picture = view.classes.map(Class::color);
    let (width, height) = (picture.width(), picture.height());
    let mut order: Vec<_> = view.witnesses.iter().collect();
    order.sort_by_key(|w| w.class);
    for w in order {
        for (dx, dy) in [(0, 0), (1, 0), (2, 0), (0, 1), (0, 2)] {
            let below = (w.x.checked_add(dx), w.y.checked_add(dy));
            let above = (w.x.checked_sub(dx), w.y.checked_sub(dy));
            for place in [below, above] {
                if let (Some(x), Some(y)) = place
                    && x < width
                    && y < height
                {
                    let at = y as usize * width as usize + x as usize;
                    picture.values_mut()[at] = w.class.color();
                }
            }
        }
    }
    picture
}

/// Columns of a sheet that is as square as it comes.
fn columns(views: usize) -> usize {
    (1..views).find(|c| c * c >= views).unwrap_or(1)
}

/// Refuses a sheet that no picture holds: before long work, not after it.
fn require_sheet(set: &ViewSet) -> Result<()> {
    let side = u64::from((set.width * set.samples).max(set.height * set.samples));
    let columns = columns(set.views.len()) as u64;
    // Space for labels and between pictures.
    if columns * (side + 24) + 8 > u64::from(png::SIDE_LIMIT) {
        return Err(Error::Usage(format!(
            "a sheet of {} views of {side} samples is larger than {} per side: use fewer or smaller views, or no \
             --picture",
            set.views.len(),
            png::SIDE_LIMIT
        )));
    }
    Ok(())
}
