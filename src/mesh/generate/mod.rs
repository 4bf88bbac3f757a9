//! Generated meshes: the same bits everywhere, for tests, benchmarks, the demo and the self-check.
//!
//! Each is rounded to `f32`. The closed ones ([`tetrahedron`], [`cube`], [`icosphere`], [`shells`], [`torus`],
//! [`interlocking_tori`], [`textured_torus`], [`engine`], [`motor`],
//! [`encased`]) have two triangles at every edge, oriented outward.
//! Counts beyond what a function's documentation allows are brought into that range.

mod city;
mod cube;
mod encased;
mod engine;
mod grid;
mod motor;
mod motor_inside;
mod pcg;
mod probe;
mod solids;
mod sphere;
pub(crate) mod subdivision;
mod torus;

use glam::DVec3;

use super::{Attributes, ChannelKind, Mesh, MeshParts};
use crate::num::Each;

pub use city::{buildings, city, forest, trees};
pub use cube::cube;
pub use encased::encased;
pub use engine::engine;
pub use grid::{Height, grid};
pub use motor::motor;
pub use pcg::Pcg32;
pub use probe::probe;
pub use sphere::{icosphere, shells, tetrahedron};
pub use torus::{interlocking_tori, textured_torus, torus};

/// A mesh by name, made when it is asked for.
type Named = (&'static str, fn() -> Mesh);

/// Meshes by name, of a size that suits a demonstration.
pub const NAMED: [Named; 14] = [
    ("tetrahedron", tetrahedron),
    ("cube", cube),
    ("icosphere", || icosphere(4)),
    ("torus", || torus(1.0, 0.4, 96, 48)),
    ("plane", || grid(32, 32, Height::Flat)),
    ("terrain", || grid(64, 64, Height::Polynomial)),
    ("waves", || grid(64, 64, Height::Waves)),
    ("shells", || shells(4, 3)),
    ("tori", || interlocking_tori(64, 32)),
    ("engine", || engine(2)),
    ("textured-torus", || textured_torus(96, 48)),
    ("probe", probe),
    ("motor", || motor(1)),
    ("encased", || encased(2)),
];

/// The mesh of a name in [`NAMED`]; `None` for other names.
pub fn by_name(name: &str) -> Option<Mesh> {
    let found = NAMED.iter().find(|(known, _)| *known == name);
    found.map(|(_, make)| make())
}

/// A surface in the making.
#[derive(Clone, Debug, Default)]
struct Surface {
    positions: Vec<DVec3>,
    triangles: Vec<[u32; 3]>,
}

impl Surface {
    /// Adds a copy of `other` with its positions moved by `place`, which must not mirror.
    fn add(&mut self, other: &Self, place: impl Fn(DVec3) -> DVec3) {
        let first = self.positions.len() as u32;
        self.positions
            .extend(other.positions.iter().map(|&p| place(p)));
        let moved = other.triangles.iter().map(|t| t.each(|v| v + first));
        self.triangles.extend(moved);
    }

    fn into_mesh(self) -> Mesh {
        finish(MeshParts {
            positions: self.positions,
            triangles: self.triangles,
            ..MeshParts::default()
        })
    }
}

fn finish(parts: MeshParts) -> Mesh {
    Mesh::new(parts).expect("a generator names its own vertices and finite lengths only")
}

fn attributes(kinds: &[ChannelKind], values: Vec<f64>, corners: Vec<[u32; 3]>) -> Attributes {
    Attributes::new(kinds, values, corners).expect("a generator names its own wedges only")
}
