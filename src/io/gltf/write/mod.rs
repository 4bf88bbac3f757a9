//! Writes glTF: the document that a mesh came from, with the triangles that the mesh has.
//!
//! A primitive whose triangles are those of the source stays as it is. Of another one every vertex that is still there
//! keeps its stored values ([`vertices`]); new accessors are appended, and no index changes ([`additions`]). What nothing
//! refers to any more loses its bytes ([`prune`]), everything else is copied as it stands: text entry by entry
//! ([`json`]), bytes into one buffer ([`pack`]). A mesh of another format gets a document of its own ([`fresh`]). Several
//! files of one document can share its images ([`mod@share`]).

mod additions;
mod files;
mod fresh;
mod images;
mod json;
mod left;
mod pack;
mod primitive;
mod prune;
mod references;
mod share;
mod vertices;
mod weights;

use std::collections::BTreeMap;

use self::{
    additions::Additions, json::Members, primitive::Source, references::ACCESSORS,
    vertices::Vertices,
};
use super::{attributes, buffers::Views, document::Document, surface::part_corners};
use crate::{
    Error, Result,
    mesh::{Asset, Mesh},
};

pub(in crate::rooms::io) use files::{buffer_beside, encode, write};
pub use share::{SharedImages, share_images};

const DRACO: &str = "KHR_draco_mesh_compression";

/// A document and its one buffer, and what it could not keep.
struct Written {
    sections: Members,
    binary: Vec<u8>,
    notes: Vec<String>,
}

/// The document of a mesh; images in files of their own come into the buffer if asked for.
fn document(mesh: &Mesh, embed: bool) -> Result<Written> {
    let Some(asset) = &mesh.materials().asset else {
        return fresh::document(mesh);
    };
    let document = Document::parse(asset)?;
    let views = Views::new(&document, &asset.buffers);
    let mut sections = Members::from(asset.sections.clone());
    let before = references::gather(&sections, ACCESSORS)?;
    let mut additions = Additions::to(document.views.len(), document.accessors.len());
    let mut notes = Vec::new();
    let kept = (&document, &views);
    replace_primitives(
        &mut sections,
        kept,
        (mesh, asset),
        &mut additions,
        &mut notes,
    )?;
    let dropped = prune::prune(&mut sections, kept, &before, &mut additions, &mut notes)?;
    if embed {
        images::embed(&mut sections, &asset.folder, &mut additions, &mut notes)?;
    }
    let binary = pack::pack(&mut sections, kept, &asset.buffers, &dropped, &additions)?;
    if !sections
        .get("meshes")
        .is_some_and(|text| text.contains(DRACO))
    {
        pack::drop_extensions(&mut sections, &[DRACO])?;
    }
    Ok(Written {
        sections,
        binary,
        notes,
    })
}

/// Replaces the primitives that the mesh has changed.
fn replace_primitives(
    sections: &mut Members,
    (document, views): (&Document, &Views<'_>),
    (mesh, asset): (&Mesh, &Asset),
    additions: &mut Additions,
    notes: &mut Vec<String>,
) -> Result<()> {
    let mut meshes = json::entries(sections.get("meshes").unwrap_or("[]"))?;
    let mut changed: BTreeMap<usize, Vec<String>> = BTreeMap::new();
    for (number, (part, triangles)) in asset
        .parts
        .iter()
        .zip(triangles_of(mesh, asset)?)
        .enumerate()
    {
        let surface = part_corners(document, views, asset, number)?;
        let vertices = Vertices::new(&surface, mesh, &triangles);
        if vertices.are_unchanged() {
            continue;
        }
        let primitives = match changed.entry(part.mesh) {
            std::collections::btree_map::Entry::Occupied(known) => known.into_mut(),
            std::collections::btree_map::Entry::Vacant(new) => {
                let of_mesh = Members::parse(&meshes[part.mesh])?;
                new.insert(json::entries(of_mesh.get("primitives").unwrap_or("[]"))?)
            }
        };
        let mut primitive = Members::parse(&primitives[part.primitive])?;
        let source = Source {
            document,
            views,
            asset,
            part,
            primitive: attributes::primitive(document, part),
            surface: &surface,
        };
        primitive::replace(&source, &vertices, &mut primitive, additions, notes)?;
        primitives[part.primitive] = primitive.to_string();
    }
    if changed.is_empty() {
        return Ok(());
    }
    for (number, primitives) in changed {
        let mut of_mesh = Members::parse(&meshes[number])?;
        of_mesh.set("primitives", json::array(&primitives));
        meshes[number] = of_mesh.to_string();
    }
    sections.set("meshes", json::array(&meshes));
    Ok(())
}

/// The triangles of every part.
fn triangles_of(mesh: &Mesh, asset: &Asset) -> Result<Vec<Vec<u32>>> {
    let parts: BTreeMap<&str, usize> = asset
        .parts
        .iter()
        .map(|p| p.name.as_str())
        .zip(0..)
        .collect();
    let materials = mesh.materials();
    let names = materials.names.iter();
    let part_of: Vec<Option<&usize>> = names.map(|name| parts.get(name.as_str())).collect();
    let mut found = vec![Vec::new(); asset.parts.len()];
    for t in 0..mesh.triangles().len() {
        let material = materials.of(t) as usize;
        let part = part_of.get(material).copied().flatten().ok_or_else(|| {
            let name = materials.names.get(material).map_or("none", String::as_str);
            Error::content(format!(
                "triangle {t} has the material `{name}`, which no primitive of its document has"
            ))
        })?;
        found[*part].push(t as u32);
    }
    Ok(found)
}
