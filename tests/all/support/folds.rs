//! A judge of folds and turned faces that shares no code with `metric::folds`, which drives the repairs that it judges.
//!
//! Every face is held against every face of the reference. Folds are told by where the third corners of two faces lie
//! beside their edge, not by normals.

use std::collections::BTreeMap;

use glam::DVec3;
use lodmark::mesh::Mesh;

use super::geometry::{distance, faces};

/// Folded edges away from those of the reference, and faces around whose centroid all of the reference looks the other
/// way.
pub(crate) fn faults(reference: &Mesh, mesh: &Mesh) -> [usize; 2] {
    let points = || {
        reference
            .triangles()
            .iter()
            .flatten()
            .map(|&v| reference.positions()[v as usize])
    };
    let low = points().fold(DVec3::INFINITY, DVec3::min);
    let reach = 0.01 * (points().fold(DVec3::NEG_INFINITY, DVec3::max) - low).length();
    let known = folded_edges(reference);
    let is_new = |&[a, b]: &[DVec3; 2]| {
        let middle = (a + b) / 2.0;
        known
            .iter()
            .all(|&[c, d]| distance(middle, [c, d, d]) > reach)
    };
    let folded = folded_edges(mesh).into_iter().filter(is_new).count();
    [folded, turned_faces(reference, mesh, reach)]
}

/// Edges of two faces that lie on each other, up to some 25 degrees.
fn folded_edges(mesh: &Mesh) -> Vec<[DVec3; 2]> {
    let mut wings: BTreeMap<[u32; 2], Vec<u32>> = BTreeMap::new();
    for &[a, b, c] in mesh.triangles() {
        for [v, w, opposite] in [[a, b, c], [b, c, a], [c, a, b]] {
            wings
                .entry([v.min(w), v.max(w)])
                .or_default()
                .push(opposite);
        }
    }
    let at = |v: u32| mesh.positions()[v as usize];
    let is_folded = |[v, w]: [u32; 2], thirds: &[u32]| {
        let &[c, d] = thirds else { return false };
        let along = (at(w) - at(v)).normalize_or_zero();
        let wing = |p: u32| (at(p) - at(v)).reject_from_normalized(along);
        let (c, d) = (wing(c), wing(d));
        c.dot(d) > 0.9 * c.length() * d.length()
    };
    let found = wings
        .into_iter()
        .filter(|(edge, thirds)| is_folded(*edge, thirds));
    found.map(|(edge, _)| edge.map(at)).collect()
}

fn turned_faces(reference: &Mesh, mesh: &Mesh, reach: f64) -> usize {
    let normal = |[a, b, c]: [DVec3; 3]| (b - a).cross(c - a);
    // Balls spare most distances; they leave no face out.
    let balls: Vec<(DVec3, f64, [DVec3; 3])> = faces(reference)
        .into_iter()
        .map(|f| {
            let center = (f[0] + f[1] + f[2]) / 3.0;
            (
                center,
                f.map(|p| p.distance(center))
                    .into_iter()
                    .fold(0.0, f64::max),
                f,
            )
        })
        .collect();
    let is_turned = |&&face: &&[DVec3; 3]| {
        let centroid = (face[0] + face[1] + face[2]) / 3.0;
        let within = |most: f64| {
            let near = move |(center, radius, _): &&(DVec3, f64, _)| {
                center.distance(centroid) - radius <= most
            };
            balls
                .iter()
                .filter(near)
                .map(|(.., f)| (distance(centroid, *f), *f))
                .filter(move |(d, _)| *d <= most)
        };
        let mut most = reach;
        while within(most).next().is_none() {
            most *= 2.0;
        }
        let nearest = within(most).map(|(d, _)| d).fold(f64::INFINITY, f64::min);
        normal(face) != DVec3::ZERO
            && within(reach.max(nearest * 1.000_001))
                .all(|(_, f)| normal(f).dot(normal(face)) <= 0.0)
    };
    faces(mesh).iter().filter(is_turned).count()
}
