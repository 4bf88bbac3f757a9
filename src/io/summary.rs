//! A file in brief: what it is and what it holds, without an examination of the surface.

use std::fmt::Write;

use serde::Serialize;

use super::{Encoding, Format, Loaded, per_vertex};
use crate::{mesh::ChannelKind, num::Precision};

/// The contents of a file by number and kind, as `inspect` tells them.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Summary {
    /// The format that the content has.
    pub format: Format,
    /// The format down to its bytes.
    pub encoding: Encoding,
    /// The precision of the coordinates.
    pub precision: Precision,
    /// Number of vertices, as stored.
    pub vertices: usize,
    /// Number of triangles, polygons split.
    pub triangles: usize,
    /// Number of different corners with attributes, as stored.
    pub wedges: usize,
    /// Kinds of the attributes.
    pub channels: Vec<ChannelKind>,
    /// Names of the attributes that only the file knows, by number.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub customs: Vec<String>,
    /// Names of the materials, or of the parts of a document, with the number of triangles of each.
    pub materials: Vec<(String, usize)>,
    /// Files that define them.
    pub libraries: Vec<String>,
    /// One sentence for everything that the reader could not keep.
    pub notes: Vec<String>,
}

impl Summary {
    /// Summarizes what was read. O(triangles).
    #[must_use]
    pub fn of(loaded: &Loaded) -> Self {
        let mesh = &loaded.mesh;
        let names = &mesh.materials().names;
        let mut counts = vec![0; names.len()];
        for &material in &mesh.materials().of_triangle {
            if let Some(count) = counts.get_mut(material as usize) {
                *count += 1;
            }
        }
        Self {
            format: loaded.encoding.format(),
            encoding: loaded.encoding,
            precision: mesh.precision(),
            vertices: mesh.positions().len(),
            triangles: mesh.triangles().len(),
            wedges: mesh.attributes().wedge_count(),
            channels: mesh
                .attributes()
                .channels()
                .iter()
                .map(|c| c.kind)
                .collect(),
            customs: (mesh.materials().asset.as_ref()).map_or_else(Vec::new, |a| a.customs.clone()),
            materials: names.iter().cloned().zip(counts).collect(),
            libraries: mesh.materials().libraries.clone(),
            notes: loaded.notes.clone(),
        }
    }

    /// The summary as lines of text.
    #[must_use]
    pub fn report(&self) -> String {
        let encoding = match self.encoding {
            Encoding::Gltf | Encoding::Obj | Encoding::PlyAscii | Encoding::StlAscii => "text",
            Encoding::Glb | Encoding::PlyLittleEndian | Encoding::StlBinary => {
                "little-endian binary"
            }
            Encoding::PlyBigEndian => "big-endian binary",
        };
        let bits = match self.precision {
            Precision::F32 => 32,
            Precision::F64 => 64,
        };
        let mut text = format!(
            "format              {}, {encoding}, {bits}-bit coordinates\nvertices            {}\ntriangles           {}\n",
            self.format, self.vertices, self.triangles
        );
        // Writing to a String cannot fail.
        for kind in &self.channels {
            let custom = match kind {
                ChannelKind::Custom { number, .. } => self.customs.get(usize::from(*number)),
                _ => None,
            };
            let name = custom.cloned().unwrap_or_else(|| per_vertex::name(*kind));
            let _ = writeln!(text, "attribute           {name}");
        }
        if !self.channels.is_empty() {
            let _ = writeln!(text, "wedges              {}", self.wedges);
        }
        let word = match self.format {
            Format::Glb | Format::Gltf => "part    ",
            Format::Obj | Format::Ply | Format::Stl => "material",
        };
        for (name, count) in &self.materials {
            let _ = writeln!(text, "{word}            {name}: {count} triangles");
        }
        for library in &self.libraries {
            let _ = writeln!(text, "material library    {library}");
        }
        for note in &self.notes {
            let _ = writeln!(text, "note: {note}");
        }
        text
    }
}
