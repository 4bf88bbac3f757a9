//! Reads STL (3D Systems, 1988), text and binary.
//!
//! Our own reader instead of a crate: `stl_io` 0.11 takes a file for text exactly where it begins with `solid `, as
//! the headers of many binary files do, its errors have no place, and it writes no text. Here a file whose length is
//! what its binary count says is binary, whatever it begins with.
//!
//! STL has no shared vertices: every triangle gets three of its own, and welding unites them. Facets with more than
//! three corners (text only) become fans.

use glam::DVec3;

use crate::{
    Error,
    io::{
        Encoding, Loaded,
        words::{Words, shown},
    },
    mesh::Mesh,
    num::Each,
};

/// Bytes before the first triangle, and of every triangle.
const HEADER: usize = 84;
const RECORD: usize = 50;

/// The number of triangles that a binary file declares.
fn declared(bytes: &[u8]) -> Option<u32> {
    bytes
        .get(80..HEADER)?
        .first_chunk::<4>()
        .map(|raw| u32::from_le_bytes(*raw))
}

/// Whether the length is exactly that of a binary file.
pub(in crate::rooms::io) fn is_binary(bytes: &[u8]) -> bool {
    declared(bytes)
        .is_some_and(|n| HEADER as u64 + RECORD as u64 * u64::from(n) == bytes.len() as u64)
}

/// Whether the first words are those of a text file.
pub(in crate::rooms::io) fn is_ascii(bytes: &[u8]) -> bool {
    let mut words = Words::new(&bytes[..bytes.len().min(1024)], 0, 1);
    if !words.next_is("solid") {
        return false;
    }
    words.skip_line();
    let next = words.next().unwrap_or_default();
    next.eq_ignore_ascii_case(b"facet") || next.eq_ignore_ascii_case(b"endsolid")
}

pub(in crate::rooms::io) fn read(bytes: &[u8]) -> Result<Loaded, String> {
    let starts_solid = Words::new(bytes, 0, 1).next_is("solid");
    // A name, colours or nothing fill the header of a binary file, then follows the count: seldom all in letters.
    let is_text = bytes
        .iter()
        .take(HEADER)
        .all(|b| b.is_ascii_graphic() || b.is_ascii_whitespace());
    if is_binary(bytes) || (!starts_solid && !is_text && bytes.len() >= HEADER) {
        binary(bytes)
    } else if starts_solid {
        text(bytes)
    } else {
        Err(format!(
            "neither the text `solid` at the start nor a binary STL, whose length follows from the count at byte 80; \
             the file has {} bytes",
            bytes.len()
        ))
    }
}

fn binary(bytes: &[u8]) -> Result<Loaded, String> {
    let count = declared(bytes).unwrap_or_default();
    let body = &bytes[HEADER..];
    if (body.len() / RECORD) < count as usize {
        return Err(format!(
            "byte 80: {count} triangles declared, which take {} bytes, but {} follow; the file is cut off or its \
             header is wrong",
            u64::from(count) * RECORD as u64,
            body.len()
        ));
    }
    let mut positions = Vec::with_capacity(3 * count as usize);
    let mut tagged = 0_usize;
    for (t, record) in body.chunks_exact(RECORD).take(count as usize).enumerate() {
        let (floats, _) = record.as_chunks::<4>();
        let at = |i: usize| f64::from(f32::from_le_bytes(floats[i]));
        for corner in 1..4 {
            let p = DVec3::new(at(3 * corner), at(3 * corner + 1), at(3 * corner + 2));
            if !p.is_finite() {
                return Err(format!(
                    "byte {}: a corner of triangle {t} is ({}, {}, {}); expected finite coordinates",
                    HEADER + t * RECORD + 12 * corner,
                    p.x,
                    p.y,
                    p.z
                ));
            }
            positions.push(p);
        }
        tagged += usize::from(record[48..] != [0, 0]);
    }
    let mut notes = Vec::new();
    if tagged > 0 {
        notes.push(format!(
            "the attribute bytes of {tagged} triangles (colours, in some programs) are not kept"
        ));
    }
    let excess = body.len() - count as usize * RECORD;
    if excess > 0 {
        notes.push(format!(
            "{excess} bytes after the last triangle are ignored"
        ));
    }
    Ok(Loaded {
        mesh: soup(positions)?,
        encoding: Encoding::StlBinary,
        notes,
    })
}

/// A mesh of triangles that share nothing.
fn soup(positions: Vec<DVec3>) -> Result<Mesh, String> {
    let count = positions.len() / 3;
    if 3 * count > Mesh::LIMIT {
        return Err(format!(
            "{count} triangles have {} corners; at most {} can be handled",
            3 * count,
            Mesh::LIMIT
        ));
    }
    let triangles = (0..count as u32)
        .map(|t| [3 * t, 3 * t + 1, 3 * t + 2])
        .collect();
    Mesh::from_triangles(positions, triangles).map_err(Error::message)
}

fn text(bytes: &[u8]) -> Result<Loaded, String> {
    let mut words = Words::new(bytes, 0, 1);
    let (mut positions, mut facet) = (Vec::new(), Vec::new());
    let (mut solids, mut polygons) = (0_usize, 0_usize);
    while words.peek().is_some() {
        expect(&mut words, &["solid"], "the start of a solid")?;
        words.skip_line();
        solids += 1;
        while expect(
            &mut words,
            &["facet", "endsolid"],
            "the next facet or the end of the solid",
        )? == 0
        {
            expect(&mut words, &["normal"], "the normal of the facet")?;
            for _ in 0..3 {
                float(&mut words, "a coordinate of the normal", false)?;
            }
            expect(&mut words, &["outer"], "the outer loop of the facet")?;
            expect(&mut words, &["loop"], "the outer loop of the facet")?;
            facet.clear();
            while expect(
                &mut words,
                &["vertex", "endloop"],
                "the next vertex or the end of the loop",
            )? == 0
            {
                let [x, y, z] = [(); 3].each(|()| float(&mut words, "a finite coordinate", true));
                facet.push(DVec3::new(x?, y?, z?));
            }
            expect(&mut words, &["endfacet"], "the end of the facet")?;
            if facet.len() < 3 {
                return Err(format!(
                    "line {}: this facet has {} corners; expected at least three",
                    words.line(),
                    facet.len()
                ));
            }
            polygons += usize::from(facet.len() > 3);
            for i in 1..facet.len() - 1 {
                positions.extend([facet[0], facet[i], facet[i + 1]]);
            }
        }
        words.skip_line();
    }
    let mut notes = Vec::new();
    if solids > 1 {
        notes.push(format!("{solids} solids become one mesh"));
    }
    if polygons > 0 {
        notes.push(format!(
            "{polygons} facets with more than three corners are split into triangles"
        ));
    }
    Ok(Loaded {
        mesh: soup(positions)?,
        encoding: Encoding::StlAscii,
        notes,
    })
}

/// Takes the next word, and says which of `words` it is.
fn expect(text: &mut Words<'_>, words: &[&str], what: &str) -> Result<usize, String> {
    let found = text.next();
    found
        .and_then(|found| {
            words
                .iter()
                .position(|word| found.eq_ignore_ascii_case(word.as_bytes()))
        })
        .ok_or_else(|| wrong(text, found, &format!("`{}` ({what})", words.join("` or `"))))
}

/// Takes the next word as a number.
fn float(text: &mut Words<'_>, what: &str, finite: bool) -> Result<f64, String> {
    let found = text.next();
    found
        .and_then(|word| std::str::from_utf8(word).ok())
        .and_then(|word| word.parse::<f32>().ok())
        .filter(|x| x.is_finite() || !finite)
        .map(f64::from)
        .ok_or_else(|| wrong(text, found, what))
}

/// The sentence about a word that is not what was expected.
fn wrong(text: &Words<'_>, found: Option<&[u8]>, expected: &str) -> String {
    match found {
        Some(word) => {
            let shown = shown(word);
            format!("line {}: found `{shown}`; expected {expected}", text.line())
        }
        None => format!(
            "line {}: the file ends; expected {expected}; it may be cut off",
            text.line()
        ),
    }
}
