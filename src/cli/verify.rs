//! `lodmark verify`: holds a simplified mesh to what is claimed about it; exit code 1 where the claim is broken.

use std::path::PathBuf;

use clap::ArgGroup;

use super::{Common, Verdict, report, source, terminal::Terminal};
use crate::{
    Result,
    bound::verify::{self, Claim, DistanceReport},
};

/// Check a guaranteed error by independent samples and proofs; exit code 1 where a point breaks it
#[derive(Debug, clap::Args)]
#[command(group(ArgGroup::new("claim").args(["error", "error_abs"]).required(true)))]
#[command(after_help = "\
A distance is checked from both meshes to the other one: at samples spread over the area, along all edges, at all \
vertices, and by cutting every triangle until it is certain that all of it is near enough or that a point of it is \
not. The report says what was measured, where it was largest, what is proven, and what share of the area is undecided \
(near the claim itself, where no proof ends).")]
pub(super) struct Options {
    /// The original mesh: .obj, .ply or .stl
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
    #[arg(long, requires = "claim")]
    one_sided: bool,
    /// Points on each mesh [default: 1000000]
    #[arg(long, value_name = "N", default_value_t = 1_000_000, hide_default_value = true, value_parser = clap::value_parser!(u64).range(1..=100_000_000_000))]
    samples: u64,
}

pub(super) fn run(options: &Options, common: &Common, terminal: &Terminal) -> Result<Verdict> {
    source::require_outputs(common.json.iter())?;
    let reference = source::read(&options.reference, false, terminal)?;
    source::require_triangles(&options.reference, &reference)?;
    let low = source::read(&options.low, false, terminal)?;
    source::require_triangles(&options.low, &low)?;
    let claim = match (options.error, options.error_abs) {
        (Some(share), _) => Claim::Relative(share),
        (None, length) => Claim::Absolute(length.unwrap_or(0.0)),
    };
    let found = verify::distance(
        &reference,
        &low,
        claim,
        options.one_sided,
        options.samples,
        terminal,
    )?;
    report(
        common,
        "verify",
        serde_json::json!({
            "reference": options.reference, "low": options.low, "claim": claim,
            "one_sided": options.one_sided, "samples": options.samples,
        }),
        &found,
    )?;
    tell(&found);
    Ok(if found.holds {
        Verdict::Good
    } else {
        Verdict::Negative
    })
}

fn tell(found: &DistanceReport) {
    let percent = |x: f64| {
        if found.diagonal > 0.0 {
            format!(" ({:.5} % of the diagonal)", 100.0 * x / found.diagonal)
        } else {
            String::new()
        }
    };
    answer!(
        "claimed: at most {:.6e}{}",
        found.claimed,
        percent(found.claimed)
    );
    for d in &found.directions {
        let (f, to) = (
            &d.farthest,
            if d.from == "reference" {
                "simplified"
            } else {
                "reference"
            },
        );
        answer!(
            "{} -> {to}: {} points, largest {:.6e}{} on triangle {} at ({}, {}, {})",
            d.from,
            d.samples,
            f.distance,
            percent(f.distance),
            f.triangle,
            f.point[0],
            f.point[1],
            f.point[2]
        );
        if d.undecided_area > 0.0 {
            answer!(
                "  proven: at most {:.6e}{}; the claim itself is undecided on {:.2e} of the area",
                d.proven,
                percent(d.proven),
                d.undecided_area
            );
        } else {
            answer!("  proven: at most {:.6e}{}", d.proven, percent(d.proven));
        }
        if !d.holds {
            answer!(
                "  BROKEN: {} of the points are farther away than claimed",
                d.violations.max(1)
            );
        }
    }
    answer!(
        "{}",
        match (found.holds, found.proven) {
            (false, _) => "the claim is broken",
            (true, true) => "the claim holds: proven",
            (true, false) => "no point breaks the claim",
        }
    );
}
