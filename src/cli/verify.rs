//! `lodmark verify`: holds a simplified mesh to what is claimed about it; exit code 1 where the claim is broken.

use std::path::{Path, PathBuf};

use clap::ArgGroup;
use serde_json::json;

use super::{Common, Verdict, file_help, input, report, terminal::Terminal};
use crate::{
    Error, Result,
    bound::{
        verify::{self, AngleReport, Claim, DistanceReport, Property, Record},
        view_cell,
    },
    encode::bytes,
    mesh::{self, Mesh},
    num::Each,
};

/// Check a guaranteed error by independent samples and proofs; exit code 1 where a point breaks it
#[derive(Debug, clap::Args)]
#[command(group(ArgGroup::new("claim").args(["error", "error_abs", "error_deg"]).required(true)))]
#[command(after_long_help = file_help::paragraphs(&["\
A distance is checked from both meshes to the other one: at samples spread over the area, along all edges, at all \
vertices, and by cutting every triangle until it is certain that all of it is near enough or that a point of it is \
not. The report says what was measured, where it was largest, what is proven, and what share of the area is undecided \
(near the claim itself, where no proof ends).

An angle is checked for the viewers in a cell with the file that `simplify --bound-out` wrote: that its pieces cover every \
original triangle without a gap, and that no point and what stands for it are seen under more than the angle, at samples \
and by proof. Without that file only a weaker property is checked: that every original point has some point of LOW within \
the angle.", &file_help::cells(), file_help::CORRESPONDENCE]))]
pub(super) struct VerifyArgs {
    /// The original mesh: .obj, .ply, .stl, .glb or .gltf
    #[arg(value_name = "REF")]
    reference: PathBuf,
    /// The simplified mesh
    #[arg(value_name = "LOW")]
    low: PathBuf,
    /// Claimed: no point of either mesh is farther from the other than this share of the original's bounding-box diagonal
    #[arg(long, value_name = "E", allow_negative_numbers = true)]
    error: Option<f64>,
    /// The same, in the units of the files
    #[arg(long, value_name = "LENGTH", allow_negative_numbers = true)]
    error_abs: Option<f64>,
    /// Check only that every point of LOW is near REF
    #[arg(long, conflicts_with = "error_deg")]
    one_sided: bool,
    /// Claimed: no viewer in --cell sees a point of REF and what stands for it under more than this angle, in degrees
    #[arg(long, value_name = "DEGREES", allow_negative_numbers = true)]
    #[arg(requires = "cell")]
    error_deg: Option<f64>,
    /// The viewpoints of --error-deg: a JSON cell file
    #[arg(long, value_name = "FILE", requires = "error_deg", conflicts_with_all = ["error", "error_abs"])]
    cell: Option<PathBuf>,
    /// The record of which part stands for which: the file that simplify --bound-out wrote
    #[arg(long, value_name = "FILE", requires = "error_deg", conflicts_with_all = ["error", "error_abs"])]
    bound: Option<PathBuf>,
    /// Points on each mesh [default: 1000000]
    #[arg(long, value_name = "N", default_value_t = 1_000_000, hide_default_value = true, value_parser = clap::value_parser!(u64).range(1..=100_000_000_000))]
    samples: u64,
}

pub(super) fn run(options: &VerifyArgs, common: &Common, terminal: &Terminal) -> Result<Verdict> {
    input::require_outputs(common.json.iter())?;
    let reference = input::read(&options.reference, false, terminal)?;
    input::require_triangles(&options.reference, &reference)?;
    let low = input::read(&options.low, false, terminal)?;
    input::require_triangles(&options.low, &low)?;
    let meshes = [&reference, &low];
    let holds = match (options.error, options.error_abs) {
        (Some(share), _) => distances(options, meshes, Claim::Relative(share), common, terminal)?,
        (None, Some(length)) => {
            distances(options, meshes, Claim::Absolute(length), common, terminal)?
        }
        (None, None) => angles(options, meshes, common, terminal)?,
    };
    Ok(Verdict::of(holds))
}

fn distances(
    options: &VerifyArgs,
    [reference, low]: [&Mesh; 2],
    claim: Claim,
    common: &Common,
    terminal: &Terminal,
) -> Result<bool> {
    let (one_sided, samples) = (options.one_sided, options.samples);
    let found = verify::distance(reference, low, claim, one_sided, samples, terminal)?;
    let resolved = json!({
        "reference": options.reference, "low": options.low, "claim": claim, "one_sided": one_sided, "samples": samples,
    });
    report(common, "verify", resolved, &found)?;
    tell(&found);
    Ok(found.holds)
}

fn angles(
    options: &VerifyArgs,
    [reference, low]: [&Mesh; 2],
    common: &Common,
    terminal: &Terminal,
) -> Result<bool> {
    let (degrees, samples) = (options.error_deg.unwrap_or(0.0), options.samples);
    let Some(path) = &options.cell else {
        let told = "--error-deg needs --cell FILE: the viewpoints that the bound holds for";
        return Err(Error::Usage(told.into()));
    };
    let cell = view_cell::file::read(path)?;
    let (mut record, mut original) = (None, reference.clone());
    if let Some(path) = &options.bound {
        let foreign =
            |to: &Path| Error::input(path, format!("does not belong to {}", to.display()));
        let found = Record::from_bytes(&bytes::read(path)?, path)?;
        if !found.is_to(low) {
            return Err(foreign(&options.low));
        }
        original = recorded(&found, reference).ok_or_else(|| foreign(&options.reference))?;
        record = Some(found);
    }
    let map = record.as_ref();
    let found = verify::angles(&original, low, &cell, degrees, map, samples, terminal)?;
    let resolved = json!({
        "reference": options.reference, "low": options.low, "error_deg": degrees, "cell": cell, "bound": options.bound,
        "samples": samples,
    });
    report(common, "verify", resolved, &found)?;
    tell_angles(&found, &original, reference);
    Ok(found.holds)
}

/// The original as the run that wrote the record saw it: in canonical order, welded or not.
fn recorded(record: &Record, reference: &Mesh) -> Option<Mesh> {
    let welded = mesh::weld(reference.clone()).mesh;
    [welded, reference.clone()]
        .iter()
        .map(|mesh| mesh::canonical(mesh).mesh)
        .find(|mesh| record.is_from(mesh))
}

/// The triangle of the file that a triangle of the canonical mesh is.
fn in_file(original: &Mesh, triangle: u32, reference: &Mesh) -> Option<usize> {
    let wanted = original.corners(triangle as usize);
    (0..reference.triangles().len()).find(|&t| {
        let [a, b, c] = reference.corners(t);
        [[a, b, c], [b, c, a], [c, a, b]].contains(&wanted)
    })
}

fn tell_angles(found: &AngleReport, original: &Mesh, reference: &Mesh) {
    let pairs = match found.property {
        Property::Correspondence => "every original point and what stands for it",
        Property::NearestInAngle => {
            "every original point and the simplified point nearest in angle (weaker: no --bound)"
        }
    };
    answer!(
        "claimed: at most {} degrees between {pairs}",
        found.claimed_deg
    );
    if found.part_of_cell {
        answer!(
            "the cell has no end: only viewpoints in a part of it, some sizes of the original wide, were looked from"
        );
    }
    if let Some(pieces) = found.pieces {
        match found.gap {
            Some((triangle, gap)) => answer!(
                "BROKEN: {pieces} pieces do not cover original triangle {} ({gap:?})",
                in_file(original, triangle, reference).unwrap_or(triangle as usize)
            ),
            None => answer!("{pieces} pieces cover every original triangle"),
        }
    }
    if let Some(w) = &found.worst {
        let [p, s, v] = [w.point, w.replacement, w.viewpoint]
            .each(|p| format!("({}, {}, {})", p[0], p[1], p[2]));
        answer!(
            "{} sightings, the largest angle {:.9} degrees: on triangle {} {p} and {s} seen from {v}",
            found.sightings,
            w.angle_deg,
            in_file(original, w.triangle, reference).unwrap_or(w.triangle as usize)
        );
    }
    if found.violations > 0 {
        answer!("BROKEN: {} sightings are above the claim", found.violations);
    }
    if let Some(degrees) = found.at_most_deg {
        answer!("no viewer sees any of them under more than {degrees:.9} degrees: proven");
    }
    if found.property == Property::Correspondence {
        let area = found.undecided_area;
        answer!("proven for all viewpoints of the cell but for {area:.3e} of the original's area");
    }
    answer!(
        "{}",
        if !found.holds {
            "the claim is broken"
        } else if found.proven {
            "the claim holds: proven"
        } else if found.property == Property::Correspondence && found.at_most_deg.is_none() {
            "nothing was found that breaks the claim, but no angle below 90 degrees is proven: viewers come very near to \
             what was moved"
        } else {
            "nothing breaks the claim"
        }
    );
}

fn tell(found: &DistanceReport) {
    let percent = |x: f64| {
        if found.diagonal > 0.0 {
            format!(" ({:.5} % of the diagonal)", 100.0 * x / found.diagonal)
        } else {
            String::new()
        }
    };
    let length = |x: f64| format!("{x:.6e}{}", percent(x));
    answer!("claimed: at most {}", length(found.claimed));
    for d in &found.directions {
        let to = match d.from {
            "reference" => "simplified",
            _ => "reference",
        };
        let (from, samples, triangle) = (d.from, d.samples, d.farthest.triangle);
        let ([x, y, z], largest) = (d.farthest.point, length(d.farthest.distance));
        answer!(
            "{from} -> {to}: {samples} points, largest {largest} on triangle {triangle} at ({x}, {y}, {z})"
        );
        let (most, area) = (length(d.upper_bound), d.undecided_area);
        if d.is_proven {
            answer!("  proven: at most {most}");
        } else {
            answer!(
                "  proven: at most {most}; the claim itself is undecided on {area:.2e} of the area"
            );
        }
        if !d.holds {
            let count = d.violations.max(1);
            answer!("  BROKEN: {count} of the points are farther away than claimed");
        }
    }
    match (found.holds, found.proven) {
        (false, _) => answer!("the claim is broken"),
        (true, true) => answer!("the claim holds: proven"),
        (true, false) => answer!("no point breaks the claim"),
    }
}
