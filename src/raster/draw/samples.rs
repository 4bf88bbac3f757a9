//! From samples to pixels: sums of integers, and their means for eyes.

use super::{Grid, Scene, picture::luma};
use crate::view::{View, ViewSet};

/// Luma of every pixel as the sum of its samples: 0 to `255 * samples * samples`.
pub fn luma_sums(scene: &Scene, view: &View, set: &ViewSet) -> Grid<u16> {
    sum_samples(&luma(scene, view, set).tones, set.samples)
}

/// Luma of every pixel as the sum of its `samples` x `samples` samples, from a picture at sample resolution.
pub fn sum_samples(picture: &Grid<u8>, samples: u32) -> Grid<u16> {
    let [sums] = sum(picture, samples, |v| [v]);
    sums
}

/// The mean luma of every pixel, rounded to nearest, from the sums of `samples * samples` samples.
pub fn mean_luma(sums: &Grid<u16>, samples: u32) -> Grid<u8> {
    sums.map(|v| mean(v, samples))
}

/// The mean colour of every pixel, rounded to nearest, from colours at sample resolution.
///
/// # Panics
/// Never: the planes that the sums come from have one size.
pub fn mean_rgb(picture: &Grid<[u8; 3]>, samples: u32) -> Grid<[u8; 3]> {
    let [red, green, blue] = sum(picture, samples, |v| v);
    let mut means = Grid::filled(red.width(), red.height(), [0; 3]);
    let sums = red.values().iter().zip(green.values()).zip(blue.values());
    for (pixel, ((&r, &g), &b)) in means.values_mut().iter_mut().zip(sums) {
        *pixel = [r, g, b].map(|v| mean(v, samples));
    }
    means
}

fn mean(sum: u16, samples: u32) -> u8 {
    let count = samples * samples;
    ((u32::from(sum) + count / 2) / count) as u8
}

/// Sums every channel of `samples` x `samples` blocks; at most 16 samples of 8 bits fit.
fn sum<T: Copy, const N: usize>(
    picture: &Grid<T>,
    samples: u32,
    channels: impl Fn(T) -> [u8; N],
) -> [Grid<u16>; N] {
    let (width, height) = (picture.width() / samples, picture.height() / samples);
    let mut sums: [Grid<u16>; N] = std::array::from_fn(|_| Grid::filled(width, height, 0));
    for (y, row) in picture
        .values()
        .chunks_exact(picture.width() as usize)
        .enumerate()
    {
        let start = y / samples as usize * width as usize;
        for (x, block) in row.chunks_exact(samples as usize).enumerate() {
            for &value in block {
                for (plane, v) in sums.iter_mut().zip(channels(value)) {
                    plane.values_mut()[start + x] += u16::from(v);
                }
            }
        }
    }
    sums
}
