//! ID buffers by ray casting.

use glam::DVec3;

use super::{
    hierarchy::{Hierarchy, Line},
    intersect::Rays,
};
use crate::{
    Progress, Result,
    mesh::Mesh,
    num::Each,
    parallel,
    raster::{Grid, SampleKey},
    view::{View, ViewSet},
};

/// Rows between two looks at the interrupt key.
const ROWS: u32 = 64;

/// Casts the rays of any view against one mesh.
pub struct RayCaster {
    pub(super) positions: Vec<DVec3>,
    pub(super) triangles: Vec<[u32; 3]>,
    pub(super) hierarchy: Hierarchy,
}

impl RayCaster {
    /// Takes the positions as they are and builds the hierarchy; O(n log n), on one thread.
    pub fn new(mesh: &Mesh) -> Self {
        Self {
            positions: mesh.positions().to_vec(),
            triangles: mesh.triangles().to_vec(),
            hierarchy: Hierarchy::new(mesh.positions(), mesh.triangles()),
        }
    }

    /// Depth and triangle of the first hit of the ray through the centre of every sample, as
    /// [`raster::keys`](crate::raster::keys) has them; depth is `floor(z/w 2^32)` of the exact hit, and of equal depths
    /// the lowest triangle is taken. `view` and `set` are in the units of the mesh.
    ///
    /// Exact: the hierarchy chooses which triangles are tested, never what is hit. 3 microseconds per ray for 69,451 triangles, 8 for
    /// 871,414, of one core.
    ///
    /// # Errors
    /// [`Error::Interrupted`](crate::Error::Interrupted).
    pub fn keys(
        &self,
        view: &View,
        set: &ViewSet,
        progress: &dyn Progress,
    ) -> Result<Grid<SampleKey>> {
        let rays = Rays::new(view, set, &self.positions);
        let (width, height) = (set.width * set.samples, set.height * set.samples);
        let planes = [0, 1].each(|axis| rays.planes(axis, &self.hierarchy));
        let mut keys = Grid::filled(width, height, SampleKey::BACKGROUND);
        let chunk = (ROWS * width).max(1) as usize;
        for (i, rows) in keys.values_mut().chunks_mut(chunk).enumerate() {
            if progress.interrupted() {
                return Err(crate::Error::Interrupted);
            }
            let first = i as u32 * ROWS;
            parallel::for_chunks(rows, width.max(1) as usize, |i, row| {
                let y = first + i as u32;
                for (key, x) in row.iter_mut().zip(0..width) {
                    let ray = rays.ray(i64::from(x), i64::from(y));
                    // Rows count downwards, planes upwards.
                    let row = planes[1][(height - 1 - y) as usize];
                    let line = Line::new([planes[0][x as usize], row]);
                    self.hierarchy.candidates(line.as_ref(), |t| {
                        if let Some(hit) = rays.hit(ray, self.triangles[t as usize]) {
                            *key = (*key).min(SampleKey::new(hit.depth, t));
                        }
                    });
                }
            });
        }
        Ok(keys)
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;
    use proptest::prelude::*;

    use super::*;
    use crate::{
        Silent,
        num::fixed::SubpixelBits,
        view::{Projection, Sphere},
    };

    /// Points anywhere, on a coarse grid (boxes without thickness, rays through corners), or all in one plane.
    fn mesh() -> impl Strategy<Value = Mesh> {
        let coordinate = |flat: bool| {
            if flat {
                prop_oneof![Just(0.25_f64), Just(0.25)].boxed()
            } else {
                prop_oneof![-1.0..1.0_f64, (-2..3_i32).prop_map(|i| f64::from(i) * 0.5)].boxed()
            }
        };
        let point = move |flat| (coordinate(false), coordinate(false), coordinate(flat));
        // Where the mesh is: at the origin, or so far away that f32 knows no details.
        let place = prop_oneof![Just(0.0), Just(65_536.0), Just(-3e6)];
        (any::<bool>(), place).prop_flat_map(move |(flat, place)| {
            let corners = [point(flat), point(flat), point(flat)];
            proptest::collection::vec(corners, 1..24).prop_map(move |soup| {
                let place = DVec3::new(place, -place, place * 0.5);
                let moved = |(x, y, z)| DVec3::new(x, y, z) + place;
                let triangles = (0..soup.len() as u32).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]);
                let triangles = triangles.collect();
                let positions = soup.into_iter().flatten().map(moved).collect();
                Mesh::from_triangles(positions, triangles).expect("valid")
            })
        })
    }

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(400) })]

        #[test]
        fn the_hierarchy_hides_no_triangle(
            mesh in mesh(),
            direction in prop_oneof![
                [-1.0..1.0_f64, -1.0..1.0, -1.0..1.0],
                proptest::sample::select(vec![[1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 1e-9, 0.0]]),
            ],
            orthographic in any::<bool>(),
        ) {
            let direction = DVec3::from_array(direction);
            prop_assume!(direction.length_squared() > 1e-3);
            let projection = Projection::of(orthographic);
            let sphere = Sphere::of_mesh(&mesh).expect("triangles");
            let set = ViewSet::around(&sphere, &[direction], 24, 16, projection)
                .expect("views")
                .with_subpixel(SubpixelBits::Sixteen);
            let (caster, view) = (RayCaster::new(&mesh), &set.views[0]);
            let keys = caster.keys(view, &set, &Silent).expect("not interrupted");
            let rays = Rays::new(view, &set, mesh.positions());
            for y in 0..16 {
                for x in 0..24 {
                    let ray = rays.ray(x, y);
                    let hits = (0..).zip(mesh.triangles()).filter_map(|(t, &triangle)| {
                        Some(SampleKey::new(rays.hit(ray, triangle)?.depth, t))
                    });
                    prop_assert_eq!(keys.at(x as u32, y as u32), hits.min().unwrap_or(SampleKey::BACKGROUND));
                }
            }
        }

        #[test]
        fn where_doubles_cannot_tell_exact_numbers_do(
            direction in [-1.0..1.0_f64, -1.0..1.0, -1.0..1.0],
            (x, y) in (0..24_i64, 0..16_i64),
            [s, t, depth] in [0.01..0.9_f64, 0.01..0.9, -0.5..0.5],
            third in [-1.0..1.0_f64, -1.0..1.0, -1.0..1.0],
        ) {
            let direction = DVec3::from_array(direction);
            prop_assume!(direction.length_squared() > 1e-3);
            let sphere = Sphere { center: DVec3::new(0.1, 0.2, 0.3), radius: 1.0 };
            let set = ViewSet::around(&sphere, &[direction], 24, 16, Projection::Orthographic)
                .expect("views");
            // An edge through the centre of a pixel, up to the rounding of its ends.
            let matrix = set.views[0].matrix;
            let axis = |i: usize| DVec3::new(matrix[i][0], matrix[i][1], matrix[i][2]);
            let on_ray = [(0, (2 * x + 1) as f64 / 24.0 - 1.0), (1, 1.0 - (2 * y + 1) as f64 / 16.0)]
                .map(|(i, ndc)| axis(i) * ((ndc - matrix[i][3]) / axis(i).dot(axis(i))));
            let centre = on_ray[0] + on_ray[1] + axis(2) * depth;
            let along = (axis(0) * s + axis(1) * t) * 0.3;
            let positions = vec![centre - along, centre + along * 0.7, centre + DVec3::from_array(third)];
            let rays = Rays::new(&set.views[0], &set, &positions);
            let ray = rays.ray(x, y);
            prop_assert_eq!(rays.hit(ray, [0, 1, 2]), rays.exact_hit(ray, [0, 1, 2]));
            prop_assert_eq!(rays.hit(ray, [1, 0, 2]).is_some(), rays.exact_hit(ray, [0, 1, 2]).is_some());
        }
    }
}
