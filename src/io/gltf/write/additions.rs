//! Additions to a document, after everything that it has: new views with their bytes, and new accessors.

use super::json;
use crate::io::gltf::accessor::Component;

/// The storage of an accessor's elements.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Storage {
    pub component: Component,
    /// Whether integers stand for numbers in [0, 1] or [-1, 1].
    pub normalized: bool,
    /// Components of an element: 1 to 4.
    pub width: usize,
}

/// Uses of a view: by vertices, by indices.
const VERTICES: usize = 34962;
const INDICES: usize = 34963;

impl Storage {
    pub(super) const fn floats(width: usize) -> Self {
        Self {
            component: Component::F32,
            normalized: false,
            width,
        }
    }

    fn push(self, value: f64, bytes: &mut Vec<u8>) {
        let scale = if self.normalized {
            self.component.one()
        } else {
            1.0
        };
        // `as` ends at the least and the greatest number of the type.
        let whole = (value * scale).round();
        match self.component {
            Component::I8 => bytes.extend((whole as i8).to_le_bytes()),
            Component::U8 => bytes.push(whole as u8),
            Component::I16 => bytes.extend((whole as i16).to_le_bytes()),
            Component::U16 => bytes.extend((whole as u16).to_le_bytes()),
            Component::U32 => bytes.extend((whole as u32).to_le_bytes()),
            Component::F32 => bytes.extend((value as f32).to_le_bytes()),
        }
    }
}

/// A view and what is in it; where it begins is found out last.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct NewView {
    pub bytes: Vec<u8>,
    pub stride: Option<usize>,
    pub target: Option<usize>,
}

/// Views and accessors to append to a document: nothing that it has gets another number.
#[derive(Clone, Debug, Default)]
pub(super) struct Additions {
    first_view: usize,
    first_accessor: usize,
    pub views: Vec<NewView>,
    pub accessors: Vec<String>,
}

impl Additions {
    /// Additions to a document with so many views and accessors.
    pub(super) fn to(views: usize, accessors: usize) -> Self {
        Self {
            first_view: views,
            first_accessor: accessors,
            ..Self::default()
        }
    }

    /// Appends a view; its number.
    pub(super) fn view(&mut self, view: NewView) -> usize {
        self.views.push(view);
        self.first_view + self.views.len() - 1
    }

    /// Appends an accessor with one element a vertex, and its bounds where asked; its number.
    pub(super) fn vertices(&mut self, storage: Storage, values: &[f64], bounded: bool) -> usize {
        let tight = storage.width * storage.component.size();
        let stride = tight.next_multiple_of(4);
        let mut bytes = Vec::with_capacity(values.len() / storage.width * stride);
        for element in values.chunks(storage.width) {
            for &value in element {
                storage.push(value, &mut bytes);
            }
            bytes.resize(bytes.len().next_multiple_of(4), 0);
        }
        let view = self.view(NewView {
            bytes,
            stride: (stride != tight).then_some(stride),
            target: Some(VERTICES),
        });
        let bounds = bounded.then(|| bounds(storage.width, values));
        let shape = ["SCALAR", "VEC2", "VEC3", "VEC4"][storage.width.clamp(1, 4) - 1];
        self.accessor(
            view,
            storage,
            values.len() / storage.width,
            shape,
            bounds.unwrap_or_default(),
        )
    }

    /// Appends the vertices of triangles; the number of the accessor. 65,535 is a sign of its own in 16 bits.
    pub(super) fn indices(&mut self, triangles: &[[u32; 3]], vertices: usize) -> usize {
        let component = if vertices <= usize::from(u16::MAX) {
            Component::U16
        } else {
            Component::U32
        };
        let storage = Storage {
            component,
            normalized: false,
            width: 1,
        };
        let mut bytes = Vec::with_capacity(triangles.len() * 3 * storage.component.size());
        for &index in triangles.as_flattened() {
            storage.push(f64::from(index), &mut bytes);
        }
        let view = self.view(NewView {
            bytes,
            stride: None,
            target: Some(INDICES),
        });
        let count = 3 * triangles.len();
        self.accessor(view, storage, count, "SCALAR", String::new())
    }

    fn accessor(
        &mut self,
        view: usize,
        storage: Storage,
        count: usize,
        shape: &str,
        bounds: String,
    ) -> usize {
        let normalized = if storage.normalized {
            r#","normalized":true"#
        } else {
            ""
        };
        self.accessors.push(format!(
            r#"{{"bufferView":{view},"componentType":{}{normalized},"count":{count},"type":"{shape}"{bounds}}}"#,
            code(storage.component)
        ));
        self.first_accessor + self.accessors.len() - 1
    }
}

/// `,"min":[..],"max":[..]` of values as f32 holds them.
fn bounds(width: usize, values: &[f64]) -> String {
    let of = |pick: fn(f32, f32) -> f32| {
        let least = (0..width).map(|k| {
            let column = values.iter().skip(k).step_by(width);
            let found = column.map(|&x| x as f32).reduce(pick);
            // A float is a number of JSON as f64 writes it: the same bits come back.
            serde_json::Value::from(f64::from(found.unwrap_or_default())).to_string()
        });
        json::array(&least.collect::<Vec<_>>())
    };
    format!(r#","min":{},"max":{}"#, of(f32::min), of(f32::max))
}

/// The number that glTF gives a type of components.
const fn code(component: Component) -> u32 {
    match component {
        Component::I8 => 5120,
        Component::U8 => 5121,
        Component::I16 => 5122,
        Component::U16 => 5123,
        Component::U32 => 5125,
        Component::F32 => 5126,
    }
}
