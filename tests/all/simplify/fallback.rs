//! Images that do worse than geometry: the run returns what the memoryless method makes.

use lodmark::{
    mesh::{Mesh, canonical, generate},
    simplify::{
        MethodOptions, Options, Outcome, Replay, Target,
        image::{DrivingShading, ImageOptions, Size, Start},
        simplify,
    },
};

fn sphere() -> Mesh {
    canonical(&generate::icosphere(3)).mesh
}

/// Pictures of a few pixels, polished at length: nothing but their noise is fitted.
fn blind(triangles: u64) -> Options {
    let mut own = ImageOptions {
        size: Size::Pixels(8),
        samples: 1,
        shading: DrivingShading::Gouraud,
        ..ImageOptions::default()
    };
    own.polish.sweeps = 4;
    own.swept_weight = 0.0;
    own.polish.deviation_weight = 0.0;
    Options::new(own, Target::triangles(triangles))
}

fn with(options: &Options, change: impl FnOnce(&mut ImageOptions)) -> Options {
    let mut options = options.clone();
    if let MethodOptions::Image(own) = &mut options.method {
        change(own);
    }
    options
}

fn run(mesh: &Mesh, options: &Options) -> Outcome {
    simplify(mesh, options).expect("runs")
}

#[test]
fn where_images_fit_noise_the_memoryless_result_is_returned_to_the_bit() {
    let mesh = sphere();
    let outcome = run(&mesh, &blind(640));
    let comparison = outcome.comparison().expect("compared");
    assert!(comparison.fell_back, "{comparison:?}");
    assert!(comparison.image > comparison.memoryless * 0.97);
    let geometry = run(&mesh, &Options::memoryless(Target::Triangles(640)));
    assert_eq!(outcome.mesh, geometry.mesh);
    // What describes the mesh that was thrown away is gone with it.
    assert_eq!((outcome.error_rms(), outcome.polish()), (None, None));
    let mut replay = Replay::new(&mesh, &outcome.history).expect("its mesh");
    replay.seek(640).expect("replays");
    assert_eq!(replay.live().to_mesh().expect("a mesh"), outcome.mesh);
}

#[test]
fn whoever_wants_the_image_driven_result_gets_it() {
    let mesh = sphere();
    let options = with(&blind(640), |own| own.fall_back = false);
    let outcome = run(&mesh, &options);
    assert_eq!(outcome.comparison(), None);
    assert!(outcome.polish().is_some());
    let geometry = run(&mesh, &Options::memoryless(Target::Triangles(640)));
    assert_ne!(outcome.mesh, geometry.mesh);
}

#[test]
fn where_images_pay_nothing_changes() {
    let mesh = canonical(&generate::interlocking_tori(24, 12)).mesh;
    let options = Options::image(Target::Triangles(200));
    let kept = run(&mesh, &options);
    assert!(kept.comparison().is_none_or(|c| !c.fell_back));
    let free = run(&mesh, &with(&options, |own| own.fall_back = false));
    assert_eq!(kept.mesh, free.mesh);
    assert_eq!(kept.error_rms(), free.error_rms());
}

/// At a boundary a collapse takes one triangle, elsewhere two: results for one target differ by one.
#[test]
fn geometry_is_not_given_up_for_one_triangle_more_than_images_left() {
    let mesh = canonical(&generate::grid(16, 16, generate::Height::Waves)).mesh;
    let mut more = 0;
    for triangles in 201..213 {
        let outcome = run(&mesh, &blind(triangles));
        let comparison = outcome.comparison().expect("compared");
        let pays = comparison.image < comparison.memoryless * 0.97 && comparison.memoryless >= 0.25;
        assert_eq!(comparison.fell_back, !pays, "{triangles}: {comparison:?}");
        assert!(outcome.mesh.triangles().len() as u64 <= triangles);
        let images = run(&mesh, &with(&blind(triangles), |own| own.fall_back = false));
        let left = images.mesh.triangles().len();
        more += usize::from(comparison.fell_back && outcome.mesh.triangles().len() > left);
    }
    assert!(more > 0, "no case has what this is about");
}

/// Flat and shaded by the normals of its vertices, a square looks alike with any triangles.
#[test]
fn differences_far_below_a_level_of_luma_are_no_reason_for_images() {
    let mesh = canonical(&generate::grid(16, 16, generate::Height::Flat)).mesh;
    for triangles in [101, 204, 205] {
        let options = with(&Options::image(Target::Triangles(triangles)), |own| {
            own.shading = DrivingShading::Gouraud;
        });
        let comparison = run(&mesh, &options).comparison().expect("compared");
        assert!(comparison.memoryless < 0.25, "{comparison:?}");
        assert!(comparison.fell_back, "{triangles}: {comparison:?}");
    }
}

#[test]
fn nothing_is_compared_where_more_than_a_number_limits_the_run() {
    let mesh = sphere();
    let limited = blind(640).error_rms(200.0);
    let inside = with(&blind(640), |own| own.interior_views = 1);
    for options in [limited, inside] {
        assert_eq!(run(&mesh, &options).comparison(), None);
    }
}

/// A ratio is one of the input, not of the mesh that images start from.
#[test]
fn a_ratio_means_the_same_to_both_methods() {
    let mesh = sphere();
    let start = |own: &mut ImageOptions| own.start = Start::Triangles(800);
    let by_count = with(&blind(640), start);
    let by_ratio = by_count.clone().target(Target::ratio(0.5));
    let [count, ratio] = [by_count, by_ratio].map(|options| run(&mesh, &options));
    assert_eq!(count.comparison(), ratio.comparison());
    assert_eq!(count.mesh, ratio.mesh);
}
