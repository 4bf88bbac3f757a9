//! The two pinned scenes, measured: viewers are sampled against texels, and the best sample of each is refined.
//!
//! `LODMARK_BOUND_CASES` sets the number of viewpoints that look at a texel of a scene; from 10^5 on the scenes are whole
//! and the angle is the pinned 0.1 degrees, below that they are a part and the angle is wider.

use glam::{DVec2, DVec3};
use lodmark::{
    bound::view_cell::ViewCell,
    mesh::{Mesh, generate},
    simplify::billboards::BillboardOptions,
};

use super::{angle, before_the_city, behind, blocks, cloud, in_the_forest, place, within};
use crate::support::Random;

/// Viewpoints at a texel before the best is refined, and steps of that.
const LOOKS: [u32; 2] = [8, 24];

struct Scene {
    name: &'static str,
    mesh: Mesh,
    cell: ViewCell,
    /// The border of the cell, over [0, 1], seen from a point.
    viewer: fn(DVec2, f64) -> DVec2,
    /// Heights of eyes.
    eyes: [f64; 2],
    options: BillboardOptions,
}

fn scenes(whole: bool) -> [Scene; 2] {
    let options = |degrees: f64| {
        if whole {
            BillboardOptions {
                directions: BillboardOptions::DIRECTIONS,
                texels: 256,
                ..within(0.1)
            }
        } else {
            within(degrees)
        }
    };
    [
        Scene {
            name: "city",
            mesh: if whole { generate::city() } else { blocks(60) },
            cell: before_the_city(),
            viewer: |p, s| {
                let turn = (s - 0.5) * std::f64::consts::PI * 0.999_999;
                DVec2::new(p.x + (p.y + 6.0) * turn.tan(), -6.0)
            },
            eyes: [0.0, 8.0],
            options: options(0.3),
        },
        Scene {
            name: "forest",
            mesh: if whole {
                generate::forest()
            } else {
                generate::trees(400, 120.0)
            },
            cell: in_the_forest(),
            viewer: |_, s| DVec2::new(20.0 * s - 10.0, 0.0),
            eyes: [0.0, 0.0],
            options: options(0.5),
        },
    ]
}

/// The difference in height above the horizon between two points.
fn rise(v: DVec2, eye: f64, a: DVec3, b: DVec3) -> f64 {
    let turn = |p: DVec3| (p.z - eye).atan2((p.truncate() - v).length());
    (turn(a) - turn(b)).abs()
}

#[test]
fn no_texel_of_a_pinned_scene_is_seen_too_far_from_what_it_shows() {
    let wanted = crate::support::bound_count(20_000);
    for scene in scenes(wanted >= 100_000) {
        let mut random = Random::new(2007, 401);
        let Scene { mesh, viewer, .. } = &scene;
        let cloud = cloud(mesh, &scene.cell, &scene.options);
        let theta = match scene.options.limit {
            lodmark::simplify::billboards::Limit::Angle(aperture) => aperture.angle(),
            other => unreachable!("{other:?}"),
        };
        let (mut across, mut up, mut looks, mut shown) = (0.0_f64, 0.0_f64, 0, 0);
        while looks < wanted {
            let quad = &cloud.quads[random.below(cloud.quads.len())];
            let at = |side: u32, random: &mut Random| random.below(side as usize) as f64 + 0.5;
            let (x, y) = (
                at(quad.texels[0], &mut random),
                at(quad.texels[1], &mut random),
            );
            let texel = place(quad, x, y);
            let points = quad
                .drawn
                .iter()
                .filter_map(|&t| behind(mesh.corners(t as usize), texel, quad.along));
            for p in points {
                shown += 1;
                let seen = |s: f64| angle(viewer(p.truncate(), s), p, texel);
                let (mut best, mut step) = ((0.0, 0.0), 1.0 / f64::from(LOOKS[0]));
                for i in 0..LOOKS[0] {
                    let s = (f64::from(i) + random.unit()) * step;
                    if seen(s) >= best.0 {
                        best = (seen(s), s);
                    }
                }
                for i in 0..LOOKS[1] {
                    let sense = if i % 2 == 0 { 1.0 } else { -1.0 };
                    let s = (best.1 + sense * step).clamp(0.0, 1.0);
                    if seen(s) > best.0 {
                        best = (seen(s), s);
                    } else {
                        step *= 0.7;
                    }
                }
                looks += LOOKS.iter().sum::<u32>();
                if !quad.horizontal {
                    across = across.max(best.0);
                }
                let v = viewer(p.truncate(), best.1);
                for eye in scene.eyes {
                    up = up.max(rise(v, eye, p, texel));
                    up = up.max(rise(viewer(p.truncate(), 0.5), eye, p, texel));
                }
            }
        }
        println!(
            "{}: {looks} viewpoints at {shown} points behind texels of {} quads: at most {:.6} of the angle across, {:.4} degrees up or down ({:.4} claimed)",
            scene.name,
            cloud.quads.len(),
            across / theta,
            up.to_degrees(),
            cloud.displacement.vertical.to_degrees(),
        );
        assert!(
            across <= theta * (1.0 + 1e-9),
            "{}: {across} > {theta}",
            scene.name
        );
        assert!(across > 0.3 * theta, "{}: {across} of {theta}", scene.name);
        let claimed = cloud.displacement.vertical;
        assert!(
            up <= claimed * (1.0 + 1e-9),
            "{}: {up} > {claimed}",
            scene.name
        );
    }
}
