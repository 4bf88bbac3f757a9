//! Filters: the last step from decoded attributes to what accessors read.
//!
//! The specifications state formulas in 32-bit floats and allow results one unit off. Here the exact value of a formula
//! is rounded (half away from zero) from integers, in `f64` where a root is needed, so that the bits are the same everywhere;
//! other decoders may differ by one unit for octahedral, quaternion and 16-bit colour elements. Exponential elements are exact.
//! Components out of their range, which the specifications leave open, saturate.

use crate::num::math::sqrt;

use super::Filter;

/// Replaces elements of `stride` bytes, one that the filter allows, by what the filter makes of them.
pub(super) fn apply(filter: Filter, stride: usize, elements: &mut [u8]) -> Result<(), String> {
    match (filter, stride) {
        (Filter::None, _) => Ok(()),
        (Filter::Exponential, _) => {
            for word in elements.as_chunks_mut::<4>().0 {
                *word = exponential(i32::from_le_bytes(*word)).to_le_bytes();
            }
            Ok(())
        }
        (Filter::Octahedral, 4) => each(elements, |e: [u8; 4]| {
            let [x, y, one, rest] = e.map(u8::cast_signed);
            let [x, y, z] = octahedral([x, y, one].map(i32::from), i8::MAX.into())?;
            Ok([x as i8, y as i8, z as i8, rest].map(i8::cast_unsigned))
        }),
        (Filter::Octahedral, _) => halves(elements, |e| {
            let [x, y, one, rest] = e.map(u16::cast_signed);
            let [x, y, z] = octahedral([x, y, one].map(i32::from), i16::MAX.into())?;
            Ok([x as i16, y as i16, z as i16, rest].map(i16::cast_unsigned))
        }),
        (Filter::Quaternion, _) => halves(elements, |e| quaternion(e.map(u16::cast_signed))),
        (Filter::Color, 4) => each(elements, |[y, co, cg, alpha]: [u8; 4]| {
            let chroma = [co, cg].map(|c| i32::from(c.cast_signed()));
            Ok(color(y.into(), chroma, alpha.into(), u8::MAX.into())?.map(|c| c as u8))
        }),
        (Filter::Color, _) => halves(elements, |[y, co, cg, alpha]| {
            let chroma = [co, cg].map(|c| i32::from(c.cast_signed()));
            Ok(color(y.into(), chroma, alpha.into(), u16::MAX.into())?.map(|c| c as u16))
        }),
    }
}

/// Replaces elements of `N` bytes; the fault of one is told with its place.
fn each<const N: usize>(
    elements: &mut [u8],
    decoded: impl Fn([u8; N]) -> Result<[u8; N], String>,
) -> Result<(), String> {
    for (i, element) in elements.as_chunks_mut::<N>().0.iter_mut().enumerate() {
        *element = decoded(*element)
            .map_err(|fault| format!("element {i}, decoded byte {}: {fault}", i * N))?;
    }
    Ok(())
}

/// Replaces elements of four 16-bit components.
fn halves(
    elements: &mut [u8],
    decoded: impl Fn([u16; 4]) -> Result<[u16; 4], String>,
) -> Result<(), String> {
    each(elements, |e: [u8; 8]| {
        let result = decoded(std::array::from_fn(|i| {
            u16::from_le_bytes([e[2 * i], e[2 * i + 1]])
        }))?;
        Ok(std::array::from_fn(|i| result[i / 2].to_le_bytes()[i % 2]))
    })
}

/// Whether `one` is the greatest signed integer of at least `bits` bits.
fn is_one(one: i32, bits: u32) -> bool {
    one >= (1 << (bits - 1)) - 1 && (one + 1).count_ones() == 1
}

/// The unit vector, in units of `1 / max`, behind two coordinates of the unfolded octahedron in units of `1 / one`.
///
/// The octahedron is scaled by `one` instead of dividing its coordinates: the direction is the same, and integers are exact.
fn octahedral([x, y, one]: [i32; 3], max: i32) -> Result<[f64; 3], String> {
    if !is_one(one, 2) {
        return Err(format!(
            "an octahedral vector with {one} for 1.0; expected 2^(k-1) - 1, k from 2 to 16"
        ));
    }
    let z = one - x.abs() - y.abs();
    let fold = z.min(0);
    let unfolded = |c: i32| if c < 0 { c - fold } else { c + fold };
    let vector = [unfolded(x), unfolded(y), z].map(f64::from);
    let length = sqrt(vector.iter().map(|c| c * c).sum());
    Ok(vector.map(|c| (c * f64::from(max) / length).round()))
}

/// The unit quaternion behind its three smaller components, in units of `1 / (one * sqrt 2)`, and the number of the
/// greatest.
fn quaternion([x, y, z, last]: [i16; 4]) -> Result<[u16; 4], String> {
    let one = i32::from(last | 3);
    if !is_one(one, 4) {
        return Err(format!(
            "a quaternion with {one} for 1.0; expected 2^(k-1) - 1, k from 4 to 16"
        ));
    }
    let unit = f64::from(i16::MAX);
    let diagonal = 2.0 * f64::from(one) * f64::from(one);
    let length = sqrt(diagonal);
    let small = [x, y, z].map(f64::from);
    let rest = diagonal - small.iter().map(|c| c * c).sum::<f64>();
    let greatest = usize::from(last.cast_unsigned() & 3);
    let mut result = [0; 4];
    result[greatest] = (sqrt(rest.max(0.0)) * unit / length).round() as i16;
    for (i, c) in small.iter().enumerate() {
        result[(greatest + 1 + i) % 4] = (c * unit / length).round() as i16;
    }
    Ok(result.map(i16::cast_unsigned))
}

/// The float `m * 2^e` behind a signed exponent of 8 bits above a signed mantissa of 24. Exact for the exponents from -100
/// to 100 that the specifications allow, rounded beyond.
fn exponential(bits: i32) -> f32 {
    let power = f64::from_bits(((1023 + (bits >> 24)) as u64) << 52);
    (f64::from(bits << 8 >> 8) * power) as f32
}

/// Red, green, blue and alpha, from 0 to `max`, behind luma, two chromas and an alpha whose highest bit tells the number
/// of bits.
fn color(y: i32, [co, cg]: [i32; 2], alpha: i32, max: i32) -> Result<[i64; 4], String> {
    if alpha < 2 {
        return Err(format!(
            "a colour with the alpha code {alpha}; expected 2 or more, the highest bit being 1"
        ));
    }
    let high = 1 << alpha.ilog2();
    let one = 2 * high - 1;
    let a = alpha - high;
    let rgba = [y + co - cg, y + cg, y - co - cg, a << 1 | a & 1];
    // `one` is odd: no quotient lies half way.
    let rounded =
        |c: i32| (2 * i64::from(c) * i64::from(max) + i64::from(one)) / (2 * i64::from(one));
    Ok(rgba.map(|c| rounded(c.clamp(0, one))))
}
