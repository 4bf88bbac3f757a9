//! Cases of simplification: every method but those of hidden parts.

use glam::DVec3;

use super::{
    Collector,
    fixtures::{
        colored, lit, outcome_items, partly_smooth_torus, side_by_side, terrain, two_materials,
    },
};
use crate::{
    Error, Result,
    bound::{tolerance::Source, view_cell::ViewCell},
    mesh::{canonical, generate},
    simplify::{
        Normals, Options, Target, Topology,
        image::{DrivingShading, ImageOptions, Polish, Preset, Start},
        simplify,
        tolerance::{Distance, ToleranceOptions},
        view_bounded::ViewBoundedOptions,
    },
    view::{Cull, Specular, ViewsName},
};

/// Every method on closed, open, seamed and coloured meshes.
pub(super) fn simplified(collector: &mut Collector) -> Result<()> {
    geometric(collector)?;
    with_normals(collector)?;
    by_images(collector)?;
    within_distance(collector)?;
    bounded(collector)?;
    readme_picture(collector)
}

/// The methods that look at geometry alone.
fn geometric(collector: &mut Collector) -> Result<()> {
    let colors = colored(&generate::torus(1.0, 0.4, 16, 8));
    let cases = [
        ("cube", generate::cube(), 8),
        ("torus", generate::torus(1.0, 0.4, 24, 12), 120),
        ("textured-torus", generate::textured_torus(24, 12), 150),
        ("colored-torus", colors, 80),
        ("terrain", terrain(), 100),
        ("two-materials", two_materials(), 100),
        ("shells", generate::shells(2, 2), 120),
        ("probe", generate::probe(), 150),
    ];
    for (name, mesh, triangles) in &cases {
        let target = Target::Triangles(*triangles);
        let probabilistic = Options::quadric(target).probabilistic();
        for (method, options) in [
            ("memoryless", Options::memoryless(target)),
            ("quadric", Options::quadric(target)),
            ("quadric-probabilistic", probabilistic),
        ] {
            // What the rules refuse is recorded, whatever would give way for a target.
            let outcome = simplify(mesh, &options.topology(Topology::Preserve))?;
            outcome_items(collector, &format!("{name}/{method}"), &outcome);
        }
        if ["textured-torus", "colored-torus"].contains(name) {
            let options = Options::quadric(target).attributes();
            let outcome = simplify(mesh, &options.topology(Topology::Preserve))?;
            outcome_items(collector, &format!("{name}/quadric-attributes"), &outcome);
        }
    }
    Ok(())
}

/// Normals in every way, where most faces fold and where few do.
fn with_normals(collector: &mut Collector) -> Result<()> {
    let torus = lit(&generate::torus(1.0, 0.4, 24, 12));
    for (name, normals) in [
        ("fit", Normals::Fit),
        ("carry", Normals::Carry),
        ("recompute", Normals::Recompute),
        ("drop", Normals::Drop),
    ] {
        for triangles in [60, 300] {
            let options = Options::memoryless(Target::Triangles(triangles)).normals(normals);
            let mesh = simplify(&torus, &options)?.mesh;
            collector.mesh(&format!("lit-torus/{triangles}/normals-{name}"), &mesh);
        }
    }
    Ok(())
}

/// Options of the image method for small meshes, a driving set each: flat, Gouraud, lit and with interior views; every driving
/// view of the published method, after memoryless pre-simplification; the steps of the default preset in small, turned
/// cameras too, and with mixed shading.
fn recipes() -> [ImageOptions; 7] {
    let small = ImageOptions {
        views: ViewsName::Octahedron(0),
        size: 64.into(),
        samples: 1,
        start: Start::Input,
        polish: Polish::default(),
        // Some of the meshes store normals.
        shading: DrivingShading::Flat,
        // What pictures do is recorded, whatever geometry would do.
        fall_back: false,
        ..ImageOptions::default()
    };
    let gouraud = ImageOptions {
        shading: DrivingShading::Gouraud,
        ..small.clone()
    };
    let lit = ImageOptions {
        shading: DrivingShading::Lit,
        ..small.clone()
    };
    let interior = ImageOptions {
        interior_views: 2,
        specular: Some(Specular {
            strength: 0.4,
            exponent: 8,
        }),
        ..small.clone()
    };
    let published = ImageOptions {
        size: 64.into(),
        start: Start::Triangles(180),
        ..Preset::Paper.options()
    };
    let polished = ImageOptions {
        views: ViewsName::Spiral(9),
        size: 40.into(),
        polish: Polish {
            sweeps: 4,
            flips_every: 1,
            cameras_every: 2,
            deviation_weight: 0.3,
            least_share: 0.0,
        },
        fall_back: false,
        ..Preset::Default.options()
    };
    let mixed = ImageOptions {
        shading: DrivingShading::Mixed,
        ..polished.clone()
    };
    [small, gouraud, lit, interior, published, polished, mixed]
}

/// The image method.
fn by_images(collector: &mut Collector) -> Result<()> {
    let [small, gouraud, lit, interior, published, polished, mixed] = recipes();
    let torus = || generate::torus(1.0, 0.4, 16, 8);
    let textured = || generate::textured_torus(16, 8);
    let (shells, sphere) = (generate::shells(2, 2), generate::icosphere(3));
    for (name, mesh, triangles, own) in [
        ("torus/image-flat", torus(), 90, &small),
        ("torus/image-gouraud", torus(), 90, &gouraud),
        ("cube/image-flat", generate::cube(), 8, &small),
        ("torus/image-lit", partly_smooth_torus(16, 8), 90, &lit),
        ("textured-torus/image-flat", textured(), 120, &small),
        ("terrain/image-gouraud", terrain(), 120, &gouraud),
        ("two-materials/image-flat", two_materials(), 150, &small),
        ("shells/image-interior", shells, 400, &interior),
        ("probe/image-flat", generate::probe(), 300, &small),
        ("icosphere/image-published", sphere, 120, &published),
        ("torus/image-polished", torus(), 90, &polished),
        ("textured-torus/image-polished", textured(), 120, &polished),
        ("terrain/image-polished-mixed", terrain(), 120, &mixed),
    ] {
        let options = Options::new(own.clone(), Target::Triangles(triangles));
        let outcome = simplify(&mesh, &options.topology(Topology::Preserve))?;
        outcome_items(collector, name, &outcome);
    }
    let limited = Options::new(small, Target::ErrorOnly).error_rms(4.0);
    let outcome = simplify(&torus(), &limited)?;
    outcome_items(collector, "torus/image-error-rms", &outcome);
    Ok(())
}

/// Within a distance: with everything that the method can do.
fn within_distance(collector: &mut Collector) -> Result<()> {
    let within = ToleranceOptions::new(Distance::OfDiagonal(0.02));
    let widely = ToleranceOptions::new(Distance::OfDiagonal(0.04));
    let one_sided = ToleranceOptions {
        one_sided: true,
        volume: Some(Source::Vertices),
        ..widely
    };
    let growing = ToleranceOptions {
        volume: Some(Source::Edges),
        growing: true,
        ..widely
    };
    let torus = generate::torus(1.0, 0.4, 24, 12);
    // Volumes are slow: on 144 triangles they took half of the time of all goldens.
    let few = generate::torus(1.0, 0.4, 10, 5);
    let textured = generate::textured_torus(24, 12);
    for (name, mesh, own) in [
        ("torus/tolerance", &torus, within),
        ("torus/tolerance-one-sided", &few, one_sided),
        ("torus/tolerance-growing", &few, growing),
        ("terrain/tolerance", &terrain(), within),
        ("textured-torus/tolerance", &textured, within),
    ] {
        let options = Options::tolerance(own, Target::ErrorOnly);
        let outcome = simplify(mesh, &options)?;
        outcome_items(collector, name, &outcome);
    }
    Ok(())
}

/// Within an angle for viewers in a cell: the mesh, and what stands for what.
fn bounded(collector: &mut Collector) -> Result<()> {
    let at = |x: f64, y: f64| DVec3::new(x, y, 4.0);
    let cell = ViewCell::polygon(&[at(-1.0, -0.5), at(1.0, -0.5), at(0.5, 1.0)])?;
    let mesh = canonical(&generate::torus(1.0, 0.4, 24, 12)).mesh;
    let own = ViewBoundedOptions::new(cell, 0.5);
    let options = Options::view_bounded(own, Target::ErrorOnly);
    let outcome = simplify(&mesh, &options)?;
    outcome_items(collector, "torus/view-bounded", &outcome);
    let mut bytes = Vec::new();
    if let Some(map) = outcome.correspondence() {
        map.write(&mesh, &outcome.mesh, &mut bytes)
            .map_err(|e| Error::Internal(e.to_string()))?;
    }
    collector.bytes("torus/view-bounded/correspondence", &bytes);
    Ok(())
}

/// The picture of the README: a model, and what images and geometry leave of it.
fn readme_picture(collector: &mut Collector) -> Result<()> {
    let mesh = canonical(&generate::interlocking_tori(32, 32)).mesh;
    let target = Target::Triangles(260);
    let driving = ImageOptions {
        size: 72.into(),
        ..ImageOptions::default()
    };
    let by_images = simplify(&mesh, &Options::new(driving, target))?.mesh;
    let by_geometry = simplify(&mesh, &Options::memoryless(target))?.mesh;
    let meshes = [mesh, by_images, by_geometry];
    let name = "tori-side-by-side/luma";
    side_by_side(collector, name, &meshes, &[Cull::None], 200)
}
