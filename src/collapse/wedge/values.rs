//! Values that a method gives to wedges, from what it keeps of the faces before, in place of those that follow from the
//! star alone.

use std::fmt::Debug;

use glam::DVec3;

use super::{
    classes::Corner,
    makes_features,
    transfer::{Place, WedgeScratch},
};
use crate::{
    collapse::{Admitted, EdgeStar, LiveMesh, Site},
    mesh::Channel,
};

/// Most values of a channel that a method may be asked for: red, green, blue, opacity.
pub const WIDEST: usize = 4;

/// A corner of a star at one end of its edge.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ClassCorner {
    /// Id of its triangle.
    pub triangle: u32,
    /// The end: an index into [`EdgeStar::ends`].
    pub end: usize,
}

/// Corners that share a value of a channel once the edge has collapsed.
#[derive(Clone, Copy, Debug)]
pub struct WedgeClass<'a> {
    /// The channel: texture coordinates or colours.
    pub channel: Channel,
    /// The corners, by the ids of their triangles, then by their ends.
    pub corners: &'a [ClassCorner],
}

/// The values of new wedges, by a method that minimises an error over them.
///
/// The room asks for texture coordinates and colours where the new vertex lies at neither end of its edge, keeps what it
/// is told within the old triangles of the class, and rounds it. Other channels it fills in by itself.
pub trait WedgeValues: Debug + Sync {
    /// The values of a class with the new vertex of the star's edge at `position`, those beyond the width of the channel
    /// being ignored; `None` where the method knows none.
    fn values(
        &self,
        star: &EdgeStar,
        class: &WedgeClass<'_>,
        position: DVec3,
    ) -> Option<[f64; WIDEST]>;
}

/// Hears of the classes of a star.
type Visit<'a> = &'a mut dyn FnMut(&WedgeClass<'_>, &[f64]);

/// Calls `visit` for every class of texture coordinates and colours, with the values that it gets with the new vertex at
/// a place; with meaningless ones where no place is given.
fn each_class(live: &LiveMesh, star: &EdgeStar, place: Option<Place<'_>>, visit: Visit<'_>) {
    let (mut scratch, mut members) = (WedgeScratch::default(), Vec::new());
    scratch.gather(live, star);
    let channels = live.rows().channels().iter().copied();
    for channel in channels.filter(|c| makes_features(c.kind)) {
        match place {
            Some(place) => scratch.fill(live, star, channel, place),
            None => scratch.divide(live, star, channel),
        }
        let corners = scratch.corners();
        for (i, _) in corners.iter().enumerate().filter(|(i, c)| c.class == *i) {
            members_of(star, corners, i, &mut members);
            let class = WedgeClass {
                channel,
                corners: &members,
            };
            visit(&class, scratch.value(live.rows(), channel, i));
        }
    }
}

/// # Classes as a method sees them
impl Site<'_> {
    /// Calls `visit` for every class of corners of texture coordinates and of colours.
    pub fn each_class(&self, mut visit: impl FnMut(&WedgeClass<'_>)) {
        each_class(self.live, self.star, None, &mut |class, _| visit(class));
    }

    /// Calls `visit` for every class of corners of texture coordinates and of colours, with the values that it gets with
    /// the new vertex at `position`.
    pub fn each_value(&self, position: Admitted, mut visit: impl FnMut(&WedgeClass<'_>, &[f64])) {
        let place = Some((position.position(), self.values));
        each_class(self.live, self.star, place, &mut visit);
    }
}

/// Collects the corners of a class.
pub(super) fn members_of(
    star: &EdgeStar,
    corners: &[Corner],
    class: usize,
    members: &mut Vec<ClassCorner>,
) {
    members.clear();
    let own = corners.iter().filter(|c| c.class == class);
    members.extend(own.map(|c| ClassCorner {
        triangle: star.faces[c.face].id,
        end: c.end,
    }));
}
