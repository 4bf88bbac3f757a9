//! Mesh files: what survives, what is refused and where.

mod files;
mod hostile;
mod mesh_methods;
mod readers;
