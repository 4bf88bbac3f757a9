//! The file of a correspondence: what it leaves out, and what is wrong with it.
//!
//! `LODMARK_BOUND_CASES` sets the number of cases of each property, and `LODMARK_SEED` what they are drawn from.

use glam::DVec3;
use lodmark::{
    Silent,
    bound::{
        verify::{Gap, Record, angles},
        view_cell::ViewCell,
    },
    mesh::{canonical, generate},
};
use proptest::prelude::*;
use sha2::{Digest, Sha256};

use super::{identity, read};
use crate::support::{bounded, moved};

/// Bytes before the first piece; the last eight count the pieces.
const HEADER: usize = 92;

/// The words of a record between the header and the checksum, and back to a file.
fn words(bytes: &[u8]) -> Vec<u32> {
    bytes[HEADER..bytes.len() - 32]
        .chunks(4)
        .map(|b| u32::from_le_bytes(b.try_into().expect("four")))
        .collect()
}

fn file(header: &[u8], words: &[u32]) -> Vec<u8> {
    let mut bytes = header[..HEADER].to_vec();
    bytes.extend(words.iter().flat_map(|w| w.to_le_bytes()));
    bytes.extend(Sha256::digest(&bytes));
    bytes
}

#[test]
fn pieces_that_leave_a_gap_or_lie_twice_are_found() {
    let mesh = canonical(&generate::tetrahedron()).mesh;
    let cell = ViewCell::point(DVec3::new(0.0, 0.0, 9.0)).expect("a point");
    let whole = identity(&mesh, &mesh);
    let words = words(&whole);
    // Per triangle: count, target, corners, 3 x 4 weights.
    assert_eq!(words.len(), 4 * 15);
    let judge = |words: &[u32], pieces: u64| {
        let mut header = whole.clone();
        header[HEADER - 8..HEADER].copy_from_slice(&pieces.to_le_bytes());
        let record = read(&file(&header, words));
        let report = angles(&mesh, &mesh, &cell, 1.0, Some(&record), 100, &Silent).expect("fits");
        assert_eq!(report.holds, report.gap.is_none() && report.violations == 0);
        assert_eq!(report.proven, report.holds, "nothing moved");
        report.gap
    };
    assert_eq!(judge(&words, 4), None);
    let mut shrunk = words.clone();
    shrunk[15 + 3 + 4] -= 1 << 24;
    assert_eq!(judge(&shrunk, 4), Some((1, Gap::Inside)));
    let mut turned = words.clone();
    for k in 0..4 {
        turned.swap(30 + 3 + k, 30 + 7 + k);
    }
    assert_eq!(judge(&turned, 4), Some((2, Gap::Border)));
    let mut none = words.clone();
    none[0] = 0;
    none.drain(1..15);
    assert_eq!(judge(&none, 3), Some((0, Gap::Border)));
    // Two halves that are the same half.
    let mut twice = words.clone();
    twice[0] = 2;
    twice[3 + 8] = 1 << 30;
    twice[3 + 9] = 1 << 30;
    let half: Vec<u32> = twice[1..15].to_vec();
    twice.splice(15..15, half);
    assert_eq!(judge(&twice, 5), Some((0, Gap::Inside)));
}

proptest! {
    #![proptest_config(bounded(400))]

    #[test]
    fn no_bytes_make_the_reader_panic_or_accept_what_is_out_of_range(
        at: prop::sample::Index, value: u32, cut: prop::sample::Index, shorten: bool,
    ) {
        let mesh = canonical(&generate::tetrahedron()).mesh;
        let whole = identity(&mesh, &mesh);
        let mut words = words(&whole);
        if shorten {
            words.truncate(cut.index(words.len()));
        } else {
            let at = at.index(words.len());
            words[at] = value;
        }
        match Record::from_bytes(&file(&whole, &words), "a.corr") {
            Err(error) => prop_assert_eq!(error.exit_code(), 3),
            Ok(record) => {
                let cell = ViewCell::point(DVec3::new(0.0, 0.0, 9.0)).expect("a point");
                let report = angles(&mesh, &mesh, &cell, 1.0, Some(&record), 50, &Silent);
                prop_assert!(report.is_ok());
            }
        }
    }
}

#[test]
fn a_damaged_file_says_what_is_wrong_with_it() {
    let mesh = canonical(&generate::tetrahedron()).mesh;
    let whole = identity(&mesh, &mesh);
    let refused = |bytes: &[u8]| Record::from_bytes(bytes, "a.corr").expect_err("damaged");
    for length in [0, 7, 8, 50, 115, whole.len() - 1] {
        assert_eq!(refused(&whole[..length]).exit_code(), 3);
    }
    let mut newer = whole.clone();
    newer[8] = 2;
    assert_eq!(refused(&newer).exit_code(), 4);
    let mut flipped = whole.clone();
    flipped[100] ^= 1;
    assert!(refused(&flipped).to_string().contains("checksum"));
    let mut huge = whole[..HEADER].to_vec();
    huge[HEADER - 8..HEADER].copy_from_slice(&u64::MAX.to_le_bytes());
    huge.extend(Sha256::digest(&huge));
    assert!(refused(&huge).to_string().contains("more pieces"));
    // As many triangles, but others; and fewer.
    for other in [moved(&mesh, 0, DVec3::X * 1e-3), generate::icosphere(1)] {
        assert!(!read(&whole).is_from(&other) && !read(&whole).is_to(&other));
    }
    let words = words(&whole);
    let one = 1_u32 << 31;
    let with = |changes: &[(usize, u32)]| {
        let mut changed = words.clone();
        for &(at, word) in changes {
            changed[at] = word;
        }
        refused(&file(&whole, &changed)).to_string()
    };
    // Corners beyond the side across from the first one, in the original and in what stands for it.
    for first in [3, 5] {
        let said = with(&[(first, one / 2 + 1), (first + 1, one / 2)]);
        assert!(said.contains("outside its triangle"), "{said}");
    }
    assert!(with(&[(1, 4)]).contains("goes to triangle 4"));
    let longer = refused(&file(&whole, &[&words[..], &[7]].concat()));
    assert!(longer.to_string().contains("pieces"));
}
