//! Cases of the rasterizer: small pictures with everything that can go wrong in them.

use glam::DVec3;

use super::{
    Collector,
    fixtures::{colored, partly_smooth_torus, sphere_of},
};
use crate::{
    Error, Result,
    encode::png::Picture,
    mesh::{Mesh, generate},
    num::{Each, fixed::SubpixelBits},
    raster::{self, Scene},
    view::{
        self, Cull, Interpolation, Light, Projection, Shading, Specular, View, ViewSet, ViewsName,
        frame_of,
    },
};

/// The picture of a case for eyes.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Show {
    Nothing,
    Luma,
    Rgb,
}

/// A scene in some views.
struct Case {
    name: &'static str,
    mesh: Mesh,
    set: ViewSet,
    /// The picture of view 0 that is kept.
    show: Show,
}

const GOURAUD: Shading = Shading {
    interpolation: Interpolation::Gouraud,
    two_sided: true,
    specular: None,
};

const LIT: Shading = Shading {
    interpolation: Interpolation::Lit,
    two_sided: true,
    specular: None,
};

const SPECULAR: Shading = Shading {
    interpolation: Interpolation::Flat,
    two_sided: true,
    specular: Some(Specular {
        strength: 0.6,
        exponent: 12,
    }),
};

/// Ids, depth, coverage, luma and colours of every view of every case.
pub(super) fn pictures(collector: &mut Collector) -> Result<()> {
    let cases = [probe_cases()?, torus_cases()?, placed_cases()?];
    for case in cases.into_iter().flatten() {
        let frame = frame_of(&case.mesh);
        let set = case.set.enter_frame(frame);
        let scene = Scene::of(&case.mesh.enter_frame(frame));
        let only_view = set.views.len() == 1;
        for (i, view) in set.views.iter().enumerate() {
            let name = |buffer: &str| match only_view {
                true => format!("{}/{buffer}", case.name),
                false => format!("{}/{i:02}/{buffer}", case.name),
            };
            let keys = raster::keys(&scene, view, &set);
            collector.plane(&name("ids"), &raster::ids(&keys));
            collector.plane(&name("depth"), &raster::depths(&keys));
            if i == 0 {
                collector.plane(&name("coverage"), &raster::coverage(&keys));
            }
            let luma = raster::luma_sums(&scene, view, &set);
            collector.plane(&name("luma"), &luma);
            if case.show == Show::Luma && i == 0 {
                let mean = raster::mean_luma(&luma, set.samples);
                collector.shown(Picture::Grey(mean));
            }
            if !scene.colors().is_empty() {
                let rgb = raster::rgb(&scene, view, &set).tones;
                let mean = raster::mean_rgb(&rgb, set.samples);
                collector.plane(&name("rgb"), &mean);
                if case.show == Show::Rgb && i == 0 {
                    collector.shown(Picture::Rgb(mean));
                }
            }
        }
    }
    crowd(collector)
}

/// More triangles than one task draws, so that several threads share the picture.
fn crowd(collector: &mut Collector) -> Result<()> {
    let mesh = generate::icosphere(6);
    let set = around(&mesh, 1, 64)?;
    let frame = frame_of(&mesh);
    let set = set.enter_frame(frame);
    let scene = Scene::of(&mesh.enter_frame(frame));
    let picture = raster::luma(&scene, &set.views[0], &set);
    collector.plane("crowd/ids", &raster::ids(&picture));
    collector.plane("crowd/depth", &raster::depths(&picture));
    collector.plane("crowd/luma", &picture.tones);
    Ok(())
}

/// The first `count` views of the dodecahedron.
fn around(mesh: &Mesh, count: usize, size: u32) -> Result<ViewSet> {
    named(mesh, &ViewsName::Dodecahedron, count, size)
}

fn named(mesh: &Mesh, name: &ViewsName, count: usize, size: u32) -> Result<ViewSet> {
    let mut set = view::resolve(name, &sphere_of(mesh)?, [size; 2], Projection::Perspective)?;
    set.views.truncate(count);
    Ok(set)
}

/// A picture of 96 x 72 pixels from any place.
fn from_eye(eye: [f64; 3], target: [f64; 3], depth: [f64; 2]) -> Result<ViewSet> {
    let ends = [eye, target, [0.0, 0.0, 1.0]].each(DVec3::from_array);
    let view = View::perspective(ends, depth, [96, 72])
        .ok_or_else(|| Error::Internal("a golden view is degenerate".into()))?;
    Ok(ViewSet {
        width: 96,
        height: 72,
        samples: 1,
        subpixel: SubpixelBits::Eight,
        background: view::BACKGROUND,
        views: vec![view],
    })
}

fn lit(mut set: ViewSet, light: Light, two_sided: bool) -> ViewSet {
    for view in &mut set.views {
        view.light = light;
        view.shading.two_sided = two_sided;
    }
    set
}

/// A mesh in views that depend on it.
fn case(
    name: &'static str,
    mesh: Mesh,
    show: Show,
    set: &dyn Fn(&Mesh) -> Result<ViewSet>,
) -> Result<Case> {
    let set = set(&mesh)?;
    Ok(Case {
        name,
        mesh,
        set,
        show,
    })
}

/// The first three views along the axes, orthographic.
fn orthographic(mesh: &Mesh) -> Result<ViewSet> {
    let (name, sphere) = (ViewsName::Octahedron(0), sphere_of(mesh)?);
    let mut set = view::resolve(&name, &sphere, [80, 64], Projection::Orthographic)?;
    set.views.truncate(3);
    Ok(set)
}

/// Every kind of difficult triangle, by every kind of view set.
fn probe_cases() -> Result<Vec<Case>> {
    let probe = generate::probe;
    let all = usize::MAX;
    Ok(vec![
        case("probe", probe(), Show::Luma, &|m| around(m, all, 96))?,
        case("probe-16-bits", probe(), Show::Nothing, &|m| {
            Ok(around(m, 3, 96)?.with_subpixel(SubpixelBits::Sixteen))
        })?,
        case("probe-2x2", probe(), Show::Luma, &|m| {
            named(m, &ViewsName::Rhombicuboctahedron, 4, 64)?.with_samples(2)
        })?,
        case("probe-4x4-16-bits", probe(), Show::Nothing, &|m| {
            let set = named(m, &ViewsName::Rhombicuboctahedron, 1, 48)?.with_samples(4)?;
            Ok(set.with_subpixel(SubpixelBits::Sixteen))
        })?,
        case("probe-orthographic", probe(), Show::Luma, &orthographic)?,
        case("probe-cull-back", probe(), Show::Luma, &|m| {
            Ok(around(m, 2, 96)?.with_cull(Cull::Back))
        })?,
        case("probe-gouraud", probe(), Show::Nothing, &|m| {
            Ok(around(m, 3, 96)?.with_shading(GOURAUD))
        })?,
    ])
}

/// Shadings, lights, colours and culling.
fn torus_cases() -> Result<Vec<Case>> {
    let torus = || generate::torus(1.0, 0.4, 32, 16);
    let colors = || colored(&torus());
    let normals = || partly_smooth_torus(24, 12);
    let engine = || generate::engine(1);
    Ok(vec![
        case("torus-gouraud", torus(), Show::Luma, &|m| {
            Ok(around(m, 2, 96)?.with_shading(GOURAUD))
        })?,
        case("torus-specular", torus(), Show::Nothing, &|m| {
            Ok(around(m, 2, 96)?.with_shading(SPECULAR))
        })?,
        case("torus-gouraud-specular", torus(), Show::Luma, &|m| {
            let interpolation = Interpolation::Gouraud;
            Ok(around(m, 2, 96)?.with_shading(Shading {
                interpolation,
                ..SPECULAR
            }))
        })?,
        case("torus-colored", colors(), Show::Rgb, &|m| around(m, 2, 96))?,
        case("torus-colored-gouraud", colors(), Show::Nothing, &|m| {
            around(m, 2, 64)?.with_shading(GOURAUD).with_samples(2)
        })?,
        case("torus-stored-normals", normals(), Show::Luma, &|m| {
            around(m, 2, 96)?.with_shading(LIT).with_samples(2)
        })?,
        case("torus-lit-from-a-point", torus(), Show::Nothing, &|m| {
            let lamp = Light::Point(DVec3::new(2.0, -1.0, 3.0));
            Ok(lit(around(m, 2, 96)?, lamp, false))
        })?,
        case("torus-lit-from-afar", torus(), Show::Nothing, &|m| {
            let sun = Light::Direction(DVec3::new(0.6, 0.0, 0.8));
            Ok(lit(around(m, 2, 96)?.with_shading(GOURAUD), sun, false))
        })?,
        case("engine", engine(), Show::Nothing, &|m| {
            around(m, 2, 96)?.with_interior_views(0)
        })?,
        case("engine-cull-front", engine(), Show::Luma, &|m| {
            Ok(around(m, 2, 96)?.with_cull(Cull::Front))
        })?,
    ])
}

/// Eyes at places where clipping has much to do.
fn placed_cases() -> Result<Vec<Case>> {
    let probe = generate::probe;
    let engine = || generate::engine(1);
    let (cube, waves) = (
        generate::cube(),
        generate::grid(24, 24, generate::Height::Waves),
    );
    Ok(vec![
        // An eye inside the mesh: the near plane cuts triangles on all sides.
        case("engine-from-inside", engine(), Show::Luma, &|_| {
            from_eye([0.55, 0.3, 0.1], [0.0, 0.1, 0.0], [0.02, 3.0])
        })?,
        case("probe-from-inside", probe(), Show::Luma, &|_| {
            from_eye([0.2, 0.1, 0.15], [-0.6, -0.4, 0.2], [0.05, 4.0])
        })?,
        // Vertices far outside the frame, some beyond the guard band, some behind the eye.
        case("slivers-from-close-by", probe(), Show::Luma, &|_| {
            from_eye([0.98, -0.897, 0.41], [-1.2, -0.8, 0.4], [0.001, 4.0])
        })?,
        case("cube-from-its-side", cube, Show::Nothing, &|_| {
            from_eye([1.000_01, 0.3, 0.2], [0.0, 0.9, 0.1], [1e-6, 4.0])
        })?,
        case("waves-along-the-ground", waves, Show::Nothing, &|_| {
            from_eye([-0.9, 0.013, 0.06], [1.0, 0.02, 0.0], [0.01, 4.0])
        })?,
    ])
}
