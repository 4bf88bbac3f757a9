//! Cases of billboards: planes, what is on them, and a texture, for viewers before a city and in a forest.

use glam::DVec3;

use super::{Collector, fixtures::bits};
use crate::{
    Error, Result, Silent,
    bound::{planar::Aperture, view_cell::ViewCell},
    encode::png::Picture,
    mesh::{Mesh, generate},
    simplify::billboards::{BillboardOptions, Limit, billboards},
};

pub(super) fn clouds(collector: &mut Collector) -> Result<()> {
    let city = part(&generate::city(), 600)?;
    let before = ViewCell::half_space(DVec3::new(0.0, -6.0, 0.0), DVec3::Y)?;
    let forest = generate::trees(200, 80.0);
    let inside = ViewCell::segment([-10.0, 10.0].map(|x| DVec3::new(x, 0.0, 0.0)))?;
    for (name, mesh, cell) in [("city", city, before), ("forest", forest, inside)] {
        let options = BillboardOptions {
            directions: 30,
            texels: 96,
            ..BillboardOptions::within(Limit::Angle(Aperture::degrees(0.4)?))
        };
        let cloud = billboards(&mesh, &cell, &options, &Silent)?;
        let mut bytes = Vec::new();
        for quad in &cloud.quads {
            let vectors = [&[quad.corner, quad.along][..], &quad.axes].concat();
            let numbers = vectors.iter().flat_map(|v| v.to_array()).chain(quad.size);
            bytes.extend(numbers.flat_map(|x| x.to_bits().to_le_bytes()));
            let counts = quad.texels.iter().chain(&quad.replaces).chain(&quad.drawn);
            bytes.extend(counts.flat_map(|n| n.to_le_bytes()));
        }
        collector.bytes(&format!("{name}/quads"), &bytes);
        let error = [cloud.displacement.horizontal, cloud.displacement.vertical];
        let counts = format!("{} {} {}", cloud.quads.len(), cloud.kept.len(), bits(error));
        collector.text(&format!("{name}/counts-displacements"), counts);
        let busiest = cloud.quads.iter().max_by_key(|quad| quad.replaces.len());
        if let Some(quad) = busiest {
            let texture = quad.texture(&mesh);
            let tones = texture.map(|[r, g, b, _]| [r, g, b]);
            collector.plane(&format!("{name}/opacity"), &texture.map(|[.., a]| a));
            collector.plane(&format!("{name}/texture"), &tones);
            collector.shown(Picture::Rgb(tones));
        }
    }
    Ok(())
}

/// The first triangles of a mesh.
fn part(mesh: &Mesh, triangles: usize) -> Result<Mesh> {
    let kept = mesh.triangles().iter().take(triangles).copied().collect();
    Mesh::from_triangles(mesh.positions().to_vec(), kept).map_err(Error::internal)
}
