//! Simplify 3D meshes by what they look like, with the same bits on every machine and no GPU.
//!
//! lodmark is the pure-CPU reference for image-driven mesh simplification (Lindstrom & Turk 2000) and the geometric
//! methods it is measured against. Its rasterizer is exact, its results are reproducible, and both can be pinned: by
//! continuous integration, by machines without a GPU, and by GPU implementations that want to know whether they are
//! right.
//!
//! ```
//! use lodmark::{Mesh, Options, Preset, Target, compare, simplify};
//!
//! # let program = std::env::current_exe().expect("a test is a file");
//! # let folder = program.parent().expect("a file is in a folder").join("example");
//! # std::fs::create_dir_all(&folder).and_then(|()| std::env::set_current_dir(&folder)).expect("a folder");
//! # let place = |i| [(i % 17) as f32, (i / 17) as f32, ((i * i) % 7) as f32];
//! # let corners: Vec<f32> = (0..289).flat_map(place).collect();
//! # let quad = |i: u32| [i, i + 1, i + 17, i + 1, i + 18, i + 17];
//! # let faces: Vec<u32> = (0..272).filter(|i| i % 17 < 16).flat_map(quad).collect();
//! # Mesh::from_slices(&corners, &faces)?.write("bunny.ply")?;
//! let mesh = Mesh::read("bunny.ply")?; // welded, in canonical order
//! let options = Options::image(Target::ratio(0.5)).preset(Preset::Fast);
//! let outcome = simplify(&mesh, &options)?; // simplify_with(.., &progress) to watch or stop it
//! println!("{} of {} triangles", outcome.mesh.triangles().len(), mesh.triangles().len());
//! let report = compare(&mesh, &outcome.mesh)?;
//! println!("largest distance {:?}", report.errors.distances.distance_max);
//! outcome.mesh.write("bunny.lod.ply")?;
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
//! # Without the command
//!
//! The default feature `cli` builds the command and brings what only it needs: a library asks for
//! `default-features = false`.
//!
//! # Architecture
//!
//! Everything behind the names on this page is free to change; tests of this crate open it by the feature `internals`,
//! for which no promise holds. Data flows one way, and a test holds the table of allowed imports.
//!
//! ```text
//! error, num -> geometry -> mesh -> io            encode (png, npy, json, hash): low, used by all
//!                            |
//!                            +-> view -> raster -> metric ------+
//!                            |             +----> visibility ---+     pictures
//!                            |             +----> validate (why a pixel differs) ------------------------> cli
//!                            +-> bound  (view cells, envelopes)-+
//!                            +-> collapse ----------------------+-> simplify -> chain -> selfcheck, front -> cli
//! ```
//!
//! | room | owns |
//! |---|---|
//! | `num` | where a float becomes fixed point, the only callers of sqrt and libm, the scaled frame |
//! | `parallel` | work on all threads in the order of a list; nothing else shares work among threads |
//! | `geometry` | symmetric 3x3, triangles, boxes, the one tree over triangles: what bound, metric and simplify share |
//! | `encode` | PNG, npy, JSON, hashes of pixels, contact sheets; whole files or none |
//! | `mesh` | positions, triangles, corner attributes (wedges), materials; adjacency, welding, canonical order, findings, generators |
//! | `io` | OBJ, PLY and STL, in and out, and glTF; hostile input ends here |
//! | `view` | cameras, the minimum bounding sphere, view sets and view files |
//! | `raster` | `draw`: clip, snap, spans, depth, ids, shading; `unrender/buckets` and `unrender/layers`, two engines with the same bits |
//! | `metric` | squared luma error, RMS, PSNR, silhouettes, surface distance, image difference; the report of candidates against a reference |
//! | `visibility` | ID buffers of cameras all around: V(t), V(M), partial counts, hidden parts |
//! | `validate` | why a pixel of an ID buffer differs: the proof of our own by ray casting |
//! | `bound` | guarantees: view cells, valid regions of points and faces, tolerance volumes, an independent verifier |
//! | `collapse` | one engine for every method: live mesh, queue, legality, wedges, history and replay; no word about pictures |
//! | `simplify` | one folder a method: options, run, report; targets and outcome |
//! | `chain` | levels of detail: their sizes, runs and measured switch distances; their files and the manifest |
//! | `selfcheck` | goldens: what this version computes for a fixed set of small cases |
//! | `front` | the functions of this page that no room has in that form |
//! | `cli` | the command, one file or folder a subcommand |
//!
//! Two seams carry later work: a `collapse::Method` proposes a position and a key for a site and hears of commits;
//! `raster::Unrender` engines take a change, not a collapse.
//!
//! ## The way of an edge from the queue to its commit
//!
//! 1. `collapse/engine`: the edge with the smallest key stands at the front of the queue.
//! 2. Where its key is not exact, the engine gathers its edge star from the lists of the live mesh.
//! 3. `collapse/legality` says where the rules allow the new vertex at all.
//! 4. The method places it (`simplify/memoryless`), `collapse/fold` tests the shapes, and the method prices the
//!    collapse: the image-driven one turns the patch into a scene edit and asks `raster/unrender` for the difference of
//!    every view. The edge goes back to the queue under the exact key.
//! 5. At the front again, the star becomes the patch that is committed: faces that go, faces that come, wedges.
//! 6. The method reviews it; the patch changes the lists of the live mesh.
//! 7. The method and the observers hear of it: pictures follow, the history keeps a record.
//! 8. The engine re-keys the edges around the new vertex.
//!
//! One collapse has three shapes: a `Patch` of the live mesh, the `SceneEdit` that pictures are asked about, and the
//! `Record` of the history. A memoryless one has no second, and passes 12 files; an image-driven one passes 20:
//!
//! | room | files of the way |
//! |---|---|
//! | `collapse` | `engine/mod`, `engine/queue`, `edge_star`, `live/mod`, `live/incidence`, `legality`, `fold`, `patch`, `history` |
//! | `simplify/memoryless` | `objective`; not for images: `method`, `vertex_sums` |
//! | `simplify/image` | `method`, `pictures`, `slots` |
//! | `raster/unrender` | `scene_edit`, `layers/mod`, `layers/projected`, `layers/view`, `layers/probe`, `layers/view_delta`, `layers/fragment_lists` |
//!
//! Attributes add those of `collapse/wedge`. Not counted are files that only declare a seam (`collapse/method`,
//! `collapse/observer`, `unrender/mod`), the test for sheets that touch in a point (`collapse/pinch`), and what every
//! picture is drawn by (`raster/draw`).
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

/// The rooms, public to the tests and benches of this crate and to nobody else.
#[path = ""]
mod rooms {
    pub mod bound;
    pub mod chain;
    #[cfg(feature = "cli")]
    pub mod cli;
    pub mod collapse;
    pub mod encode;
    pub mod geometry;
    pub mod io;
    pub mod mesh;
    pub mod metric;
    pub mod num;
    pub mod raster;
    pub mod selfcheck;
    pub mod simplify;
    pub mod validate;
    pub mod view;
    pub mod visibility;
}
#[cfg(feature = "internals")]
pub use rooms::*;
#[cfg(not(feature = "internals"))]
use rooms::*;

pub use chain::{chain, chain_with};
pub use error::{Error, Result};
pub use front::{
    compare, compare_with, options, render, render_with, reports, verify, views, visibility,
    visibility_with,
};
pub use mesh::{Attributes, Channel, ChannelKind, Materials, Mesh, MeshParts};
pub use num::Precision;
pub use progress::{Progress, Silent};
pub use simplify::{
    History, Options, Outcome, Stop, Target, image::Preset, simplify, simplify_with,
};

/// The whole command: reads the arguments of the process and runs them.
#[cfg(feature = "cli")]
#[doc(hidden)]
#[must_use]
pub fn command() -> std::process::ExitCode {
    cli::main()
}
