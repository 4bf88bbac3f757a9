//! The validity region of a point as a shape: a profile in a plane (Eisemann & Décoret 2007, Figure 7) and a surface in
//! space (Figure 2).
//!
//! The paper's figures intersect sampled cones; here every point of the boundary is an exact extent. Where a region has
//! no end in a direction it is cut off at a given reach.

use glam::DVec3;

use super::{
    planar::Aperture,
    point::extent,
    view_cell::{Shape, ViewCell},
};
use crate::{
    Error, Result,
    mesh::{Mesh, generate},
    num::math::{cos, sin, unit},
    parallel,
};

/// Most points of the outline of a profile.
pub const PROFILE_LIMIT: u32 = 100_000;

/// Finest sphere of directions: 20 * 4^7 triangles.
pub const SHELL_LIMIT: u32 = 7;

/// Length at which an unbounded direction is drawn where none is bounded, in distances of the point from the cell.
const UNBOUNDED: f64 = 2.0;

/// Part of a validity region in a plane.
#[derive(Clone, Debug, PartialEq)]
pub struct Profile {
    /// The outline around the point, counter-clockwise seen from where the normal points.
    pub outline: Vec<DVec3>,
    /// Two unit vectors that span the plane.
    pub axes: [DVec3; 2],
    /// Where it was cut off, as a distance from the point.
    pub reach: f64,
}

/// The part of the validity region of `point` in the plane through it across `normal`, by `count` directions.
///
/// `reach`: where unbounded directions are cut off; `None` for twice the largest bounded extent.
///
/// # Errors
/// [`Error::Usage`] for a normal without length, fewer than 3 or more than [`PROFILE_LIMIT`] directions, or a reach that
/// is not above 0.
pub fn profile(
    cell: &ViewCell,
    point: DVec3,
    normal: DVec3,
    aperture: Aperture,
    count: u32,
    reach: Option<f64>,
) -> Result<Profile> {
    let normal = unit(normal)
        .ok_or_else(|| Error::Usage("the plane of the profile has no normal".into()))?;
    if !(3..=PROFILE_LIMIT).contains(&count) {
        return Err(Error::Usage(format!(
            "a profile by {count} directions; expected 3 to {PROFILE_LIMIT}"
        )));
    }
    let x = normal.any_orthonormal_vector();
    let axes = [x, normal.cross(x)];
    let turn = std::f64::consts::TAU / f64::from(count);
    let directions: Vec<DVec3> = (0..count)
        .map(|i| {
            let angle = turn * f64::from(i);
            axes[0] * cos(angle) + axes[1] * sin(angle)
        })
        .collect();
    let (lengths, reach) = lengths(cell, point, &directions, aperture, reach)?;
    let ends = directions.iter().zip(&lengths);
    Ok(Profile {
        outline: ends.map(|(&d, &t)| point + d * t).collect(),
        axes,
        reach,
    })
}

/// The boundary of the validity region of `point`, over the directions of an icosphere with `subdivisions`; `reach` as
/// for [`profile`].
///
/// # Errors
/// [`Error::Usage`] for more than [`SHELL_LIMIT`] subdivisions, a reach that is not above 0, or a point that may move in
/// none of the directions: its region is the point itself, which has no surface.
pub fn shell(
    cell: &ViewCell,
    point: DVec3,
    aperture: Aperture,
    subdivisions: u32,
    reach: Option<f64>,
) -> Result<Mesh> {
    if subdivisions > SHELL_LIMIT {
        return Err(Error::Usage(format!(
            "{subdivisions} subdivisions of the directions; expected at most {SHELL_LIMIT}"
        )));
    }
    let mut parts = generate::icosphere(subdivisions).into_parts();
    let (lengths, _) = lengths(cell, point, &parts.positions, aperture, reach)?;
    if lengths.iter().all(|&t| t <= 0.0) {
        return Err(Error::Usage(format!(
            "the validity region of {point} is the point itself, which has no surface: {}; give a point outside the \
             cell and an angle above 0, or ask for a figure",
            if cell.contains(point) {
                "viewers may stand on it"
            } else {
                "without an angle it may not move"
            }
        )));
    }
    for (position, t) in parts.positions.iter_mut().zip(lengths) {
        *position = parts.precision.round_vector(point + *position * t);
    }
    Mesh::new(parts).map_err(Error::internal)
}

/// The plane that shows most of a cell beside a point: that of both for a segment or line, else one that holds the way
/// from the point to the cell.
pub fn profile_normal(cell: &ViewCell, point: DVec3) -> DVec3 {
    let (toward, along) = match cell.shape() {
        Shape::Point(at) => (*at - point, DVec3::ZERO),
        Shape::Segment([a, b]) => (*a - point, *b - *a),
        Shape::Line {
            point: at,
            direction,
        } => (*at - point, *direction),
        Shape::Plane { normal, .. }
        | Shape::HalfSpace { normal, .. }
        | Shape::Polygon { normal, .. } => (*normal, normal.any_orthonormal_vector()),
        Shape::Polyhedron { corners, .. } => {
            let middle = corners.iter().fold(DVec3::ZERO, |sum, &c| sum + c);
            (middle / corners.len() as f64 - point, DVec3::Z)
        }
    };
    unit(toward.cross(along))
        .or_else(|| unit(toward).map(|t| t.any_orthonormal_vector()))
        .unwrap_or(DVec3::Z)
}

/// The extents in all directions, cut off at the reach.
fn lengths(
    cell: &ViewCell,
    point: DVec3,
    directions: &[DVec3],
    aperture: Aperture,
    reach: Option<f64>,
) -> Result<(Vec<f64>, f64)> {
    if let Some(reach) = reach.filter(|r| !(*r > 0.0 && r.is_finite())) {
        return Err(Error::Usage(format!(
            "the reach is {reach}; expected a length above 0"
        )));
    }
    let extents: Vec<f64> =
        parallel::map_slice(directions, |&d| extent(cell, point, d, aperture).length);
    let largest = extents.iter().copied().filter(|t| t.is_finite());
    let largest = largest.fold(0.0, f64::max);
    let reach = reach.unwrap_or(if largest > 0.0 {
        2.0 * largest
    } else {
        let away = cell.distance_to_point(point);
        UNBOUNDED * if away > 0.0 { away } else { 1.0 }
    });
    let cut = extents.iter().map(|&t| t.min(reach)).collect();
    Ok((cut, reach))
}
