//! `lodmark inspect`: what a mesh file holds.

use std::path::PathBuf;

use super::{Common, Verdict, report, terminal::Terminal};
use crate::{
    Result, io,
    mesh::{ChannelKind, content_sha256},
    view::Sphere,
};

/// Say what a mesh file holds
#[derive(Debug, clap::Args)]
pub(super) struct Options {
    /// The mesh: .obj, .ply or .stl
    #[arg(value_name = "IN")]
    input: PathBuf,
}

#[derive(Debug, serde::Serialize)]
struct Contents {
    encoding: String,
    vertices: usize,
    triangles: usize,
    precision: crate::num::Precision,
    channels: Vec<ChannelKind>,
    wedges: usize,
    materials: Vec<String>,
    material_libraries: Vec<String>,
    bounds_low: Option<[f64; 3]>,
    bounds_high: Option<[f64; 3]>,
    bounding_radius: Option<f64>,
    content_sha256: String,
    notes: Vec<String>,
}

pub(super) fn run(options: &Options, common: &Common, _: &Terminal) -> Result<Verdict> {
    let loaded = io::read(&options.input)?;
    let mesh = &loaded.mesh;
    let bounds = mesh.bounds();
    let contents = Contents {
        encoding: loaded.encoding.to_string(),
        vertices: mesh.positions().len(),
        triangles: mesh.triangles().len(),
        precision: mesh.precision(),
        channels: mesh
            .attributes()
            .channels()
            .iter()
            .map(|c| c.kind)
            .collect(),
        wedges: mesh.attributes().wedge_count(),
        materials: mesh.materials().names.clone(),
        material_libraries: mesh.materials().libraries.clone(),
        bounds_low: bounds.map(|b| b.0.to_array()),
        bounds_high: bounds.map(|b| b.1.to_array()),
        bounding_radius: Sphere::of_mesh(mesh).map(|s| s.radius),
        content_sha256: content_sha256(mesh),
        notes: loaded.notes.clone(),
    };
    println!("{}", options.input.display());
    println!(
        "  format      {}, coordinates {:?}",
        contents.encoding, contents.precision
    );
    println!("  vertices    {}", contents.vertices);
    println!("  triangles   {}", contents.triangles);
    if let (Some(low), Some(high)) = (contents.bounds_low, contents.bounds_high) {
        println!("  bounds      {low:?} to {high:?}");
    }
    if let Some(radius) = contents.bounding_radius {
        println!("  radius      {radius} (smallest enclosing sphere)");
    }
    if !contents.channels.is_empty() {
        println!(
            "  attributes  {:?}, {} wedges",
            contents.channels, contents.wedges
        );
    }
    if !contents.materials.is_empty() {
        println!("  materials   {}", contents.materials.join(", "));
    }
    println!("  sha256      {}", contents.content_sha256);
    for note in &contents.notes {
        println!("  note        {note}");
    }
    report(
        common,
        "inspect",
        serde_json::json!({ "input": options.input }),
        &contents,
    )?;
    Ok(Verdict::Good)
}
