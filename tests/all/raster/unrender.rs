//! Incremental pictures against pictures drawn from scratch, over random changes of every kind of mesh and view.

use glam::DVec3;
use lodmark::{
    num::fixed::SubpixelBits,
    raster::{
        self, BucketEngine, CornerValues, Grid, LayerEngine, Model, Scene, SceneEdit, Unrender,
        ViewSubset,
    },
    view::{Cull, Interpolation, Light, Projection, Shading, Specular, Sphere, View, ViewSet},
};
use proptest::prelude::*;

use crate::support::at;

/// A mesh under random surgery, kept without any incremental structure.
#[derive(Clone, Debug)]
struct Patient {
    positions: Vec<DVec3>,
    triangles: Vec<Option<[u32; 3]>>,
    colors: Option<Vec<[[f64; 3]; 3]>>,
    /// Stored normals, by number: see [`Patient::normals`].
    marks: Option<Vec<[u32; 3]>>,
}

impl Patient {
    /// Unit normals of a triangle in no relation to its neighbours', one in five absent.
    fn normals(&self, t: usize) -> [DVec3; 3] {
        let normal = |mark: u32| {
            let [x, y, z] = [7, 11, 13].map(|m| f64::from(mark % m) - f64::from(m / 2));
            match mark % 5 {
                0 => [f64::NAN; 3],
                _ => [x, y, z],
            }
        };
        let marks = self.marks.as_ref().map_or([0; 3], |marks| marks[t]);
        marks.map(|mark| raster::stored_normal(&normal(mark)))
    }

    fn values(&self, t: usize) -> CornerValues {
        CornerValues {
            colors: self.colors.as_ref().map_or([[0.0; 3]; 3], |c| c[t]),
            normals: self.normals(t),
        }
    }

    fn scene(&self) -> Scene {
        let ids: Vec<u32> = (0..)
            .zip(&self.triangles)
            .filter_map(|(t, c)| c.map(|_| t))
            .collect();
        let triangles = self.triangles.iter().flatten().copied().collect();
        let colors = self
            .colors
            .iter()
            .flat_map(|c| ids.iter().map(|&t| c[t as usize]));
        let colors = colors.collect();
        let marked = ids.iter().filter(|_| self.marks.is_some());
        let normals = marked.map(|&t| self.normals(t as usize)).collect();
        Scene::new(self.positions.clone(), triangles, ids)
            .with_colors(colors)
            .with_stored_normals(normals)
    }
}

/// One step of surgery.
#[derive(Clone, Debug)]
enum Step {
    /// One vertex of a triangle becomes another, which moves: what a collapse does, with no regard to legality.
    Collapse(prop::sample::Index, u8, DVec3),
    /// A vertex moves.
    Move(prop::sample::Index, DVec3),
    /// A triangle disappears.
    Remove(prop::sample::Index),
    /// A triangle turns over.
    Turn(prop::sample::Index),
    /// A triangle stores other normals.
    Mark(prop::sample::Index, u32),
}

/// Mostly inside the unit ball; sometimes outside the frame, behind the eye, or on a coarse grid with ties of depth.
fn position() -> impl Strategy<Value = DVec3> {
    let triple = |range: std::ops::Range<f64>| {
        (range.clone(), range.clone(), range).prop_map(|(x, y, z)| DVec3::new(x, y, z))
    };
    prop_oneof![
        6 => triple(-0.6..0.6),
        3 => (-3..=3_i32, -3..=3_i32, -3..=3_i32)
            .prop_map(|(x, y, z)| DVec3::new(f64::from(x), f64::from(y), f64::from(z)) * 0.25),
        1 => triple(-3.0..3.0),
        1 => triple(-400.0..400.0),
    ]
}

/// Soups that share vertices: open, non-manifold, with duplicate and degenerate faces, all of them often.
fn patient() -> impl Strategy<Value = Patient> {
    (
        proptest::collection::vec(position(), 4..14),
        proptest::collection::vec(any::<[prop::sample::Index; 3]>(), 1..24),
        proptest::option::weighted(0.3, Just(())),
        proptest::option::weighted(0.8, any::<u32>()),
    )
        .prop_map(|(positions, triangles, colored, marked)| {
            let corners = |t: &[prop::sample::Index; 3]| t.map(|i| i.index(positions.len()) as u32);
            let triangles: Vec<_> = triangles.iter().map(corners).map(Some).collect();
            let tone = |t: u32, k: u32, c: u32| f64::from((t * 7 + k * 3 + c * 5) % 11) / 10.0;
            let color = |t| [0, 1, 2].map(|k| [0, 1, 2].map(|c| tone(t, k, c)));
            let colors = colored.map(|()| (0..triangles.len() as u32).map(color).collect());
            let mark = |seed: u32, t: u32| [0, 1, 2].map(|k| seed % 1_000 + t * 17 + k * 5);
            let count = triangles.len() as u32;
            Patient {
                marks: marked.map(|seed| (0..count).map(|t| mark(seed, t)).collect()),
                positions,
                triangles,
                colors,
            }
        })
}

fn step() -> impl Strategy<Value = Step> {
    prop_oneof![
        4 => (any::<prop::sample::Index>(), 0..3_u8, position()).prop_map(|(t, k, p)| Step::Collapse(t, k, p)),
        1 => (any::<prop::sample::Index>(), position()).prop_map(|(v, p)| Step::Move(v, p)),
        1 => any::<prop::sample::Index>().prop_map(Step::Remove),
        1 => any::<prop::sample::Index>().prop_map(Step::Turn),
        1 => (any::<prop::sample::Index>(), 0..9_999_u32).prop_map(|(t, mark)| Step::Mark(t, mark)),
    ]
}

fn shading() -> impl Strategy<Value = Shading> {
    let shine = Specular {
        strength: 0.4,
        exponent: 9,
    };
    let specular = prop_oneof![Just(None), Just(Some(shine))];
    let interpolation = prop_oneof![
        Just(Interpolation::Flat),
        Just(Interpolation::Gouraud),
        Just(Interpolation::Lit)
    ];
    let fields = (interpolation, any::<bool>(), specular);
    fields.prop_map(|(interpolation, two_sided, specular)| Shading {
        interpolation,
        two_sided,
        specular,
    })
}

const SPHERE: Sphere = Sphere {
    center: DVec3::ZERO,
    radius: 0.7,
};

/// Perspective from outside and from inside the mesh (near-clipped), orthographic; all culls and lights.
fn view() -> impl Strategy<Value = View> {
    let place = (0..20_usize, 0..4_u8).prop_filter_map("a camera", move |(i, kind)| {
        let direction = DVec3::new(1.0, 0.3, -0.2) * (i as f64 - 9.5)
            + DVec3::new(-0.4, 1.0, 0.7 * (i % 3) as f64);
        let size = [32, 24];
        match kind {
            0 | 1 => View::around(&SPHERE, direction, [i, 20], size, Projection::Perspective),
            2 => View::around(&SPHERE, direction, [i, 20], size, Projection::Orthographic),
            _ => {
                let frame = [at(0.01, 0.02, 0.03), direction, at(0.1, 0.9, -0.3)];
                View::perspective(frame, [0.05, 2.0], size)
            }
        }
    });
    let cull = prop_oneof![Just(Cull::None), Just(Cull::Back), Just(Cull::Front)];
    let light = prop_oneof![
        3 => Just(Light::Headlight),
        1 => Just(Light::Point(DVec3::new(0.0, 2.0, 0.5))),
        1 => Just(Light::Direction(DVec3::new(0.6, 0.0, 0.8))),
    ];
    (place, shading(), cull, light).prop_map(|(view, shading, cull, light)| View {
        shading,
        cull,
        light,
        ..view
    })
}

fn views() -> impl Strategy<Value = ViewSet> {
    let bits = prop_oneof![Just(SubpixelBits::Eight), Just(SubpixelBits::Sixteen)];
    let samples = prop_oneof![2 => Just(1), 1 => Just(2), 1 => Just(4)];
    (proptest::collection::vec(view(), 1..4), bits, samples).prop_map(
        |(views, subpixel, samples)| ViewSet {
            width: 32 / samples,
            height: 24 / samples,
            samples,
            subpixel,
            background: 128,
            views,
        },
    )
}

/// The mesh after a step, and the step as the engines see it: everything that differs, found by comparing.
fn operate(before: &Patient, step: &Step) -> Option<Patient> {
    let mut after = before.clone();
    let alive = |i: &prop::sample::Index| {
        let ids: Vec<usize> = (0..before.triangles.len())
            .filter(|&t| before.triangles[t].is_some())
            .collect();
        (!ids.is_empty()).then(|| *i.get(&ids))
    };
    match step {
        Step::Collapse(t, k, p) => {
            let corners = before.triangles[alive(t)?]?;
            let (u, w) = (corners[*k as usize], corners[(*k as usize + 1) % 3]);
            if u == w {
                return None;
            }
            after.positions[u as usize] = *p;
            for (t, corners) in after.triangles.iter_mut().enumerate() {
                // A corner that moves stores something else.
                if let (Some(c), Some(marks)) = (corners.as_ref(), after.marks.as_mut()) {
                    for k in (0..3).filter(|&k| c[k] == w) {
                        marks[t][k] += 3;
                    }
                }
                if corners.is_some_and(|c| c.contains(&u) && c.contains(&w)) {
                    *corners = None;
                }
                if let Some(c) = corners {
                    c.iter_mut().filter(|v| **v == w).for_each(|v| *v = u);
                }
            }
        }
        Step::Move(v, p) => after.positions[v.index(before.positions.len())] = *p,
        Step::Remove(t) => after.triangles[alive(t)?] = None,
        Step::Turn(t) => after.triangles[alive(t)?].as_mut()?.swap(0, 1),
        Step::Mark(t, mark) => after.marks.as_mut()?[alive(t)?] = [*mark, mark / 7, mark / 49],
    }
    Some(after)
}

fn difference(before: &Patient, after: &Patient, gouraud: bool) -> SceneEdit {
    let vertices = 0..before.positions.len() as u32;
    let moved: Vec<(u32, DVec3)> = vertices
        .clone()
        .filter(|&v| before.positions[v as usize] != after.positions[v as usize])
        .map(|v| (v, after.positions[v as usize]))
        .collect();
    let (old, new) = (before.scene(), after.scene());
    let normals: Vec<(u32, DVec3)> = vertices
        .filter(|&v| {
            let changed = old.normals()[v as usize] != new.normals()[v as usize];
            gouraud && (changed || moved.iter().any(|m| m.0 == v))
        })
        .map(|v| (v, new.normals()[v as usize]))
        .collect();
    let touched = |by: &[(u32, DVec3)], corners: Option<[u32; 3]>| {
        corners.is_some_and(|c| by.iter().any(|entry| c.contains(&entry.0)))
    };
    let mut edit = SceneEdit::new(before.triangles.len(), true);
    (edit.moved, edit.normals) = (moved.clone(), normals.clone());
    for (t, (&a, &b)) in before.triangles.iter().zip(&after.triangles).enumerate() {
        let stays = a == b && !touched(&moved, a);
        let marked = before.normals(t) != after.normals(t);
        if stays && !marked && !touched(&normals, a) {
            continue;
        }
        if let Some(corners) = b {
            let positions = corners.map(|v| after.positions[v as usize]);
            let put = if stays {
                SceneEdit::restyle
            } else {
                SceneEdit::add
            };
            put(&mut edit, t as u32, corners, positions, after.values(t));
        }
        if let (Some(corners), false) = (a, stays) {
            edit.remove(t as u32, corners);
        }
    }
    edit
}

/// Both engines with the pictures of a mesh.
fn engines(mesh: &Patient, set: &ViewSet, reference: &[Grid<u16>]) -> [Box<dyn Unrender>; 2] {
    let model = || Model::new(&mesh.scene(), set);
    [
        Box::new(BucketEngine::new(model(), set, reference)),
        Box::new(LayerEngine::new(model(), set, reference)),
    ]
}

fn sums(mesh: &Patient, set: &ViewSet) -> Vec<Grid<u16>> {
    let scene = mesh.scene();
    set.views
        .iter()
        .map(|v| raster::luma_sums(&scene, v, set))
        .collect()
}

/// The squared differences of two pictures.
fn squares(a: &Grid<u16>, b: &Grid<u16>) -> i64 {
    let pairs = a.values().iter().zip(b.values());
    pairs
        .map(|(&a, &b)| (i64::from(a) - i64::from(b)).pow(2))
        .sum()
}

/// The sum of the area normals of a closed fan does not depend on where its middle is: it moves, and its normal stays.
#[test]
fn a_vertex_that_moves_under_an_unchanged_normal_is_lit_anew() {
    let rim = [at(-0.5, -0.25, 0.0), at(0.5, -0.25, 0.0), at(0.0, 0.5, 0.0)];
    let before = Patient {
        positions: [rim.as_slice(), &[at(0.0, 0.0, 0.25)]].concat(),
        triangles: vec![Some([0, 1, 3]), Some([1, 2, 3]), Some([2, 0, 3])],
        colors: None,
        marks: None,
    };
    let mut after = before.clone();
    after.positions[3] = at(0.125, 0.0, 0.5);
    let normals = [&before, &after].map(|patient| patient.scene().normals()[3]);
    assert_eq!(normals[0], normals[1]);
    let gouraud = Shading {
        interpolation: Interpolation::Gouraud,
        ..Shading::default()
    };
    let perspective = Projection::Perspective;
    let view = View::around(&SPHERE, at(0.5, 0.25, 1.0), [0, 1], [32, 24], perspective);
    let set = ViewSet {
        width: 32,
        height: 24,
        samples: 1,
        subpixel: SubpixelBits::Eight,
        background: 128,
        views: vec![View {
            shading: gouraud,
            ..view.expect("a camera")
        }],
    };
    let edit = difference(&before, &after, true);
    let reference = sums(&before, &set);
    let expected = raster::luma(&after.scene(), &set.views[0], &set).tones;
    for mut engine in engines(&before, &set, &reference) {
        let mut scratch = engine.scratch(false);
        engine.commit(&edit, &mut scratch);
        assert_eq!(engine.luma(0), expected);
    }
}

proptest! {
    #![proptest_config(crate::support::cases(1000))]

    #[test]
    fn incremental_pictures_equal_pictures_drawn_from_scratch(
        start in patient(),
        set in views(),
        steps in proptest::collection::vec(step(), 1..12),
    ) {
        let gouraud = set.views.iter().any(|v| v.shading.interpolation == Interpolation::Gouraud);
        let reference = sums(&start, &set);
        let mut engines = engines(&start, &set, &reference);
        let mut scratches = [engines[0].scratch(false), engines[1].scratch(false)];
        let mut now = start;
        let mut error = 0_i64;
        for step in &steps {
            let Some(after) = operate(&now, step) else { continue };
            let change = difference(&now, &after, gouraud);
            let mut costs = Vec::new();
            for (engine, scratch) in engines.iter_mut().zip(&mut scratches) {
                costs.push(engine.evaluate(&change, ViewSubset::All, scratch));
                costs.push(engine.commit(&change, scratch));
            }
            prop_assert_eq!(&costs, &vec![costs[0]; 4]);
            error += costs[0];
            for (i, view) in set.views.iter().enumerate() {
                let fresh = raster::luma(&after.scene(), view, &set);
                for engine in &engines {
                    prop_assert_eq!(&fresh.keys, &engine.keys(i));
                    prop_assert_eq!(&fresh.tones, &engine.luma(i));
                }
            }
            let errors = sums(&after, &set);
            prop_assert_eq!(error, errors.iter().zip(&reference).map(|(y, y0)| squares(y, y0)).sum::<i64>());
            now = after;
        }
    }

    #[test]
    fn a_subset_of_the_views_costs_what_its_views_cost(
        start in patient(),
        own in views(),
        more in proptest::collection::vec(view(), 12),
        step in step(),
        every in 0..6_u32,
    ) {
        // So many views that the layers engine divides them among threads.
        let set = ViewSet { views: more, ..own };
        let gouraud = set.views.iter().any(|v| v.shading.interpolation == Interpolation::Gouraud);
        let Some(after) = operate(&start, &step) else { return Ok(()) };
        let change = difference(&start, &after, gouraud);
        // The reference is the picture before: what a change costs is how far it leads away.
        let [before, sums] = [&start, &after].map(|patient| sums(patient, &set));
        let costs: Vec<i64> = before.iter().zip(&sums).map(|(y0, y)| squares(y0, y)).collect();
        let some: i64 = costs.iter().step_by(every.max(1) as usize).sum();
        let [buckets, layers] = engines(&start, &set, &before);
        let mut scratches = (buckets.scratch(false), layers.scratch(false), layers.scratch(true));
        // After a look at many pixels a lone one is shared among threads.
        for (views, expected) in [
            (ViewSubset::All, costs.iter().sum()),
            (ViewSubset::EveryNth(every), some),
            (ViewSubset::All, costs.iter().sum()),
        ] {
            prop_assert_eq!(buckets.evaluate(&change, views, &mut scratches.0), expected);
            prop_assert_eq!(layers.evaluate(&change, views, &mut scratches.1), expected);
            prop_assert_eq!(layers.evaluate(&change, views, &mut scratches.2), expected);
        }
    }

    #[test]
    fn no_order_of_triangles_and_no_rotation_changes_a_picture(
        start in patient(),
        set in views(),
        shuffle in any::<u64>(),
    ) {
        let ids: Vec<u32> = (0..start.triangles.len() as u32).collect();
        let mut order = ids.clone();
        order.sort_by_key(|&t| (u64::from(t) + 1).wrapping_mul(shuffle | 1) >> 7);
        let turn = |t: u32| (shuffle >> (t % 60)) as usize % 3;
        let triangles = order.iter().map(|&t| {
            let mut c = start.triangles[t as usize].expect("all alive");
            c.rotate_left(turn(t));
            c
        }).collect();
        let colors = start.colors.as_ref().map_or_else(Vec::new, |c| order.iter().map(|&t| {
            let mut c = c[t as usize];
            c.rotate_left(turn(t));
            c
        }).collect());
        let normals = order.iter().filter(|_| start.marks.is_some()).map(|&t| {
            let mut n = start.normals(t as usize);
            n.rotate_left(turn(t));
            n
        }).collect();
        let shuffled = Scene::new(start.positions.clone(), triangles, order.clone())
            .with_colors(colors)
            .with_stored_normals(normals);
        for view in &set.views {
            let (a, b) = (raster::rgb(&start.scene(), view, &set), raster::rgb(&shuffled, view, &set));
            prop_assert_eq!(a, b);
        }
    }
}
