//! Small meshes for tests: closed, open, non-manifold, duplicated, soups; plain and textured.

use glam::DVec3;
use lodmark::{
    collapse::LiveMesh,
    mesh::{Attributes, ChannelKind, Materials, Mesh, MeshParts},
    num::Frame,
    raster::{FaceGeometry, Scene},
    view::{Sphere, frame_of},
};

use super::Random;

/// A mesh to draw in views that are in its units.
pub(crate) fn scene_of(mesh: &Mesh) -> Scene {
    Scene::of(&mesh.enter_frame(Frame::default()))
}

/// The frame of a mesh, the mesh in its units, and the sphere around that.
pub(crate) fn framed(mesh: &Mesh) -> (Frame, Mesh, Sphere) {
    let frame = frame_of(mesh);
    let original = mesh.enter_frame(frame).in_frame_units().clone();
    let sphere = Sphere::of_mesh(&original).expect("triangles");
    (frame, original, sphere)
}

/// A live copy of a mesh in its own frame.
pub(crate) fn live(mesh: &Mesh) -> LiveMesh {
    LiveMesh::new(mesh, frame_of(mesh))
}

/// A live mesh as it is now, in units of its frame.
pub(crate) fn snapshot(live: &LiveMesh) -> Mesh {
    let mesh = live.to_mesh().expect("valid");
    mesh.enter_frame(live.frame()).in_frame_units().clone()
}

fn jitter(positions: &mut [DVec3], amount: f64, random: &mut Random) {
    for p in positions {
        let mut axis = || (random.unit() - 0.5) * amount;
        *p += DVec3::new(axis(), axis(), axis());
    }
}

/// An open, bumpy grid of `n * n` squares.
pub(crate) fn grid(n: usize, seed: u64) -> Mesh {
    let mut random = Random(seed);
    let mut positions = Vec::new();
    for y in 0..=n {
        for x in 0..=n {
            positions.push(DVec3::new(x as f64, y as f64, random.unit() * 0.6));
        }
    }
    let at = |x: usize, y: usize| (y * (n + 1) + x) as u32;
    let mut triangles = Vec::new();
    for y in 0..n {
        for x in 0..n {
            triangles.push([at(x, y), at(x + 1, y), at(x + 1, y + 1)]);
            triangles.push([at(x, y), at(x + 1, y + 1), at(x, y + 1)]);
        }
    }
    Mesh::from_triangles(positions, triangles).expect("valid")
}

/// A closed, bumpy torus of `n * m` squares.
pub(crate) fn torus(n: usize, m: usize, seed: u64) -> Mesh {
    let (positions, triangles, _) = torus_parts(n, m, seed);
    Mesh::from_triangles(positions, triangles).expect("valid")
}

type Parts = (Vec<DVec3>, Vec<[u32; 3]>, Vec<[[usize; 2]; 3]>);

fn torus_parts(n: usize, m: usize, seed: u64) -> Parts {
    let mut positions = Vec::new();
    for i in 0..n {
        for j in 0..m {
            let a = i as f64 / n as f64 * std::f64::consts::TAU;
            let b = j as f64 / m as f64 * std::f64::consts::TAU;
            let r = 2.0 + libm::cos(b);
            positions.push(DVec3::new(r * libm::cos(a), r * libm::sin(a), libm::sin(b)));
        }
    }
    jitter(&mut positions, 0.1, &mut Random(seed));
    let (mut triangles, mut cells) = (Vec::new(), Vec::new());
    for i in 0..n {
        for j in 0..m {
            for cell in [
                [[i, j], [i + 1, j], [i + 1, j + 1]],
                [[i, j], [i + 1, j + 1], [i, j + 1]],
            ] {
                triangles.push(cell.map(|[i, j]| ((i % n) * m + j % m) as u32));
                cells.push(cell);
            }
        }
    }
    (positions, triangles, cells)
}

/// A torus with one chart whose seams run around it in both directions; normals that differ at every corner if `flat`.
pub(crate) fn textured_torus(n: usize, m: usize, seed: u64, flat: bool) -> Mesh {
    let (positions, triangles, cells) = torus_parts(n, m, seed);
    let mut kinds = vec![ChannelKind::TexCoord(0)];
    if flat {
        kinds.push(ChannelKind::Normal);
    }
    let (mut values, mut corners) = (Vec::new(), Vec::new());
    for (t, cell) in cells.iter().enumerate() {
        let p = triangles[t].map(|v| positions[v as usize]);
        let normal = (p[1] - p[0]).cross(p[2] - p[0]).normalize();
        let mut wedges = [0; 3];
        for (k, [i, j]) in cell.iter().enumerate() {
            wedges[k] = (values.len() / if flat { 5 } else { 2 }) as u32;
            values.extend([*i as f64 / n as f64, *j as f64 / m as f64]);
            if flat {
                values.extend(normal.to_array().map(|x| f64::from(x as f32)));
            }
        }
        corners.push(wedges);
    }
    let attributes = Attributes::new(&kinds, values, corners).expect("valid");
    Mesh::new(MeshParts {
        positions,
        triangles,
        attributes,
        ..MeshParts::default()
    })
    .expect("valid")
}

/// `mesh` with a normal at every corner, absent where `normal` gives none: asked by the number of the corner, its position
/// and the unit normal of its triangle. Other attributes are left behind.
pub(crate) fn with_normals(
    mesh: &Mesh,
    normal: impl Fn(u32, DVec3, DVec3) -> Option<DVec3>,
) -> Mesh {
    let (mut values, mut corners) = (Vec::new(), Vec::new());
    for (t, triangle) in (0..).zip(mesh.triangles()) {
        let points = triangle.map(|v| mesh.positions()[v as usize]);
        let own = FaceGeometry::new(points).normal;
        let wedges = [3 * t, 3 * t + 1, 3 * t + 2];
        for (wedge, p) in wedges.into_iter().zip(points) {
            let normal = normal(wedge, p, own);
            values.extend(normal.map_or([f64::NAN; 3], |n| n.to_array()));
        }
        corners.push(wedges);
    }
    let attributes = Attributes::new(&[ChannelKind::Normal], values, corners).expect("valid");
    let parts = mesh.clone().into_parts();
    Mesh::new(MeshParts {
        attributes,
        ..parts
    })
    .expect("the mesh was valid before")
}

/// A bumpy cube of six `n * n` sides; every side is a chart (if `charts`) and has its own material (if `materials`).
pub(crate) fn cube(n: usize, charts: bool, materials: bool) -> Mesh {
    let mut positions: Vec<DVec3> = Vec::new();
    let (mut triangles, mut values, mut corners, mut of_triangle) =
        (Vec::new(), Vec::new(), Vec::new(), Vec::new());
    let axes = [DVec3::X, DVec3::Y, DVec3::Z];
    for side in 0..6_usize {
        let (a, b) = (axes[(side / 2 + 1) % 3], axes[(side / 2 + 2) % 3]);
        let (a, b) = if side % 2 == 0 { (a, b) } else { (b, a) };
        let out = a.cross(b);
        let first_wedge = values.len() / 2;
        let mut ids = Vec::new();
        for y in 0..=n {
            for x in 0..=n {
                let (s, t) = (x as f64 / n as f64, y as f64 / n as f64);
                let inner = x > 0 && x < n && y > 0 && y < n;
                let bump = if inner {
                    0.02 * ((x * 7 + y * 3) % 5) as f64
                } else {
                    0.0
                };
                let p = out * (1.0 + bump) + a * (2.0 * s - 1.0) + b * (2.0 * t - 1.0);
                let p = DVec3::from_array(p.to_array().map(|c| f64::from(c as f32) + 0.0));
                let known = positions.iter().position(|&q| q == p);
                ids.push(known.unwrap_or_else(|| {
                    positions.push(p);
                    positions.len() - 1
                }) as u32);
                let offset = if charts { side as f64 * 2.0 } else { 0.0 };
                values.extend([f64::from(s as f32) + offset, f64::from(t as f32)]);
            }
        }
        let at = |x: usize, y: usize| y * (n + 1) + x;
        for y in 0..n {
            for x in 0..n {
                for cell in [
                    [at(x, y), at(x + 1, y), at(x + 1, y + 1)],
                    [at(x, y), at(x + 1, y + 1), at(x, y + 1)],
                ] {
                    triangles.push(cell.map(|c| ids[c]));
                    corners.push(cell.map(|c| (first_wedge + c) as u32));
                    of_triangle.push(side as u32);
                }
            }
        }
    }
    let mut parts = MeshParts {
        positions,
        triangles,
        ..MeshParts::default()
    };
    if charts {
        let kinds = [ChannelKind::TexCoord(0)];
        parts.attributes = Attributes::new(&kinds, values, corners).expect("valid");
    }
    if materials {
        parts.materials = Materials {
            names: (0..6).map(|i| format!("side{i}")).collect(),
            of_triangle,
            libraries: Vec::new(),
            asset: None,
        };
    }
    Mesh::new(parts).expect("valid")
}

/// Random triangles over few vertices: edges with many faces, pinched vertices, duplicate and degenerate faces.
pub(crate) fn soup(vertices: usize, triangles: usize, seed: u64) -> Mesh {
    let mut random = Random(seed);
    let mut positions = vec![DVec3::ZERO; vertices];
    jitter(&mut positions, 2.0, &mut random);
    let triangles = (0..triangles)
        .map(|_| [0; 3].map(|_| random.below(vertices) as u32))
        .collect();
    Mesh::from_triangles(positions, triangles).expect("valid")
}

/// A grid with some of its triangles doubled (both ways round), fins on edges and a second sheet at one vertex.
pub(crate) fn fins(n: usize, seed: u64) -> Mesh {
    let parts = grid(n, seed).into_parts();
    let (mut positions, mut triangles) = (parts.positions, parts.triangles);
    let mut random = Random(seed ^ 0xf1f1);
    for _ in 0..n {
        let [a, b, c] = triangles[random.below(triangles.len())];
        match random.below(4) {
            0 => triangles.push([a, b, c]),
            1 => triangles.push([a, c, b]),
            2 => {
                let (p, q) = (positions[a as usize], positions[b as usize]);
                positions.push((p + q) * 0.5 + DVec3::Z * (1.0 + random.unit()));
                triangles.push([a, b, positions.len() as u32 - 1]);
            }
            _ => {
                let p = positions[a as usize];
                positions.push(p + DVec3::new(0.3, 0.1, 1.0 + random.unit()));
                positions.push(p + DVec3::new(-0.3, 0.2, 1.0 + random.unit()));
                let last = positions.len() as u32 - 1;
                triangles.push([a, last - 1, last]);
            }
        }
    }
    Mesh::from_triangles(positions, triangles).expect("valid")
}

/// One of the above, by number.
pub(crate) fn any(kind: usize, seed: u64) -> Mesh {
    match kind % 8 {
        0 => grid(5, seed),
        1 => torus(7, 5, seed),
        2 => soup(12, 30, seed),
        3 => fins(5, seed),
        4 => textured_torus(7, 5, seed, false),
        5 => textured_torus(6, 5, seed, true),
        6 => cube(4, true, true),
        _ => soup(40, 25, seed),
    }
}
