//! [`Slots`]: the numbers of the mesh's triangles and vertices in the pictures, and what its corners look like there.

use glam::DVec3;

use crate::{
    collapse::{LiveMesh, NONE},
    mesh::{Channel, ChannelKind},
    num::Each,
    raster::{CornerValues, Scene, stored_normal},
};

/// Numbers of the mesh's triangles and vertices in the pictures: without gaps, in the order of the mesh's own ids.
#[derive(Clone, Debug)]
pub(super) struct Slots {
    /// By triangle id; [`NONE`] where it was dead.
    pub(super) triangles: Vec<u32>,
    /// By vertex id; [`NONE`] where no triangle used it.
    pub(super) vertices: Vec<u32>,
    color: Option<Channel>,
    /// Only where pictures show stored normals.
    normal: Option<Channel>,
}

impl Slots {
    /// Numbers the living triangles and their vertices, and gives the scene that they are; `lit` where pictures show
    /// stored normals.
    pub(super) fn of(live: &LiveMesh, lit: bool) -> (Self, Scene) {
        let channel = |kinds: &[ChannelKind]| {
            let mut channels = live.rows().channels().iter().copied();
            channels.find(|c| kinds.contains(&c.kind))
        };
        let mut slots = Self {
            triangles: vec![NONE; live.triangle_ids() as usize],
            vertices: vec![NONE; live.vertex_ids() as usize],
            color: channel(&[ChannelKind::Color, ChannelKind::ColorAlpha]),
            normal: channel(&[ChannelKind::Normal]).filter(|_| lit),
        };
        let (mut positions, mut triangles) = (Vec::new(), Vec::new());
        let (mut colors, mut normals) = (Vec::new(), Vec::new());
        for id in 0..live.triangle_ids() {
            let Some(corners) = live.triangle(id) else {
                continue;
            };
            slots.triangles[id as usize] = triangles.len() as u32;
            let values = slots.values(live, &[], live.wedges(id));
            if slots.has_colors() {
                colors.push(values.colors);
            }
            if slots.normal.is_some() {
                normals.push(values.normals);
            }
            triangles.push(corners.each(|v| {
                let slot = &mut slots.vertices[v as usize];
                if *slot == NONE {
                    *slot = positions.len() as u32;
                    positions.push(live.position(v));
                }
                *slot
            }));
        }
        let ids = (0..triangles.len() as u32).collect();
        let scene = Scene::new(positions, triangles, ids);
        (
            slots,
            scene.with_colors(colors).with_stored_normals(normals),
        )
    }

    /// Number of triangles in the pictures.
    pub(super) fn triangle_count(&self) -> usize {
        let numbered = self.triangles.iter().filter(|&&slot| slot != NONE);
        numbered.count()
    }

    /// True where the mesh has colours.
    pub(super) fn has_colors(&self) -> bool {
        self.color.is_some()
    }

    /// The colours and normals that a triangle with these wedges shows at its corners; `rows` holds wedges that the mesh does not have yet.
    pub(super) fn values(&self, live: &LiveMesh, rows: &[f64], wedges: [u32; 3]) -> CornerValues {
        let of = |channel: Channel, wedge: u32| {
            let row = if wedge < live.wedge_count() {
                live.rows().row(wedge)
            } else {
                let stride = live.rows().stride();
                &rows[(wedge - live.wedge_count()) as usize * stride..][..stride]
            };
            &row[channel.offset..][..channel.kind.width()]
        };
        CornerValues {
            colors: match self.color {
                None => [[1.0; 3]; 3],
                Some(channel) => wedges.each(|w| match *of(channel, w) {
                    [r, g, b, ..] if !r.is_nan() => [r, g, b],
                    _ => [1.0; 3],
                }),
            },
            normals: match self.normal {
                None => [DVec3::ZERO; 3],
                Some(channel) => wedges.each(|w| stored_normal(of(channel, w))),
            },
        }
    }
}
