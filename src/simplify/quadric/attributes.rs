//! The quadrics of texture coordinates and colours, per vertex and class of corners.
//!
//! Every channel has a quadric in R^(3+w) of its own, and positions count once: with one channel that is Garland &
//! Heckbert 1998. A channel that jumps at a vertex has a quadric for each of its values there, so the sides of a seam
//! share the position and keep their own coordinates.
//!
//! A unit of texture coordinates is as long as its chart's mean edge on the surface over that in the texture; a unit of
//! colour or opacity as the longest side of the mesh's box: the paper's unit cube. Normals take no part: they are fitted
//! to the surface that is left.
//!
//! A quadric lies at the first triangle of its class, under that and the vertex; where the triangle goes, it moves to
//! another that has the same value at the vertex.

use std::collections::BTreeMap;

use glam::DVec3;

use super::{
    Quadric, Weighting,
    attribute_quadric::{AttributeQuadric, Values},
};
use crate::{
    collapse::{
        Admitted, EdgeStar, LiveMesh, Patch, PatchFace, Site,
        wedge::{WIDEST, WedgeClass, WedgeValues, makes_features, texture_area},
    },
    geometry::{Box3, double_area},
    mesh::{Channel, ChannelKind},
    num::{Each, math},
};

/// The quadrics of the channels of a mesh that take part.
#[derive(Clone, Debug)]
pub struct AttributeQuadrics {
    channels: Vec<ChannelQuadrics>,
}

/// The quadrics of a channel.
#[derive(Clone, Debug)]
struct ChannelQuadrics {
    channel: Channel,
    /// The middle of the values, from which those of quadrics count.
    origin: Values,
    /// By vertex and the triangle that stands for the class.
    at: BTreeMap<(u32, u32), AttributeQuadric>,
}

impl AttributeQuadrics {
    /// The quadrics of a mesh; `None` where no channel takes part. O(n log n).
    pub fn new(live: &LiveMesh, weighting: Weighting) -> Option<Self> {
        let channels = live.rows().channels().iter().copied();
        let channels: Vec<_> = channels
            .filter(|c| makes_features(c.kind))
            .map(|channel| ChannelQuadrics::new(live, channel, weighting))
            .collect();
        (!channels.is_empty()).then_some(Self { channels })
    }

    /// A quadric of positions with those of all classes of a site added, each with the best values.
    pub fn placing(&self, site: &Site<'_>, mut sum: Quadric) -> Quadric {
        site.each_class(|class| {
            let own = self.of_class(site.star, class).map(|(_, quadric)| quadric);
            let left = own.and_then(|q| q.without_values(class.channel.kind.width()));
            // Nothing, exactly, where the values are constant.
            if let Some(left) = left.filter(|q| *q != Quadric::default()) {
                sum = sum.plus(&left);
            }
        });
        sum
    }

    /// The error of the values that the new vertex gets at a place.
    pub fn error(&self, site: &Site<'_>, place: Admitted) -> f64 {
        let mut sum = 0.0;
        site.each_value(place, |class, values| {
            if let Some((set, quadric)) = self.of_class(site.star, class)
                && values.iter().all(|x| x.is_finite())
            {
                let mut own = [0.0; WIDEST];
                for ((own, x), origin) in own.iter_mut().zip(values).zip(set.origin) {
                    *own = x - origin;
                }
                sum += quadric.error(place.position(), own);
            }
        });
        sum
    }

    /// Follows a commit.
    pub fn committed(&mut self, live: &LiveMesh, patch: &Patch) {
        for set in &mut self.channels {
            set.committed(live, patch);
        }
    }

    /// The sum of the quadrics of a class.
    fn of_class(
        &self,
        star: &EdgeStar,
        class: &WedgeClass<'_>,
    ) -> Option<(&ChannelQuadrics, AttributeQuadric)> {
        let mut sets = self.channels.iter();
        let set = sets.find(|set| set.channel == class.channel)?;
        let mut sum = AttributeQuadric::default();
        for corner in class.corners {
            if let Some(own) = set.at.get(&(star.ends[corner.end], corner.triangle)) {
                sum.add(own);
            }
        }
        Some((set, sum))
    }
}

impl WedgeValues for AttributeQuadrics {
    fn values(
        &self,
        star: &EdgeStar,
        class: &WedgeClass<'_>,
        position: DVec3,
    ) -> Option<[f64; WIDEST]> {
        let (set, quadric) = self.of_class(star, class)?;
        let mut values = quadric.values_at(position, class.channel.kind.width())?;
        for (x, origin) in values.iter_mut().zip(set.origin) {
            *x += origin;
        }
        Some(values)
    }
}

impl ChannelQuadrics {
    fn new(live: &LiveMesh, channel: Channel, weighting: Weighting) -> Self {
        let origin = middle(live, channel);
        let all = (0..live.triangle_ids()).filter_map(|t| live.points(t));
        let extent = Box3::of(all.flatten()).map_or(0.0, |all| all.diagonal().max_element());
        let face = |t: u32| {
            let points = live.points(t)?;
            let scale = match channel.kind {
                ChannelKind::TexCoord(_) => live.texture_scale(channel.kind, t),
                _ => extent,
            };
            let weight = match weighting {
                Weighting::Unit => 1.0,
                Weighting::Area => double_area(points) * 0.5,
            };
            let own = live.wedges(t).each(|w| {
                let mut values = values(live, channel, w);
                for (x, origin) in values.iter_mut().zip(origin) {
                    *x -= origin;
                }
                values
            });
            AttributeQuadric::face(points, own, scale, weight)
        };
        // Corners by vertex, value and side of the texture: equal ones share a quadric.
        let mut corners = Vec::new();
        for t in 0..live.triangle_ids() {
            let Some(vertices) = live.triangle(t).filter(|_| face(t).is_some()) else {
                continue;
            };
            let wedges = live.wedges(t);
            let mirrored = is_mirrored(live, channel, wedges);
            for (v, w) in vertices.into_iter().zip(wedges) {
                let bits = values(live, channel, w).each(f64::to_bits);
                corners.push((v, bits, mirrored, t));
            }
        }
        corners.sort_unstable();
        let mut at = BTreeMap::new();
        for class in corners.chunk_by(|a, b| (a.0, a.1, a.2) == (b.0, b.1, b.2)) {
            let mut sum = AttributeQuadric::default();
            for face in class.iter().filter_map(|corner| face(corner.3)) {
                sum.add(&face);
            }
            at.insert((class[0].0, class[0].3), sum);
        }
        Self {
            channel,
            origin,
            at,
        }
    }

    fn committed(&mut self, live: &LiveMesh, patch: &Patch) {
        let Some(moved) = patch.moved else { return };
        let stays = |face: &PatchFace| patch.added.binary_search_by_key(&face.id, |f| f.id).is_ok();
        for face in patch.removed.iter().filter(|f| !stays(f)) {
            for k in 0..3 {
                let Some(quadric) = self.at.remove(&(face.corners[k], face.id)) else {
                    continue;
                };
                if let Some(heir) = self.heir(live, patch, face, k) {
                    self.at.entry(heir).or_default().add(&quadric);
                }
            }
        }
        let Some(gone) = patch.gone else { return };
        for face in patch.removed.iter().filter(|f| stays(f)) {
            if let Some(quadric) = self.at.remove(&(gone, face.id)) {
                self.at
                    .entry((moved.vertex, face.id))
                    .or_default()
                    .add(&quadric);
            }
        }
    }

    /// The vertex and the triangle of the patch that stays to which the quadric of a corner of one that goes belongs.
    fn heir(
        &self,
        live: &LiveMesh,
        patch: &Patch,
        face: &PatchFace,
        corner: usize,
    ) -> Option<(u32, u32)> {
        let ends = [patch.moved.map(|m| m.vertex), patch.gone];
        let is_end = |v: u32| ends.contains(&Some(v));
        let mirrored = is_mirrored(live, self.channel, face.wedges);
        // A face with both ends unites the classes of its two corners.
        let others = (0..3)
            .filter(|&k| k != corner && is_end(face.corners[corner]) && is_end(face.corners[k]));
        for k in std::iter::once(corner).chain(others) {
            let same = |other: &&PatchFace| {
                let at = other.corner(face.corners[k]);
                let rows = live.rows();
                at.is_some_and(|at| rows.same(self.channel, other.wedges[at], face.wedges[k]))
            };
            let staying = patch.removed.iter().filter(|other| {
                let added = &patch.added;
                added.binary_search_by_key(&other.id, |f| f.id).is_ok()
            });
            let heir = staying.filter(same).min_by_key(|other| {
                let differs = is_mirrored(live, self.channel, other.wedges) != mirrored;
                (differs, other.id)
            });
            if let Some(heir) = heir {
                return Some((face.corners[k], heir.id));
            }
        }
        None
    }
}

/// The middle of the range of a channel's values; constant values are exactly that.
fn middle(live: &LiveMesh, channel: Channel) -> Values {
    let mut origin = [0.0; WIDEST];
    for (k, origin) in origin[..channel.kind.width()].iter_mut().enumerate() {
        let all = (0..live.wedge_count()).map(|w| live.rows().value(channel, w)[k]);
        let [low, high] = math::range(all);
        let middle = low + (high - low) * 0.5;
        *origin = if middle.is_finite() { middle } else { 0.0 };
    }
    origin
}

/// The values of a wedge.
fn values(live: &LiveMesh, channel: Channel, wedge: u32) -> Values {
    let mut values = [0.0; WIDEST];
    let width = channel.kind.width();
    values[..width].copy_from_slice(live.rows().value(channel, wedge));
    values
}

fn is_mirrored(live: &LiveMesh, channel: Channel, wedges: [u32; 3]) -> bool {
    matches!(channel.kind, ChannelKind::TexCoord(_))
        && texture_area(live.rows(), channel, wedges) < 0.0
}
