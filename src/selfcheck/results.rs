//! Cases of meshes and numbers: generators, methods, replay, comparisons.

use glam::DVec3;

use super::{Collector, files::sphere_of, pictures::colored};
use crate::{
    Error, Result, Silent,
    bound::{tolerance::Source, view_cell::ViewCell},
    encode::{
        png::Picture,
        sheet::{Style, Tile, sheet},
    },
    mesh::{Materials, Mesh, MeshParts, canonical, generate},
    metric::{
        luma::ViewErrors,
        silhouette::silhouette_histogram,
        surface::{OneSided, surface_distance},
    },
    raster::{Grid, Scene, luma_sums, mean_luma},
    simplify::{
        Amount, MethodOptions, Options, Outcome, Replay,
        image::{DrivingShading, ImageOptions, Polish, Preset, Start},
        quadric::QuadricOptions,
        simplify,
        tolerance::{Distance, ToleranceOptions},
        view_bounded::ViewBoundedOptions,
    },
    view::{self, Interpolation, Projection, Shading, Specular, ViewSet, ViewsName, frame_of},
};

/// The content of every generated mesh.
pub(super) fn generators(collector: &mut Collector) -> Result<()> {
    for &name in generate::NAMES {
        if let Some(mesh) = generate::by_name(name) {
            collector.mesh(name, &mesh);
        }
    }
    Ok(())
}

/// Every method on closed, open, seamed and coloured meshes.
pub(super) fn simplified(collector: &mut Collector) -> Result<()> {
    let geometric = [
        ("cube", generate::cube(), 8),
        ("torus", generate::torus(1.0, 0.4, 24, 12), 120),
        ("textured-torus", generate::textured_torus(24, 12), 150),
        (
            "colored-torus",
            colored(&generate::torus(1.0, 0.4, 16, 8)),
            80,
        ),
        ("terrain", terrain(), 100),
        ("two-materials", two_materials(), 100),
        ("shells", generate::shells(2, 2), 120),
        ("probe", generate::probe(), 150),
    ];
    for (name, mesh, triangles) in &geometric {
        let target = Amount::Triangles(*triangles);
        let mut probabilistic = Options::quadric(target);
        probabilistic.method = MethodOptions::Quadric(QuadricOptions::probabilistic());
        for (method, options) in [
            ("memoryless", Options::memoryless(target)),
            ("quadric", Options::quadric(target)),
            ("quadric-probabilistic", probabilistic),
        ] {
            let outcome = simplify(mesh, &options, &Silent)?;
            outcome_items(collector, &format!("{name}/{method}"), &outcome);
        }
    }
    let small = ImageOptions {
        views: ViewsName::Octahedron(0),
        size: 64.into(),
        samples: 1,
        start: Start::Input,
        polish: Polish::default(),
        // What pictures do is recorded, whatever geometry would do.
        fall_back: false,
        ..ImageOptions::default()
    };
    let gouraud = ImageOptions {
        shading: DrivingShading::Gouraud,
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
    // Every driving view of the published method, after memoryless pre-simplification.
    let published = ImageOptions {
        size: 64.into(),
        start: Start::Triangles(180),
        ..Preset::Paper.options()
    };
    // What the default preset does, in small: turned cameras too.
    let recipe = ImageOptions {
        views: ViewsName::Spiral(9),
        size: 40.into(),
        polish: Polish {
            sweeps: 4,
            flips_every: 1,
            cameras_every: 2,
            deviation_weight: 0.3,
        },
        fall_back: false,
        ..Preset::Default.options()
    };
    let mixed = ImageOptions {
        shading: DrivingShading::Mixed,
        ..recipe.clone()
    };
    let torus = || generate::torus(1.0, 0.4, 16, 8);
    for (name, mesh, triangles, own) in [
        ("torus/image-flat", torus(), 90, &small),
        ("torus/image-gouraud", torus(), 90, &gouraud),
        ("cube/image-flat", generate::cube(), 8, &small),
        (
            "textured-torus/image-flat",
            generate::textured_torus(16, 8),
            120,
            &small,
        ),
        ("terrain/image-gouraud", terrain(), 120, &gouraud),
        ("two-materials/image-flat", two_materials(), 150, &small),
        (
            "shells/image-interior",
            generate::shells(2, 2),
            400,
            &interior,
        ),
        ("probe/image-flat", generate::probe(), 300, &small),
        (
            "icosphere/image-published",
            generate::icosphere(3),
            120,
            &published,
        ),
        ("torus/image-polished", torus(), 90, &recipe),
        (
            "textured-torus/image-polished",
            generate::textured_torus(16, 8),
            120,
            &recipe,
        ),
        ("terrain/image-polished-mixed", terrain(), 120, &mixed),
    ] {
        let outcome = simplify(&mesh, &image(own, Amount::Triangles(triangles)), &Silent)?;
        outcome_items(collector, name, &outcome);
    }
    let mut limited = image(&small, Amount::ErrorOnly);
    limited.error_rms = Some(4.0);
    let outcome = simplify(&torus(), &limited, &Silent)?;
    outcome_items(collector, "torus/image-error-rms", &outcome);
    within_distance(collector)?;
    bounded(collector)?;
    side_by_side(collector)
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
    for (name, mesh, own) in [
        ("torus/tolerance", &torus, within),
        ("torus/tolerance-one-sided", &few, one_sided),
        ("torus/tolerance-growing", &few, growing),
        ("terrain/tolerance", &terrain(), within),
        (
            "textured-torus/tolerance",
            &generate::textured_torus(24, 12),
            within,
        ),
    ] {
        let options = Options::tolerance(own, Amount::ErrorOnly);
        let outcome = simplify(mesh, &options, &Silent)?;
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
    let options = Options::view_bounded(own, Amount::ErrorOnly);
    let outcome = simplify(&mesh, &options, &Silent)?;
    outcome_items(collector, "torus/view-bounded", &outcome);
    let mut bytes = Vec::new();
    if let Some(map) = &outcome.correspondence {
        map.write(&mesh, &outcome.mesh, &mut bytes)
            .map_err(|e| Error::Internal(e.to_string()))?;
    }
    collector.bytes("torus/view-bounded/correspondence", &bytes);
    Ok(())
}

/// The picture of the README: a model, and what images and geometry leave of it.
fn side_by_side(collector: &mut Collector) -> Result<()> {
    let mesh = canonical(&generate::interlocking_tori(32, 32)).mesh;
    let target = Amount::Triangles(260);
    let driving = ImageOptions {
        size: 72.into(),
        ..ImageOptions::default()
    };
    let by_images = simplify(&mesh, &image(&driving, target), &Silent)?.mesh;
    let by_geometry = simplify(&mesh, &Options::memoryless(target), &Silent)?.mesh;
    let frame = frame_of(&mesh);
    let sphere = sphere_of(&mesh.enter_frame(frame))?;
    let views = ViewSet {
        width: 200,
        height: 200,
        ..ViewSet::evaluation(&sphere)?
    };
    let view = views
        .views
        .get(17)
        .copied()
        .ok_or_else(|| Error::Internal("24 views".into()))?;
    let drawn = [mesh, by_images, by_geometry].map(|m| {
        let scene = Scene::of(&m.enter_frame(frame));
        mean_luma(&luma_sums(&scene, &view, &views), views.samples)
    });
    let tiles = drawn.each_ref().map(|picture| Tile { picture, label: "" });
    let style = Style {
        padding: 0,
        paper: 128,
        ..Style::default()
    };
    let picture = sheet(&tiles, 3, style)?;
    collector.plane("tori-side-by-side/luma", &picture);
    collector.shown(Picture::Grey(picture));
    Ok(())
}

/// Levels between the input and the end of a run, reached from both sides.
pub(super) fn replayed(collector: &mut Collector) -> Result<()> {
    let own = ImageOptions {
        views: ViewsName::Octahedron(0),
        size: 48.into(),
        start: Start::Triangles(200),
        ..ImageOptions::default()
    };
    let textured = generate::textured_torus(16, 8);
    for (name, mesh, options) in [
        (
            "terrain/image",
            terrain(),
            image(&own, Amount::Triangles(150)),
        ),
        (
            "textured-torus/memoryless",
            textured,
            Options::memoryless(Amount::Triangles(60)),
        ),
    ] {
        let outcome = simplify(&mesh, &options, &Silent)?;
        let mut replay = Replay::new(&mesh, &outcome.history)?;
        for (step, triangles) in [
            ("coarser", 180),
            ("end", 1),
            ("finer", 220),
            ("input", usize::MAX),
        ] {
            replay.seek(triangles)?;
            let level = replay.live().to_mesh()?;
            collector.mesh(&format!("{name}/{step}"), &level);
        }
    }
    Ok(())
}

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
    let scenes = [&reference, &candidate].map(|m| Scene::of(&m.enter_frame(frame)));
    for (shading, set) in [("flat", &flat), ("gouraud", &gouraud)] {
        let set = set.enter_frame(frame);
        let [expected, actual] = scenes.each_ref().map(|scene| {
            let views = set.views.iter();
            views
                .map(|v| luma_sums(scene, v, &set))
                .collect::<Vec<Grid<u16>>>()
        });
        let errors = ViewErrors::between(&expected, &actual, set.samples * set.samples)?;
        let sums = errors.views().iter().map(|e| e.sum.to_string());
        let sums = sums.collect::<Vec<_>>().join(" ");
        collector.text(&format!("luma/{shading}/views"), sums);
        let total = errors.total();
        collector.text(
            &format!("luma/{shading}/total"),
            format!("{} {} {}", total.sum, total.pixels, total.samples),
        );
        let psnr = total.psnr().unwrap_or(f64::INFINITY);
        collector.text(
            &format!("luma/{shading}/rms-psnr-bits"),
            bits(&[total.rms(), psnr]),
        );
    }
    let distance = surface_distance(&reference, &candidate, 2_000, &Silent)?;
    let one_sided = |d: &OneSided| {
        let a = d.absolute;
        format!("{} {}", d.samples, bits(&[a.mean, a.rms, a.max]))
    };
    collector.text(
        "distance/to-candidate-bits",
        one_sided(&distance.to_candidate),
    );
    collector.text(
        "distance/to-reference-bits",
        one_sided(&distance.to_reference),
    );
    let eyes: Vec<_> = flat.views.iter().map(|v| v.eye).collect();
    let histogram = silhouette_histogram(&candidate, &eyes, &Silent)?;
    let counts = histogram.counts().iter().map(u64::to_string);
    collector.text("silhouette", counts.collect::<Vec<_>>().join(" "));
    Ok(())
}

/// An open surface with a boundary.
fn terrain() -> Mesh {
    generate::grid(12, 12, generate::Height::Polynomial)
}

/// An open surface with a material for each half: the border between them has to stay.
fn two_materials() -> Mesh {
    let mesh = terrain();
    let half = |t: &[u32; 3]| u32::from(mesh.positions()[t[0] as usize].x >= 0.0);
    Mesh::new(MeshParts {
        positions: mesh.positions().to_vec(),
        triangles: mesh.triangles().to_vec(),
        materials: Materials {
            names: vec!["left".into(), "right".into()],
            of_triangle: mesh.triangles().iter().map(half).collect(),
            libraries: Vec::new(),
        },
        precision: mesh.precision(),
        ..MeshParts::default()
    })
    .expect("the mesh was valid before")
}

fn image(own: &ImageOptions, target: Amount) -> Options {
    Options {
        method: MethodOptions::Image(own.clone()),
        schedule: own.preset.schedule(),
        ..Options::image(target)
    }
}

/// The mesh, how many collapses led to it, and the bits of its error. Not how many evaluations: that is effort.
pub(super) fn outcome_items(collector: &mut Collector, name: &str, outcome: &Outcome) {
    collector.mesh(name, &outcome.mesh);
    let mut text = format!("{}", outcome.mesh.triangles().len());
    for phase in &outcome.phases {
        text += &format!(" {}-{}", phase.method, phase.counters.collapses);
    }
    if let Some(rms) = outcome.error_rms {
        text += &format!(" {}", bits(&[rms]));
    }
    collector.text(&format!("{name}/run"), text);
}

fn bits(numbers: &[f64]) -> String {
    let hex = numbers.iter().map(|x| format!("{:016x}", x.to_bits()));
    hex.collect::<Vec<_>>().join(" ")
}
