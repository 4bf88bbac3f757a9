//! Interior views of the image-driven method: Lindstrom & Turk 2000, section 5.2 and Plate 3.

use std::sync::OnceLock;

use lodmark::{
    Silent,
    mesh::{Mesh, canonical, generate},
    metric::{appearance::flat, surface::surface_distance},
    simplify::{
        Options, Schedule, Target,
        image::{ImageOptions, Preset, Size, Start},
        simplify,
    },
    view::{Cull, Projection, ViewSet, sets::rhombicuboctahedron},
};

use crate::support::{framed, scene_of};

/// The scene, and what is left of it with 0, 10 and 20 of 20 views that look inside.
fn results() -> &'static (Mesh, [Mesh; 3]) {
    static RESULTS: OnceLock<(Mesh, [Mesh; 3])> = OnceLock::new();
    RESULTS.get_or_init(|| {
        let mesh = canonical(&generate::encased(1)).mesh;
        let reduced = [0, 10, 20].map(|interior_views| {
            let own = ImageOptions {
                size: Size::Pixels(48),
                start: Start::Input,
                interior_views,
                ..Preset::Paper.options()
            };
            // Another schedule than the preset's notices costs that fall.
            let options = Options::new(own, Target::triangles(220)).schedule(Schedule::Semi);
            simplify(&mesh, &options).expect("runs").mesh
        });
        (mesh, reduced)
    })
}

/// Flat RMS in views that drove nothing.
fn rms(original: &Mesh, other: &Mesh, cull: Cull) -> f64 {
    let (frame, original, sphere) = framed(original);
    let other = other.enter_frame(frame).in_frame_units().clone();
    let directions = rhombicuboctahedron();
    let views = ViewSet::around(&sphere, &directions, 96, 96, Projection::Perspective);
    let views = views.expect("small").with_cull(cull);
    let found = flat(&scene_of(&original), &[scene_of(&other)], &views, &Silent);
    found.expect("finite")[0].total().rms()
}

/// The part inside the casing, whose vertices are nearer to the middle.
fn inside(mesh: &Mesh) -> Mesh {
    let is_near = |v: &u32| mesh.positions()[*v as usize].length() < 1.88;
    let near = |t: &&[u32; 3]| t.iter().all(is_near);
    let triangles = mesh.triangles().iter().filter(near).copied().collect();
    Mesh::from_triangles(mesh.positions().to_vec(), triangles).expect("a part")
}

#[test]
fn half_of_the_views_inside_cost_the_outside_less_than_all_of_them() {
    let (mesh, reduced) = results();
    let [none, half, all] = reduced.each_ref().map(|m| rms(mesh, m, Cull::None));
    assert!(none < half && half < all, "{none} {half} {all}");
    let [none, half, all] = reduced.each_ref().map(|m| rms(mesh, m, Cull::Front));
    assert!(half < none && all < none, "{none} {half} {all}");
}

#[test]
fn what_some_views_see_inside_keeps_its_basic_shape() {
    let (mesh, reduced) = results();
    let original = inside(mesh);
    assert_eq!(original.triangles().len(), 512);
    let parts = reduced.each_ref().map(inside);
    let [none, half, all] = parts.each_ref().map(|part| {
        let distance = surface_distance(&original, part, 4_000, &Silent).expect("both have area");
        distance.relative().expect("a diagonal").mean
    });
    let counts = parts.each_ref().map(|p| p.triangles().len());
    assert!(half < 0.5 * none, "{none} {half} {all} with {counts:?}");
    assert!(all < none, "{none} {half} {all} with {counts:?}");
    assert!(counts[0] < counts[1] && counts[1] < counts[2], "{counts:?}");
}
