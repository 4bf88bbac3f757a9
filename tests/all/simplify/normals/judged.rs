//! Fitted normals against carried and recomputed ones, judged by pictures that are lit from the eye.

use lodmark::{
    Silent, io,
    mesh::{Mesh, canonical, weld},
    simplify::{Normals, Options, Target, normals::settle, simplify},
};

use super::smooth;
use crate::support::{asset_file, lit_errors, model, say};

/// Simplifies to a share of the triangles and holds the fitted normals to a share of the error of the others.
fn fit_pays(name: &str, mesh: &Mesh, ratio: f64, pays: f64) {
    let options = Options::memoryless(Target::ratio(ratio)).normals(Normals::Carry);
    let carried = simplify(mesh, &options).expect("runs").mesh;
    let ways = [Normals::Fit, Normals::Carry, Normals::Recompute];
    let settled = ways.map(|way| settle(mesh, carried.clone(), way, &Silent).expect("runs"));
    let price = settled
        .each_ref()
        .map(|(_, report)| report.map(|r| [r.stored_vertices_carried, r.stored_vertices]));
    let [fit, carry, recompute] = settled.map(|(settled, _)| lit_errors(mesh, &settled)[0]);
    say(&format!(
        "{name} at {ratio}: lit error {fit:.3}, carried {carry:.3} ({:.3}), recomputed {recompute:.3} ({:.3}); {price:?} vertices",
        fit / carry,
        fit / recompute
    ));
    assert!(fit <= pays * carry && fit <= pays * recompute, "{name}");
}

/// An asset, welded and in canonical order.
fn asset(name: &str) -> Option<Mesh> {
    let mesh = io::read(&asset_file(name)?).expect("a good file").mesh;
    Some(canonical(&weld(mesh).mesh).mesh)
}

#[test]
fn fitted_normals_of_the_bunny_are_better_lit_than_carried_and_recomputed_ones() {
    if let Some(mesh) = model("bunny.ply") {
        fit_pays("bunny", &canonical(&smooth(mesh)).mesh, 0.02, 0.95);
    }
}

#[test]
fn fitted_normals_of_assets_are_better_lit_than_carried_and_recomputed_ones() {
    for name in [
        "FlightHelmet/FlightHelmet.gltf",
        "BoomBox/BoomBox.gltf",
        "DamagedHelmet.glb",
    ] {
        if let Some(mesh) = asset(name) {
            fit_pays(name, &mesh, 0.1, 0.98);
        }
    }
}
