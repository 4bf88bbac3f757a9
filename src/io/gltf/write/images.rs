//! Images that lie in files of their own.

use std::{
    collections::BTreeMap,
    path::{Path, PathBuf},
};

use super::{
    additions::{Additions, NewView},
    json::{self, Members},
};
use crate::{Result, encode::bytes, io::gltf::buffers::relative};

/// An image of a document that names a file.
pub(super) struct Named {
    /// Its number among the images.
    pub number: usize,
    pub uri: String,
    /// The file, in the folder of the document.
    pub path: PathBuf,
}

/// The images that name files; the notes say which of them lie elsewhere.
pub(super) fn named(sections: &Members, notes: &mut Vec<String>) -> Result<Vec<Named>> {
    let mut found = Vec::new();
    let entries = json::entries(sections.get("images").unwrap_or("[]"))?;
    for (number, entry) in entries.iter().enumerate() {
        let uri = Members::parse(entry)?.get("uri").map(serde_json::from_str);
        let Some(Ok(uri)) = uri else {
            continue;
        };
        let uri: String = uri;
        if uri.starts_with("data:") {
            continue;
        }
        match relative(&uri) {
            Ok(path) => found.push(Named { number, uri, path }),
            Err(_) => notes.push(format!(
                "images[{number}] names {uri:.100}, which is not in the folder of the document: the name stays as it is"
            )),
        }
    }
    Ok(found)
}

/// The bytes of an image, or a note that they cannot be had.
pub(super) fn read(image: &Named, folder: &Path, notes: &mut Vec<String>) -> Option<Vec<u8>> {
    match bytes::read(&folder.join(&image.path)) {
        Ok(bytes) => Some(bytes),
        Err(error) => {
            let number = image.number;
            notes.push(format!("images[{number}] stays a name: {error}"));
            None
        }
    }
}

/// Takes the images of files into the buffer.
pub(super) fn embed(
    sections: &mut Members,
    folder: &Path,
    additions: &mut Additions,
    notes: &mut Vec<String>,
) -> Result<()> {
    let images = named(sections, notes)?;
    if images.is_empty() {
        return Ok(());
    }
    let mut entries = json::entries(sections.get("images").unwrap_or("[]"))?;
    let mut views: BTreeMap<PathBuf, (usize, &str)> = BTreeMap::new();
    for image in images {
        if !views.contains_key(&image.path) {
            let Some(bytes) = read(&image, folder, notes) else {
                continue;
            };
            let Some(kind) = media_type(&bytes) else {
                notes.push(format!(
                    "images[{}] stays a name: {} is no PNG, JPEG, WebP, AVIF, KTX2 or DDS",
                    image.number, image.uri
                ));
                continue;
            };
            let view = additions.view(NewView {
                bytes,
                ..NewView::default()
            });
            views.insert(image.path.clone(), (view, kind));
        }
        let (view, kind) = views[&image.path];
        let mut entry = Members::parse(&entries[image.number])?;
        entry.remove(&["uri"]);
        entry.set("mimeType", json::quoted(kind));
        entry.set("bufferView", view.to_string());
        entries[image.number] = entry.to_string();
    }
    sections.set("images", json::array(&entries));
    Ok(())
}

/// The media type that the first bytes of an image show.
pub(super) fn media_type(bytes: &[u8]) -> Option<&'static str> {
    let at = |offset: usize, sign: &[u8]| bytes.get(offset..).is_some_and(|b| b.starts_with(sign));
    type Sign<'a> = (usize, &'a [u8]);
    let types: [(&[Sign<'_>], &str); 6] = [
        (&[(0, b"\x89PNG\r\n\x1a\n")], "image/png"),
        (&[(0, b"\xff\xd8\xff")], "image/jpeg"),
        (&[(0, b"RIFF"), (8, b"WEBP")], "image/webp"),
        (&[(4, b"ftypavif")], "image/avif"),
        (&[(0, b"\xabKTX 20\xbb\r\n\x1a\n")], "image/ktx2"),
        (&[(0, b"DDS ")], "image/vnd-ms.dds"),
    ];
    let fits = |signs: &[Sign<'_>]| signs.iter().all(|&(offset, sign)| at(offset, sign));
    types
        .into_iter()
        .find(|(signs, _)| fits(signs))
        .map(|(_, kind)| kind)
}
