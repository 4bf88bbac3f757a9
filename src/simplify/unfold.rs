//! Opening folds that geometric methods leave.
//!
//! Where the topology is kept, a thin handle or sheet ends as two layers of faces that lie on each other: nothing in a
//! sum of squared distances or volumes is against it. Refusing such collapses would leave the handle with faces that are
//! needed elsewhere (measured on the dragon at 8,191 triangles: 2 % more flat RMS), so they are allowed, and at the end
//! vertices at the folds are moved, by as little as opens them (0.4 % more). What is folded in the original stays folded.
//! Faces that look where none of the original does are turned back in the same way. Both as [`crate::metric::folds`]
//! counts them.

use glam::DVec3;

use crate::{
    Progress, Result,
    collapse::{
        Changes, Freedom, LiveMesh, Observer, Patch, Rules, Star, folded_edges, foldedness,
        unmirrored,
    },
    mesh::Mesh,
    metric::{
        Sides,
        folds::{FOLD_COSINE, REACH},
    },
    num::math,
};

/// Opened a little further than what counts as a fold.
const OPEN_COSINE: f64 = FOLD_COSINE + 0.02;

/// Times that all faults are visited, at most; the dragon at five levels needed up to 15.
const SWEEPS: u32 = 32;

/// Lengths of moves that are tried, in mean edges at the vertex.
const STEPS: [f64; 6] = [0.03125, 0.0625, 0.125, 0.25, 0.5, 1.0];

/// The folded edges of an original, near which a fold is none of ours.
#[derive(Clone, Debug)]
pub(super) struct Creases {
    edges: Vec<[DVec3; 2]>,
    /// Square of how far they reach.
    reach2: f64,
}

impl Creases {
    /// Those of a mesh; O(edges).
    pub(super) fn of(live: &LiveMesh) -> Self {
        let mut bounds: Option<[DVec3; 2]> = None;
        for &p in live.positions() {
            let [low, high] = bounds.unwrap_or([p; 2]);
            bounds = Some([low.min(p), high.max(p)]);
        }
        let [low, high] = bounds.unwrap_or_default();
        let folded = folded_edges(live, FOLD_COSINE).into_iter();
        let ends = folded.filter_map(|e| Some(live.edge(e)?.map(|v| live.position(v))));
        let reach = REACH * math::length(high - low);
        Self {
            edges: ends.collect(),
            reach2: reach * reach,
        }
    }

    /// The folded edges of a mesh that are near none of these.
    fn folds(&self, live: &LiveMesh) -> Vec<u32> {
        let mut folded = folded_edges(live, FOLD_COSINE);
        folded.retain(|&e| {
            live.edge(e).is_some_and(|ends| {
                let [a, b] = ends.map(|v| live.position(v));
                let far = |&crease| squared_distance((a + b) * 0.5, crease) > self.reach2;
                self.edges.iter().all(far)
            })
        });
        folded
    }
}

/// What has to be repaired, and around which vertices.
struct Faults<'a> {
    creases: &'a Creases,
    /// The surface around whatever may look the wrong way.
    sides: Option<Sides>,
}

impl<'a> Faults<'a> {
    fn new(live: &LiveMesh, original: &Mesh, creases: &'a Creases) -> Self {
        let boxes: Vec<[DVec3; 2]> = suspects(live)
            .into_iter()
            .filter_map(|face| {
                let corners = live.points(face)?;
                let low = corners[0].min(corners[1]).min(corners[2]);
                let high = corners[0].max(corners[1]).max(corners[2]);
                // As far as a vertex may go, and the surface from there.
                let margin = DVec3::splat(math::length(high - low) + math::sqrt(creases.reach2));
                Some([low - margin, high + margin])
            })
            .collect();
        let sides = if boxes.is_empty() {
            None
        } else {
            Sides::within(&original.enter_frame(live.frame()), &boxes)
        };
        Self { creases, sides }
    }

    fn is_flipped(&self, face: [DVec3; 3]) -> bool {
        self.sides.as_ref().is_some_and(|s| s.is_flipped(face))
    }

    /// The vertices of every folded edge's faces and of every flipped face.
    fn find(&self, live: &LiveMesh) -> Vec<Vec<u32>> {
        let around = |edge: u32| {
            let [a, b] = live.edge(edge)?;
            let faces = live.triangles_at(a).filter_map(|f| live.triangle(f));
            let mut around: Vec<u32> = faces.filter(|c| c.contains(&b)).flatten().collect();
            around.sort_unstable();
            around.dedup();
            Some(around)
        };
        let folds = self.creases.folds(live).into_iter().filter_map(around);
        let is_flipped = |&f: &u32| live.points(f).is_some_and(|face| self.is_flipped(face));
        let flipped = suspects(live).into_iter().filter(is_flipped);
        let corners = flipped.filter_map(|f| Some(live.triangle(f)?.to_vec()));
        folds.chain(corners).collect()
    }

    /// How wrong the faces of a patch are: how far their edges are folded, and how many of them are flipped.
    fn weigh(&self, live: &LiveMesh, patch: &Patch) -> [f64; 2] {
        let [mut before, mut after] = foldedness(live, patch, OPEN_COSINE);
        for face in &patch.removed {
            before += f64::from(self.is_flipped(patch.before(live, face)));
        }
        for face in &patch.added {
            after += f64::from(self.is_flipped(patch.after(live, face)));
        }
        [before, after]
    }
}

/// The faces at edges of more than a right angle, ascending: no other face is taken to be flipped.
fn suspects(live: &LiveMesh) -> Vec<u32> {
    let mut faces: Vec<u32> = folded_edges(live, 0.0)
        .into_iter()
        .filter_map(|edge| live.edge(edge))
        .flat_map(|[a, b]| {
            let at_edge = move |f: &u32| live.triangle(*f).is_some_and(|c| c.contains(&b));
            live.triangles_at(a).filter(at_edge)
        })
        .collect();
    faces.sort_unstable();
    faces.dedup();
    faces
}

/// Moves vertices at folds that are not near the creases of the original, and at faces that look where none of the
/// original does.
///
/// O(edges), and O(creases) for every fold; O(n) for the original where there are edges of more than a right angle.
///
/// # Errors
/// [`crate::Error::Interrupted`].
pub(super) fn unfold(
    live: &mut LiveMesh,
    original: &Mesh,
    creases: &Creases,
    rules: Rules,
    observer: &mut dyn Observer,
    progress: &dyn Progress,
) -> Result<()> {
    let faults = Faults::new(live, original, creases);
    let mut search = Search::default();
    let mut left = faults.find(live);
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
        left = faults.find(live);
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
        faults: &Faults<'_>,
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
        let areas = star.faces.iter().map(|f| {
            let [a, b, c] = f.corners.map(|v| live.position(v));
            math::length((b - a).cross(c - a))
        });
        let area: f64 = areas.sum();
        let mut best: Option<(f64, DVec3)> = None;
        for step in STEPS {
            for direction in &directions {
                let to = star.point + *direction * (step * edge);
                let Ok(to) = star.admit(live, to, rules) else {
                    continue;
                };
                star.patch(live, to, patch);
                if unmirrored(live, patch).is_err() {
                    continue;
                }
                let [before, after] = faults.weigh(live, patch);
                // The second term keeps tiny moves of tiny faces from counting as free.
                let price = (area * step + 0.05 * edge * edge) * edge;
                let gain = (before - after) / price;
                if gain > 0.0 && best.is_none_or(|(most, _)| gain > most) {
                    best = Some((gain, to));
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

fn squared_distance(p: DVec3, [a, b]: [DVec3; 2]) -> f64 {
    let (d, q) = (b - a, p - a);
    let t = (q.dot(d) / d.dot(d)).clamp(0.0, 1.0);
    let off = if t.is_finite() { q - d * t } else { q };
    off.dot(off)
}
