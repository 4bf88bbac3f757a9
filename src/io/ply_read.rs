//! Reads PLY (G. Turk, 1994), text and binary.
//!
//! Our own reader instead of a crate: `ply-rs-bw` 4 bounds what it allocates, but sets every value of every item by the
//! name of its property, keeps a list per face, and gives no offset in binary files. This one reads numbers straight
//! into the mesh, refuses at once a count that the rest of the file cannot hold, and names the place of every fault.
//!
//! Polygons become fans around their first corner. Corner texture coordinates are the face property `texcoord` as
//! MeshLab writes it. Integer colours are divided by the largest value of their type.

use glam::DVec3;

use super::{
    Encoding, Loaded,
    ply_header::{self, Element, Scalar, Shape, Storage},
    ply_source::{Binary, Fault, Source, Text},
    rows,
};
use crate::{
    mesh::{Attributes, ChannelKind, Mesh, MeshParts, compare_rows, unite},
    num::Precision,
};

pub(super) fn read(bytes: &[u8]) -> Result<Loaded, String> {
    let header = ply_header::parse(bytes)?;
    let (encoding, (mesh, notes)) = match header.storage {
        Storage::Ascii => (
            Encoding::PlyAscii,
            Reader::run(
                Text {
                    bytes,
                    at: header.body,
                    line: header.body_line,
                },
                &header,
            )?,
        ),
        Storage::LittleEndian => {
            let source = Binary::<false> {
                bytes,
                at: header.body,
            };
            (Encoding::PlyLittleEndian, Reader::run(source, &header)?)
        }
        Storage::BigEndian => {
            let source = Binary::<true> {
                bytes,
                at: header.body,
            };
            (Encoding::PlyBigEndian, Reader::run(source, &header)?)
        }
    };
    Ok(Loaded {
        mesh,
        encoding,
        notes,
    })
}

/// Names of vertex properties, in the order of their slots in [`Reader::rows`]; a slot may have several names.
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

struct Reader<S> {
    source: S,
    bytes_total: usize,
    precision: Precision,
    positions: Vec<DVec3>,
    /// Attribute values of every vertex, one row of `kinds` after the other.
    rows: Vec<f64>,
    kinds: Vec<ChannelKind>,
    triangles: Vec<[u32; 3]>,
    /// Texture coordinates of the corners of every triangle; empty where faces have none.
    corner_uvs: Vec<[[f64; 2]; 3]>,
    /// Faces with fewer than three corners.
    slivers: u64,
    notes: Vec<String>,
}

impl<S: Source> Reader<S> {
    fn run(source: S, header: &ply_header::Header) -> Result<(Mesh, Vec<String>), String> {
        let mut reader = Self {
            bytes_total: source.remaining() as usize,
            source,
            precision: Precision::F32,
            positions: Vec::new(),
            rows: Vec::new(),
            kinds: Vec::new(),
            triangles: Vec::new(),
            corner_uvs: Vec::new(),
            slivers: 0,
            notes: Vec::new(),
        };
        let vertices = header
            .elements
            .iter()
            .find(|e| e.name == "vertex")
            .ok_or("the header declares no element `vertex`; expected one with x, y and z")?;
        if vertices.count > Mesh::LIMIT as u64 {
            return Err(format!(
                "the header declares {} vertices; at most {} can be handled",
                vertices.count,
                Mesh::LIMIT
            ));
        }
        for element in &header.elements {
            reader.check_size(element, header.storage)?;
            match element.name.as_str() {
                "vertex" => reader.vertices(element)?,
                "face" => reader.faces(element, vertices.count)?,
                _ => reader.skip_element(element)?,
            }
        }
        if !header.elements.iter().any(|e| e.name == "face") {
            reader
                .notes
                .push("the header declares no element `face`: points without triangles".into());
        }
        let excess = reader.source.excess();
        if excess > 0 {
            reader
                .notes
                .push(format!("{excess} bytes after the last element are ignored"));
        }
        reader.finish()
    }

    /// Refuses counts that the rest of the file cannot hold.
    fn check_size(&self, element: &Element, storage: Storage) -> Result<(), String> {
        let needed = element.count.saturating_mul(element.smallest_size(storage));
        if needed > self.source.remaining() {
            return Err(format!(
                "{}: {} items of `{}` need at least {needed} bytes, but {} are left; the file is cut off or its header \
                 is wrong",
                self.source.place(),
                element.count,
                element.name,
                self.source.remaining()
            ));
        }
        Ok(())
    }

    fn fault(&self, fault: Fault, element: &Element, item: u64, property: &str) -> String {
        let found = match fault {
            Fault::End => "the file ends".to_string(),
            Fault::NotANumber(from, to) => format!("found `{}`", self.source.shown(from, to)),
            Fault::Length(length) => format!(
                "found a list of {length} numbers where {} bytes are left",
                self.source.remaining()
            ),
        };
        format!(
            "{}: {found}; expected `{property}` of {} {item} of {}",
            self.source.place(),
            element.name,
            element.count
        )
    }

    fn vertices(&mut self, element: &Element) -> Result<(), String> {
        let mut slots: Vec<Option<usize>> = Vec::with_capacity(element.properties.len());
        let mut kinds: [Option<Scalar>; SLOTS.len()] = [None; SLOTS.len()];
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
        if let Some(missing) = (0..NORMAL).find(|&slot| kinds[slot].is_none()) {
            return Err(format!(
                "the header declares vertices without `{}`; expected the properties x, y and z",
                SLOTS[missing][0]
            ));
        }
        if kinds[..NORMAL].contains(&Some(Scalar::F64)) {
            self.precision = Precision::F64;
        }
        let has = |from: usize, to: usize| kinds[from..to].iter().all(Option::is_some);
        // The slots of the attributes, in the order of the rows.
        let mut row: Vec<usize> = Vec::new();
        for (from, to, kind) in [
            (NORMAL, TEXCOORD, ChannelKind::Normal),
            (TEXCOORD, COLOR, ChannelKind::TexCoord(0)),
            (COLOR, ALPHA + 1, ChannelKind::ColorAlpha),
            (COLOR, ALPHA, ChannelKind::Color),
        ] {
            if has(from, to) && row.last().is_none_or(|&last| last < from) {
                row.extend(from..to);
                self.kinds.push(kind);
            }
        }
        for (property, slot) in element.properties.iter().zip(&slots) {
            if slot.is_none_or(|slot| slot >= NORMAL && !row.contains(&slot)) {
                self.notes.push(format!(
                    "the vertex property `{}` is not kept",
                    property.name
                ));
            }
        }
        let scales = kinds.map(|kind| match kind {
            Some(Scalar::U8 | Scalar::I8) => 255.0,
            Some(Scalar::U16 | Scalar::I16) => 65_535.0,
            Some(Scalar::U32 | Scalar::I32) => 4_294_967_295.0,
            _ => 1.0,
        });
        // Bounded by the size of the file: `check_size` has been here.
        self.positions.reserve_exact(element.count as usize);
        self.rows.reserve_exact(element.count as usize * row.len());
        let mut values = [0.0; SLOTS.len()];
        for item in 0..element.count {
            for (property, slot) in element.properties.iter().zip(&slots) {
                let read = match (property.shape, slot) {
                    (Shape::Scalar(kind), &Some(slot)) => {
                        self.source.number(kind).map(|x| values[slot] = x)
                    }
                    (Shape::Scalar(kind), None) => self.source.skip(kind, 1),
                    (Shape::List { count, item: kind }, _) => self.skip_list(count, kind),
                };
                read.map_err(|fault| self.fault(fault, element, item, &property.name))?;
            }
            let position = DVec3::new(values[0], values[1], values[2]);
            if !self.precision.round_vector(position).is_finite() {
                return Err(format!(
                    "{}: vertex {item} is ({}, {}, {}); expected finite coordinates",
                    self.source.place(),
                    position.x,
                    position.y,
                    position.z
                ));
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

    fn skip_list(&mut self, count: Scalar, item: Scalar) -> Result<(), Fault> {
        let length = self.count(count, item)?;
        self.source.skip(item, length)
    }

    /// The length of a list of `item`s.
    fn count(&mut self, count: Scalar, item: Scalar) -> Result<u64, Fault> {
        let length = self.source.number(count)?;
        let bytes = length * S::smallest(item) as f64;
        // NaN, negative and fractional lengths fail here too.
        if length >= 0.0 && length.fract() == 0.0 && bytes <= self.source.remaining() as f64 {
            Ok(length as u64)
        } else {
            Err(Fault::Length(length))
        }
    }

    fn faces(&mut self, element: &Element, vertices: u64) -> Result<(), String> {
        let (mut indices_at, mut uvs_at) = (None, None);
        for (i, property) in element.properties.iter().enumerate() {
            match (property.name.as_str(), property.shape) {
                ("vertex_indices" | "vertex_index", Shape::List { .. }) if indices_at.is_none() => {
                    indices_at = Some(i);
                }
                ("texcoord", Shape::List { .. }) if uvs_at.is_none() => uvs_at = Some(i),
                (name, _) => self
                    .notes
                    .push(format!("the face property `{name}` is not kept")),
            }
        }
        if indices_at.is_none() {
            if element.count == 0 {
                return Ok(());
            }
            return Err(
                "the header declares faces without vertices; expected `property list uchar int vertex_indices`".into(),
            );
        }
        // Every face takes at least a byte: bounded by the size of the file.
        let expected = (element.count as usize).min(self.bytes_total);
        self.triangles.reserve(expected);
        if uvs_at.is_some() {
            self.corner_uvs.reserve(expected);
        }
        let (mut corners, mut uvs): (Vec<u32>, Vec<f64>) = (Vec::new(), Vec::new());
        for item in 0..element.count {
            corners.clear();
            uvs.clear();
            for (i, property) in element.properties.iter().enumerate() {
                let name = &property.name;
                let (count, kind) = match property.shape {
                    Shape::Scalar(kind) => {
                        self.source
                            .skip(kind, 1)
                            .map_err(|fault| self.fault(fault, element, item, name))?;
                        continue;
                    }
                    Shape::List { count, item } => (count, item),
                };
                let length = self
                    .count(count, kind)
                    .map_err(|fault| self.fault(fault, element, item, name))?;
                if Some(i) == indices_at {
                    for _ in 0..length {
                        let x = self
                            .source
                            .number(kind)
                            .map_err(|fault| self.fault(fault, element, item, name))?;
                        if !(x >= 0.0 && x < vertices as f64 && x.fract() == 0.0) {
                            return Err(format!(
                                "{}: face {item} names vertex {x}; expected a number from 0 to {} (there are \
                                 {vertices} vertices)",
                                self.source.place(),
                                vertices.saturating_sub(1)
                            ));
                        }
                        corners.push(x as u32);
                    }
                } else if Some(i) == uvs_at {
                    for _ in 0..length {
                        uvs.push(
                            self.source
                                .number(kind)
                                .map_err(|fault| self.fault(fault, element, item, name))?,
                        );
                    }
                } else {
                    self.source
                        .skip(kind, length)
                        .map_err(|fault| self.fault(fault, element, item, name))?;
                }
            }
            if !uvs.is_empty() && uvs.len() != 2 * corners.len() {
                return Err(format!(
                    "{}: face {item} has {} corners and {} texture coordinates; expected two per corner or none",
                    self.source.place(),
                    corners.len(),
                    uvs.len()
                ));
            }
            self.fan(&corners, &uvs, uvs_at.is_some());
        }
        Ok(())
    }

    fn fan(&mut self, corners: &[u32], uvs: &[f64], keep_uvs: bool) {
        self.slivers += u64::from(corners.len() < 3);
        for i in 1..corners.len().saturating_sub(1) {
            self.triangles
                .push([corners[0], corners[i], corners[i + 1]]);
            if keep_uvs {
                self.corner_uvs.push([0, i, i + 1].map(|corner| {
                    match uvs.get(2 * corner..2 * corner + 2) {
                        Some(uv) => [uv[0], uv[1]],
                        None => [f64::NAN; 2],
                    }
                }));
            }
        }
    }

    fn skip_element(&mut self, element: &Element) -> Result<(), String> {
        self.notes.push(format!(
            "the element `{}` ({} items) is not kept",
            element.name, element.count
        ));
        if element.properties.is_empty() {
            return Ok(());
        }
        for item in 0..element.count {
            for property in &element.properties {
                let skipped = match property.shape {
                    Shape::Scalar(kind) => self.source.skip(kind, 1),
                    Shape::List { count, item: kind } => self.skip_list(count, kind),
                };
                skipped.map_err(|fault| self.fault(fault, element, item, &property.name))?;
            }
        }
        Ok(())
    }

    fn finish(mut self) -> Result<(Mesh, Vec<String>), String> {
        if self.slivers > 0 {
            self.notes.push(format!(
                "{} faces with fewer than three corners are not kept",
                self.slivers
            ));
        }
        let attributes = self.attributes()?;
        let mesh = Mesh::new(MeshParts {
            positions: self.positions,
            triangles: self.triangles,
            attributes,
            precision: self.precision,
            ..MeshParts::default()
        })?;
        Ok((mesh, self.notes))
    }

    fn attributes(&mut self) -> Result<Attributes, String> {
        let precision = self.precision;
        rows::settle(&mut self.rows, &self.kinds, precision);
        if self.corner_uvs.is_empty() {
            return Attributes::new(
                &self.kinds,
                std::mem::take(&mut self.rows),
                self.triangles.clone(),
            );
        }
        let mut kinds = std::mem::take(&mut self.kinds);
        let width: usize = kinds.iter().map(|k| k.width()).sum();
        // Texture coordinates come after normals and before colours, wherever they are from.
        let (first, at) = if kinds.contains(&ChannelKind::Normal) {
            (1, 3)
        } else {
            (0, 0)
        };
        let replaced = if kinds.contains(&ChannelKind::TexCoord(0)) {
            self.notes.push(
                "faces have texture coordinates of their own: those of the vertices are not kept"
                    .into(),
            );
            2
        } else {
            kinds.insert(first, ChannelKind::TexCoord(0));
            0
        };
        let uvs: Vec<[f64; 2]> = self
            .corner_uvs
            .iter()
            .flatten()
            .map(|uv| {
                let mut uv = *uv;
                rows::settle(&mut uv, &[ChannelKind::TexCoord(0)], precision);
                uv
            })
            .collect();
        let vertices: &[u32] = self.triangles.as_flattened();
        let united = unite(uvs.len(), |a, b| {
            vertices[a]
                .cmp(&vertices[b])
                .then_with(|| compare_rows(&uvs[a], &uvs[b]))
        });
        let mut values = Vec::with_capacity(united.firsts.len() * (width + 2));
        for &corner in &united.firsts {
            let row = &self.rows[vertices[corner] as usize * width..][..width];
            values.extend_from_slice(&row[..at]);
            values.extend_from_slice(&uvs[corner]);
            values.extend_from_slice(&row[at + replaced..]);
        }
        let (corners, _) = united.groups.as_chunks::<3>();
        Attributes::new(&kinds, values, corners.to_vec())
    }
}
