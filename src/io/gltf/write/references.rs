//! Which accessors and views a document refers to, and whether there may be references nobody here knows of.

use std::collections::BTreeSet;

use serde_json::Value;

use super::json::Members;
use crate::{Error, Result};

/// Extensions that refer to no accessor and no view other than by [`ACCESSORS`] and [`VIEWS`]; those of materials come
/// in addition.
const KNOWN: &[&str] = &[
    "EXT_mesh_gpu_instancing",
    "EXT_meshopt_compression",
    "EXT_texture_avif",
    "EXT_texture_webp",
    "KHR_animation_pointer",
    "KHR_draco_mesh_compression",
    "KHR_lights_punctual",
    "KHR_mesh_quantization",
    "KHR_meshopt_compression",
    "KHR_node_hoverability",
    "KHR_node_selectability",
    "KHR_node_visibility",
    "KHR_texture_basisu",
    "KHR_texture_transform",
    "KHR_xmp_json_ld",
    "MSFT_lod",
    "MSFT_texture_dds",
];

/// Where numbers of accessors stand; `*` is every member or entry.
pub(super) const ACCESSORS: &[&[&str]] = &[
    &["meshes", "*", "primitives", "*", "indices"],
    &["meshes", "*", "primitives", "*", "attributes", "*"],
    &["meshes", "*", "primitives", "*", "targets", "*", "*"],
    &["animations", "*", "samplers", "*", "input"],
    &["animations", "*", "samplers", "*", "output"],
    &["skins", "*", "inverseBindMatrices"],
    &[
        "nodes",
        "*",
        "extensions",
        "EXT_mesh_gpu_instancing",
        "attributes",
        "*",
    ],
];

/// Where numbers of views stand other than as the elements of accessors.
pub(super) const VIEWS: &[&[&str]] = &[
    &["images", "*", "bufferView"],
    &["accessors", "*", "sparse", "indices", "bufferView"],
    &["accessors", "*", "sparse", "values", "bufferView"],
    &[
        "meshes",
        "*",
        "primitives",
        "*",
        "extensions",
        "KHR_draco_mesh_compression",
        "bufferView",
    ],
];

/// The numbers that stand at the places.
pub(super) fn gather(sections: &Members, places: &[&[&str]]) -> Result<BTreeSet<usize>> {
    let mut found = BTreeSet::new();
    for place in places {
        if let Some(value) = value(sections, place[0])? {
            gather_below(&value, &place[1..], &mut found);
        }
    }
    Ok(found)
}

fn gather_below(value: &Value, place: &[&str], found: &mut BTreeSet<usize>) {
    match (place, value) {
        ([], _) => found.extend(value.as_u64().map(|n| n as usize)),
        (["*", rest @ ..], Value::Array(entries)) => {
            for entry in entries {
                gather_below(entry, rest, found);
            }
        }
        (["*", rest @ ..], Value::Object(members)) => {
            for entry in members.values() {
                gather_below(entry, rest, found);
            }
        }
        ([name, rest @ ..], _) => {
            if let Some(member) = value.get(name) {
                gather_below(member, rest, found);
            }
        }
    }
}

/// An extension of the document that may refer to anything by its number.
pub(super) fn unknown_extension(sections: &Members) -> Result<Option<String>> {
    let mut names = BTreeSet::new();
    for (name, _) in sections.iter() {
        if let Some(value) = value(sections, name)? {
            match (name, &value) {
                ("extensionsUsed", Value::Array(used)) => {
                    names.extend(used.iter().filter_map(Value::as_str).map(String::from));
                }
                ("extensions", Value::Object(of_document)) => {
                    names.extend(of_document.keys().cloned());
                }
                _ => extensions_below(&value, &mut names),
            }
        }
    }
    let known = |name: &str| KNOWN.contains(&name) || name.starts_with("KHR_materials_");
    Ok(names.into_iter().find(|name| !known(name)))
}

fn extensions_below(value: &Value, names: &mut BTreeSet<String>) {
    match value {
        Value::Array(entries) => entries.iter().for_each(|e| extensions_below(e, names)),
        Value::Object(members) => {
            for (name, member) in members {
                match member {
                    Value::Object(extensions) if name == "extensions" => {
                        names.extend(extensions.keys().cloned());
                    }
                    // What an application notes down for itself is not part of the format.
                    _ if name == "extras" => continue,
                    _ => {}
                }
                extensions_below(member, names);
            }
        }
        _ => {}
    }
}

fn value(sections: &Members, name: &str) -> Result<Option<Value>> {
    let Some(text) = sections.get(name) else {
        return Ok(None);
    };
    let value = serde_json::from_str(text);
    value
        .map(Some)
        .map_err(|e| Error::content(format!("the section `{name}`: {e}")))
}
