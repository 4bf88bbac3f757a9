//! Files and bytes that know nothing of meshes: pictures, arrays, reports and hashes; a low room that anybody may use.
//!
//! Every file is written as a whole or not at all ([`atomic`]), and equal results give equal bytes. Pictures are compared
//! by the hash of their pixels ([`hash`]), never by that of a PNG file, which depends on the encoder.

pub mod atomic;
pub mod byte_cursor;
pub mod bytes;
mod chart_axis;
mod font;
pub mod hash;
pub mod json;
pub mod line_chart;
pub mod npy;
pub mod png;
pub mod sealed_file;
pub mod sheet;
