//! Why pixels differ: every difference between a picture of the rasterizer and one of rays has a class.
//!
//! The rasterizer moves every vertex by up to half a sub-pixel along each axis and rounds depths down; rays do neither.
//! That explains a difference where
//! - the centre of the pixel is within [`TOLERANCE`] of an outline: of the triangle one picture shows and the other does
//!   not, or of the cut at the near plane;
//! - depths are within two units of 2^-32 plus what both triangles rise or fall within [`TOLERANCE`];
//! - a triangle is degenerate.
//!
//! A claim is judged against all triangles, not only against the other claim: each picture must show a triangle that can
//! be there and that nothing certainly hides. Every other difference is a bug, and in a view that needs no rounding
//! (every vertex on the sub-pixel grid, every depth a multiple of 2^-32) every difference is one.

use serde::Serialize;

use super::{
    cast::RayCaster,
    claim::{Fault, Pixel, QUANTA},
    grid,
    intersect::Rays,
};
use crate::{
    Error, Progress, Result,
    num::Each,
    parallel,
    raster::{Grid, SampleKey},
    view::{View, ViewSet},
};

/// Distance from an outline within which a difference is explained, in pixels: one step of an 8-bit grid. Snapping to it moves a
/// vertex by up to 0.71 of that, to the 16-bit grid by a 360th.
pub const TOLERANCE: f64 = 1.0 / 256.0;

/// The class of a pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Class {
    /// Both show nothing.
    Background,
    /// Both show the same triangle, equally deep.
    Equal,
    /// Explained: an outline passes within [`TOLERANCE`] of the centre.
    Edge,
    /// Explained: the two triangles are equally deep.
    DepthTie,
    /// Explained: a triangle has no more area than a step of the grid squared.
    Degenerate,
    /// Bug: the rasterizer shows a triangle that is not there.
    Stray,
    /// Bug: the rasterizer shows nothing where a triangle is.
    Hole,
    /// Bug: the rasterizer shows a triangle behind another one.
    Occluded,
    /// Bug: the same triangle at another depth.
    Depth,
    /// Bug: the rasterizer shows a triangle that the mesh does not have.
    Range,
    /// Bug: a difference, of any size, in a view that needs no rounding.
    GridExact,
    /// Bug: the rays show what cannot be, the rasterizer what can.
    Rays,
}

impl Class {
    /// Number of classes.
    pub const COUNT: usize = CLASSES.len();

    /// All classes, in their order.
    pub fn all() -> impl Iterator<Item = Self> {
        CLASSES.into_iter().map(|(class, ..)| class)
    }

    /// True for the three reasons why pictures may differ.
    pub fn is_explained(self) -> bool {
        matches!(self, Self::Edge | Self::DepthTie | Self::Degenerate)
    }

    /// True where nothing explains the difference.
    pub fn is_bug(self) -> bool {
        self > Self::Degenerate
    }

    /// Name in reports.
    pub fn name(self) -> &'static str {
        CLASSES[self as usize].1
    }

    /// Colour in pictures: greys without a difference, cold ones where it is explained, warm ones for bugs.
    pub fn color(self) -> [u8; 3] {
        CLASSES[self as usize].2
    }
}

/// Every class with its name and its colour, in their order.
const CLASSES: [(Class, &str, [u8; 3]); 12] = [
    (Class::Background, "background", [24, 24, 24]),
    (Class::Equal, "equal", [96, 96, 96]),
    (Class::Edge, "edge", [0, 160, 255]),
    (Class::DepthTie, "depth-tie", [0, 220, 120]),
    (Class::Degenerate, "degenerate", [130, 120, 255]),
    (Class::Stray, "stray", [255, 0, 0]),
    (Class::Hole, "hole", [255, 140, 0]),
    (Class::Occluded, "occluded", [255, 0, 180]),
    (Class::Depth, "depth", [255, 220, 0]),
    (Class::Range, "range", [255, 255, 255]),
    (Class::GridExact, "grid-exact", [255, 90, 90]),
    (Class::Rays, "rays", [190, 60, 0]),
];

/// A differing pixel with the integers to find it again.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Witness {
    /// Number of the view.
    pub view: usize,
    /// Column, from the left.
    pub x: u32,
    /// Row, from the top.
    pub y: u32,
    /// Why it differs.
    pub class: Class,
    /// The rasterizer's triangle.
    pub raster: Shown,
    /// The rays' triangle.
    pub rays: Shown,
}

/// The triangle that one picture shows at a pixel.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Shown {
    /// Number of the triangle in the file; none for the background.
    pub triangle: Option<u32>,
    /// In units of 2^-32.
    pub depth: u32,
    /// Distance of the centre from the triangle's outline in units of [`Shown::UNIT`], positive inside; none for the
    /// background.
    pub inside: Option<i64>,
}

impl Shown {
    /// The unit of distances, in pixels: 2^-24, so that those of 16-bit grids are no zeros.
    pub const UNIT: f64 = 1.0 / 16_777_216.0;
}

/// The classes of a picture.
#[derive(Clone, Debug)]
pub struct Classified {
    /// The class of every sample.
    pub classes: Grid<Class>,
    /// Every sample that differs, row by row.
    pub witnesses: Vec<Witness>,
    /// True where the view needs no rounding, so that nothing may differ.
    pub grid_exact: bool,
}

impl RayCaster {
    /// Says of every sample of view `index` whether two pictures of keys (as [`RayCaster::keys`] makes them) differ there,
    /// and why. `rays` may come from any ray caster whose depths are those of `raster` where the triangle is the same.
    ///
    /// # Errors
    /// [`Error::Usage`] where a picture has another size than the views; [`Error::Interrupted`].
    pub fn classify(
        &self,
        set: &ViewSet,
        index: usize,
        [raster, cast]: [&Grid<SampleKey>; 2],
        progress: &dyn Progress,
    ) -> Result<Classified> {
        let size = [set.width * set.samples, set.height * set.samples];
        let sizes = [raster, cast].each(|p| [p.width(), p.height()]);
        let view = set.views.get(index).filter(|_| sizes == [size; 2]);
        let Some(view) = view else {
            let count = set.views.len();
            let [first, second, expected] =
                [sizes[0], sizes[1], size].each(|[width, height]| format!("{width} x {height}"));
            return Err(Error::Usage(format!(
                "view {index} of {count} with pictures of {first} and {second}; expected {expected}"
            )));
        };
        let rays = Rays::new(view, set, &self.positions);
        let grid_exact = grid::is_exact(&rays, self.triangles.as_flattened(), set.subpixel);
        let judge = Judge {
            caster: self,
            rays: &rays,
            view,
            index,
            grid_exact,
        };
        let [width, height] = size.each(|side| side as usize);
        let mut classes = Grid::filled(size[0], size[1], Class::Background);
        let mut witnesses = Vec::new();
        for first in (0..height).step_by(64) {
            if progress.interrupted() {
                return Err(Error::Interrupted);
            }
            let found = parallel::map((height - first).min(64), |i| {
                let y = first + i;
                let row = y * width..(y + 1) * width;
                let (raster, cast) = (&raster.values()[row.clone()], &cast.values()[row]);
                judge.row(y as u32, raster, cast)
            });
            for (y, (row, seen)) in (first..).zip(found) {
                classes.values_mut()[y * width..][..width].copy_from_slice(&row);
                witnesses.extend(seen);
            }
        }
        Ok(Classified {
            classes,
            witnesses,
            grid_exact,
        })
    }
}

/// Compares the samples of one view.
struct Judge<'a> {
    caster: &'a RayCaster,
    rays: &'a Rays<'a>,
    view: &'a View,
    index: usize,
    grid_exact: bool,
}

fn triangle(key: SampleKey) -> Option<u32> {
    (!key.is_background()).then_some(key.id())
}

impl Judge<'_> {
    fn row(&self, y: u32, raster: &[SampleKey], cast: &[SampleKey]) -> (Vec<Class>, Vec<Witness>) {
        let mut witnesses = Vec::new();
        let classes = (0..)
            .zip(raster.iter().zip(cast))
            .map(|(x, (&shown, &hit))| {
                if shown == hit {
                    return match shown.is_background() {
                        true => Class::Background,
                        false => Class::Equal,
                    };
                }
                let at = [x, y].each(i64::from);
                let pixel = Pixel::new(self.caster, self.rays, self.view.cull, at);
                let class = self.class(&pixel, shown, hit);
                if class != Class::Equal {
                    let side = |key: SampleKey| Shown {
                        triangle: triangle(key),
                        depth: key.depth(),
                        inside: triangle(key).and_then(|id| {
                            let pixels = pixel.outline(id)?.distance;
                            Some((pixels / Shown::UNIT).round_ties_even() as i64)
                        }),
                    };
                    witnesses.push(Witness {
                        view: self.index,
                        x,
                        y,
                        class,
                        raster: side(shown),
                        rays: side(hit),
                    });
                }
                class
            });
        let classes = classes.collect();
        (classes, witnesses)
    }

    fn class(&self, pixel: &Pixel<'_>, shown: SampleKey, hit: SampleKey) -> Class {
        if self.grid_exact {
            return Class::GridExact;
        }
        let (ours, theirs) = (triangle(shown), triangle(hit));
        if ours == theirs {
            return self.depth(pixel, shown, hit);
        }
        match pixel.check(ours) {
            Err(Fault::Range) => return Class::Range,
            Err(Fault::Hole) => return Class::Hole,
            Err(Fault::Stray) => return Class::Stray,
            Err(Fault::Occluded) => return Class::Occluded,
            Ok(()) => {}
        }
        if pixel.check(theirs).is_err() {
            return Class::Rays;
        }
        let outlines = [ours, theirs].each(|id| pixel.outline(id?));
        let any = |what: fn(&super::outline::Outline) -> bool| outlines.iter().flatten().any(what);
        if any(|o| o.area <= TOLERANCE * TOLERANCE) {
            Class::Degenerate
        } else if any(|o| o.distance.abs() <= TOLERANCE) {
            Class::Edge
        } else {
            Class::DepthTie
        }
    }

    /// The class of a pixel whose triangle is not disputed, but its depth.
    fn depth(&self, pixel: &Pixel<'_>, shown: SampleKey, hit: SampleKey) -> Class {
        let Some(outline) = triangle(shown).and_then(|id| pixel.outline(id)) else {
            return Class::Range;
        };
        let [low, high] = outline.depths(TOLERANCE);
        let [z, exact] = [shown, hit].each(|key| f64::from(key.depth()));
        let near = z - exact <= QUANTA && exact - z <= QUANTA;
        if near || (z >= low - QUANTA && z <= high + QUANTA) {
            Class::Equal
        } else {
            Class::Depth
        }
    }
}
