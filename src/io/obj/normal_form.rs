//! Prepares OBJ text for `tobj`: resolves what that crate gets wrong or does not tell.
//!
//! `tobj` 4.0.5 splits a file into models at every object, group and material and numbers the vertices of each anew,
//! merges materials when their library is missing, gives corners without `vt` or `vn` the values of the corner before
//! (and overflows on some negative indices), shifts colours when some vertices have none, refuses text that is not
//! UTF-8, and tells no line. So it gets a normal form: the numbers as they are, every index resolved, absent values
//! pointing to a NaN that stands first, and nothing that starts another model. What it cannot see stays here:
//! materials, colours, notes and line numbers.
//!
//! Of the file, `v vt vn f usemtl mtllib` are read; the rest is told of in notes.

use std::{
    collections::{BTreeMap, BTreeSet},
    io::Write,
};

use super::lines::{float, keyword, lines, words};
use crate::{
    io::words::shown,
    mesh::Materials,
    num::{Each, Precision},
};

/// The normal form of a text, and what `tobj` cannot see of it.
pub(super) struct Scan {
    /// `v`, `vt` and `vn` lines in normal form.
    pub vertex_text: Vec<u8>,
    /// `f` lines in normal form: faces with at least three corners, each `v/vt/vn` with positive indices.
    pub face_text: Vec<u8>,
    /// Number of triangles in the fans.
    pub triangles: usize,
    /// Number of positions, texture coordinates and normals, without the NaN that leads the latter two.
    pub counts: [usize; 3],
    /// Whether a corner uses texture coordinates, normals.
    pub uses: [bool; 2],
    /// Colours of the vertices, NaN where absent; empty where no vertex has one.
    pub colors: Vec<[f64; 3]>,
    /// Materials, one per triangle of the fans.
    pub materials: Materials,
    /// The precision that a comment of our own writer tells.
    pub precision: Option<Precision>,
    /// Notes about what is not kept.
    pub notes: Vec<String>,
}

/// Index (from 0) of a value that a corner does not have.
const ABSENT: u32 = u32::MAX;

/// Numbers and names of the three kinds of vertex lines.
const KINDS: [&str; 3] = ["v", "vt", "vn"];

/// A comment in which [`super::write`] tells the precision, which text does not show.
pub(super) const PRECISION: &str = "# lodmark precision ";

/// Reads the structure of the text.
pub(super) fn scan(bytes: &[u8]) -> Result<Scan, String> {
    let mut scanner = Scanner {
        vertex_text: b"vt nan nan\nvn nan nan nan\n".to_vec(),
        material: Materials::NONE,
        ..Scanner::default()
    };
    for (line, text) in lines(bytes) {
        if text.contains(&0) {
            return Err(format!(
                "line {line}: a zero byte; expected OBJ, which is text"
            ));
        }
        scanner.number = line;
        scanner
            .line(&text)
            .map_err(|message| format!("line {line}: {message}"))?;
    }
    scanner.finish()
}

#[derive(Default)]
struct Scanner {
    /// The current line.
    number: usize,
    vertex_text: Vec<u8>,
    face_text: Vec<u8>,
    /// The corners of the current face, as (v, vt, vn) from 0.
    corners: Vec<[u32; 3]>,
    counts: [usize; 3],
    uses: [bool; 2],
    /// The largest index of each kind (from 0) and the line that names it.
    largest: [Option<(u32, usize)>; 3],
    colors: Vec<[f64; 3]>,
    names: BTreeMap<String, u32>,
    libraries: BTreeSet<String>,
    material: u32,
    materials: Materials,
    precision: Option<Precision>,
    /// Number of lines of every kind that is not kept.
    dropped: BTreeMap<String, usize>,
    slivers: usize,
    extra_uvs: bool,
}

impl Scanner {
    fn line(&mut self, text: &[u8]) -> Result<(), String> {
        let (word, rest) = keyword(text);
        match word {
            b"v" => self.vertex(rest),
            b"vt" => self.texcoord(rest),
            b"vn" => self.normal(rest),
            b"f" | b"fo" => self.face(rest),
            b"usemtl" => {
                self.material = self.material_of(String::from_utf8_lossy(rest).into_owned());
                Ok(())
            }
            b"mtllib" => {
                let library = String::from_utf8_lossy(rest).into_owned();
                if !library.is_empty() && self.libraries.insert(library.clone()) {
                    self.materials.libraries.push(library);
                }
                Ok(())
            }
            _ if word.starts_with(b"#") => {
                self.precision = match text.strip_prefix(PRECISION.as_bytes()) {
                    Some(b"f32") => Some(Precision::F32),
                    Some(b"f64") => Some(Precision::F64),
                    _ => self.precision,
                };
                Ok(())
            }
            b"" => Ok(()),
            other => {
                // Bounded, whatever the file holds.
                let name = if self.dropped.len() < 20 {
                    shown(other)
                } else {
                    "...".into()
                };
                *self.dropped.entry(name).or_default() += 1;
                Ok(())
            }
        }
    }

    fn material_of(&mut self, name: String) -> u32 {
        if name.is_empty() {
            return Materials::NONE;
        }
        let next = self.names.len() as u32;
        *self.names.entry(name).or_insert_with_key(|name| {
            self.materials.names.push(name.clone());
            next
        })
    }

    fn emit<'a>(&mut self, kind: usize, words: impl IntoIterator<Item = &'a [u8]>) {
        self.vertex_text.extend_from_slice(KINDS[kind].as_bytes());
        for word in words {
            self.vertex_text.push(b' ');
            // `tobj` reads UTF-8 only; no number holds any other byte.
            self.vertex_text
                .extend(word.iter().map(|b| if b.is_ascii() { *b } else { b'?' }));
        }
        self.vertex_text.push(b'\n');
        self.counts[kind] += 1;
    }

    fn vertex(&mut self, rest: &[u8]) -> Result<(), String> {
        let mut found = [b"".as_slice(); 7];
        let count = words(rest)
            .zip(&mut found)
            .map(|(word, slot)| *slot = word)
            .count();
        match count {
            3 | 4 => self.emit(0, found[..count].iter().copied()),
            6 => {
                let mut color = [0.0; 3];
                for (value, word) in color.iter_mut().zip(&found[3..6]) {
                    *value = float(word).filter(|x| x.is_finite()).ok_or_else(|| {
                        format!("found `{}`; expected a colour value", shown(word))
                    })?;
                }
                self.colors.resize(self.counts[0], [f64::NAN; 3]);
                self.colors.push(color);
                self.emit(0, found[..3].iter().copied());
            }
            _ => {
                return Err(format!(
                    "a vertex of {} numbers; expected x y z, x y z w, or x y z red green blue",
                    if count == 7 {
                        "more than 6".into()
                    } else {
                        count.to_string()
                    }
                ));
            }
        }
        Ok(())
    }

    fn texcoord(&mut self, rest: &[u8]) -> Result<(), String> {
        let mut words = words(rest);
        let u = words
            .next()
            .ok_or("a texture coordinate without numbers; expected u v")?;
        let v = words.next().unwrap_or(b"0");
        self.extra_uvs |= words.next().is_some_and(|w| float(w) != Some(0.0));
        self.emit(1, [u, v]);
        Ok(())
    }

    fn normal(&mut self, rest: &[u8]) -> Result<(), String> {
        if words(rest).count() != 3 {
            return Err("expected a normal of three numbers".into());
        }
        self.emit(2, words(rest));
        Ok(())
    }

    fn face(&mut self, rest: &[u8]) -> Result<(), String> {
        self.corners.clear();
        for word in words(rest) {
            let corner = self.corner(word)?;
            self.corners.push(corner);
        }
        let count = self.corners.len();
        if count < 3 {
            self.slivers += 1;
            return Ok(());
        }
        self.face_text.push(b'f');
        for &[v, vt, vn] in &self.corners {
            // Vertices may follow the faces that use them: what is out of range shows at the end.
            for (largest, index) in self.largest.iter_mut().zip([v, vt, vn]) {
                if index != ABSENT && largest.is_none_or(|(seen, _)| index > seen) {
                    *largest = Some((index, self.number));
                }
            }
            self.uses[0] |= vt != ABSENT;
            self.uses[1] |= vn != ABSENT;
            // From 1; the first texture coordinate and normal stand for absent ones: ABSENT wraps to 0.
            let [vt, vn] = [vt, vn].each(|i| u64::from(i.wrapping_add(1)) + 1);
            // Writing to a Vec cannot fail.
            let _ = write!(self.face_text, " {}/{vt}/{vn}", u64::from(v) + 1);
        }
        self.face_text.push(b'\n');
        let filled = self.materials.of_triangle.len();
        self.materials
            .of_triangle
            .resize(filled + count - 2, self.material);
        Ok(())
    }

    /// `v`, `v/vt`, `v//vn` or `v/vt/vn`, from 1, or negative and counted from the end.
    fn corner(&self, word: &[u8]) -> Result<[u32; 3], String> {
        let mut corner = [ABSENT; 3];
        for (kind, part) in word.split(|&b| b == b'/').enumerate() {
            if part.is_empty() && kind > 0 {
                continue;
            }
            let index = (kind < 3)
                .then(|| std::str::from_utf8(part).ok()?.parse::<i64>().ok())
                .flatten()
                .ok_or_else(|| {
                    format!(
                        "found `{}`; expected a corner v, v/vt, v//vn or v/vt/vn of whole numbers",
                        shown(word)
                    )
                })?;
            let count = self.counts[kind];
            let resolved = if index < 0 {
                (count as i64).checked_add(index)
            } else {
                index.checked_sub(1)
            };
            corner[kind] = resolved
                .and_then(|i| u32::try_from(i).ok())
                .filter(|&i| i < ABSENT)
                .ok_or_else(|| {
                    format!(
                        "a corner names `{}` {index}, and {count} come before; indices count from 1, or from -1 \
                         backwards",
                        KINDS[kind]
                    )
                })?;
        }
        Ok(corner)
    }

    fn finish(mut self) -> Result<Scan, String> {
        for (kind, largest) in self.largest.into_iter().enumerate() {
            if let Some((index, line)) = largest
                && index as usize >= self.counts[kind]
            {
                return Err(format!(
                    "line {line}: a corner names `{}` {}, but there are {}",
                    KINDS[kind],
                    u64::from(index) + 1,
                    self.counts[kind]
                ));
            }
        }
        // Our own writer's comment is enough: a mesh without vertices can be read back.
        if self.counts[0] == 0 && self.precision.is_none() {
            return Err("no line begins with `v`; expected an OBJ mesh with vertices".into());
        }
        if !self.colors.is_empty() {
            self.colors.resize(self.counts[0], [f64::NAN; 3]);
        }
        let notes = self.notes();
        let triangles = self.materials.of_triangle.len();
        if self
            .materials
            .of_triangle
            .iter()
            .all(|&m| m == Materials::NONE)
        {
            self.materials.of_triangle.clear();
        }
        Ok(Scan {
            vertex_text: self.vertex_text,
            face_text: self.face_text,
            triangles,
            counts: self.counts,
            uses: self.uses,
            colors: self.colors,
            materials: self.materials,
            precision: self.precision,
            notes,
        })
    }

    fn notes(&self) -> Vec<String> {
        let mut notes: Vec<String> = self
            .dropped
            .iter()
            .map(|(word, count)| match word.as_str() {
                "o" | "g" => format!("{count} lines `{word}`: objects and groups are not kept"),
                "l" | "p" => format!("{count} lines `{word}`: lines and points are not kept"),
                "s" => format!("{count} lines `s`: smoothing groups are not kept"),
                _ => format!("{count} lines `{word}` are not kept"),
            })
            .collect();
        if self.slivers > 0 {
            notes.push(format!(
                "{} faces with fewer than three corners are not kept",
                self.slivers
            ));
        }
        if self.extra_uvs {
            notes.push("the third texture coordinate is not kept".into());
        }
        notes
    }
}
