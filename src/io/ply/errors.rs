//! The texts of the errors about a broken PLY body: where, what is there, and what was expected.

use glam::DVec3;

use super::{
    header::Element,
    numbers::{Fault, Source},
};
use crate::mesh::Mesh;

/// The header declares no vertices.
pub(super) const NO_VERTICES: &str =
    "the header declares no element `vertex`; expected one with x, y and z";

/// The header declares faces, but nothing that could be their corners.
pub(super) const NO_CORNERS: &str = "the header declares faces without vertices; expected `property list uchar int \
                                     vertex_indices`";

/// The header declares more vertices than a mesh may have.
pub(super) fn too_many_vertices(count: u64) -> String {
    format!(
        "the header declares {count} vertices; at most {} can be handled",
        Mesh::LIMIT
    )
}

/// A coordinate is missing in the header.
pub(super) fn no_coordinate(name: &str) -> String {
    format!("the header declares vertices without `{name}`; expected the properties x, y and z")
}

/// The rest of the file cannot hold an element, whatever its numbers are.
pub(super) fn too_short(source: &impl Source, element: &Element, needed: u64) -> String {
    format!(
        "{}: {} items of `{}` need at least {needed} bytes, but {} are left; the file is cut off or its header is wrong",
        source.place(),
        element.count,
        element.name,
        source.remaining()
    )
}

/// There is no next number.
pub(super) fn no_number(
    source: &impl Source,
    fault: Fault,
    element: &Element,
    item: u64,
    property: &str,
) -> String {
    let found = match fault {
        Fault::End => "the file ends".to_string(),
        Fault::NotANumber(length) => format!("found `{}`", source.shown(length)),
        Fault::Length(length) => format!(
            "found a list of {length} numbers where {} bytes are left",
            source.remaining()
        ),
    };
    format!(
        "{}: {found}; expected `{property}` of {} {item} of {}",
        source.place(),
        element.name,
        element.count
    )
}

/// A coordinate is infinite or NaN.
pub(super) fn not_finite(source: &impl Source, vertex: u64, at: DVec3) -> String {
    format!(
        "{}: vertex {vertex} is ({}, {}, {}); expected finite coordinates",
        source.place(),
        at.x,
        at.y,
        at.z
    )
}

/// A corner of a face is no vertex.
pub(super) fn no_such_vertex(
    source: &impl Source,
    face: u64,
    corner: f64,
    vertices: u64,
) -> String {
    format!(
        "{}: face {face} names vertex {corner}; expected a number from 0 to {} (there are {vertices} vertices)",
        source.place(),
        vertices.saturating_sub(1)
    )
}

/// A face has texture coordinates for some of its corners.
pub(super) fn uneven_uvs(source: &impl Source, face: u64, corners: usize, uvs: usize) -> String {
    format!(
        "{}: face {face} has {corners} corners and {uvs} texture coordinates; expected two per corner or none",
        source.place()
    )
}
