//! SHA-256 of pixels, for goldens: of raw arrays with their size, never of encoded files; and of any bytes.
//!
//! The hash covers three little-endian 32-bit numbers, width, height and bytes per pixel, and then the pixels row by
//! row from the top left, every value little-endian. In Python with a numpy array `a` of shape (height, width) or
//! (height, width, 3): `sha256(struct.pack("<3I", w, h, a.nbytes // (w * h)) + a.tobytes())`.

use sha2::{Digest, Sha256};

use crate::num::Grid;

/// A pixel with a fixed little-endian form.
pub trait Raw: Copy {
    /// Bytes of a pixel.
    const BYTES: u32;

    /// Appends the little-endian bytes.
    fn append(self, bytes: &mut Vec<u8>);
}

macro_rules! raw_number {
    ($($number:ty),*) => {$(
        impl Raw for $number {
            const BYTES: u32 = size_of::<$number>() as u32;

            fn append(self, bytes: &mut Vec<u8>) {
                bytes.extend_from_slice(&self.to_le_bytes());
            }
        }
    )*};
}

raw_number!(u8, u16, u32, u64, i64, f32, f64);

impl Raw for [u8; 3] {
    const BYTES: u32 = 3;

    fn append(self, bytes: &mut Vec<u8>) {
        bytes.extend_from_slice(&self);
    }
}

/// SHA-256 of the bytes of a file as 64 lower-case hexadecimal digits: what `sha256sum` prints.
pub fn bytes_sha256(bytes: &[u8]) -> String {
    digits(&Sha256::digest(bytes))
}

fn digits(digest: &[u8]) -> String {
    digest.iter().map(|byte| format!("{byte:02x}")).collect()
}

/// SHA-256 of a plane as 64 lower-case hexadecimal digits.
pub fn plane_sha256<T: Raw>(plane: &Grid<T>) -> String {
    let mut hash = Sha256::new();
    for number in [plane.width(), plane.height(), T::BYTES] {
        hash.update(number.to_le_bytes());
    }
    let mut bytes = Vec::new();
    for part in plane.values().chunks(4_096) {
        bytes.clear();
        for &value in part {
            value.append(&mut bytes);
        }
        hash.update(&bytes);
    }
    digits(&hash.finalize())
}
