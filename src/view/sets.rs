//! The named view sets: their directions, their presets and their names on the command line.
//!
//! Dodecahedron (20) for edge costs and small rhombicuboctahedron (24) for evaluation: Lindstrom & Turk 2000,
//! section 3.2. Octahedron with every triangle split in four k times, midpoints put back on the sphere (6, 18, 66,
//! 258, 1026, 4098 = 4^(k+1) + 2): Zhang & Turk 2002. Spiral: any number, evenly spread. Directions are unit vectors
//! from the scene towards the viewer. A new set is a function here and a case of [`ViewsName`].

use std::{fmt, path::PathBuf, str::FromStr};

use glam::DVec3;

use super::{Projection, Sphere, View, ViewSet, file};
use crate::{
    Error, Result,
    mesh::generate::subdivision,
    num::{Each, fixed::SubpixelBits, math},
};

/// The 50 % grey behind every model (Lindstrom & Turk 2000, section 3.2).
pub const BACKGROUND: u8 = 128;

/// The golden ratio and its inverse, and 1 + the square root of 2, rounded to nearest.
const GOLDEN: f64 = 1.618_033_988_749_895;
const GOLDEN_INVERSE: f64 = 0.618_033_988_749_894_8;
const SILVER: f64 = 2.414_213_562_373_095;

/// 2 pi / golden ratio^2 and 2 pi (sqrt 2 - 1), rounded to nearest.
const GOLDEN_ANGLE: f64 = 2.399_963_229_728_653;
const SILVER_ANGLE: f64 = 2.602_580_569_572_975_4;

/// Most directions of a spiral.
pub const SPIRAL_LIMIT: u32 = 4_098;

/// Most subdivisions of the octahedron: 4,098 directions.
pub const OCTAHEDRON_LIMIT: u32 = 5;

/// Both signs of every number of `v`, the last number changing fastest; 0 has one sign.
fn with_signs(v: [f64; 3], into: &mut Vec<DVec3>) {
    let signs = |x: f64| {
        if x == 0.0 { vec![x] } else { vec![-x, x] }
    };
    for x in signs(v[0]) {
        for y in signs(v[1]) {
            into.extend(signs(v[2]).into_iter().map(|z| DVec3::new(x, y, z)));
        }
    }
}

fn units(corners: &[[f64; 3]]) -> Vec<DVec3> {
    let mut directions = Vec::new();
    for &corner in corners {
        with_signs(corner, &mut directions);
    }
    directions.into_iter().filter_map(math::unit).collect()
}

/// The 20 vertices of the regular dodecahedron.
pub fn dodecahedron() -> Vec<DVec3> {
    units(&[
        [1.0, 1.0, 1.0],
        [0.0, GOLDEN_INVERSE, GOLDEN],
        [GOLDEN_INVERSE, GOLDEN, 0.0],
        [GOLDEN, 0.0, GOLDEN_INVERSE],
    ])
}

/// The 24 vertices of the small rhombicuboctahedron.
pub fn rhombicuboctahedron() -> Vec<DVec3> {
    units(&[[SILVER, 1.0, 1.0], [1.0, SILVER, 1.0], [1.0, 1.0, SILVER]])
}

/// `count` directions spread evenly along a spiral (spherical Fibonacci points; Swinbank & Purser 2006): all stand for
/// nearly the same share of the sphere, and no two look along one axis.
pub fn spiral(count: u32) -> Vec<DVec3> {
    let point = |i: u32| {
        let z = 1.0 - (2.0 * f64::from(i) + 1.0) / f64::from(count);
        let r = math::sqrt(1.0 - z * z);
        let angle = GOLDEN_ANGLE * f64::from(i);
        DVec3::new(r * math::cos(angle), r * math::sin(angle), z)
    };
    (0..count).map(point).collect()
}

/// `directions` turned as a whole; every `round` another way, 0 not at all.
///
/// About z by the golden angle and about x by the share `sqrt(2) - 1` of a circle, `round` times each: no two rounds
/// look from the same side.
pub fn turned(directions: &[DVec3], round: u32) -> Vec<DVec3> {
    if round == 0 {
        return directions.to_vec();
    }
    let [a, b] = [GOLDEN_ANGLE, SILVER_ANGLE].each(|angle| angle * f64::from(round));
    let [(sin_a, cos_a), (sin_b, cos_b)] = [a, b].each(|x| (math::sin(x), math::cos(x)));
    let turn = |d: &DVec3| {
        let (x, y) = (cos_a * d.x - sin_a * d.y, sin_a * d.x + cos_a * d.y);
        DVec3::new(x, cos_b * y - sin_b * d.z, sin_b * y + cos_b * d.z)
    };
    directions.iter().map(turn).collect()
}

/// The vertices of the octahedron subdivided `k` times; those of `k - 1` come first, in the same order.
///
/// `k` above `OCTAHEDRON_LIMIT` counts as the limit.
pub fn octahedron(k: u32) -> Vec<DVec3> {
    octahedron_faces(k).0
}

/// [`octahedron`] with its 8 * 4^k triangles, counter-clockwise seen from outside: what the share of the sphere that
/// a direction stands for is computed from.
pub fn octahedron_faces(k: u32) -> (Vec<DVec3>, Vec<[u32; 3]>) {
    let (x, y, z) = (DVec3::X, DVec3::Y, DVec3::Z);
    let nx = DVec3::NEG_X;
    let mut vertices = vec![x, nx, y, DVec3::NEG_Y, z, DVec3::NEG_Z];
    let upper = [[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4]];
    let lower = [[2, 0, 5], [1, 2, 5], [3, 1, 5], [0, 3, 5]];
    let mut triangles = [upper, lower].concat();
    for _ in 0..k.min(OCTAHEDRON_LIMIT) {
        subdivision::split(&mut vertices, &mut triangles);
    }
    (vertices, triangles)
}

impl ViewSet {
    /// Views onto `sphere` from `directions` (towards the viewer, of any length), in pixels of one sample, with 8
    /// sub-pixel bits on 50 % grey; placed and rolled as [`View::around`] says.
    ///
    /// # Errors
    /// [`Error::Usage`] where there is no direction, one has no length, the size is refused by
    /// [`ViewSet::check_size`], or the sphere is too large for numbers to stay finite.
    pub fn around(
        sphere: &Sphere,
        directions: &[DVec3],
        width: u32,
        height: u32,
        projection: Projection,
    ) -> Result<Self> {
        let count = directions.len();
        let size = [width, height];
        let view = |(i, &d)| View::around(sphere, d, [i, count], size, projection);
        let views: Option<Vec<View>> = directions.iter().enumerate().map(view).collect();
        let views = views.filter(|views| !views.is_empty()).ok_or_else(|| {
            Error::Usage(format!(
                "no views of {width} x {height} pixels from {count} directions onto a sphere of radius {:e} around \
                 ({:e}, {:e}, {:e}); expected at least one pixel and one direction, none of them zero, and a sphere that \
                 is neither too small nor too large for doubles",
                sphere.radius, sphere.center.x, sphere.center.y, sphere.center.z
            ))
        })?;
        let set = Self {
            width,
            height,
            samples: 1,
            subpixel: SubpixelBits::Eight,
            background: BACKGROUND,
            views,
        };
        set.check_size()?;
        Ok(set)
    }

    /// The 20 views that edge costs are measured in: dodecahedron, 256 x 256 pixels, one sample.
    ///
    /// # Errors
    /// [`Error::Usage`] where the sphere is too large for numbers to stay finite; never in the working frame.
    pub fn costs(sphere: &Sphere) -> Result<Self> {
        Self::around(sphere, &dodecahedron(), 256, 256, Projection::Perspective)
    }

    /// The 24 views that results are judged in: small rhombicuboctahedron, 512 x 512 pixels of 2 x 2 samples.
    ///
    /// # Errors
    /// As [`ViewSet::costs`].
    pub fn evaluation(sphere: &Sphere) -> Result<Self> {
        let directions = rhombicuboctahedron();
        Self::around(sphere, &directions, 512, 512, Projection::Perspective)?.with_samples(2)
    }
}

/// The value of `--views`: `dodecahedron`, `rhombicuboctahedron`, `octahedron:K`, `spiral:N` or a view file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum ViewsName {
    /// 20 directions.
    Dodecahedron,
    /// 24 directions.
    Rhombicuboctahedron,
    /// 4^(k+1) + 2 directions, k at most `OCTAHEDRON_LIMIT`.
    Octahedron(u32),
    /// This many directions along a spiral, 1 to `SPIRAL_LIMIT`.
    Spiral(u32),
    /// The views in a JSON file; see `view::file`.
    File(PathBuf),
}

impl ViewsName {
    /// The directions of a named set; `None` for a file, whose views are complete.
    #[must_use]
    pub fn directions(&self) -> Option<Vec<DVec3>> {
        match self {
            Self::Dodecahedron => Some(dodecahedron()),
            Self::Rhombicuboctahedron => Some(rhombicuboctahedron()),
            Self::Octahedron(k) => Some(octahedron(*k)),
            Self::Spiral(n) => Some(spiral(*n)),
            Self::File(_) => None,
        }
    }
}

impl fmt::Display for ViewsName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Dodecahedron => f.write_str("dodecahedron"),
            Self::Rhombicuboctahedron => f.write_str("rhombicuboctahedron"),
            Self::Octahedron(k) => write!(f, "octahedron:{k}"),
            Self::Spiral(n) => write!(f, "spiral:{n}"),
            Self::File(path) => write!(f, "{}", path.display()),
        }
    }
}

impl FromStr for ViewsName {
    type Err = Error;

    /// A name, or anything else that looks like a file: with a `.` or a path separator in it.
    fn from_str(text: &str) -> Result<Self> {
        let refused = |what: String| {
            Error::Usage(format!(
                "{what}; expected dodecahedron, rhombicuboctahedron, octahedron:K with K from 0 to \
                 {OCTAHEDRON_LIMIT}, spiral:N with N from 1 to {SPIRAL_LIMIT}, or a view file such as views.json"
            ))
        };
        match text {
            "dodecahedron" => Ok(Self::Dodecahedron),
            "rhombicuboctahedron" => Ok(Self::Rhombicuboctahedron),
            _ => {
                if let Some(k) = text.strip_prefix("octahedron:") {
                    return match k.parse() {
                        Ok(k) if k <= OCTAHEDRON_LIMIT => Ok(Self::Octahedron(k)),
                        _ => Err(refused(format!("octahedron:K with K = `{k}`"))),
                    };
                }
                if let Some(n) = text.strip_prefix("spiral:") {
                    return match n.parse() {
                        Ok(n) if (1..=SPIRAL_LIMIT).contains(&n) => Ok(Self::Spiral(n)),
                        _ => Err(refused(format!("spiral:N with N = `{n}`"))),
                    };
                }
                if text.contains(['.', '/', '\\']) {
                    Ok(Self::File(text.into()))
                } else {
                    Err(refused(format!("no views are called `{text}`")))
                }
            }
        }
    }
}

/// Reads the views that `name` stands for: from its file, in file units, or placed around `sphere`.
///
/// `width`, `height` and `projection` hold for named sets only; a file says its own.
///
/// # Errors
/// As [`ViewSet::around`] and [`file::read`].
pub fn resolve(
    name: &ViewsName,
    sphere: &Sphere,
    [width, height]: [u32; 2],
    projection: Projection,
) -> Result<ViewSet> {
    match name {
        ViewsName::File(path) => file::read(path),
        named => {
            let directions = named.directions().unwrap_or_default();
            ViewSet::around(sphere, &directions, width, height, projection)
        }
    }
}
