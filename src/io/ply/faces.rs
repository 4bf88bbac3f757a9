//! The faces of a PLY body: triangles, and texture coordinates of their corners.

use super::{
    errors,
    header::{Element, Scalar, Shape},
    numbers::{Fault, Source},
    read::Reader,
};
use crate::{
    Result,
    io::attribute_rows,
    mesh::{Attributes, ChannelKind, compare_rows, group_equal},
    num::Each,
};

/// The properties of a face that are kept, by their index.
struct Lists {
    corners: usize,
    uvs: Option<usize>,
}

/// A face as it is read.
#[derive(Default)]
struct Polygon {
    corners: Vec<u32>,
    uvs: Vec<f64>,
}

impl<S: Source> Reader<S> {
    /// Reads the faces; `vertices` is the number of vertices that the header declares.
    pub(super) fn faces(&mut self, element: &Element, vertices: u64) -> Result<(), String> {
        let Some(lists) = self.lists(element)? else {
            return Ok(());
        };
        // Every face takes at least a byte: bounded by the size of the file.
        let expected = (element.count as usize).min(self.bytes_total);
        self.triangles.reserve(expected);
        if lists.uvs.is_some() {
            self.corner_uvs.reserve(expected);
        }
        let mut polygon = Polygon::default();
        for item in 0..element.count {
            self.face(element, item, &lists, vertices, &mut polygon)?;
            let Polygon { corners, uvs } = &polygon;
            if !uvs.is_empty() && uvs.len() != 2 * corners.len() {
                let sizes = (corners.len(), uvs.len());
                return Err(errors::uneven_uvs(&self.source, item, sizes.0, sizes.1));
            }
            self.fan(corners, uvs, lists.uvs.is_some());
        }
        Ok(())
    }

    /// Finds the lists that are kept; `None` where there are no faces.
    fn lists(&mut self, element: &Element) -> Result<Option<Lists>, String> {
        let (mut corners, mut uvs) = (None, None);
        for (i, property) in element.properties.iter().enumerate() {
            match (property.name.as_str(), property.shape) {
                ("vertex_indices" | "vertex_index", Shape::List { .. }) if corners.is_none() => {
                    corners = Some(i);
                }
                ("texcoord", Shape::List { .. }) if uvs.is_none() => uvs = Some(i),
                (name, _) => self
                    .notes
                    .push(format!("the face property `{name}` is not kept")),
            }
        }
        match corners {
            Some(corners) => Ok(Some(Lists { corners, uvs })),
            None if element.count == 0 => Ok(None),
            None => Err(errors::NO_CORNERS.into()),
        }
    }

    /// Reads the face number `item`.
    fn face(
        &mut self,
        element: &Element,
        item: u64,
        lists: &Lists,
        vertices: u64,
        polygon: &mut Polygon,
    ) -> Result<(), String> {
        polygon.corners.clear();
        polygon.uvs.clear();
        for (i, property) in element.properties.iter().enumerate() {
            let read = match property.shape {
                Shape::Scalar(kind) => self.source.skip(kind, 1),
                Shape::List { count, item: kind } if i == lists.corners => {
                    match self.corners(count, kind, vertices, &mut polygon.corners) {
                        Ok(None) => Ok(()),
                        Ok(Some(x)) => {
                            return Err(errors::no_such_vertex(&self.source, item, x, vertices));
                        }
                        Err(fault) => Err(fault),
                    }
                }
                Shape::List { count, item: kind } if Some(i) == lists.uvs => {
                    self.numbers(count, kind, &mut polygon.uvs)
                }
                Shape::List { count, item: kind } => self.skip_list(count, kind),
            };
            read.map_err(|fault| {
                errors::no_number(&self.source, fault, element, item, &property.name)
            })?;
        }
        Ok(())
    }

    /// Reads a list of vertices, and answers the first number that is none.
    fn corners(
        &mut self,
        count: Scalar,
        kind: Scalar,
        vertices: u64,
        corners: &mut Vec<u32>,
    ) -> Result<Option<f64>, Fault> {
        for _ in 0..self.list_length(count, kind)? {
            let x = self.source.number(kind)?;
            if !(x >= 0.0 && x < vertices as f64 && x.fract() == 0.0) {
                return Ok(Some(x));
            }
            corners.push(x as u32);
        }
        Ok(None)
    }

    /// Reads a list of numbers.
    fn numbers(&mut self, count: Scalar, kind: Scalar, into: &mut Vec<f64>) -> Result<(), Fault> {
        for _ in 0..self.list_length(count, kind)? {
            into.push(self.source.number(kind)?);
        }
        Ok(())
    }

    /// Splits a polygon into triangles around its first corner.
    fn fan(&mut self, corners: &[u32], uvs: &[f64], keep_uvs: bool) {
        self.slivers += u64::from(corners.len() < 3);
        for i in 1..corners.len().saturating_sub(1) {
            self.triangles
                .push([corners[0], corners[i], corners[i + 1]]);
            if keep_uvs {
                self.corner_uvs.push([0, i, i + 1].each(|corner| {
                    match uvs.get(2 * corner..2 * corner + 2) {
                        Some(uv) => [uv[0], uv[1]],
                        None => [f64::NAN; 2],
                    }
                }));
            }
        }
    }

    /// The attributes of all corners: those of the vertices, and texture coordinates of the faces instead of theirs.
    pub(super) fn attributes(&mut self) -> Result<Attributes> {
        let precision = self.precision;
        attribute_rows::settle(&mut self.rows, &self.kinds, precision);
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
                attribute_rows::settle(&mut uv, &[ChannelKind::TexCoord(0)], precision);
                uv
            })
            .collect();
        let vertices: &[u32] = self.triangles.as_flattened();
        let united = group_equal(uvs.len(), &|a, b| {
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
