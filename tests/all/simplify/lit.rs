//! Stored normals that drive: where they do, and that the run says so.

use glam::DVec3;
use lodmark::{
    mesh::{Mesh, canonical, content_sha256, generate},
    simplify::{
        MethodOptions, Options, Outcome, Target,
        image::{DrivingShading, EngineName, ImageOptions, Preset, Start},
        simplify,
    },
    view::file,
};

use crate::{
    simplify::image::view_sets,
    support::{self, framed, meshes::with_normals, same_on_all_threads},
};

/// A torus that stores smooth normals, hard ones on a third of its faces, and none at some corners.
fn mesh() -> Mesh {
    let plain = generate::torus(1.0, 0.4, 16, 10);
    let smooth = |p: DVec3| {
        let around = DVec3::new(p.x, p.y, 0.0);
        p - around / around.length()
    };
    let mesh = with_normals(&plain, |corner, p, own| {
        match (corner / 3 % 3, corner % 11) {
            (_, 0) => None,
            (0, _) => Some(own),
            _ => Some(smooth(p)),
        }
    });
    canonical(&mesh).mesh
}

fn small(options: Options) -> Options {
    options.size(24).polish(1).start(Start::Triangles(200))
}

fn image() -> Options {
    small(Options::image(Target::triangles(120)).preset(Preset::Fast))
}

fn run(mesh: &Mesh, options: &Options) -> Outcome {
    simplify(mesh, options).expect("simplified")
}

/// Absent values are NaN, which equals nothing.
fn content(outcome: &Outcome) -> String {
    content_sha256(&outcome.mesh)
}

fn resolved(outcome: &Outcome) -> &ImageOptions {
    match &outcome.options.method {
        MethodOptions::Image(own) => own,
        other => panic!("{other:?}"),
    }
}

#[test]
fn pictures_are_lit_where_the_mesh_stores_normals_and_nobody_says_otherwise() {
    let lit = run(&mesh(), &image());
    let own = resolved(&lit);
    let weights = Preset::Fast.shaded(DrivingShading::Lit);
    assert_eq!(own.shading, DrivingShading::Lit);
    assert_eq!(own.swept_weight.to_bits(), weights.swept_weight.to_bits());
    assert_eq!(
        own.polish.deviation_weight.to_bits(),
        weights.polish.deviation_weight.to_bits()
    );
    let asked = run(&mesh(), &image().shading(DrivingShading::Lit));
    assert_eq!(
        (content(&asked), &asked.options),
        (content(&lit), &lit.options)
    );
    // The recorded options are the same run.
    let again = run(&mesh(), &lit.options);
    assert_eq!(
        (content(&again), &again.options),
        (content(&lit), &lit.options)
    );
    let flat = run(&mesh(), &image().shading(DrivingShading::Flat));
    assert_eq!(resolved(&flat).shading, DrivingShading::Flat);
    assert_ne!(content(&flat), content(&lit));
}

#[test]
fn a_mesh_without_normals_is_driven_flat_with_the_bits_that_flat_has() {
    let plain = generate::torus(1.0, 0.4, 16, 10);
    let found = run(&plain, &image());
    assert_eq!(resolved(&found).shading, DrivingShading::Flat);
    let flat = run(&plain, &image().shading(DrivingShading::Flat));
    assert_eq!((found.mesh, found.options), (flat.mesh, flat.options));
}

#[test]
fn the_published_method_and_view_files_keep_their_own_shading() {
    let published = Options::image(Target::triangles(120)).preset(Preset::Paper);
    let found = run(&mesh(), &small(published));
    assert_eq!(resolved(&found).shading, DrivingShading::Flat);
    let (frame, _, sphere) = framed(&mesh());
    let (_, set) = view_sets(&sphere).into_iter().next().expect("flat views");
    let folder = support::folder();
    let path = folder.path().join("views.json");
    let text = file::to_json(&set.leave_frame(frame), &[]).expect("finite");
    std::fs::write(&path, text).expect("written");
    let views = path.to_str().expect("a name").parse().expect("a file");
    let by_file = Options::image(Target::triangles(120)).preset(Preset::Fast);
    let found = run(&mesh(), &by_file.polish(0).views(views));
    assert_eq!(resolved(&found).shading, DrivingShading::Flat);
}

#[test]
fn a_step_that_says_the_shading_survives_every_order_of_steps() {
    let target = Target::triangles(120);
    for shading in [DrivingShading::Flat, DrivingShading::Lit] {
        let first = Options::image(target)
            .shading(shading)
            .preset(Preset::Paper);
        let last = Options::image(target)
            .preset(Preset::Paper)
            .shading(shading);
        assert_eq!(first, last);
    }
    let there_and_back = Options::image(target)
        .preset(Preset::Paper)
        .preset(Preset::Default);
    assert_eq!(there_and_back, Options::image(target));
}

#[test]
fn no_number_of_threads_and_no_engine_changes_a_lit_result() {
    let options = [EngineName::Layers, EngineName::Buckets].map(|engine| image().engine(engine));
    let run = |options: &Options| {
        let outcome = run(&mesh(), options);
        (
            content(&outcome),
            outcome.error_rms(),
            outcome.history.len(),
        )
    };
    let layers = same_on_all_threads(|| run(&options[0]));
    assert_eq!(layers, run(&options[1]));
    assert!(layers.1.is_some_and(|rms| rms > 0.0));
}

#[test]
fn the_report_of_the_command_says_which_shading_drove() {
    let dir = support::folder();
    support::put(&dir, "lit.obj", &mesh());
    support::put(&dir, "plain.obj", &generate::torus(1.0, 0.4, 16, 10));
    for (words, shading) in [
        ("lit.obj", "lit"),
        ("lit.obj --shading auto", "lit"),
        ("lit.obj --shading flat", "flat"),
        ("lit.obj --preset paper", "flat"),
        ("plain.obj", "flat"),
        ("plain.obj --shading lit", "lit"),
    ] {
        let (input, rest) = words.split_once(' ').unwrap_or((words, ""));
        let line =
            format!("simplify {input} out.obj --triangles 200 --size 24 --json r.json {rest}");
        support::expect(&dir, 0, line.trim_end());
        let method = &support::json(&dir, "r.json")["options"]["method"];
        assert_eq!(method["shading"], shading, "{words}");
    }
}
