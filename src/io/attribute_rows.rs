//! Attribute values as files have them, made fit for a mesh.

use crate::{mesh::ChannelKind, num::Precision};

/// Rounds rows of attribute values to the precision of the mesh. A value of which a part is NaN is absent as a whole.
pub(super) fn settle(values: &mut [f64], kinds: &[ChannelKind], precision: Precision) {
    let stride: usize = kinds.iter().map(|k| k.width()).sum();
    if stride == 0 {
        return;
    }
    for row in values.chunks_mut(stride) {
        let mut rest = row;
        for kind in kinds {
            let Some((value, after)) = rest.split_at_mut_checked(kind.width()) else {
                break;
            };
            if value.iter().any(|x| x.is_nan()) {
                value.fill(f64::NAN);
            }
            for x in value {
                *x = precision.round(*x);
            }
            rest = after;
        }
    }
}
