//! Open height fields over a square.

use glam::DVec3;

use super::Surface;
use crate::{
    mesh::Mesh,
    num::{Each, math},
};

/// Largest number of cells in one direction.
const CELL_LIMIT: u32 = 2_048;

/// The height of a point of a grid.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Height {
    /// 0.
    Flat,
    /// A saddle with a dent: a polynomial of degree 4, within 0.6 of 0.
    Polynomial,
    /// Eight waves along x and six along y, 0.05 high.
    Waves,
}

impl Height {
    fn at(self, x: f64, y: f64) -> f64 {
        match self {
            Self::Flat => 0.0,
            Self::Polynomial => 0.3 * (x * x - y * y) + 0.4 * x * y * (1.0 - x * x) * (1.0 - y),
            Self::Waves => {
                let (u, v) = (std::f64::consts::PI * x, std::f64::consts::PI * y);
                0.05 * math::sin(8.0 * u) * math::cos(6.0 * v)
            }
        }
    }
}

/// `n` by `m` cells (1 to 2,048 each) of two triangles over the square [-1, 1]^2, facing +z, with a boundary.
pub fn grid(n: u32, m: u32, height: Height) -> Mesh {
    grid_surface(n, m, height).into_mesh()
}

pub(super) fn grid_surface(n: u32, m: u32, height: Height) -> Surface {
    let [n, m] = [n, m].each(|s| s.clamp(1, CELL_LIMIT));
    let mut surface = Surface::default();
    for j in 0..=m {
        for i in 0..=n {
            let [x, y] = [(i, n), (j, m)].each(|(i, n)| 2.0 * (f64::from(i) / f64::from(n)) - 1.0);
            surface.positions.push(DVec3::new(x, y, height.at(x, y)));
        }
    }
    for j in 0..m {
        for i in 0..n {
            let a = j * (n + 1) + i;
            let (b, c, d) = (a + 1, a + n + 2, a + n + 1);
            surface.triangles.extend([[a, b, c], [a, c, d]]);
        }
    }
    surface
}
