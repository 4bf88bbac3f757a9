//! The vertices of a PLY body: positions, and the attributes that a mesh keeps.

use glam::DVec3;

use super::{
    errors,
    header::{Element, Scalar, Shape},
    numbers::Source,
    read::Reader,
};
use crate::{mesh::ChannelKind, num::Precision};

/// Names of vertex properties, in the order of their slots in `Columns::slots`; a slot may have several names.
const SLOTS: [&[&str]; 12] = [
    &["x"],
    &["y"],
    &["z"],
    &["nx"],
    &["ny"],
    &["nz"],
    &["s", "u", "texture_u"],
    &["t", "v", "texture_v"],
    &["red", "diffuse_red"],
    &["green", "diffuse_green"],
    &["blue", "diffuse_blue"],
    &["alpha"],
];
const NORMAL: usize = 3;
const TEXCOORD: usize = 6;
const COLOR: usize = 8;
const ALPHA: usize = 11;

/// The properties of a vertex by what they mean.
struct Columns {
    /// The slot of every property; `None` where it is not kept.
    slots: Vec<Option<usize>>,
    /// The type of the number in every slot.
    kinds: [Option<Scalar>; SLOTS.len()],
}

impl Columns {
    /// Finds the slots of the properties of an element; of two properties for one slot the first has it.
    fn of(element: &Element) -> Result<Self, String> {
        let mut kinds: [Option<Scalar>; SLOTS.len()] = [None; SLOTS.len()];
        let mut slots = Vec::with_capacity(element.properties.len());
        for property in &element.properties {
            let slot = match property.shape {
                Shape::Scalar(kind) => SLOTS
                    .iter()
                    .position(|names| names.contains(&property.name.as_str()))
                    .filter(|&slot| kinds[slot].is_none())
                    .inspect(|&slot| kinds[slot] = Some(kind)),
                Shape::List { .. } => None,
            };
            slots.push(slot);
        }
        match (0..NORMAL).find(|&slot| kinds[slot].is_none()) {
            Some(missing) => Err(errors::no_coordinate(SLOTS[missing][0])),
            None => Ok(Self { slots, kinds }),
        }
    }

    /// The channels that are complete, and their slots in the order of a row.
    fn channels(&self) -> (Vec<ChannelKind>, Vec<usize>) {
        let has = |from: usize, to: usize| self.kinds[from..to].iter().all(Option::is_some);
        let (mut kinds, mut row) = (Vec::new(), Vec::new());
        for (from, to, kind) in [
            (NORMAL, TEXCOORD, ChannelKind::Normal),
            (TEXCOORD, COLOR, ChannelKind::TexCoord(0)),
            (COLOR, ALPHA + 1, ChannelKind::ColorAlpha),
            (COLOR, ALPHA, ChannelKind::Color),
        ] {
            if has(from, to) && row.last().is_none_or(|&last| last < from) {
                row.extend(from..to);
                kinds.push(kind);
            }
        }
        (kinds, row)
    }

    /// The number that stands for 1 in every slot, should it hold a colour.
    fn scales(&self) -> [f64; SLOTS.len()] {
        self.kinds.map(|kind| match kind {
            Some(Scalar::U8 | Scalar::I8) => 255.0,
            Some(Scalar::U16 | Scalar::I16) => 65_535.0,
            Some(Scalar::U32 | Scalar::I32) => 4_294_967_295.0,
            _ => 1.0,
        })
    }
}

impl<S: Source> Reader<S> {
    /// Reads the vertices.
    pub(super) fn vertices(&mut self, element: &Element) -> Result<(), String> {
        let columns = Columns::of(element)?;
        if columns.kinds[..NORMAL].contains(&Some(Scalar::F64)) {
            self.precision = Precision::F64;
        }
        let (kinds, row) = columns.channels();
        self.kinds.extend(kinds);
        for (property, slot) in element.properties.iter().zip(&columns.slots) {
            if slot.is_none_or(|slot| slot >= NORMAL && !row.contains(&slot)) {
                self.notes.push(format!(
                    "the vertex property `{}` is not kept",
                    property.name
                ));
            }
        }
        let scales = columns.scales();
        // Bounded by the size of the file: `check_size` has been here.
        self.positions.reserve_exact(element.count as usize);
        self.rows.reserve_exact(element.count as usize * row.len());
        let mut values = [0.0; SLOTS.len()];
        for item in 0..element.count {
            for (property, slot) in element.properties.iter().zip(&columns.slots) {
                let read = match (property.shape, slot) {
                    (Shape::Scalar(kind), &Some(slot)) => {
                        self.source.number(kind).map(|x| values[slot] = x)
                    }
                    (Shape::Scalar(kind), None) => self.source.skip(kind, 1),
                    (Shape::List { count, item: kind }, _) => self.skip_list(count, kind),
                };
                read.map_err(|fault| {
                    errors::no_number(&self.source, fault, element, item, &property.name)
                })?;
            }
            let position = DVec3::new(values[0], values[1], values[2]);
            if !self.precision.round_vector(position).is_finite() {
                return Err(errors::not_finite(&self.source, item, position));
            }
            self.positions.push(position);
            for &slot in &row {
                self.rows.push(if slot >= COLOR {
                    values[slot] / scales[slot]
                } else {
                    values[slot]
                });
            }
        }
        Ok(())
    }
}
