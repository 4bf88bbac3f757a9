//! Streams that are broken: told with their place, never a panic.

use proptest::prelude::*;

use super::{
    reference::{ROWS, bytes},
    *,
};

#[test]
fn memory_is_in_proportion_to_the_stream() {
    for header in [0xa0, 0xa1, 0xe1, 0xd1] {
        let mode = match header {
            0xe1 => Mode::Triangles,
            0xd1 => Mode::Indices,
            _ => Mode::Attributes,
        };
        let mut stream = vec![0; 100];
        stream[0] = header;
        for count in [usize::MAX / 3 * 3, 1 << 40, 300_000] {
            let count = count / 3 * 3;
            let error = decode(mode, Filter::None, count, 4, &stream).expect_err("too short");
            assert!(error.to_string().contains("need at least"), "{error}");
        }
    }
}

/// Decodes a stream in hexadecimal, and returns the message of the error.
fn fault(mode: Mode, filter: Filter, count: usize, stride: usize, stream: &str) -> String {
    decode(mode, filter, count, stride, &bytes(stream))
        .expect_err(stream)
        .message()
}

#[test]
fn faults_of_attributes_are_told_with_their_place() {
    let attributes = |count, stream: &str| {
        let tail = "00".repeat(32);
        fault(
            Mode::Attributes,
            Filter::None,
            count,
            4,
            &format!("{stream}{tail}"),
        )
    };
    for (found, told) in [
        (
            attributes(1, "a2"),
            "byte 0: found 0xa2; expected 0xa0 or 0xa1",
        ),
        (
            attributes(1, "a0000000"),
            "byte 1: 1 elements and the tail need at least 36 bytes, but 35 follow",
        ),
        (
            attributes(1, "a003000000"),
            "byte 2: the stream ends before its tail, in the block of elements 0 to 0 of 1",
        ),
        (
            attributes(1, "a00000000000"),
            "byte 5: 1 bytes are left after the last element",
        ),
        (
            fault(Mode::Attributes, Filter::None, 1, 4, ""),
            "byte 0: the stream is empty",
        ),
        (
            fault(
                Mode::Attributes,
                Filter::None,
                1,
                4,
                &format!("a1aa{}03", "00".repeat(23)),
            ),
            "byte 25: channel mode 0x03",
        ),
        (
            fault(
                Mode::Attributes,
                Filter::None,
                1,
                4,
                &format!("a1aa{}11", "00".repeat(23)),
            ),
            "byte 25: channel mode 0x11",
        ),
    ] {
        assert!(found.contains(told), "{found}");
    }
}

#[test]
fn faults_of_indices_are_told_with_their_place() {
    let table = "00".repeat(16);
    let triangles = |count, stream: &str| fault(Mode::Triangles, Filter::None, count, 2, stream);
    let sequence = |count, stream: &str| fault(Mode::Indices, Filter::None, count, 4, stream);
    for (found, told) in [
        (
            triangles(3, &format!("e0f0{table}")),
            "byte 0: found 0xe0; expected 0xe1",
        ),
        (
            triangles(6, &format!("e1f0{table}")),
            "byte 1: 6 elements and the tail need at least 18 bytes",
        ),
        (
            triangles(3, &format!("e110{table}")),
            "byte 1: code 0x10 of triangle 0 of 1 names the edge before 1",
        ),
        (
            triangles(6, &format!("e1f004{table}")),
            "byte 2: code 0x04 of triangle 1 of 2 names the vertex before 4",
        ),
        (
            triangles(3, &format!("e1fe{table}")),
            "byte 1: code 0xfe of triangle 0 of 1 asks for more than there is",
        ),
        (
            triangles(3, &format!("e1ff008080808080{table}")),
            "before byte 8",
        ),
        (
            triangles(3, &format!("e1f000{table}")),
            "byte 2: 1 bytes are left",
        ),
        (
            triangles(3, &format!("e1f0{}01", &table[2..])),
            "byte 17: entry 15 of the table is 0x01; expected zero",
        ),
        (
            triangles(3, &format!("e1f0f1{}", &table[2..])),
            "byte 2: entry 0 of the table is 0xf1",
        ),
        (sequence(1, "d1000000000000"), "byte 2: 1 bytes are left"),
        (
            sequence(1, "d18080808080"),
            "byte 1: index 0 of 1 has no end",
        ),
        (
            sequence(1, "d181818181810100000000"),
            "byte 1: index 0 of 1 has no end",
        ),
        (
            sequence(2, "d10000000000"),
            "byte 1: 2 elements and the tail need at least 6 bytes, but 5 follow",
        ),
    ] {
        assert!(found.contains(told), "{found}");
    }
}

#[test]
fn faults_around_a_stream_and_of_filters_are_told() {
    let zero = |filter, stride| {
        let stream = format!("a0{}", "00".repeat(stride + 32));
        fault(Mode::Attributes, filter, 1, stride, &stream)
    };
    for (found, told) in [
        (
            zero(Filter::None, 6),
            "6 bytes an element; expected a multiple of 4 up to 256",
        ),
        (zero(Filter::None, 0), "0 bytes an element"),
        (
            zero(Filter::Color, 12),
            "12 bytes an element; expected 4 or 8",
        ),
        (
            zero(Filter::Quaternion, 4),
            "4 bytes an element; expected 8",
        ),
        (
            zero(Filter::Octahedral, 4),
            "element 0, decoded byte 0: an octahedral vector with 0 for 1.0",
        ),
        (
            zero(Filter::Quaternion, 8),
            "element 0, decoded byte 0: a quaternion with 3 for 1.0",
        ),
        (
            zero(Filter::Color, 8),
            "element 0, decoded byte 0: a colour with the alpha code 0",
        ),
        (
            fault(Mode::Indices, Filter::None, 1, 3, ""),
            "3 bytes an element; expected 2 or 4",
        ),
        (
            fault(Mode::Indices, Filter::Color, 1, 4, ""),
            "expected it for attributes only",
        ),
        (
            fault(Mode::Triangles, Filter::None, 4, 4, ""),
            "4 indices of triangles are declared; expected a multiple of 3",
        ),
    ] {
        assert!(found.contains(told), "{found}");
    }
}

fn some_mode() -> impl Strategy<Value = (Mode, u8)> {
    prop::sample::select(vec![
        (Mode::Attributes, 0xa0),
        (Mode::Attributes, 0xa1),
        (Mode::Triangles, 0xe1),
        (Mode::Indices, 0xd1),
    ])
}

fn some_filter() -> impl Strategy<Value = Filter> {
    prop::sample::select(vec![
        Filter::None,
        Filter::Octahedral,
        Filter::Quaternion,
        Filter::Exponential,
        Filter::Color,
    ])
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn any_bytes_are_elements_or_an_error(
        (mode, header) in some_mode(),
        filter in some_filter(),
        count in 0_usize..400,
        stride in prop::sample::select(vec![0_usize, 2, 3, 4, 8, 12, 64, 252, 256, 260]),
        stream in prop::collection::vec(prop_oneof![Just(0), any::<u8>()], 0..600),
    ) {
        let stream: Vec<u8> = std::iter::once(header).chain(stream).collect();
        for filter in [Filter::None, filter] {
            if let Ok(elements) = decode(mode, filter, count, stride, &stream) {
                prop_assert_eq!(elements.len(), count * stride);
            }
        }
    }

    #[test]
    fn any_elements_pass_a_filter_or_are_an_error(
        filter in some_filter(),
        element in any::<[u8; 8]>(),
        stride in prop::sample::select(vec![4_usize, 8]),
    ) {
        if fits(Mode::Attributes, filter, 1, stride).is_ok() {
            let mut elements = element;
            drop(filters::apply(filter, stride, &mut elements[..stride]));
        }
    }

    #[test]
    fn a_stream_with_other_bytes_is_elements_or_an_error(
        row in prop::sample::select((0..ROWS.len()).collect::<Vec<_>>()),
        changes in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..4),
        dropped in prop_oneof![4 => Just(0_usize), 1 => 1_usize..40],
        more in 0_usize..3,
    ) {
        let row = &ROWS[row];
        let mut stream = row.stream();
        for (at, byte) in changes {
            let at = at.index(stream.len());
            stream[at] = byte;
        }
        stream.truncate(stream.len().saturating_sub(dropped));
        let count = row.count + 3 * more;
        if let Ok(elements) = decode(row.mode, row.filter, count, row.stride, &stream) {
            prop_assert_eq!(elements.len(), count * row.stride);
        }
    }

    #[test]
    fn a_shorter_or_longer_stream_is_an_error(
        row in prop::sample::select((0..ROWS.len()).collect::<Vec<_>>()),
        keep in any::<prop::sample::Index>(),
    ) {
        let row = &ROWS[row];
        let mut stream = row.stream();
        stream.push(0);
        prop_assert!(row.decode(&stream).is_err());
        stream.pop();
        stream.truncate(keep.index(stream.len()));
        prop_assert!(row.decode(&stream).is_err());
    }
}
