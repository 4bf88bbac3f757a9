//! Which planes: greedily the one that the most faces may be projected on, each refined between the directions of the
//! grid, until no plane takes two faces.
//!
//! Gains are integers and only shrink as faces are taken, so that a gain computed earlier is an upper bound and most
//! directions need not be swept again. Unlike the billboard clouds of Décoret et al. 2003 there is no penalty for
//! planes that cut through what they just miss: intervals are exact, there are no bins to cut. At last planes whose
//! faces all find a place on others are dropped.

use glam::DVec2;
use rayon::prelude::*;

use super::{
    Options,
    plan::{Limits, PlanCell, PlanFace},
    sweep::{Stab, Sweep},
    tree::PlanTree,
};
use crate::{Progress, Result, bound::planar::Interval, num::math};

/// A vertical plane and the faces that are projected on it.
#[derive(Clone, Debug)]
pub(super) struct Slab {
    /// Unit normal in plan.
    pub(super) normal: DVec2,
    pub(super) rho: f64,
    /// Numbers of plan faces, each in one slab only, ascending.
    pub(super) faces: Vec<u32>,
}

/// Halvings of the angle between grid directions.
const HALVINGS: u32 = 12;
/// Directions of walls are one where they differ by less than this, in radians.
const SAME_DIRECTION: f64 = 1e-5;

struct Selection<'a> {
    faces: &'a [PlanFace],
    tree: &'a PlanTree,
    cell: &'a PlanCell,
    options: &'a Options,
    /// What a face is worth; 0 once it is taken.
    values: Vec<u64>,
}

/// Planes for the faces, in the order in which they were chosen, and the numbers of the faces that no plane shares.
pub(super) fn select(
    faces: &[PlanFace],
    tree: &PlanTree,
    cell: &PlanCell,
    options: &Options,
    progress: &dyn Progress,
) -> Result<(Vec<Slab>, Vec<u32>)> {
    let mut selection = Selection {
        faces,
        tree,
        cell,
        options,
        values: values(faces),
    };
    let normals = directions(faces, options.directions);
    progress.step("bound faces", 0, normals.len() as u64)?;
    let numbers = 0..faces.len() as u32;
    let sweeps: Vec<Option<Sweep>> = normals
        .par_iter()
        .map(|&normal| {
            let limits = selection.limits(normal);
            let sweep = || Sweep::new(faces, numbers.clone(), &limits);
            (!progress.interrupted()).then(sweep)
        })
        .collect();
    progress.step("bound faces", normals.len() as u64, normals.len() as u64)?;
    let mut sweeps: Vec<Sweep> = sweeps.into_iter().flatten().collect();
    let mut stabs: Vec<Stab> = sweeps
        .par_iter_mut()
        .map(|sweep| sweep.best(|face| selection.values[face as usize]))
        .collect();
    let mut slabs: Vec<Slab> = Vec::new();
    let mut left = faces.len();
    loop {
        progress.step(
            "choose planes",
            (faces.len() - left) as u64,
            faces.len() as u64,
        )?;
        let Some(k) = most(&mut stabs, &mut sweeps, &selection.values) else {
            break;
        };
        let (normal, rho) = selection.refine(normals[k], stabs[k]);
        let taken = selection.valid(normal, rho);
        if taken.len() < 2 {
            break;
        }
        left -= taken.len();
        for &face in &taken {
            selection.values[face as usize] = 0;
        }
        slabs.push(Slab {
            normal,
            rho,
            faces: taken,
        });
    }
    let alone: Vec<u32> = (0..faces.len() as u32)
        .filter(|&face| selection.values[face as usize] > 0)
        .collect();
    let homes = selection.homes(&slabs);
    let alone = place(&mut slabs, &homes, alone);
    drop_superfluous(&mut slabs, &homes);
    Ok((slabs, alone))
}

/// The direction of the largest gain, brought up to date; `None` where nothing is gained.
fn most(stabs: &mut [Stab], sweeps: &mut [Sweep], values: &[u64]) -> Option<usize> {
    let mut fresh = vec![false; stabs.len()];
    loop {
        let mut k = 0;
        for i in 1..stabs.len() {
            if stabs[i].gain > stabs[k].gain {
                k = i;
            }
        }
        if stabs[k].gain == 0 {
            return None;
        }
        if fresh[k] {
            return Some(k);
        }
        stabs[k] = sweeps[k].best(|face| values[face as usize]);
        fresh[k] = true;
    }
}

/// The same for every face: as few planes as possible are wanted, and a small face alone costs one as a large one does.
fn values(faces: &[PlanFace]) -> Vec<u64> {
    vec![1; faces.len()]
}

/// The grid, then the directions across two walls or more, those of most walls first and at most as many again.
fn directions(faces: &[PlanFace], count: u32) -> Vec<DVec2> {
    let angle = |k: u32| (f64::from(k) + 0.5) * std::f64::consts::PI / f64::from(count);
    let grid = (0..count).map(|k| unit(angle(k)));
    let mut walls: Vec<(i64, DVec2)> = Vec::new();
    for face in faces.iter().filter(|face| face.is_wall()) {
        let [a, b] = face.segments[0];
        let across = (b - a).perp();
        let length = math::sqrt(across.dot(across));
        if length > 0.0 {
            let normal = across / length;
            let upper = normal.y > 0.0 || (normal.y == 0.0 && normal.x > 0.0);
            let normal = if upper { normal } else { -normal };
            let bin = (math::atan2(normal.y, normal.x) / SAME_DIRECTION).round();
            walls.push((bin as i64, normal));
        }
    }
    walls.sort_by(|a, b| {
        let order = a.0.cmp(&b.0).then(a.1.x.total_cmp(&b.1.x));
        order.then(a.1.y.total_cmp(&b.1.y))
    });
    let mut groups: Vec<(usize, DVec2)> = walls
        .chunk_by(|a, b| a.0 == b.0)
        .map(|group| (group.len(), group[group.len() / 2].1))
        .filter(|&(walls, _)| walls > 1)
        .collect();
    groups.sort_by_key(|&(walls, _)| std::cmp::Reverse(walls));
    groups.truncate(count as usize);
    grid.chain(groups.into_iter().map(|(_, normal)| normal))
        .collect()
}

fn unit(angle: f64) -> DVec2 {
    DVec2::new(math::cos(angle), math::sin(angle))
}

impl Selection<'_> {
    fn limits(&self, normal: DVec2) -> Limits {
        self.cell.limits(normal, self.options.limit)
    }

    /// The faces of some value that may be projected on a plane.
    fn valid(&self, normal: DVec2, rho: f64) -> Vec<u32> {
        let limits = self.limits(normal);
        self.tree
            .at(&limits, rho)
            .into_par_iter()
            .filter(|&face| self.values[face as usize] > 0)
            .filter(|&face| self.faces[face as usize].fits(&limits, rho))
            .collect()
    }

    /// A plane near the given one that takes at least as much.
    fn refine(&self, normal: DVec2, stab: Stab) -> (DVec2, f64) {
        let taken = self.valid(normal, stab.rho);
        let middle = |face: u32| {
            let [a, b] = self.faces[face as usize].segments[0];
            (a + b) / 2.0
        };
        let sum: DVec2 = taken
            .iter()
            .map(|&face| middle(face))
            .fold(DVec2::ZERO, |a, b| a + b);
        let centre = sum / (taken.len().max(1) as f64);
        let mut step = std::f64::consts::PI / f64::from(self.options.directions) / 2.0;
        // Whatever a turn about the centre can reach.
        let limits = self.limits(normal);
        let offsets = Interval {
            min: stab.rho,
            max: stab.rho,
        };
        let near: Vec<u32> = self
            .tree
            .near(&limits, offsets, (6.0 * step, centre))
            .into_par_iter()
            .filter(|&face| self.values[face as usize] > 0)
            .filter(|&face| {
                let slack = 3.0 * step * middle(face).distance(centre);
                let wanted = Interval {
                    min: stab.rho - 2.0 * slack,
                    max: stab.rho + 2.0 * slack,
                };
                let face = &self.faces[face as usize];
                face.may_reach(&limits, wanted) && {
                    let interval = face.interval(&limits);
                    interval.min <= wanted.max && wanted.min <= interval.max
                }
            })
            .collect();
        let mut best = (stab.gain, normal, stab.rho);
        let mut angle = math::atan2(normal.y, normal.x);
        for _ in 0..HALVINGS {
            let tried: Vec<(Stab, DVec2)> = [angle - step, angle + step]
                .into_par_iter()
                .map(|angle| {
                    let normal = unit(angle);
                    let limits = self.limits(normal);
                    let mut sweep = Sweep::new(self.faces, near.iter().copied(), &limits);
                    (sweep.best(|face| self.values[face as usize]), normal)
                })
                .collect();
            for (found, turned) in tried {
                if found.gain > best.0 {
                    best = (found.gain, turned, found.rho);
                    angle = math::atan2(turned.y, turned.x);
                }
            }
            step /= 2.0;
        }
        (best.1, best.2)
    }

    /// For every face the planes that take it, in their order.
    fn homes(&self, slabs: &[Slab]) -> Vec<Vec<u32>> {
        let taken: Vec<Vec<u32>> = slabs
            .par_iter()
            .map(|slab| {
                let limits = self.limits(slab.normal);
                let mut near = self.tree.at(&limits, slab.rho);
                near.retain(|&face| self.faces[face as usize].fits(&limits, slab.rho));
                near
            })
            .collect();
        let mut homes = vec![Vec::new(); self.faces.len()];
        for (slab, faces) in (0_u32..).zip(taken) {
            for face in faces {
                homes[face as usize].push(slab);
            }
        }
        homes
    }
}

/// Gives faces that were left a place on the first plane that takes them; those that find none are given back.
fn place(slabs: &mut [Slab], homes: &[Vec<u32>], faces: Vec<u32>) -> Vec<u32> {
    let mut left = Vec::new();
    for face in faces {
        match homes[face as usize].first() {
            Some(&slab) => slabs[slab as usize].faces.push(face),
            None => left.push(face),
        }
    }
    for slab in slabs {
        slab.faces.sort_unstable();
    }
    left
}

/// Drops planes whose faces all find a place on others, those with the fewest faces first.
fn drop_superfluous(slabs: &mut Vec<Slab>, homes: &[Vec<u32>]) {
    let mut order: Vec<usize> = (0..slabs.len()).collect();
    order.sort_by_key(|&i| (slabs[i].faces.len(), std::cmp::Reverse(i)));
    for i in order {
        let faces = std::mem::take(&mut slabs[i].faces);
        let home = |face: &u32| {
            let mut homes = homes[*face as usize].iter().map(|&slab| slab as usize);
            homes.find(|&slab| !slabs[slab].faces.is_empty())
        };
        let found: Option<Vec<usize>> = faces.iter().map(home).collect();
        match found {
            Some(found) => {
                for (&face, slab) in faces.iter().zip(found) {
                    let others = &mut slabs[slab].faces;
                    let at = others.partition_point(|&other| other < face);
                    others.insert(at, face);
                }
            }
            None => slabs[i].faces = faces,
        }
    }
    slabs.retain(|slab| !slab.faces.is_empty());
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_plane_whose_faces_all_have_another_place_is_dropped_and_a_face_goes_to_the_first_one() {
        let slab = |faces: &[u32]| Slab {
            normal: DVec2::X,
            rho: 0.0,
            faces: faces.to_vec(),
        };
        let homes = [
            vec![0, 2],
            vec![0, 1, 2],
            vec![1],
            vec![1],
            vec![2],
            vec![1, 2],
            vec![],
        ];
        let mut slabs = vec![slab(&[0, 1]), slab(&[2, 3]), slab(&[4])];
        let left = place(&mut slabs, &homes, vec![5, 6]);
        assert_eq!(left, [6]);
        drop_superfluous(&mut slabs, &homes);
        let faces: Vec<&[u32]> = slabs.iter().map(|slab| &slab.faces[..]).collect();
        assert_eq!(faces, [&[1, 2, 3, 5][..], &[0, 4]]);
    }
}
