//! The report that holds candidates against a reference.

use lodmark::{
    Error, Silent,
    mesh::{Mesh, generate},
    metric::{
        folds::{Folds, folds},
        report::{CompareOptions, Judge, compare},
        surface::surface_distance,
    },
    view::{Interpolation, ViewsName},
};

fn options() -> CompareOptions {
    let mut options = CompareOptions::default()
        .views(ViewsName::Dodecahedron)
        .pictures(48, 2)
        .distance_samples(2_000);
    options.image_error = true;
    options
}

fn meshes() -> [Mesh; 3] {
    [3, 2, 1].map(generate::icosphere)
}

#[test]
fn a_candidate_is_judged_the_same_alone_and_in_company() {
    let [reference, fine, coarse] = meshes();
    let both = compare(&reference, &[&fine, &coarse], &options(), &Silent).expect("a report");
    for (mesh, report) in [&fine, &coarse].into_iter().zip(&both.candidates) {
        let alone = compare(&reference, &[mesh], &options(), &Silent).expect("a report");
        assert_eq!(alone.reference, both.reference);
        assert_eq!(alone.candidates[0].shape, report.shape);
        assert_eq!(alone.candidates[0].errors, report.errors);
    }
    let error = |i: usize| {
        let errors = &both.candidates[i].errors;
        let pictures = errors.pictures.expect("pictures were asked for");
        (pictures.rms_flat, errors.distances.distance_max)
    };
    assert!(error(0) < error(1), "{:?} {:?}", error(0), error(1));
}

#[test]
fn a_report_holds_what_its_measures_find_one_by_one() {
    let [reference, _, coarse] = meshes();
    let report = compare(&reference, &[&coarse], &options(), &Silent).expect("a report");
    let errors = &report.candidates[0].errors;
    let distance = surface_distance(&reference, &coarse, 2_000, &Silent).expect("distances");
    assert_eq!(errors.distances.distance, Some(distance));
    let folds = folds(&reference, &coarse, &Silent).expect("folds");
    assert_eq!(errors.folds, Some(folds));
    // In the views of equation 5.11 both flat errors are one.
    let (pictures, image) = (errors.pictures, errors.image_error);
    let flat = pictures.map(|p| p.squared_error_flat);
    assert_eq!(flat, image.map(|e| e.squared_error));
    let sum: u64 = errors.views.iter().map(|v| v.squared_error_flat).sum();
    assert_eq!(flat.map(|f| f.sum), Some(sum));
}

#[test]
fn a_mesh_does_not_differ_from_itself_anywhere() {
    let [reference, ..] = meshes();
    let report = compare(&reference, &[&reference], &options(), &Silent).expect("a report");
    let errors = &report.candidates[0].errors;
    let pictures = errors.pictures.expect("pictures were asked for");
    assert!(pictures.squared_error_flat.is_zero() && pictures.squared_error_gouraud.is_zero());
    assert_eq!(errors.image_error.map(|e| e.error), Some(0.0));
    assert!(errors.distances.distance_max.is_some_and(|d| d < 1e-12));
    assert_eq!(errors.folds, Some(Folds::default()));
    assert_eq!(report.candidates[0].shape, report.reference);
}

#[test]
fn only_what_is_asked_for_is_measured() {
    let [reference, fine, _] = meshes();
    let mut options = options();
    options.views = None;
    options.image_error = false;
    options.distance_samples = None;
    options.folds = false;
    let judge = Judge::new(&reference, &options).expect("a judge");
    let report = judge.compare(&[&fine], &Silent).expect("a report");
    let errors = &report.candidates[0].errors;
    assert!(errors.pictures.is_none() && errors.image_error.is_none() && errors.folds.is_none());
    assert!(errors.distances.distance.is_none() && errors.views.is_empty());
    assert!(report.reference.silhouette_histogram.is_none());
    let refused = judge.pictures(&[], 0, Interpolation::Flat);
    assert!(matches!(refused, Err(Error::Usage(_))));
}

#[test]
fn options_and_references_that_cannot_be_used_are_refused_before_any_work() {
    let [reference, ..] = meshes();
    for (size, samples) in [(0, 2), (48, 3), (1 << 20, 1)] {
        let options = options().pictures(size, samples);
        let refused = Judge::new(&reference, &options);
        assert!(matches!(refused, Err(Error::Usage(_))), "{size} {samples}");
    }
    let empty = Mesh::default();
    let refused = Judge::new(&empty, &options());
    assert!(matches!(refused, Err(Error::Usage(_))));
}
