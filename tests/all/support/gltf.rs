//! glTF documents made by hand.

use serde_json::{Value, json};

/// A document that grows accessor by accessor; `json` may be changed at will.
#[derive(Clone)]
pub(crate) struct GltfBuilder {
    pub(crate) json: Value,
    pub(crate) bin: Vec<u8>,
}

impl GltfBuilder {
    /// A document without anything to show.
    pub(crate) fn new() -> Self {
        let json = json!({
            "asset": {"version": "2.0", "copyright": "nobody"},
            "accessors": [], "bufferViews": [], "meshes": [], "nodes": [], "scenes": [{"nodes": []}], "scene": 0,
        });
        Self {
            json,
            bin: Vec::new(),
        }
    }

    /// Appends to a list of the document; the index of the new element.
    pub(crate) fn push(&mut self, list: &str, value: Value) -> usize {
        let list = self.json[list].as_array_mut().expect("a list");
        list.push(value);
        list.len() - 1
    }

    /// A view of new bytes, from a multiple of 4 on.
    pub(crate) fn view(&mut self, bytes: &[u8]) -> usize {
        self.bin.resize(self.bin.len().next_multiple_of(4), 0);
        let view = json!({"buffer": 0, "byteOffset": self.bin.len(), "byteLength": bytes.len()});
        self.bin.extend(bytes);
        self.push("bufferViews", view)
    }

    /// An accessor of floats.
    pub(crate) fn floats(&mut self, shape: &str, values: &[f32]) -> usize {
        let bytes: Vec<u8> = values.iter().flat_map(|x| x.to_le_bytes()).collect();
        let view = self.view(&bytes);
        let width = match shape {
            "VEC2" => 2,
            "VEC3" => 3,
            "VEC4" => 4,
            "MAT4" => 16,
            _ => 1,
        };
        self.push(
            "accessors",
            json!({"bufferView": view, "componentType": 5126, "count": values.len() / width, "type": shape}),
        )
    }

    /// An accessor of 16-bit indices.
    pub(crate) fn indices(&mut self, values: &[u16]) -> usize {
        let bytes: Vec<u8> = values.iter().flat_map(|x| x.to_le_bytes()).collect();
        let view = self.view(&bytes);
        self.push(
            "accessors",
            json!({"bufferView": view, "componentType": 5123, "count": values.len(), "type": "SCALAR"}),
        )
    }

    /// A mesh.
    pub(crate) fn mesh(&mut self, primitives: Value) -> usize {
        self.push("meshes", json!({"primitives": primitives}))
    }

    /// A node that the scene shows.
    pub(crate) fn node(&mut self, node: Value) -> usize {
        let node = self.push("nodes", node);
        let roots = self.json["scenes"][0]["nodes"]
            .as_array_mut()
            .expect("a list");
        roots.push(json!(node));
        node
    }

    /// The text, whose first buffer is the given one.
    pub(crate) fn text(&self, mut buffer: Value) -> String {
        let mut json = self.json.clone();
        if !self.bin.is_empty() {
            buffer["byteLength"] = json!(self.bin.len());
            json["buffers"] = json!([buffer]);
        }
        json.to_string()
    }

    /// The document as a GLB.
    pub(crate) fn glb(&self) -> Vec<u8> {
        let mut chunks = Vec::new();
        let mut text = self.text(json!({})).into_bytes();
        text.resize(text.len().next_multiple_of(4), b' ');
        let mut bin = self.bin.clone();
        bin.resize(bin.len().next_multiple_of(4), 0);
        for (kind, bytes) in [(b"JSON", text), (b"BIN\0", bin)] {
            chunks.extend((bytes.len() as u32).to_le_bytes());
            chunks.extend(kind);
            chunks.extend(bytes);
        }
        let mut file = b"glTF\x02\0\0\0".to_vec();
        file.extend((chunks.len() as u32 + 12).to_le_bytes());
        file.extend(chunks);
        file
    }
}
