//! The JSON cell file: one view cell.
//!
//! A file of every kind; copy a line, put your numbers in, and give its name to `--cell`:
//!
//! ```json
#![doc = include_str!("examples.jsonl")]
//! ```
//! | cell | value |
//! |---|---|
//! | `point` | `[x, y, z]` |
//! | `segment` | two points |
//! | `line` | `{"point": [x, y, z], "direction": [x, y, z]}` |
//! | `polygon` | 3 to 64 points: the corners of a convex polygon in order |
//! | `plane` | `{"point": [x, y, z], "normal": [x, y, z]}` |
//! | `polyhedron` | 4 to 64 points: the cell is their convex hull |
//! | `box` | `{"low": [x, y, z], "high": [x, y, z]}`, sides along the axes |
//! | `half_space` | `{"point": [x, y, z], "normal": [x, y, z]}`: viewers are on the side that the normal points away from |
//!
//! Positions are in the units of the mesh file. Directions and normals may have any length but 0. Numbers are written
//! with the digits that give the same double back; a box is written as a polyhedron.

use std::path::Path;

use glam::DVec3;
use serde::{Deserialize, Serialize};

use super::{Shape, ViewCell};
use crate::{Error, Result, encode::json, num::Each};

/// The version of the schema that this crate reads and writes.
pub const SCHEMA: u32 = 1;

/// A cell file of every kind, one a line: for help texts and documentation.
pub const EXAMPLES: &str = include_str!("examples.jsonl");

/// The smallest whole cell file: shown where a file is refused.
pub const EXAMPLE: &str = r#"{"schema": 1, "cell": {"point": [0, 0, 5]}}"#;

/// Largest cell file that is read, in bytes: 64 corners take some 4 kB.
const SIZE_LIMIT: u64 = 1 << 20;

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct FileRecord {
    schema: u32,
    cell: CellRecord,
}

/// A cell as the file has it.
#[derive(Debug, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
enum CellRecord {
    Point([f64; 3]),
    Segment([[f64; 3]; 2]),
    Line {
        point: [f64; 3],
        direction: [f64; 3],
    },
    Polygon(Vec<[f64; 3]>),
    Plane {
        point: [f64; 3],
        normal: [f64; 3],
    },
    Polyhedron(Vec<[f64; 3]>),
    Box {
        low: [f64; 3],
        high: [f64; 3],
    },
    HalfSpace {
        point: [f64; 3],
        normal: [f64; 3],
    },
}

impl Serialize for ViewCell {
    /// As in a cell file: `{"segment": [...]}`.
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        CellRecord::of(self).serialize(serializer)
    }
}

impl<'de> Deserialize<'de> for ViewCell {
    /// As in a cell file; what the constructors refuse is an error.
    fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let record = CellRecord::deserialize(deserializer)?;
        record.check().map_err(serde::de::Error::custom)
    }
}

/// The text of the cell file for `cell`. Equal cells give equal text.
///
/// # Errors
/// [`Error::Internal`] where the cell has no JSON form; there is none like that.
pub fn to_json(cell: &ViewCell) -> Result<String> {
    let record = FileRecord {
        schema: SCHEMA,
        cell: CellRecord::of(cell),
    };
    json::to_text(&record)
}

/// The cell in the text of a cell file; `path` is named in errors.
///
/// # Errors
/// [`Error::Input`]: another schema, missing or unknown fields, or what the constructors of [`ViewCell`] refuse.
pub fn from_json(text: &str, path: impl AsRef<Path>) -> Result<ViewCell> {
    let path = path.as_ref();
    let refused = |what: String| refused(path, &what);
    let schema = json::schema_of(text).map_err(|e| refused(e.to_string()))?;
    if schema != SCHEMA {
        return Err(refused(format!(
            "schema {schema}; this version reads schema {SCHEMA}"
        )));
    }
    let record: FileRecord = serde_json::from_str(text).map_err(|e| refused(e.to_string()))?;
    record.cell.check().map_err(|e| refused(e.to_string()))
}

/// Reads a cell file; positions in units of the mesh file (see [`ViewCell::enter_frame`]).
///
/// # Errors
/// [`Error::Io`], or as `from_json`.
pub fn read(path: impl AsRef<Path>) -> Result<ViewCell> {
    let path = path.as_ref();
    from_json(&json::read_text(path, SIZE_LIMIT, "cell file")?, path)
}

/// Says what is wrong with a cell file, and shows one that is right.
fn refused(path: &Path, what: &str) -> Error {
    Error::input(
        path,
        format!(
            "{what}; a whole cell file is {EXAMPLE}, and `lodmark bound --help` shows one of every kind"
        ),
    )
}

impl CellRecord {
    fn of(cell: &ViewCell) -> Self {
        let all = |points: &[DVec3]| points.iter().map(DVec3::to_array).collect();
        match cell.shape() {
            Shape::Point(at) => Self::Point(at.to_array()),
            Shape::Segment(ends) => Self::Segment(ends.each(|e| e.to_array())),
            Shape::Line { point, direction } => Self::Line {
                point: point.to_array(),
                direction: direction.to_array(),
            },
            Shape::Polygon { corners, .. } => Self::Polygon(all(corners)),
            Shape::Plane { point, normal } => Self::Plane {
                point: point.to_array(),
                normal: normal.to_array(),
            },
            Shape::Polyhedron { corners, .. } => Self::Polyhedron(all(corners)),
            Shape::HalfSpace { point, normal } => Self::HalfSpace {
                point: point.to_array(),
                normal: normal.to_array(),
            },
        }
    }

    fn check(&self) -> Result<ViewCell> {
        let all = |points: &[[f64; 3]]| -> Vec<DVec3> {
            points.iter().map(|&p| DVec3::from_array(p)).collect()
        };
        let [a, b] = match self {
            Self::Point(at) => return ViewCell::point(DVec3::from_array(*at)),
            Self::Polygon(corners) => return ViewCell::polygon(&all(corners)),
            Self::Polyhedron(corners) => return ViewCell::polyhedron(&all(corners)),
            Self::Segment(ends) => *ends,
            Self::Line { point, direction } => [*point, *direction],
            Self::Plane { point, normal } | Self::HalfSpace { point, normal } => [*point, *normal],
            Self::Box { low, high } => [*low, *high],
        }
        .each(DVec3::from_array);
        match self {
            Self::Line { .. } => ViewCell::line(a, b),
            Self::Plane { .. } => ViewCell::plane(a, b),
            Self::HalfSpace { .. } => ViewCell::half_space(a, b),
            Self::Box { .. } => ViewCell::cuboid(a, b),
            _ => ViewCell::segment([a, b]),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_example_is_a_cell_file_and_there_is_one_of_every_kind() {
        let mut kinds = Vec::new();
        for line in EXAMPLES.lines().chain([EXAMPLE]) {
            let cell = from_json(line, "example.json").expect(line);
            let kind = match cell.shape() {
                Shape::Point(_) => "point",
                Shape::Segment(_) => "segment",
                Shape::Line { .. } => "line",
                Shape::Polygon { .. } => "polygon",
                Shape::Plane { .. } => "plane",
                Shape::Polyhedron { .. } => "polyhedron",
                Shape::HalfSpace { .. } => "half_space",
            };
            kinds.push(if line.contains("\"box\"") {
                "box"
            } else {
                kind
            });
        }
        assert_eq!(
            kinds,
            [
                "point",
                "segment",
                "line",
                "polygon",
                "plane",
                "polyhedron",
                "box",
                "half_space",
                "point"
            ]
        );
    }

    #[test]
    fn a_refused_file_is_told_what_a_cell_file_looks_like() {
        for text in [
            "",
            "[]",
            "{\"schema\": 1, \"cell\": {\"circle\": 3}}",
            "{\"schema\": 2}",
        ] {
            let told = from_json(text, "cell.json")
                .expect_err("no cell file")
                .to_string();
            assert!(
                told.contains(EXAMPLE) && told.contains("bound --help"),
                "{told}"
            );
        }
    }
}
