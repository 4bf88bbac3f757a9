//! STL (3D Systems, 1988), text and binary, in and out.

mod read;
mod write;

pub(super) use read::{is_ascii, is_binary, read};
pub(super) use write::encode;
