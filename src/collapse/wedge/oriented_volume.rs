//! Texture coordinates of a new vertex by oriented volumes in five dimensions.
//!
//! Lindstrom & Turk 2000, section 4.1.1, equations 4 to 7: a face is a triangle in (x, y, z, k s, k t), and the new
//! vertex, whose position is known, sweeps with it a tetrahedron whose oriented volume has ten components, each linear
//! in (s, t). Preservation makes the sum of the components over all faces vanish; where that leaves a direction open
//! (their normals cancel), optimisation minimises the sum of their squares. An affine map of the surface is reproduced
//! exactly: every component of the sum is then a multiple of the same two residuals.

use glam::DVec3;

/// cos^2 of one degree, the least angle between constraints.
const COS2: f64 = 0.999_695_413_509_547_9;

/// Share of the largest coefficient below which a row is zero.
const NOTHING: f64 = 1e-12;

/// The sums over the faces of one wedge, relative to an origin in texture space.
#[derive(Clone, Copy, Debug)]
pub(super) struct OrientedVolume {
    position: DVec3,
    origin: [f64; 2],
    /// Lengths on the surface per length in texture space.
    scale: f64,
    /// Coefficients of s and t and the constant of each component, summed over the faces.
    sums: [[f64; 3]; 10],
    /// The sum over the faces of the squared components: `[ss, st, tt, s1, t1]`.
    squares: [f64; 5],
}

impl OrientedVolume {
    /// No face yet, around a position and an origin near the coordinates; `scale` is the mean edge on the surface over
    /// the mean edge in texture space.
    pub(super) fn new(position: DVec3, origin: [f64; 2], scale: f64) -> Self {
        Self {
            position,
            origin,
            scale,
            sums: [[0.0; 3]; 10],
            squares: [0.0; 5],
        }
    }

    /// Adds a face, all in the same sense, with the coordinates of its corners.
    pub(super) fn add(&mut self, points: [DVec3; 3], coordinates: [[f64; 2]; 3]) {
        let components = self.components(points, coordinates);
        for (sum, row) in self.sums.iter_mut().zip(components) {
            for (s, x) in sum.iter_mut().zip(row) {
                *s += x;
            }
            let [a, b, c] = row;
            for (s, x) in self
                .squares
                .iter_mut()
                .zip([a * a, a * b, b * b, a * c, b * c])
            {
                *s += x;
            }
        }
    }

    /// The ten components of a face's volume, each as coefficients of s and t and a constant. Triples of corners are
    /// vectors here.
    fn components(&self, points: [DVec3; 3], coordinates: [[f64; 2]; 3]) -> [[f64; 3]; 10] {
        let [p, q, r] = points.map(|p| p - self.position);
        let (x, y, z) = (
            DVec3::new(p.x, q.x, r.x),
            DVec3::new(p.y, q.y, r.y),
            DVec3::new(p.z, q.z, r.z),
        );
        let axis = |k: usize| {
            let relative = |c: [f64; 2]| (c[k] - self.origin[k]) * self.scale;
            DVec3::from_array(coordinates.map(relative))
        };
        let (s, t) = (axis(0), axis(1));
        let one = DVec3::ONE;
        let (ot, so, st) = (one.cross(t), s.cross(one), s.cross(t));
        let (yz, xz, xy) = (y.cross(z), x.cross(z), x.cross(y));
        [
            [z.dot(ot), z.dot(so), -z.dot(st)],
            [-y.dot(ot), -y.dot(so), y.dot(st)],
            [0.0, yz.dot(one), -yz.dot(t)],
            [-yz.dot(one), 0.0, yz.dot(s)],
            [x.dot(ot), x.dot(so), -x.dot(st)],
            [0.0, -xz.dot(one), xz.dot(t)],
            [xz.dot(one), 0.0, -xz.dot(s)],
            [0.0, xy.dot(one), -xy.dot(t)],
            [-xy.dot(one), 0.0, xy.dot(s)],
            [0.0, 0.0, -xy.dot(z)],
        ]
    }

    /// The coordinates that preserve the volume, or minimise it in the directions that this leaves open, or
    /// [`Otherwise`] where faces determine none.
    pub(super) fn solve(&self, otherwise: Otherwise) -> Option<[f64; 2]> {
        let mut rows = Rows {
            least: NOTHING * self.squares[0].max(self.squares[2]),
            ..Rows::default()
        };
        let mut kept = [0.0; 5];
        for [a, b, c] in self.sums {
            for (s, x) in kept.iter_mut().zip([a * a, a * b, b * b, a * c, b * c]) {
                *s += x;
            }
        }
        let [aa, ab, bb, ac, bc] = kept;
        rows.offer([aa, ab], -ac);
        rows.offer([ab, bb], -bc);
        let [aa, ab, bb, ac, bc] = self.squares;
        if rows.count == 1 {
            let [x, y] = rows.rows[0];
            let (q, r) = (-y, x);
            rows.offer([aa * q + ab * r, ab * q + bb * r], -(q * ac + r * bc));
        } else if rows.count == 0 {
            rows.offer([aa, ab], -ac);
            rows.offer([ab, bb], -bc);
        }
        match rows.solve() {
            Some(st) => {
                let [s, t] = self.origin;
                let st = [st[0] / self.scale + s, st[1] / self.scale + t];
                st.iter().all(|x| x.is_finite()).then_some(st)
            }
            None => otherwise.value(),
        }
    }
}

/// The line between the coordinates at both ends of the edge, for faces that determine no others.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Otherwise {
    /// The coordinates at either end, where there are such.
    pub(super) ends: [Option<[f64; 2]>; 2],
    /// Place on the edge, 0 at its first end and 1 at its second.
    pub(super) at: f64,
}

impl Otherwise {
    fn value(self) -> Option<[f64; 2]> {
        match self.ends {
            [Some(a), Some(b)] => {
                let mix = |k: usize| (1.0 - self.at) * a[k] + self.at * b[k];
                Some([mix(0), mix(1)])
            }
            [a, b] => a.or(b),
        }
    }
}

/// Up to two accepted rows `a . (s, t) = b`.
#[derive(Clone, Copy, Debug, Default)]
struct Rows {
    rows: [[f64; 2]; 2],
    values: [f64; 2],
    count: usize,
    least: f64,
}

impl Rows {
    /// Accepts the row where it says anything, and anything else than the row before it.
    fn offer(&mut self, row: [f64; 2], value: f64) {
        let dot = |a: [f64; 2], b: [f64; 2]| a[0] * b[0] + a[1] * b[1];
        let size2 = dot(row, row);
        if self.count == 2 || !(size2 > self.least * self.least && value.is_finite()) {
            return;
        }
        if self.count == 1 {
            let along = dot(self.rows[0], row);
            if along * along > dot(self.rows[0], self.rows[0]) * size2 * COS2 {
                return;
            }
        }
        self.rows[self.count] = row;
        self.values[self.count] = value;
        self.count += 1;
    }

    fn solve(&self) -> Option<[f64; 2]> {
        if self.count < 2 {
            return None;
        }
        let ([[a, b], [c, d]], [e, f]) = (self.rows, self.values);
        let determinant = a * d - b * c;
        let st = [(e * d - b * f) / determinant, (a * f - e * c) / determinant];
        st.iter().all(|x| x.is_finite()).then_some(st)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn near(found: [f64; 2], expected: [f64; 2], within: f64) {
        for (f, e) in found.iter().zip(expected) {
            assert!((f - e).abs() <= within, "{found:?} is not {expected:?}");
        }
    }

    #[test]
    fn the_components_of_a_triangle_are_those_of_the_vectors() {
        let points = [[1.0, 0.0, 0.2], [0.3, 1.1, -0.1], [-0.4, 0.2, 0.9]].map(DVec3::from_array);
        let coordinates = [[0.1, 0.2], [0.7, 0.3], [0.4, 0.9]];
        let at = |s: f64, t: f64| {
            let position = DVec3::new(0.1, 0.2, 0.3);
            let volume = OrientedVolume::new(position, [0.0; 2], 1.5);
            // The unknowns are scaled like the coordinates.
            let rows = volume.components(points, coordinates);
            rows.map(|[a, b, c]| a * (1.5 * s) + b * (1.5 * t) + c)
        };
        let expected = [
            0.282_375, 0.475_875, -0.134_25, -0.3135, -0.403_875, -0.362_25, 0.048, -0.8025,
            -0.3675, -0.425,
        ];
        for (found, expected) in at(0.5, 0.25).iter().zip(expected) {
            assert!(
                (found - expected).abs() < 1e-12,
                "{found} is not {expected}"
            );
        }
    }

    const U: [f64; 3] = [0.0, 0.0, 0.3];
    const W: [f64; 3] = [1.0, 0.0, 0.1];

    /// The faces of the vectors, around the edge from `U` to `W`.
    fn ring() -> [[DVec3; 3]; 10] {
        let l = [
            [0.5, 0.9, 0.0],
            [-0.4, 0.8, -0.1],
            [-1.0, 0.1, 0.0],
            [-0.5, -0.9, 0.05],
            [0.5, -1.0, 0.0],
            [1.5, -0.8, -0.05],
            [2.0, 0.1, 0.02],
            [1.4, 0.9, 0.0],
        ];
        [
            [U, l[0], l[1]],
            [U, l[1], l[2]],
            [U, l[2], l[3]],
            [U, l[3], l[4]],
            [U, l[4], W],
            [W, l[4], l[5]],
            [W, l[5], l[6]],
            [W, l[6], l[7]],
            [W, l[7], l[0]],
            [U, W, l[0]],
        ]
        .map(|face| face.map(DVec3::from_array))
    }

    fn affine(p: DVec3) -> [f64; 2] {
        [
            0.2 * p.x - 0.05 * p.y + 0.1 * p.z + 0.4,
            0.03 * p.x + 0.25 * p.y - 0.07 * p.z + 0.1,
        ]
    }

    fn curved(p: DVec3) -> [f64; 2] {
        [
            0.2 * p.x + 0.03 * p.y * p.y + 0.4,
            0.25 * p.y + 0.02 * p.x * p.y + 0.1,
        ]
    }

    fn around(x: [f64; 3], scale: f64, map: fn(DVec3) -> [f64; 2]) -> OrientedVolume {
        let position = DVec3::from_array(x);
        let mut volume = OrientedVolume::new(position, map(DVec3::from_array(U)), scale);
        for face in ring() {
            volume.add(face, face.map(map));
        }
        volume
    }

    const ON_PLANE: [f64; 3] = [
        0.499_978_903_152_382_1,
        0.000_780_583_361_863_809_3,
        0.246_096_612_045_200_6,
    ];

    #[test]
    fn preserved_coordinates_are_those_of_the_vectors_and_an_affine_map_is_reproduced() {
        let solve = |x, scale, map| {
            let solved = around(x, scale, map).solve(Otherwise::default());
            solved.expect("determined")
        };
        let expected = [0.524_566_412_666_903_3, 0.097_967_750_091_873_38];
        for scale in [1e-3, 1.0, 4.0, 100.0] {
            near(solve(ON_PLANE, scale, affine), expected, 1e-10);
            near(
                solve(ON_PLANE, scale, affine),
                affine(DVec3::from_array(ON_PLANE)),
                1e-10,
            );
        }
        near(solve([0.5, 0.0, 0.2], 4.0, affine), expected, 1e-12);
        near(
            solve(ON_PLANE, 4.0, curved),
            [0.500_490_668_452_632_9, 0.099_975_286_369_763_77],
            1e-12,
        );
        near(
            solve([0.5, 0.0, 0.2], 4.0, curved),
            [0.500_488_529_327_277_9, 0.099_989_936_929_363_96],
            1e-12,
        );
    }

    #[test]
    fn optimised_coordinates_are_those_of_the_vectors_where_nothing_is_preserved() {
        let optimised = |x, map| {
            let mut volume = around(x, 4.0, map);
            // As where the faces' normals cancel.
            volume.sums = [[0.0; 3]; 10];
            volume.solve(Otherwise::default()).expect("determined")
        };
        near(
            optimised(ON_PLANE, affine),
            [0.520_829_332_579_075, 0.098_767_687_170_719_6],
            1e-12,
        );
        near(
            optimised([0.5, 0.0, 0.2], curved),
            [0.497_528_281_019_881_95, 0.101_100_428_474_442_42],
            1e-12,
        );
    }

    #[test]
    fn faces_without_extent_leave_the_line_between_the_ends() {
        let flat = [DVec3::ZERO; 3];
        let mut volume = OrientedVolume::new(DVec3::ZERO, [0.0; 2], 1.0);
        volume.add(flat, [[0.5; 2]; 3]);
        let otherwise = Otherwise {
            ends: [Some([0.0, 1.0]), Some([1.0, 0.0])],
            at: 0.25,
        };
        assert_eq!(volume.solve(otherwise), Some([0.25, 0.75]));
        assert_eq!(volume.solve(Otherwise::default()), None);
    }
}
