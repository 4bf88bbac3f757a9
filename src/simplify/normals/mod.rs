//! Stored normals of a simplified mesh: fitted to the normal field of the original.
//!
//! Collapses carry normals from corner to corner. Where the surface has moved since, they no longer fit it: the original
//! is smooth over a bevel, and once the bevel has collapsed, one normal serves two faces. So after the last collapse the
//! original's normal field ([`field`]) is sampled at points spread over the simplified surface ([`moments`]), and the
//! corners around every vertex are grouped anew ([`groups`]): those of faces whose samples want about the same normal
//! there, and that had no hard edge between them, share one, whatever their texture coordinates and materials. The
//! normals of all groups together are the least squares of the distance from the samples ([`fit`]). A group whose faces
//! show the original's very normals keeps its own, bit for bit.
//!
//! Everything here is a function of the two meshes: a replay that rebuilds a level gets the normals of the run that
//! stopped there. Not in the papers.

mod face;
mod field;
mod fit;
mod groups;
mod moments;
mod rows;

use glam::DVec3;
use serde::{Deserialize, Serialize};

pub(super) use self::rows::stored_vertices;
use self::{face::Faces, groups::Groups, moments::Moments};
use super::{
    recorded::recorded,
    tangents::{self, Tangents},
};
use crate::{
    Progress, Result,
    collapse::History,
    mesh::{ChannelKind, Mesh},
    num::Each,
    view::frame_of,
};

/// Cosine of the largest angle by which faces fold that share a recomputed normal: 45 degrees.
const FOLD: f64 = std::f64::consts::FRAC_1_SQRT_2;

/// Cosine of the largest angle between the normals that two faces with a common one would have at its corner, each by
/// itself: 25 degrees. A smaller angle stores more vertices for a closer fit.
const APART: f64 = 0.906_307_787_036_65;

/// Cosine of the largest angle between carried normals on both sides of an edge that was not hard: 10 degrees. Normals of
/// equal corners differ a little in files that round them or split texture seams before computing them.
const SOFT: f64 = 0.984_807_753_012_208;

/// The way in which a simplified mesh gets its stored normals; only for meshes that have some.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "cli", derive(clap::ValueEnum))]
#[serde(rename_all = "kebab-case")]
pub enum Normals {
    /// Fitted to the normals of the input, and split where one cannot serve all faces around a vertex
    #[default]
    Fit,
    /// As the collapses carried them from corner to corner
    Carry,
    /// Area-weighted means of the result's own faces, split where it folds by more than 45 degrees
    Recompute,
    /// None: without normals and tangents
    Drop,
}

impl Normals {
    /// The way of runs before there was a choice.
    pub(super) const fn carried() -> Self {
        Self::Carry
    }

    /// True for [`Normals::Carry`].
    pub(super) fn are_carried(&self) -> bool {
        *self == Self::Carry
    }

    /// The way that makes a difference to this mesh: [`Normals::Carry`] where it has no normals.
    pub(super) fn of(self, mesh: &Mesh) -> Self {
        match mesh.attributes().channel(ChannelKind::Normal) {
            Some(_) => self,
            None => Self::Carry,
        }
    }
}

/// The price of normals: vertices as files with one row of attributes per vertex store them, which are the different
/// pairs of place and attributes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct NormalsReport {
    /// The way that the normals were made.
    pub normals: Normals,
    /// Stored vertices with the normals that the collapses carried.
    pub stored_vertices_carried: usize,
    /// Stored vertices of the result.
    pub stored_vertices: usize,
}

/// Gives a simplified mesh its normals; the account of their price where they are not the carried ones. Tangents follow:
/// they are turned into the plane across the new normal and keep their sign. The order of vertices and triangles stays;
/// materials must be numbered alike in both meshes. O(n log n).
///
/// # Errors
/// [`Error::Interrupted`](crate::Error::Interrupted).
pub fn settle(
    original: &Mesh,
    simplified: Mesh,
    normals: Normals,
    progress: &dyn Progress,
) -> Result<(Mesh, Option<NormalsReport>)> {
    if normals.of(&simplified) == Normals::Carry {
        return Ok((simplified, None));
    }
    let carried = stored_vertices(&simplified);
    let mesh = match normals {
        Normals::Drop => rows::without_normals(simplified)?,
        Normals::Recompute => {
            let faces = Faces::of(original, &simplified, frame_of(original));
            let groups = Groups::of(&simplified, &faces, &|a, b| {
                faces.direction(a).dot(faces.direction(b)) >= FOLD
            });
            let found = groups.area_weighted(&faces);
            rows::with_normals(simplified, &faces, &found)?
        }
        Normals::Fit | Normals::Carry => fitted(original, simplified, progress)?,
    };
    let report = NormalsReport {
        normals,
        stored_vertices_carried: carried,
        stored_vertices: stored_vertices(&mesh),
    };
    Ok((mesh, Some(report)))
}

/// Gives the level of a recorded run the normals and the tangents that a run to it ends with.
///
/// # Errors
/// [`Error::Input`](crate::Error::Input) where the history names normals or tangents that nobody knows;
/// [`Error::Interrupted`](crate::Error::Interrupted).
pub fn settle_level(
    original: &Mesh,
    level: Mesh,
    history: &History,
    progress: &dyn Progress,
) -> Result<Mesh> {
    let normals = recorded(history, "normals")?.unwrap_or(Normals::Carry);
    let tangents = recorded(history, "tangents")?.unwrap_or(Tangents::Carry);
    let (level, _) = settle(original, level, normals, progress)?;
    tangents::settle(level, tangents).map(|(mesh, _)| mesh)
}

fn fitted(original: &Mesh, simplified: Mesh, progress: &dyn Progress) -> Result<Mesh> {
    let frame = frame_of(original);
    let faces = Faces::of(original, &simplified, frame);
    let moments = Moments::of_faces(original, frame, &faces, progress)?;
    let share = |a: usize, b: usize| {
        let [m, n] = [a, b].each(|slot| faces.carried(slot));
        let is_soft = m.dot(n) >= SOFT || m == DVec3::ZERO || n == DVec3::ZERO;
        let [m, n] = [a, b].each(|slot| moments[slot / 3].own[slot % 3]);
        is_soft && m.dot(n) >= APART
    };
    let groups = Groups::of(&simplified, &faces, &share);
    let found = fit::fit(&faces, &groups, &moments, progress)?;
    rows::with_normals(simplified, &faces, &found)
}
