//! Mesh files: what survives, what is refused and where.

mod files;
mod gltf;
mod gltf_assets;
mod gltf_documents;
mod gltf_hostile;
mod gltf_pictures;
mod gltf_round_trips;
mod gltf_write;
mod hostile;
mod mesh_methods;
mod readers;
