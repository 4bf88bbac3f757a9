//! Wedges: the values of corners, and the seams between faces that differ in them.

mod blend;
mod charts;
mod classes;
mod coordinates;
mod displaced;
mod oriented_volume;
mod transfer;
mod values;

pub use self::values::{ClassCorner, WIDEST, WedgeClass, WedgeValues};
pub(super) use self::{
    blend::Blend,
    charts::ChartScales,
    coordinates::double_area,
    displaced::displaced_area,
    transfer::{WedgeScratch, transfer, turns_texture},
};
use super::{LiveMesh, StarFace};
use crate::{
    mesh::{Attributes, Channel, ChannelKind},
    num::Each,
};

/// The values of all wedges, rows that patches appended included.
#[derive(Clone, Debug, Default)]
pub struct WedgeRows {
    channels: Vec<Channel>,
    stride: usize,
    values: Vec<f64>,
}

impl WedgeRows {
    /// A copy of the rows of `attributes`.
    #[must_use]
    pub fn of(attributes: &Attributes) -> Self {
        Self {
            channels: attributes.channels().to_vec(),
            stride: attributes.stride(),
            values: attributes.values().to_vec(),
        }
    }

    /// The channels.
    #[must_use]
    pub fn channels(&self) -> &[Channel] {
        &self.channels
    }

    /// The meanings of the channels.
    #[must_use]
    pub fn kinds(&self) -> Vec<ChannelKind> {
        self.channels.iter().map(|c| c.kind).collect()
    }

    /// Values in a row; 0 where there are no attributes.
    #[must_use]
    pub fn stride(&self) -> usize {
        self.stride
    }

    /// Number of rows.
    #[must_use]
    pub fn count(&self) -> u32 {
        self.values.len().checked_div(self.stride).unwrap_or(0) as u32
    }

    /// The values of a wedge.
    ///
    /// # Panics
    /// Where there is no such wedge.
    #[must_use]
    pub fn row(&self, wedge: u32) -> &[f64] {
        &self.values[wedge as usize * self.stride..][..self.stride]
    }

    /// True where a channel is one whose discontinuities are features.
    #[must_use]
    pub fn has_feature_channels(&self) -> bool {
        self.channels.iter().any(|c| makes_features(c.kind))
    }

    pub(super) fn append(&mut self, rows: &[f64]) {
        self.values.extend_from_slice(rows);
    }

    pub(super) fn truncate(&mut self, values: usize) {
        self.values.truncate(self.values.len() - values);
    }

    /// The values of a channel at a wedge.
    ///
    /// # Panics
    /// Where there is no such wedge.
    #[must_use]
    pub fn value(&self, channel: Channel, wedge: u32) -> &[f64] {
        &self.row(wedge)[channel.offset..][..channel.kind.width()]
    }

    /// True where two wedges have the same values of a channel, to the bit.
    ///
    /// # Panics
    /// Where there is no such wedge.
    #[must_use]
    pub fn same(&self, channel: Channel, a: u32, b: u32) -> bool {
        a == b || same_bits(self.value(channel, a), self.value(channel, b))
    }
}

/// True for texture coordinates and colours, which are seen to jump. Normals differ at almost every edge of a flat-shaded export; that
/// alone is no feature. The rest is not seen.
#[must_use]
pub fn makes_features(kind: ChannelKind) -> bool {
    matches!(
        kind,
        ChannelKind::TexCoord(_) | ChannelKind::Color | ChannelKind::ColorAlpha
    )
}

pub(super) fn same_bits(a: &[f64], b: &[f64]) -> bool {
    a.iter().zip(b).all(|(x, y)| x.to_bits() == y.to_bits())
}

/// True where attributes or materials differ between the star's faces at the edge `ends`, or its texture is mirrored
/// there; `faces` has at least those of the star at that edge, in its order.
#[must_use]
pub(super) fn is_feature<'a>(
    live: &LiveMesh,
    faces: impl Iterator<Item = &'a StarFace>,
    ends: [u32; 2],
) -> bool {
    let corner = |f: &StarFace, v: u32| f.corners.iter().position(|&c| c == v);
    let at_edge = |f: &StarFace| Some([corner(f, ends[0])?, corner(f, ends[1])?]);
    let mut at = faces.filter_map(|f| Some((f, at_edge(f)?)));
    let Some((first, first_at)) = at.next() else {
        return false;
    };
    at.any(|(other, other_at)| {
        let faces = [first, other].each(|f| (f.id, live.wedges(f.id)));
        differ(live, faces, [first_at, other_at], makes_features)
    })
}

/// True where two faces, given with their wedges, differ along a common edge in their material, in the values of a
/// channel that `counts` at either end (`at`: which corners those are, the same end first), or where one of them is
/// mirrored in texture space.
pub(super) fn differ(
    live: &LiveMesh,
    faces: [(u32, [u32; 3]); 2],
    at: [[usize; 2]; 2],
    counts: impl Fn(ChannelKind) -> bool,
) -> bool {
    let [(f, a), (g, b)] = faces;
    if live.material(f) != live.material(g) {
        return true;
    }
    let rows = live.rows();
    rows.channels.iter().filter(|c| counts(c.kind)).any(|&c| {
        let differs = |end: usize| !rows.same(c, a[at[0][end]], b[at[1][end]]);
        let mirrored = || {
            // Faces that run along the edge the same way show different sides.
            let forward = |at: [usize; 2]| (at[0] + 1) % 3 == at[1];
            let side = if forward(at[0]) == forward(at[1]) {
                -1.0
            } else {
                1.0
            };
            matches!(c.kind, ChannelKind::TexCoord(_))
                && side * texture_area(rows, c, a) * texture_area(rows, c, b) < 0.0
        };
        differs(0) || differs(1) || mirrored()
    })
}

/// Twice the signed area of a triangle in texture space; NaN where it has no texture coordinates.
#[must_use]
pub fn texture_area(rows: &WedgeRows, channel: Channel, wedges: [u32; 3]) -> f64 {
    coordinates::double_area(wedges.each(|w| {
        let value = rows.value(channel, w);
        [value[0], value[1]]
    }))
}
