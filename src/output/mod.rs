//! Results as files: pictures, arrays, reports, and hashes of pixels.
//!
//! Every file is written as a whole or not at all ([`crate::io::atomic`]), and equal results give equal bytes. Pictures
//! are compared by the hash of their pixels ([`hash`]), never by that of a PNG file, which depends on the encoder.

pub mod billboards;
mod font;
pub mod golden;
pub mod hash;
pub mod npy;
pub mod png;
pub mod report;
pub mod sheet;
pub mod visibility_ply;
