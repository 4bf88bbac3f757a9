//! The direction of texture coordinates: v runs down in glTF, up in the other formats.

use crate::{
    Result,
    mesh::{Attributes, ChannelKind, Mesh},
};

/// The mesh with 1 - v for every v, and only with the channels that are kept.
pub(super) fn flipped(mesh: &Mesh, keeps: &mut dyn FnMut(ChannelKind) -> bool) -> Result<Mesh> {
    let attributes = mesh.attributes();
    let channels = attributes.channels().iter().copied();
    let kept: Vec<_> = channels.filter(|channel| keeps(channel.kind)).collect();
    let kinds: Vec<ChannelKind> = kept.iter().map(|channel| channel.kind).collect();
    let mut values = Vec::with_capacity(attributes.values().len());
    for wedge in 0..attributes.wedge_count() as u32 {
        for &channel in &kept {
            values.extend_from_slice(attributes.value(channel, wedge));
            if let (ChannelKind::TexCoord(_), Some(v)) = (channel.kind, values.last_mut()) {
                *v = mesh.precision().round(1.0 - *v);
            }
        }
    }
    let mut parts = mesh.clone().into_parts();
    parts.attributes = Attributes::new(&kinds, values, attributes.corners().to_vec())?;
    Mesh::new(parts)
}
