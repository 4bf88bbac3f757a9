//! Meshes, views and texts that several groups of cases use.

use glam::DVec3;

use super::Collector;
use crate::{
    Error, Result,
    encode::{png::Picture, sheet::sheet},
    geometry::area_normal,
    mesh::{Attributes, ChannelKind, Materials, Mesh, MeshParts, generate},
    num::{Each, Precision, math::unit},
    raster::{FaceGeometry, Scene, luma_sums, mean_luma},
    simplify::Outcome,
    view::{Cull, Sphere, View, ViewSet, frame_of},
};

/// The smallest sphere around a mesh.
pub(super) fn sphere_of(mesh: &Mesh) -> Result<Sphere> {
    Sphere::of_mesh(mesh).ok_or_else(|| Error::Internal("a golden mesh has no triangles".into()))
}

/// A mesh with a colour at every vertex that follows its position.
pub(super) fn colored(mesh: &Mesh) -> Mesh {
    let mut values = Vec::new();
    for p in mesh.positions() {
        // Steps of 1/64 in [0, 1]: exact in every file format.
        let channel = |x: f64| ((x * 0.25 + 0.5) * 64.0).floor().clamp(0.0, 64.0) / 64.0;
        values.extend(p.to_array().each(channel));
    }
    let attributes = Attributes::new(&[ChannelKind::Color], values, mesh.triangles().to_vec())
        .expect("a row for every vertex");
    let parts = mesh.clone().into_parts();
    Mesh::new(MeshParts {
        attributes,
        ..parts
    })
    .expect("the mesh was valid before")
}

/// A torus that stores smooth normals, every third triangle its own, and none at every eleventh corner.
pub(super) fn partly_smooth_torus(around: u32, across: u32) -> Mesh {
    let mesh = generate::torus(1.0, 0.4, around, across);
    let (mut values, mut corners) = (Vec::new(), Vec::new());
    for (t, triangle) in (0..).zip(mesh.triangles()) {
        let points = triangle.each(|v| mesh.positions()[v as usize]);
        let own = FaceGeometry::new(points).normal;
        let wedges = [3 * t, 3 * t + 1, 3 * t + 2];
        for (wedge, p) in wedges.into_iter().zip(points) {
            // Away from the circle in the middle.
            let center = unit(DVec3::new(p.x, p.y, 0.0)).unwrap_or(DVec3::ZERO);
            let smooth = unit(p - center).unwrap_or(own);
            values.extend(match (t % 3, wedge % 11) {
                (_, 0) => [f64::NAN; 3],
                (0, _) => own.to_array(),
                _ => smooth.to_array(),
            });
        }
        corners.push(wedges);
    }
    let attributes =
        Attributes::new(&[ChannelKind::Normal], values, corners).expect("a row for every corner");
    let parts = mesh.into_parts();
    Mesh::new(MeshParts {
        attributes,
        ..parts
    })
    .expect("the mesh was valid before")
}

/// A mesh with a stored normal at every vertex: the direction of the sum of its faces' area normals.
pub(super) fn lit(mesh: &Mesh) -> Mesh {
    let mut sums = vec![DVec3::ZERO; mesh.positions().len()];
    for (t, triangle) in mesh.triangles().iter().enumerate() {
        for &v in triangle {
            sums[v as usize] += area_normal(mesh.corners(t));
        }
    }
    let normal = |&sum: &DVec3| {
        let normal = Precision::F32.round_vector(unit(sum).unwrap_or(DVec3::Z));
        normal.to_array()
    };
    let values = sums.iter().flat_map(normal).collect();
    let attributes = Attributes::new(&[ChannelKind::Normal], values, mesh.triangles().to_vec())
        .expect("a row for every vertex");
    let parts = mesh.clone().into_parts();
    Mesh::new(MeshParts {
        attributes,
        ..parts
    })
    .expect("the mesh was valid before")
}

/// An open surface with a boundary.
pub(super) fn terrain() -> Mesh {
    generate::grid(12, 12, generate::Height::Polynomial)
}

/// An open surface with a material for each half: the border between them has to stay.
pub(super) fn two_materials() -> Mesh {
    let mesh = terrain();
    let half = |t: &[u32; 3]| u32::from(mesh.positions()[t[0] as usize].x >= 0.0);
    let materials = Materials {
        names: vec!["left".into(), "right".into()],
        of_triangle: mesh.triangles().iter().map(half).collect(),
        ..Materials::default()
    };
    let parts = mesh.into_parts();
    Mesh::new(MeshParts { materials, ..parts }).expect("the mesh was valid before")
}

/// The mesh, how many collapses led to it, and the bits of its error. Not how many evaluations: that is effort.
pub(super) fn outcome_items(collector: &mut Collector, name: &str, outcome: &Outcome) {
    collector.mesh(name, &outcome.mesh);
    let mut text = format!("{}", outcome.mesh.triangles().len());
    for phase in &outcome.phases {
        text += &format!(" {}-{}", phase.method, phase.counters.collapses);
    }
    if let Some(rms) = outcome.error_rms() {
        text += &format!(" {}", bits([rms]));
    }
    collector.text(&format!("{name}/run"), text);
}

/// The bits of numbers in hexadecimal digits.
pub(super) fn bits(numbers: impl IntoIterator<Item = f64>) -> String {
    let words = numbers.into_iter().map(|x| format!("{:016x}", x.to_bits()));
    words.collect::<Vec<_>>().join(" ")
}

/// Records a picture of meshes side by side, a row for every way of culling, from view 17 of the evaluation around the first
/// mesh.
pub(super) fn side_by_side(
    collector: &mut Collector,
    name: &str,
    meshes: &[Mesh],
    culls: &[Cull],
    size: u32,
) -> Result<()> {
    let Some(first) = meshes.first() else {
        return Ok(());
    };
    let frame = frame_of(first);
    let views = ViewSet {
        width: size,
        height: size,
        ..ViewSet::evaluation(&sphere_of(first.enter_frame(frame).in_frame_units())?)?
    };
    let view = views.views.get(17).copied();
    let view = view.ok_or_else(|| Error::Internal("24 views".into()))?;
    let scenes = meshes.iter().map(|m| Scene::of(&m.enter_frame(frame)));
    let scenes: Vec<Scene> = scenes.collect();
    let mut pictures = Vec::new();
    for &cull in culls {
        let view = View { cull, ..view };
        for scene in &scenes {
            let sums = luma_sums(scene, &view, &views);
            pictures.push((mean_luma(&sums, views.samples), ""));
        }
    }
    let picture = sheet(&pictures, meshes.len() as u32, 0)?;
    collector.plane(name, &picture);
    collector.shown(Picture::Grey(picture));
    Ok(())
}
