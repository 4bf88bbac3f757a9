//! Cases of what is hidden: simplification guided by visibility, and interiors that some views look into.

use super::{Collector, files::sphere_of, results::outcome_items};
use crate::{
    Error, Result, Silent,
    encode::{
        png::Picture,
        sheet::{Style, Tile, sheet},
    },
    mesh::{canonical, generate},
    raster::{Scene, luma_sums, mean_luma},
    simplify::{
        Amount, MethodOptions, Options, Replay,
        image::{ImageOptions, Preset, Size, Start},
        quadric::QuadricOptions,
        simplify,
        visibility::VisibilityOptions,
    },
    view::{Cull, ViewSet, frame_of},
    visibility,
};

/// Few cameras and small pictures: fast, and everything the method does is in it.
fn guided(quadric: QuadricOptions, triangles: u64) -> Options {
    let mut options = Options::visibility(Amount::Triangles(triangles));
    options.method = MethodOptions::Visibility(VisibilityOptions {
        quadric,
        measure: visibility::MeasureOptions {
            octahedron: 1,
            size: 64,
            ..visibility::MeasureOptions::default()
        },
        ..VisibilityOptions::default()
    });
    options
}

/// The guided method on closed, open and hidden meshes, and levels of its history.
pub(super) fn hidden(collector: &mut Collector) -> Result<()> {
    for (name, mesh, triangles) in [
        ("encased", generate::encased(1), 200),
        ("shells", generate::shells(2, 2), 330),
        (
            "terrain",
            generate::grid(12, 12, generate::Height::Polynomial),
            100,
        ),
        ("textured-torus", generate::textured_torus(24, 12), 150),
        ("probe", generate::probe(), 150),
    ] {
        let options = guided(QuadricOptions::default(), triangles);
        let outcome = simplify(&mesh, &options, &Silent)?;
        outcome_items(collector, &format!("{name}/visibility"), &outcome);
        let v = outcome.v_mesh.unwrap_or(f64::NAN).to_bits();
        collector.text(&format!("{name}/v-mesh-bits"), format!("{v:016x}"));
        let mut replay = Replay::new(&mesh, &outcome.history)?;
        replay.seek(mesh.triangles().len() * 2 / 3)?;
        let level = replay.live().to_mesh()?;
        collector.mesh(&format!("{name}/replay"), &level);
    }
    let options = guided(QuadricOptions::probabilistic(), 200);
    let outcome = simplify(&generate::encased(1), &options, &Silent)?;
    outcome_items(collector, "encased/visibility-probabilistic", &outcome);
    interiors(collector)
}

/// Plate 3 of Lindstrom & Turk 2000: an encased object, and what is left of it when none, half and all of the 20 views
/// look into the casing. Above from outside, below through the fronts.
fn interiors(collector: &mut Collector) -> Result<()> {
    let mesh = canonical(&generate::encased(2)).mesh;
    let mut meshes = vec![mesh.clone()];
    for interior_views in [0, 10, 20] {
        let own = ImageOptions {
            size: Size::Pixels(48),
            start: Start::Triangles(1_100),
            interior_views,
            ..Preset::Paper.options()
        };
        let options = Options {
            method: MethodOptions::Image(own),
            ..Options::image(Amount::Triangles(640))
        };
        let outcome = simplify(&mesh, &options, &Silent)?;
        let name = format!("interior-views/{interior_views:02}");
        outcome_items(collector, &name, &outcome);
        meshes.push(outcome.mesh);
    }
    let frame = frame_of(&mesh);
    let sphere = sphere_of(&mesh.enter_frame(frame))?;
    let views = ViewSet {
        width: 150,
        height: 150,
        ..ViewSet::evaluation(&sphere)?
    };
    let view = views
        .views
        .get(17)
        .copied()
        .ok_or_else(|| Error::Internal("24 views".into()))?;
    let scenes: Vec<Scene> = meshes
        .iter()
        .map(|m| Scene::of(&m.enter_frame(frame)))
        .collect();
    let mut pictures = Vec::new();
    for cull in [Cull::None, Cull::Front] {
        let view = crate::view::View { cull, ..view };
        let drawn = scenes.iter().map(|s| luma_sums(s, &view, &views));
        pictures.extend(drawn.map(|sums| mean_luma(&sums, views.samples)));
    }
    let tiles: Vec<_> = pictures
        .iter()
        .map(|picture| Tile { picture, label: "" })
        .collect();
    let style = Style {
        padding: 0,
        paper: 128,
        ..Style::default()
    };
    let picture = sheet(&tiles, 4, style)?;
    collector.plane("interior-views/luma", &picture);
    collector.shown(Picture::Grey(picture));
    Ok(())
}
