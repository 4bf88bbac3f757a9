//! NumPy arrays of any type and shape, and files that are none.

use std::fs;

use lodmark::encode::npy::{self, Element};
use proptest::prelude::*;

use crate::support::{cases, folder};

/// Shapes of one to four dimensions and the values of each.
fn shaped() -> impl Strategy<Value = (Vec<u64>, Vec<u64>)> {
    prop::collection::vec(0_u64..5, 1..5).prop_flat_map(|shape| {
        let count = shape.iter().product::<u64>() as usize;
        (Just(shape), prop::collection::vec(any::<u64>(), count))
    })
}

/// Writes and reads an array; compares by `bits`, so that NaN is equal to itself.
fn survives<T: Element>(shape: &[u64], values: &[T], bits: impl Fn(&T) -> u64) -> bool {
    let folder = folder();
    let path = folder.path().join("a.npy");
    npy::write_array(&path, values, shape).expect("written");
    let (read, sides) = npy::read_array::<T>(&path).expect("read");
    sides == shape && read.iter().map(&bits).eq(values.iter().map(&bits))
}

proptest! {
    #![proptest_config(cases(32))]

    #[test]
    fn an_array_of_any_type_and_shape_reads_back_to_the_same_bits((shape, words) in shaped()) {
        let narrow: Vec<u32> = words.iter().map(|&w| w as u32).collect();
        let bytes: Vec<u8> = words.iter().map(|&w| w as u8).collect();
        let halves: Vec<u16> = words.iter().map(|&w| w as u16).collect();
        let signed: Vec<i64> = words.iter().map(|&w| w.cast_signed()).collect();
        let floats: Vec<f32> = narrow.iter().map(|&w| f32::from_bits(w)).collect();
        let doubles: Vec<f64> = words.iter().map(|&w| f64::from_bits(w)).collect();
        prop_assert!(survives(&shape, &bytes, |&x| x.into()));
        prop_assert!(survives(&shape, &halves, |&x| x.into()));
        prop_assert!(survives(&shape, &narrow, |&x| x.into()));
        prop_assert!(survives(&shape, &words, |&x| x));
        prop_assert!(survives(&shape, &signed, |x| x.cast_unsigned()));
        prop_assert!(survives(&shape, &floats, |x| x.to_bits().into()));
        prop_assert!(survives(&shape, &doubles, |x| x.to_bits()));
    }

    #[test]
    fn bytes_that_are_no_array_are_refused_and_never_a_panic(
        bytes in prop::collection::vec(any::<u8>(), 0..200),
        version in 0_u8..5,
    ) {
        let folder = folder();
        let path = folder.path().join("a.npy");
        let headed = [b"\x93NUMPY".as_slice(), &[version, 0], &bytes].concat();
        for content in [bytes, headed] {
            fs::write(&path, content).expect("target is writable");
            let refused = npy::read_array::<u16>(&path).expect_err("no array");
            prop_assert_eq!(refused.exit_code(), 3);
        }
    }
}

#[test]
fn the_bytes_before_the_values_are_those_of_earlier_versions() {
    let folder = folder();
    let path = folder.path().join("a.npy");
    npy::write_array(&path, &[0_u32; 64], &[8, 8]).expect("written");
    let text = "{'descr': '<u4', 'fortran_order': False, 'shape': (8, 8, ), }";
    let expected = [
        b"\x93NUMPY\x01\x00\x76\x00".as_slice(),
        format!("{text:<117}\n").as_bytes(),
        &[0; 256],
    ]
    .concat();
    assert_eq!(fs::read(&path).expect("read"), expected);
}

#[test]
fn a_shape_that_is_not_that_of_the_values_is_refused_before_writing() {
    let folder = folder();
    let path = folder.path().join("a.npy");
    for shape in [&[][..], &[3], &[1; 5], &[1 << 63, 4]] {
        assert!(npy::write_array(&path, &[1_u8, 2], shape).is_err());
    }
    assert!(!path.exists());
}

#[test]
fn arrays_of_numpy_in_every_version_of_the_format_are_read() {
    let folder = folder();
    let path = folder.path().join("a.npy");
    let text = "{'descr': '<u2', 'fortran_order': False, 'shape': (3,), }\n";
    let length = text.len() as u32;
    for version in [1_u8, 2, 3] {
        let mut file = b"\x93NUMPY".to_vec();
        file.extend([version, 0]);
        match version {
            1 => file.extend((length as u16).to_le_bytes()),
            _ => file.extend(length.to_le_bytes()),
        }
        file.extend(text.as_bytes());
        file.extend([1, 0, 2, 0, 3, 1]);
        fs::write(&path, file).expect("target is writable");
        let read = npy::read_array::<u16>(&path).expect("read");
        assert_eq!(read, (vec![1, 2, 0x103], vec![3]));
    }
}
