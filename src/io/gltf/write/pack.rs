//! One buffer for everything that is still needed, in the order in which the source had it.

use std::{collections::BTreeSet, ops::Range};

use super::{
    additions::Additions,
    json::{self, Members},
};
use crate::{
    Result,
    io::gltf::{buffers::Views, document::Document},
};

/// Extensions of views whose bytes are written as they are after decoding.
pub(super) const MESHOPT: &[&str] = &["EXT_meshopt_compression", "KHR_meshopt_compression"];

/// Lays the views out and writes where they begin; those `dropped` keep their places in the list and share 4 bytes.
/// Returns the bytes of the buffer.
pub(super) fn pack(
    sections: &mut Members,
    (document, views): (&Document, &Views<'_>),
    buffers: &[Vec<u8>],
    dropped: &BTreeSet<usize>,
    additions: &Additions,
) -> Result<Vec<u8>> {
    let mut packed = Vec::new();
    let pieces = pieces(document, buffers, dropped);
    let mut starts = Vec::with_capacity(pieces.len());
    for (buffer, range) in &pieces {
        starts.push(append(&mut packed, &buffers[*buffer][range.clone()]));
    }
    let mut entries = json::entries(sections.get("bufferViews").unwrap_or("[]"))?;
    let mut changed = !additions.views.is_empty();
    for (index, view) in document.views.iter().enumerate() {
        let mut entry = Members::parse(&entries[index])?;
        if dropped.contains(&index) {
            entry.remove(&["byteOffset", "byteStride", "target"]);
            entry.set("buffer", "0");
            entry.set("byteLength", "4");
        } else {
            let Ok(bytes) = views.bytes(index) else {
                // Nobody who reads the mesh needs it: what is wrong with it stays.
                continue;
            };
            let start = if view.extensions.meshopt.is_some() {
                append(&mut packed, &bytes[..view.byte_length])
            } else {
                let holds = |(buffer, range): &(usize, Range<usize>)| {
                    *buffer == view.buffer
                        && range.start <= view.byte_offset
                        && view.byte_offset + view.byte_length <= range.end
                };
                let piece = pieces.iter().position(holds).unwrap_or(0);
                let start = view.byte_offset - pieces[piece].1.start + starts[piece];
                if (view.buffer, view.byte_offset) == (0, start) {
                    continue;
                }
                start
            };
            entry.set("buffer", "0");
            entry.set("byteOffset", start.to_string());
        }
        entry.remove_within("extensions", MESHOPT)?;
        entries[index] = entry.to_string();
        changed = true;
    }
    for view in &additions.views {
        let start = append(&mut packed, &view.bytes);
        let mut entry = Members::default();
        entry.set("buffer", "0");
        entry.set("byteOffset", start.to_string());
        entry.set("byteLength", view.bytes.len().to_string());
        for (name, value) in [("byteStride", view.stride), ("target", view.target)] {
            if let Some(value) = value {
                entry.set(name, value.to_string());
            }
        }
        entries.push(entry.to_string());
    }
    if changed {
        sections.set("bufferViews", json::array(&entries));
    }
    if !dropped.is_empty() {
        packed.resize(packed.len().max(4), 0);
    }
    drop_extensions(sections, MESHOPT)?;
    Ok(packed)
}

/// Appends bytes at a multiple of 4; where they begin.
fn append(packed: &mut Vec<u8>, bytes: &[u8]) -> usize {
    packed.resize(packed.len().next_multiple_of(4), 0);
    packed.extend_from_slice(bytes);
    packed.len() - bytes.len()
}

/// The parts of the buffers that stay: all of a buffer where all of its views do.
fn pieces(
    document: &Document,
    buffers: &[Vec<u8>],
    dropped: &BTreeSet<usize>,
) -> Vec<(usize, Range<usize>)> {
    let mut found = Vec::new();
    for (buffer, bytes) in buffers.iter().enumerate() {
        let (mut needed, mut whole) = (Vec::new(), true);
        for (index, view) in document.views.iter().enumerate() {
            if let Some(meshopt) = &view.extensions.meshopt {
                whole &= meshopt.buffer != buffer && view.buffer != buffer;
            } else if view.buffer == buffer && dropped.contains(&index) {
                whole = false;
            } else if view.buffer == buffer {
                // As far from a multiple of 4 as before.
                let start = view.byte_offset / 4 * 4;
                let end = view.byte_offset.saturating_add(view.byte_length);
                if end <= bytes.len() {
                    needed.push(start..end);
                }
            }
        }
        if whole {
            found.push((buffer, 0..bytes.len()));
            continue;
        }
        needed.sort_by_key(|range| range.start);
        let mut merged: Vec<Range<usize>> = Vec::new();
        for range in needed {
            match merged.last_mut() {
                Some(last) if range.start <= last.end => last.end = last.end.max(range.end),
                _ => merged.push(range),
            }
        }
        found.extend(merged.into_iter().map(|range| (buffer, range)));
    }
    found
}

/// Takes extensions out of the lists of those that are used and required.
pub(super) fn drop_extensions(sections: &mut Members, names: &[&str]) -> Result<()> {
    for list in ["extensionsUsed", "extensionsRequired"] {
        let Some(text) = sections.get(list) else {
            continue;
        };
        let mut entries = json::entries(text)?;
        let count = entries.len();
        entries.retain(|entry| !names.iter().any(|name| json::quoted(name) == *entry));
        if entries.is_empty() {
            sections.remove(&[list]);
        } else if entries.len() < count {
            sections.set(list, json::array(&entries));
        }
    }
    Ok(())
}
