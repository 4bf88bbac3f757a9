//! Writes Wavefront OBJ.
//!
//! Normals and texture coordinates are listed once each, in the order of their first use. Triangles keep their order:
//! a material that comes up again is named again. A comment tells the precision, which decimals do not.

use std::{cmp::Ordering, collections::BTreeMap, io::Write};

use super::normal_form::PRECISION;
use crate::{
    io::{decimal, per_vertex, per_vertex::PerVertex},
    mesh::{Channel, ChannelKind, Materials, Mesh, compare_rows, group_equal},
    num::Precision,
};

pub(in crate::rooms::io) fn encode(mesh: &Mesh) -> (Vec<u8>, Vec<String>) {
    let attributes = mesh.attributes();
    let per_vertex = PerVertex::of(mesh);
    let mut notes = notes(mesh, &per_vertex);
    let precision = mesh.precision();
    let mut text = PRECISION.as_bytes().to_vec();
    text.extend_from_slice(match precision {
        Precision::F32 => b"f32\n",
        Precision::F64 => b"f64\n",
    });
    for library in &mesh.materials().libraries {
        push_name(&mut text, "mtllib", library);
    }
    let color = attributes
        .channel(ChannelKind::ColorAlpha)
        .or(attributes.channel(ChannelKind::Color));
    for (v, p) in mesh.positions().iter().enumerate() {
        text.push(b'v');
        push_numbers(&mut text, &p.to_array(), precision);
        if let Some((channel, wedge)) = color.zip(per_vertex.wedges[v]) {
            let values = attributes.value(channel, wedge);
            if !values.iter().any(|x| x.is_nan()) {
                push_numbers(&mut text, &values[..3], precision);
            }
        }
        text.push(b'\n');
    }
    let uvs = Listed::write(&mut text, mesh, ChannelKind::TexCoord(0), "vt");
    let normals = Listed::write(&mut text, mesh, ChannelKind::Normal, "vn");
    let (names, unnamed) = names(mesh, &mut notes);
    let mut current = Materials::NONE;
    for (t, corners) in mesh.triangles().iter().enumerate() {
        let material = mesh.materials().of(t);
        if material != current {
            let name = names.get(material as usize).unwrap_or(&unnamed);
            push_name(&mut text, "usemtl", name);
            current = material;
        }
        text.push(b'f');
        for (corner, &v) in corners.iter().enumerate() {
            let at = |listed: &Listed| listed.index(mesh, t, corner);
            // Writing to a Vec cannot fail.
            let _ = match (at(&uvs), at(&normals)) {
                (None, None) => write!(text, " {}", v + 1),
                (Some(vt), None) => write!(text, " {}/{vt}", v + 1),
                (None, Some(vn)) => write!(text, " {}//{vn}", v + 1),
                (Some(vt), Some(vn)) => write!(text, " {}/{vt}/{vn}", v + 1),
            };
        }
        text.push(b'\n');
    }
    (text, notes)
}

fn notes(mesh: &Mesh, per_vertex: &PerVertex) -> Vec<String> {
    let mut notes = Vec::new();
    for channel in mesh.attributes().channels() {
        let (name, differing) = (
            per_vertex::name(channel.kind),
            per_vertex.differing(channel.kind),
        );
        match channel.kind {
            ChannelKind::Normal | ChannelKind::TexCoord(0) => {}
            ChannelKind::ColorAlpha => notes.push("OBJ cannot keep the opacity of colours".into()),
            ChannelKind::Color => {}
            _ => notes.push(format!("OBJ cannot keep {name}")),
        }
        if matches!(channel.kind, ChannelKind::Color | ChannelKind::ColorAlpha) && differing > 0 {
            notes.push(format!(
                "OBJ keeps one colour per vertex: {name} differ between corners at {differing} vertices, the first is \
                 kept there"
            ));
        }
    }
    notes
}

fn push_numbers(text: &mut Vec<u8>, numbers: &[f64], precision: Precision) {
    for &x in numbers {
        text.push(b' ');
        decimal::push(text, x, precision);
    }
}

fn push_name(text: &mut Vec<u8>, keyword: &str, name: &str) {
    text.extend_from_slice(keyword.as_bytes());
    text.push(b' ');
    text.extend_from_slice(name.as_bytes());
    text.push(b'\n');
}

/// The names of the materials as they are written, and one for triangles without.
fn names(mesh: &Mesh, notes: &mut Vec<String>) -> (Vec<String>, String) {
    let mut taken: BTreeMap<String, usize> = BTreeMap::new();
    let mut changed = 0_usize;
    let names: Vec<String> = mesh
        .materials()
        .names
        .iter()
        .enumerate()
        .map(|(i, name)| {
            let cleaned: String = name
                .trim()
                .chars()
                .map(|c| if c.is_control() { '_' } else { c })
                .collect();
            let mut unique = cleaned.trim_end_matches('\\').to_string();
            while unique.is_empty() || taken.contains_key(&unique) {
                unique.push('_');
            }
            changed += usize::from(unique != *name);
            taken.insert(unique.clone(), i);
            unique
        })
        .collect();
    if changed > 0 {
        notes.push(format!(
            "{changed} material names are empty, double, or cannot stand in a line of OBJ: they are written otherwise"
        ));
    }
    let mut unnamed = "none".to_string();
    while taken.contains_key(&unnamed) {
        unnamed.push('_');
    }
    let of = &mesh.materials().of_triangle;
    let first_named = of.iter().position(|&m| m != Materials::NONE);
    let lost = first_named.map_or(0, |first| {
        of[first..]
            .iter()
            .filter(|&&m| m == Materials::NONE)
            .count()
    });
    if lost > 0 {
        notes.push(format!(
            "OBJ has no way back to no material: {lost} triangles without one get the material `{unnamed}`"
        ));
    }
    (names, unnamed)
}

/// The different values of a channel, and which one every wedge has.
struct Listed {
    channel: Option<Channel>,
    of_wedge: Vec<u32>,
}

impl Listed {
    const ABSENT: u32 = u32::MAX;

    /// Writes the different values in the order of their first use.
    fn write(text: &mut Vec<u8>, mesh: &Mesh, kind: ChannelKind, keyword: &str) -> Self {
        let attributes = mesh.attributes();
        let Some(channel) = attributes.channel(kind) else {
            return Self {
                channel: None,
                of_wedge: Vec::new(),
            };
        };
        let wedges: Vec<u32> = attributes.corners().as_flattened().to_vec();
        let united = group_equal(wedges.len(), &|a, b| {
            if wedges[a] == wedges[b] {
                return Ordering::Equal;
            }
            compare_rows(
                attributes.value(channel, wedges[a]),
                attributes.value(channel, wedges[b]),
            )
        });
        let mut numbers = Vec::with_capacity(united.firsts.len());
        let mut next = 0;
        for &first in &united.firsts {
            let values = attributes.value(channel, wedges[first]);
            if values.iter().any(|x| x.is_nan()) {
                numbers.push(Self::ABSENT);
                continue;
            }
            text.extend_from_slice(keyword.as_bytes());
            push_numbers(text, values, mesh.precision());
            text.push(b'\n');
            next += 1;
            numbers.push(next);
        }
        let mut of_wedge = vec![Self::ABSENT; attributes.wedge_count()];
        for (&wedge, &group) in wedges.iter().zip(&united.groups) {
            of_wedge[wedge as usize] = numbers[group as usize];
        }
        Self {
            channel: Some(channel),
            of_wedge,
        }
    }

    /// The number, from 1, of the value at a corner.
    fn index(&self, mesh: &Mesh, triangle: usize, corner: usize) -> Option<u32> {
        self.channel?;
        let wedge = mesh.attributes().corners()[triangle][corner];
        Some(self.of_wedge[wedge as usize]).filter(|&i| i != Self::ABSENT)
    }
}
