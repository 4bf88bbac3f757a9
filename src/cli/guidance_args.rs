//! The options of a command that is guided by visibility: a measurement, or a file that holds one.

use std::path::PathBuf;

use super::visibility::{finish, parse_cameras, read};
use crate::{
    Result,
    mesh::Mesh,
    simplify::visibility::VisibilityOptions,
    visibility::{MeasureOptions, Visibility},
};

/// Options of the method `visibility`.
#[derive(Clone, Debug, Default, clap::Args)]
pub(super) struct GuidanceArgs {
    /// The counts of this mesh that `lodmark visibility --partial` wrote, by whichever rule, instead
    /// of measuring
    #[arg(long, value_name = "FILE")]
    visibility: Option<PathBuf>,
    /// Measure with 6, 18, 66, 258, 1026 or 4098 cameras [default: 258]
    #[arg(long, value_name = "N", conflicts_with = "visibility", value_parser = parse_cameras)]
    cameras: Option<u32>,
    /// Width and height of the ID buffers [default: 480]
    #[arg(long, value_name = "PIXELS", conflicts_with = "visibility")]
    visibility_size: Option<u32>,
}

impl GuidanceArgs {
    /// The options of the library, without the file.
    pub(super) fn options(&self) -> VisibilityOptions {
        let default = MeasureOptions::default();
        VisibilityOptions {
            measure: MeasureOptions {
                octahedron: self.cameras.unwrap_or(default.octahedron),
                size: self.visibility_size.unwrap_or(default.size),
                ..default
            },
            ..VisibilityOptions::default()
        }
    }

    /// The first option that is given.
    pub(super) fn first_given(&self) -> Option<&'static str> {
        let given = [
            ("--visibility", self.visibility.is_some()),
            ("--cameras", self.cameras.is_some()),
            ("--visibility-size", self.visibility_size.is_some()),
        ];
        given
            .into_iter()
            .find(|(_, given)| *given)
            .map(|(name, _)| name)
    }

    /// The visibility in the file, where one is given.
    ///
    /// # Errors
    /// [`Error::Io`](crate::Error::Io), [`Error::Input`](crate::Error::Input) and
    /// [`Error::Unsupported`](crate::Error::Unsupported) for a file that cannot be used, or that belongs to another
    /// mesh.
    pub(super) fn read(&self, mesh: &Mesh) -> Result<Option<Visibility>> {
        let Some(path) = &self.visibility else {
            return Ok(None);
        };
        finish(path, &read(path)?, mesh).map(Some)
    }
}
