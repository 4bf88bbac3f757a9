//! Blending the values of corners: weighted means, made fit again for what the channel means.

use glam::DVec3;

use crate::{
    mesh::ChannelKind,
    num::{Precision, math},
};

/// The values of corners, and their weights, which sum to 1.
pub(in crate::rooms::collapse) struct Blend<'a, const N: usize> {
    /// The values of each corner.
    pub values: [&'a [f64]; N],
    /// The weight of each corner.
    pub weights: [f64; N],
}

impl<const N: usize> Blend<'_, N> {
    /// Writes the mean into `into`, rounded to the precision: within the range of the values; unit for normals and
    /// tangents, or `otherwise` where they cancel; of skins the four heaviest joints with the weight of all; of
    /// custom attributes and the signs of tangents the value that weighs most.
    pub(in crate::rooms::collapse) fn write(
        &self,
        kind: ChannelKind,
        precision: Precision,
        otherwise: &[f64],
        into: &mut [f64],
    ) {
        match kind {
            ChannelKind::Custom { .. } => return into.copy_from_slice(self.heaviest()),
            ChannelKind::Skin(_) => self.skin(into),
            _ => self.mean(into),
        }
        if matches!(kind, ChannelKind::Normal | ChannelKind::Tangent) {
            let unit = math::unit(DVec3::new(into[0], into[1], into[2]));
            into[..3].copy_from_slice(
                &unit.map_or([otherwise[0], otherwise[1], otherwise[2]], |n| n.to_array()),
            );
        }
        if kind == ChannelKind::Tangent {
            into[3] = self.heaviest()[3];
        }
        for x in into {
            *x = precision.round(*x);
        }
    }

    fn mean(&self, into: &mut [f64]) {
        for (i, x) in into.iter_mut().enumerate() {
            let (mut sum, first) = (self.weights[0] * self.values[0][i], self.values[0][i]);
            let (mut low, mut high) = (first, first);
            for (values, weight) in self.values.iter().zip(self.weights).skip(1) {
                sum += weight * values[i];
                (low, high) = (low.min(values[i]), high.max(values[i]));
            }
            *x = sum.clamp(low, high);
        }
    }

    /// The values of the corner that weighs most, the first of several.
    fn heaviest(&self) -> &[f64] {
        let better = |best: usize, i: usize| {
            if self.weights[i] > self.weights[best] {
                i
            } else {
                best
            }
        };
        self.values[(1..N).fold(0, better)]
    }

    /// Adds the weights of equal joints and keeps the four heaviest, of equal ones those with the least number; they take
    /// over what the others weigh (a set of several does not sum to 1).
    fn skin(&self, into: &mut [f64]) {
        let mut joints: Vec<(f64, f64)> = Vec::with_capacity(4 * N);
        for (values, weight) in self.values.iter().zip(self.weights) {
            for k in 0..4 {
                let (joint, share) = (values[k], weight * values[k + 4]);
                match joints.iter_mut().find(|j| j.0.total_cmp(&joint).is_eq()) {
                    _ if share <= 0.0 => {}
                    Some(known) => known.1 += share,
                    None => joints.push((joint, share)),
                }
            }
        }
        joints.sort_by(|a, b| b.1.total_cmp(&a.1).then(a.0.total_cmp(&b.0)));
        let sum_of = |joints: &[(f64, f64)]| joints.iter().map(|j| j.1).sum::<f64>();
        let all = sum_of(&joints);
        joints.truncate(4);
        let sum = sum_of(&joints);
        into.fill(0.0);
        for (k, (joint, share)) in joints.into_iter().enumerate() {
            (into[k], into[k + 4]) = (joint, share / sum * all);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn blended(kind: ChannelKind, values: [&[f64]; 2], weights: [f64; 2]) -> Vec<f64> {
        let mut into = vec![0.0; kind.width()];
        Blend { values, weights }.write(kind, Precision::F64, values[0], &mut into);
        into
    }

    #[test]
    fn ids_are_taken_from_the_nearest_corner_and_never_averaged() {
        let kind = ChannelKind::Custom {
            number: 0,
            width: 1,
        };
        assert_eq!(blended(kind, [&[3.0], &[8.0]], [0.4, 0.6]), [8.0]);
        assert_eq!(blended(kind, [&[3.0], &[8.0]], [0.5, 0.5]), [3.0]);
    }

    #[test]
    fn a_skin_keeps_its_four_heaviest_joints_and_their_weights_sum_to_one() {
        let a = [1.0, 2.0, 3.0, 4.0, 0.4, 0.3, 0.2, 0.1];
        let b = [5.0, 2.0, 6.0, 0.0, 0.5, 0.25, 0.25, 0.0];
        let found = blended(ChannelKind::Skin(0), [&a, &b], [0.5, 0.5]);
        assert_eq!(found[..4], [2.0, 5.0, 1.0, 6.0]);
        assert!((found[4..].iter().sum::<f64>() - 1.0).abs() < 1e-15);
        assert!(found[4] > found[5] && found[5] > found[6] && found[6] > found[7]);
    }

    #[test]
    fn a_tangent_is_unit_and_its_sign_whole() {
        let found = blended(
            ChannelKind::Tangent,
            [&[1.0, 0.0, 0.0, 1.0], &[0.0, 1.0, 0.0, -1.0]],
            [0.25, 0.75],
        );
        assert_eq!(found[3..], [-1.0]);
        assert!((found[0] * found[0] + found[1] * found[1] - 1.0).abs() < 1e-15);
    }
}
