//! Switch distances, held against a judge that draws by itself: rays through pixels, no rasterizer.

use glam::DVec3;
use lodmark::{
    Mesh, Options, Target,
    chain::{Chain, Levels, Screen, chain},
    mesh::generate,
    num::math::{sqrt, tan},
    view::Sphere,
};

use crate::support::distance;

/// Samples of a pixel of the judge along each axis.
const SAMPLES: usize = 2;

/// A picture from a point: whether samples are covered, and the luma of pixels.
struct Picture {
    side: usize,
    covered: Vec<bool>,
    luma: Vec<f64>,
}

/// The 24 directions that evaluation looks from.
fn directions() -> Vec<DVec3> {
    let far = 1.0 + sqrt(2.0);
    let mut found = Vec::new();
    for bits in 0..8 {
        let sign = |axis: u32| if bits >> axis & 1 == 1 { 1.0 } else { -1.0 };
        for long in 0..3 {
            let mut corner = DVec3::new(sign(0), sign(1), sign(2));
            corner[long] *= far;
            found.push(corner.normalize());
        }
    }
    found
}

/// Draws a mesh from `eye` towards `center`; `pixel` is the width of a pixel at distance 1.
fn draw(mesh: &Mesh, eye: DVec3, center: DVec3, pixel: f64, side: usize) -> Picture {
    let forward = (center - eye).normalize();
    let right = forward.cross(DVec3::new(0.3, 0.5, 0.8)).normalize();
    let up = right.cross(forward);
    let width = side * SAMPLES;
    let step = pixel / SAMPLES as f64;
    let on = |p: DVec3| {
        let p = p - eye;
        let (x, y, z) = (p.dot(right), p.dot(up), p.dot(forward));
        let middle = 0.5 * width as f64;
        DVec3::new(x / z / step + middle, y / z / step + middle, 1.0 / z)
    };
    let mut samples = vec![(0.0_f64, 128.0_f64); width * width];
    for t in 0..mesh.triangles().len() {
        let corners = mesh.corners(t);
        let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
        let toward = eye - (corners[0] + corners[1] + corners[2]) / 3.0;
        let tone = 255.0 * normal.normalize_or_zero().dot(toward.normalize()).abs();
        let p = corners.map(on);
        let cross =
            |a: DVec3, b: DVec3, x: f64, y: f64| (b.x - a.x) * (y - a.y) - (b.y - a.y) * (x - a.x);
        let area = cross(p[0], p[1], p[2].x, p[2].y);
        let range = |of: fn(DVec3) -> f64| {
            let [a, b, c] = p.map(of);
            let low = (a.min(b).min(c) - 0.5).ceil().max(0.0) as usize;
            let high = (a.max(b).max(c) - 0.5).floor().min(width as f64 - 1.0);
            low..(high + 1.0).max(0.0) as usize
        };
        for row in range(|p| p.y) {
            for column in range(|p| p.x) {
                let (x, y) = (column as f64 + 0.5, row as f64 + 0.5);
                let b = [1, 2, 0].map(|i| cross(p[i], p[(i + 1) % 3], x, y) / area);
                if b.iter().all(|&b| b >= 0.0) {
                    let near: f64 = (0..3).map(|i| b[i] * p[i].z).sum();
                    let sample = &mut samples[row * width + column];
                    if near > sample.0 {
                        *sample = (near, tone);
                    }
                }
            }
        }
    }
    let mut luma = vec![0.0; side * side];
    for (i, sample) in samples.iter().enumerate() {
        let (x, y) = (i % width / SAMPLES, i / width / SAMPLES);
        luma[y * side + x] += sample.1 / (SAMPLES * SAMPLES) as f64;
    }
    Picture {
        side,
        covered: samples.iter().map(|s| s.0 > 0.0).collect(),
        luma,
    }
}

/// The largest distance in pixels from what `a` covers to what `b` covers, up to `most`.
fn displacement(a: &Picture, b: &Picture, most: f64) -> f64 {
    let width = a.side * SAMPLES;
    let reach = (most * SAMPLES as f64).ceil() as i64;
    let mut largest = 0.0_f64;
    for (i, _) in a
        .covered
        .iter()
        .enumerate()
        .filter(|(i, c)| **c && !b.covered[*i])
    {
        let (x, y) = ((i % width) as i64, (i / width) as i64);
        let mut nearest = most * SAMPLES as f64;
        for v in (y - reach).max(0)..(y + reach + 1).min(width as i64) {
            for u in (x - reach).max(0)..(x + reach + 1).min(width as i64) {
                if b.covered[v as usize * width + u as usize] {
                    let squared = ((u - x).pow(2) + (v - y).pow(2)) as f64;
                    nearest = nearest.min(sqrt(squared));
                }
            }
        }
        largest = largest.max(nearest / SAMPLES as f64);
    }
    largest
}

/// The largest displacement in pixels (at most 4) and RMS of luma over a square picture as high as the screen, from all
/// sides.
fn seen(original: &Mesh, level: &Mesh, distance: f64, height: u32) -> [f64; 2] {
    let sphere = Sphere::of_mesh(original).expect("triangles");
    let pixel = 2.0 * tan(30.0_f64.to_radians()) / f64::from(height);
    let side = (2.4 * sphere.radius / (distance * pixel)).ceil() as usize + 6;
    let (mut largest, mut rms) = (0.0_f64, 0.0_f64);
    for direction in directions() {
        let eye = sphere.center + direction * distance;
        let [a, b] = [original, level].map(|mesh| draw(mesh, eye, sphere.center, pixel, side));
        largest = largest
            .max(displacement(&a, &b, 4.0))
            .max(displacement(&b, &a, 4.0));
        let sum: f64 = a
            .luma
            .iter()
            .zip(&b.luma)
            .map(|(a, b)| (a - b) * (a - b))
            .sum();
        rms = rms.max(sqrt(sum) / f64::from(height));
    }
    [largest, rms]
}

const HEIGHT: u32 = 120;

fn torus_chain(screen: Screen) -> (Mesh, Chain) {
    let mesh = lodmark::mesh::canonical(&generate::torus(1.0, 0.4, 24, 12)).mesh;
    let levels = Levels::targets([200, 80].map(Target::triangles));
    let levels = levels.screen(screen).judged(32, 1_000);
    let found = chain(&mesh, &Options::memoryless(Target::ratio(1.0)), &levels).expect("levels");
    (mesh, found)
}

#[test]
fn silhouettes_keep_to_the_accepted_pixels_from_the_switch_distance_on_and_not_much_nearer() {
    let screen = Screen::new(HEIGHT, 60.0).accept(1.0, 255.0);
    let (mesh, found) = torus_chain(screen);
    for level in &found.levels[1..] {
        let switch = level.report.switch_distance.expect("shown");
        assert!(switch > 2.01 * found.radius, "the torus tests nothing");
        // Samples of both judges are up to half a pixel wide.
        let at = |share: f64| seen(&mesh, &level.mesh, share * switch, HEIGHT)[0];
        let found = [1.5, 1.0, 0.8].map(at);
        assert!(
            found[0] <= 1.5 && found[1] <= 1.5 && found[2] > 1.0,
            "{found:?}"
        );
    }
}

#[test]
fn luma_keeps_to_the_accepted_levels_from_the_switch_distance_on_and_not_much_nearer() {
    let screen = Screen::new(HEIGHT, 60.0).accept(1e9, 4.0);
    let (mesh, found) = torus_chain(screen);
    for level in &found.levels[1..] {
        let report = &level.report;
        let switch = report.switch_distance.expect("shown");
        assert!(switch > 2.01 * found.radius, "the torus tests nothing");
        let at = |share: f64| seen(&mesh, &level.mesh, share * switch, HEIGHT)[1];
        let own = report.luma_rms.expect("seen");
        let found = [1.5, 1.0, 0.8].map(at);
        // Neither judge sees what lies between its samples.
        assert!(
            own <= 4.0 && (found[1] / own - 1.0).abs() < 0.2,
            "{own} {found:?}"
        );
        assert!(found[0] <= 4.0 && found[2] > 4.0, "{found:?}");
    }
}

#[test]
fn shares_of_the_screen_follow_from_the_distance_as_engines_have_it() {
    let (_, found) = torus_chain(Screen::new(HEIGHT, 60.0));
    for level in &found.levels[1..] {
        let switch = level.report.switch_distance.expect("shown");
        let shares = level.report.shares.expect("seen");
        let height = 2.0 * found.radius / (2.0 * switch * (1.0 / sqrt(3.0)));
        assert!((shares.screen_height / height - 1.0).abs() < 1e-12);
        assert!((shares.screen_diameter / height - 1.0).abs() < 1e-12);
        let disc = std::f64::consts::PI * (0.25 * height * height) / (16.0 / 9.0);
        assert!((shares.coverage / disc - 1.0).abs() < 1e-12);
    }
    let first = &found.levels[0].report;
    assert!(first.shares.is_none() && first.switch_distance == Some(0.0));
}

#[test]
fn nothing_is_accepted_from_anywhere_where_no_difference_is() {
    let (_, found) = torus_chain(Screen::new(HEIGHT, 60.0).accept(0.0, 0.0));
    for level in &found.levels[1..] {
        let far = level.report.switch_distance;
        // Where the torus is a pixel, chance decides whether anything differs.
        assert!(far.is_none_or(|far| far > 50.0 * found.radius), "{far:?}");
    }
}

#[test]
fn a_proved_distance_is_no_nearer_than_what_silhouettes_are_seen_to_need() {
    let mesh = lodmark::mesh::canonical(&generate::icosphere(2)).mesh;
    let screen = Screen::new(HEIGHT, 60.0).accept(1.0, 255.0);
    let levels = Levels::targets([Target::triangles(100)]);
    let levels = levels.screen(screen).judged(32, 1_000).certify();
    let found = chain(&mesh, &Options::memoryless(Target::ratio(1.0)), &levels).expect("levels");
    let level = &found.levels[1];
    let proved = level.report.certified_distance.expect("proved");
    let measured = level.report.switch_distance.expect("shown");
    assert!(
        proved >= 0.97 * measured && proved < 4.0 * measured,
        "{proved} {measured}"
    );
    // By points: what is farthest from the other surface, seen from there, is within a pixel.
    let faces = crate::support::faces(&level.mesh);
    let farthest = mesh.positions().iter().map(|&p| {
        let nearest = faces.iter().map(|&face| distance(p, face));
        nearest.fold(f64::INFINITY, f64::min)
    });
    let farthest = farthest.fold(0.0, f64::max);
    let pixel = 2.0 * tan(30.0_f64.to_radians()) / f64::from(HEIGHT);
    assert!(farthest / (proved - found.radius) <= pixel);
    assert!(found.levels[0].report.certified_distance.is_none());
}
