//! Selection of planes: greedily the one that takes faces of the most value, each refined between the bearings of the
//! grid, until no plane takes two faces.
//!
//! A face is worth its share of the fullest plane of the grid that takes it: 1 / n where at most n go with it. So planes
//! are chosen that few others could do without, and lonely faces while there is company for them. No plane of the grid is
//! worth more than 1 then, so that the sum of the shares is also a bound below which no choice from the grid can go.
//! Gains are integers and only shrink as faces are taken, so that a gain computed earlier is an upper bound and most
//! bearings need not be swept again. Unlike the billboard clouds of Décoret et al. 2003 there is no penalty for
//! planes that cut through what they just miss: intervals are exact, there are no bins to cut. At last planes whose
//! faces all find a place on others are dropped.

use glam::DVec2;

use super::{
    BillboardOptions,
    bearing::{Bearing, Turn, grid, half_steps},
    plan::{Limits, PlanFace},
    sweep::{Stab, Sweep},
    tree::{Growth, PlanTree},
    viewers_in_plan::PlanCell,
};
use crate::{Progress, Result, bound::planar::Interval, parallel};

/// A vertical plane and the faces that are projected on it.
#[derive(Clone, Debug)]
pub(super) struct Slab {
    pub(super) bearing: Bearing,
    pub(super) rho: f64,
    /// Numbers of plan faces, each in one slab only, ascending.
    pub(super) faces: Vec<u32>,
}

/// Halvings of the steps of the grid.
const HALVINGS: u32 = 12;
/// The value of a face that goes with no other.
const WHOLE: u64 = 1 << 32;
/// Largest move of a face's offset by a slant of one radian, per distance from the middle of the plane.
const SLANT_REACH: f64 = 0.1;

struct Selection<'a> {
    faces: &'a [PlanFace],
    tree: &'a PlanTree,
    cell: &'a PlanCell,
    options: &'a BillboardOptions,
    /// The value of every face; 0 once it is taken.
    values: Vec<u64>,
}

/// Planes for the faces, in the order in which they were chosen, and the numbers of the faces that no plane shares.
pub(super) fn select(
    faces: &[PlanFace],
    tree: &PlanTree,
    cell: &PlanCell,
    options: &BillboardOptions,
    progress: &dyn Progress,
) -> Result<(Vec<Slab>, Vec<u32>)> {
    let mut selection = Selection {
        faces,
        tree,
        cell,
        options,
        values: Vec::new(),
    };
    let bearings = grid(faces, options);
    progress.step("bound faces", 0, bearings.len() as u64)?;
    let numbers = 0..faces.len() as u32;
    let mut sweeps = parallel::filter_map(bearings.len(), |i| {
        let limits = selection.limits(bearings[i]);
        let sweep = || Sweep::new(faces, numbers.clone(), &limits);
        (!progress.interrupted()).then(sweep)
    });
    progress.step("bound faces", bearings.len() as u64, bearings.len() as u64)?;
    selection.values = shares(&sweeps, faces.len());
    let mut stabs = parallel::map_mut(&mut sweeps, |i, sweep| selection.best(sweep, bearings[i]));
    let mut slabs: Vec<Slab> = Vec::new();
    let mut alone = Vec::new();
    let mut left = faces.len();
    loop {
        let done = (faces.len() - left) as u64;
        progress.step("choose planes", done, faces.len() as u64)?;
        let Some(k) = selection.most(&mut stabs, &mut sweeps, &bearings) else {
            break;
        };
        let (bearing, rho) = selection.refine(bearings[k], stabs[k]);
        let taken = selection.valid(bearing, rho);
        if taken.is_empty() {
            break;
        }
        left -= taken.len();
        for &face in &taken {
            selection.values[face as usize] = 0;
        }
        if taken.len() < 2 {
            alone.extend(taken);
            continue;
        }
        slabs.push(Slab {
            bearing,
            rho,
            faces: taken,
        });
    }
    alone.extend((0..faces.len() as u32).filter(|&face| selection.values[face as usize] > 0));
    alone.sort_unstable();
    let homes = selection.homes(&slabs);
    let alone = place(&mut slabs, &homes, alone);
    drop_superfluous(&mut slabs, &homes);
    Ok((slabs, alone))
}

/// Computes the value of every face.
fn shares(sweeps: &[Sweep], faces: usize) -> Vec<u64> {
    let of_parts = parallel::collect(sweeps.len(), 1, |range, parts| {
        let mut most = vec![1; faces];
        for sweep in &sweeps[range] {
            sweep.fullest(&mut most);
        }
        parts.push(most);
    });
    let mut most = vec![1; faces];
    for part in of_parts {
        for (a, b) in most.iter_mut().zip(part) {
            *a = b.max(*a);
        }
    }
    let share = |most| WHOLE / u64::from(most);
    most.into_iter().map(share).collect()
}

impl Selection<'_> {
    fn limits(&self, bearing: Bearing) -> Limits {
        self.cell.limits(bearing, self.options.limit)
    }

    fn best(&self, sweep: &mut Sweep, bearing: Bearing) -> Stab {
        let value = |face: u32| self.values[face as usize];
        sweep.best(self.faces, &self.limits(bearing), value)
    }

    /// The bearing of the largest gain, brought up to date; `None` where nothing is gained.
    fn most(
        &self,
        stabs: &mut [Stab],
        sweeps: &mut [Sweep],
        bearings: &[Bearing],
    ) -> Option<usize> {
        let mut fresh = vec![false; stabs.len()];
        loop {
            // The first of the best.
            let k = (0..stabs.len()).rev().max_by_key(|&i| stabs[i].gain)?;
            if stabs[k].gain == 0 {
                return None;
            }
            if fresh[k] {
                return Some(k);
            }
            stabs[k] = self.best(&mut sweeps[k], bearings[k]);
            fresh[k] = true;
        }
    }

    /// The faces of some value that may be projected on a plane.
    fn valid(&self, bearing: Bearing, rho: f64) -> Vec<u32> {
        let limits = self.limits(bearing);
        let found = self.tree.at(&limits, rho);
        let is_valid = |&face: &u32| {
            self.values[face as usize] > 0 && self.faces[face as usize].fits(&limits, rho)
        };
        parallel::filter_map(found.len(), |i| Some(found[i]).filter(is_valid))
    }

    /// A plane near the given one that takes at least as much.
    fn refine(&self, bearing: Bearing, stab: Stab) -> (Bearing, f64) {
        let taken = self.valid(bearing, stab.rho);
        let middle = |face: u32| {
            let [a, b] = self.faces[face as usize].segments[0];
            (a + b) / 2.0
        };
        let middles = taken.iter().map(|&face| middle(face));
        let centre = middles.fold(DVec2::ZERO, |a, b| a + b) / (taken.len().max(1) as f64);
        let mut step = half_steps(self.options);
        // Whatever a turn about the centre can reach.
        let reach = 3.0 * step.whole + SLANT_REACH * step.slant;
        let limits = self.limits(bearing);
        let is_near = |&face: &u32| {
            if self.values[face as usize] == 0 {
                return false;
            }
            let slack = reach * middle(face).distance(centre);
            let wanted = Interval::around(stab.rho, 2.0 * slack);
            let face = &self.faces[face as usize];
            face.may_reach(&limits, wanted) && {
                let interval = face.interval(&limits);
                interval.min <= wanted.max && wanted.min <= interval.max
            }
        };
        let growth = Growth {
            slope: 2.0 * reach,
            centre,
        };
        let near = self.tree.near(&limits, stab.rho, growth);
        let near = parallel::filter_map(near.len(), |i| Some(near[i]).filter(is_near));
        let mut best = (stab, bearing);
        for _ in 0..HALVINGS {
            let Turn { whole, slant } = step;
            let turns = [(-whole, 0.0), (whole, 0.0), (0.0, -slant), (0.0, slant)];
            let tried = parallel::filter_map(turns.len(), |i| {
                let (whole, slant) = turns[i];
                if whole == 0.0 && slant == 0.0 {
                    return None;
                }
                let bearing = best.1.turned(Turn { whole, slant })?;
                let limits = self.limits(bearing);
                let mut sweep = Sweep::new(self.faces, near.iter().copied(), &limits);
                Some((self.best(&mut sweep, bearing), bearing))
            });
            for found in tried {
                if found.0.gain > best.0.gain {
                    best = found;
                }
            }
            step = Turn {
                whole: whole / 2.0,
                slant: slant / 2.0,
            };
        }
        (best.1, best.0.rho)
    }

    /// For every face the planes that take it, in their order.
    fn homes(&self, slabs: &[Slab]) -> Vec<Vec<u32>> {
        let taken = parallel::map_slice(slabs, |slab| {
            let limits = self.limits(slab.bearing);
            let mut near = self.tree.at(&limits, slab.rho);
            near.retain(|&face| self.faces[face as usize].fits(&limits, slab.rho));
            near
        });
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
    use glam::DVec3;

    use super::*;
    use crate::{
        bound::{planar::Aperture, view_cell::ViewCell},
        mesh::generate::Pcg32,
        simplify::billboards::Limit,
    };

    #[test]
    fn a_plane_of_the_grid_is_worth_more_than_one_face_alone() {
        let mut random = Pcg32::new(2007, 404);
        let mut at = |size: f64| {
            let mut x = || size * (2.0 * random.unit() - 1.0);
            DVec2::new(x(), x())
        };
        let aperture = Aperture::degrees(2.0).expect("below 90");
        let options = BillboardOptions {
            directions: 12,
            ..BillboardOptions::within(Limit::Angle(aperture))
        };
        let cell = ViewCell::segment([DVec3::ZERO, DVec3::X]).expect("two points");
        let cell = PlanCell::new(&cell, options.up).expect("room");
        let faces = (0..200).map(|t| PlanFace::wall(t, at(9.0) + DVec2::Y * 11.0, at(0.3)));
        let faces: Vec<PlanFace> = faces.collect();
        let limits = |bearing| cell.limits(bearing, options.limit);
        let limits: Vec<Limits> = grid(&faces, &options).into_iter().map(limits).collect();
        let sweep = |limits| Sweep::new(&faces, 0..200, limits);
        let mut sweeps: Vec<Sweep> = limits.iter().map(sweep).collect();
        let values = shares(&sweeps, faces.len());
        let value = |face: u32| values[face as usize];
        let best = sweeps.iter_mut().zip(&limits);
        let gains = best.map(|(sweep, limits)| sweep.best(&faces, limits, value).gain);
        let gains: Vec<u64> = gains.collect();
        // And the fullest ones are worth as much.
        assert!(gains.iter().all(|&gain| gain <= WHOLE));
        assert!(gains.iter().any(|&gain| gain > WHOLE - 200));
        assert!(values.iter().all(|&value| value > 0));
    }

    #[test]
    fn a_plane_whose_faces_all_have_another_place_is_dropped_and_a_face_goes_to_the_first_one() {
        let slab = |faces: &[u32]| Slab {
            bearing: Bearing::across(DVec2::X),
            rho: 0.0,
            faces: faces.to_vec(),
        };
        let homes: [&[u32]; 7] = [&[0, 2], &[0, 1, 2], &[1], &[1], &[2], &[1, 2], &[]];
        let homes = homes.map(<[u32]>::to_vec);
        let mut slabs = vec![slab(&[0, 1]), slab(&[2, 3]), slab(&[4])];
        let left = place(&mut slabs, &homes, vec![5, 6]);
        assert_eq!(left, [6]);
        drop_superfluous(&mut slabs, &homes);
        let faces: Vec<&[u32]> = slabs.iter().map(|slab| &slab.faces[..]).collect();
        assert_eq!(faces, [&[1, 2, 3, 5][..], &[0, 4]]);
    }
}
