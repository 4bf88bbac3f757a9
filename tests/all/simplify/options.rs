//! Options are built step by step: no step is lost, and none that means nothing to the method passes.

use lodmark::{
    Error,
    bound::view_cell::ViewCell,
    mesh::generate,
    simplify::{
        MethodOptions, Options, Schedule, Target,
        image::{DrivingShading, EngineName, ImageOptions, Preset, Size, Start},
        simplify,
        tolerance::{Distance, ToleranceOptions},
        view_bounded::ViewBoundedOptions,
    },
    view::ViewsName,
};

pub(crate) const SHADINGS: [DrivingShading; 4] = [
    DrivingShading::Flat,
    DrivingShading::Gouraud,
    DrivingShading::Mixed,
    DrivingShading::Lit,
];

const PRESETS: [Preset; 4] = [Preset::Paper, Preset::Fast, Preset::Default, Preset::Best];

fn target() -> Target {
    Target::triangles(100)
}

fn image(options: &Options) -> &ImageOptions {
    match &options.method {
        MethodOptions::Image(own) => own,
        other => panic!("{other:?}"),
    }
}

#[test]
fn a_preset_brings_its_schedule_and_the_weights_of_the_shading() {
    for preset in PRESETS {
        for shading in SHADINGS {
            let first = Options::image(target()).preset(preset).shading(shading);
            let last = Options::image(target()).shading(shading).preset(preset);
            assert_eq!(first, last);
            assert_eq!(*image(&first), preset.shaded(shading));
            assert_eq!(first.schedule, preset.schedule());
            assert_eq!(first, Options::new(preset.shaded(shading), target()));
        }
    }
}

#[test]
fn a_preset_keeps_what_other_steps_have_set() {
    for preset in PRESETS {
        let steps = |options: Options| {
            options
                .views(ViewsName::Octahedron(1))
                .size(100)
                .samples(4)
                .interior_views(3)
                .start(Start::Triangles(700))
                .polish(11)
                .engine(EngineName::Buckets)
                .schedule(Schedule::Eager)
        };
        let before = steps(Options::image(target())).preset(preset);
        assert_eq!(before, steps(Options::image(target()).preset(preset)));
        let own = image(&before);
        assert_eq!((own.size, own.samples), (Size::Pixels(100), 4));
        assert_eq!((own.polish.sweeps, before.schedule), (11, Schedule::Eager));
        assert!(before.check().is_ok());
    }
}

#[test]
fn a_step_that_means_nothing_to_the_method_is_refused_by_name() {
    let distance = ToleranceOptions::new(Distance::OfDiagonal(0.1));
    let cell = ViewCell::point(glam::DVec3::ONE).expect("finite");
    let bound = ViewBoundedOptions::new(cell, 1.0);
    type Step = fn(Options) -> Options;
    let steps: [(&str, Step); 6] = [
        ("preset", |o| o.preset(Preset::Fast)),
        ("shading", |o| o.shading(DrivingShading::Mixed)),
        ("views", |o| o.views(ViewsName::Dodecahedron)),
        ("polish", |o| o.polish(3)),
        ("probabilistic", Options::probabilistic),
        ("attributes", Options::attributes),
    ];
    for options in [
        Options::memoryless(target()),
        Options::tolerance(distance, target()),
        Options::view_bounded(bound, target()),
    ] {
        assert!(options.check().is_ok());
        for (name, step) in steps {
            let refused = simplify(&generate::tetrahedron(), &step(options.clone()));
            let named = matches!(&refused, Err(Error::Usage(what)) if what.starts_with(name));
            assert!(named, "{refused:?}");
        }
    }
    for (name, options) in [
        ("keep_folds", Options::image(target()).keep_folds()),
        ("probabilistic", Options::image(target()).probabilistic()),
        ("attributes", Options::visibility(target()).attributes()),
        ("error-rms", Options::quadric(target()).error_rms(2.0)),
    ] {
        let refused = options.check().expect_err("refused").to_string();
        assert!(refused.contains(name), "{refused}");
    }
    let guided = Options::visibility(target()).probabilistic();
    assert!(guided.check().is_ok());
    assert!(Options::quadric(target()).keep_folds().check().is_ok());
}

#[test]
fn a_refused_step_leaves_no_trace_in_what_is_recorded() {
    let json = |options: &Options| serde_json::to_string(options).expect("JSON");
    let wrong = Options::memoryless(target()).polish(3);
    assert_eq!(json(&wrong), json(&Options::memoryless(target())));
    let read: Options = serde_json::from_str(&json(&wrong)).expect("options");
    assert!(read.check().is_ok());
}
