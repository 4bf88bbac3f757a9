//! The canonical order of a mesh: equal meshes are equal bytes, whatever the order in the file.
//!
//! Vertices lie along a Morton (Z-order) curve through the bounding box (G. M. Morton 1966), which also keeps
//! neighbours close in memory. Every triangle starts at its smallest vertex, orientation kept; triangles are sorted.
//! Two vertices at the very same place have no order of their own: weld first, or their order is that of first use.

use std::cmp::Ordering;

use glam::DVec3;

use super::{
    Attributes, ChannelKind, Materials, Mesh, MeshParts,
    group_equal::{compare_rows, group_equal},
};
use crate::{num::Each, parallel};

/// A mesh in canonical order, with what was dropped on the way.
#[derive(Clone, Debug, PartialEq)]
pub struct Canonical {
    /// The mesh.
    pub mesh: Mesh,
    /// Triangles that repeat a vertex: dropped. Triangles of no area with three different vertices stay.
    pub degenerate: usize,
    /// Vertices that no remaining triangle names: dropped.
    pub unreferenced: usize,
    /// For every vertex of `mesh`, its number before.
    pub vertices: Vec<u32>,
}

/// The canonical form of `mesh`: it does not depend on the order of vertices, triangles, wedges and material names,
/// nor on which corner a triangle starts at.
///
/// Vertices are sorted along the Morton curve (21 bits per axis of the bounding box), then by their coordinates, then
/// by first use. Triangles are sorted by vertices, then by material name, then by attribute values. Wedges are
/// numbered in the order of their first use; those of one vertex with equal bits are one. Material names are those in
/// use, sorted; libraries keep their order, which says which one wins. O(n log n).
///
/// # Panics
/// Never: the parts of a valid mesh in another order make a valid mesh.
#[must_use]
pub fn canonical(mesh: &Mesh) -> Canonical {
    let kept: Vec<usize> = (0..mesh.triangles().len())
        .filter(|&t| {
            let [a, b, c] = mesh.triangles()[t];
            a != b && b != c && c != a
        })
        .collect();
    let order = vertex_order(mesh, &kept);
    let mut renumbered = vec![u32::MAX; mesh.positions().len()];
    for (new, &old) in order.iter().enumerate() {
        renumbered[old as usize] = new as u32;
    }
    let triangles = sorted_triangles(mesh, &kept, &renumbered);
    let parts = MeshParts {
        positions: order
            .iter()
            .map(|&v| mesh.positions()[v as usize])
            .collect(),
        attributes: attributes(mesh.attributes(), &triangles),
        materials: materials(mesh.materials(), &triangles),
        triangles: triangles.iter().map(|t| t.vertices).collect(),
        precision: mesh.precision(),
    };
    Canonical {
        degenerate: mesh.triangles().len() - kept.len(),
        unreferenced: mesh.positions().len() - order.len(),
        mesh: Mesh::new(parts).expect("the parts of a valid mesh in another order"),
        vertices: order,
    }
}

/// A triangle in its new vertices, and where it came from.
#[derive(Clone, Copy)]
struct Placed {
    vertices: [u32; 3],
    /// Its old number, and how many corners it was rotated by.
    old: u32,
    rotation: u8,
}

/// The vertices that the kept triangles use, in canonical order.
fn vertex_order(mesh: &Mesh, kept: &[usize]) -> Vec<u32> {
    let mut seen = vec![false; mesh.positions().len()];
    let mut order = Vec::with_capacity(mesh.positions().len());
    for &t in kept {
        for v in mesh.triangles()[t] {
            if !std::mem::replace(&mut seen[v as usize], true) {
                order.push(v);
            }
        }
    }
    let place = |v: u32| mesh.positions()[v as usize];
    let Some(&first) = order.first() else {
        return order;
    };
    let (low, high) = order
        .iter()
        .fold((place(first), place(first)), |(low, high), &v| {
            (low.min(place(v)), high.max(place(v)))
        });
    let mut keyed: Vec<(u64, DVec3, u32, u32)> = parallel::map(order.len(), |use_order| {
        let v = order[use_order];
        (morton(place(v), low, high), place(v), use_order as u32, v)
    });
    parallel::sort_by(&mut keyed, |a, b| {
        a.0.cmp(&b.0)
            .then_with(|| compare_rows(&a.1.to_array(), &b.1.to_array()))
            .then(a.2.cmp(&b.2))
    });
    keyed.into_iter().map(|(_, _, _, v)| v).collect()
}

/// Cells of the curve along each axis: 2^21, so that three axes fill 63 bits.
const CELLS: f64 = 2_097_152.0;

/// The position of `p` along the Morton curve through the box: x in the lowest of every three bits.
fn morton(p: DVec3, low: DVec3, high: DVec3) -> u64 {
    let cell = |x: f64, low: f64, high: f64| {
        // Halves, so that the extent of a box around +-1e308 does not overflow.
        let (offset, extent) = (x * 0.5 - low * 0.5, high * 0.5 - low * 0.5);
        if extent > 0.0 {
            // `as` truncates; the far side of the box belongs to the last cell.
            ((offset / extent * CELLS) as u64).min(CELLS as u64 - 1)
        } else {
            0
        }
    };
    spread(cell(p.x, low.x, high.x))
        | spread(cell(p.y, low.y, high.y)) << 1
        | spread(cell(p.z, low.z, high.z)) << 2
}

/// The 21 bits of `x`, three apart.
fn spread(x: u64) -> u64 {
    let mut x = x & 0x1f_ffff;
    for (shift, mask) in [
        (32, 0x001f_0000_0000_ffff),
        (16, 0x001f_0000_ff00_00ff),
        (8, 0x100f_00f0_0f00_f00f),
        (4, 0x10c3_0c30_c30c_30c3),
        (2, 0x1249_2492_4924_9249),
    ] {
        x = (x | x << shift) & mask;
    }
    x
}

fn sorted_triangles(mesh: &Mesh, kept: &[usize], renumbered: &[u32]) -> Vec<Placed> {
    let mut triangles: Vec<Placed> = parallel::map_slice(kept, |&t| {
        let mut vertices = mesh.triangles()[t].each(|v| renumbered[v as usize]);
        let smallest = vertices[0].min(vertices[1]).min(vertices[2]);
        let rotation = vertices.iter().position(|&v| v == smallest).unwrap_or(0);
        vertices.rotate_left(rotation);
        Placed {
            vertices,
            old: t as u32,
            rotation: rotation as u8,
        }
    });
    parallel::sort_by(&mut triangles, |a, b| {
        (a.vertices, a.old).cmp(&(b.vertices, b.old))
    });
    let (attributes, materials) = (mesh.attributes(), mesh.materials());
    for run in triangles.chunk_by_mut(|a, b| a.vertices == b.vertices) {
        // Copies of one triangle: only what they carry tells them apart.
        run.sort_by(|a, b| {
            name_of(materials, a.old)
                .cmp(&name_of(materials, b.old))
                .then_with(|| {
                    if attributes.is_empty() {
                        return Ordering::Equal;
                    }
                    wedges_of(attributes, a)
                        .iter()
                        .zip(wedges_of(attributes, b))
                        .map(|(&x, y)| compare_rows(attributes.row(x), attributes.row(y)))
                        .find(|o| o.is_ne())
                        .unwrap_or(Ordering::Equal)
                })
        });
    }
    triangles
}

fn name_of(materials: &Materials, triangle: u32) -> Option<&str> {
    let index = materials.of(triangle as usize);
    materials.names.get(index as usize).map(String::as_str)
}

fn wedges_of(attributes: &Attributes, triangle: &Placed) -> [u32; 3] {
    let mut wedges = attributes.corners()[triangle.old as usize];
    wedges.rotate_left(triangle.rotation as usize);
    wedges
}

fn attributes(attributes: &Attributes, triangles: &[Placed]) -> Attributes {
    if attributes.is_empty() {
        return Attributes::default();
    }
    let corners: Vec<(u32, u32)> = triangles
        .iter()
        .flat_map(|t| {
            let wedges = wedges_of(attributes, t);
            [0, 1, 2].each(|i| (t.vertices[i], wedges[i]))
        })
        .collect();
    let united = group_equal(corners.len(), &|a, b| {
        let ((v, x), (w, y)) = (corners[a], corners[b]);
        v.cmp(&w).then_with(|| {
            if x == y {
                Ordering::Equal
            } else {
                compare_rows(attributes.row(x), attributes.row(y))
            }
        })
    });
    let mut values = Vec::with_capacity(united.firsts.len() * attributes.stride());
    for &corner in &united.firsts {
        values.extend_from_slice(attributes.row(corners[corner].1));
    }
    let kinds: Vec<ChannelKind> = attributes.channels().iter().map(|c| c.kind).collect();
    let (corners, _) = united.groups.as_chunks::<3>();
    Attributes::new(&kinds, values, corners.to_vec()).expect("rows of valid attributes")
}

fn materials(materials: &Materials, triangles: &[Placed]) -> Materials {
    let mut names: Vec<&str> = triangles
        .iter()
        .filter_map(|t| name_of(materials, t.old))
        .collect();
    names.sort_unstable();
    names.dedup();
    let of_triangle = if names.is_empty() {
        Vec::new()
    } else {
        triangles
            .iter()
            .map(|t| {
                name_of(materials, t.old)
                    .and_then(|name| names.binary_search(&name).ok())
                    .map_or(Materials::NONE, |i| i as u32)
            })
            .collect()
    };
    Materials {
        of_triangle,
        names: names.into_iter().map(String::from).collect(),
        libraries: materials.libraries.clone(),
        asset: materials.asset.clone(),
    }
}
