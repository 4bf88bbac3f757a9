//! Simplify 3D meshes by what they look like, with the same bits on every machine and no GPU.
//!
//! lodmark is the pure-CPU reference for image-driven mesh simplification (Lindstrom & Turk 2000) and the geometric
//! methods it is measured against. Its rasterizer is exact, its results are reproducible, and both can be pinned: by
//! continuous integration, by machines without a GPU, and by GPU implementations that want to know whether they are
//! right.
//!
//! ```
//! use lodmark::{Silent, mesh, simplify};
//!
//! let mesh = mesh::canonical(&mesh::generate::icosphere(3)).mesh;
//! let options = simplify::Options::image(simplify::Target::Triangles(200));
//! let outcome = simplify::simplify(&mesh, &options)?;
//! assert_eq!(outcome.mesh.triangles().len(), 200);
//! # Ok::<(), lodmark::Error>(())
//! ```
//!
//! # The promise
//!
//! For one version of lodmark with its `Cargo.lock`: every image, ID buffer, image cost and simplified mesh is the
//! same, bit for bit, for every thread count, build profile and CPU.
//!
//! - From the snapped vertex on, pictures are integers: coverage, depth, ids, luma, squared differences. Sums of
//!   integers have no order.
//! - A pixel is the minimum of `(depth, triangle id)`. Ids are stable: a collapse removes ids and never reuses or
//!   renumbers them, a survivor keeps its id, and a candidate is evaluated under the ids it would have.
//! - Before the snap there is `f64` with `+ - * / sqrt` in one written order, and `libm` where a transcendental function
//!   is unavoidable (`num::math`).
//! - Work happens in a frame scaled by a power of two (`num::Frame`), undone exactly on output.
//! - A new position is rounded to the file's precision before its cost is evaluated: the pictures that drove a choice
//!   are those of the file that is written.
//! - Queues have a total order: image cost, geometric cost, squared edge length, ids.
//! - Incremental equals from scratch: maintained pictures are those of a fresh rendering, the maintained error is the
//!   recomputed one, and the cost of a freshly evaluated edge is the error after minus the error before. Exactly.
//!
//! # Architecture
//!
//! Data flows one way; an import only points to the left, and a test holds the table of allowed imports.
//!
//! ```text
//! error, num -> geometry -> mesh -> io            encode: low, used by all
//!                            |
//!                            +-> view -> raster -> metric --+     pictures
//!                            |             +-> visibility --+
//!                            +-> bound ---------------------+
//!                            +-> collapse ------------------+-> simplify -> selfcheck -> cli
//! ```
//!
//! | module | owns |
//! |---|---|
//! | `num` | where a float becomes fixed point, the only callers of sqrt and libm, the scaled frame |
//! | `geometry` | symmetric 3x3 matrices, boxes, triangles, the one tree over triangles |
//! | `mesh` | positions, triangles, corner attributes (wedges), materials; adjacency, welding, canonical order, findings, generators |
//! | `io` | OBJ, PLY and STL, in and out; hostile input ends here |
//! | `view` | cameras, the minimum bounding sphere, view sets and view files |
//! | `raster` | clip, snap, spans, depth, ids, shading; un-rendering |
//! | `metric` | squared luma error, RMS, PSNR, silhouettes, surface distance, image difference |
//! | `visibility` | what cameras all around see of every triangle: V(t), V(M), partial surveys, hidden parts; the proof of ID buffers by ray casting |
//! | `bound` | what is guaranteed: view cells, valid regions of points and faces, tolerance volumes, an independent verifier |
//! | `collapse` | one engine for every method: live mesh, queue, legality, wedges, history and replay |
//! | `simplify` | the methods, their options and outcomes |
//! | `encode` | PNG, npy, JSON, hashes of pixels, contact sheets; whole files or none |
//! | `selfcheck` | goldens: what this version computes for a fixed set of small cases |
//!
//! Two seams carry later work: a `collapse::Method` proposes a position and a key for a site and hears of commits;
//! `raster::Unrender` engines take a change, not a collapse.
//!
//! # Refusals
//!
//! No GPU and no window, no system fonts, no wall clock or thread count in results, no tolerance in goldens, no
//! hash-map order, no global state, no network.

#![cfg_attr(
    not(feature = "internals"),
    allow(
        dead_code,
        unreachable_pub,
        unused_imports,
        reason = "rooms are public to the tests and benches of this crate only, which use more of them"
    )
)]

mod error;
mod front;
mod parallel;
mod progress;

#[cfg(feature = "internals")]
pub mod bound;
#[cfg(not(feature = "internals"))]
mod bound;
#[cfg(all(feature = "cli", feature = "internals"))]
pub mod cli;
#[cfg(all(feature = "cli", not(feature = "internals")))]
mod cli;
#[cfg(feature = "internals")]
pub mod collapse;
#[cfg(not(feature = "internals"))]
mod collapse;
#[cfg(feature = "internals")]
pub mod encode;
#[cfg(not(feature = "internals"))]
mod encode;
#[cfg(feature = "internals")]
pub mod geometry;
#[cfg(not(feature = "internals"))]
mod geometry;
#[cfg(feature = "internals")]
pub mod io;
#[cfg(not(feature = "internals"))]
mod io;
#[cfg(feature = "internals")]
pub mod mesh;
#[cfg(not(feature = "internals"))]
mod mesh;
#[cfg(feature = "internals")]
pub mod metric;
#[cfg(not(feature = "internals"))]
mod metric;
#[cfg(feature = "internals")]
pub mod num;
#[cfg(not(feature = "internals"))]
mod num;
#[cfg(feature = "internals")]
pub mod raster;
#[cfg(not(feature = "internals"))]
mod raster;
#[cfg(feature = "internals")]
pub mod selfcheck;
#[cfg(not(feature = "internals"))]
mod selfcheck;
#[cfg(feature = "internals")]
pub mod simplify;
#[cfg(not(feature = "internals"))]
mod simplify;
#[cfg(feature = "internals")]
pub mod view;
#[cfg(not(feature = "internals"))]
mod view;
#[cfg(feature = "internals")]
pub mod visibility;
#[cfg(not(feature = "internals"))]
mod visibility;

pub use error::{Error, Result};
pub use front::{
    compare, compare_with, options, render, render_with, reports, verify, views, visibility,
    visibility_with,
};
pub use mesh::{Attributes, Channel, ChannelKind, Materials, Mesh, MeshParts};
pub use num::Precision;
pub use progress::{Progress, Silent};

/// The whole command: reads the arguments of the process and runs them.
#[cfg(feature = "cli")]
#[doc(hidden)]
#[must_use]
pub fn command() -> std::process::ExitCode {
    cli::main()
}
