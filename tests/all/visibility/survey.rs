//! Measurements in parts.

use lodmark::{
    Error, Silent,
    mesh::{Mesh, generate},
    visibility::{MeasureOptions, PartialVisibility, measure},
};
use proptest::prelude::*;
use sha2::{Digest, Sha256};

use super::small;

fn mesh() -> Mesh {
    generate::interlocking_tori(10, 6)
}

fn part(options: &MeasureOptions, range: std::ops::Range<u32>) -> PartialVisibility {
    PartialVisibility::of_views(&mesh(), options, range, &Silent).expect("counts")
}

proptest! {
    #![proptest_config(crate::support::cases(24))]

    #[test]
    fn parts_in_any_order_and_split_sum_up_to_the_same_bytes(
        cuts in prop::collection::btree_set(1..18_u32, 0..8),
        order in any::<u64>(),
        fractional in any::<bool>(),
        two_sided in any::<bool>(),
    ) {
        let options = MeasureOptions { fractional, two_sided, ..small(1, 32) };
        let direct = part(&options, 0..18);
        let ends: Vec<u32> = [0].into_iter().chain(cuts).chain([18]).collect();
        let mut parts: Vec<PartialVisibility> = ends.windows(2).map(|w| part(&options, w[0]..w[1])).collect();
        let mut order = order;
        // Two at a time, whichever: sums of sums too.
        while parts.len() > 1 {
            let first = parts.swap_remove(order as usize % parts.len());
            order = order.rotate_left(7) ^ 0x9e37_79b9;
            let second = order as usize % parts.len();
            let bytes = first.to_bytes();
            let read = PartialVisibility::from_bytes(&bytes, "x").expect("its own bytes");
            prop_assert_eq!(&read, &first);
            parts[second].merge(&read).expect("other views");
        }
        prop_assert_eq!(parts[0].to_bytes(), direct.to_bytes());
        prop_assert!(parts[0].is_complete());
        let found = parts[0].finish(&mesh()).expect("complete");
        prop_assert_eq!(found, measure(&mesh(), &options, &Silent).expect("measures"));
    }

    #[test]
    fn a_changed_byte_or_a_cut_is_refused(at in any::<prop::sample::Index>(), bit in 0..8) {
        let mut bytes = part(&small(0, 16), 1..4).to_bytes();
        let at = at.index(bytes.len());
        let refused = |bytes: &[u8]| {
            let read = PartialVisibility::from_bytes(bytes, "x");
            matches!(read, Err(Error::Input { .. } | Error::Unsupported(_)))
        };
        prop_assert!(refused(&bytes[..at]));
        bytes[at] ^= 1_u8 << bit;
        prop_assert!(refused(&bytes));
    }

    /// The checksum is no secret: whoever damages a file on purpose writes another one.
    #[test]
    fn no_file_with_a_right_checksum_breaks_the_reader(
        changes in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..4),
        cut in any::<prop::sample::Index>(),
        cuts in any::<bool>(),
    ) {
        let options = MeasureOptions { two_sided: true, ..small(0, 16) };
        let bytes = part(&options, 0..6).to_bytes();
        let mut body = bytes[..bytes.len() - 32].to_vec();
        for (at, value) in changes {
            let at = at.index(body.len());
            body[at] = value;
        }
        if cuts {
            body.truncate(cut.index(body.len()));
        }
        let checksum = Sha256::digest(&body);
        body.extend(checksum);
        match PartialVisibility::from_bytes(&body, "x") {
            Ok(mut read) => {
                let _ = read.finish(&mesh());
                let whole = read.clone();
                let _ = read.merge(&whole);
                let _ = read.merge(&part(&options, 0..1));
            }
            Err(error) => {
                let expected = matches!(error, Error::Input { .. } | Error::Unsupported(_));
                prop_assert!(expected, "{}", error);
            }
        }
    }
}

#[test]
fn no_view_counts_twice() {
    let options = small(0, 16);
    let mut sum = part(&options, 1..4);
    let before = sum.clone();
    for overlapping in [0..2, 1..4, 2..3, 3..6, 0..6] {
        let refused = sum.merge(&part(&options, overlapping.clone()));
        let text = refused.expect_err("views in common").to_string();
        assert!(text.contains("in common"), "{overlapping:?}: {text}");
        assert_eq!(sum, before, "nothing was added");
    }
    sum.merge(&part(&options, 0..1)).expect("touches only");
    sum.merge(&part(&options, 4..6)).expect("touches only");
    assert!(sum.is_complete());
}

#[test]
fn parts_that_do_not_belong_together_are_refused() {
    let options = small(0, 16);
    let mut sum = part(&options, 0..3);
    let other = MeasureOptions {
        size: 17,
        ..options
    };
    let refused = sum.merge(&part(&other, 3..6)).expect_err("other options");
    assert!(
        refused
            .to_string()
            .contains("different options (size 16 and 17)"),
        "{refused}"
    );
    let cube =
        PartialVisibility::of_views(&generate::cube(), &options, 3..6, &Silent).expect("counts");
    let refused = sum.merge(&cube).expect_err("another mesh");
    assert!(
        refused.to_string().contains("different meshes"),
        "{refused}"
    );
}

#[test]
fn a_survey_of_another_mesh_or_of_some_views_is_refused() {
    let options = small(0, 16);
    let some = part(&options, 0..5);
    assert!(!some.is_complete());
    let refused = some.finish(&mesh()).expect_err("a view is missing");
    assert!(
        refused.to_string().contains("views 0..5 of 0..6"),
        "{refused}"
    );
    let mut moved = mesh().into_parts();
    moved.positions[7].x += 0.001;
    let moved = Mesh::new(moved).expect("a mesh");
    for other in [moved, generate::cube()] {
        let refused = part(&options, 0..6)
            .finish(&other)
            .expect_err("another mesh");
        assert!(refused.to_string().contains("another mesh"), "{refused}");
    }
}

#[test]
fn views_that_do_not_exist_are_refused() {
    for (start, end) in [(0, 0), (3, 2), (5, 7), (6, 7), (0, u32::MAX)] {
        let range = start..end;
        let refused = PartialVisibility::of_views(&mesh(), &small(0, 16), range.clone(), &Silent);
        assert!(matches!(refused, Err(Error::Usage(_))), "{range:?}");
    }
}
