//! The attributes of primitives as channels of the mesh.

use std::collections::BTreeSet;

use glam::{DAffine3, DMat3, DVec3};

use super::{
    accessor::{Elements, Shape},
    buffers::Views,
    document::{Document, Primitive},
    wrong,
};
use crate::{
    Result,
    mesh::{AssetPart, ChannelKind},
    num::math,
};

/// Custom attributes that a mesh can tell apart.
const CUSTOMS: usize = 256;

/// The attributes of the document that the mesh carries.
pub(super) struct Channels<'a> {
    document: &'a Document,
    /// Names of custom attributes, by number.
    customs: &'a [String],
    /// Channels of all parts together, in order.
    pub kinds: Vec<ChannelKind>,
}

/// The names of the custom attributes of the parts, in order.
pub(super) fn customs(document: &Document, parts: &[AssetPart]) -> Vec<String> {
    let mut found = BTreeSet::new();
    for (name, &accessor) in parts
        .iter()
        .flat_map(|part| &primitive(document, part).attributes)
    {
        let is_color = name.starts_with("COLOR_") && name != "COLOR_0";
        if (name.starts_with('_') || is_color) && (1..=4).contains(&width(document, accessor)) {
            found.insert(name);
        }
    }
    found.into_iter().take(CUSTOMS).cloned().collect()
}

/// The primitive of a part.
///
/// # Panics
/// Where the part is of another document.
pub(super) fn primitive<'a>(document: &'a Document, part: &AssetPart) -> &'a Primitive {
    &document.meshes[part.mesh].primitives[part.primitive]
}

/// Components of an accessor; 0 where there is none.
fn width(document: &Document, accessor: usize) -> usize {
    let accessor = document.accessors.get(accessor);
    accessor
        .and_then(|a| Shape::of(&a.shape))
        .map_or(0, Shape::width)
}

impl<'a> Channels<'a> {
    /// The channels of some parts of a document.
    pub(super) fn of(document: &'a Document, parts: &[AssetPart], customs: &'a [String]) -> Self {
        let mut channels = Self {
            document,
            customs,
            kinds: Vec::new(),
        };
        let mut kinds = BTreeSet::new();
        for primitive in parts.iter().map(|part| primitive(document, part)) {
            let names = primitive.attributes.iter();
            kinds.extend(names.filter_map(|(name, _)| channels.kind(primitive, name)));
            for (number, target) in primitive.targets.iter().enumerate() {
                kinds.extend(target.keys().filter_map(|name| delta(number, name)));
            }
        }
        // Colours without opacity are opaque beside those that have it.
        if kinds.contains(&ChannelKind::ColorAlpha) {
            kinds.remove(&ChannelKind::Color);
        }
        channels.kinds = kinds.into_iter().collect();
        channels
    }

    /// Names of the attributes of a primitive that no channel carries.
    pub(super) fn left_out(&self, primitive: &Primitive) -> Vec<String> {
        let is_weight = |name: &String| {
            let joints = name
                .strip_prefix("WEIGHTS_")
                .map(|set| format!("JOINTS_{set}"));
            joints.is_some_and(|joints| self.kind(primitive, &joints).is_some())
        };
        let attributes = primitive.attributes.keys().filter(|name| {
            *name != "POSITION" && !is_weight(name) && self.kind(primitive, name).is_none()
        });
        let mut found: Vec<String> = attributes.cloned().collect();
        for (number, target) in primitive.targets.iter().enumerate() {
            let names = target.keys().filter(|name| delta(number, name).is_none());
            found.extend(names.map(|name| format!("{name} of morph targets")));
        }
        found
    }

    /// The channel of an attribute, if the mesh carries it.
    fn kind(&self, primitive: &Primitive, name: &str) -> Option<ChannelKind> {
        let accessor = *primitive.attributes.get(name)?;
        let width = width(self.document, accessor);
        let kind = match (name, width) {
            ("NORMAL", 3) => ChannelKind::Normal,
            ("TANGENT", 4) => ChannelKind::Tangent,
            ("COLOR_0", 3) => ChannelKind::Color,
            ("COLOR_0", 4) => ChannelKind::ColorAlpha,
            _ => {
                if let Some(set) = numbered(name, "TEXCOORD_") {
                    ChannelKind::TexCoord(set)
                } else if let Some(set) = numbered(name, "JOINTS_") {
                    ChannelKind::Skin(set)
                } else {
                    let number = self.customs.iter().position(|custom| custom == name)?;
                    ChannelKind::Custom {
                        number: number as u8,
                        width: width as u8,
                    }
                }
            }
        };
        self.sources(primitive, kind).map(|_| kind)
    }

    /// The accessors that fill a channel of a primitive, each with its place in the channel.
    pub(super) fn sources(
        &self,
        primitive: &Primitive,
        kind: ChannelKind,
    ) -> Option<Vec<(usize, usize)>> {
        let of = |name: &str, widths: &[usize]| {
            let accessor = *primitive.attributes.get(name)?;
            let fits = widths.contains(&width(self.document, accessor));
            fits.then_some(accessor)
        };
        let one = |name: &str, widths: &[usize]| Some(vec![(of(name, widths)?, 0)]);
        match kind {
            ChannelKind::Normal => one("NORMAL", &[3]),
            ChannelKind::Tangent => one("TANGENT", &[4]),
            ChannelKind::TexCoord(set) => one(&format!("TEXCOORD_{set}"), &[2]),
            ChannelKind::Color => one("COLOR_0", &[3]),
            ChannelKind::ColorAlpha => one("COLOR_0", &[3, 4]),
            ChannelKind::Skin(set) => Some(vec![
                (of(&format!("JOINTS_{set}"), &[4])?, 0),
                (of(&format!("WEIGHTS_{set}"), &[4])?, 4),
            ]),
            ChannelKind::Delta(number) => {
                let target = primitive.targets.get(usize::from(number / 3))?;
                let accessor = *target.get(DELTAS[usize::from(number % 3)])?;
                Some(vec![(accessor, 0)])
            }
            ChannelKind::Custom { number, width } => one(
                self.customs.get(usize::from(number))?,
                &[usize::from(width)],
            ),
        }
    }

    /// The rows of some vertices of a primitive, as it stores them.
    ///
    /// # Errors
    /// As [`Elements::open`]; [`Error::Input`](crate::Error::Input) where an attribute does not have `count` elements.
    pub(super) fn rows(
        &self,
        views: &Views<'_>,
        primitive: &Primitive,
        count: usize,
        vertices: &[u32],
    ) -> Result<Vec<f64>> {
        let stride: usize = self.kinds.iter().map(|kind| kind.width()).sum();
        views.spend(stride.saturating_mul(vertices.len()))?;
        let mut rows = vec![f64::NAN; stride * vertices.len()];
        let mut offset = 0;
        for &kind in &self.kinds {
            for (accessor, place) in self.sources(primitive, kind).unwrap_or_default() {
                let elements = Elements::open(self.document, views, accessor)?;
                let is_delta = matches!(kind, ChannelKind::Delta(_));
                if elements.count != count || (is_delta && elements.width() != 3) {
                    return Err(wrong(format!(
                        "accessors[{accessor}] has {} elements of {} components, where an attribute of {count} vertices is \
                         expected",
                        elements.count,
                        elements.width()
                    )));
                }
                let opaque = kind == ChannelKind::ColorAlpha && elements.width() == 3;
                for (&vertex, row) in vertices.iter().zip(rows.chunks_exact_mut(stride)) {
                    let into = &mut row[offset + place..];
                    elements.read(vertex as usize, into);
                    if opaque {
                        into[3] = 1.0;
                    }
                }
            }
            offset += kind.width();
        }
        Ok(rows)
    }
}

/// The attributes that morph targets displace, in the order of the numbers of their channels.
const DELTAS: [&str; 3] = ["POSITION", "NORMAL", "TANGENT"];

/// The channel of an attribute of a morph target.
fn delta(target: usize, name: &str) -> Option<ChannelKind> {
    let which = DELTAS.iter().position(|known| *known == name)?;
    u16::try_from(3 * target + which)
        .ok()
        .map(ChannelKind::Delta)
}

/// The number after a prefix, written without a zero or a sign before it.
fn numbered(name: &str, prefix: &str) -> Option<u8> {
    let number = name.strip_prefix(prefix)?;
    let parsed: u8 = number.parse().ok()?;
    (parsed.to_string() == number).then_some(parsed)
}

/// Brings rows from the coordinates of a primitive into those of the mesh.
pub(super) fn place(rows: &mut [f64], kinds: &[ChannelKind], placement: &DAffine3) {
    let linear = placement.matrix3;
    let across = linear.inverse().transpose();
    let is_mirrored = linear.determinant() < 0.0;
    let stride: usize = kinds.iter().map(|kind| kind.width()).sum();
    for row in rows.chunks_exact_mut(stride.max(1)) {
        let mut rest = row;
        for kind in kinds {
            let (value, after) = rest.split_at_mut(kind.width());
            match kind {
                ChannelKind::Normal => turn(value, across, true),
                ChannelKind::Tangent => {
                    turn(value, linear, true);
                    if is_mirrored {
                        value[3] = -value[3];
                    }
                }
                ChannelKind::Delta(number) if number % 3 == 1 => turn(value, across, false),
                ChannelKind::Delta(_) => turn(value, linear, false),
                ChannelKind::TexCoord(_)
                | ChannelKind::Color
                | ChannelKind::ColorAlpha
                | ChannelKind::Skin(_)
                | ChannelKind::Custom { .. } => {}
            }
            rest = after;
        }
    }
}

/// Maps a vector; one that must be unit and has no direction is absent.
fn turn(value: &mut [f64], by: DMat3, is_unit: bool) {
    let mut vector = by * DVec3::new(value[0], value[1], value[2]);
    if is_unit {
        vector = math::unit(vector).unwrap_or(DVec3::NAN);
    }
    value[..3].copy_from_slice(&vector.to_array());
}
