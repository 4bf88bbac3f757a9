//! Cases of comparison: how far two meshes and their pictures are apart.

use super::{
    Collector,
    fixtures::{bits, sphere_of},
};
use crate::{
    Result, Silent,
    mesh::generate,
    metric::{luma::ViewErrors, silhouette::silhouette_histogram, surface::surface_distance},
    num::Each,
    raster::{Grid, Scene, luma_sums},
    view::{self, Interpolation, Projection, Shading, ViewsName, frame_of},
};

/// Squared luma errors as integers, distances as bits, silhouettes as counts.
pub(super) fn compared(collector: &mut Collector) -> Result<()> {
    let reference = generate::torus(1.0, 0.4, 24, 12);
    // Generated, so that a change of a method leaves these goldens alone.
    let candidate = generate::torus(1.0, 0.4, 14, 7);
    let sphere = sphere_of(&reference)?;
    let name = ViewsName::Rhombicuboctahedron;
    let flat = view::resolve(&name, &sphere, [48, 48], Projection::Perspective)?.with_samples(2)?;
    let gouraud = flat.clone().with_shading(Shading {
        interpolation: Interpolation::Gouraud,
        ..Shading::default()
    });
    let frame = frame_of(&reference);
    let scenes = [&reference, &candidate].each(|m| Scene::of(&m.enter_frame(frame)));
    for (shading, set) in [("flat", &flat), ("gouraud", &gouraud)] {
        let set = set.enter_frame(frame);
        let [expected, actual] = scenes.each_ref().each(|scene| {
            let drawn = set.views.iter().map(|v| luma_sums(scene, v, &set));
            drawn.collect::<Vec<Grid<u16>>>()
        });
        let errors = ViewErrors::between(&expected, &actual, set.samples * set.samples)?;
        let sums = errors.views().iter().map(|e| e.sum.to_string());
        let sums = sums.collect::<Vec<_>>().join(" ");
        collector.text(&format!("luma/{shading}/views"), sums);
        let total = errors.total();
        let counts = format!("{} {} {}", total.sum, total.pixels, total.samples);
        collector.text(&format!("luma/{shading}/total"), counts);
        let psnr = total.psnr().unwrap_or(f64::INFINITY);
        let name = format!("luma/{shading}/rms-psnr-bits");
        collector.text(&name, bits([total.rms(), psnr]));
    }
    let distance = surface_distance(&reference, &candidate, 2_000, &Silent)?;
    for (to, found) in [
        ("candidate", distance.to_candidate),
        ("reference", distance.to_reference),
    ] {
        let a = found.absolute;
        let text = format!("{} {}", found.samples, bits([a.mean, a.rms, a.max]));
        collector.text(&format!("distance/to-{to}-bits"), text);
    }
    let eyes: Vec<_> = flat.views.iter().map(|v| v.eye).collect();
    let histogram = silhouette_histogram(&candidate, &eyes, &Silent)?;
    let counts = histogram.counts().iter().map(u64::to_string);
    collector.text("silhouette", counts.collect::<Vec<_>>().join(" "));
    Ok(())
}
