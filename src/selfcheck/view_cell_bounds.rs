//! Cases of guarantees for a view cell: distances, extents and errors of points, bounds of surfaces, validity regions.

use glam::DVec3;

use super::{Collector, fixtures::bits};
use crate::{
    Error, Result, Silent,
    bound::{
        heuristics,
        nearest_triangle::{NearestTriangle, originals},
        planar::Aperture,
        point::{error, extent},
        region,
        surface::{Effort, Measure, measure},
        switch_distance::switch_distance,
        view_cell::{ViewCell, file},
    },
    mesh::generate,
    simplify::{Options, Target, simplify},
};

fn at(x: f64, y: f64, z: f64) -> DVec3 {
    DVec3::new(x, y, z)
}

fn cells() -> Result<[(&'static str, ViewCell); 7]> {
    let (a, b, c) = (at(-0.5, 3.0, 0.25), at(1.5, 2.5, -0.5), at(0.25, 4.0, 1.0));
    let corners = [a, b, c, at(0.0, 3.5, -2.0), at(0.25, 3.25, 0.0)];
    Ok([
        ("point", ViewCell::point(a)?),
        ("segment", ViewCell::segment([a, b])?),
        ("line", ViewCell::line(a, b - a)?),
        ("polygon", ViewCell::polygon(&[a, b, c])?),
        ("plane", ViewCell::plane(a, at(0.1, 1.0, 0.2))?),
        ("polyhedron", ViewCell::polyhedron(&corners)?),
        ("half-space", ViewCell::half_space(a, at(0.1, -1.0, 0.2))?),
    ])
}

/// Everything that is claimed about a view cell.
pub(super) fn bounds(collector: &mut Collector) -> Result<()> {
    let aperture = Aperture::radians(0.05)?;
    for (name, cell) in cells()? {
        collector.bytes(&format!("{name}/file"), file::to_json(&cell)?.as_bytes());
        let (mut extents, mut errors, mut distances) = (Vec::new(), Vec::new(), Vec::new());
        for d in generate::icosphere(1).positions() {
            let point = at(0.5, 0.25, -0.125) * d.x;
            extents.push(extent(&cell, point, *d, aperture).length);
            errors.push(error(&cell, point, point + *d * 0.01).radians);
            distances.push(cell.distance_to_triangle([point, *d, DVec3::ZERO]));
        }
        for (what, numbers) in [
            ("extents", extents),
            ("errors", errors),
            ("distances", distances),
        ] {
            collector.bytes(&format!("{name}/{what}"), bits(numbers).as_bytes());
        }
    }
    let (fine, amount) = (generate::torus(1.0, 0.4, 24, 16), Target::Triangles(200));
    let coarse = simplify(&fine, &Options::memoryless(amount))?.mesh;
    let nearest = NearestTriangle::new(&coarse)
        .ok_or_else(|| Error::Internal("a torus has triangles".into()))?;
    for (name, cell) in cells()? {
        let (what, effort) = (Measure::Angle(&cell), Effort::default());
        let found = measure(originals(&fine), &nearest, what, effort, &Silent)?;
        let worst = found.worst.map_or(0.0, |w| w.value);
        let claims = heuristics::claims(&fine, &coarse, &nearest, &cell);
        let numbers = bits([found.bound, worst, claims.vertices, claims.edges]);
        let text = format!("{numbers} {}", found.pieces);
        collector.text(&format!("{name}/surface-bits"), text);
        let shell = region::shell(&cell, at(0.1, 0.2, 0.3), aperture, 2, Some(2.0))?;
        collector.mesh(&format!("{name}/region"), &shell);
    }
    let (what, effort) = (Measure::Distance, Effort::default());
    let found = measure(originals(&fine), &nearest, what, effort, &Silent)?;
    let switch = switch_distance(found.bound, aperture);
    collector.text("distance-switch-bits", bits([found.bound, switch]));
    Ok(())
}
