//! Pruning: the bytes go that nothing refers to any more, but no index changes.

use std::collections::BTreeSet;

use super::{
    additions::{Additions, NewView},
    json::{self, Members},
    references::{self, ACCESSORS, VIEWS},
};
use crate::{
    Result,
    io::gltf::{accessor::Elements, buffers::Views, document::Document},
};

/// Appends the new accessors. Those that were referred to and are no longer become one element of zeros; the others that
/// share a view with them move to views of their own. Returns the views that nobody needs.
pub(super) fn prune(
    sections: &mut Members,
    (document, views): (&Document, &Views<'_>),
    before: &BTreeSet<usize>,
    additions: &mut Additions,
    notes: &mut Vec<String>,
) -> Result<BTreeSet<usize>> {
    let mut entries = json::entries(sections.get("accessors").unwrap_or("[]"))?;
    let after = references::gather(sections, ACCESSORS)?;
    let known = |index: &&usize| **index < entries.len();
    let dead: BTreeSet<usize> = before.difference(&after).filter(known).copied().collect();
    let mut dropped = BTreeSet::new();
    if !dead.is_empty() {
        if let Some(extension) = references::unknown_extension(sections)? {
            notes.push(format!(
                "the extension {extension} may refer to anything: vertices that are replaced stay in the file as well"
            ));
        } else {
            for &index in &dead {
                entries[index] = stub(&entries[index])?;
            }
            sections.set("accessors", json::array(&entries));
            let needed = references::gather(sections, VIEWS)?;
            let texts = json::entries(sections.get("bufferViews").unwrap_or("[]"))?;
            for view in views_of(document, &dead) {
                let users = users(document, view, &dead);
                if needed.contains(&view) || !users.iter().all(|&a| is_plain(document, a)) {
                    continue;
                }
                let old = Members::parse(&texts[view])?;
                let moved = users.iter().map(|&a| copy(&old, document, views, a));
                let moved: Result<Vec<NewView>> = moved.collect();
                let Some(moved) = moved.ok().filter(|m| saves(document, view, m)) else {
                    continue;
                };
                for (accessor, bytes) in users.into_iter().zip(moved) {
                    let mut entry = Members::parse(&entries[accessor])?;
                    entry.set("bufferView", additions.view(bytes).to_string());
                    entry.remove(&["byteOffset"]);
                    entries[accessor] = entry.to_string();
                }
                dropped.insert(view);
            }
        }
    }
    if !dead.is_empty() || !additions.accessors.is_empty() {
        entries.extend(additions.accessors.iter().cloned());
        sections.set("accessors", json::array(&entries));
    }
    Ok(dropped)
}

/// An accessor of one zero, with the name and the type of the old one.
fn stub(entry: &str) -> Result<String> {
    let mut entry = Members::parse(entry)?;
    entry.remove(&["bufferView", "byteOffset", "sparse", "min", "max"]);
    entry.set("count", "1");
    Ok(entry.to_string())
}

/// The views of the bytes of some accessors.
fn views_of(document: &Document, accessors: &BTreeSet<usize>) -> BTreeSet<usize> {
    let mut found = BTreeSet::new();
    for accessor in accessors.iter().filter_map(|&a| document.accessors.get(a)) {
        found.extend(accessor.buffer_view);
        if let Some(sparse) = &accessor.sparse {
            found.extend([sparse.indices.buffer_view, sparse.values.buffer_view]);
        }
    }
    found
}

/// The accessors that still need a view.
fn users(document: &Document, view: usize, dead: &BTreeSet<usize>) -> Vec<usize> {
    let all = document.accessors.iter().enumerate();
    all.filter(|(index, a)| a.buffer_view == Some(view) && !dead.contains(index))
        .map(|(index, _)| index)
        .collect()
}

fn is_plain(document: &Document, accessor: usize) -> bool {
    document.accessors[accessor].sparse.is_none()
}

/// Whether bytes apart are fewer than the view: accessors may share them.
fn saves(document: &Document, view: usize, moved: &[NewView]) -> bool {
    let apart: usize = moved.iter().map(|m| m.bytes.len()).sum();
    apart <= document.views[view].byte_length
}

/// The bytes of an accessor alone, in a view as the `old` one.
fn copy(old: &Members, document: &Document, views: &Views<'_>, accessor: usize) -> Result<NewView> {
    let elements = Elements::open(document, views, accessor)?;
    let (size, strided) = (elements.size(), old.get("byteStride").is_some());
    let stride = if strided {
        size.next_multiple_of(4)
    } else {
        size
    };
    let mut bytes = Vec::with_capacity(elements.count * stride);
    for element in 0..elements.count {
        bytes.extend_from_slice(elements.bytes(element).unwrap_or_default());
        bytes.resize((element + 1) * stride, 0);
    }
    Ok(NewView {
        bytes,
        stride: (stride != size).then_some(stride),
        target: old.get("target").and_then(|t| t.parse().ok()),
    })
}
