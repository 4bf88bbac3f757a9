//! `lodmark bound`: how far a simplification is from its original for every viewer in a view cell, as a guarantee.

mod pictures;

mod switch_args;

use std::path::{Path, PathBuf};

use glam::DVec3;

use super::{Common, Verdict, file_help, input, report, terminal::Terminal};
use crate::{
    Error, Result,
    bound::{
        correspondence,
        heuristics::{self, Claims},
        nearest_triangle::{NearestTriangle, originals},
        surface::{self, Effort, Given, Measure, Pair, SurfaceBound},
        view_cell::{ViewCell, file},
    },
    encode::bytes,
    mesh::{self, Mesh},
    num::{Each, Frame},
    view::frame_of,
};

/// Guarantee how far a simplified mesh is from its original for every viewer in a view cell
#[derive(Debug, clap::Args)]
#[command(group(clap::ArgGroup::new("question").args(["cell", "switch_deg", "switch_px"]).required(true).multiple(true)))]
#[command(after_long_help = file_help::paragraphs(&["\
The guarantee: for every point of REF, not only its vertices, there is a point of LOW that no viewer of the cell sees \
more than that many degrees away from it. The points are those of the nearest triangle: REF is cut into parts, each goes \
to the triangle of LOW that is nearest to its centroid, each corner to the nearest point of that triangle. Neighbouring \
parts may go apart: the guarantee is about where points are seen, and says nothing of cracks or of what is in front. \
It holds one way; exchange REF and LOW for the other. A mesh without triangles is a point cloud. With --correspondence the map is the recorded one, which moves no two neighbours apart.", "\
The report has bound_deg (the guarantee), attained_deg (what is seen of a point: the guarantee is no larger by more than \
--precision unless the parts ran out or the cell meets the mesh), worst (that point, its replacement, its triangle and \
the viewpoint), pieces; with --heuristics: vertices_deg, edges_deg; with --switch-*: distance_bound, switch_distance.",
    &file_help::cells(), file_help::CORRESPONDENCE]))]
pub(super) struct BoundArgs {
    /// The original: .obj, .ply, .stl, .glb or .gltf
    #[arg(value_name = "REF")]
    reference: PathBuf,
    /// The mesh that stands for it
    #[arg(value_name = "LOW")]
    low: PathBuf,
    /// Where viewers may be: a JSON cell file, in the units of REF
    #[arg(long, value_name = "FILE")]
    cell: Option<PathBuf>,
    /// Which part of LOW stands for which part of REF, as `lodmark simplify --bound-out` wrote it: the guarantee then holds
    /// for that map, which is continuous, instead of the nearest triangle
    #[arg(long, value_name = "FILE", requires = "cell")]
    correspondence: Option<PathBuf>,
    /// By what share the guarantee may exceed what is attained, 0.0001 to 1 [default: 0.01]
    #[arg(long, value_name = "SHARE", default_value_t = Effort::default().precision, hide_default_value = true, allow_negative_numbers = true)]
    precision: f64,
    /// Parts of triangles that are looked at most; the guarantee holds wherever that ends [default: 20000000]
    #[arg(long, value_name = "N", default_value_t = Effort::default().pieces, hide_default_value = true)]
    pieces: u64,
    /// Write worst-view.png and worst-zoom.png (original, replacement, difference) as the viewer sees them who sees
    /// most, and views.json to draw them again with `lodmark render`
    #[arg(long, value_name = "DIR", requires = "cell")]
    pictures: Option<PathBuf>,
    /// Width and height of each picture [default: 512]
    #[arg(long, value_name = "PIXELS", requires = "pictures", default_value_t = 512, hide_default_value = true, value_parser = clap::value_parser!(u32).range(16..=4096))]
    size: u32,
    /// Say what tests of vertices and of edge lengths would have claimed: neither bounds anything
    #[arg(long, requires = "cell")]
    heuristics: bool,
    #[command(flatten)]
    switch: switch_args::SwitchArgs,
}

/// The guarantee in degrees and file units.
#[derive(Debug, serde::Serialize)]
struct Found {
    bound_deg: f64,
    attained_deg: f64,
    worst: Option<WorstPoint>,
    pieces: u64,
    /// The rule that chooses a point of LOW for each point of REF.
    map: &'static str,
    #[serde(flatten, skip_serializing_if = "Option::is_none")]
    claims: Option<ClaimsInDegrees>,
}

#[derive(Debug, serde::Serialize)]
struct ClaimsInDegrees {
    vertices_deg: f64,
    edges_deg: f64,
}

#[derive(Debug, serde::Serialize)]
struct WorstPoint {
    point: [f64; 3],
    replacement: [f64; 3],
    viewpoint: Option<[f64; 3]>,
    /// Of the file; with a correspondence, of the mesh in canonical order.
    triangle: u32,
}

pub(super) fn run(options: &BoundArgs, common: &Common, terminal: &Terminal) -> Result<Verdict> {
    if !(0.0001..=1.0).contains(&options.precision) {
        return Err(Error::Usage(format!(
            "precision is {}; expected a share from 0.0001 to 1",
            options.precision
        )));
    }
    let aperture = options.switch.aperture()?;
    let cell = options.cell.as_ref().map(file::read).transpose()?;
    let reference = input::read(&options.reference, true, terminal)?;
    let low = input::read(&options.low, true, terminal)?;
    for (path, mesh) in [(&options.reference, &reference), (&options.low, &low)] {
        require_vertices(path, mesh, terminal)?;
    }
    let frame = frame_for(&reference);
    let (own, other) = (reference.enter_frame(frame), low.enter_frame(frame));
    let nearest = NearestTriangle::new(other.in_frame_units())
        .ok_or_else(|| Error::Internal("a mesh with vertices has something near".into()))?;
    let effort = Effort {
        precision: options.precision,
        pieces: options.pieces,
    };
    let framed = cell.as_ref().map(|cell| cell.enter_frame(frame));
    let measured = |measure| {
        let faces = originals(own.in_frame_units());
        surface::measure(faces, &nearest, measure, effort, terminal)
    };
    let recorded = options.recorded(&reference, &low, frame)?;
    let found = match &framed {
        None => None,
        Some(cell) => {
            let angle = Measure::Angle(cell);
            let bound = match recorded {
                Some(pairs) => surface::measure(pairs, &Given, angle, effort, terminal)?,
                None => measured(angle)?,
            };
            let claims = options.heuristics.then(|| {
                heuristics::claims(own.in_frame_units(), other.in_frame_units(), &nearest, cell)
            });
            if let Some(folder) = &options.pictures {
                let meshes = [&own, &other];
                pictures::write(folder, options.size, meshes, &bound, frame, terminal)?;
            }
            let recorded = options.correspondence.is_some();
            Some(Found::new(&bound, claims, frame, recorded))
        }
    };
    let switch = aperture
        .map(|aperture| {
            let bound = measured(Measure::Distance)?;
            let distance = frame.leave_length(bound.bound, 1);
            Ok::<_, Error>(switch_args::Found::new(distance, aperture))
        })
        .transpose()?;
    options.tell(cell.as_ref(), found.as_ref(), switch.as_ref(), common)
}

#[derive(Debug, serde::Serialize)]
struct Sections<'a> {
    #[serde(flatten, skip_serializing_if = "Option::is_none")]
    found: Option<&'a Found>,
    #[serde(flatten, skip_serializing_if = "Option::is_none")]
    switch: Option<&'a switch_args::Found>,
}

impl BoundArgs {
    /// Writes the report and prints the findings.
    fn tell(
        &self,
        cell: Option<&ViewCell>,
        found: Option<&Found>,
        switch: Option<&switch_args::Found>,
        common: &Common,
    ) -> Result<Verdict> {
        report(
            common,
            "bound",
            serde_json::json!({
                "reference": self.reference, "low": self.low, "cell": cell,
                "correspondence": self.correspondence, "precision": self.precision,
                "pieces": self.pieces, "pictures": self.pictures, "size": self.size,
                "heuristics": self.heuristics, "switch": self.switch,
            }),
            Sections { found, switch },
        )?;
        if let Some(found) = found {
            found.tell();
        }
        if let Some(switch) = switch {
            switch.tell();
        }
        Ok(Verdict::Good)
    }

    /// The recorded map in units of `frame`, where there is one.
    fn recorded(&self, reference: &Mesh, low: &Mesh, frame: Frame) -> Result<Option<Vec<Pair>>> {
        let Some(path) = &self.correspondence else {
            return Ok(None);
        };
        let bytes = bytes::read(path)?;
        let original = mesh::canonical(reference).mesh;
        let Some(pairs) = correspondence::pairs(&bytes, path, &original, low)? else {
            let told = format!("does not belong to {}", self.reference.display());
            return Err(Error::input(path, told));
        };
        let inside = |pair: Pair| Pair {
            from: pair.from.each(|p| frame.enter(p)),
            to: pair.to.each(|p| frame.enter(p)),
            ..pair
        };
        Ok(Some(pairs.into_iter().map(inside).collect()))
    }
}

/// Refuses a mesh without vertices; one without triangles is a point cloud.
fn require_vertices(path: &Path, mesh: &Mesh, terminal: &Terminal) -> Result<()> {
    if mesh.positions().is_empty() {
        let told = "the file has neither triangles nor vertices; expected at least one vertex";
        return Err(Error::input(path, told));
    }
    if mesh.triangles().is_empty() {
        terminal.say(&format!(
            "{}: no triangles; its {} vertices are taken as a point cloud",
            path.display(),
            mesh.positions().len()
        ));
    }
    Ok(())
}

/// The frame of a mesh, or of its vertices where it has no triangles.
fn frame_for(mesh: &Mesh) -> Frame {
    if !mesh.triangles().is_empty() {
        return frame_of(mesh);
    }
    mesh.bounds().map_or_else(Frame::default, |(low, high)| {
        // Halves: the difference itself could be infinite.
        Frame::for_size((0.5 * high - 0.5 * low).max_element())
    })
}

impl Found {
    fn new(bound: &SurfaceBound, claims: Option<Claims>, frame: Frame, recorded: bool) -> Self {
        let outside = |p: DVec3| frame.leave(p).to_array();
        Self {
            bound_deg: bound.bound.to_degrees(),
            attained_deg: bound.worst.map_or(0.0, |w| w.value).to_degrees(),
            worst: bound.worst.map(|w| WorstPoint {
                point: outside(w.point),
                replacement: outside(w.replacement),
                viewpoint: w.viewpoint.map(outside),
                triangle: w.triangle,
            }),
            pieces: bound.pieces,
            map: match recorded {
                true => "correspondence",
                false => "nearest triangle",
            },
            claims: claims.map(|claims| ClaimsInDegrees {
                vertices_deg: claims.vertices.to_degrees(),
                edges_deg: claims.edges.to_degrees(),
            }),
        }
    }

    fn tell(&self) {
        answer!("guaranteed        {:.6} degrees", self.bound_deg);
        answer!("attained          {:.6} degrees", self.attained_deg);
        if let Some(worst) = &self.worst {
            let (point, triangle) = (worst.point, worst.triangle);
            answer!("  by the point    {point:?} of triangle {triangle}");
            answer!("  replaced by     {:?}", worst.replacement);
            match &worst.viewpoint {
                Some(viewpoint) => answer!("  as seen from    {viewpoint:?}"),
                None => answer!("  which the cell meets: no angle bounds it"),
            }
        }
        answer!("parts             {}", self.pieces);
        if let Some(claims) = &self.claims {
            answer!("tests would have claimed, and bound nothing:");
            answer!("  of vertices     {:.6} degrees", claims.vertices_deg);
            answer!("  of edge lengths {:.6} degrees", claims.edges_deg);
        }
    }
}
