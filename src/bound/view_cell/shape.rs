//! A view cell, and what is refused as one.
//!
//! Bounded cells are the convex hull of their corners, exactly: where four or more corners of a face are not quite in
//! one plane, they are taken as coplanar within [`FLATNESS`] of the cell's size. Lengths are in the units of the mesh.

use glam::DVec3;

use super::hull;
use crate::{
    Error, Result,
    geometry::Box3,
    num::{
        Each, Frame,
        math::{length, unit},
    },
};

/// Most corners of a polygon or polyhedron: its hull is found by trying every triple.
pub const CORNER_LIMIT: usize = 64;

/// Largest distance of the corners of a face from its plane, as a fraction of the largest side of the cell's box.
pub(super) const FLATNESS: f64 = 1e-9;

/// The viewpoints that a guarantee is given for: a convex set.
#[derive(Clone, Debug, PartialEq)]
pub struct ViewCell(Shape);

/// The shape of a [`ViewCell`]. Unit vectors are unit vectors to the last few bits.
#[derive(Clone, Debug, PartialEq)]
pub enum Shape {
    /// One viewpoint.
    Point(DVec3),
    /// From one end to the other; the ends differ.
    Segment([DVec3; 2]),
    /// A whole line.
    Line {
        /// Any of its points.
        point: DVec3,
        /// Unit vector along it.
        direction: DVec3,
    },
    /// A convex polygon with its inside.
    Polygon {
        /// In order, counter-clockwise seen from where the normal points; no three on a line.
        corners: Vec<DVec3>,
        /// Unit vector.
        normal: DVec3,
    },
    /// A whole plane.
    Plane {
        /// Any of its points.
        point: DVec3,
        /// Unit vector; its sign means nothing.
        normal: DVec3,
    },
    /// A convex polyhedron with its inside.
    Polyhedron {
        /// No other point is needed for the hull.
        corners: Vec<DVec3>,
        /// Convex polygons of corner numbers, counter-clockwise from outside; each edge lies on two faces.
        faces: Vec<Vec<u32>>,
        /// Unit vectors out of the cell, one per face.
        normals: Vec<DVec3>,
    },
    /// All viewpoints `v` with `(v - point) . normal <= 0`.
    HalfSpace {
        /// Any point of its boundary.
        point: DVec3,
        /// Unit vector out of the cell.
        normal: DVec3,
    },
}

impl ViewCell {
    /// One viewpoint.
    ///
    /// # Errors
    /// [`Error::Usage`] where a coordinate is not finite.
    pub fn point(at: DVec3) -> Result<Self> {
        finite(&[at], "the point")?;
        Ok(Self(Shape::Point(at)))
    }

    /// The viewpoints between two ends, which belong to it.
    ///
    /// # Errors
    /// [`Error::Usage`] where a coordinate is not finite or the ends are equal.
    pub fn segment(ends: [DVec3; 2]) -> Result<Self> {
        finite(&ends, "the segment")?;
        if ends[0] == ends[1] {
            return Err(Error::Usage(
                "both ends of the segment are the same point; give a point as the cell".into(),
            ));
        }
        Ok(Self(Shape::Segment(ends)))
    }

    /// The line through `point` along `direction`, which may have any length but 0.
    ///
    /// # Errors
    /// [`Error::Usage`] where a coordinate is not finite or the direction has no length.
    pub fn line(point: DVec3, direction: DVec3) -> Result<Self> {
        finite(&[point, direction], "the line")?;
        let direction = direction_of(direction, "the direction of the line")?;
        Ok(Self(Shape::Line { point, direction }))
    }

    /// A convex polygon by its corners in order, in either sense.
    ///
    /// # Errors
    /// [`Error::Usage`] with the corner concerned: fewer than 3 or more than `CORNER_LIMIT` corners, a coordinate that
    /// is not finite, a corner off the plane of the others, no area, or a polygon that is not convex.
    pub fn polygon(corners: &[DVec3]) -> Result<Self> {
        corner_count(corners, 3, "polygon")?;
        hull::polygon(corners).map(Self)
    }

    /// The plane through `point` across `normal`, which may have any length but 0.
    ///
    /// # Errors
    /// [`Error::Usage`] where a coordinate is not finite or the normal has no length.
    pub fn plane(point: DVec3, normal: DVec3) -> Result<Self> {
        finite(&[point, normal], "the plane")?;
        let normal = direction_of(normal, "the normal of the plane")?;
        Ok(Self(Shape::Plane { point, normal }))
    }

    /// The convex hull of points; those inside it or inside a face or an edge are dropped.
    ///
    /// # Errors
    /// [`Error::Usage`]: fewer than 4 or more than `CORNER_LIMIT` points, a coordinate that is not finite, points in
    /// one plane, or points so nearly in one plane that their faces cannot be told apart.
    pub fn polyhedron(points: &[DVec3]) -> Result<Self> {
        corner_count(points, 4, "polyhedron")?;
        hull::polyhedron(points).map(Self)
    }

    /// A box with sides along the axes.
    ///
    /// # Errors
    /// [`Error::Usage`] where a coordinate is not finite or `low` is not below `high` on every axis.
    pub fn cuboid(low: DVec3, high: DVec3) -> Result<Self> {
        finite(&[low, high], "the box")?;
        if !low.cmplt(high).all() {
            return Err(Error::Usage(format!(
                "the box goes from {low} to {high}; expected low below high on every axis: give a polygon, segment or \
                 point as the cell where it has no thickness"
            )));
        }
        let corners: Vec<DVec3> = (0..8).map(|i| Box3 { low, high }.corner(i)).collect();
        Self::polyhedron(&corners)
    }

    /// All viewpoints `v` with `(v - point) . normal <= 0`: the normal, of any length but 0, points out of the cell.
    ///
    /// # Errors
    /// [`Error::Usage`] where a coordinate is not finite or the normal has no length.
    pub fn half_space(point: DVec3, normal: DVec3) -> Result<Self> {
        finite(&[point, normal], "the half-space")?;
        let normal = direction_of(normal, "the normal of the half-space")?;
        Ok(Self(Shape::HalfSpace { point, normal }))
    }

    /// The shape.
    #[must_use]
    pub fn shape(&self) -> &Shape {
        &self.0
    }

    /// The points whose convex hull it is; `None` for a cell without an end.
    #[must_use]
    pub fn corners(&self) -> Option<&[DVec3]> {
        match &self.0 {
            Shape::Point(at) => Some(std::slice::from_ref(at)),
            Shape::Segment(ends) => Some(ends),
            Shape::Polygon { corners, .. } | Shape::Polyhedron { corners, .. } => Some(corners),
            Shape::Line { .. } | Shape::Plane { .. } | Shape::HalfSpace { .. } => None,
        }
    }

    /// The same cell in units of `frame`; exact unless a number over- or underflows.
    #[must_use]
    pub fn enter_frame(&self, frame: Frame) -> Self {
        self.moved(|p| frame.enter(p))
    }

    /// Undoes [`ViewCell::enter_frame`].
    #[must_use]
    pub fn leave_frame(&self, frame: Frame) -> Self {
        self.moved(|p| frame.leave(p))
    }

    /// The same cell as seen from `origin`.
    #[must_use]
    pub fn relative_to(&self, origin: DVec3) -> Self {
        self.moved(|p| p - origin)
    }

    /// Every position through a scaling by a power of two or a shift, which change no direction.
    fn moved(&self, scale: impl Fn(DVec3) -> DVec3) -> Self {
        let mut shape = self.0.clone();
        match &mut shape {
            Shape::Point(point)
            | Shape::Line { point, .. }
            | Shape::Plane { point, .. }
            | Shape::HalfSpace { point, .. } => *point = scale(*point),
            Shape::Segment(ends) => *ends = ends.each(scale),
            Shape::Polygon { corners, .. } | Shape::Polyhedron { corners, .. } => {
                for corner in corners {
                    *corner = scale(*corner);
                }
            }
        }
        Self(shape)
    }
}

fn finite(vectors: &[DVec3], what: &str) -> Result<()> {
    if vectors.iter().all(|v| v.is_finite()) {
        return Ok(());
    }
    let told = format!("{what} has a coordinate that is not finite; expected numbers");
    Err(Error::Usage(told))
}

/// The unit vector along `v`, whatever its length: scaled first, so that squares neither overflow nor vanish. A vector
/// that is a unit vector but for rounding stays as it is: what was written is read back as the same bits.
fn direction_of(v: DVec3, what: &str) -> Result<DVec3> {
    if (length(v) - 1.0).abs() <= 4.0 * f64::EPSILON {
        return Ok(v);
    }
    let frame = Frame::for_size(v.abs().max_element());
    unit(frame.enter(v)).ok_or_else(|| {
        Error::Usage(format!(
            "{what} has length {}; expected a vector that points somewhere",
            length(v)
        ))
    })
}

fn corner_count(corners: &[DVec3], least: usize, what: &str) -> Result<()> {
    let n = corners.len();
    let refused = |told: String| Err(Error::Usage(told));
    if !(least..=CORNER_LIMIT).contains(&n) {
        return refused(format!(
            "a {what} with {n} corners; expected {least} to {CORNER_LIMIT}"
        ));
    }
    if let Some(i) = corners.iter().position(|c| !c.is_finite()) {
        return refused(format!(
            "corner {i} of the {what} is not finite; expected numbers"
        ));
    }
    for (i, a) in corners.iter().enumerate() {
        if let Some(j) = corners[..i].iter().position(|b| a == b) {
            return refused(format!(
                "corners {j} and {i} of the {what} are the same point; leave one out"
            ));
        }
    }
    Ok(())
}
