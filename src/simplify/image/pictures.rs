//! The pictures that drive a run, their error (equation 8 of Lindstrom & Turk 2000, over all views, as an exact
//! integer), and its change by a patch of the mesh, which becomes an edit of their scene.
//!
//! The pictures number vertices and triangles without gaps, in the order of the mesh's own ids, so that ties of depth
//! are decided the same way. With Gouraud shading a collapse changes the normals of the whole link, and with them the
//! shading of one more ring of triangles (Lindstrom & Turk 2000, footnote 3); with stored normals only that of its own
//! faces.

use glam::DVec3;

use super::{EngineName, ReferenceImages, slots::Slots};
use crate::{
    collapse::{LiveMesh, NONE, Patch},
    num::{
        Each,
        math::{sqrt, unit},
    },
    raster::{
        self, BucketEngine, FaceGeometry, Grid, LayerEngine, Model, SceneEdit, Unrender,
        UnrenderScratch, ViewSubset,
    },
    view::Interpolation,
};

/// Pictures of a mesh as it is, and the sum of the squared luma differences from those of the original.
///
/// A pixel with `samples` x `samples` samples is the integer sum of them, and the difference is squared per pixel: the
/// unit of sums and costs is `(1 / samples^2)^2` squared levels, one squared level where there is one sample.
/// The sum is never taken from a cost that was computed earlier: every commit adds its own difference.
#[derive(Debug)]
pub struct Pictures {
    engine: Box<dyn Unrender>,
    /// The luma sums of the original's pictures.
    reference: Vec<Grid<u16>>,
    slots: Slots,
    /// A view is flat shaded.
    flat: bool,
    /// A view is Gouraud shaded.
    gouraud: bool,
    sum: u64,
    /// Number of views.
    views: usize,
    /// Pixels of all views.
    pixels: u64,
    /// Samples in a pixel.
    samples: u32,
}

/// Buffers of one thread.
#[derive(Debug)]
pub struct PictureScratch {
    engine: UnrenderScratch,
    translator: Translator,
}

impl Pictures {
    /// Draws `live` in the views of the original's pictures (in the same frame), and compares them.
    pub fn new(reference: &ReferenceImages, live: &LiveMesh, engine: EngineName) -> Self {
        let set = reference.set();
        let shaded = |by| set.views.iter().any(|v| v.shading.interpolation == by);
        let (slots, scene) = Slots::of(live, shaded(Interpolation::Lit));
        let (model, sums) = (Model::new(&scene, set), reference.sums());
        let engine: Box<dyn Unrender> = match engine {
            EngineName::Layers => Box::new(LayerEngine::new(model, set, sums)),
            EngineName::Buckets => Box::new(BucketEngine::new(model, set, sums)),
        };
        let mut pictures = Self {
            engine,
            reference: sums.to_vec(),
            slots,
            flat: shaded(Interpolation::Flat),
            gouraud: shaded(Interpolation::Gouraud),
            sum: 0,
            views: set.views.len(),
            pixels: set.views.len() as u64 * u64::from(set.width) * u64::from(set.height),
            samples: set.samples * set.samples,
        };
        let views = 0..pictures.views;
        pictures.sum = views
            .map(|i| pictures.squares(i).values().iter().sum::<u64>())
            .sum();
        pictures
    }

    /// The squared difference of every pixel of a view from the original's.
    fn squares(&self, view: usize) -> Grid<u64> {
        let sums = raster::sum_samples(&self.engine.luma(view), self.samples.isqrt());
        let mut y0 = self.reference[view].values().iter();
        sums.map(|y| y0.next().map_or(0, |&y0| u64::from(y.abs_diff(y0)).pow(2)))
    }

    /// The error of the pixels in which every triangle is seen, by triangle id, in units of [`Pictures::sum`] times the
    /// samples of a pixel: a pixel's squared difference for each of its samples. A sample that shows the background
    /// counts for the triangles beside it: their silhouette is not where it should be. O(samples of all views).
    pub fn errors(&self, live: &LiveMesh) -> Vec<u64> {
        let mut by_slot = vec![0; self.slots.triangle_count()];
        let samples = self.samples.isqrt();
        for view in 0..self.views {
            let (squares, keys) = (self.squares(view), self.engine.keys(view));
            let [width, height] = [keys.width(), keys.height()];
            for y in 0..height {
                for x in 0..width {
                    let square = squares.at(x / samples, y / samples);
                    if square == 0 {
                        continue;
                    }
                    let key = keys.at(x, y);
                    if !key.is_background() {
                        by_slot[key.id() as usize] += square;
                        continue;
                    }
                    let beside = [
                        (x > 0).then(|| (x - 1, y)),
                        (x + 1 < width).then_some((x + 1, y)),
                        (y > 0).then(|| (x, y - 1)),
                        (y + 1 < height).then_some((x, y + 1)),
                    ];
                    for key in beside.into_iter().flatten().map(|(x, y)| keys.at(x, y)) {
                        if !key.is_background() {
                            by_slot[key.id() as usize] += square;
                        }
                    }
                }
            }
        }
        let error = |id: u32| match self.slots.triangles[id as usize] {
            NONE => 0,
            slot => by_slot[slot as usize],
        };
        (0..live.triangle_ids()).map(error).collect()
    }

    /// Sum over views and pixels of the squared luma differences, in squared levels over `samples^4`.
    pub fn sum(&self) -> u64 {
        self.sum
    }

    /// Root mean square of the differences over all views, in levels (equation 2).
    pub fn rms(&self) -> f64 {
        sqrt(self.sum as f64 / self.pixels.max(1) as f64) / f64::from(self.samples)
    }

    /// The sum that a root mean square in levels stands for.
    pub fn sum_of_rms(&self, rms: f64) -> f64 {
        let sum = rms * f64::from(self.samples);
        sum * sum * self.pixels as f64
    }

    /// Number of views.
    pub fn views(&self) -> usize {
        self.views
    }

    /// The engine that keeps the pictures.
    pub fn engine(&self) -> &dyn Unrender {
        &*self.engine
    }

    /// Buffers for one thread; `alone` where nothing else evaluates at the same time.
    pub fn scratch(&self, alone: bool) -> PictureScratch {
        PictureScratch {
            engine: self.engine.scratch(alone),
            translator: Translator::new(&self.slots, self.flat),
        }
    }

    /// Prices a patch, not yet committed: its addition to the error in some views, negative where it makes those better.
    pub fn cost(
        &self,
        live: &LiveMesh,
        patch: &Patch,
        views: ViewSubset,
        scratch: &mut PictureScratch,
    ) -> i64 {
        let PictureScratch { engine, translator } = scratch;
        translator.fill(&self.slots, live, patch, self.gouraud);
        self.engine.evaluate(&translator.edit, views, engine)
    }

    /// Follows a patch, before or after `live` has it, and returns its addition to the error.
    pub fn commit(&mut self, live: &LiveMesh, patch: &Patch, scratch: &mut PictureScratch) -> i64 {
        let PictureScratch { engine, translator } = scratch;
        translator.fill(&self.slots, live, patch, self.gouraud);
        let cost = self.engine.commit(&translator.edit, engine);
        self.sum = self.sum.wrapping_add_signed(cost);
        cost
    }
}

/// A triangle after the change, at a vertex whose normal may change.
#[derive(Clone, Copy, Debug)]
struct ShadedFace {
    id: u32,
    corners: [u32; 3],
    points: [DVec3; 3],
    area_normal: DVec3,
}

impl ShadedFace {
    fn new(id: u32, corners: [u32; 3], points: [DVec3; 3]) -> Self {
        Self {
            id,
            corners,
            points,
            area_normal: FaceGeometry::new(points).area_normal,
        }
    }
}

/// Translates patches of the mesh to edits of the pictures; the buffers are reused.
#[derive(Clone, Debug, Default)]
struct Translator {
    /// The last patch, for an un-rendering engine.
    edit: SceneEdit,
    vertices: Vec<u32>,
    faces: Vec<ShadedFace>,
}

impl Translator {
    /// For pictures with these numbers; `flat` where one of them needs the geometry of faces.
    fn new(slots: &Slots, flat: bool) -> Self {
        Self {
            edit: SceneEdit::new(slots.triangle_count(), flat || slots.has_colors()),
            ..Self::default()
        }
    }

    /// Translates `patch`; the same before and after `live` has applied it. `gouraud` adds the changed normals and the
    /// triangles that they touch.
    fn fill(&mut self, slots: &Slots, live: &LiveMesh, patch: &Patch, gouraud: bool) {
        self.edit.clear();
        if let Some(m) = patch.moved {
            self.edit
                .moved
                .push((slots.vertices[m.vertex as usize], m.to));
        }
        if gouraud {
            self.find_shaded(slots, live, patch);
        }
        let numbers = |corners: [u32; 3]| corners.each(|v| slots.vertices[v as usize]);
        for face in &patch.added {
            let (id, corners) = (slots.triangles[face.id as usize], numbers(face.corners));
            let values = slots.values(live, &patch.rows, face.wedges);
            let points = patch.after(live, face);
            self.edit.add(id, corners, points, values);
        }
        if gouraud {
            // Other faces at these vertices look different too.
            let removed = |id: u32| patch.removed.binary_search_by_key(&id, |f| f.id).is_ok();
            for face in self.faces.iter().filter(|f| !removed(f.id)) {
                let (id, corners) = (slots.triangles[face.id as usize], numbers(face.corners));
                let values = slots.values(live, &patch.rows, live.wedges(face.id));
                self.edit.restyle(id, corners, face.points, values);
            }
        }
        for face in &patch.removed {
            let id = slots.triangles[face.id as usize];
            self.edit.remove(id, numbers(face.corners));
        }
    }

    /// Finds the vertices whose normals may change with their new normals, and all faces at them after the change.
    fn find_shaded(&mut self, slots: &Slots, live: &LiveMesh, patch: &Patch) {
        // (1) All vertices of the removed faces, but for the one that is gone.
        self.vertices.clear();
        let corners = patch.removed.iter().flat_map(|face| face.corners);
        self.vertices
            .extend(corners.filter(|&v| Some(v) != patch.gone));
        self.vertices.sort_unstable();
        self.vertices.dedup();
        // (2) All faces at them, by ascending id.
        self.faces.clear();
        let removed = |id: u32| patch.removed.binary_search_by_key(&id, |f| f.id).is_ok();
        let added = patch.added.iter();
        let added = added.map(|f| ShadedFace::new(f.id, f.corners, patch.after(live, f)));
        self.faces.extend(added);
        for &v in &self.vertices {
            for id in live.triangles_at(v).filter(|&id| !removed(id)) {
                if let (Some(corners), Some(points)) = (live.triangle(id), live.points(id)) {
                    self.faces.push(ShadedFace::new(id, corners, points));
                }
            }
        }
        self.faces.sort_unstable_by_key(|f| f.id);
        self.faces.dedup_by_key(|f| f.id);
        // (3) The new normals, summed by ascending id.
        for &v in &self.vertices {
            let at = self.faces.iter().filter(|f| f.corners.contains(&v));
            let sum = at.fold(DVec3::ZERO, |sum, f| sum + f.area_normal);
            let normal = unit(sum).unwrap_or(DVec3::ZERO);
            self.edit.normals.push((slots.vertices[v as usize], normal));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        collapse::{Changes, EdgeStar, Rules, Site},
        mesh::{canonical, generate},
        raster::Scene,
        view::frame_of,
    };

    #[test]
    fn the_normals_of_a_change_are_those_of_the_changed_mesh_to_the_last_bit() {
        let mesh = canonical(&generate::textured_torus(14, 9)).mesh;
        let mut live = LiveMesh::new(&mesh, frame_of(&mesh));
        let mut tested = 0;
        for edge in (0..live.edge_ids()).step_by(3) {
            let mut star = EdgeStar::default();
            if !star.gather(&live, edge) {
                continue;
            }
            let Ok(site) = Site::new(&live, &star, Rules::default()) else {
                continue;
            };
            let middle = site.fixed().unwrap_or_else(|| star.midpoint());
            let Ok(position) = site.admit(middle) else {
                continue;
            };
            let mut patch = Patch::default();
            site.patch(position, &mut patch);
            let (slots, _) = Slots::of(&live, false);
            let mut change = Translator::new(&slots, true);
            change.fill(&slots, &live, &patch, true);
            let before = change.edit.normals.clone();
            live.apply(&patch, &mut Changes::default());
            change.fill(&slots, &live, &patch, true);
            assert_eq!(
                change.edit.normals, before,
                "the same before and after the commit"
            );
            let ids: Vec<u32> = (0..live.triangle_ids())
                .filter(|&t| live.triangle(t).is_some())
                .collect();
            let triangles = ids.iter().filter_map(|&t| live.triangle(t)).collect();
            let fresh = Scene::new(live.positions().to_vec(), triangles, ids);
            for &(slot, normal) in &before {
                let vertex = slots.vertices.iter().position(|&s| s == slot);
                let expected = fresh.normals()[vertex.expect("a numbered vertex")];
                assert_eq!(
                    normal.to_array().map(f64::to_bits),
                    expected.to_array().map(f64::to_bits)
                );
                tested += 1;
            }
        }
        assert!(tested > 100, "{tested}");
    }
}
