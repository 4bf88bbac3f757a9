//! The command as a user runs it.

mod beside;
mod bound;
mod compare;
mod exit_codes;
mod help;
mod levels;
mod lod;
mod normals;
mod odd_files;
mod replay;
mod visibility;
mod weights;
