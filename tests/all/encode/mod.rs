//! What is written besides meshes: pictures, arrays, reports, hashes.

mod arrays;
mod formats;
