//! Corner attributes as a format with per-vertex attributes sees them.

use crate::mesh::{ChannelKind, Mesh, compare_rows};

/// The attributes of every vertex, and where one row per vertex does not tell everything.
pub(super) struct PerVertex {
    /// The wedge of the first corner at every vertex; `None` at vertices without triangles.
    pub wedges: Vec<Option<u32>>,
    /// Channels whose value differs between corners of one vertex, with the number of such vertices.
    pub differing: Vec<(ChannelKind, usize)>,
}

impl PerVertex {
    /// O(corners).
    pub(super) fn of(mesh: &Mesh) -> Self {
        let attributes = mesh.attributes();
        let channels = attributes.channels();
        let vertices = mesh.positions().len();
        let mut wedges = vec![None; vertices];
        let mut differs = vec![false; vertices * channels.len()];
        for (vertices, corners) in mesh.triangles().iter().zip(attributes.corners()) {
            for (&v, &wedge) in vertices.iter().zip(corners) {
                let first = *wedges[v as usize].get_or_insert(wedge);
                if first == wedge {
                    continue;
                }
                for (i, &channel) in channels.iter().enumerate() {
                    let (a, b) = (
                        attributes.value(channel, first),
                        attributes.value(channel, wedge),
                    );
                    differs[v as usize * channels.len() + i] |= compare_rows(a, b).is_ne();
                }
            }
        }
        let differing = channels
            .iter()
            .enumerate()
            .map(|(i, channel)| {
                let count = differs
                    .iter()
                    .skip(i)
                    .step_by(channels.len())
                    .filter(|&&d| d)
                    .count();
                (channel.kind, count)
            })
            .filter(|&(_, count)| count > 0)
            .collect();
        Self { wedges, differing }
    }

    /// Number of vertices at which the channel differs between corners.
    pub(super) fn differing(&self, kind: ChannelKind) -> usize {
        self.differing
            .iter()
            .find(|(k, _)| *k == kind)
            .map_or(0, |&(_, count)| count)
    }
}

/// A channel in words.
pub(super) fn name(kind: ChannelKind) -> String {
    match kind {
        ChannelKind::Normal => "normals".into(),
        ChannelKind::TexCoord(set) => format!("texture coordinates (set {set})"),
        ChannelKind::Color => "colours".into(),
        ChannelKind::ColorAlpha => "colours with opacity".into(),
        ChannelKind::Tangent => "tangents".into(),
        ChannelKind::Skin(set) => format!("joints and weights (set {set})"),
        ChannelKind::Delta(n) => {
            let of = ["positions", "normals", "tangents"][usize::from(n % 3)];
            format!("{of} of morph target {}", n / 3)
        }
        ChannelKind::Custom { number, .. } => format!("custom attribute {number}"),
    }
}
