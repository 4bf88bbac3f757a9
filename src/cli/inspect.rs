//! `lodmark inspect`: what a mesh file holds.

use std::path::PathBuf;

use super::{Common, Verdict, report, terminal::Terminal};
use crate::{
    Result,
    io::{self, Summary},
    mesh::content_sha256,
    view::Sphere,
};

/// Say what a mesh file holds
#[derive(Debug, clap::Args)]
pub(super) struct InspectArgs {
    /// The mesh: .obj, .ply, .stl, .glb or .gltf
    #[arg(value_name = "IN")]
    input: PathBuf,
}

#[derive(Debug, serde::Serialize)]
struct Contents {
    #[serde(flatten)]
    summary: Summary,
    bounds: Option<[[f64; 3]; 2]>,
    bounding_radius: Option<f64>,
    content_sha256: String,
}

pub(super) fn run(options: &InspectArgs, common: &Common, _: &Terminal) -> Result<Verdict> {
    let loaded = io::read(&options.input)?;
    let bounds = loaded.mesh.bounds();
    let contents = Contents {
        summary: Summary::of(&loaded),
        bounds: bounds.map(|(low, high)| [low.to_array(), high.to_array()]),
        bounding_radius: Sphere::of_mesh(&loaded.mesh).map(|s| s.radius),
        content_sha256: content_sha256(&loaded.mesh),
    };
    answer!("{}", contents.summary.report().trim_end());
    if let (Some([low, high]), Some(radius)) = (contents.bounds, contents.bounding_radius) {
        answer!("bounds              {low:?} to {high:?}");
        answer!("bounding radius     {radius}");
    }
    answer!("content sha256      {}", contents.content_sha256);
    let resolved = serde_json::json!({ "input": options.input });
    report(common, "inspect", resolved, &contents)?;
    Ok(Verdict::Good)
}
