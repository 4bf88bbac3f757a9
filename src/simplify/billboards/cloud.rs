//! The cloud: planes become quads, and what finds no plane stays as it is.

use glam::{DVec2, DVec3};

use super::{
    BillboardOptions, Displacement, Limit, Quad,
    bearing::Bearing,
    displacement::{displacement, eyes},
    flat::{self, Level},
    plan::{Plan, PlanFace},
    quad::{project, texels},
    select::{Slab, select},
    tree::PlanTree,
    viewers_in_plan::PlanCell,
};
use crate::{
    Progress, Result,
    bound::{planar::Interval, view_cell::ViewCell},
    mesh::Mesh,
    num::{Each, math},
    parallel,
};

/// The resolution of textures where no angle asks for one.
const DEFAULT_TEXEL: f64 = 0.002;

/// A scene on quads.
#[derive(Clone, Debug, PartialEq)]
pub struct Cloud {
    /// The quads: vertical ones in the order in which they were chosen, then single walls, then horizontal ones.
    pub quads: Vec<Quad>,
    /// Triangles that stay as they are, ascending: those that viewers stand on, under or in, and slanted ones that
    /// share a plane with nothing.
    pub kept: Vec<u32>,
    /// The largest displacements of vertices.
    pub displacement: Displacement,
}

/// The scene, cell and options that all quads have in common.
struct Scene<'a> {
    mesh: &'a Mesh,
    cell: &'a ViewCell,
    plan_cell: PlanCell,
    options: &'a BillboardOptions,
}

/// Replaces a scene by quads for the viewers of `cell`. Planes, quads and textures depend on the mesh, the cell and the
/// options alone. O(directions · faces · log faces), and some more per quad.
///
/// # Errors
/// [`Error::Usage`](crate::Error::Usage) where an option is out of range or the cell, seen from above, covers the
/// ground; [`Error::Interrupted`](crate::Error::Interrupted).
pub fn billboards(
    mesh: &Mesh,
    cell: &ViewCell,
    options: &BillboardOptions,
    progress: &dyn Progress,
) -> Result<Cloud> {
    options.check()?;
    let scene = Scene {
        mesh,
        cell,
        plan_cell: PlanCell::new(cell, options.up)?,
        options,
    };
    let plan = Plan::new(mesh, &scene.plan_cell, options.up);
    let (flat, faces): (Vec<PlanFace>, Vec<PlanFace>) = plan
        .faces
        .into_iter()
        .partition(|face| !face.is_wall() && face.area == DVec2::ZERO);
    let mut kept = plan.touched;
    let tree = PlanTree::new(&faces);
    let (mut slabs, alone) = select(&faces, &tree, &scene.plan_cell, options, progress)?;
    for number in alone {
        match own_plane(&faces[number as usize]) {
            Some((bearing, rho)) => slabs.push(Slab {
                bearing,
                rho,
                faces: vec![number],
            }),
            None => kept.extend(&faces[number as usize].triangles),
        }
    }
    let mut quads = Vec::new();
    let vertical = parallel::map_slice(&slabs, |slab| scene.vertical(slab, &faces, &tree));
    for (slab, quad) in slabs.iter().zip(vertical) {
        let triangles = |&f: &u32| &faces[f as usize].triangles;
        match quad {
            Some(quad) => quads.push(quad),
            None => kept.extend(slab.faces.iter().flat_map(triangles)),
        }
    }
    quads.extend(scene.horizontal(&flat));
    kept.sort_unstable();
    progress.step("measure displacements", 0, 0)?;
    let eyes = eyes(mesh, cell, options.up);
    let displacements = parallel::map_slice(&quads, |quad| {
        displacement(mesh, quad, &scene.plan_cell, options.up, eyes)
    });
    let (none, all) = (Displacement::default(), displacements.into_iter());
    let displacement = all.fold(none, Displacement::and);
    Ok(Cloud {
        quads,
        kept,
        displacement,
    })
}

/// The vertical plane that a wall stands in.
fn own_plane(face: &PlanFace) -> Option<(Bearing, f64)> {
    let [a, b] = face.segments[0];
    let across = (b - a).perp();
    let length = math::sqrt(across.dot(across));
    let normal = across / length;
    let plane = (Bearing::across(normal), ((a + b) / 2.0).dot(normal));
    (face.is_wall() && length > 0.0).then_some(plane)
}

impl Scene<'_> {
    /// The quad of a vertical plane; `None` where its faces are seen from the edge only.
    fn vertical(&self, slab: &Slab, faces: &[PlanFace], tree: &PlanTree) -> Option<Quad> {
        let up = self.options.up;
        let Bearing { normal, along } = slab.bearing;
        let behind = self.plan_cell.somewhere().dot(normal) < slab.rho;
        let [towards, along] = [normal, along].each(|d| if behind { -d } else { d });
        let right = towards.perp();
        let (at, steep) = (normal * slab.rho, along.dot(towards));
        let axes = [right, DVec2::ZERO, towards].each(|a| up.place(a, 0.0));
        let axes = [axes[0], up.place(DVec2::ZERO, 1.0), axes[2]];
        let triangles = |numbers: &[u32]| {
            let all = numbers.iter().flat_map(|&f| &faces[f as usize].triangles);
            let mut all: Vec<u32> = all.copied().collect();
            all.sort_unstable();
            all
        };
        let replaces = triangles(&slab.faces);
        let origin = up.place(at, 0.0);
        let mut quad = self.framed(origin, axes, up.place(along, 0.0), replaces)?;
        let limits = self.plan_cell.limits(slab.bearing, self.options.limit);
        let low = quad.corner.dot(axes[0]);
        let high = low + quad.size[0];
        let shown = |&f: &u32| {
            let face = &faces[f as usize];
            let place = |&p: &DVec2| (p - along * ((p - at).dot(towards) / steep)).dot(right);
            let places = || face.segments.iter().flatten().map(place);
            let beside = places().all(|x| x < low) || places().all(|x| x > high);
            slab.faces.binary_search(&f).is_ok() || !beside && face.fits(&limits, slab.rho)
        };
        let mut near = tree.at(&limits, slab.rho);
        near.extend_from_slice(&slab.faces);
        near.sort_unstable();
        near.dedup();
        near.retain(shown);
        quad.drawn = triangles(&near);
        Some(quad)
    }

    /// The quads of horizontal faces.
    fn horizontal(&self, faces: &[PlanFace]) -> Vec<Quad> {
        let up = self.options.up;
        let mut triangles: Vec<u32> = faces.iter().flat_map(|f| f.triangles.clone()).collect();
        triangles.sort_unstable();
        let bound = |&t: &u32| {
            let interval = flat::heights(self.mesh, t, self.cell, up, self.options.limit);
            (interval, t)
        };
        let bounded: Vec<(Interval, u32)> = parallel::map_slice(&triangles, bound);
        let levels = if self.options.any_height {
            let height = |&t: &u32| up.height(self.mesh.corners(t as usize)[0]);
            let [low, high] = math::range(triangles.iter().map(height));
            let height = low + (high - low) / 2.0;
            let some = !triangles.is_empty();
            some.then_some(Level { height, triangles })
                .into_iter()
                .collect()
        } else {
            flat::levels(bounded.clone())
        };
        let axes = [(DVec2::X, 0.0), (DVec2::Y, 0.0), (DVec2::ZERO, 1.0)];
        let axes = axes.each(|(plan, height)| up.place(plan, height));
        let quad = |level: Level| {
            let origin = up.place(DVec2::ZERO, level.height);
            let mut quad = self.framed(origin, axes, axes[2], level.triangles)?;
            quad.horizontal = true;
            let shown = |&&(interval, t): &&(Interval, u32)| {
                interval.contains(level.height) || quad.replaces.binary_search(&t).is_ok()
            };
            quad.drawn = bounded.iter().filter(shown).map(|&(_, t)| t).collect();
            Some(quad)
        };
        levels.into_iter().filter_map(quad).collect()
    }

    /// The rectangle of what a plane through `origin` replaces, projected `along` a direction; `None` where it has no
    /// area.
    fn framed(
        &self,
        origin: DVec3,
        axes: [DVec3; 3],
        along: DVec3,
        replaces: Vec<u32>,
    ) -> Option<Quad> {
        let corners = || {
            let corners = replaces.iter().flat_map(|&t| self.mesh.corners(t as usize));
            corners.map(|p| project(p, origin, axes[2], along))
        };
        let range = |axis: DVec3| math::range(corners().map(|p| p.dot(axis)));
        let [[left, right], [bottom, top]] = [range(axes[0]), range(axes[1])];
        let size = [right - left, top - bottom];
        if !(size[0] > 0.0 && size[1] > 0.0) {
            return None;
        }
        let up = self.options.up;
        let distance = replaces.iter().fold(f64::INFINITY, |least, &t| {
            let [a, b, c] = self.mesh.corners(t as usize).each(|p| up.plan(p));
            let to = |p, q| self.plan_cell.distance(p, q);
            least.min(to(a, b)).min(to(b, c)).min(to(c, a))
        });
        let angle = match self.options.limit {
            Limit::Angle(aperture) => aperture.angle(),
            Limit::Distance(_) => DEFAULT_TEXEL,
        };
        let most = self.options.texels;
        Some(Quad {
            corner: axes[0] * left + axes[1] * bottom + axes[2] * origin.dot(axes[2]),
            axes,
            along,
            size,
            texels: size.each(|side| texels(side, distance, angle, most)),
            replaces,
            drawn: Vec::new(),
            horizontal: false,
        })
    }
}
