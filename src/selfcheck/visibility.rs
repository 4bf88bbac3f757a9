//! Cases of visibility: V(t) of closed, open and nested shapes by every rule, parts that add up, and what is seen of
//! them in colours.

use super::{
    Collector,
    fixtures::{bits, sphere_of, terrain},
};
use crate::{
    Result, Silent,
    encode::png::Picture,
    mesh::{Mesh, generate},
    num::Each,
    raster::{self, Scene},
    view::{Projection, ViewSet, frame_of, sets::octahedron},
    visibility::{
        self, MeasureOptions, PartialVisibility, Visibility, color, measure, remove_hidden,
    },
};

pub(super) fn measured(collector: &mut Collector) -> Result<()> {
    let small = MeasureOptions {
        octahedron: 1,
        size: 72,
        ..MeasureOptions::default()
    };
    let (mut paper, mut fractional, mut two_sided) = (MeasureOptions::paper(), small, small);
    (paper.octahedron, paper.size) = (small.octahedron, small.size);
    fractional.fractional = true;
    (two_sided.two_sided, two_sided.edge_limit) = (true, None);
    let rules = [
        ("default", small),
        ("paper", paper),
        ("fractional", fractional),
        ("two-sided", two_sided),
    ];
    for (name, mesh) in [
        ("tori", generate::interlocking_tori(24, 12)),
        ("shells", generate::shells(3, 2)),
        ("terrain", terrain()),
        ("probe", generate::probe()),
        // Most triangles are smaller than a pixel.
        ("fine-torus", generate::torus(1.0, 0.4, 160, 80)),
    ] {
        for (rule, options) in &rules {
            let found = measure(&mesh, options, &Silent)?;
            numbers(collector, &format!("{name}/{rule}"), &found);
        }
        let found = measure(&mesh, &small, &Silent)?;
        let kept = remove_hidden(&mesh, &found, 1)?;
        collector.mesh(&format!("{name}/kept"), &kept);
        let bytes = visibility::ply::encode(&mesh, &found)?;
        collector.bytes(&format!("{name}/colored"), &bytes);
    }
    let mesh = generate::interlocking_tori(24, 12);
    let (survey, table) = PartialVisibility::with_table(&mesh, &small, &Silent)?;
    collector.plane("tori/table", table.packed());
    numbers(collector, "tori/survey", &survey.finish(&mesh)?);
    let (few, tiny) = (
        generate::interlocking_tori(8, 5),
        MeasureOptions { size: 16, ..small },
    );
    let steps = visibility::convergence(&few, &tiny, &Silent)?;
    let errors = steps.iter().flat_map(|s| [s.error, s.mesh]);
    collector.text("convergence", bits(errors));
    pictured(collector, &mesh, &survey.finish(&mesh)?)
}

fn numbers(collector: &mut Collector, name: &str, found: &Visibility) {
    let shares = found
        .triangles()
        .iter()
        .flat_map(|v| v.to_bits().to_le_bytes());
    let views = found.views().iter().flat_map(|n| n.to_le_bytes());
    let bytes: Vec<u8> = shares.chain(views).collect();
    collector.bytes(&format!("{name}/triangles"), &bytes);
    let shares = bits([found.mesh(), found.never_seen_area()]);
    let text = format!("{shares} {}", found.never_seen());
    collector.text(&format!("{name}/mesh"), text);
}

/// The mesh in the colours of its visibility.
fn pictured(collector: &mut Collector, mesh: &Mesh, found: &Visibility) -> Result<()> {
    let directions = &octahedron(2)[20..21];
    let sphere = sphere_of(mesh)?;
    let set = ViewSet::around(&sphere, directions, 96, 96, Projection::Perspective)?;
    let frame = frame_of(mesh);
    let set = set.enter_frame(frame);
    let colors = found.triangles().iter().map(|&v| {
        let level = |x: u8| f64::from(x) / 255.0;
        [color(v).each(level); 3]
    });
    let scene = Scene::of(&mesh.enter_frame(frame)).with_colors(colors.collect());
    for view in &set.views {
        let tones = raster::rgb(&scene, view, &set).tones;
        collector.plane("tori/picture", &tones);
        collector.shown(Picture::Rgb(tones));
    }
    Ok(())
}
