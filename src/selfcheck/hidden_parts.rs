//! Cases of what is hidden: simplification guided by visibility, and interiors that some views look into.

use super::{
    Collector,
    fixtures::{bits, outcome_items, side_by_side, terrain},
};
use crate::{
    Result,
    mesh::{canonical, generate},
    simplify::{
        Options, Replay, Schedule, Target,
        image::{ImageOptions, Preset, Size, Start},
        quadric::QuadricOptions,
        simplify,
        visibility::VisibilityOptions,
    },
    view::Cull,
    visibility,
};

/// Few cameras and small pictures: fast, and everything the method does is in it.
fn guided(quadric: QuadricOptions, triangles: u64) -> Options {
    let own = VisibilityOptions {
        quadric,
        measure: visibility::MeasureOptions {
            octahedron: 1,
            size: 64,
            ..visibility::MeasureOptions::default()
        },
        ..VisibilityOptions::default()
    };
    Options::new(own, Target::triangles(triangles))
}

/// The guided method on closed, open and hidden meshes, and levels of its history.
pub(super) fn hidden(collector: &mut Collector) -> Result<()> {
    for (name, mesh, triangles) in [
        ("encased", generate::encased(1), 200),
        ("shells", generate::shells(2, 2), 330),
        ("terrain", terrain(), 100),
        ("textured-torus", generate::textured_torus(24, 12), 150),
        ("probe", generate::probe(), 150),
    ] {
        let options = guided(QuadricOptions::default(), triangles);
        let outcome = simplify(&mesh, &options)?;
        outcome_items(collector, &format!("{name}/visibility"), &outcome);
        let v = outcome.v_mesh().unwrap_or(f64::NAN);
        collector.text(&format!("{name}/v-mesh-bits"), bits([v]));
        let mut replay = Replay::new(&mesh, &outcome.history)?;
        replay.seek(mesh.triangles().len() * 2 / 3)?;
        let level = replay.live().to_mesh()?;
        collector.mesh(&format!("{name}/replay"), &level);
    }
    let options = guided(QuadricOptions::probabilistic(), 200);
    let outcome = simplify(&generate::encased(1), &options)?;
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
        // Recorded with another schedule than the preset's.
        let options = Options::new(own, Target::triangles(640)).schedule(Schedule::Semi);
        let outcome = simplify(&mesh, &options)?;
        let name = format!("interior-views/{interior_views:02}");
        outcome_items(collector, &name, &outcome);
        meshes.push(outcome.mesh);
    }
    let culls = [Cull::None, Cull::Front];
    side_by_side(collector, "interior-views/luma", &meshes, &culls, 150)
}
