//! glTF documents written by hand, and what is in documents.

use lodmark::mesh::{Asset, Mesh};
use serde_json::{Value, json};

pub(super) const U8: u32 = 5121;
pub(super) const U16: u32 = 5123;
pub(super) const F32: u32 = 5126;

/// A document in the making: its views and accessors.
#[derive(Default)]
pub(super) struct Builder {
    views: Vec<Value>,
    accessors: Vec<Value>,
    bytes: Vec<u8>,
}

impl Builder {
    pub(super) fn view(&mut self, bytes: &[u8]) -> usize {
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
        self.views.push(json!({
            "buffer": 0,
            "byteOffset": self.bytes.len(),
            "byteLength": bytes.len(),
        }));
        self.bytes.extend_from_slice(bytes);
        self.views.len() - 1
    }

    /// An accessor in a view of its own; normalized numbers are given as what they stand for.
    pub(super) fn add(
        &mut self,
        component: u32,
        shape: &str,
        normalized: bool,
        values: &[f64],
    ) -> usize {
        let mut bytes = Vec::new();
        for &x in values {
            let one = match (normalized, component) {
                (false, _) => 1.0,
                (true, U8) => 255.0,
                _ => 65535.0,
            };
            match component {
                U8 => bytes.push((x * one).round() as u8),
                U16 => bytes.extend(((x * one).round() as u16).to_le_bytes()),
                _ => bytes.extend((x as f32).to_le_bytes()),
            }
        }
        let width = width(shape);
        let mut entry = json!({
            "bufferView": self.view(&bytes),
            "componentType": component,
            "count": values.len() / width,
            "type": shape,
        });
        if normalized {
            entry["normalized"] = json!(true);
        }
        if shape == "VEC3" {
            let column = |k: usize| values.iter().copied().skip(k).step_by(3);
            let least = |k| column(k).fold(f64::INFINITY, f64::min);
            let greatest = |k| column(k).fold(f64::NEG_INFINITY, f64::max);
            entry["min"] = json!([least(0), least(1), least(2)]);
            entry["max"] = json!([greatest(0), greatest(1), greatest(2)]);
        }
        self.accessors.push(entry);
        self.accessors.len() - 1
    }

    /// The document as GLB.
    pub(super) fn finish(self, mut document: Value) -> Vec<u8> {
        document["accessors"] = json!(self.accessors);
        document["bufferViews"] = json!(self.views);
        document["buffers"] = json!([{ "byteLength": self.bytes.len() }]);
        glb(&document.to_string(), &self.bytes)
    }
}

/// The binary container.
pub(super) fn glb(text: &str, binary: &[u8]) -> Vec<u8> {
    let mut text = text.as_bytes().to_vec();
    text.resize(text.len().next_multiple_of(4), b' ');
    let mut binary = binary.to_vec();
    binary.resize(binary.len().next_multiple_of(4), 0);
    let word = |n: usize| (n as u32).to_le_bytes();
    let total = 12 + 8 + text.len() + 8 + binary.len();
    let header = [*b"glTF", word(2), word(total)].concat();
    let json = [&word(text.len()), &b"JSON"[..], &text].concat();
    let bin = [&word(binary.len()), &b"BIN\0"[..], &binary].concat();
    [header, json, bin].concat()
}

pub(super) fn asset(mesh: &Mesh) -> &Asset {
    mesh.materials().asset.as_ref().expect("a document")
}

/// A section as it is written.
pub(super) fn text_of<'a>(asset: &'a Asset, name: &str) -> Option<&'a str> {
    let found = asset.sections.iter().find(|(known, _)| known == name);
    found.map(|(_, text)| text.as_str())
}

/// A section, parsed.
pub(super) fn section(asset: &Asset, name: &str) -> Value {
    serde_json::from_str(text_of(asset, name).expect("the section")).expect("JSON")
}

/// An accessor, and its elements as they are stored: integers are not divided.
pub(super) struct Stored {
    pub entry: Value,
    pub elements: Vec<Vec<f64>>,
}

pub(super) fn accessor(asset: &Asset, index: &Value) -> Stored {
    let entry = section(asset, "accessors")[index.as_u64().expect("an index") as usize].clone();
    let number = |of: &Value, name: &str| of[name].as_u64().unwrap_or(0) as usize;
    let view = section(asset, "bufferViews")[number(&entry, "bufferView")].clone();
    let bytes = &asset.buffers[number(&view, "buffer")][number(&view, "byteOffset")..];
    let width = width(entry["type"].as_str().expect("a type"));
    let component = number(&entry, "componentType") as u32;
    let size = match component {
        U8 => 1,
        U16 => 2,
        _ => 4,
    };
    let stride = match number(&view, "byteStride") {
        0 => size * width,
        stride => stride,
    };
    let elements = (0..number(&entry, "count")).map(|i| {
        let element = &bytes[number(&entry, "byteOffset") + i * stride..][..size * width];
        let component = |raw: &[u8]| match component {
            U8 => f64::from(raw[0]),
            U16 => f64::from(u16::from_le_bytes([raw[0], raw[1]])),
            _ => f64::from(f32::from_le_bytes([raw[0], raw[1], raw[2], raw[3]])),
        };
        element.chunks(size).map(component).collect()
    });
    Stored {
        elements: elements.collect(),
        entry,
    }
}

fn width(shape: &str) -> usize {
    match shape {
        "SCALAR" => 1,
        "VEC2" => 2,
        "VEC3" => 3,
        _ => 4,
    }
}
