//! The layers engine: every sample keeps all of its fragments, so what a removed triangle hid is at hand.
//!
//! Nothing is drawn again but the triangles of the change. A view is left out, exactly, where none of the triangles that
//! go is seen and those that come are behind everything seen in the tiles of their box. Views are kept in parts of at
//! most 64; the vertices of a part lie together for all of its views, and a bit for every view says where a triangle is
//! seen. Views are dealt out to the parts one by one, those with Gouraud shading after the others: in a set, neighbours
//! see much the same, and every part should have as much to do for a change as any other.

mod fragment_lists;
mod probe;
mod projected;
mod view;
mod view_delta;

use self::{
    projected::{Projected, ScreenBoxes},
    view::{LayerView, ProbeContext},
    view_delta::ViewDelta,
};
use super::{Model, SceneEdit, Unrender, UnrenderScratch, ViewSubset};
use crate::{
    parallel,
    raster::{Grid, SampleKey},
    view::ViewSet,
};

/// Views that a part has bits for.
const MOST_VIEWS: usize = 64;

/// Fewest views that are worth a part of their own.
const FEWEST_VIEWS: usize = 5;

/// Most parts that the views are divided into for the sake of threads.
const PARTS: usize = 4;

/// Pictures of a mesh in all views, with all their layers.
#[derive(Clone, Debug)]
pub struct LayerEngine {
    model: Model,
    parts: Vec<Part>,
    size: [u32; 2],
}

/// Buffers of an evaluation, reused.
#[derive(Clone, Debug)]
struct LayerScratch {
    parts: Vec<PartScratch>,
    /// Nothing else runs beside: parts may be given to other threads.
    alone: bool,
}

#[derive(Clone, Debug)]
struct PartScratch {
    screens: Screens,
    delta: ViewDelta,
}

/// An edit on the screens of the views of a part.
#[derive(Clone, Debug)]
struct Screens {
    /// Vertices that move, as they will be.
    moved: Projected,
    /// Bounding boxes of the fresh triangles, and of all that go and come.
    fresh: ScreenBoxes,
    all: ScreenBoxes,
    /// Views, one bit for each, in which a triangle that goes is seen.
    uncovers: u64,
}

/// Some of the views.
#[derive(Clone, Debug)]
struct Part {
    views: Vec<LayerView>,
    /// Their indices in the set.
    indices: Vec<usize>,
    /// All vertices on the screens of these views.
    vertices: Projected,
    /// Gouraud shading: intensities by vertex and view.
    intensities: Vec<f64>,
    /// Samples that show a triangle, by triangle and view.
    counts: Vec<u32>,
    /// By triangle, one bit for every view where its count is not 0.
    seen: Vec<u64>,
}

impl Part {
    fn new(model: &Model, views: Vec<(usize, LayerView)>) -> Self {
        let (indices, views): (Vec<_>, Vec<_>) = views.into_iter().unzip();
        let count = views.len();
        let shaded = views.iter().any(|view| !view.plain);
        let mut part = Self {
            vertices: Projected::new(count, model.positions.len(), shaded),
            intensities: Vec::new(),
            counts: vec![0; model.corners.len() * count],
            seen: vec![0; model.corners.len()],
            views,
            indices,
        };
        for (v, &position) in model.positions.iter().enumerate() {
            for (lane, view) in part.views.iter().enumerate() {
                part.vertices.set(v, lane, view.projector.screen(position));
            }
        }
        if part.views.iter().any(|view| view.gouraud) {
            let views = &part.views;
            let at = |v| {
                views
                    .iter()
                    .map(move |view| view.vertex_intensity(model, v))
            };
            part.intensities = (0..model.positions.len() as u32).flat_map(at).collect();
        }
        for (lane, view) in part.views.iter().enumerate() {
            for shown in view.lists.shown() {
                let id = shown.id() as usize;
                if id < part.seen.len() {
                    part.counts[id * count + lane] += 1;
                    part.seen[id] |= 1 << lane;
                }
            }
        }
        part
    }

    /// Puts the vertices that move on the screens of the views in `lanes` (a bit for each), and finds the boxes; those of
    /// other views mean nothing.
    fn project(&self, edit: &SceneEdit, lanes: u64, screens: &mut Screens) {
        let Screens {
            moved,
            fresh,
            all,
            uncovers,
        } = screens;
        moved.resize(edit.moved.len());
        for (entry, m) in edit.moved.iter().enumerate() {
            for lane in each(lanes) {
                moved.set(entry, lane, self.views[lane].projector.screen(m.1));
            }
        }
        fresh.clear(self.views.len());
        for &v in &edit.rim {
            fresh.add(&self.vertices, v as usize);
        }
        for &entry in &edit.movers {
            fresh.add(moved, entry as usize);
        }
        all.copy(fresh);
        for &v in &edit.inside {
            all.add(&self.vertices, v as usize);
        }
        let seen = edit.gone.iter().map(|&id| self.seen[id as usize]);
        *uncovers = seen.fold(0, |all, bits| all | bits);
    }

    fn evaluate(
        &self,
        model: &Model,
        edit: &SceneEdit,
        lanes: u64,
        scratch: &mut PartScratch,
    ) -> i64 {
        if lanes == 0 {
            return 0;
        }
        let PartScratch { screens, delta } = scratch;
        self.project(edit, lanes, screens);
        let mut sum = 0;
        for lane in each(lanes) {
            let context = ProbeContext {
                model,
                edit,
                part: self,
                screens,
                lane,
            };
            sum += self.views[lane].probe(&context, delta);
        }
        sum
    }

    fn commit(&mut self, model: &Model, edit: &SceneEdit, scratch: &mut PartScratch) -> i64 {
        let PartScratch { screens, delta } = scratch;
        self.project(edit, all(self.views.len()), screens);
        let mut views = std::mem::take(&mut self.views);
        let lane_count = views.len();
        let mut sum = 0;
        for (lane, view) in views.iter_mut().enumerate() {
            let context = ProbeContext {
                model,
                edit,
                part: self,
                screens,
                lane,
            };
            sum += view.probe(&context, delta);
            view.apply(&context, delta);
            for &(before, after) in &delta.swaps {
                for (id, step) in [(before, u32::MAX), (after, 1)] {
                    let Some(seen) = self.seen.get_mut(id as usize) else {
                        continue; // the background
                    };
                    let count = &mut self.counts[id as usize * lane_count + lane];
                    *count = count.wrapping_add(step);
                    *seen = *seen & !(1 << lane) | u64::from(*count > 0) << lane;
                }
            }
        }
        self.views = views;
        for (entry, &(v, _)) in edit.moved.iter().enumerate() {
            self.vertices.copy(v as usize, &screens.moved, entry);
        }
        if !self.intensities.is_empty() {
            for &(v, normal) in &edit.normals {
                let position = model.position_after(edit, v);
                for (lane, view) in self.views.iter().enumerate() {
                    self.intensities[v as usize * lane_count + lane] =
                        view.shader.intensity(position, normal);
                }
            }
        }
        sum
    }
}

/// The lowest `lanes` bits, at most 64.
fn all(lanes: usize) -> u64 {
    match lanes {
        0 => 0,
        n => u64::MAX >> (64 - n),
    }
}

/// The lanes whose bits are set.
fn each(mut lanes: u64) -> impl Iterator<Item = usize> {
    std::iter::from_fn(move || {
        let lane = (lanes != 0).then(|| lanes.trailing_zeros() as usize)?;
        lanes &= lanes - 1;
        Some(lane)
    })
}

impl LayerEngine {
    /// Draws the model in every view of the set. `reference` has the luma sums of every view (see
    /// [`luma_sums`](crate::raster::luma_sums)).
    pub fn new(model: Model, set: &ViewSet, reference: &[Grid<u16>]) -> Self {
        let colored = !model.colors.is_empty();
        let count = set.views.len();
        let threads = parallel::threads().min(PARTS);
        let part_count = threads
            .min(count / FEWEST_VIEWS)
            .max(count.div_ceil(MOST_VIEWS))
            .max(1);
        let views = parallel::map(count, |i| {
            LayerView::new(&model, &set.views[i], set, reference[i].values(), colored)
        });
        let mut views: Vec<(usize, LayerView)> = views.into_iter().enumerate().collect();
        views.sort_by_key(|(_, view)| view.gouraud);
        let mut dealt: Vec<Vec<_>> = (0..part_count).map(|_| Vec::new()).collect();
        for (turn, view) in views.into_iter().enumerate() {
            dealt[turn % part_count].push(view);
        }
        let parts = parallel::map_vec(dealt, |views| Part::new(&model, views));
        Self {
            model,
            parts,
            size: [set.width * set.samples, set.height * set.samples],
        }
    }

    fn view(&self, index: usize) -> &LayerView {
        let mut parts = self.parts.iter();
        let view = parts.find_map(|part| {
            let lane = part.indices.iter().position(|&i| i == index)?;
            Some(&part.views[lane])
        });
        view.expect("a view of the set")
    }

    fn plane<T: Copy>(&self, values: Vec<T>) -> Grid<T> {
        Grid::new(self.size[0], self.size[1], values).expect("a value for every sample")
    }
}

impl Unrender for LayerEngine {
    fn scratch(&self, alone: bool) -> UnrenderScratch {
        let part = |part: &Part| PartScratch {
            screens: Screens {
                moved: Projected::new(part.views.len(), 1, part.views.iter().any(|v| !v.plain)),
                fresh: ScreenBoxes::default(),
                all: ScreenBoxes::default(),
                uncovers: 0,
            },
            delta: ViewDelta::default(),
        };
        UnrenderScratch::new(LayerScratch {
            parts: self.parts.iter().map(part).collect(),
            alone,
        })
    }

    fn evaluate(&self, edit: &SceneEdit, views: ViewSubset, scratch: &mut UnrenderScratch) -> i64 {
        let scratch: &mut LayerScratch = scratch.of();
        let model = &self.model;
        let work = |i: usize, scratch: &mut PartScratch| {
            let part = &self.parts[i];
            let chosen = part
                .indices
                .iter()
                .map(|&view| u64::from(views.contains(view)));
            let lanes = chosen.rev().fold(0, |bits, chosen| bits << 1 | chosen);
            part.evaluate(model, edit, lanes, scratch)
        };
        if scratch.alone && self.parts.len() > 1 {
            parallel::sum_mut(&mut scratch.parts, &work)
        } else {
            let parts = scratch.parts.iter_mut().enumerate();
            parts.map(|(i, part)| work(i, part)).sum()
        }
    }

    fn commit(&mut self, edit: &SceneEdit, scratch: &mut UnrenderScratch) -> i64 {
        let scratch: &mut LayerScratch = scratch.of();
        let model = &self.model;
        let work =
            |(part, scratch): (&mut Part, &mut PartScratch)| part.commit(model, edit, scratch);
        let count = self.parts.len();
        let pairs = self.parts.iter_mut().zip(&mut scratch.parts);
        let sum = if count > 1 {
            let mut pairs: Vec<_> = pairs.collect();
            parallel::sum_mut(&mut pairs, &|_, (part, scratch)| work((part, scratch)))
        } else {
            pairs.map(work).sum()
        };
        self.model.apply(edit);
        sum
    }

    fn luma(&self, view: usize) -> Grid<u8> {
        self.plane(self.view(view).luma())
    }

    fn keys(&self, view: usize) -> Grid<SampleKey> {
        self.plane(self.view(view).keys())
    }
}
