//! The z-buffer and the shading of what it finds, against every triangle drawn on its own.

use glam::DVec3;
use lodmark::{
    mesh::generate,
    num::fixed::SubpixelBits,
    raster::{self, Face, FaceGeometry, Grid, Paint, Projector, SampleKey, Scene, Shader, ZBuffer},
    view::{Cull, Interpolation, Projection, Shading, Sphere, View, ViewSet},
};
use proptest::prelude::*;

use crate::support::scene_of;

/// Keys and luma from every triangle on its own, in the order of the scene.
fn one_by_one(scene: &Scene, ids: &[u32], view: &View, set: &ViewSet) -> (Vec<SampleKey>, Vec<u8>) {
    let projector = Projector::new(view, set);
    let image = projector.image();
    let shader = Shader::new(view);
    let mut keys = vec![SampleKey::BACKGROUND; (image.x1 * image.y1) as usize];
    let mut luma = vec![set.background; keys.len()];
    for (t, (corners, &id)) in scene.triangles().iter().zip(ids).enumerate() {
        let positions = corners.map(|v| scene.positions()[v as usize]);
        let colors = scene.colors().get(t);
        let paint = match view.shading.interpolation {
            Interpolation::Flat => {
                let g = FaceGeometry::new(positions);
                Paint::flat(shader.intensity(g.centroid, g.normal), colors)
            }
            Interpolation::Gouraud => {
                let intensity = corners.map(|v| {
                    let v = v as usize;
                    shader.intensity(scene.positions()[v], scene.normals()[v])
                });
                Paint::gouraud(intensity, colors)
            }
            Interpolation::Lit => {
                let own = FaceGeometry::new(positions).normal;
                let stored = scene
                    .stored_normals()
                    .get(t)
                    .map_or([DVec3::ZERO; 3], |n| *n);
                let intensity = [0, 1, 2].map(|k| {
                    let normal = if stored[k].length_squared() > 0.0 {
                        stored[k]
                    } else {
                        own
                    };
                    shader.intensity(positions[k], normal)
                });
                Paint::gouraud(intensity, colors)
            }
        };
        let face = Face {
            positions,
            screen: positions.map(|p| projector.screen(p)),
            paint,
        };
        face.pieces(&projector, view.cull, |setup, paint| {
            setup.fragments(image, |x, y, depth| {
                let at = (y * image.x1 + x) as usize;
                let key = SampleKey::new(depth, id);
                if key < keys[at] {
                    keys[at] = key;
                    luma[at] = paint.luma(setup, x, y);
                }
            });
        });
    }
    (keys, luma)
}

/// Triangles from far below a pixel to far beyond the image, many of them flat in depth so that ties are frequent.
fn soup() -> impl Strategy<Value = Vec<[DVec3; 3]>> {
    let size = prop_oneof![Just(0.02), Just(0.1), Just(0.5), Just(6.0)];
    let triangle = (
        size,
        any::<bool>(),
        proptest::array::uniform12(-1.0..1.0_f64),
    )
        .prop_map(|(size, grid, r)| {
            let at = |i: usize| DVec3::new(r[i], r[i + 1], r[i + 2]);
            [0, 1, 2].map(|k| {
                let p = at(0) * 0.6 + at(3 + 3 * k) * size;
                if grid { (p * 8.0).round() / 8.0 } else { p }
            })
        });
    // Every triangle twice: the copies tie at every sample, and only their ids tell them apart.
    proptest::collection::vec(triangle, 1..30).prop_map(|soup| [soup.clone(), soup].concat())
}

fn set() -> impl Strategy<Value = ViewSet> {
    (
        prop_oneof![Just(0.3), Just(1.0)],
        prop_oneof![
            Just(Interpolation::Flat),
            Just(Interpolation::Gouraud),
            Just(Interpolation::Lit)
        ],
        prop_oneof![Just(SubpixelBits::Eight), Just(SubpixelBits::Sixteen)],
        prop_oneof![Just(Cull::None), Just(Cull::Front), Just(Cull::Back)],
        prop_oneof![
            Just(Projection::Perspective),
            Just(Projection::Orthographic)
        ],
        1..3_u32,
    )
        .prop_map(|(radius, interpolation, bits, cull, projection, samples)| {
            let sphere = Sphere {
                center: DVec3::new(0.1, 0.0, -0.1),
                radius,
            };
            let directions = [DVec3::X, DVec3::new(-0.3, 0.7, 0.5)];
            let shading = Shading {
                interpolation,
                ..Shading::default()
            };
            ViewSet::around(&sphere, &directions, 37, 23, projection)
                .and_then(|set| set.with_samples(samples))
                .expect("a small set")
                .with_subpixel(bits)
                .with_cull(cull)
                .with_shading(shading)
        })
}

proptest! {
    #![proptest_config(crate::support::cases(400))]

    #[test]
    fn a_picture_never_differs_from_its_triangles_drawn_one_by_one(
        soup in soup(),
        set in set(),
        colored in any::<bool>(),
        marked in any::<bool>(),
        first_id in 0..9_u32,
        stride in prop_oneof![Just(1_u32), Just(5)],
    ) {
        let positions: Vec<DVec3> = soup.iter().flatten().copied().collect();
        let triangles: Vec<[u32; 3]> = (0..soup.len() as u32)
            .map(|t| [3 * t, 3 * t + 1, 3 * t + 2])
            .collect();
        // Ids with gaps, in another order than the triangles.
        let count = triangles.len() as u32;
        let ids: Vec<u32> = (0..count)
            .map(|t| if stride == 1 { t } else { first_id + (t * 41 + 7) % count })
            .collect();
        prop_assume!(ids.iter().collect::<std::collections::BTreeSet<_>>().len() == ids.len());
        let colors = if colored {
            (0..count).map(|t| [0, 1, 2].map(|k| [f64::from(t % 4) / 3.0, f64::from(k) / 2.0, 0.4])).collect()
        } else {
            Vec::new()
        };
        let stored = |t: u32| [0, 1, 2].map(|k| {
            let mark = f64::from((t * 3 + k) % 5);
            raster::stored_normal(&[mark - 2.0, (mark - 2.0) * 0.5, (mark - 2.0) * mark])
        });
        let normals = (0..count).filter(|_| marked).map(stored).collect();
        let scene = Scene::new(positions, triangles, ids.clone())
            .with_colors(colors)
            .with_stored_normals(normals);
        // One buffer for all views, as its users have it.
        let mut buffer = ZBuffer::new(1);
        for view in &set.views {
            let (keys, luma) = one_by_one(&scene, &ids, view, &set);
            buffer.draw(&scene, view, &set);
            prop_assert_eq!(buffer.keys().values(), &keys);
            let picture = raster::luma(&scene, view, &set);
            prop_assert_eq!(picture.keys.values(), &keys);
            prop_assert_eq!(picture.tones.values(), &luma);
            let bare = raster::keys(&scene, view, &set);
            prop_assert_eq!(bare.keys.values(), &keys);
            let colours = raster::rgb(&scene, view, &set);
            prop_assert_eq!(Some(colours.luma()), Grid::new(set.width * set.samples, set.height * set.samples, luma.clone()));
            if !colored {
                prop_assert_eq!(colours.tones.values(), luma.iter().map(|&v| [v; 3]).collect::<Vec<_>>());
            }
        }
    }
}

#[test]
fn a_reused_buffer_and_any_number_of_parts_give_the_same_picture() {
    let mesh = generate::icosphere(6);
    let scene = scene_of(&mesh);
    let sphere = Sphere::of_mesh(&mesh).expect("triangles");
    let pictures = |threads: usize| -> Vec<(Grid<SampleKey>, u64)> {
        let mut buffer = ZBuffer::new(threads);
        let sizes = [[90, 70], [16, 16], [90, 70]];
        let pictures = sizes.map(|[width, height]| {
            let directions = [DVec3::new(0.2, -0.4, 0.9)];
            let projection = Projection::Perspective;
            let set = ViewSet::around(&sphere, &directions, width, height, projection);
            let set = set.expect("a view");
            buffer.draw(&scene, &set.views[0], &set);
            (buffer.keys().clone(), buffer.dropped())
        });
        pictures.into()
    };
    let expected = pictures(1);
    assert_eq!(expected[0], expected[2]);
    for threads in [0, 2, 3, 8] {
        assert!(pictures(threads) == expected, "{threads} threads");
    }
}
