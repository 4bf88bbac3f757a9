//! Corner attributes: wedges, so that seams are first-class.
//!
//! A *wedge* is one combination of attribute values at a vertex. Every triangle corner names a wedge; corners of one
//! vertex on both sides of a texture seam name different wedges. A mesh without attributes has no channels and no
//! corners.

use serde::{Deserialize, Serialize};

use crate::{Error, Result};

/// Meaning of a channel of attribute values.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum ChannelKind {
    /// A unit normal: 3 values.
    Normal,
    /// A texture coordinate of set 0, 1, ...: 2 values.
    TexCoord(u8),
    /// Red, green, blue in [0, 1]: 3 values.
    Color,
    /// Red, green, blue, opacity in [0, 1]: 4 values.
    ColorAlpha,
    /// A unit tangent, and the sign (1 or -1) of the bitangent: 4 values.
    Tangent,
    /// Four joints by number, and their weights, which sum to 1: 8 values. Of set 0, 1, ...
    Skin(u8),
    /// The displacement of a morph target: 3 values. 3 x target, + 0 of the position, 1 of the normal, 2 of the tangent.
    Delta(u16),
    /// An attribute that only its file knows, such as an id: it is taken from the nearest corner, never averaged.
    Custom {
        /// Number among the attributes of the file, which has their names (`Asset::customs`).
        number: u8,
        /// Values per wedge: 1 to 4.
        width: u8,
    },
}

impl ChannelKind {
    /// Values per wedge.
    #[must_use]
    pub const fn width(self) -> usize {
        match self {
            Self::TexCoord(_) => 2,
            Self::Normal | Self::Color | Self::Delta(_) => 3,
            Self::ColorAlpha | Self::Tangent => 4,
            Self::Skin(_) => 8,
            Self::Custom { width, .. } => width as usize,
        }
    }
}

/// One channel: its meaning and where its values lie in a wedge's row.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Channel {
    /// Meaning of the values.
    pub kind: ChannelKind,
    /// Index of the first value in the row of a wedge.
    pub offset: usize,
}

/// The attributes of a mesh: channels, a row of values per wedge, three wedges per triangle.
///
/// A value that a corner does not have (an OBJ face without `vt`) is NaN, always the same one; two wedges are equal
/// where all their bits are.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Attributes {
    channels: Vec<Channel>,
    stride: usize,
    values: Vec<f64>,
    corners: Vec<[u32; 3]>,
}

impl Attributes {
    /// Attributes with the given channels in the given order; `values` holds the rows of all wedges, `corners` the
    /// wedges of every triangle. Every NaN is replaced by the one that means "absent".
    ///
    /// # Errors
    /// [`Error::Input`] where the sizes do not fit, a corner names a wedge that does not exist, or a value is infinite.
    pub fn new(
        kinds: &[ChannelKind],
        mut values: Vec<f64>,
        corners: Vec<[u32; 3]>,
    ) -> Result<Self> {
        let mut channels = Vec::with_capacity(kinds.len());
        let mut stride = 0;
        for &kind in kinds {
            channels.push(Channel {
                kind,
                offset: stride,
            });
            stride += kind.width();
        }
        if stride == 0 {
            return Ok(Self::default());
        }
        if !values.len().is_multiple_of(stride) {
            return Err(Error::content(format!(
                "{} attribute values are not a whole number of rows of {stride}",
                values.len()
            )));
        }
        let wedges = values.len() / stride;
        if let Some((t, c)) = corners
            .iter()
            .enumerate()
            .find_map(|(t, c)| c.iter().find(|&&w| w as usize >= wedges).map(|&w| (t, w)))
        {
            return Err(Error::content(format!(
                "triangle {t} names wedge {c}, but there are {wedges}"
            )));
        }
        for v in &mut values {
            if v.is_nan() {
                *v = f64::NAN;
            } else if v.is_infinite() {
                return Err(Error::content(
                    "an attribute value is infinite; expected finite numbers",
                ));
            }
        }
        Ok(Self {
            channels,
            stride,
            values,
            corners,
        })
    }

    /// True where the mesh has no attributes at all.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.channels.is_empty()
    }

    /// The channels, in the order of their values in a row.
    #[must_use]
    pub fn channels(&self) -> &[Channel] {
        &self.channels
    }

    /// The channel of a kind, if there is one.
    #[must_use]
    pub fn channel(&self, kind: ChannelKind) -> Option<Channel> {
        self.channels.iter().copied().find(|c| c.kind == kind)
    }

    /// Values per wedge.
    #[must_use]
    pub fn stride(&self) -> usize {
        self.stride
    }

    /// Number of wedges.
    #[must_use]
    pub fn wedge_count(&self) -> usize {
        self.values.len().checked_div(self.stride).unwrap_or(0)
    }

    /// All values of a wedge.
    ///
    /// # Panics
    /// Where there is no such wedge.
    #[must_use]
    pub fn row(&self, wedge: u32) -> &[f64] {
        &self.values[wedge as usize * self.stride..][..self.stride]
    }

    /// The values of one channel at a wedge; NaN where absent.
    ///
    /// # Panics
    /// Where there is no such wedge.
    #[must_use]
    pub fn value(&self, channel: Channel, wedge: u32) -> &[f64] {
        &self.row(wedge)[channel.offset..][..channel.kind.width()]
    }

    /// The rows of all wedges, one after the other.
    #[must_use]
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// The three wedges of every triangle; empty where there are no attributes.
    #[must_use]
    pub fn corners(&self) -> &[[u32; 3]] {
        &self.corners
    }
}
