//! Mesh files: what survives, what is refused and where.

mod files;
mod gltf;
mod gltf_hostile;
mod hostile;
mod mesh_methods;
mod readers;
