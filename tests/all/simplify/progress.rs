//! What a user hears of a run, and how soon a run ends that nobody wants any more.

use lodmark::{
    Error,
    bound::view_cell::ViewCell,
    mesh::{Mesh, canonical},
    simplify::{
        Options, Target, simplify_with,
        tolerance::{Distance, ToleranceOptions},
        view_bounded::ViewBoundedOptions,
    },
    view::ViewsName,
};

use crate::support::{Recorder, StopsAfter, at, folder, meshes};

/// A run of every method.
fn methods() -> Vec<Options> {
    let target = Target::Triangles(200);
    let cell = ViewCell::point(at(0.0, 0.0, 9.0)).expect("a point");
    vec![
        Options::image(target),
        Options::memoryless(target),
        Options::quadric(target),
        Options::visibility(target),
        Options::tolerance(ToleranceOptions::new(Distance::OfDiagonal(0.1)), target),
        Options::view_bounded(ViewBoundedOptions::new(cell, 20.0), target),
    ]
}

fn mesh() -> Mesh {
    canonical(&meshes::torus(32, 24, 1)).mesh
}

#[test]
fn every_method_stops_between_two_collapses() {
    let mesh = mesh();
    for options in methods() {
        let name = options.method.name();
        let whole = StopsAfter::new("collapse", u64::MAX);
        simplify_with(&mesh, &options, &whole).expect("nobody interrupts");
        let [steps, _] = whole.counts();
        assert!(steps > 0, "{name} reports no collapses");
        for step in [1, steps.div_ceil(2), steps] {
            let stopped = StopsAfter::new("collapse", step);
            let result = simplify_with(&mesh, &options, &stopped);
            assert!(matches!(result, Err(Error::Interrupted)), "{name}, {step}");
            let [reported, answers] = stopped.counts();
            assert_eq!(reported, step, "{name} goes on after step {step}");
            // Whatever draws pictures at the same time hears it too, once for every view.
            assert!(answers <= 64, "{name} asks {answers} times after {step}");
        }
    }
}

#[test]
fn unusable_views_are_refused_before_any_work() {
    let mesh = mesh();
    let dir = folder();
    let file = dir.path().join("views.json");
    std::fs::write(&file, "{\"schema\": 1, \"views\": []}").expect("writes");
    let with = |views: ViewsName, size: u32| {
        Options::image(Target::triangles(20))
            .views(views)
            .size(size)
    };
    // With views that can be used the memoryless method goes first.
    let first = StopsAfter::new("collapse", 1);
    let result = simplify_with(&mesh, &with(ViewsName::Dodecahedron, 64), &first);
    assert!(matches!(result, Err(Error::Interrupted)));
    for (views, size, code) in [
        (ViewsName::File(file), 64, 3),
        (ViewsName::File(dir.path().join("nowhere.json")), 64, 5),
        (ViewsName::Dodecahedron, 0, 2),
        (ViewsName::Octahedron(5), 2_048, 4),
    ] {
        let seen = Recorder::default();
        let refused = simplify_with(&mesh, &with(views.clone(), size), &seen);
        let error = refused.map(drop).expect_err("unusable");
        assert_eq!(error.exit_code(), code, "{views:?}: {error}");
        assert_eq!(seen.phases(), [""; 0], "{views:?}: work before `{error}`");
    }
}
