//! Bearings of planes, and directions along which the scene is projected on them: a grid, and the walls of the scene.
//!
//! Slanted planes take faces that no plane across the direction of projection takes together, at the same bounds: a
//! forest of 10,000 trees goes on an eighth fewer.

use glam::DVec2;

use super::{BillboardOptions, Limit, plan::PlanFace};
use crate::num::math;

/// Slants of planes of the grid to either side, beside none.
const SLANTS: i32 = 4;
/// Angle between two slants of the grid, in radians.
const SLANT: f64 = std::f64::consts::PI / 12.0;
/// Slants stay below this, in radians: steeper planes lie along the direction and gain nothing.
const STEEPEST: f64 = 1.4;
/// Directions of walls are one where they differ by less than this, in radians.
const SAME_DIRECTION: f64 = 1e-5;

/// The normal of vertical planes and the direction of projection on them, unit vectors in plan with a scalar product
/// above 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Bearing {
    pub(super) normal: DVec2,
    pub(super) along: DVec2,
}

/// Angles in radians to turn a bearing by.
#[derive(Clone, Copy, Debug)]
pub(super) struct Turn {
    /// Of normal and direction together.
    pub(super) whole: f64,
    /// Of the direction alone.
    pub(super) slant: f64,
}

impl Bearing {
    /// Planes across the direction of projection.
    pub(super) fn across(normal: DVec2) -> Self {
        let along = normal;
        Self { normal, along }
    }

    /// By the angle of the normal and of the direction from it; 0 for planes across the direction.
    fn at(angle: f64, slant: f64) -> Self {
        let unit = |angle: f64| DVec2::new(math::cos(angle), math::sin(angle));
        let normal = unit(angle);
        let straight = slant == 0.0;
        let along = if straight {
            normal
        } else {
            unit(angle + slant)
        };
        Self { normal, along }
    }

    /// Turned; `None` where planes come too close to the direction.
    pub(super) fn turned(self, by: Turn) -> Option<Self> {
        let angle = math::atan2(self.normal.y, self.normal.x);
        let (across, along) = (
            self.normal.perp_dot(self.along),
            self.normal.dot(self.along),
        );
        let slant = math::atan2(across, along) + by.slant;
        (slant.abs() < STEEPEST).then(|| Self::at(angle + by.whole, slant))
    }
}

/// Half the steps of the grid.
pub(super) fn half_steps(options: &BillboardOptions) -> Turn {
    Turn {
        whole: std::f64::consts::PI / f64::from(options.directions) / 2.0,
        slant: match options.limit {
            Limit::Angle(_) => SLANT / 2.0,
            Limit::Distance(_) => 0.0,
        },
    }
}

/// The grid, then across two walls or more, those of most walls first and at most as many as there are directions. A
/// distance knows no viewers and is shortest across, so that it has no slants.
pub(super) fn grid(faces: &[PlanFace], options: &BillboardOptions) -> Vec<Bearing> {
    let count = options.directions;
    let slants = match options.limit {
        Limit::Angle(_) => SLANTS,
        Limit::Distance(_) => 0,
    };
    let angle = |k: u32| (f64::from(k) + 0.5) * std::f64::consts::PI / f64::from(count);
    let grid = (0..count).flat_map(|k| {
        (-slants..=slants).map(move |slant| Bearing::at(angle(k), f64::from(slant) * SLANT))
    });
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
    let walls = groups.into_iter().map(|(_, normal)| normal);
    grid.chain(walls.map(Bearing::across)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bound::planar::Aperture;

    #[test]
    fn no_bearing_turns_into_planes_along_the_direction_and_a_distance_has_no_slants() {
        let aperture = Aperture::degrees(1.0).expect("below 90");
        let options = BillboardOptions {
            directions: 7,
            ..BillboardOptions::within(Limit::Angle(aperture))
        };
        let bearings = grid(&[], &options);
        assert_eq!(bearings.len(), 7 * 9);
        let across = bearings.iter().filter(|b| b.normal == b.along).count();
        assert_eq!(across, 7);
        for bearing in bearings {
            let Turn { whole, slant } = half_steps(&options);
            let turns = [(whole, slant), (-whole, -slant), (0.0, 0.3), (0.0, -0.3)];
            for (whole, slant) in turns {
                let angle = |b: Bearing| b.normal.angle_to(b.along);
                let wanted = angle(bearing) + slant;
                let Some(turned) = bearing.turned(Turn { whole, slant }) else {
                    assert!(wanted.abs() > STEEPEST - 1e-9);
                    continue;
                };
                let turn = bearing.normal.angle_to(turned.normal);
                let off = (angle(turned) - wanted).abs().max((turn - whole).abs());
                assert!(off < 1e-12, "{bearing:?} {turned:?}");
                assert!(turned.normal.dot(turned.along) > 0.16);
            }
        }
        let options = BillboardOptions::within(Limit::Distance(0.1));
        let all_across = grid(&[], &options).iter().all(|b| b.normal == b.along);
        assert!(all_across && half_steps(&options).slant == 0.0);
    }
}
