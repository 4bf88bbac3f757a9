//! Targets are met by default: what gives way, in which order, and no more than needed.

use std::sync::Arc;

use glam::{DAffine3, DVec3};
use lodmark::{
    collapse::Concession,
    mesh::{Asset, AssetPart, Attributes, ChannelKind, Mesh, MeshParts, canonical, generate, weld},
    simplify::{self, MethodOptions, Options, Outcome, Replay, Stop, Target, Topology},
};

use crate::support::Random;

fn run(
    mesh: &Mesh,
    method: impl Into<MethodOptions>,
    triangles: u64,
    topology: Topology,
) -> Outcome {
    let options = Options::new(method, Target::Triangles(triangles)).topology(topology);
    simplify::simplify(mesh, &options).expect("runs")
}

fn memoryless(mesh: &Mesh, triangles: u64, topology: Topology) -> Outcome {
    run(
        mesh,
        simplify::memoryless::MemorylessOptions::default(),
        triangles,
        topology,
    )
}

fn concessions(outcome: &Outcome) -> Vec<Concession> {
    outcome.phases.iter().filter_map(|p| p.concession).collect()
}

/// A torus whose texture jumps at every third edge or so: each triangle has coordinates of its own in one of three charts.
fn patchwork() -> Mesh {
    let mut parts = generate::torus(1.0, 0.4, 40, 24).into_parts();
    let mut random = Random::new(7, 1);
    let (mut values, mut corners) = (Vec::new(), Vec::new());
    for corner in &parts.triangles {
        let chart = 10.0 * (random.next() % 3) as f64;
        let first = (values.len() / 2) as u32;
        for &v in corner {
            let p = parts.positions[v as usize];
            values.extend([chart + p.x, p.y]);
        }
        corners.push([first, first + 1, first + 2]);
    }
    parts.attributes = Attributes::new(&[ChannelKind::TexCoord(0)], values, corners).expect("fits");
    canonical(&weld(Mesh::new(parts).expect("valid")).mesh).mesh
}

/// Square sheets of `side * side * 2` triangles in rows of 25, in three layers where `layers` says so: the one in the
/// middle is not seen.
fn sheets(count: usize, side: usize, center: impl Fn(usize) -> DVec3) -> Mesh {
    let mut parts = MeshParts::default();
    for sheet in 0..count {
        let first = parts.positions.len() as u32;
        let across = side as u32 + 1;
        for i in 0..across * across {
            let (x, y) = (f64::from(i % across), f64::from(i / across));
            // Hardly bent, so that no two faces lie in one plane.
            let z = 0.01 * (x * x - y * y);
            parts
                .positions
                .push(center(sheet) + DVec3::new(x, y, z) / side as f64 * 0.8);
        }
        for i in
            (0..across * across).filter(|i| i % across < side as u32 && i / across < side as u32)
        {
            let v = first + i;
            parts.triangles.push([v, v + 1, v + across]);
            parts.triangles.push([v + 1, v + across + 1, v + across]);
        }
    }
    canonical(&Mesh::new(parts).expect("valid")).mesh
}

fn heap(count: usize) -> Mesh {
    let mut random = Random::new(3, 1);
    let places: Vec<DVec3> = (0..count)
        .map(|_| DVec3::from_array([0, 1, 2].map(|_| (random.next() % 1000) as f64 / 25.0)))
        .collect();
    sheets(count, 4, |sheet| places[sheet])
}

#[test]
fn an_object_with_seams_in_every_third_edge_meets_its_target_and_seams_alone_give_way() {
    let mesh = patchwork();
    let target = mesh.triangles().len() as u64 / 20;
    let kept = memoryless(&mesh, target, Topology::Preserve);
    assert!(
        kept.mesh.triangles().len() as u64 > 4 * target,
        "seams stop it"
    );
    assert!(concessions(&kept).is_empty());
    let met = memoryless(&mesh, target, Topology::Auto);
    let count = met.mesh.triangles().len() as u64;
    assert!((target - 2..=target).contains(&count), "{count}");
    assert_eq!(concessions(&met), [Concession::Seams]);
    assert_eq!(met.stop, Stop::TargetReached);
}

#[test]
fn what_a_target_does_not_need_does_not_give_way() {
    let mesh = patchwork();
    let reached = memoryless(&mesh, 1, Topology::Preserve)
        .mesh
        .triangles()
        .len() as u64;
    let kept = memoryless(&mesh, reached, Topology::Preserve);
    let auto = memoryless(&mesh, reached, Topology::Auto);
    assert_eq!(auto.mesh, kept.mesh);
    assert!(concessions(&auto).is_empty());
}

#[test]
fn a_heap_of_500_loose_sheets_meets_five_percent_and_every_sheet_stays() {
    let mesh = heap(500);
    let target = mesh.triangles().len() as u64 / 20;
    let met = memoryless(&mesh, target, Topology::Auto);
    let count = met.mesh.triangles().len() as u64;
    assert!(
        (target - 2..=target).contains(&count),
        "{count} of {target}"
    );
    let least = memoryless(&mesh, 500, Topology::Auto);
    assert_eq!(least.mesh.triangles().len(), 500);
}

#[test]
fn pieces_that_are_seen_go_before_the_target_unless_they_may_be_dropped() {
    let mesh = sheets(60, 2, |sheet| {
        DVec3::new((sheet % 10) as f64, (sheet / 10) as f64, 0.0)
    });
    let outcome = memoryless(&mesh, 12, Topology::Auto);
    assert_eq!(outcome.mesh.triangles().len(), 60);
    assert_eq!(outcome.stop, Stop::VisiblePieces { pieces: 60 });
    let own = simplify::memoryless::MemorylessOptions::default();
    let mut options = Options::new(own, Target::Triangles(12));
    options.rules.drop_pieces = true;
    let outcome = simplify::simplify(&mesh, &options).expect("runs");
    assert_eq!(outcome.mesh.triangles().len(), 12);
}

#[test]
fn pieces_that_no_view_sees_vanish_before_a_run_falls_short() {
    // A closed box around 40 sheets.
    let inside = sheets(40, 1, |sheet| {
        DVec3::new((sheet % 8) as f64, (sheet / 8) as f64, 3.0)
    })
    .into_parts();
    let mut parts = generate::cube().into_parts();
    parts.attributes = Attributes::default();
    parts.materials = lodmark::mesh::Materials::default();
    for p in &mut parts.positions {
        *p = *p * 10.0 + DVec3::splat(5.0);
    }
    let first = parts.positions.len() as u32;
    parts.positions.extend(inside.positions);
    parts
        .triangles
        .extend(inside.triangles.iter().map(|t| t.map(|v| v + first)));
    let mesh = canonical(&Mesh::new(parts).expect("valid")).mesh;
    let outcome = memoryless(&mesh, 20, Topology::Auto);
    assert_eq!(outcome.mesh.triangles().len(), 20);
    assert!(concessions(&outcome).contains(&Concession::UnseenPieces));
    assert!(
        outcome.mesh.positions().iter().any(|p| p.x < 0.0),
        "the box stays"
    );
}

#[test]
fn every_method_meets_a_target_that_seams_forbid_and_its_history_leads_there() {
    let mesh = patchwork();
    let target = mesh.triangles().len() as u64 / 10;
    let methods: [MethodOptions; 3] = [
        simplify::quadric::QuadricOptions::default().into(),
        simplify::image::Preset::Fast.options().into(),
        simplify::visibility::VisibilityOptions::default().into(),
    ];
    for method in methods {
        let outcome = run(&mesh, method, target, Topology::Auto);
        let count = outcome.mesh.triangles().len();
        assert!((target - 2..=target).contains(&(count as u64)), "{count}");
        let mut replay = Replay::new(&mesh, &outcome.history).expect("its mesh");
        replay.seek(count).expect("replays");
        assert_eq!(replay.live().to_mesh().expect("a mesh"), outcome.mesh);
    }
}

#[test]
fn a_run_by_pictures_breaks_seams_from_the_start_near_where_they_would_stop_it() {
    let mesh = patchwork();
    let floor = memoryless(&mesh, 1, Topology::Preserve).mesh;
    let target = floor.triangles().len() as u64 + 1;
    assert!(concessions(&memoryless(&mesh, target, Topology::Auto)).is_empty());
    let options = Options::image(Target::Triangles(target))
        .preset(simplify::image::Preset::Fast)
        .size(64);
    let outcome = simplify::simplify(&mesh, &options).expect("runs");
    let first = outcome.phases.first().expect("a phase");
    assert_eq!(first.concession, Some(Concession::Seams));
    assert!(first.counters.seams_broken > 0);
}

/// A ball and a plane side by side, as the two meshes of a document.
fn ball_and_plane() -> Mesh {
    let mut parts = generate::icosphere(3).into_parts();
    let plane = generate::grid(20, 20, generate::Height::Flat).into_parts();
    let ball = parts.triangles.len();
    let first = parts.positions.len() as u32;
    let aside = |p: DVec3| p + DVec3::new(4.0, 0.0, 0.0);
    parts
        .positions
        .extend(plane.positions.into_iter().map(aside));
    let moved = plane.triangles.into_iter().map(|t| t.map(|v| v + first));
    parts.triangles.extend(moved);
    let of = |t: usize| u32::from(t >= ball);
    parts.materials.of_triangle = (0..parts.triangles.len()).map(of).collect();
    parts.materials.names = vec!["ball".into(), "plane".into()];
    let part = |mesh: usize, name: &str| AssetPart {
        name: name.into(),
        mesh,
        primitive: 0,
        placement: DAffine3::IDENTITY,
        instances: 1,
    };
    parts.materials.asset = Some(Arc::new(Asset {
        parts: vec![part(0, "ball"), part(1, "plane")],
        ..Asset::default()
    }));
    canonical(&Mesh::new(parts).expect("valid")).mesh
}

#[test]
fn every_mesh_of_a_document_gets_its_own_share_where_that_is_asked_for() {
    let mesh = ball_and_plane();
    let counts = |mesh: &Mesh| {
        let name = |t: usize| mesh.materials().names[mesh.materials().of(t) as usize].as_str();
        let all = 0..mesh.triangles().len();
        ["ball", "plane"].map(|part| all.clone().filter(|&t| name(t) == part).count())
    };
    let [ball, plane] = counts(&mesh);
    let quarter = |count: usize| count.div_ceil(4);
    for options in [
        Options::memoryless(Target::Ratio(0.25)),
        Options::quadric(Target::Ratio(0.25)),
        Options::image(Target::Ratio(0.25)).preset(simplify::image::Preset::Fast),
    ] {
        let divided = simplify::simplify(&mesh, &options).expect("runs");
        assert!(
            counts(&divided.mesh)[1] < quarter(plane) / 2,
            "a plane needs few"
        );
        let own = simplify::simplify(&mesh, &options.per_mesh()).expect("runs");
        assert_eq!(own.stop, Stop::TargetReached);
        for (count, asked) in counts(&own.mesh)
            .into_iter()
            .zip([ball, plane].map(quarter))
        {
            assert!((asked - 2..=asked).contains(&count), "{count} of {asked}");
        }
        assert!(concessions(&own).is_empty());
    }
}
