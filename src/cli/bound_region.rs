//! `lodmark bound-region`: figures of validity regions, as in Eisemann & Décoret 2007, Figures 2 and 7.

use std::{fmt::Write, path::PathBuf};

use glam::DVec3;

use crate::{
    Error, Result,
    bound::{
        planar::Aperture,
        region::{self, Profile},
        view_cell::{Shape, ViewCell, file},
    },
    cli::{Common, Verdict, file_help, has_extension, input, report, terminal::Terminal},
    encode::atomic,
    io,
    mesh::{Mesh, MeshParts},
    num::Each,
};

/// Draw where a point may move before a viewer in a view cell sees it move by more than an angle
#[derive(Debug, clap::Args)]
#[command(after_long_help = file_help::paragraphs(&["\
A .svg shows the region in a plane through the first point: that of point and cell for a segment or a line, one that \
holds the way to the cell for others, or the one across --normal. A mesh (.obj, .ply, .stl, .glb, .gltf) is the region's surface. \
Where the region has no end it is cut off at --reach. The cell is drawn in red, of one without an end what is in the \
picture.", &file_help::cells()]))]
pub(super) struct BoundRegionArgs {
    /// Figure (.svg) or mesh (.obj, .ply, .stl, .glb, .gltf)
    #[arg(value_name = "OUT")]
    output: PathBuf,
    /// Where viewers may be: a JSON cell file
    #[arg(long, value_name = "FILE")]
    cell: PathBuf,
    /// The point, as x,y,z; may be given several times
    #[arg(long = "point", value_name = "X,Y,Z", required = true, allow_hyphen_values = true, value_parser = parse_point)]
    points: Vec<DVec3>,
    /// The angle, in degrees: at least 0 and less than 90
    #[arg(long, value_name = "DEGREES", allow_negative_numbers = true)]
    error_deg: f64,
    /// Cut the region off at this distance from its point [default: twice the largest bounded extent]
    #[arg(long, value_name = "LENGTH", allow_negative_numbers = true)]
    reach: Option<f64>,
    /// Figure: the normal of the plane that is shown
    #[arg(long, value_name = "X,Y,Z", allow_hyphen_values = true, value_parser = parse_point)]
    normal: Option<DVec3>,
    /// Figure: directions around each point [default: 720]
    #[arg(long, value_name = "N")]
    directions: Option<u32>,
    /// Mesh: 20 * 4^K triangles for each point, K from 0 to 7 [default: 4]
    #[arg(long, value_name = "K")]
    subdivisions: Option<u32>,
}

pub(super) fn run(args: &BoundRegionArgs, common: &Common, terminal: &Terminal) -> Result<Verdict> {
    let svg = has_extension(&args.output, "svg");
    if !svg {
        io::writable_format(&args.output)?;
    }
    let misplaced = if svg {
        args.subdivisions.map(|_| "--subdivisions is for a mesh")
    } else if args.directions.is_some() || args.normal.is_some() {
        Some("--directions and --normal are for a figure (.svg)")
    } else {
        None
    };
    if let Some(what) = misplaced {
        let told = format!("{what}; {} is none", args.output.display());
        return Err(Error::Usage(told));
    }
    let beside = io::written_beside(&args.output);
    let outputs = [&args.output].into_iter().chain(&beside);
    input::require_outputs(outputs.chain(&common.json))?;
    let aperture = Aperture::degrees(args.error_deg)?;
    let cell = file::read(&args.cell)?;
    let directions = args.directions.unwrap_or(720);
    let subdivisions = args.subdivisions.unwrap_or(4);
    for p in args.points.iter().filter(|&&p| cell.contains(p)) {
        terminal.say(&format!(
            "the point {p} lies in the cell, where viewers may stand on it: it may not move at all"
        ));
    }
    if svg {
        let text = args.figure(&cell, aperture, directions)?;
        atomic::write_bytes(&args.output, text.as_bytes())?;
    } else {
        let shell = |&p| region::shell(&cell, p, aperture, subdivisions, args.reach);
        let shells = args.points.iter().map(shell).collect::<Result<_>>()?;
        io::write(&args.output, &together(shells)?)?;
    }
    let points: Vec<[f64; 3]> = args.points.iter().map(DVec3::to_array).collect();
    report(
        common,
        "bound-region",
        serde_json::json!({
            "cell": cell, "points": points, "error_deg": args.error_deg, "reach": args.reach,
            "normal": args.normal.map(|n| n.to_array()), "directions": svg.then_some(directions),
            "subdivisions": (!svg).then_some(subdivisions),
        }),
        serde_json::json!({ "output": args.output }),
    )?;
    let (output, count, degrees) = (args.output.display(), points.len(), args.error_deg);
    answer!("{output}: {count} validity regions for {degrees} degrees");
    Ok(Verdict::Good)
}

impl BoundRegionArgs {
    fn figure(&self, cell: &ViewCell, aperture: Aperture, directions: u32) -> Result<String> {
        let first = self.points.first().copied().unwrap_or_default();
        let normal = || region::profile_normal(cell, first);
        let normal = self.normal.unwrap_or_else(normal);
        let profile = |&p| region::profile(cell, p, normal, aperture, directions, self.reach);
        let profiles = self
            .points
            .iter()
            .map(profile)
            .collect::<Result<Vec<_>>>()?;
        Ok(svg(&self.points, &profiles, cell))
    }
}

/// An endless cell in a figure.
struct Trace {
    /// The nearest place to the first point.
    foot: [f64; 2],
    /// Along the line, or the border of a half-space.
    along: [f64; 2],
    /// The side of the border where viewers are.
    inward: Option<[f64; 2]>,
}

impl Trace {
    /// A line as it is seen along the normal, a plane or half-space where the plane of the figure cuts its border; `None`
    /// where it does not or only far away, or the line is seen end on, up to two degrees.
    fn of(cell: &ViewCell, origin: DVec3, [x, y]: [DVec3; 2]) -> Option<Self> {
        // Down the page.
        let flat = |d: DVec3| [d.dot(x), -d.dot(y)];
        let (foot, along, inward) = match cell.shape() {
            Shape::Line { point, direction } => {
                let foot = *point + *direction * (origin - *point).dot(*direction);
                (flat(foot - origin), flat(*direction), None)
            }
            Shape::Plane { point, normal } | Shape::HalfSpace { point, normal } => {
                let [a, b] = flat(*normal);
                let share = normal.dot(*point - origin) / (a * a + b * b);
                let solid = matches!(cell.shape(), Shape::HalfSpace { .. });
                ([a * share, b * share], [-b, a], solid.then_some([-a, -b]))
            }
            _ => return None,
        };
        let seen = along[0] * along[0] + along[1] * along[1] > 1e-3;
        (seen && foot.iter().all(|x| x.is_finite())).then_some(Self {
            foot,
            along,
            inward,
        })
    }

    /// The ends of the line, `far` lengths of its direction away, and with them those of the side of the viewers.
    fn corners(&self, far: f64) -> Vec<[f64; 2]> {
        let ends = [-far, far].each(|t| [0, 1].each(|k| self.foot[k] + self.along[k] * t));
        let mut all = ends.to_vec();
        if let Some(inward) = self.inward {
            let beyond = |end: [f64; 2]| [0, 1].each(|k| end[k] + inward[k] * 2.0 * far);
            all.extend([beyond(ends[1]), beyond(ends[0])]);
        }
        all
    }
}

/// Draws outlines with their points, and the corners of the cell with all lines between them, seen along the normal; of a
/// cell without an end what is in the picture.
fn svg(points: &[DVec3], profiles: &[Profile], cell: &ViewCell) -> String {
    let Some([x, y]) = profiles.first().map(|p| p.axes) else {
        return String::new();
    };
    // Down the page.
    let flat = |p: DVec3| [(p - points[0]).dot(x), -(p - points[0]).dot(y)];
    let outline = |profile: &Profile| profile.outline.iter().map(|&p| flat(p)).collect();
    let outlines: Vec<Vec<[f64; 2]>> = profiles.iter().map(outline).collect();
    let trace = Trace::of(cell, points[0], [x, y]);
    let corners = cell.corners().unwrap_or_default();
    let cell: Vec<[f64; 2]> = corners.iter().map(|&p| flat(p)).collect();
    let foot = trace.as_ref().map(|t| &t.foot);
    let mut page = Page::around(outlines.iter().flatten().chain(&cell).chain(foot));
    if let Some(trace) = &trace {
        page.trace(trace);
    }
    for (outline, &point) in outlines.iter().zip(points) {
        let style = "fill=\"#cfe0f5\" stroke=\"#1f4e96\" stroke-width=\"1.5\"";
        page.polygon(outline, style);
        page.circle(flat(point), 3, "#1f4e96");
    }
    for (i, &a) in cell.iter().enumerate() {
        if cell.len() == 1 {
            page.circle(a, 4, "#b22222");
        }
        for &b in &cell[..i] {
            page.line(&[a, b]);
        }
    }
    page.text.push_str("</svg>\n");
    page.text
}

/// A page of 800 x 800 that shows a square of the figure's plane.
struct Page {
    low: [f64; 2],
    span: f64,
    text: String,
}

impl Page {
    /// A page on which all of these points lie, 20 from its border.
    fn around<'a>(points: impl Iterator<Item = &'a [f64; 2]>) -> Self {
        let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        for p in points {
            for axis in 0..2 {
                low[axis] = low[axis].min(p[axis]);
                high[axis] = high[axis].max(p[axis]);
            }
        }
        let span = (high[0] - low[0]).max(high[1] - low[1]);
        let text = "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 800 800\">\n<rect width=\"800\" \
                    height=\"800\" fill=\"white\"/>\n";
        Self {
            low,
            span: if span > 0.0 { span } else { 1.0 },
            text: text.into(),
        }
    }

    fn place(&self, p: [f64; 2]) -> [f64; 2] {
        let scale = 760.0 / self.span;
        [0, 1].each(|axis| 20.0 + (p[axis] - self.low[axis]) * scale)
    }

    fn path(&self, points: &[[f64; 2]]) -> String {
        let place = |&p: &[f64; 2]| {
            let [x, y] = self.place(p);
            format!("{x:.3},{y:.3}")
        };
        points.iter().map(place).collect::<Vec<_>>().join(" ")
    }

    // Writing to a string cannot fail.
    fn polygon(&mut self, points: &[[f64; 2]], style: &str) {
        let path = self.path(points);
        let _ = writeln!(self.text, "<polygon points=\"{path}\" {style}/>");
    }

    fn line(&mut self, points: &[[f64; 2]]) {
        let path = self.path(points);
        let style = "fill=\"none\" stroke=\"#b22222\" stroke-width=\"2\"";
        let _ = writeln!(self.text, "<polyline points=\"{path}\" {style}/>");
    }

    fn circle(&mut self, center: [f64; 2], radius: u32, fill: &str) {
        let [x, y] = self.place(center);
        let _ = writeln!(
            self.text,
            "<circle cx=\"{x:.3}\" cy=\"{y:.3}\" r=\"{radius}\" fill=\"{fill}\"/>"
        );
    }

    /// Draws an endless cell, out of the picture, however steep.
    fn trace(&mut self, trace: &Trace) {
        let far = 4.0 * self.span / (trace.along[0].abs() + trace.along[1].abs());
        let corners = trace.corners(far);
        if trace.inward.is_some() {
            self.polygon(&corners, "fill=\"#b22222\" fill-opacity=\"0.15\"");
        }
        self.line(&corners[..2]);
    }
}

/// Several meshes as one.
fn together(meshes: Vec<Mesh>) -> Result<Mesh> {
    let mut all = MeshParts::default();
    for mesh in meshes {
        let parts = mesh.into_parts();
        let first = all.positions.len() as u32;
        all.positions.extend(parts.positions);
        let moved = parts.triangles.iter().map(|t| t.each(|v| v + first));
        all.triangles.extend(moved);
        all.precision = parts.precision;
    }
    Mesh::new(all).map_err(Error::internal)
}

/// Three numbers with commas between them.
fn parse_point(text: &str) -> Result<DVec3, String> {
    let numbers = text.split(',').map(|part| part.trim().parse::<f64>());
    let numbers = numbers.collect::<Result<Vec<_>, _>>();
    let numbers = numbers.map_err(|e| format!("{e}; expected three numbers as in 1,0,-2.5"))?;
    match numbers[..] {
        [x, y, z] if numbers.iter().all(|n| n.is_finite()) => Ok(DVec3::new(x, y, z)),
        _ => Err("expected three numbers as in 1,0,-2.5".into()),
    }
}
