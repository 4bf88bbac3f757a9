//! Cases and what they produce.

use sha2::{Digest, Sha256};

use super::{
    billboards, compared, hidden_parts, pictures, replayed, simplified, view_cell_bounds,
    visibility, written_files,
};
use crate::{
    Error, Progress, Result,
    encode::{
        hash::{Raw, plane_sha256},
        png::Picture,
    },
    mesh::{Mesh, content_sha256},
    raster::Grid,
};

/// One result: a name, its exact value, and for some a picture for eyes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Item {
    /// `group/case/...`: lower-case letters, digits, `-`, `.` and `/`.
    pub name: String,
    /// A SHA-256 in hexadecimal digits, or exact integers; one line.
    pub value: String,
    /// The pixels that were hashed, where a person may want to see them.
    pub picture: Option<Picture>,
}

/// Cases that test one stage.
#[derive(Clone, Copy, Debug)]
pub struct Group {
    /// First part of the names of its items.
    pub name: &'static str,
    /// The cases in a few words.
    pub about: &'static str,
    run: fn(&mut Collector) -> Result<()>,
}

/// Every case there is, in the order in which data flows.
pub const GROUPS: &[Group] = &[
    Group {
        name: "generate",
        about: "content of the generated meshes",
        run: written_files::generators,
    },
    Group {
        name: "files",
        about: "bytes of written meshes, and meshes read back",
        run: written_files::meshes,
    },
    Group {
        name: "views",
        about: "matrices of every view set, and view files",
        run: written_files::views,
    },
    Group {
        name: "pictures",
        about: "ids, depth, luma, colours and coverage",
        run: pictures::pictures,
    },
    Group {
        name: "visibility",
        about: "V(t) by every rule, hidden parts, colours",
        run: visibility::measured,
    },
    Group {
        name: "bound",
        about: "what is guaranteed for a view cell",
        run: view_cell_bounds::bounds,
    },
    Group {
        name: "simplify",
        about: "simplified meshes of every method",
        run: simplified::simplified,
    },
    Group {
        name: "hidden",
        about: "guided by visibility, and interiors in some views",
        run: hidden_parts::hidden,
    },
    Group {
        name: "billboards",
        about: "planes, quads and textures for two view cells",
        run: billboards::clouds,
    },
    Group {
        name: "replay",
        about: "middle levels of a recorded run, coarser and finer",
        run: replayed::replayed,
    },
    Group {
        name: "compare",
        about: "squared luma errors, distances, silhouettes",
        run: compared::compared,
    },
];

impl Group {
    /// Computes the group's items, in a fixed order.
    ///
    /// # Errors
    /// The errors of the stage under test; none is expected.
    pub fn items(&self) -> Result<Vec<Item>> {
        let mut collector = Collector {
            group: self.name,
            items: Vec::new(),
        };
        (self.run)(&mut collector)?;
        Ok(collector.items)
    }

    /// The groups of these names, in the order of [`GROUPS`]; all of them for no name.
    ///
    /// # Errors
    /// [`Error::Usage`] where no group has a name.
    pub fn named(names: &[String]) -> Result<Vec<&'static Self>> {
        if let Some(name) = names.iter().find(|&n| GROUPS.iter().all(|g| g.name != n)) {
            let known: Vec<&str> = GROUPS.iter().map(|g| g.name).collect();
            return Err(Error::Usage(format!(
                "no group of goldens is called `{name}`; expected one of {}",
                known.join(", ")
            )));
        }
        let chosen = |g: &&Self| names.is_empty() || names.iter().any(|n| n == g.name);
        Ok(GROUPS.iter().filter(chosen).collect())
    }

    /// Computes the items of all groups, in the order of [`GROUPS`].
    ///
    /// # Errors
    /// As [`Group::items`]; [`Error::Interrupted`].
    pub fn all(progress: &dyn Progress) -> Result<Vec<Item>> {
        Self::items_of(&Self::named(&[])?, progress)
    }

    /// Computes the items of some groups, in their order.
    ///
    /// # Errors
    /// As [`Group::items`]; [`Error::Interrupted`].
    pub fn items_of(groups: &[&Self], progress: &dyn Progress) -> Result<Vec<Item>> {
        let mut items = Vec::new();
        for (i, group) in groups.iter().enumerate() {
            progress.step("goldens", i as u64, groups.len() as u64)?;
            items.extend(group.items()?);
        }
        Ok(items)
    }
}

/// Gathers the items of a group.
#[derive(Debug)]
pub struct Collector {
    group: &'static str,
    items: Vec<Item>,
}

impl Collector {
    /// A value that is exact as text.
    pub(super) fn text(&mut self, name: &str, value: String) {
        self.items.push(Item {
            name: format!("{}/{name}", self.group),
            value,
            picture: None,
        });
    }

    /// The content of a mesh.
    pub(super) fn mesh(&mut self, name: &str, mesh: &Mesh) {
        self.text(name, content_sha256(mesh));
    }

    /// The bytes of a file.
    pub(super) fn bytes(&mut self, name: &str, bytes: &[u8]) {
        let digits = Sha256::digest(bytes);
        self.text(name, digits.iter().map(|b| format!("{b:02x}")).collect());
    }

    /// The pixels of a plane.
    pub(super) fn plane<T: Raw>(&mut self, name: &str, plane: &Grid<T>) {
        self.text(name, plane_sha256(plane));
    }

    /// Shows the picture that the last item hashed.
    pub(super) fn shown(&mut self, picture: Picture) {
        if let Some(item) = self.items.last_mut() {
            item.picture = Some(picture);
        }
    }
}
