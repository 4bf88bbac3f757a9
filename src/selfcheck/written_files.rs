//! Cases of meshes and files: generated meshes, meshes in every encoding, matrices of views, view files.

use super::{
    Collector,
    fixtures::{colored, sphere_of},
};
use crate::{
    Result,
    io::{self, Encoding},
    mesh::generate,
    view::{self, Projection, ViewSet, ViewsName},
};

const ENCODINGS: [(&str, Encoding); 6] = [
    ("obj", Encoding::Obj),
    ("ply-text", Encoding::PlyAscii),
    ("ply-little-endian", Encoding::PlyLittleEndian),
    ("ply-big-endian", Encoding::PlyBigEndian),
    ("stl-text", Encoding::StlAscii),
    ("stl-binary", Encoding::StlBinary),
];

/// The content of every generated mesh.
pub(super) fn generators(collector: &mut Collector) -> Result<()> {
    for (name, make) in generate::NAMED {
        collector.mesh(name, &make());
    }
    Ok(())
}

/// Seams, materials, colours and nothing of it, in every encoding.
pub(super) fn meshes(collector: &mut Collector) -> Result<()> {
    let meshes = [
        ("cube", generate::cube()),
        ("textured-torus", generate::textured_torus(12, 6)),
        ("colored-torus", colored(&generate::torus(1.0, 0.4, 12, 6))),
        ("probe", generate::probe()),
    ];
    for (name, mesh) in &meshes {
        for (encoding_name, encoding) in ENCODINGS {
            let (bytes, _) = io::encode(mesh, encoding)?;
            collector.bytes(&format!("{name}/{encoding_name}"), &bytes);
            let back = io::read_bytes(encoding.format(), &bytes, "-")?;
            collector.mesh(&format!("{name}/{encoding_name}/read"), &back.mesh);
        }
    }
    Ok(())
}

/// The bits of every matrix of every named set.
pub(super) fn views(collector: &mut Collector) -> Result<()> {
    let sphere = sphere_of(&generate::grid(8, 8, generate::Height::Polynomial))?;
    let sets = [
        ("dodecahedron", ViewsName::Dodecahedron),
        ("rhombicuboctahedron", ViewsName::Rhombicuboctahedron),
        ("octahedron-0", ViewsName::Octahedron(0)),
        ("octahedron-1", ViewsName::Octahedron(1)),
        ("octahedron-2", ViewsName::Octahedron(2)),
        ("octahedron-3", ViewsName::Octahedron(3)),
    ];
    for (name, set) in &sets {
        for (projection_name, projection) in [
            ("perspective", Projection::Perspective),
            ("orthographic", Projection::Orthographic),
        ] {
            let set = view::resolve(set, &sphere, [96, 64], projection)?;
            let name = format!("{name}/{projection_name}");
            collector.bytes(&name, &matrices(&set));
        }
    }
    let set = ViewSet::costs(&sphere)?.with_interior_views(4)?;
    let text = view::file::to_json(&set, &[])?;
    collector.bytes("file", text.as_bytes());
    let back = view::file::from_json(&text, "-")?;
    collector.bytes("file/read", &matrices(&back));
    Ok(())
}

fn matrices(set: &ViewSet) -> Vec<u8> {
    let numbers = set.views.iter().flat_map(|v| v.matrix).flatten();
    numbers.flat_map(f64::to_le_bytes).collect()
}
