//! The default scene: which meshes it shows, how often, and where the largest instance of each stands.

use std::collections::BTreeSet;

use glam::{DAffine3, DMat3, DMat4, DQuat, DVec3};

use super::{
    accessor::Elements,
    buffers::Views,
    document::{Document, Instancing, Node, named},
    placed, wrong,
};
use crate::Result;

/// The placement by which the default scene shows a mesh, and its count.
#[derive(Clone, Debug, Default)]
pub(super) struct Shown {
    /// The placement of its largest instance, by volume, the first of several; `None` where none can be inverted.
    pub placement: Option<DAffine3>,
    /// Number of instances.
    pub instances: usize,
    /// Whether that instance has a skin, and stands as its first joint binds it.
    pub skinned: bool,
}

/// The instances of every mesh of the document in its default scene, which is the first where it names none; without
/// scenes all nodes are shown.
///
/// # Errors
/// [`Error::Input`](crate::Error::Input) where nodes are no forest, or something does not exist.
pub(super) fn shown(document: &Document, views: &Views<'_>) -> Result<Vec<Shown>> {
    let parents = parents(document)?;
    let roots: Vec<usize> = (0..parents.len())
        .filter(|&n| parents[n].is_none())
        .collect();
    let (worlds, order) = worlds(document, &roots);
    if order.len() < parents.len() {
        let node = (0..parents.len())
            .find(|n| !order.contains(n))
            .unwrap_or_default();
        return Err(wrong(format!(
            "nodes[{node}] is its own ancestor, or below one that is; expected trees"
        )));
    }
    let first = document
        .scene
        .or((!document.scenes.is_empty()).then_some(0));
    let starts = match first {
        Some(scene) => {
            let from = || "the section `scene`".into();
            &named(&document.scenes, scene, "scenes", from)?.nodes
        }
        None => &roots,
    };
    let mut found = vec![Shown::default(); document.meshes.len()];
    let mut seen = vec![false; document.nodes.len()];
    for &start in starts {
        named(&document.nodes, start, "nodes", || {
            "the default scene".into()
        })?;
        let mut waiting = vec![start];
        while let Some(index) = waiting.pop() {
            if std::mem::replace(&mut seen[index], true) {
                continue;
            }
            let node = &document.nodes[index];
            waiting.extend(node.children.iter().rev());
            let Some(mesh) = node.mesh else { continue };
            named(&document.meshes, mesh, "meshes", || {
                format!("nodes[{index}]")
            })?;
            for placement in placements(document, views, &worlds, index)? {
                consider(&mut found[mesh], placement, node.skin.is_some());
            }
        }
    }
    Ok(found)
}

/// Counts an instance, and keeps it where it is the largest yet.
fn consider(shown: &mut Shown, placement: DAffine3, skinned: bool) {
    shown.instances += 1;
    let volume = |p: DAffine3| p.matrix3.determinant().abs();
    let can_be_inverted = placement.is_finite() && placement.inverse().is_finite();
    let is_larger = shown
        .placement
        .is_none_or(|known| volume(placement) > volume(known));
    if can_be_inverted && is_larger {
        (shown.placement, shown.skinned) = (Some(placement), skinned);
    }
}

/// The parent of every node.
fn parents(document: &Document) -> Result<Vec<Option<usize>>> {
    let mut parents = vec![None; document.nodes.len()];
    for (i, node) in document.nodes.iter().enumerate() {
        for &child in &node.children {
            named(&document.nodes, child, "nodes", || format!("nodes[{i}]"))?;
            if let Some(other) = parents[child].replace(i) {
                return Err(wrong(format!(
                    "nodes[{child}] is a child of nodes[{other}] and of nodes[{i}]; expected one parent"
                )));
            }
        }
    }
    Ok(parents)
}

/// The transform of every node that can be reached from the roots, and these nodes.
fn worlds(document: &Document, roots: &[usize]) -> (Vec<DAffine3>, BTreeSet<usize>) {
    let mut worlds = vec![DAffine3::IDENTITY; document.nodes.len()];
    let mut reached = BTreeSet::new();
    let mut waiting: Vec<(usize, DAffine3)> = roots
        .iter()
        .map(|&root| (root, DAffine3::IDENTITY))
        .collect();
    while let Some((index, parent)) = waiting.pop() {
        let node = &document.nodes[index];
        let world = parent * local(node);
        worlds[index] = world;
        reached.insert(index);
        waiting.extend(node.children.iter().map(|&child| (child, world)));
    }
    (worlds, reached)
}

/// The transform of a node in its parent.
fn local(node: &Node) -> DAffine3 {
    if let Some(matrix) = &node.matrix {
        return DAffine3::from_mat4(DMat4::from_cols_array(matrix));
    }
    transform(
        node.translation.unwrap_or_default(),
        node.rotation.unwrap_or([0.0, 0.0, 0.0, 1.0]),
        node.scale.unwrap_or([1.0; 3]),
    )
}

fn transform(translation: [f64; 3], rotation: [f64; 4], scale: [f64; 3]) -> DAffine3 {
    let turn = DMat3::from_quat(DQuat::from_array(rotation));
    let scale = DMat3::from_diagonal(DVec3::from_array(scale));
    DAffine3::from_mat3_translation(turn * scale, DVec3::from_array(translation))
}

/// The placements of the mesh of a node.
fn placements(
    document: &Document,
    views: &Views<'_>,
    worlds: &[DAffine3],
    index: usize,
) -> Result<Vec<DAffine3>> {
    let node = &document.nodes[index];
    let world = match node.skin {
        Some(skin) => bind(document, views, worlds, skin)
            .map_err(|error| placed(error, &format!("skins[{skin}]")))?,
        None => worlds[index],
    };
    match &node.extensions.instancing {
        Some(instancing) => instances(document, views, instancing, world)
            .map_err(|error| placed(error, &format!("nodes[{index}], EXT_mesh_gpu_instancing"))),
        None => Ok(vec![world]),
    }
}

/// From the coordinates of a mesh with a skin to the scene, as the first joint has it: the transform of the node of the
/// mesh does not count.
fn bind(
    document: &Document,
    views: &Views<'_>,
    worlds: &[DAffine3],
    skin: usize,
) -> Result<DAffine3> {
    let skin = named(&document.skins, skin, "skins", || "a node".into())?;
    let Some(&joint) = skin.joints.first() else {
        return Err(wrong("there are no joints; expected at least one"));
    };
    let world = *named(worlds, joint, "nodes", || "the first joint".into())?;
    let Some(matrices) = skin.inverse_bind_matrices else {
        return Ok(world);
    };
    let elements = Elements::open(document, views, matrices)?;
    if elements.width() != 16 || elements.count == 0 {
        return Err(wrong(format!(
            "accessors[{matrices}] has no inverse bind matrix of the first joint; expected elements of type MAT4"
        )));
    }
    let mut matrix = [0.0; 16];
    elements.read(0, &mut matrix);
    Ok(world * DAffine3::from_mat4(DMat4::from_cols_array(&matrix)))
}

/// The placements of the instances that accessors hold.
fn instances(
    document: &Document,
    views: &Views<'_>,
    instancing: &Instancing,
    world: DAffine3,
) -> Result<Vec<DAffine3>> {
    let open = |name: &str, width: usize| {
        let Some(&accessor) = instancing.attributes.get(name) else {
            return Ok(None);
        };
        let elements = Elements::open(document, views, accessor)?;
        if elements.width() == width {
            Ok(Some(elements))
        } else {
            Err(wrong(format!(
                "accessors[{accessor}] has {} components; expected {width} for {name}",
                elements.width()
            )))
        }
    };
    let parts = [
        open("TRANSLATION", 3)?,
        open("ROTATION", 4)?,
        open("SCALE", 3)?,
    ];
    let mut counts = parts.iter().flatten().map(|elements| elements.count);
    let Some(count) = counts.next() else {
        return Ok(vec![world]);
    };
    if let Some(other) = counts.find(|&other| other != count) {
        return Err(wrong(format!(
            "accessors of {count} and of {other} instances; expected equal numbers"
        )));
    }
    views.spend(count)?;
    let mut found = Vec::with_capacity(count);
    for i in 0..count {
        let (mut translation, mut rotation, mut scale) = ([0.0; 3], [0.0, 0.0, 0.0, 1.0], [1.0; 3]);
        let into: [&mut [f64]; 3] = [&mut translation, &mut rotation, &mut scale];
        for (part, into) in parts.iter().zip(into) {
            if let Some(elements) = part {
                elements.read(i, into);
            }
        }
        found.push(world * transform(translation, rotation, scale));
    }
    Ok(found)
}
