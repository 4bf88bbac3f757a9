//! The parts of a mesh: the primitives that its document shows, and their names.

use std::collections::{BTreeMap, BTreeSet};

use super::{
    attributes::{self, Channels},
    document::{Document, Primitive, named},
    scene::Shown,
};
use crate::{Result, io::words, mesh::AssetPart};

/// The primitives of triangles that the scene shows, in the order of the document; notes say what is left as it is.
///
/// # Errors
/// [`Error::Input`](crate::Error::Input) where a primitive names a material that does not exist.
pub(super) fn of(
    document: &Document,
    shown: &[Shown],
    notes: &mut Vec<String>,
) -> Result<Vec<AssetPart>> {
    let mut parts = Vec::new();
    let (mut hidden, mut flat, mut lines, mut ragged) = (0, 0, 0, 0);
    for (m, (mesh, shown)) in document.meshes.iter().zip(shown).enumerate() {
        let Some(placement) = shown.placement else {
            *(if shown.instances == 0 {
                &mut hidden
            } else {
                &mut flat
            }) += 1;
            continue;
        };
        for (p, primitive) in mesh.primitives.iter().enumerate() {
            if !primitive.has_triangles() {
                lines += 1;
                continue;
            }
            ragged += usize::from(is_ragged(document, primitive));
            parts.push(AssetPart {
                name: base_name(document, primitive.material, m, p)?,
                mesh: m,
                primitive: p,
                placement,
                instances: shown.instances,
            });
        }
    }
    make_unique(document, &mut parts);
    let repeated = shown
        .iter()
        .filter(|s| s.placement.is_some() && s.instances > 1);
    let skinned = shown.iter().filter(|s| s.placement.is_some() && s.skinned);
    let said = [
        (
            hidden,
            "meshes that the default scene does not show stay as they are",
        ),
        (
            flat,
            "meshes that their nodes flatten to nothing stay as they are",
        ),
        (lines, "primitives of points or lines stay as they are"),
        (
            ragged,
            "primitives with indices left over after the last triangle, which are ignored",
        ),
        (
            skinned.count(),
            "meshes with a skin, taken as it binds them",
        ),
        (
            repeated.clone().count(),
            "meshes that are shown several times count once, as their largest instance shows them",
        ),
    ];
    let said = said.into_iter().filter(|(count, _)| *count > 0);
    notes.extend(said.map(|(count, what)| format!("{what}: {count}")));
    let instances: usize = repeated.map(|s| s.instances).sum();
    if instances > 0 {
        notes.push(format!(
            "instances of meshes that are shown several times: {instances}"
        ));
    }
    Ok(parts)
}

/// Adds notes about attributes that the mesh does not carry.
pub(super) fn note_attributes(
    document: &Document,
    parts: &[AssetPart],
    channels: &Channels<'_>,
    notes: &mut Vec<String>,
) {
    let mut left_out = BTreeMap::new();
    for part in parts {
        for name in channels.left_out(attributes::primitive(document, part)) {
            *left_out.entry(name).or_insert(0_usize) += 1;
        }
    }
    let more = left_out.len().saturating_sub(8);
    for (name, count) in left_out.iter().take(8) {
        notes.push(format!(
            "{} stays only where a primitive does not change, in primitives: {count}",
            words::shown(name.as_bytes()).escape_default()
        ));
    }
    if more > 0 {
        notes.push(format!(
            "further attributes of which the same holds: {more}"
        ));
    }
}

/// Whether a list of triangles has one or two corners too many.
fn is_ragged(document: &Document, primitive: &Primitive) -> bool {
    let corners = primitive
        .indices
        .or_else(|| primitive.attributes.get("POSITION").copied());
    let count = corners
        .and_then(|i| document.accessors.get(i))
        .map_or(0, |a| a.count);
    matches!(primitive.mode, None | Some(4)) && !count.is_multiple_of(3)
}

/// The name of the material, or words for it, without control characters.
fn base_name(
    document: &Document,
    material: Option<usize>,
    mesh: usize,
    primitive: usize,
) -> Result<String> {
    let Some(number) = material else {
        return Ok("no material".into());
    };
    let from = || format!("meshes[{mesh}], primitive {primitive}");
    let material = named(&document.materials, number, "materials", from)?;
    Ok(tidy(material.name.as_deref()).unwrap_or_else(|| format!("material {number}")))
}

/// A name in one line; `None` where nothing is left of it.
fn tidy(name: Option<&str>) -> Option<String> {
    let is_space = |c: char| c.is_whitespace() || c.is_control();
    let words: Vec<&str> = name?
        .split(is_space)
        .filter(|word| !word.is_empty())
        .collect();
    (!words.is_empty()).then(|| words.join(" "))
}

/// Adds to the names of parts until they all differ: the mesh, then the primitive, then a number.
fn make_unique(document: &Document, parts: &mut [AssetPart]) {
    for detail in 0..2 {
        let mut counts: BTreeMap<String, usize> = BTreeMap::new();
        for part in &*parts {
            *counts.entry(part.name.clone()).or_default() += 1;
        }
        for part in parts.iter_mut().filter(|part| counts[&part.name] > 1) {
            if detail == 0 {
                let mesh = tidy(document.meshes[part.mesh].name.as_deref());
                let mesh = mesh.unwrap_or_else(|| part.mesh.to_string());
                part.name += &format!(" (mesh {mesh})");
            } else {
                part.name += &format!(" (primitive {} of mesh {})", part.primitive, part.mesh);
            }
        }
    }
    let mut taken: BTreeSet<String> = BTreeSet::new();
    for part in parts {
        while !taken.insert(part.name.clone()) {
            part.name.push('\'');
        }
    }
}
