//! Writes PLY, text and binary.
//!
//! Attributes are per vertex; where texture coordinates differ between the corners of a vertex they become the face
//! property `texcoord`, as MeshLab writes it, and where normals or colours do, the vertex is stored once for each of their
//! values, which welding undoes. Colours are `uchar` where every value is a multiple of 1/255.

use std::{collections::BTreeMap, fmt::Write};

use crate::{
    io::{decimal, per_vertex, per_vertex::PerVertex},
    mesh::{Channel, ChannelKind, Mesh},
    num::Precision,
};

/// Storage of the numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::rooms::io) enum Numbers {
    Text,
    LittleEndian,
    BigEndian,
}

pub(in crate::rooms::io) fn encode(mesh: &Mesh, numbers: Numbers) -> (Vec<u8>, Vec<String>) {
    let plan = Plan::of(mesh);
    let mut notes = plan.notes(mesh);
    let mut sink = Sink {
        bytes: plan.header(mesh, numbers).into_bytes(),
        numbers,
        precision: mesh.precision(),
        fresh: true,
    };
    let attributes = mesh.attributes();
    let mut absent = 0_usize;
    for &(v, wedge) in &plan.vertices {
        for x in mesh.positions()[v as usize].to_array() {
            sink.real(x);
        }
        for &channel in &plan.vertex_channels {
            // A vertex without triangles has no attributes that anyone could miss.
            let zeros = [0.0; 4];
            let values = match wedge {
                Some(wedge) => attributes.value(channel, wedge),
                None => &zeros[..channel.kind.width()],
            };
            absent += usize::from(values.iter().any(|x| x.is_nan()));
            for &x in values {
                if plan.byte_colours && is_colour(channel.kind) {
                    sink.byte((x * 255.0).round() as u8);
                } else {
                    sink.real(x);
                }
            }
        }
        sink.end_of_line();
    }
    for (t, corners) in plan.triangles.iter().enumerate() {
        sink.byte(3);
        for &v in corners {
            sink.index(v);
        }
        if let Some(channel) = plan.corner_uv {
            sink.byte(6);
            for &wedge in &attributes.corners()[t] {
                let values = attributes.value(channel, wedge);
                absent += usize::from(values.iter().any(|x| x.is_nan()));
                for &x in values {
                    sink.real(x);
                }
            }
        }
        sink.end_of_line();
    }
    if absent > 0 {
        notes.push(format!(
            "PLY has no sign for an absent attribute: {absent} of them are stored as NaN; programs other than this one \
             may stumble over that"
        ));
    }
    (sink.bytes, notes)
}

const fn is_colour(kind: ChannelKind) -> bool {
    matches!(kind, ChannelKind::Color | ChannelKind::ColorAlpha)
}

/// The place of a stored vertex among those of the mesh, and the corner that it has its values from.
type StoredVertex = (u32, Option<u32>);

/// Where every channel goes.
struct Plan {
    per_vertex: PerVertex,
    /// The vertices as they are stored.
    vertices: Vec<StoredVertex>,
    /// The triangles, in stored vertices.
    triangles: Vec<[u32; 3]>,
    vertex_channels: Vec<Channel>,
    corner_uv: Option<Channel>,
    byte_colours: bool,
}

impl Plan {
    fn of(mesh: &Mesh) -> Self {
        let attributes = mesh.attributes();
        let per_vertex = PerVertex::of(mesh);
        let corner_uv = attributes
            .channel(ChannelKind::TexCoord(0))
            .filter(|c| per_vertex.differing(c.kind) > 0);
        let vertex_channels: Vec<Channel> = attributes
            .channels()
            .iter()
            .copied()
            .filter(|&c| match c.kind {
                ChannelKind::TexCoord(0) => corner_uv.is_none(),
                ChannelKind::Normal | ChannelKind::Color | ChannelKind::ColorAlpha => true,
                _ => false,
            })
            .collect();
        let byte_colours = vertex_channels
            .iter()
            .filter(|c| is_colour(c.kind))
            .all(|&channel| {
                (0..attributes.wedge_count() as u32).all(|wedge| {
                    attributes
                        .value(channel, wedge)
                        .iter()
                        .all(|&x| is_byte(x, mesh.precision()))
                })
            });
        let (vertices, triangles) = stored(mesh, &per_vertex, &vertex_channels);
        Self {
            per_vertex,
            vertices,
            triangles,
            vertex_channels,
            corner_uv,
            byte_colours,
        }
    }

    fn header(&self, mesh: &Mesh, numbers: Numbers) -> String {
        let storage = match numbers {
            Numbers::Text => "ascii",
            Numbers::LittleEndian => "binary_little_endian",
            Numbers::BigEndian => "binary_big_endian",
        };
        let real = match mesh.precision() {
            Precision::F32 => "float",
            Precision::F64 => "double",
        };
        let mut header = format!(
            "ply\nformat {storage} 1.0\ncomment written by lodmark\nelement vertex {}\n",
            self.vertices.len()
        );
        let mut property = |kind: &str, names: &[&str]| {
            for name in names {
                // Writing to a String cannot fail.
                let _ = writeln!(header, "property {kind} {name}");
            }
        };
        property(real, &["x", "y", "z"]);
        let colour = if self.byte_colours { "uchar" } else { real };
        for channel in &self.vertex_channels {
            match channel.kind {
                ChannelKind::Normal => property(real, &["nx", "ny", "nz"]),
                ChannelKind::TexCoord(_) => property(real, &["s", "t"]),
                ChannelKind::Color => property(colour, &["red", "green", "blue"]),
                ChannelKind::ColorAlpha => property(colour, &["red", "green", "blue", "alpha"]),
                _ => {}
            }
        }
        let _ = write!(
            header,
            "element face {}\nproperty list uchar int vertex_indices\n",
            mesh.triangles().len()
        );
        if self.corner_uv.is_some() {
            let _ = writeln!(header, "property list uchar {real} texcoord");
        }
        header + "end_header\n"
    }

    fn notes(&self, mesh: &Mesh) -> Vec<String> {
        let mut notes = Vec::new();
        if !mesh.materials().names.is_empty() {
            notes.push("PLY cannot keep materials; .obj can".into());
        }
        for channel in mesh.attributes().channels() {
            let kind = channel.kind;
            let differing = self.per_vertex.differing(kind);
            let name = per_vertex::name(kind);
            match kind {
                ChannelKind::TexCoord(0) => {}
                ChannelKind::Normal | ChannelKind::Color | ChannelKind::ColorAlpha => {
                    if differing > 0 {
                        notes.push(format!(
                            "PLY keeps one value per vertex: {name} differ between corners at {differing} vertices, \
                             which are stored once for each value"
                        ));
                    }
                }
                _ => notes.push(format!("PLY cannot keep {name}")),
            }
        }
        notes
    }
}

/// The stored vertices, and the triangles in them: those of the mesh, then one for each further value of the channels at a
/// vertex. O(corners log corners).
fn stored(
    mesh: &Mesh,
    per_vertex: &PerVertex,
    channels: &[Channel],
) -> (Vec<StoredVertex>, Vec<[u32; 3]>) {
    let mut vertices: Vec<_> = (0..).zip(per_vertex.wedges.iter().copied()).collect();
    let mut triangles = mesh.triangles().to_vec();
    let differing = channels.iter().copied();
    let differing: Vec<_> = differing
        .filter(|c| per_vertex.differing(c.kind) > 0)
        .collect();
    if differing.is_empty() {
        return (vertices, triangles);
    }
    let attributes = mesh.attributes();
    let key = |wedge: u32| -> Vec<u64> {
        let values = differing.iter().flat_map(|&c| attributes.value(c, wedge));
        values.map(|x| x.to_bits()).collect()
    };
    let mut further = BTreeMap::new();
    for (corners, wedges) in triangles.iter_mut().zip(attributes.corners()) {
        for (corner, &wedge) in corners.iter_mut().zip(wedges) {
            let (v, first) = vertices[*corner as usize];
            let wanted = key(wedge);
            if first.is_some_and(|first| first == wedge || key(first) == wanted) {
                continue;
            }
            *corner = *further.entry((v, wanted)).or_insert_with(|| {
                vertices.push((v, Some(wedge)));
                vertices.len() as u32 - 1
            });
        }
    }
    (vertices, triangles)
}

/// Whether `x` is what a reader makes of a byte.
fn is_byte(x: f64, precision: Precision) -> bool {
    let byte = (x * 255.0).round();
    // -0 is not what a byte reads back as.
    x.is_sign_positive() && byte <= 255.0 && precision.round(byte / 255.0).to_bits() == x.to_bits()
}

struct Sink {
    bytes: Vec<u8>,
    numbers: Numbers,
    precision: Precision,
    /// True at the start of a line of text.
    fresh: bool,
}

impl Sink {
    fn separate(&mut self) {
        if !std::mem::take(&mut self.fresh) {
            self.bytes.push(b' ');
        }
    }

    fn real(&mut self, x: f64) {
        let big = self.numbers == Numbers::BigEndian;
        match (self.numbers, self.precision) {
            (Numbers::Text, _) => {
                self.separate();
                decimal::push(&mut self.bytes, x, self.precision);
            }
            (_, Precision::F32) => self.packed((x as f32).to_le_bytes(), big),
            (_, Precision::F64) => self.packed(x.to_le_bytes(), big),
        }
    }

    fn byte(&mut self, x: u8) {
        if self.numbers == Numbers::Text {
            self.separate();
            self.bytes.extend_from_slice(x.to_string().as_bytes());
        } else {
            self.bytes.push(x);
        }
    }

    fn index(&mut self, x: u32) {
        if self.numbers == Numbers::Text {
            self.separate();
            self.bytes.extend_from_slice(x.to_string().as_bytes());
        } else {
            self.packed(x.to_le_bytes(), self.numbers == Numbers::BigEndian);
        }
    }

    fn packed<const N: usize>(&mut self, mut little: [u8; N], big: bool) {
        if big {
            little.reverse();
        }
        self.bytes.extend_from_slice(&little);
    }

    fn end_of_line(&mut self) {
        if self.numbers == Numbers::Text {
            self.bytes.push(b'\n');
            self.fresh = true;
        }
    }
}
