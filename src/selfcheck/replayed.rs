//! Cases of replay: levels of recorded runs.

use super::{Collector, fixtures::terrain};
use crate::{
    Result,
    mesh::generate,
    simplify::{
        Options, Replay, Target,
        image::{ImageOptions, Start},
        simplify,
    },
    view::ViewsName,
};

/// Levels between the input and the end of a run, reached from both sides.
pub(super) fn replayed(collector: &mut Collector) -> Result<()> {
    let own = ImageOptions {
        views: ViewsName::Octahedron(0),
        size: 48.into(),
        start: Start::Triangles(200),
        ..ImageOptions::default()
    };
    let textured = generate::textured_torus(16, 8);
    let by_images = Options::new(own, Target::Triangles(150));
    let by_geometry = Options::memoryless(Target::Triangles(60));
    for (name, mesh, options) in [
        ("terrain/image", terrain(), by_images),
        ("textured-torus/memoryless", textured, by_geometry),
    ] {
        let outcome = simplify(&mesh, &options)?;
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
