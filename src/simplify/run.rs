//! From a mesh and options to an outcome.

use super::{
    MethodOptions, Options, Outcome, Stop, memoryless::Memoryless, quadric::QuadricMethod,
};
use crate::{
    Error, Progress, Result,
    collapse::{Counters, End, Engine, LiveMesh, Method, Recorder, Target},
    mesh::Mesh,
    num::{Frame, math},
};

/// Simplifies a mesh; the result has no more triangles than wanted, or says why not.
///
/// The mesh is taken as it is: weld it and put it in canonical order first. Triangle and vertex ids of the history
/// are those of `mesh`. O(n log n).
///
/// # Errors
/// [`Error::Usage`] for options out of range, [`Error::Interrupted`].
pub fn simplify(mesh: &Mesh, options: &Options, progress: &dyn Progress) -> Result<Outcome> {
    options.check()?;
    let triangles = options.target.triangles(mesh.triangles().len())?;
    let json = serde_json::to_string(options).map_err(|e| Error::Internal(e.to_string()))?;
    let frame = frame_of(mesh);
    let recorder = Recorder::new(mesh, frame, json);
    if mesh.triangles().len() <= triangles {
        return Ok(Outcome {
            mesh: mesh.clone(),
            history: recorder.finish(),
            stop: Stop::TargetAboveInput,
            counters: Counters::default(),
        });
    }
    let live = LiveMesh::new(mesh, frame);
    let target = Target { triangles };
    match &options.method {
        MethodOptions::Memoryless(own) => {
            let method = Memoryless { options: *own };
            collapse(live, method, options, target, recorder, progress)
        }
        MethodOptions::Quadric(own) => {
            let method = QuadricMethod::new(&live, own);
            collapse(live, method, options, target, recorder, progress)
        }
    }
}

fn collapse<M: Method>(
    live: LiveMesh,
    method: M,
    options: &Options,
    target: Target,
    mut recorder: Recorder,
    progress: &dyn Progress,
) -> Result<Outcome> {
    let mut engine = Engine::new(live, method, options.rules, options.schedule);
    let end = engine.run(target, &mut recorder, progress)?;
    let (live, _, counters) = engine.into_parts();
    Ok(Outcome {
        mesh: live.to_mesh().map_err(Error::Internal)?,
        history: recorder.finish(),
        stop: match end {
            End::TargetReached => Stop::TargetReached,
            End::ErrorLimit => Stop::ErrorLimit,
            End::NoLegalCollapse { blocked } => Stop::NoLegalCollapse { refusals: blocked },
        },
        counters,
    })
}

/// The frame in which half the bounding box's diagonal, hence the bounding radius, is less than 1.
#[must_use]
pub fn frame_of(mesh: &Mesh) -> Frame {
    let size = mesh.bounds().map_or(0.0, |(low, high)| {
        // Halves before the difference: the difference of two finite coordinates may overflow.
        let half = high * 0.5 - low * 0.5;
        let largest = half.max_element();
        if largest > 0.0 {
            largest * math::length(half / largest)
        } else {
            0.0
        }
    });
    Frame::for_size(size)
}
