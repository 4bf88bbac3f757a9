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
    errors,
    header::{self, Element, Header, Scalar, Shape, Storage},
    numbers::{Binary, Fault, Source, Text},
};
use crate::{
    Error,
    encode::byte_cursor::ByteCursor,
    io::{Encoding, Loaded, words::Words},
    mesh::{ChannelKind, Mesh, MeshParts},
    num::Precision,
};

pub(in crate::rooms::io) fn read(bytes: &[u8]) -> Result<Loaded, String> {
    let header = header::parse(bytes)?;
    let cursor = ByteCursor::new(bytes, header.body);
    let (encoding, (mesh, notes)) = match header.storage {
        Storage::Ascii => {
            let words = Words::new(bytes, header.body, header.body_line);
            (Encoding::PlyAscii, Reader::run(Text(words), &header)?)
        }
        Storage::LittleEndian => (
            Encoding::PlyLittleEndian,
            Reader::run(Binary::<false>(cursor), &header)?,
        ),
        Storage::BigEndian => (
            Encoding::PlyBigEndian,
            Reader::run(Binary::<true>(cursor), &header)?,
        ),
    };
    Ok(Loaded {
        mesh,
        encoding,
        notes,
    })
}

/// The mesh as far as it is read, and the numbers that are left.
pub(super) struct Reader<S> {
    pub(super) source: S,
    pub(super) bytes_total: usize,
    pub(super) precision: Precision,
    pub(super) positions: Vec<DVec3>,
    /// Attribute values of every vertex, one row of `kinds` after the other.
    pub(super) rows: Vec<f64>,
    pub(super) kinds: Vec<ChannelKind>,
    pub(super) triangles: Vec<[u32; 3]>,
    /// Texture coordinates of the corners of every triangle; empty where faces have none.
    pub(super) corner_uvs: Vec<[[f64; 2]; 3]>,
    /// Faces with fewer than three corners.
    pub(super) slivers: u64,
    pub(super) notes: Vec<String>,
}

impl<S: Source> Reader<S> {
    fn run(source: S, header: &Header) -> Result<(Mesh, Vec<String>), String> {
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
        let named = |name: &str| header.elements.iter().find(|e| e.name == name);
        let vertices = named("vertex").ok_or(errors::NO_VERTICES)?;
        if vertices.count > Mesh::LIMIT as u64 {
            return Err(errors::too_many_vertices(vertices.count));
        }
        for element in &header.elements {
            reader.check_size(element, header.storage)?;
            match element.name.as_str() {
                "vertex" => reader.vertices(element)?,
                "face" => reader.faces(element, vertices.count)?,
                _ => reader.skip_element(element)?,
            }
        }
        if named("face").is_none() {
            let note = "the header declares no element `face`: points without triangles";
            reader.notes.push(note.into());
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
            return Err(errors::too_short(&self.source, element, needed));
        }
        Ok(())
    }

    /// Skips an element that is not kept.
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
                skipped.map_err(|fault| {
                    errors::no_number(&self.source, fault, element, item, &property.name)
                })?;
            }
        }
        Ok(())
    }

    pub(super) fn skip_list(&mut self, count: Scalar, item: Scalar) -> Result<(), Fault> {
        let length = self.list_length(count, item)?;
        self.source.skip(item, length)
    }

    /// Reads the length of a list of `item`s, and refuses one that the rest of the file cannot hold.
    pub(super) fn list_length(&mut self, count: Scalar, item: Scalar) -> Result<u64, Fault> {
        let length = self.source.number(count)?;
        let bytes = length * S::smallest(item) as f64;
        // NaN, negative and fractional lengths fail here too.
        if length >= 0.0 && length.fract() == 0.0 && bytes <= self.source.remaining() as f64 {
            Ok(length as u64)
        } else {
            Err(Fault::Length(length))
        }
    }

    fn finish(mut self) -> Result<(Mesh, Vec<String>), String> {
        if self.slivers > 0 {
            self.notes.push(format!(
                "{} faces with fewer than three corners are not kept",
                self.slivers
            ));
        }
        let attributes = self.attributes().map_err(Error::message)?;
        let mesh = Mesh::new(MeshParts {
            positions: self.positions,
            triangles: self.triangles,
            attributes,
            precision: self.precision,
            ..MeshParts::default()
        });
        Ok((mesh.map_err(Error::message)?, self.notes))
    }
}
