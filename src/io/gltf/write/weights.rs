//! Weights of joints that sum to 1 as they are stored.

use super::additions::Storage;
use crate::io::gltf::accessor::Component;

/// Brings weights to a sum of 1: of normalized integers exactly, those with the greatest remainders, of equal ones the
/// first, are rounded up; of floats as far as one of them can.
pub(super) fn settle(weights: &mut [f64], storage: Storage) {
    let sum: f64 = weights.iter().map(|w| w.max(0.0)).sum();
    for w in weights.iter_mut() {
        *w = if sum > 0.0 { w.max(0.0) / sum } else { 0.0 };
    }
    if sum <= 0.0 {
        weights[0] = 1.0;
    }
    if storage.component == Component::F32 {
        for w in weights.iter_mut() {
            *w = f64::from(*w as f32);
        }
        let rest = 1.0 - weights.iter().sum::<f64>();
        if let Some(greatest) = weights.iter_mut().max_by(|a, b| a.total_cmp(b)) {
            *greatest += rest;
        }
        return;
    }
    let one = storage.component.one();
    let mut order: Vec<usize> = (0..weights.len()).collect();
    let remainder = |i: usize, weights: &[f64]| {
        let whole = weights[i] * one;
        whole - whole.floor()
    };
    order.sort_by(|&a, &b| remainder(b, weights).total_cmp(&remainder(a, weights)));
    let floors: f64 = weights.iter().map(|w| (w * one).floor()).sum();
    let missing = (one - floors) as usize;
    for (rank, i) in order.into_iter().enumerate() {
        let up = if rank < missing { 1.0 } else { 0.0 };
        weights[i] = ((weights[i] * one).floor() + up) / one;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn settled(weights: [f64; 4], component: Component) -> [f64; 4] {
        let mut weights = weights;
        let storage = Storage {
            component,
            normalized: component != Component::F32,
            width: 4,
        };
        settle(&mut weights, storage);
        weights
    }

    #[test]
    fn normalized_integers_sum_exactly() {
        for weights in [
            [0.3, 0.3, 0.3, 0.1],
            [1.0, 1.0, 1.0, 0.0],
            [0.0; 4],
            [0.7, 0.2, 0.1, 0.0],
        ] {
            for (component, one) in [(Component::U8, 255.0), (Component::U16, 65535.0)] {
                let found = settled(weights, component).map(|w| (w * one).round());
                assert_eq!(
                    found.iter().sum::<f64>() as u32,
                    one as u32,
                    "{weights:?} {found:?}"
                );
            }
        }
    }

    #[test]
    fn floats_sum_to_one_as_closely_as_they_can() {
        let found = settled([1.0, 1.0, 1.0, 0.0], Component::F32).map(|w| w as f32);
        assert!((found.iter().sum::<f32>() - 1.0).abs() < 1e-7, "{found:?}");
    }
}
