//! The manifest of a chain: what an engine needs to know of the files beside it.

use serde::Serialize;

use super::{ASPECT, Chain, LevelReport, Screen};
use crate::simplify::{Options, Stop};

/// The content of `NAME.lod.json`.
///
/// Numbers of a level hold from its `switch_distance` on; an engine that wants to know where a level ends takes those of the
/// next one.
#[derive(Clone, Debug, Serialize)]
pub(super) struct Manifest<'a> {
    schema: u32,
    command: &'static str,
    version: &'static str,
    name: &'a str,
    /// The minimum bounding sphere of level 0: distances are from its centre, shares of the screen are its.
    sphere: BoundingSphere,
    /// The screen that switch distances are for.
    screen: ScreenOfManifest,
    levels: Vec<LevelEntry<'a>>,
    /// Images that the levels share by name.
    #[serde(skip_serializing_if = "<[String]>::is_empty")]
    images: &'a [String],
    /// Distances that were asked for and have no level of their own.
    #[serde(skip_serializing_if = "<[f64]>::is_empty")]
    left_out: &'a [f64],
}

#[derive(Clone, Copy, Debug, Serialize)]
struct BoundingSphere {
    center: [f64; 3],
    radius: f64,
}

#[derive(Clone, Copy, Debug, Serialize)]
struct ScreenOfManifest {
    #[serde(flatten)]
    own: Screen,
    /// Width by height, for `coverage`.
    aspect: f64,
}

/// A level and its file.
#[derive(Clone, Debug, Serialize)]
struct LevelEntry<'a> {
    file: &'a str,
    target: usize,
    triangles: usize,
    vertices: usize,
    /// No more triangles than asked for.
    reached: bool,
    stop: &'a Stop,
    /// Of the mesh, as `lodmark simplify --json` has it.
    content_sha256: &'a str,
    /// Of the bytes of the file.
    file_sha256: &'a str,
    #[serde(flatten)]
    report: &'a LevelReport,
    #[serde(skip_serializing_if = "Option::is_none")]
    options: Option<&'a Options>,
}

/// The name and the hashes of the file of a level.
#[derive(Clone, Debug)]
pub(super) struct LevelFile {
    pub(super) name: String,
    pub(super) content_sha256: String,
    pub(super) file_sha256: String,
}

impl<'a> Manifest<'a> {
    /// The manifest of a chain whose levels are in `files`, and whose images have these names.
    pub(super) fn new(
        name: &'a str,
        chain: &'a Chain,
        files: &'a [LevelFile],
        images: &'a [String],
    ) -> Self {
        let levels = chain.levels.iter().zip(files);
        let entry = |(level, file): (&'a super::Level, &'a LevelFile)| LevelEntry {
            file: &file.name,
            target: level.target,
            triangles: level.mesh.triangles().len(),
            vertices: level.mesh.positions().len(),
            reached: level.mesh.triangles().len() <= level.target,
            stop: &level.stop,
            content_sha256: &file.content_sha256,
            file_sha256: &file.file_sha256,
            report: &level.report,
            options: level.options.as_ref(),
        };
        Self {
            schema: 1,
            command: "lod",
            version: env!("CARGO_PKG_VERSION"),
            name,
            sphere: BoundingSphere {
                center: chain.center,
                radius: chain.radius,
            },
            screen: ScreenOfManifest {
                own: chain.screen,
                aspect: ASPECT,
            },
            levels: levels.map(entry).collect(),
            images,
            left_out: &chain.left_out,
        }
    }
}
