//! Files: from bytes to a clean [`Mesh`](crate::mesh::Mesh) and back. Hostile input ends here.
//!
//! A reader returns a valid mesh, notes about what the mesh could not keep, or an error that says where the file is
//! wrong; it needs time and memory in proportion to the size of the file, whatever the file declares. A writer returns
//! notes about what the format cannot keep; reading back what it wrote changes no bit of the rest. The network, and
//! files other than the one named (material libraries), are never touched.

mod decimal;
mod format;
mod obj_read;
mod obj_scan;
mod obj_write;
mod per_vertex;
mod ply_header;
mod ply_read;
mod ply_source;
mod ply_write;
mod rows;
mod stl_read;
mod stl_write;
mod summary;

pub use crate::encode::{atomic, bytes};
pub use format::{Encoding, Format, Loaded, encode, read, read_bytes, writable_format, write};
pub use summary::Summary;
