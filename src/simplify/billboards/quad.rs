//! One billboard: its place, its texture, and the size of its texels.

use glam::DVec3;

use crate::{
    mesh::{ChannelKind, Mesh},
    num::{Each, fixed::SubpixelBits, math},
    raster::{self, Grid, Scene},
    view::{Cull, Eye, Light, Shading, View, ViewSet},
};

/// A rectangle with a texture.
#[derive(Clone, Debug, PartialEq)]
pub struct Quad {
    /// The lower left corner, seen from the viewers.
    pub corner: DVec3,
    /// Unit vectors to the right, up, and towards the viewers.
    pub axes: [DVec3; 3],
    /// Unit vector towards the viewers along which the scene is projected: the last of the axes, or slanted to it.
    pub along: DVec3,
    /// Width and height.
    pub size: [f64; 2],
    /// Texels in a row and in a column.
    pub texels: [u32; 2],
    /// Triangles of the scene that it replaces, ascending.
    pub replaces: Vec<u32>,
    /// Triangles that are drawn on it: those and all others that may be, which hides cracks. Ascending.
    pub drawn: Vec<u32>,
    /// True for a horizontal one.
    pub horizontal: bool,
}

/// Red, green, blue, opacity; the first row is the upper one.
pub type Texture = Grid<[u8; 4]>;

impl Quad {
    /// The four corners: lower left, lower right, upper right, upper left.
    pub fn corners(&self) -> [DVec3; 4] {
        let [right, up, _] = self.axes;
        let (right, up) = (right * self.size[0], up * self.size[1]);
        let a = self.corner;
        [a, a + right, a + right + up, a + up]
    }

    /// The place on the quad at which a point of the scene is shown.
    pub fn project(&self, p: DVec3) -> DVec3 {
        project(p, self.corner, self.axes[2], self.along)
    }

    /// Draws its texture, seen along the direction of projection with a light at the viewer, as every picture of this
    /// crate; nothing is opaque that no triangle covers, but the colour goes one texel beyond, for filters. O(texels +
    /// drawn).
    pub fn texture(&self, mesh: &Mesh) -> Texture {
        let picture = self.picture(mesh);
        let [width, height] = self.texels;
        let covered = raster::coverage(&picture);
        let mut texture = Grid::filled(width, height, [0; 4]);
        for y in 0..height {
            for x in 0..width {
                let texel = &mut texture.values_mut()[(y * width + x) as usize];
                if covered.at(x, y) > 0 {
                    let [r, g, b] = picture.tones.at(x, y);
                    *texel = [r, g, b, 255];
                } else if let Some([r, g, b]) = neighbour(&picture.tones, &covered, [x, y]) {
                    *texel = [r, g, b, 0];
                }
            }
        }
        texture
    }

    fn picture(&self, mesh: &Mesh) -> raster::Picture<[u8; 3]> {
        let [right, up, back] = self.axes;
        let corners = self.drawn.iter().flat_map(|&t| mesh.corners(t as usize));
        let positions: Vec<DVec3> = corners.collect();
        let depth = |p: &DVec3| (p - self.corner).dot(back);
        let [low, high] = math::range(positions.iter().map(depth));
        let (low, high) = if low <= high { (low, high) } else { (0.0, 0.0) };
        let span = (high - low) * 1.25 + self.size[0].max(self.size[1]) * 1e-6;
        let steep = self.along.dot(back);
        let row = |axis: DVec3, factor: f64, offset: f64| {
            // Nothing changes along the direction of projection.
            let r = (axis - back * (axis.dot(self.along) / steep)) * factor;
            [r.x, r.y, r.z, offset - r.dot(self.corner)]
        };
        let r = -back / span;
        let depth_row = [r.x, r.y, r.z, 0.1 + high / span - r.dot(self.corner)];
        let view = View {
            matrix: [
                row(right, 2.0 / self.size[0], -1.0),
                row(up, 2.0 / self.size[1], -1.0),
                depth_row,
                [0.0, 0.0, 0.0, 1.0],
            ],
            eye: Eye::Axis(self.along),
            near: 0.0,
            far: span,
            cull: Cull::None,
            shading: Shading::default(),
            light: Light::Headlight,
        };
        let set = ViewSet {
            width: self.texels[0],
            height: self.texels[1],
            samples: 1,
            subpixel: SubpixelBits::Eight,
            background: 0,
            views: Vec::new(),
        };
        let count = self.drawn.len() as u32;
        let triangles = (0..count).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
        let scene = Scene::new(positions, triangles, self.drawn.clone());
        raster::rgb(&scene.with_colors(colors(mesh, &self.drawn)), &view, &set)
    }
}

/// The point at which the line through `p` along `along` meets the plane through `origin` with the unit vector `normal`.
pub(super) fn project(p: DVec3, origin: DVec3, normal: DVec3, along: DVec3) -> DVec3 {
    p - along * ((p - origin).dot(normal) / along.dot(normal))
}

/// The mean colour of the covered texels around one that is not.
fn neighbour(tones: &Grid<[u8; 3]>, covered: &Grid<u8>, [x, y]: [u32; 2]) -> Option<[u8; 3]> {
    let (mut sum, mut count) = ([0_u32; 3], 0);
    for j in y.saturating_sub(1)..=(y + 1).min(covered.height() - 1) {
        for i in x.saturating_sub(1)..=(x + 1).min(covered.width() - 1) {
            if covered.at(i, j) > 0 {
                let tone = tones.at(i, j);
                for k in 0..3 {
                    sum[k] += u32::from(tone[k]);
                }
                count += 1;
            }
        }
    }
    (count > 0).then(|| sum.each(|s| (s / count) as u8))
}

fn colors(mesh: &Mesh, triangles: &[u32]) -> Vec<[[f64; 3]; 3]> {
    let attributes = mesh.attributes();
    let channel = attributes
        .channel(ChannelKind::Color)
        .or_else(|| attributes.channel(ChannelKind::ColorAlpha));
    let Some(channel) = channel else {
        return Vec::new();
    };
    let color = |wedge: u32| {
        let v = attributes.value(channel, wedge);
        let none = v[0].is_nan();
        if none { [1.0; 3] } else { [v[0], v[1], v[2]] }
    };
    let of = |&t: &u32| attributes.corners()[t as usize].each(color);
    triangles.iter().map(of).collect()
}

/// Number of texels that a side needs so that none is seen under more than `angle` from `distance`, at least 1 and at
/// most
/// `most`.
pub(super) fn texels(side: f64, distance: f64, angle: f64, most: u32) -> u32 {
    let texel = 2.0 * distance * math::tan(angle / 2.0);
    let wanted = (side / texel).ceil();
    if wanted >= 1.0 && wanted < f64::from(most) {
        wanted as u32
    } else if wanted < 1.0 {
        1
    } else {
        most
    }
}
