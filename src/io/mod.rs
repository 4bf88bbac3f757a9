//! Files: from bytes to a clean [`Mesh`](crate::mesh::Mesh) and back. Hostile input ends here.
//!
//! A reader returns a valid mesh, notes about what the mesh could not keep, or an error that says where the file is
//! wrong; it needs time and memory in proportion to the size of the file, whatever the file declares. A writer returns
//! notes about what the format cannot keep; reading back what it wrote changes no bit of the rest. The network is never
//! touched, nor are files other than the one named (material libraries, images), except the buffers that a glTF document
//! names in its own folder or below.

mod attribute_rows;
mod decimal;
mod flip;
mod format;
mod gltf;
mod obj;
mod per_vertex;
mod ply;
mod read;
mod stl;
mod summary;
mod words;
mod write;

pub use format::{Encoding, Format};
pub use gltf::{SharedImages, share_images};
pub use read::{Loaded, read, read_bytes};
pub use summary::Summary;
pub use write::{encode, writable_format, write, written_beside};
