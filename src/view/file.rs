//! The JSON view file: the views of a reference image set, the same schema as the `scene.json` that `lodmark render`
//! writes.
//!
//! A whole one: an orthographic view of the unit sphere from +z ([`EXAMPLE`]).
//!
//! ```json
#![doc = include_str!("example.json")]
//! ```
//! | field | value |
//! |---|---|
//! | `width`, `height` | pixels of an image: 1 to 4096 / `samples` |
//! | `samples` | samples per pixel along each axis: 1, 2 or 4 |
//! | `subpixel_bits` | 8 or 16 |
//! | `y_direction`, `depth` | rows of images go down, depth is z / w; nothing else is read |
//! | `background` | luma where nothing is, 0 to 255 |
//! | `matrix` | clip space from world space, row by row, as the bits of 16 doubles in hexadecimal |
//! | `matrix_f32` | its rounding, which a GPU uploads (null beyond the range); may be left out |
//! | `eye` | `{"point": [x, y, z]}` where the viewer stands, or `{"axis": [x, y, z]}` towards an orthographic one |
//! | `near`, `far` | distances of the planes that bound what is drawn |
//! | `cull` | `"none"`, `"back"` or `"front"`: the side that is not drawn |
//! | `shading` | `interpolation` `"flat"`, `"gouraud"` or `"lit"`; `two_sided`; may have `"specular": {"strength": 0.3, "exponent": 20}` |
//! | `light` | `"headlight"`, `{"point": [x, y, z]}`, or `{"direction": [x, y, z]}` towards a light far away |
//! | `sha256` | hashes of the images that belong to a view, by buffer; may be left out |
//!
//! Lengths are in the units of the mesh file; axes and directions have length 1. Numbers that are neither whole nor in
//! a matrix are written with the digits that give the same double back.

use std::{collections::BTreeMap, path::Path};

use glam::DVec3;
use serde::{Deserialize, Serialize};

use super::{Cull, Eye, Light, Matrix, Shading, View, ViewSet};
use crate::{
    Error, Result,
    encode::json,
    num::{fixed::SubpixelBits, math},
};

/// The version of the schema that this crate reads and writes.
pub const SCHEMA: u32 = 1;

/// A whole view file with one view: for help texts, and shown where a file is refused.
pub const EXAMPLE: &str = include_str!("example.json");

/// Largest view file that is read, in bytes: 4,098 views take some 6 MB.
const SIZE_LIMIT: u64 = 256 << 20;

/// Largest deviation from 1 of the length of a unit vector in a file.
const UNIT_TOLERANCE: f64 = 1e-6;

const Y_DIRECTION: &str = "down";
const DEPTH: &str = "0 near, 1 far";

/// SHA-256 of the images of a view, by the name of the buffer.
pub type ImageHashes = BTreeMap<String, String>;

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct SetRecord {
    schema: u32,
    width: u32,
    height: u32,
    samples: u32,
    subpixel_bits: SubpixelBits,
    y_direction: String,
    depth: String,
    background: u8,
    views: Vec<ViewRecord>,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct ViewRecord {
    matrix: Vec<String>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    matrix_f32: Option<Vec<Option<f32>>>,
    eye: EyeRecord,
    near: f64,
    far: f64,
    cull: Cull,
    shading: Shading,
    light: LightRecord,
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    sha256: ImageHashes,
}

#[derive(Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
enum EyeRecord {
    Point([f64; 3]),
    Axis([f64; 3]),
}

#[derive(Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
enum LightRecord {
    Headlight,
    Point([f64; 3]),
    Direction([f64; 3]),
}

/// The text of the view file for `set`, in units of the mesh file; `hashes` holds one entry per view or none at all.
/// Equal sets give equal text.
///
/// # Errors
/// [`Error::Internal`] where the views hold a number that is not finite.
pub fn to_json(set: &ViewSet, hashes: &[ImageHashes]) -> Result<String> {
    let views = set.views.iter().enumerate().map(|(i, view)| ViewRecord {
        matrix: bits(&view.matrix),
        matrix_f32: Some(rounded(&view.matrix)),
        eye: match view.eye {
            Eye::Point(p) => EyeRecord::Point(p.to_array()),
            Eye::Axis(a) => EyeRecord::Axis(a.to_array()),
        },
        near: view.near,
        far: view.far,
        cull: view.cull,
        shading: view.shading,
        light: match view.light {
            Light::Headlight => LightRecord::Headlight,
            Light::Point(p) => LightRecord::Point(p.to_array()),
            Light::Direction(d) => LightRecord::Direction(d.to_array()),
        },
        sha256: hashes.get(i).cloned().unwrap_or_default(),
    });
    let record = SetRecord {
        schema: SCHEMA,
        width: set.width,
        height: set.height,
        samples: set.samples,
        subpixel_bits: set.subpixel,
        y_direction: Y_DIRECTION.into(),
        depth: DEPTH.into(),
        background: set.background,
        views: views.collect(),
    };
    for (i, view) in record.views.iter().enumerate() {
        view.check()
            .map_err(|what| Error::Internal(format!("view {i} cannot be written: {what}")))?;
    }
    json::to_text(&record)
}

/// The views in the text of a view file, in units of the mesh file; `path` is named in errors.
///
/// # Errors
/// [`Error::Input`] with the view and the number concerned: another schema, missing or unknown fields, no views, sizes
/// beyond what [`ViewSet::check_size`] allows, numbers that are not finite or contradict each other.
pub fn from_json(text: &str, path: impl AsRef<Path>) -> Result<ViewSet> {
    let path = path.as_ref();
    let refused = |what: String| Error::input(path, what);
    let malformed = |e: serde_json::Error| {
        refused(format!(
            "{e}; expected a view file such as `lodmark render` writes as scene.json; see `lodmark render --help`; \
             a whole one is\n{EXAMPLE}"
        ))
    };
    let schema = json::schema_of(text).map_err(malformed)?;
    if schema != SCHEMA {
        let told = format!("schema {schema}; this version reads schema {SCHEMA}");
        return Err(refused(told));
    }
    let record: SetRecord = serde_json::from_str(text).map_err(malformed)?;
    for (field, found, expected) in [
        ("y_direction", &record.y_direction, Y_DIRECTION),
        ("depth", &record.depth, DEPTH),
    ] {
        if found != expected {
            let told = format!("{field} is `{found}`; expected `{expected}`");
            return Err(refused(told));
        }
    }
    if record.views.is_empty() {
        return Err(refused("no views; expected at least one".into()));
    }
    let mut set = ViewSet {
        width: record.width,
        height: record.height,
        samples: record.samples,
        subpixel: record.subpixel_bits,
        background: record.background,
        views: Vec::with_capacity(record.views.len()),
    };
    set.check_size().map_err(|e| refused(e.to_string()))?;
    for (i, view) in record.views.iter().enumerate() {
        let view = view.check();
        set.views
            .push(view.map_err(|what| refused(format!("view {i}: {what}")))?);
    }
    Ok(set)
}

/// Reads a view file; lengths in units of the mesh file (see [`ViewSet::enter_frame`]).
///
/// # Errors
/// [`Error::Io`], or as `from_json`.
pub fn read(path: impl AsRef<Path>) -> Result<ViewSet> {
    let path = path.as_ref();
    from_json(&json::read_text(path, SIZE_LIMIT, "view file")?, path)
}

/// The bits of a matrix, row by row.
fn bits(matrix: &Matrix) -> Vec<String> {
    let entries = matrix.iter().flatten();
    entries.map(|x| format!("{:016x}", x.to_bits())).collect()
}

/// The `f32` rounding of a matrix, row by row; `None` where it overflows.
fn rounded(matrix: &Matrix) -> Vec<Option<f32>> {
    let entries = matrix.iter().flatten().map(|&x| x as f32);
    entries.map(|x| x.is_finite().then_some(x)).collect()
}

impl ViewRecord {
    /// The view, or a sentence about the first thing that is wrong with it.
    fn check(&self) -> Result<View, String> {
        let matrix = self.parse_matrix()?;
        if let Some(given) = &self.matrix_f32 {
            let expected = rounded(&matrix);
            let same =
                |(a, b): (&Option<f32>, &Option<f32>)| a.map(f32::to_bits) == b.map(f32::to_bits);
            if given.len() != 16 || !given.iter().zip(&expected).all(same) {
                let told = "matrix_f32 is not the rounding of matrix; leave it out or round it";
                return Err(told.into());
            }
        }
        if matrix[3].iter().all(|m| m.abs() <= 0.0) {
            return Err("the last row of matrix is 0; expected what gives w".into());
        }
        let eye = match self.eye {
            EyeRecord::Point(p) => Eye::Point(finite(p, "eye.point")?),
            EyeRecord::Axis(a) => Eye::Axis(unit(a, "eye.axis")?),
        };
        let light = match self.light {
            LightRecord::Headlight => Light::Headlight,
            LightRecord::Point(p) => Light::Point(finite(p, "light.point")?),
            LightRecord::Direction(d) => Light::Direction(unit(d, "light.direction")?),
        };
        let (near, far) = (self.near, self.far);
        let behind = matches!(eye, Eye::Point(_)) && near <= 0.0;
        if !(near.is_finite() && far.is_finite() && near < far) || behind {
            return Err(format!(
                "near {near} and far {far}; expected finite near < far, and near above 0 where the eye is a point"
            ));
        }
        if let Some(s) = self.shading.specular
            && (!(0.0..=1.0).contains(&s.strength) || s.exponent == 0)
        {
            return Err(format!(
                "specular strength {} and exponent {}; expected 0 to 1, and at least 1",
                s.strength, s.exponent
            ));
        }
        Ok(View {
            matrix,
            eye,
            near,
            far,
            cull: self.cull,
            shading: self.shading,
            light,
        })
    }

    fn parse_matrix(&self) -> Result<Matrix, String> {
        let count = self.matrix.len();
        if count != 16 {
            return Err(format!("matrix has {count} entries; expected 16"));
        }
        let mut matrix = [[0.0; 4]; 4];
        for (i, text) in self.matrix.iter().enumerate() {
            let digits = text.len() == 16 && text.bytes().all(|b| b.is_ascii_hexdigit());
            let value = u64::from_str_radix(text, 16).map(f64::from_bits);
            match value {
                Ok(x) if digits && x.is_finite() => matrix[i / 4][i % 4] = x,
                Ok(x) if digits => {
                    return Err(format!("matrix entry {i} is {x}; expected a finite number"));
                }
                _ => {
                    return Err(format!(
                        "matrix entry {i} is `{}`; expected the 16 hexadecimal digits of a double",
                        text.escape_debug().take(40).collect::<String>()
                    ));
                }
            }
        }
        Ok(matrix)
    }
}

fn finite(v: [f64; 3], what: &str) -> Result<DVec3, String> {
    let v = Some(DVec3::from_array(v)).filter(|v| v.is_finite());
    v.ok_or_else(|| format!("{what} is not finite"))
}

fn unit(v: [f64; 3], what: &str) -> Result<DVec3, String> {
    let v = finite(v, what)?;
    let length = math::length(v);
    let near = (length - 1.0).abs() <= UNIT_TOLERANCE;
    let told = || format!("{what} has length {length}; expected a unit vector");
    near.then_some(v).ok_or_else(told)
}
