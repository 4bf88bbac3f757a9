//! Memoryless placement and cost against the vectors and against brute force.

use glam::DVec3;
use lodmark::{
    collapse::{Anchor, EdgeStar, LiveMesh, Rules, Site},
    mesh::{Mesh, MeshParts},
    num::{Frame, Precision},
    simplify::{
        Options, Stop, Target, Topology,
        memoryless::{ConstraintOrder, MemorylessOptions, Objective, propose},
        simplify,
    },
};
use proptest::prelude::*;

use crate::support::{Random, meshes};

pub(crate) const U: DVec3 = DVec3::new(0.0, 0.0, 0.3);
pub(crate) const W: DVec3 = DVec3::new(1.0, 0.0, 0.1);
const LINK: [DVec3; 8] = [
    DVec3::new(0.5, 0.9, 0.0),
    DVec3::new(-0.4, 0.8, -0.1),
    DVec3::new(-1.0, 0.1, 0.0),
    DVec3::new(-0.5, -0.9, 0.05),
    DVec3::new(0.5, -1.0, 0.0),
    DVec3::new(1.5, -0.8, -0.05),
    DVec3::new(2.0, 0.1, 0.02),
    DVec3::new(1.4, 0.9, 0.0),
];

/// u is 0, w is 1, the link follows.
const INTERIOR: [[u32; 3]; 10] = [
    [0, 2, 3],
    [0, 3, 4],
    [0, 4, 5],
    [0, 5, 6],
    [0, 6, 1],
    [1, 6, 7],
    [1, 7, 8],
    [1, 8, 9],
    [1, 9, 2],
    [0, 1, 2],
];

pub(crate) fn live(positions: Vec<DVec3>, triangles: &[[u32; 3]]) -> LiveMesh {
    let mesh = Mesh::new(MeshParts {
        positions,
        triangles: triangles.to_vec(),
        precision: Precision::F64,
        ..MeshParts::default()
    });
    LiveMesh::new(&mesh.expect("valid"), Frame::default())
}

pub(crate) fn interior(flat: bool) -> LiveMesh {
    let positions = [U, W].into_iter().chain(LINK);
    let flatten = |p: DVec3| if flat { p.with_z(0.0) } else { p };
    live(positions.map(flatten).collect(), &INTERIOR)
}

fn boundary() -> LiveMesh {
    let positions = vec![
        DVec3::new(0.0, 0.0, 0.1),
        DVec3::new(1.0, 0.1, 0.0),
        DVec3::new(-1.0, -0.2, 0.0),
        DVec3::new(-0.5, 1.0, 0.2),
        DVec3::new(0.5, 1.1, 0.3),
        DVec3::new(1.6, 0.9, 0.1),
        DVec3::new(2.0, -0.3, 0.1),
    ];
    let triangles = [[0, 3, 2], [0, 4, 3], [0, 1, 4], [1, 5, 4], [1, 6, 5]];
    live(positions, &triangles)
}

pub(crate) fn star(live: &LiveMesh, u: u32, w: u32) -> EdgeStar {
    let mut star = EdgeStar::default();
    assert!(star.gather(live, live.find_edge(u, w).expect("an edge")));
    star
}

fn near(found: f64, expected: f64) {
    let most = 1e-11 * expected.abs().max(1e-2);
    assert!(
        (found - expected).abs() <= most,
        "{found} instead of {expected}"
    );
}

/// Holds the placement of the edge (0, 1), and the errors of volume and boundary and the cost there, to a vector.
fn check(live: &LiveMesh, accepted: [usize; 4], place: [f64; 3], errors: [f64; 3]) {
    let star = star(live, 0, 1);
    let objective = Objective::of(&star, &MemorylessOptions::default());
    let placement = objective.place();
    assert_eq!(placement.accepted, accepted);
    let v = placement.position.expect("determined");
    let found = [
        objective.volume_error(&star, v),
        objective.boundary_error(&star, v),
        objective.cost(&star, v),
    ];
    let found = v.to_array().into_iter().chain(found);
    for (found, expected) in found.zip(place.into_iter().chain(errors)) {
        near(found, expected);
    }
}

#[test]
fn an_interior_edge_is_placed_and_priced_as_the_vector_says() {
    let place = [
        -0.091_260_615_936_019_79,
        -0.016_282_694_211_926_286,
        0.246_114_965_249_384_5,
    ];
    let errors = [
        0.000_999_798_419_301_431_1,
        0.0,
        0.000_499_899_209_650_715_6,
    ];
    check(&interior(false), [0, 1, 3, 3], place, errors);
}

#[test]
fn a_flat_ring_puts_the_vertex_at_the_mean_of_its_link() {
    let place = [0.5, 0.012_500_000_000_000_025, 0.0];
    check(&interior(true), [0, 1, 1, 3], place, [0.0; 3]);
}

#[test]
fn a_boundary_edge_is_placed_and_priced_as_the_vector_says() {
    let place = [
        1.521_758_729_075_865,
        0.115_497_916_717_426_85,
        0.083_615_165_322_482_34,
    ];
    let errors = [
        0.002_808_735_068_766_265,
        0.034_165_109_229_338_61,
        0.018_828_573_241_345_823,
    ];
    check(&boundary(), [2, 3, 3, 3], place, errors);
}

#[test]
fn the_order_of_constraints_matters_at_a_boundary_only() {
    let place = |live: &LiveMesh, lt_order| {
        let options = MemorylessOptions {
            lt_order,
            ..MemorylessOptions::default()
        };
        Objective::of(&star(live, 0, 1), &options).place()
    };
    let both = |live: LiveMesh| {
        [ConstraintOrder::Paper, ConstraintOrder::Cgal].map(|order| place(&live, order))
    };
    let [paper, cgal] = both(interior(false));
    assert_eq!(paper.position, cgal.position);
    let accepted = both(boundary()).map(|placement| placement.accepted[0]);
    assert_eq!(accepted, [1, 2]);
}

/// Six times the signed volume of a tetrahedron, as a determinant of rows.
fn determinant(a: DVec3, b: DVec3, c: DVec3) -> f64 {
    a.x * (b.y * c.z - b.z * c.y) - a.y * (b.x * c.z - b.z * c.x) + a.z * (b.x * c.y - b.y * c.x)
}

fn swept(live: &LiveMesh, star: &EdgeStar, v: DVec3) -> Vec<f64> {
    let volume = |f: &lodmark::collapse::StarFace| {
        let [a, b, c] = live.points(f.id).expect("live");
        determinant(a - v, b - v, c - v) / 6.0
    };
    star.faces.iter().map(volume).collect()
}

proptest! {
    #![proptest_config(crate::support::cases(64))]

    #[test]
    fn placement_keeps_the_volume_and_no_neighbour_on_that_plane_is_better(seed: u64) {
        let mut random = Random(seed);
        let positions = [U, W].into_iter().chain(LINK).map(|p| {
            let mut axis = || (random.unit() - 0.5) * 0.3;
            p + DVec3::new(axis(), axis(), axis())
        });
        let live = live(positions.collect(), &INTERIOR);
        let star = star(&live, 0, 1);
        let objective = Objective::of(&star, &MemorylessOptions::default());
        let placement = objective.place();
        let v = placement.position.expect("determined");
        let volumes = swept(&live, &star, v);
        prop_assert!(volumes.iter().sum::<f64>().abs() < 1e-12);
        let best: f64 = volumes.iter().map(|x| x * x).sum();
        prop_assert!((objective.volume_error(&star, v) - best).abs() < 1e-12);
        prop_assume!(placement.accepted[2] == 3);
        let normal: DVec3 = star.faces.iter().map(|f| {
            let [a, b, c] = live.points(f.id).expect("live");
            (b - a).cross(c - a)
        }).sum();
        for axis in [DVec3::X, DVec3::Y, DVec3::Z] {
            let along = normal.cross(axis).normalize() * 1e-3;
            for v in [v + along, v - along] {
                let there: f64 = swept(&live, &star, v).iter().map(|x| x * x).sum();
                prop_assert!(there >= best * (1.0 - 1e-9));
            }
        }
    }

    #[test]
    fn the_cost_of_a_boundary_is_the_squared_area_it_sweeps(seed: u64) {
        let mut random = Random(seed);
        let live = boundary();
        let star = star(&live, 0, 1);
        let v = DVec3::new(random.unit(), random.unit(), random.unit());
        let edges = [(2, 0), (0, 1), (1, 6)];
        let areas = edges.map(|(s, t)| {
            let (s, t) = (live.position(s) - v, live.position(t) - v);
            s.cross(t).length() * 0.5
        });
        let expected: f64 = areas.iter().map(|a| a * a).sum();
        let objective = Objective::of(&star, &MemorylessOptions::default());
        prop_assert!((objective.boundary_error(&star, v) - expected).abs() < 1e-12);
        let length2 = (live.position(1) - live.position(0)).length_squared();
        let volume: f64 = swept(&live, &star, v).iter().map(|x| x * x).sum();
        let cost = 0.5 * volume + 0.5 * length2 * expected;
        prop_assert!((objective.cost(&star, v) - cost).abs() < 1e-12);
    }
}

#[test]
fn a_proposal_is_judged_at_the_position_the_file_can_store() {
    let positions: Vec<DVec3> = [U, W].into_iter().chain(LINK).collect();
    let mesh = Mesh::from_triangles(positions, INTERIOR.to_vec()).expect("valid");
    let live = LiveMesh::new(&mesh, Frame::for_size(3.0));
    let star = star(&live, 0, 1);
    let options = MemorylessOptions::default();
    let site = Site::new(&live, &star, Rules::default()).expect("legal");
    assert_eq!(site.anchor, Anchor::Free);
    let proposal = propose(&site, &options).expect("placed");
    let p = proposal.position.position();
    let file = live.frame().leave(p);
    assert_eq!(file, Precision::F32.round_vector(file));
    let cost = Objective::of(&star, &options).cost(&star, p);
    assert_eq!(proposal.secondary.to_bits(), cost.to_bits());
}

#[test]
fn a_scaled_mesh_is_simplified_to_the_scaled_result() {
    let mesh = meshes::torus(20, 12, 9);
    let options = Options::memoryless(Target::Ratio(0.3));
    let plain = simplify(&mesh, &options).expect("valid").mesh;
    for exponent in [-90, 60] {
        let frame = Frame { exponent };
        let mut parts = mesh.clone().into_parts();
        for p in &mut parts.positions {
            *p = frame.leave(*p);
        }
        let scaled = Mesh::new(parts).expect("valid");
        let found = simplify(&scaled, &options).expect("valid").mesh;
        let expected: Vec<DVec3> = plain.positions().iter().map(|&p| frame.leave(p)).collect();
        assert_eq!(found.positions(), expected);
        assert_eq!(found.triangles(), plain.triangles());
    }
}

#[test]
fn targets_are_reached_refused_or_explained() {
    let mesh = meshes::torus(10, 8, 1);
    let run = |target| simplify(&mesh, &Options::memoryless(target));
    let half = run(Target::Ratio(0.5)).expect("valid");
    assert_eq!(half.mesh.triangles().len(), 80);
    assert_eq!(half.stop, Stop::TargetReached);
    let copy = run(Target::Triangles(1000)).expect("valid");
    assert_eq!(copy.mesh, mesh);
    assert_eq!(copy.stop, Stop::TargetAboveInput);
    let kept = Options::memoryless(Target::Triangles(1)).topology(Topology::Preserve);
    let least = simplify(&mesh, &kept).expect("valid");
    let Stop::NoLegalCollapse { refusals } = least.stop else {
        panic!("a torus became one triangle");
    };
    assert!(refusals.total() > 0 && least.mesh.triangles().len() >= 14);
    let ratios = [0.0, 1.5, f64::NAN].map(Target::Ratio);
    for wrong in ratios.into_iter().chain([Target::Triangles(0)]) {
        assert_eq!(run(wrong).expect_err("out of range").exit_code(), 2);
    }
}
