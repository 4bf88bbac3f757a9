//! Embree as an oracle: ID buffers and visibility against rays that another program casts.
//!
//! `tests/oracles/embree.py` does the casting; `oracle.rs` installs what it needs, or says why the tests are skipped.
//!
//! `LODMARK_EMBREE=full` measures at the size of the acceptance, minutes instead of seconds; see the numbers with
//! `LODMARK_EMBREE=full cargo test --release --locked --test all embree -- --nocapture`.

use std::{collections::BTreeMap, fs, path::Path};

use glam::DVec3;
use lodmark::{
    Silent,
    encode::npy,
    mesh::{Mesh, generate},
    num::fixed::SubpixelBits,
    raster::{self, Grid, SampleKey},
    validate::rays::{Class, RayCaster, Tally},
    view::{Eye, Projection, Sphere, ViewSet, file, frame_of, sets},
    visibility::{self, MeasureOptions},
};

use crate::{
    support::{
        folder, model,
        oracle::{embree, oracle},
        say, scene_of,
    },
    validate::rays::framed,
};

/// True where the measurements of the acceptance are asked for.
fn full() -> bool {
    std::env::var("LODMARK_EMBREE").is_ok_and(|v| v == "full")
}

fn write_mesh(exchange: &Path, mesh: &Mesh) {
    let positions: Vec<[f64; 3]> = mesh.positions().iter().map(|p| p.to_array()).collect();
    npy::write_rows(&exchange.join("positions.npy"), &positions).expect("writes");
    npy::write_rows(&exchange.join("indices.npy"), mesh.triangles()).expect("writes");
}

fn write_views(exchange: &Path, set: &ViewSet) {
    let text = file::to_json(set, &[]).expect("finite views");
    fs::write(exchange.join("scene.json"), text).expect("writes");
}

/// For every triangle the first with the same corners: where a face occurs twice, Embree hits either.
fn first_of_its_place(mesh: &Mesh) -> Vec<u32> {
    let mut first = BTreeMap::new();
    let place = |(t, corners): (u32, &[u32; 3])| {
        let bits = |v: u32| mesh.positions()[v as usize].to_array().map(f64::to_bits);
        let mut corners = corners.map(bits);
        corners.sort_unstable();
        *first.entry(corners).or_insert(t)
    };
    (0..).zip(mesh.triangles()).map(place).collect()
}

/// The rasterizer against Embree, and the largest share of pixels of one triangle whose depths differ by more than
/// 1e-5 of their distance.
fn against_embree(packages: &Path, mesh: &Mesh, set: &ViewSet) -> (Tally, f64) {
    let dir = folder();
    write_mesh(dir.path(), mesh);
    write_views(dir.path(), set);
    oracle(packages, &["cast"], dir.path());
    let (caster, scene) = (RayCaster::new(mesh), scene_of(mesh));
    let face = first_of_its_place(mesh);
    let (mut tally, mut far, mut same) = (Tally::default(), 0_u64, 0_u64);
    for (i, view) in set.views.iter().enumerate() {
        let plane = |what: &str| dir.path().join(format!("view-{i:02}-{what}.npy"));
        let ids: Grid<u32> = npy::read_plane(&plane("ids")).expect("reads");
        let depths: Grid<f64> = npy::read_plane(&plane("depth")).expect("reads");
        let drawn = raster::keys(&scene, view, set).keys;
        let mut cast = drawn.clone();
        // The distance from the plane of the eye.
        let distance = |z: f64| match view.eye {
            Eye::Point(_) => view.near * view.far / (view.far - z * (view.far - view.near)),
            Eye::Axis(_) => view.near + z * (view.far - view.near),
        };
        let keys = cast.values_mut().iter_mut().zip(ids.values());
        for ((key, &id), &z) in keys.zip(depths.values()) {
            if id == 0 {
                *key = SampleKey::BACKGROUND;
            } else if !key.is_background() && face[key.id() as usize] == face[id as usize - 1] {
                let [ours, theirs] = [f64::from(key.depth()) / 4_294_967_296.0, z].map(distance);
                same += 1;
                far += u64::from((ours - theirs).abs() > 1e-5 * ours);
            } else {
                *key = SampleKey::new((z * 4_294_967_296.0) as u32, id - 1);
            }
        }
        let found = caster.classify(set, i, [&drawn, &cast], &Silent);
        tally.add(&found.expect("one size"));
    }
    (tally, far as f64 / same.max(1) as f64)
}

fn tell(name: &str, tally: &Tally, far: f64) {
    say(&format!(
        "{name}: {} pixels, {} unexplained, {} explained ({:.2e}: {} edge, {} depth tie, {} degenerate), depths {far:.1e}",
        tally.pixels,
        tally.unexplained(),
        tally.explained(),
        tally.explained_share(),
        tally.of(Class::Edge),
        tally.of(Class::DepthTie),
        tally.of(Class::Degenerate)
    ));
}

#[test]
fn embree_hits_what_the_rasterizer_shows() {
    let Some(packages) = embree() else {
        return;
    };
    let (count, size) = if full() { (20, 480) } else { (2, 160) };
    let wanted = |name| full() || ["engine", "tori", "probe"].contains(name);
    let scenes = generate::NAMED.iter().filter(|(name, _)| wanted(name));
    let mut scenes: Vec<(&str, Mesh)> = scenes.map(|(name, make)| (*name, make())).collect();
    for name in ["bunny.ply", "dragon.ply"] {
        if (full() || name == "bunny.ply")
            && let Some(mesh) = model(name)
        {
            scenes.push((name, mesh));
        }
    }
    for (name, mesh) in scenes {
        for projection in [Projection::Perspective, Projection::Orthographic] {
            let (mesh, set) = framed(&mesh, count, size, SubpixelBits::Sixteen, projection);
            let (tally, far) = against_embree(packages, &mesh, &set);
            tell(&format!("{name} {projection:?}"), &tally, far);
            assert_eq!(tally.unexplained(), 0, "{name}: {:?}", tally.worst);
            // Orthographic views of a regular grid put rows of pixel centres on edges, for which Embree has no rule.
            if projection == Projection::Perspective || name != "plane" {
                assert!(tally.explained_share() <= 1e-4, "{name}: {tally:?}");
            }
            assert!(far <= 1e-3, "{name}: {far} of the depths differ");
        }
    }
}

#[test]
fn embree_finds_a_planted_bug() {
    let Some(packages) = embree() else {
        return;
    };
    // Half a pixel is a shift of the views that only Embree is told of.
    let (torus, bits) = (generate::torus(1.0, 0.4, 24, 12), SubpixelBits::Sixteen);
    let (mesh, set) = framed(&torus, 1, 64, bits, Projection::Perspective);
    let dir = folder();
    let mut moved = set.clone();
    let (offset, row) = (moved.views[0].matrix[3], &mut moved.views[0].matrix[0]);
    for (x, w) in row.iter_mut().zip(offset) {
        *x += w / 64.0;
    }
    write_mesh(dir.path(), &mesh);
    write_views(dir.path(), &moved);
    oracle(packages, &["cast"], dir.path());
    let ids: Grid<u32> = npy::read_plane(&dir.path().join("view-00-ids.npy")).expect("reads");
    let drawn = raster::keys(&scene_of(&mesh), &set.views[0], &set).keys;
    let mut cast = drawn.clone();
    for (key, &id) in cast.values_mut().iter_mut().zip(ids.values()) {
        *key = match id {
            0 => SampleKey::BACKGROUND,
            id => SampleKey::new(key.depth(), id - 1),
        };
    }
    let caster = RayCaster::new(&mesh);
    let found = caster.classify(&set, 0, [&drawn, &cast], &Silent);
    let witnesses = found.expect("one size").witnesses;
    let wrong = witnesses.iter().filter(|w| w.class == Class::Rays).count();
    assert!(wrong > 100, "{wrong}");
}

/// V of every triangle as the oracle has left it.
fn measured(exchange: &Path) -> Vec<f64> {
    let plane: Grid<f64> = npy::read_plane(&exchange.join("visibility.npy")).expect("reads");
    plane.values().to_vec()
}

/// The mean over the surface, of the triangles with a value.
fn mean(mesh: &Mesh, values: &[f64], with: &[f64]) -> f64 {
    let (mut sum, mut all) = (0.0, 0.0);
    for (t, (v, with)) in values.iter().zip(with).enumerate() {
        if !with.is_nan() {
            let [a, b, c] = mesh.corners(t);
            let area = (b - a).cross(c - a).length();
            sum += area * v;
            all += area;
        }
    }
    sum / all
}

/// V of every triangle by shadow rays towards `directions`; NaN but for every `step`-th.
fn by_shadows(packages: &Path, mesh: &Mesh, directions: &[DVec3], step: usize) -> Vec<f64> {
    let dir = folder();
    write_mesh(dir.path(), mesh);
    let rows: Vec<[f64; 3]> = directions.iter().map(|d| d.to_array()).collect();
    npy::write_rows(&dir.path().join("directions.npy"), &rows).expect("writes");
    oracle(packages, &["shadow", &step.to_string()], dir.path());
    measured(dir.path())
}

/// V of every triangle by the rule of the paper on what Embree casts from the cameras of `options`.
fn by_paper(packages: &Path, mesh: &Mesh, options: &MeasureOptions) -> Vec<f64> {
    let sphere = Sphere::of_mesh(mesh).expect("triangles");
    let towards = sets::octahedron(options.octahedron);
    let size = options.size;
    let set = ViewSet::around(&sphere, &towards, size, size, Projection::Orthographic);
    let dir = folder();
    write_mesh(dir.path(), mesh);
    write_views(dir.path(), &set.expect("views"));
    oracle(packages, &["paper"], dir.path());
    measured(dir.path())
}

fn in_frame(mesh: &Mesh) -> Mesh {
    mesh.enter_frame(frame_of(mesh)).in_frame_units().clone()
}

/// The meshes whose visibility is measured, in their frames.
fn measured_meshes() -> Vec<(&'static str, Mesh)> {
    let mut meshes = vec![("tori", in_frame(&generate::interlocking_tori(64, 32)))];
    meshes.extend(model("bunny.ply").map(|mesh| ("bunny", in_frame(&mesh))));
    if full() {
        meshes.extend(model("dragon.ply").map(|mesh| ("dragon", in_frame(&mesh))));
    }
    meshes
}

#[test]
fn the_paper_measure_is_that_of_the_same_rule_on_what_embree_casts() {
    let Some(packages) = embree() else {
        return;
    };
    let (octahedron, size) = if full() { (2, 480) } else { (1, 200) };
    for (name, mesh) in measured_meshes() {
        let octahedron = if name == "dragon" { 1 } else { octahedron };
        // Embree is given whole triangles.
        let options = MeasureOptions {
            octahedron,
            size,
            edge_limit: None,
            ..MeasureOptions::paper()
        };
        let theirs = by_paper(packages, &mesh, &options);
        let ours = visibility::measure(&mesh, &options, &Silent).expect("measures");
        let theirs = mean(&mesh, &theirs, &theirs);
        let (ours, cameras) = (ours.mesh(), options.cameras());
        say(&format!(
            "{name}: V(M) by the rule of the paper, {cameras} cameras of {size}: {ours:.4}, Embree {theirs:.4}"
        ));
        assert!((ours - theirs).abs() <= 0.005, "{name}: {ours} {theirs}");
    }
}

#[test]
fn the_measure_approaches_that_of_shadow_rays_as_views_and_pixels_grow() {
    let Some(packages) = embree() else {
        return;
    };
    for (name, mesh) in measured_meshes() {
        let some = mesh.triangles().len() / 4_000;
        let step = if full() { 1 } else { some };
        // The truth: shadow rays in the directions of many cameras.
        let k = if full() { 3 } else { 2 };
        let shadows = by_shadows(packages, &mesh, &sets::octahedron(k), step.max(1));
        let truth = mean(&mesh, &shadows, &shadows);
        let count = sets::octahedron(k).len();
        say(&format!(
            "{name}: V(M) by shadow rays, {count} directions: {truth:.4}"
        ));
        let (coarse, fine) = match (full(), name) {
            (true, _) => (&[(1, 120), (2, 240)][..], (3, 480)),
            (false, "tori") => (&[(0, 60)][..], (2, 480)),
            (false, _) => (&[(0, 60)][..], (1, 200)),
        };
        let mut before = f64::INFINITY;
        for &(octahedron, size) in coarse.iter().chain([&fine]) {
            let options = MeasureOptions {
                octahedron,
                size,
                ..MeasureOptions::default()
            };
            let found = visibility::measure(&mesh, &options, &Silent).expect("measures");
            let ours = mean(&mesh, found.triangles(), &shadows);
            // Over triangles, so that too much here does not make up for too little there.
            let pairs = found.triangles().iter().zip(&shadows);
            let off: Vec<f64> = pairs.map(|(a, b)| (a - b).abs()).collect();
            let off = mean(&mesh, &off, &shadows);
            let cameras = options.cameras();
            say(&format!(
                "{name}: {cameras} cameras of {size}: {ours:.4}, mean difference of triangles {off:.4}"
            ));
            assert!(off < before, "{name}: {off} after {before}");
            before = off;
            if (octahedron, size) == fine {
                // 66 directions along the axes are not those of the cameras.
                let strict = full() || name == "bunny";
                let limit = if strict { 0.02 } else { 0.03 };
                assert!((ours - truth).abs() <= limit, "{name}: {ours} {truth}");
            }
        }
    }
}
