//! A primitive with the triangles that the mesh has left of it.

use std::collections::BTreeMap;

use super::{
    additions::{Additions, Storage},
    json::{self, Members},
    left::{Back, Left},
    vertices::{Column, Vertices},
    weights,
};
use crate::{
    Result,
    io::gltf::{
        accessor::{Component, Elements},
        buffers::Views,
        document::{Document, Primitive},
        surface::PartSurface,
    },
    mesh::{Asset, AssetPart, ChannelKind},
};

/// A part of the source, and what is known about it.
pub(super) struct Source<'a> {
    pub document: &'a Document,
    pub views: &'a Views<'a>,
    pub asset: &'a Asset,
    pub part: &'a AssetPart,
    pub primitive: &'a Primitive,
    pub surface: &'a PartSurface,
}

impl Source<'_> {
    /// The elements of the source, if they have this number of components.
    fn elements(&self, accessor: Option<usize>, width: usize) -> Result<Option<Elements<'_>>> {
        let opened = accessor.map(|index| Elements::open(self.document, self.views, index));
        Ok(opened.transpose()?.filter(|e| e.width() == width))
    }
}

/// Gives the primitive (its JSON) the triangles and vertices that are left; the notes say what it loses.
pub(super) fn replace(
    source: &Source<'_>,
    vertices: &Vertices,
    json: &mut Members,
    additions: &mut Additions,
    notes: &mut Vec<String>,
) -> Result<()> {
    let name = &source.part.name;
    let back = Back::of(source.part.placement);
    let mut left = Left::of(vertices, back.mirrored);
    let vanished = left.triangles.is_empty();
    if vanished {
        notes.push(format!(
            "vanished: {name}; nothing is left of it but one triangle without area, so that the file stays valid"
        ));
        left = Left::point(vertices, vertices.before[0][0]);
    }
    let mut attributes = Members::default();
    let positions: Vec<f64> = left.places(source.surface, vertices, &back);
    let number = additions.vertices(Storage::floats(3), &positions, true);
    attributes.set("POSITION", number.to_string());
    let mut targets = vec![Members::default(); source.primitive.targets.len()];
    let columns = vertices.columns.iter();
    let columns: Vec<&Column> = columns
        .filter(|c| c.channel.is_some() || vanished)
        .collect();
    let mut rows: Vec<Vec<f64>> = columns
        .iter()
        .map(|column| left.rows(column, vertices, &back))
        .collect();
    settle_skins(source, &left, &columns, &mut rows)?;
    for (column, values) in columns.iter().zip(&rows) {
        for slot in slots(column.kind, source.asset) {
            let (named, of_source) = match slot.target {
                None => (&mut attributes, Some(&source.primitive.attributes)),
                Some(target) => {
                    if target >= targets.len() {
                        targets.resize(target + 1, Members::default());
                    }
                    let of_source = source.primitive.targets.get(target);
                    (&mut targets[target], of_source)
                }
            };
            let stored = of_source.and_then(|of| of.get(&slot.semantic).copied());
            let number = write(
                source,
                &left,
                &slot,
                (values, column.kind),
                stored,
                additions,
            )?;
            named.set(&slot.semantic, number.to_string());
        }
    }
    note_dropped(source, &attributes, &targets, name, notes);
    json.set("attributes", attributes.to_string());
    let indices = additions.indices(&left.triangles, left.groups.len());
    json.set("indices", indices.to_string());
    json.remove(&["mode"]);
    json.remove_within("extensions", &["KHR_draco_mesh_compression"])?;
    if targets.iter().any(|t| !t.is_empty()) {
        let targets: Vec<String> = targets.iter().map(Members::to_string).collect();
        json.set("targets", json::array(&targets));
    } else {
        json.remove(&["targets"]);
    }
    Ok(())
}

fn note_dropped(
    source: &Source<'_>,
    attributes: &Members,
    targets: &[Members],
    name: &str,
    notes: &mut Vec<String>,
) {
    let lost = |had: &BTreeMap<String, usize>, has: &Members| -> Vec<String> {
        let names = had.keys().filter(|name| has.get(name).is_none());
        names.cloned().collect()
    };
    let mut dropped = lost(&source.primitive.attributes, attributes);
    for (number, (had, has)) in source.primitive.targets.iter().zip(targets).enumerate() {
        let of_target = lost(had, has).into_iter();
        dropped.extend(of_target.map(|name| format!("{name} of morph target {number}")));
    }
    if !dropped.is_empty() {
        notes.push(format!(
            "{name}: {} is dropped, for the new vertices have none",
            dropped.join(", ")
        ));
    }
}

/// A place for values in a primitive.
struct Slot {
    /// The morph target that it belongs to.
    target: Option<usize>,
    semantic: String,
    /// Where its values begin in those of the channel, and how many there are.
    first: usize,
    width: usize,
}

/// The places that a channel fills.
fn slots(kind: ChannelKind, asset: &Asset) -> Vec<Slot> {
    let slot = |semantic: String, first, width| Slot {
        target: None,
        semantic,
        first,
        width,
    };
    let width = kind.width();
    match kind {
        ChannelKind::Normal => vec![slot("NORMAL".into(), 0, width)],
        ChannelKind::Tangent => vec![slot("TANGENT".into(), 0, width)],
        ChannelKind::TexCoord(set) => vec![slot(format!("TEXCOORD_{set}"), 0, width)],
        ChannelKind::Color | ChannelKind::ColorAlpha => vec![slot("COLOR_0".into(), 0, width)],
        ChannelKind::Skin(set) => vec![
            slot(format!("JOINTS_{set}"), 0, 4),
            slot(format!("WEIGHTS_{set}"), 4, 4),
        ],
        ChannelKind::Delta(number) => {
            let semantic = ["POSITION", "NORMAL", "TANGENT"][usize::from(number % 3)];
            vec![Slot {
                target: Some(usize::from(number / 3)),
                ..slot(semantic.into(), 0, width)
            }]
        }
        ChannelKind::Custom { number, .. } => {
            let name = asset.customs.get(usize::from(number));
            name.map(|name| slot(name.clone(), 0, width))
                .into_iter()
                .collect()
        }
    }
}

/// Brings the weights of every new vertex, those of all sets together, to a sum of 1 as they are stored.
fn settle_skins(
    source: &Source<'_>,
    left: &Left,
    columns: &[&Column],
    rows: &mut [Vec<f64>],
) -> Result<()> {
    let is_skin = |i: &usize| matches!(columns[*i].kind, ChannelKind::Skin(_));
    let skins: Vec<usize> = (0..columns.len()).filter(is_skin).collect();
    let Some(&first) = skins.first() else {
        return Ok(());
    };
    let slot = &slots(columns[first].kind, source.asset)[1];
    let stored = source.primitive.attributes.get(&slot.semantic).copied();
    let elements = source.elements(stored, slot.width)?;
    let storage = storage(columns[first].kind, slot, elements.as_ref());
    for vertex in 0..left.groups.len() {
        if left.sources[vertex].is_some() {
            continue;
        }
        let weights = |i: usize| rows[i][8 * vertex + 4..][..4].to_vec();
        let mut settled: Vec<f64> = skins.iter().flat_map(|&i| weights(i)).collect();
        weights::settle(&mut settled, storage);
        for (&i, four) in skins.iter().zip(settled.chunks(4)) {
            rows[i][8 * vertex + 4..][..4].copy_from_slice(four);
        }
    }
    Ok(())
}

/// Appends the values of one place: those that the source stores where its vertex is still there.
fn write(
    source: &Source<'_>,
    left: &Left,
    slot: &Slot,
    (values, kind): (&[f64], ChannelKind),
    stored: Option<usize>,
    additions: &mut Additions,
) -> Result<usize> {
    let mut width = slot.width;
    if kind == ChannelKind::ColorAlpha
        && source.elements(stored, 3)?.is_some()
        && values.chunks(4).all(|color| color[3] >= 1.0)
    {
        // The source has no opacity; other parts have.
        width = 3;
    }
    let elements = source.elements(stored, width)?;
    let storage = Storage {
        width,
        ..storage(kind, slot, elements.as_ref())
    };
    let mut written = Vec::with_capacity(left.groups.len() * width);
    for (row, origin) in values.chunks(kind.width()).zip(&left.sources) {
        let at = written.len();
        written.extend_from_slice(&row[slot.first..][..width]);
        if let (Some(elements), Some(vertex)) = (&elements, origin) {
            elements.read(source.surface.source[*vertex] as usize, &mut written[at..]);
        }
    }
    Ok(additions.vertices(storage, &written, slot.semantic == "POSITION"))
}

/// The storage of the values of a place: as the source does where they are no lengths or directions.
fn storage(kind: ChannelKind, slot: &Slot, elements: Option<&Elements<'_>>) -> Storage {
    let floats = Storage::floats(slot.width);
    let as_stored = elements.map(|e| Storage {
        component: e.component,
        normalized: e.normalized,
        width: slot.width,
    });
    match kind {
        ChannelKind::Color | ChannelKind::ColorAlpha | ChannelKind::Custom { .. } => {
            as_stored.unwrap_or(floats)
        }
        ChannelKind::Skin(_) if slot.first == 4 => as_stored.unwrap_or(floats),
        ChannelKind::Skin(_) => as_stored.unwrap_or(Storage {
            component: Component::U16,
            ..floats
        }),
        _ => floats,
    }
}
