//! Polishing: after the last collapse the vertices that are left move, and edges flip, wherever that makes the pictures
//! better.
//!
//! Not in the papers. Sweeps visit the vertices by ascending id, but for those around which the pictures hardly differ; a
//! vertex tries positions along its normal and two
//! tangents at a distance that halves whenever none of them is better. Every few sweeps all edges are tried for a flip,
//! and the cameras are turned as a whole and the original drawn again, so that the mesh fits the model and not the
//! noise of one set of pictures. Every change that is kept lowers the error of the pictures of that moment, exactly, or
//! where the surface counts too, brings a vertex so much nearer to the original that it is worth an error.
//!
//! Vertices are searched in independent sets: no two share a neighbour, each against the same pictures; then the batch is
//! committed one by one, and what an earlier one has made worse is taken back. Batches do not depend on the number of
//! threads, so neither does the result.

mod limits;
mod search;
mod sweep;

use serde::{Deserialize, Serialize};

use super::Pictures;
use crate::{
    Progress, Result,
    collapse::{LiveMesh, Observer},
};
pub use limits::Limits;
use sweep::Polisher;

/// Amount of polishing.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub struct Polish {
    /// Sweeps over all vertices; 0 is no polishing.
    pub sweeps: u32,
    /// Edges are tried for flips after every n-th sweep; 0 is never.
    pub flips_every: u32,
    /// Cameras are turned after every n-th sweep; 0 is never.
    pub cameras_every: u32,
    /// Weight of the share of the distance from the original against the share of the image error in a change;
    /// 0 is nothing. See `DistancePenalty`.
    pub deviation_weight: f64,
    /// Least share of the squared error that the triangles around a vertex or an edge hold for it to be tried, times the
    /// number of the sweep, 1 for the first: a star yields a few percent of its error, and the less the later. 0 tries all.
    #[serde(default)]
    pub least_share: f64,
}

/// Counts of the work of polishing. The same for every number of threads.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct PolishCounters {
    /// Positions and flips whose pictures were drawn.
    pub evaluations: u64,
    /// Vertices moved.
    pub moves: u64,
    /// Edges flipped.
    pub flips: u64,
    /// Changes taken back because one just before had made them worse.
    pub reverted: u64,
    /// For every set of cameras, the root mean square of the luma differences when they came and when they went.
    pub cameras: Vec<[f64; 2]>,
}

/// Makes pictures of a mesh with cameras turned for a round (1, 2, ...); none where the cameras are to stay.
pub type Turn<'a> = dyn FnMut(&LiveMesh, u32) -> Result<Option<Pictures>> + 'a;

/// Polishes `live`, which `pictures` show, with cameras that `fresh` turns.
///
/// # Errors
/// [`crate::Error::Interrupted`], and what `fresh` fails with; the mesh is then somewhere in between.
pub fn polish(
    live: &mut LiveMesh,
    pictures: Pictures,
    options: Polish,
    limits: Limits<'_>,
    fresh: &mut Turn<'_>,
    observer: &mut dyn Observer,
    progress: &dyn Progress,
) -> Result<(Pictures, PolishCounters)> {
    let mut polisher = Polisher::new(live, pictures, limits, progress);
    let mut rms = polisher.pictures.rms();
    let every = |n: u32, sweep: u32| n > 0 && sweep.is_multiple_of(n);
    for sweep in 0..options.sweeps {
        if sweep > 0
            && every(options.cameras_every, sweep)
            && let Some(pictures) = fresh(polisher.live, sweep / options.cameras_every)?
        {
            let now = polisher.pictures.rms();
            polisher.counters.cameras.push([rms, now]);
            polisher.look_through(pictures);
            rms = polisher.pictures.rms();
        }
        let least_share = options.least_share * f64::from(sweep + 1);
        polisher.moves((sweep, options.sweeps), least_share, observer)?;
        if every(options.flips_every, sweep + 1) {
            polisher.flips(least_share, observer)?;
        }
    }
    let Polisher {
        pictures,
        mut counters,
        ..
    } = polisher;
    if options.sweeps > 0 {
        counters.cameras.push([rms, pictures.rms()]);
    }
    Ok((pictures, counters))
}
