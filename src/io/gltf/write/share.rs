//! Images of a document that several files are to share: each a file beside them, that the document names.

use std::{
    collections::BTreeSet,
    path::{Path, PathBuf},
    sync::Arc,
};

use super::{
    Written,
    additions::Additions,
    files::{copy_images, escaped, lies_in, set_buffer},
    images::{self, media_type},
    json::{self, Members},
    pack,
    references::{self, VIEWS},
};
use crate::{
    Result,
    encode::atomic,
    io::gltf::{buffers::Views, document::Document},
    mesh::{Asset, Materials, Mesh, MeshParts},
};

/// A document whose images lie in files, for all meshes that come from it.
#[derive(Clone, Debug, Default)]
pub struct SharedImages {
    asset: Option<Arc<Asset>>,
    /// The names of the images in their folder.
    pub names: Vec<String>,
    /// One sentence for every image that cannot be shared.
    pub notes: Vec<String>,
}

impl SharedImages {
    /// The mesh with the document that names its images; `None` where nothing is shared.
    ///
    /// # Errors
    /// Never: the mesh was valid before.
    pub fn named_by(&self, mesh: &Mesh) -> Result<Option<Mesh>> {
        let Some(asset) = &self.asset else {
            return Ok(None);
        };
        let parts = mesh.clone().into_parts();
        let materials = Materials {
            asset: Some(Arc::clone(asset)),
            ..parts.materials
        };
        Mesh::new(MeshParts { materials, ..parts }).map(Some)
    }
}

/// Writes the images that the document of a mesh holds or names into a folder that is there; those that it holds as
/// `STEM_image0.png` and so on, replacing what is there. Images in data URIs stay where they are.
///
/// # Errors
/// [`Error::Input`](crate::Error::Input) where the document is damaged; [`Error::Io`](crate::Error::Io).
pub fn share_images(mesh: &Mesh, folder: &Path, stem: &str) -> Result<SharedImages> {
    let Some(asset) = &mesh.materials().asset else {
        return Ok(SharedImages::default());
    };
    let document = Document::parse(asset)?;
    let views = Views::new(&document, &asset.buffers);
    let mut written = Written {
        sections: Members::from(asset.sections.clone()),
        binary: Vec::new(),
        notes: Vec::new(),
    };
    if let Some(extension) = references::unknown_extension(&written.sections)? {
        let told = format!(
            "the extension {extension} may refer to anything: images are stored in every level"
        );
        return Ok(SharedImages {
            notes: vec![told],
            ..SharedImages::default()
        });
    }
    if !lies_in(asset, folder) {
        copy_images(&mut written, asset, folder)?;
    }
    let taken = extract(&mut written, (&document, &views), folder, stem)?;
    let named = images::named(&written.sections, &mut written.notes)?;
    if named.is_empty() {
        return Ok(SharedImages::default());
    }
    let mut needed = references::gather(&written.sections, VIEWS)?;
    needed.extend(document.accessors.iter().filter_map(|a| a.buffer_view));
    let dropped: BTreeSet<usize> = taken.difference(&needed).copied().collect();
    let additions = Additions::to(document.views.len(), document.accessors.len());
    let kept = (&document, &views);
    let sections = &mut written.sections;
    written.binary = pack::pack(sections, kept, &asset.buffers, &dropped, &additions)?;
    set_buffer(&mut written, None)?;
    let name = |path: PathBuf| path.to_string_lossy().into_owned();
    let sections = written.sections.iter();
    Ok(SharedImages {
        names: named.into_iter().map(|image| name(image.path)).collect(),
        notes: written.notes,
        asset: Some(Arc::new(Asset {
            sections: sections
                .map(|(name, text)| (name.into(), text.into()))
                .collect(),
            buffers: match written.binary.is_empty() {
                true => Vec::new(),
                false => vec![written.binary],
            },
            folder: folder.to_path_buf(),
            ..(**asset).clone()
        })),
    })
}

/// Writes the images that views hold into files; the answer is those views.
fn extract(
    written: &mut Written,
    (document, views): (&Document, &Views<'_>),
    folder: &Path,
    stem: &str,
) -> Result<BTreeSet<usize>> {
    let mut taken = BTreeSet::new();
    let mut entries = json::entries(written.sections.get("images").unwrap_or("[]"))?;
    for (number, text) in entries.iter_mut().enumerate() {
        let mut entry = Members::parse(text)?;
        let view = entry.get("bufferView").and_then(|view| view.parse().ok());
        let Some(view) = view else {
            continue;
        };
        let bytes = views.bytes(view)?;
        let bytes = &bytes[..document.views[view].byte_length];
        let Some(kind) = media_type(bytes) else {
            written.notes.push(format!(
                "images[{number}] is no PNG, JPEG, WebP, AVIF, KTX2 or DDS: it is stored in every level"
            ));
            continue;
        };
        let extension = match kind.rsplit(['/', '.']).next() {
            Some("jpeg") | None => "jpg",
            Some(other) => other,
        };
        let name = format!("{stem}_image{number}.{extension}");
        atomic::write_bytes(&folder.join(&name), bytes)?;
        entry.remove(&["bufferView"]);
        entry.set("uri", json::quoted(&escaped(Path::new(&name))));
        *text = entry.to_string();
        taken.insert(view);
    }
    if !taken.is_empty() {
        written.sections.set("images", json::array(&entries));
    }
    Ok(taken)
}
