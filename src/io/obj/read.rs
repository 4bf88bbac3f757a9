//! Reads Wavefront OBJ through the `tobj` crate, on the normal form that [`super::normal_form`] makes.
//!
//! `tobj` numbers vertices in the order of their first use; a polygon through all of them, put before the faces, makes
//! that the order of the file, with the vertices that no face uses. Polygons become fans around their first corner.
//!
//! Text does not say its precision. A file of ours tells it in a comment; otherwise coordinates are 32-bit floats
//! where rounding moves each by less than 2^-20 of the bounding box diagonal, and 64-bit floats where it does not.

use std::io::{BufRead, Read, Write};

use glam::DVec3;
use tobj::{LoadError, LoadOptions};

use super::{
    lines,
    normal_form::{self, Scan},
};
use crate::{
    Error,
    io::{Encoding, Loaded, attribute_rows, words::shown},
    mesh::{Attributes, ChannelKind, Mesh, MeshParts, group_equal},
    num::{Each, Frame, Precision, math},
};

pub(in crate::rooms::io) fn read(bytes: &[u8]) -> Result<Loaded, String> {
    let scan = normal_form::scan(bytes)?;
    let parsed = parse(&scan).map_err(|error| {
        let place = first_bad_number(bytes, Precision::F64);
        place.unwrap_or_else(|| format!("{error}; expected the vertices and faces of an OBJ mesh"))
    })?;
    let precision = precision(&scan, &parsed);
    if let Some(bad) = parsed
        .positions
        .iter()
        .position(|&p| !precision.round_vector(p).is_finite())
    {
        return Err(first_bad_number(bytes, precision)
            .unwrap_or_else(|| format!("vertex {} is not finite", bad + 1)));
    }
    let mesh = assemble(&scan, parsed, precision)
        .map_err(|message| first_bad_number(bytes, precision).unwrap_or(message))?;
    Ok(Loaded {
        mesh,
        encoding: Encoding::Obj,
        notes: scan.notes,
    })
}

/// The numbers that `tobj` reads: values in the order of the file, and three corners (v, vt, vn) per triangle. The first texture
/// coordinate and the first normal are NaN.
struct Parsed {
    positions: Vec<DVec3>,
    texcoords: Vec<f64>,
    normals: Vec<f64>,
    corners: Vec<[u32; 3]>,
}

fn parse(scan: &Scan) -> Result<Parsed, String> {
    if scan.counts[0] == 0 {
        // No face can name a vertex, and no polygon can be put before the faces.
        return Ok(Parsed {
            positions: Vec::new(),
            texcoords: Vec::new(),
            normals: Vec::new(),
            corners: Vec::new(),
        });
    }
    let [v, vt, vn] = [scan.counts[0], scan.counts[1] + 1, scan.counts[2] + 1];
    let corners = v.max(vt).max(vn).max(3);
    let mut polygon = b"f".to_vec();
    for i in 1..=corners {
        // Writing to a Vec cannot fail.
        let _ = write!(polygon, " {}/{}/{}", i.min(v), i.min(vt), i.min(vn));
    }
    polygon.push(b'\n');
    let mut text = (&scan.vertex_text[..])
        .chain(&polygon[..])
        .chain(&scan.face_text[..]);
    let mesh = load(&mut text)?;
    let skipped = 3 * (corners - 2);
    let sizes = [
        mesh.positions.len(),
        mesh.texcoords.len(),
        mesh.normals.len(),
        mesh.indices.len(),
        mesh.texcoord_indices.len(),
        mesh.normal_indices.len(),
    ];
    let every = skipped + 3 * scan.triangles;
    if sizes != [3 * v, 2 * vt, 3 * vn, every, every, every] {
        return Err("the vertices and faces cannot be told apart".into());
    }
    Ok(Parsed {
        positions: mesh
            .positions
            .chunks_exact(3)
            .map(|p| DVec3::new(p[0], p[1], p[2]))
            .collect(),
        corners: mesh.indices[skipped..]
            .iter()
            .zip(&mesh.texcoord_indices[skipped..])
            .zip(&mesh.normal_indices[skipped..])
            .map(|((&v, &vt), &vn)| [v, vt, vn])
            .collect(),
        texcoords: mesh.texcoords,
        normals: mesh.normals,
    })
}

fn load(text: &mut impl BufRead) -> Result<tobj::Mesh, String> {
    let options = LoadOptions {
        single_index: false,
        triangulate: true,
        ignore_points: true,
        ignore_lines: true,
    };
    // The normal form names no material library.
    let (models, _) = tobj::load_obj_buf(text, &options, |_| Err(LoadError::OpenFileFailed))
        .map_err(|error| error.to_string())?;
    match <[tobj::Model; 1]>::try_from(models) {
        Ok([model]) => Ok(model.mesh),
        Err(models) => Err(format!("{} models instead of one", models.len())),
    }
}

/// Where a number of the text is none, or not finite; `tobj` does not tell.
fn first_bad_number(bytes: &[u8], precision: Precision) -> Option<String> {
    for (line, text) in lines::lines(bytes) {
        let (kind, rest) = lines::keyword(&text);
        let (numbers, may_be_nan) = match kind {
            b"v" => (4, false),
            b"vt" => (2, true),
            b"vn" => (3, true),
            _ => continue,
        };
        let words: Vec<&[u8]> = lines::words(rest).collect();
        // The fourth of six numbers is a colour.
        let numbers = if words.len() > 4 { 3 } else { numbers };
        for (i, word) in words.into_iter().take(numbers).enumerate() {
            let found = shown(word);
            match lines::float(word) {
                None => return Some(format!("line {line}: found `{found}`; expected a number")),
                Some(w) if i == 3 && w == 0.0 => {
                    return Some(format!(
                        "line {line}: the weight of a vertex is 0; expected another number"
                    ));
                }
                Some(x) if may_be_nan && x.is_nan() => {}
                Some(x) if !precision.round(x).is_finite() => {
                    return Some(format!(
                        "line {line}: found `{found}`; expected a finite number"
                    ));
                }
                Some(_) => {}
            }
        }
    }
    None
}

fn precision(scan: &Scan, parsed: &Parsed) -> Precision {
    if let Some(told) = scan.precision {
        return told;
    }
    let narrow = |x: f64| Precision::F32.round(x).is_finite() || !x.is_finite();
    let values = [&parsed.texcoords[..], &parsed.normals[..]];
    if !values.into_iter().flatten().all(|&x| narrow(x))
        || !scan.colors.as_flattened().iter().all(|&x| narrow(x))
    {
        return Precision::F64;
    }
    let Some(&first) = parsed.positions.first() else {
        return Precision::F32;
    };
    let (mut low, mut high, mut moved) = (first, first, 0.0_f64);
    for &p in &parsed.positions {
        (low, high) = (low.min(p), high.max(p));
        let step = (Precision::F32.round_vector(p) - p).abs().max_element();
        moved = moved.max(step);
    }
    // In a frame of size 1 the squares neither overflow nor vanish.
    let extent = high * 0.5 - low * 0.5;
    let frame = Frame::for_size(extent.max_element());
    let diagonal = 2.0 * frame.leave_length(math::length(frame.enter(extent)), 1);
    if moved == 0.0 || moved < diagonal / 1_048_576.0 {
        Precision::F32
    } else {
        Precision::F64
    }
}

fn assemble(scan: &Scan, parsed: Parsed, precision: Precision) -> Result<Mesh, String> {
    let Parsed {
        positions,
        texcoords,
        normals,
        corners,
    } = parsed;
    let [uses_uvs, uses_normals] = scan.uses;
    let mut kinds = Vec::new();
    if uses_normals {
        kinds.push(ChannelKind::Normal);
    }
    if uses_uvs {
        kinds.push(ChannelKind::TexCoord(0));
    }
    if !scan.colors.is_empty() {
        kinds.push(ChannelKind::Color);
    }
    let mut attributes = Attributes::default();
    if !kinds.is_empty() {
        let united = group_equal(corners.len(), &|a, b| corners[a].cmp(&corners[b]));
        let mut values = Vec::new();
        for &corner in &united.firsts {
            let [v, vt, vn] = corners[corner].each(|i| i as usize);
            if uses_normals {
                values.extend(&normals[3 * vn..3 * vn + 3]);
            }
            if uses_uvs {
                values.extend(&texcoords[2 * vt..2 * vt + 2]);
            }
            if !scan.colors.is_empty() {
                values.extend(&scan.colors[v]);
            }
        }
        attribute_rows::settle(&mut values, &kinds, precision);
        let (corners, _) = united.groups.as_chunks::<3>();
        attributes = Attributes::new(&kinds, values, corners.to_vec()).map_err(Error::message)?;
    }
    let (corners, _) = corners.as_chunks::<3>();
    Mesh::new(MeshParts {
        positions,
        triangles: corners.iter().map(|t| t.each(|[v, _, _]| v)).collect(),
        attributes,
        materials: scan.materials.clone(),
        precision,
    })
    .map_err(Error::message)
}
