//! A document for a mesh of another format: one mesh with a primitive for every material.

use std::collections::BTreeSet;

use glam::DAffine3;

use super::{
    Written,
    additions::Additions,
    json::{self, Members},
    pack,
    primitive::{self, Source},
    vertices::Vertices,
};
use crate::{
    Error, Result,
    io::{
        flip::flipped,
        gltf::{
            buffers::Views,
            document::{Document, Primitive},
            surface::PartSurface,
        },
        per_vertex,
    },
    mesh::{Asset, AssetPart, ChannelKind, Materials, Mesh},
    num::Precision,
};

/// A document that shows the mesh.
pub(super) fn document(mesh: &Mesh) -> Result<Written> {
    let mut notes = Vec::new();
    check_coordinates(mesh, &mut notes)?;
    let mesh = flipped(mesh, &mut |kind| {
        let keeps = matches!(
            kind,
            ChannelKind::Normal
                | ChannelKind::Tangent
                | ChannelKind::TexCoord(_)
                | ChannelKind::Color
                | ChannelKind::ColorAlpha
        );
        if !keeps {
            let name = per_vertex::name(kind);
            notes.push(format!(
                "glTF keeps {name} only of a mesh that came from glTF"
            ));
        }
        keeps
    })?;
    let (document, asset) = (Document::default(), Asset::default());
    let views = Views::new(&document, &[]);
    let mut additions = Additions::default();
    let names = &mesh.materials().names;
    let mut primitives = Vec::new();
    for (number, name) in (0..)
        .zip(names.iter().map(Some))
        .chain([(Materials::NONE, None)])
    {
        let of_material = |&t: &u32| mesh.materials().of(t as usize) == number;
        let triangles: Vec<u32> = (0..mesh.triangles().len() as u32)
            .filter(of_material)
            .collect();
        if triangles.is_empty() {
            continue;
        }
        let surface = PartSurface::default();
        let source = Source {
            document: &document,
            views: &views,
            asset: &asset,
            part: &AssetPart {
                name: String::new(),
                mesh: 0,
                primitive: 0,
                placement: DAffine3::IDENTITY,
                instances: 1,
            },
            primitive: &Primitive::default(),
            surface: &surface,
        };
        let vertices = Vertices::new(&surface, &mesh, &triangles);
        let mut primitive = Members::default();
        primitive::replace(
            &source,
            &vertices,
            &mut primitive,
            &mut additions,
            &mut notes,
        )?;
        if name.is_some() {
            primitive.set("material", number.to_string());
        }
        primitives.push(primitive.to_string());
    }
    let mut sections = sections(names, &primitives, &additions);
    let kept = (&document, &views);
    let binary = pack::pack(&mut sections, kept, &[], &BTreeSet::new(), &additions)?;
    Ok(Written {
        sections,
        binary,
        notes,
    })
}

fn sections(names: &[String], primitives: &[String], additions: &Additions) -> Members {
    let mut sections = Members::default();
    sections.set(
        "asset",
        format!(
            r#"{{"version":"2.0","generator":"lodmark {}"}}"#,
            env!("CARGO_PKG_VERSION")
        ),
    );
    sections.set("scene", "0");
    if primitives.is_empty() {
        sections.set("scenes", "[{}]");
        return sections;
    }
    sections.set("scenes", r#"[{"nodes":[0]}]"#);
    sections.set("nodes", r#"[{"mesh":0}]"#);
    sections.set(
        "meshes",
        format!(r#"[{{"primitives":{}}}]"#, json::array(primitives)),
    );
    if !names.is_empty() {
        let material = |name: &String| {
            let name = json::quoted(name);
            format!(r#"{{"name":{name},"pbrMetallicRoughness":{{"metallicFactor":0}}}}"#)
        };
        let materials: Vec<String> = names.iter().map(material).collect();
        sections.set("materials", json::array(&materials));
    }
    sections.set("accessors", json::array(&additions.accessors));
    sections
}

/// Coordinates are 32-bit floats.
fn check_coordinates(mesh: &Mesh, notes: &mut Vec<String>) -> Result<()> {
    let coordinates = || mesh.positions().iter().flat_map(|p| p.to_array());
    let single = |x: f64| Precision::F32.round(x);
    if let Some(x) = coordinates().find(|&x| !single(x).is_finite()) {
        return Err(Error::Unsupported(format!(
            "the coordinate {x} is too large for the 32-bit floats of glTF; use .obj or .ply"
        )));
    }
    let rounded = coordinates()
        .filter(|&x| single(x).to_bits() != x.to_bits())
        .count();
    if rounded > 0 {
        notes.push(format!(
            "glTF stores coordinates as 32-bit floats: {rounded} are rounded"
        ));
    }
    Ok(())
}
