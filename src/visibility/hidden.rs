//! Removes the triangles that no view sees.

use super::Visibility;
use crate::{
    Error, Result,
    mesh::{Attributes, ChannelKind, Mesh, MeshParts, VertexTriangles},
    num::Each,
};

/// The mesh without the triangles of which no view sees anything, from neither side; those that touch a seen one at a
/// vertex stay where `rings` is 1, those that touch these where it is 2, and so on.
///
/// Order, attributes and materials of the rest are kept; vertices and wedges that nothing uses any more are dropped.
/// Views that were not drawn may see what is removed: rings are the margin. O(rings x triangles).
///
/// # Errors
/// [`Error::Usage`] where `visibility` belongs to a mesh of another size, or nothing would be left.
pub fn remove_hidden(mesh: &Mesh, visibility: &Visibility, rings: u32) -> Result<Mesh> {
    let views = visibility.views();
    if views.len() != mesh.triangles().len() {
        return Err(Error::Usage(format!(
            "visibility of {} triangles for a mesh of {}; expected that of the same mesh",
            views.len(),
            mesh.triangles().len()
        )));
    }
    let mut kept: Vec<bool> = views.iter().map(|&n| n > 0).collect();
    if rings > 0 {
        grow(mesh, &mut kept, rings);
    }
    if !kept.contains(&true) {
        let told = "no view sees any triangle; expected something to keep: use larger ID buffers";
        return Err(Error::Usage(told.into()));
    }
    part(mesh, &kept).map_err(Error::internal)
}

/// Adds `rings` times the triangles at the vertices of those that are kept.
fn grow(mesh: &Mesh, kept: &mut [bool], rings: u32) {
    let around = VertexTriangles::of(mesh);
    let mut reached = vec![false; mesh.positions().len()];
    let of_kept = |&t: &u32| kept[t as usize];
    let mut border: Vec<u32> = (0..kept.len() as u32).filter(of_kept).collect();
    for _ in 0..rings {
        let mut next = Vec::new();
        for &t in &border {
            for v in mesh.triangles()[t as usize] {
                if std::mem::replace(&mut reached[v as usize], true) {
                    continue;
                }
                for &neighbor in around.at(v) {
                    if !std::mem::replace(&mut kept[neighbor as usize], true) {
                        next.push(neighbor);
                    }
                }
            }
        }
        if next.is_empty() {
            break;
        }
        border = next;
    }
}

/// The kept triangles of a mesh, with what they use.
fn part(mesh: &Mesh, kept: &[bool]) -> Result<Mesh> {
    let of_kept = |t: &usize| kept[*t];
    let chosen: Vec<usize> = (0..kept.len()).filter(of_kept).collect();
    let mut vertices = Renumbering::new(mesh.positions().len());
    let triangle = |&t: &usize| mesh.triangles()[t].each(|v| vertices.of(v));
    let triangles = chosen.iter().map(triangle).collect();
    let old = vertices.old.iter();
    let positions = old.map(|&v| mesh.positions()[v as usize]).collect();
    let attributes = mesh.attributes();
    let mut wedges = Renumbering::new(attributes.wedge_count());
    let corners: Vec<[u32; 3]> = if attributes.is_empty() {
        Vec::new()
    } else {
        let corners = chosen.iter().map(|&t| attributes.corners()[t]);
        corners.map(|c| c.each(|w| wedges.of(w))).collect()
    };
    let kinds: Vec<ChannelKind> = attributes.channels().iter().map(|c| c.kind).collect();
    let rows = wedges.old.iter().flat_map(|&w| attributes.row(w));
    let attributes = Attributes::new(&kinds, rows.copied().collect(), corners)?;
    let mut materials = mesh.materials().clone();
    let mut kept = kept.iter();
    materials.of_triangle.retain(|_| kept.next() == Some(&true));
    Mesh::new(MeshParts {
        positions,
        triangles,
        attributes,
        materials,
        precision: mesh.precision(),
    })
}

/// New numbers in the order of first use.
struct Renumbering {
    new: Vec<u32>,
    old: Vec<u32>,
}

impl Renumbering {
    fn new(count: usize) -> Self {
        Self {
            new: vec![u32::MAX; count],
            old: Vec::new(),
        }
    }

    fn of(&mut self, old: u32) -> u32 {
        let new = &mut self.new[old as usize];
        if *new == u32::MAX {
            *new = self.old.len() as u32;
            self.old.push(old);
        }
        *new
    }
}
