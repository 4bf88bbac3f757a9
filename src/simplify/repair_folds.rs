//! Repair of folds that geometric methods leave.
//!
//! Where the topology is kept, a thin handle or sheet ends as two layers of faces that lie on each other: nothing in a
//! sum of squared distances or volumes is against it. Refusing such collapses would leave the handle with faces that are
//! needed elsewhere (measured on the dragon at 8,191 triangles: 2 % more flat RMS), so they are allowed, and at the end
//! vertices at the folds are moved, by as little as opens them (0.4 % more). Folds of the original stay.
//! Faces that look where none of the original does are turned back in the same way. Both as [`crate::metric::folds`]
//! counts them.

use glam::DVec3;

use crate::{
    Progress, Result,
    collapse::{
        Changes, Freedom, LiveMesh, Observer, Patch, Rules, Star, check_uv_orientation,
        fold_amount, is_folded,
    },
    geometry::double_area,
    mesh::{FramedMesh, Mesh},
    metric::{
        FoldReference, Orientation,
        folds::{FOLD_COSINE, REACH},
    },
    num::{Each, math},
    parallel,
};

/// Opened a little further than what counts as a fold.
const OPEN_COSINE: f64 = FOLD_COSINE + 0.02;

/// A flipped face has an edge of more than a right angle: no other face is tested.
const SHARP_COSINE: f64 = 0.0;

/// Every n-th face of the original is tested first.
const FEW: usize = 16;

/// Times that all faults are visited, at most; the dragon at five levels needed up to 15.
const SWEEPS: u32 = 32;

/// Lengths of moves that are tried, in mean edges at the vertex.
const STEPS: [f64; 6] = [0.03125, 0.0625, 0.125, 0.25, 0.5, 1.0];

/// The parts of the original that are near faces of the simplified mesh, in frame units.
struct Nearby<'a> {
    original: &'a Mesh,
    reach: f64,
}

impl<'a> Nearby<'a> {
    fn new(live: &LiveMesh, original: &'a Mesh) -> Self {
        let frame = live.frame();
        let (low, high) = original.bounds().unwrap_or_default();
        let reach = REACH * math::length(frame.enter(high) - frame.enter(low));
        Self { original, reach }
    }

    /// The part near the middles of `sharp` edges and of the faces at them, of every `stride`-th face: all of them are
    /// enough to find faults.
    fn at_faces(&self, live: &LiveMesh, sharp: &[u32], stride: usize) -> FramedMesh {
        let faces = faces_at(live, sharp).into_iter();
        let boxes = faces.filter_map(|face| {
            let [a, b, c] = live.points(face)?;
            Some([((a + b) + c) / 3.0; 2])
        });
        let edges = sharp.iter().filter_map(|&edge| {
            let [a, b] = live.edge(edge)?.each(|v| live.position(v));
            Some([(a + b) * 0.5; 2])
        });
        self.within(live, boxes.chain(edges), stride)
    }

    /// The part near the faces at some vertices, wherever one of those may go: enough to repair them.
    fn at_vertices(&self, live: &LiveMesh, vertices: &[Vec<u32>]) -> FramedMesh {
        let boxes = vertices.iter().flatten().map(|&v| {
            let faces = live.triangles_at(v).filter_map(|f| live.points(f));
            let start = [live.position(v); 2];
            let [low, high] = faces
                .flatten()
                .fold(start, |[l, h], p| [l.min(p), h.max(p)]);
            let farthest = DVec3::splat(math::length(high - low));
            [low - farthest, high + farthest]
        });
        self.within(live, boxes, 1)
    }

    fn within(
        &self,
        live: &LiveMesh,
        boxes: impl Iterator<Item = [DVec3; 2]>,
        stride: usize,
    ) -> FramedMesh {
        let frame = live.frame();
        let margin = DVec3::splat(self.reach);
        let boxes = boxes.map(|[low, high]| [low - margin, high + margin].each(|p| frame.leave(p)));
        let part = self.original.near(&boxes.collect::<Vec<_>>(), stride);
        part.enter_frame(frame)
    }
}

/// Finds faults where the original nearby is known.
struct Faults(FoldReference);

impl Faults {
    /// Of `sharp` edges and the faces at them, the vertices of every folded edge's faces and of every flipped face.
    fn find(&self, live: &LiveMesh, sharp: &[u32]) -> Vec<Vec<u32>> {
        let is_new = |&e: &u32| {
            let ends = live.edge(e).map(|ends| ends.each(|v| live.position(v)));
            is_folded(live, e, FOLD_COSINE) && ends.is_some_and(|ends| self.0.is_new(ends))
        };
        let corners = |faces: Vec<u32>| {
            let corners = faces.into_iter().filter_map(|f| live.triangle(f));
            let mut corners: Vec<u32> = corners.flatten().collect();
            corners.sort_unstable();
            corners.dedup();
            corners
        };
        let folds = sharp.iter().copied().filter(is_new);
        let folds = folds.map(|edge| corners(faces_at(live, &[edge])));
        let is_flipped = |&f: &u32| live.points(f).is_some_and(|face| self.0.is_flipped(face));
        let flipped = faces_at(live, sharp).into_iter().filter(is_flipped);
        folds
            .chain(flipped.map(|face| corners(vec![face])))
            .collect()
    }

    /// Number of some faces that are flipped.
    fn flipped(&self, faces: impl Iterator<Item = [DVec3; 3]>) -> f64 {
        faces.filter(|&face| self.0.is_flipped(face)).count() as f64
    }
}

/// The faces at edges, ascending.
fn faces_at(live: &LiveMesh, edges: &[u32]) -> Vec<u32> {
    let mut faces: Vec<u32> = edges
        .iter()
        .filter_map(|&edge| live.edge(edge))
        .flat_map(|[a, b]| {
            let fewer = live.valence(a) <= live.valence(b);
            let [a, b] = if fewer { [a, b] } else { [b, a] };
            let at_edge = move |f: &u32| live.triangle(*f).is_some_and(|c| c.contains(&b));
            live.triangles_at(a).filter(at_edge)
        })
        .collect();
    faces.sort_unstable();
    faces.dedup();
    faces
}

/// The edges at which a face can be flipped, of all there are, or of those at some vertices; ascending.
fn sharp_edges(live: &LiveMesh, vertices: Option<&[Vec<u32>]>) -> Vec<u32> {
    let is_sharp = |&edge: &u32| is_folded(live, edge, SHARP_COSINE);
    let Some(vertices) = vertices else {
        return parallel::filter_map(live.edge_ids() as usize, |edge| {
            Some(edge as u32).filter(is_sharp)
        });
    };
    let at = |&v: &u32| live.edges_at(v);
    let mut edges: Vec<u32> = vertices.iter().flatten().flat_map(at).collect();
    edges.sort_unstable();
    edges.dedup();
    edges.retain(is_sharp);
    edges
}

/// Moves vertices at folds that are not near those of the original, and at faces that look where none of the
/// original does.
///
/// O(edges), and O(n) for the original; the rest grows with the faults.
///
/// # Errors
/// [`crate::Error::Interrupted`].
pub(super) fn repair_folds(
    live: &mut LiveMesh,
    original: &Mesh,
    rules: Rules,
    observer: &mut dyn Observer,
    progress: &dyn Progress,
) -> Result<()> {
    progress.step("unfold", 0, u64::from(SWEEPS))?;
    let mut sharp = sharp_edges(live, None);
    // Nearly all of them look where one of a few faces of the original does: no others are needed to see that.
    let nearby = Nearby::new(live, original);
    let some = Orientation::of_part(&nearby.at_faces(live, &sharp, FEW), nearby.reach);
    let agrees = |face| some.as_ref().is_some_and(|sides| sides.agrees(face));
    sharp.retain(|&edge| {
        let mut faces = faces_at(live, &[edge]).into_iter();
        let differs = |f| live.points(f).is_some_and(|face| !agrees(face));
        is_folded(live, edge, FOLD_COSINE) || faces.any(differs)
    });
    let faults = |part: &FramedMesh| Faults(FoldReference::of(part, nearby.reach));
    let mut left = faults(&nearby.at_faces(live, &sharp, 1)).find(live, &sharp);
    if left.is_empty() {
        return Ok(());
    }
    let faults = faults(&nearby.at_vertices(live, &left));
    let mut search = Search::default();
    for sweep in 0..SWEEPS {
        if left.is_empty() {
            break;
        }
        progress.step("unfold", u64::from(sweep), u64::from(SWEEPS))?;
        for around in &left {
            let best = around.iter().filter_map(|&v| {
                let (gain, to) = search.best(live, v, &faults, rules)?;
                Some((gain, v, to))
            });
            // The first on a tie.
            let best = best.reduce(|best, other| if other.0 > best.0 { other } else { best });
            if let Some((_, v, to)) = best {
                search.star.gather(live, v);
                search.star.patch(live, to, &mut search.patch);
                live.apply(&search.patch, &mut search.changes);
                observer.committed(live, &search.patch);
            }
        }
        // A move changes nothing but the faces at the vertices of a fault.
        let sharp = sharp_edges(live, Some(&left));
        left = faults.find(live, &sharp);
    }
    Ok(())
}

#[derive(Default)]
struct Search {
    star: Star,
    patch: Patch,
    changes: Changes,
}

impl Search {
    /// The move of a vertex that repairs most for the volume which it sweeps, if one repairs anything; and how much
    /// that is.
    fn best(
        &mut self,
        live: &LiveMesh,
        vertex: u32,
        faults: &Faults,
        rules: Rules,
    ) -> Option<(f64, DVec3)> {
        let Self { star, patch, .. } = self;
        star.gather(live, vertex);
        let normal = star.normal(live).into_iter().flat_map(|n| [n, -n]);
        let directions: Vec<DVec3> = match star.freedom {
            Freedom::Fixed => return None,
            Freedom::Normal => normal.collect(),
            Freedom::Free => around().chain(normal).collect(),
        };
        let edge = star.mean_edge(live);
        let areas = star
            .faces
            .iter()
            .map(|f| double_area(f.corners.each(|v| live.position(v))));
        let area: f64 = areas.sum();
        let faces = star.faces.iter();
        let flipped = faults.flipped(faces.map(|f| f.corners.each(|v| live.position(v))));
        let mut best: Option<(f64, DVec3)> = None;
        for step in STEPS {
            for direction in &directions {
                let to = star.point + *direction * (step * edge);
                let Ok(to) = star.admit(live, to, rules) else {
                    continue;
                };
                star.patch(live, to, patch);
                if check_uv_orientation(live, patch).is_err() {
                    continue;
                }
                let [before, after] = fold_amount(live, patch, OPEN_COSINE);
                // The second term keeps tiny moves of tiny faces from counting as free.
                let price = (area * step + 0.05 * edge * edge) * edge;
                let gain = |after: f64| (before + flipped - after) / price;
                let is_better = |gain: f64| gain > 0.0 && best.is_none_or(|(most, _)| gain > most);
                // Asking for the sides is slow.
                if is_better(gain(after)) {
                    let faces = patch.added.iter().map(|f| patch.after(live, f));
                    let gain = gain(after + faults.flipped(faces));
                    if is_better(gain) {
                        best = Some((gain, to));
                    }
                }
            }
        }
        best
    }
}

/// The 26 directions to the neighbours in a grid.
fn around() -> impl Iterator<Item = DVec3> {
    let at = |i: i32| {
        DVec3::new(
            f64::from(i % 3 - 1),
            f64::from(i / 3 % 3 - 1),
            f64::from(i / 9 - 1),
        )
    };
    (0..27).filter_map(move |i| math::unit(at(i)))
}
