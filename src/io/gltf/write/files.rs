//! Documents as files: GLB, which is one, and glTF, which names a buffer and images beside it.

use std::{
    ffi::OsStr,
    fs,
    path::{Path, PathBuf},
};

use super::{
    Written, document, images,
    json::{self, Members},
};
use crate::{
    Error, Result,
    encode::atomic,
    io::Format,
    mesh::{Asset, Mesh},
};

/// The bytes of a mesh in one file that holds everything, and notes about what it cannot keep.
///
/// # Errors
/// [`Error::Unsupported`] beyond 4 GiB in a GLB, and for coordinates that are no 32-bit floats;
/// [`Error::Input`] where the document of the mesh is damaged.
pub(in crate::rooms::io) fn encode(mesh: &Mesh, format: Format) -> Result<(Vec<u8>, Vec<String>)> {
    let mut written = document(mesh, true)?;
    let bytes = if format == Format::Glb {
        glb(&mut written)?
    } else {
        let uri = format!(
            "data:application/octet-stream;base64,{}",
            base64(&written.binary)
        );
        text(&mut written, &uri)?
    };
    Ok((bytes, written.notes))
}

/// Writes the files of a mesh, the one that names the others last; each is complete or not there.
///
/// # Errors
/// As [`encode`], and [`Error::Io`].
pub(in crate::rooms::io) fn write(path: &Path, mesh: &Mesh, format: Format) -> Result<Vec<String>> {
    let folder = folder_of(path);
    let asset = mesh.materials().asset.as_deref();
    let same_folder = asset.is_some_and(|asset| lies_in(asset, folder));
    if format == Format::Glb {
        let is_one_file = asset.is_some_and(has_own_buffer);
        let mut written = document(mesh, !(same_folder && is_one_file))?;
        let bytes = glb(&mut written)?;
        atomic::write(path, |file| file.write_all(&bytes))?;
        return Ok(written.notes);
    }
    let mut written = document(mesh, false)?;
    let mut uri = String::new();
    if !written.binary.is_empty() {
        let name = buffer_name(path);
        // Where the document is replaced, so is its buffer; any other file stays.
        let name = free_name(folder, &name, &written.binary, path.exists());
        atomic::write(&folder.join(&name), |file| file.write_all(&written.binary))?;
        uri = escaped(&name);
    }
    if let Some(asset) = asset.filter(|_| !same_folder) {
        copy_images(&mut written, asset, folder)?;
    }
    let bytes = text(&mut written, &uri)?;
    atomic::write(path, |file| file.write_all(&bytes))?;
    Ok(written.notes)
}

/// Whether the images that a document names lie in this very folder.
pub(super) fn lies_in(asset: &Asset, folder: &Path) -> bool {
    let real = |folder: &Path| fs::canonicalize(or_here(folder)).ok();
    real(&asset.folder).is_some_and(|there| Some(there) == real(folder))
}

/// The file for the buffer of a document at `path`, as far as that is known before the buffer is: `None` where a file of
/// that name belongs to something else, so that the buffer gets another name.
pub(in crate::rooms::io) fn buffer_beside(path: &Path) -> Option<PathBuf> {
    let buffer = path.with_file_name(buffer_name(path));
    let is_others = buffer.is_file() && !path.exists();
    (!is_others).then_some(buffer)
}

fn buffer_name(path: &Path) -> PathBuf {
    let stem = path.file_stem().unwrap_or(OsStr::new("buffer"));
    PathBuf::from(format!("{}.bin", stem.to_string_lossy()))
}

/// Whether the first buffer lies in the document's own file.
fn has_own_buffer(asset: &Asset) -> bool {
    let buffers = asset.sections.iter().find(|(name, _)| name == "buffers");
    let entries = buffers.and_then(|(_, text)| json::entries(text).ok());
    let first = entries.and_then(|entries| Members::parse(entries.first()?).ok());
    first.is_some_and(|first| first.get("uri").is_none())
}

fn folder_of(path: &Path) -> &Path {
    or_here(path.parent().unwrap_or(Path::new("")))
}

fn or_here(folder: &Path) -> &Path {
    if folder.as_os_str().is_empty() {
        Path::new(".")
    } else {
        folder
    }
}

/// Copies the images of the document's folder; one whose name another file has gets another name.
pub(super) fn copy_images(written: &mut Written, asset: &Asset, folder: &Path) -> Result<()> {
    let named = images::named(&written.sections, &mut written.notes)?;
    let mut entries = json::entries(written.sections.get("images").unwrap_or("[]"))?;
    let mut renamed = false;
    for image in named {
        let Some(bytes) = images::read(&image, &asset.folder, &mut written.notes) else {
            continue;
        };
        let name = free_name(folder, &image.path, &bytes, false);
        let target = folder.join(&name);
        if !target.exists() {
            let parent = folder_of(&target);
            fs::create_dir_all(parent).map_err(|e| Error::io("create", parent, e))?;
            atomic::write(&target, |file| file.write_all(&bytes))?;
        }
        if name != image.path {
            let mut entry = Members::parse(&entries[image.number])?;
            entry.set("uri", json::quoted(&escaped(&name)));
            entries[image.number] = entry.to_string();
            renamed = true;
        }
    }
    if renamed {
        written.sections.set("images", json::array(&entries));
    }
    Ok(())
}

/// The name itself, or one with a number, under which there is no other file than one of these very bytes.
fn free_name(folder: &Path, name: &Path, bytes: &[u8], replaces: bool) -> PathBuf {
    let is_free = |name: &Path| {
        let path = folder.join(name);
        !path.exists() || fs::read(path).is_ok_and(|found| found == bytes)
    };
    if replaces || is_free(name) {
        return name.to_path_buf();
    }
    let stem = name.file_stem().unwrap_or_default().to_string_lossy();
    let extension = name.extension().unwrap_or_default().to_string_lossy();
    let numbered = (2..).map(|n| name.with_file_name(format!("{stem}-{n}.{extension}")));
    let mut free = numbered.filter(|name| is_free(name));
    free.next().unwrap_or_else(|| name.to_path_buf())
}

/// A path as a URI.
pub(super) fn escaped(path: &Path) -> String {
    let mut uri = String::new();
    for byte in path.to_string_lossy().replace('\\', "/").bytes() {
        if byte.is_ascii_alphanumeric() || b"-._~/".contains(&byte) {
            uri.push(char::from(byte));
        } else {
            uri += &format!("%{byte:02X}");
        }
    }
    uri
}

/// Describes the one buffer, unless its entry is right as it is.
pub(super) fn set_buffer(written: &mut Written, uri: Option<&str>) -> Result<()> {
    let sections = &mut written.sections;
    if written.binary.is_empty() {
        sections.remove(&["buffers"]);
        return Ok(());
    }
    let entries = json::entries(sections.get("buffers").unwrap_or("[]"))?;
    let mut first = Members::parse(entries.first().map_or("{}", String::as_str))?;
    let length = written.binary.len().to_string();
    let uri = uri.map(json::quoted);
    let is_right = first.get("byteLength") == Some(&length) && first.get("uri") == uri.as_deref();
    if entries.len() == 1 && is_right {
        return Ok(());
    }
    match uri {
        Some(uri) => first.set("uri", uri),
        None => first.remove(&["uri"]),
    }
    first.set("byteLength", length);
    first.remove_within("extensions", super::pack::MESHOPT)?;
    sections.set("buffers", json::array(&[first.to_string()]));
    Ok(())
}

/// The document as text that names its buffer.
fn text(written: &mut Written, uri: &str) -> Result<Vec<u8>> {
    set_buffer(written, Some(uri))?;
    Ok((written.sections.to_string() + "\n").into_bytes())
}

/// The document and its buffer in the binary container.
fn glb(written: &mut Written) -> Result<Vec<u8>> {
    set_buffer(written, None)?;
    let mut json = written.sections.to_string().into_bytes();
    json.resize(json.len().next_multiple_of(4), b' ');
    let binary = &written.binary;
    let padded = binary.len().next_multiple_of(4);
    let of_binary = if binary.is_empty() { 0 } else { 8 + padded };
    let total = 12 + 8 + json.len() + of_binary;
    let Ok(length) = u32::try_from(total) else {
        return Err(Error::Unsupported(format!(
            "{total} bytes are more than a GLB file can have; write .gltf"
        )));
    };
    let mut bytes = Vec::with_capacity(total);
    bytes.extend_from_slice(b"glTF");
    for word in [2, length, json.len() as u32] {
        bytes.extend(word.to_le_bytes());
    }
    bytes.extend_from_slice(b"JSON");
    bytes.append(&mut json);
    if !binary.is_empty() {
        bytes.extend((padded as u32).to_le_bytes());
        bytes.extend_from_slice(b"BIN\0");
        bytes.extend_from_slice(binary);
        bytes.resize(total, 0);
    }
    Ok(bytes)
}

/// Base64 (RFC 4648), padded.
fn base64(bytes: &[u8]) -> String {
    const DIGITS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut text = String::with_capacity(bytes.len().div_ceil(3) * 4);
    for three in bytes.chunks(3) {
        let byte = |i: usize| u32::from(three.get(i).copied().unwrap_or(0));
        let bits = byte(0) << 16 | byte(1) << 8 | byte(2);
        for place in 0..4 {
            text.push(if place > three.len() {
                '='
            } else {
                char::from(DIGITS[(bits >> (18 - 6 * place)) as usize % 64])
            });
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn base64_is_that_of_its_standard() {
        for (plain, coded) in [
            ("", ""),
            ("f", "Zg=="),
            ("fo", "Zm8="),
            ("foo", "Zm9v"),
            ("foobar", "Zm9vYmFy"),
        ] {
            assert_eq!(base64(plain.as_bytes()), coded);
        }
    }
}
