//! The rasterizer against exact oracles that share no code with it.

use lodmark::{
    num::fixed::SubpixelBits,
    raster::{PixelRect, ScreenVertex, Setup},
    view::Cull,
};
use proptest::prelude::*;

const BITS: [SubpixelBits; 2] = [SubpixelBits::Eight, SubpixelBits::Sixteen];

type Point = (i64, i64);

fn vertex((x, y): Point, depth: u32) -> ScreenVertex {
    ScreenVertex {
        x: x as i32,
        y: y as i32,
        depth,
        w_inverse: 1.0,
    }
}

const IMAGE: PixelRect = PixelRect::image(64, 64);

type Fragment = (i32, i32, u32);

fn fragments(corners: [ScreenVertex; 3], bits: SubpixelBits, region: PixelRect) -> Vec<Fragment> {
    let mut found = Vec::new();
    if let Some(setup) = Setup::new(corners, bits, Cull::None, IMAGE) {
        setup.fragments(region, |x, y, z| found.push((x, y, z)));
    }
    found
}

/// Which side of the line a -> b the point p is on after a move right by a hair 1/K and down by 1/K^2, which is what the
/// top-left rule means; scaled by K^2. Never 0 for different a and b.
fn perturbed_side(a: Point, b: Point, p: Point) -> i128 {
    const K: i128 = 1 << 32;
    let (dx, dy) = (i128::from(b.0 - a.0), i128::from(b.1 - a.1));
    let side = dx * i128::from(p.1 - a.1) - dy * i128::from(p.0 - a.0);
    side * K * K + dx - dy * K
}

fn oracle_covers(corners: [Point; 3], centre: Point) -> bool {
    let [a, b, c] = corners;
    if area(corners) == 0 {
        return false;
    }
    let sides = [(a, b), (b, c), (c, a)].map(|(from, to)| perturbed_side(from, to, centre));
    sides.iter().all(|&s| s > 0) || sides.iter().all(|&s| s < 0)
}

/// floor(sum of the areas of the three sub-triangles times the depth opposite / total area), in i128.
fn oracle_depth(corners: [Point; 3], depths: [u32; 3], p: Point) -> i128 {
    let cross = |a: Point, b: Point, c: Point| {
        i128::from(b.0 - a.0) * i128::from(c.1 - a.1)
            - i128::from(b.1 - a.1) * i128::from(c.0 - a.0)
    };
    let [a, b, c] = corners;
    let area = cross(a, b, c);
    let weights = [cross(p, b, c), cross(a, p, c), cross(a, b, p)];
    let products = weights
        .into_iter()
        .zip(depths)
        .map(|(w, z)| w * i128::from(z));
    let sum: i128 = products.sum();
    (sum * area.signum()).div_euclid(area.abs())
}

/// Coordinates in sub-pixels: anywhere near, on half pixels (ties), or far inside the guard band.
fn coordinate(bits: SubpixelBits) -> impl Strategy<Value = i64> {
    let scale = i64::from(bits.scale());
    let far = 8_000 * scale;
    prop_oneof![
        3 => -10 * scale..70 * scale,
        3 => (-4..130_i64).prop_map(move |v| v * scale / 2),
        1 => -far..far,
    ]
}

fn triangle() -> impl Strategy<Value = (SubpixelBits, [Point; 3], [u32; 3])> {
    proptest::sample::select(&BITS[..]).prop_flat_map(|bits| {
        let point = || (coordinate(bits), coordinate(bits));
        // Small and round depths divide without remainder often.
        let depth = || prop_oneof![any::<u32>(), 0..9_u32, (0..9_u32).prop_map(|z| z << 16)];
        let depths = [depth(), depth(), depth()];
        (Just(bits), [point(), point(), point()], depths)
    })
}

proptest! {
    #![proptest_config(crate::support::cases(1500))]

    #[test]
    fn coverage_and_depth_equal_exact_rational_arithmetic((bits, corners, depths) in triangle()) {
        let screen = [0, 1, 2].map(|i| vertex(corners[i], depths[i]));
        let scale = i64::from(bits.scale());
        let mut expected = Vec::new();
        for y in 0..64 {
            for x in 0..64 {
                let centre = (x * scale + scale / 2, y * scale + scale / 2);
                if oracle_covers(corners, centre) {
                    expected.push((x as i32, y as i32, oracle_depth(corners, depths, centre) as u32));
                }
            }
        }
        let found = fragments(screen, bits, IMAGE);
        prop_assert_eq!(&found, &expected);
        for f in &found {
            prop_assert!((depths.iter().min().unwrap()..=depths.iter().max().unwrap()).contains(&&f.2));
        }
    }

    #[test]
    fn no_corner_order_and_no_region_changes_a_fragment(
        (bits, corners, depths) in triangle(),
        (x0, y0, w, h) in (0..60_i32, 0..60_i32, 0..64_i32, 0..64_i32),
    ) {
        let screen = [0, 1, 2].map(|i| vertex(corners[i], depths[i]));
        let all = fragments(screen, bits, IMAGE);
        for order in [[1, 2, 0], [2, 0, 1], [0, 2, 1], [2, 1, 0], [1, 0, 2]] {
            prop_assert_eq!(&fragments(order.map(|i: usize| screen[i]), bits, IMAGE), &all);
        }
        let region = PixelRect { x0, y0, x1: (x0 + w).min(64), y1: (y0 + h).min(64) };
        let inside: Vec<_> =
            all.into_iter().filter(|f| f.0 >= x0 && f.0 < region.x1 && f.1 >= y0 && f.1 < region.y1).collect();
        prop_assert_eq!(fragments(screen, bits, region), inside);
    }

    #[test]
    fn no_corner_order_changes_a_bit_of_an_interpolated_value(
        (bits, corners, _) in triangle(),
        attributes in [any::<[u16; 2]>(), any::<[u16; 2]>(), any::<[u16; 2]>()],
        w_inverse in [0.01..3.0, 0.01..3.0, 0.01..3.0_f64],
    ) {
        let at = |order: [usize; 3]| {
            let screen = order.map(|i| ScreenVertex { w_inverse: w_inverse[i], ..vertex(corners[i], 0) });
            let values = order.map(|i| attributes[i].map(|x| f64::from(x) / 65_535.0));
            let setup = Setup::new(screen, bits, Cull::None, IMAGE)?;
            let mut found = Vec::new();
            setup.fragments(setup.bounds(), |x, y, _| {
                found.extend(setup.interpolate(&values, x, y).map(f64::to_bits));
            });
            Some(found)
        };
        for order in [[1, 2, 0], [2, 0, 1], [0, 2, 1], [2, 1, 0], [1, 0, 2]] {
            prop_assert_eq!(at(order), at([0, 1, 2]));
        }
    }

    #[test]
    fn every_pixel_centre_of_a_tiled_rectangle_is_covered_exactly_once(
        bits in proptest::sample::select(&BITS[..]),
        points in proptest::collection::vec((1..120_i64, 1..120_i64, any::<u16>()), 0..40),
        fine in any::<bool>(),
    ) {
        // Half-pixel steps put corners and edges on pixel centres; fine steps make slivers.
        let step = i64::from(bits.scale()) / if fine { 32 } else { 2 };
        let side = 120;
        let scaled = |p: Point| (p.0 * step, p.1 * step);
        let mut tiles: Vec<[Point; 3]> =
            vec![[(0, 0), (side, 0), (side, side)], [(0, 0), (side, side), (0, side)]];
        for (x, y, flip) in points {
            split(&mut tiles, (x, y));
            flip_edge(&mut tiles, usize::from(flip));
        }
        let mut counts = vec![0; 64 * 64];
        for tile in &tiles {
            for (x, y, _) in fragments(tile.map(|p| vertex(scaled(p), 7)), bits, IMAGE) {
                counts[y as usize * 64 + x as usize] += 1;
            }
        }
        let scale = i64::from(bits.scale());
        for y in 0..64 {
            for x in 0..64 {
                let centre = (x * scale + scale / 2, y * scale + scale / 2);
                // Left and top border belong to the rectangle, right and bottom do not.
                let inside = centre.0 < side * step && centre.1 < side * step;
                prop_assert_eq!(counts[(y * 64 + x) as usize], i32::from(inside), "pixel ({}, {})", x, y);
            }
        }
    }
}

fn area([a, b, c]: [Point; 3]) -> i64 {
    (b.0 - a.0) * (c.1 - a.1) - (b.1 - a.1) * (c.0 - a.0)
}

/// Inserts a point into the tile that strictly contains it, or into the two tiles at the edge it lies on.
fn split(tiles: &mut Vec<[Point; 3]>, p: Point) {
    let mut parts = Vec::new();
    tiles.retain(|&[a, b, c]| {
        let pieces = [[a, b, p], [b, c, p], [c, a, p]];
        let inside = pieces.iter().all(|&t| area(t) >= 0) && ![a, b, c].contains(&p);
        if inside {
            parts.extend(pieces.into_iter().filter(|&t| area(t) > 0));
        }
        !inside
    });
    tiles.extend(parts);
}

/// Flips an edge where the two tiles at it form a convex quadrilateral.
fn flip_edge(tiles: &mut [[Point; 3]], choice: usize) {
    let i = choice % tiles.len();
    let [a, b, c] = tiles[i];
    let has_side = |t: &[Point; 3]| [[t[0], t[1]], [t[1], t[2]], [t[2], t[0]]].contains(&[b, a]);
    let Some(j) = tiles.iter().position(has_side) else {
        return;
    };
    let mut corners = tiles[j].into_iter();
    let d = corners.find(|p| ![a, b].contains(p)).expect("a third");
    let (s, t) = ([c, a, d], [d, b, c]);
    if area(s) > 0 && area(t) > 0 {
        (tiles[i], tiles[j]) = (s, t);
    }
}

#[test]
fn a_triangle_without_area_draws_nothing() {
    for second in [(0, 0), (300, 300)] {
        let corners = [(0, 0), second, (900, 900)].map(|p| vertex(p, 0));
        assert!(fragments(corners, SubpixelBits::Eight, IMAGE).is_empty());
    }
}

#[test]
fn culling_follows_the_turn_on_the_screen() {
    // Counter-clockwise as a person sees it; rows count downwards.
    let front = [(0, 0), (0, 2560), (2560, 0)].map(|p| vertex(p, 0));
    let back = [front[0], front[2], front[1]];
    let drawn = |corners| {
        [Cull::None, Cull::Back, Cull::Front]
            .map(|cull| Setup::new(corners, SubpixelBits::Eight, cull, IMAGE).is_some())
    };
    assert_eq!(drawn(front), [true, true, false]);
    assert_eq!(drawn(back), [true, false, true]);
}
