//! Streams of the reference encoder with what the reference decoder made of them, and a few made by hand.

use super::*;

/// A stream and its elements, in hexadecimal. Made with `meshoptimizer` 1.3.0; of its decoders the one in JavaScript
/// rounds filters as this module does.
pub(super) struct Row {
    name: &'static str,
    pub(super) mode: Mode,
    pub(super) filter: Filter,
    pub(super) count: usize,
    pub(super) stride: usize,
    stream: &'static str,
    elements: &'static str,
}

impl Row {
    pub(super) fn stream(&self) -> Vec<u8> {
        bytes(self.stream)
    }

    pub(super) fn decode(&self, stream: &[u8]) -> Result<Vec<u8>> {
        decode(self.mode, self.filter, self.count, self.stride, stream)
    }
}

pub(super) fn bytes(hexadecimal: &str) -> Vec<u8> {
    let (pairs, _) = hexadecimal.as_bytes().as_chunks::<2>();
    let digit = |d: u8| char::from(d).to_digit(16).expect("a digit") as u8;
    pairs
        .iter()
        .map(|&[a, b]| digit(a) << 4 | digit(b))
        .collect()
}

pub(super) const ROWS: &[Row] = &[
    Row {
        name: "version 0: all widths",
        mode: Mode::Attributes,
        filter: Filter::None,
        count: 19,
        stride: 8,
        stream: "a000070013031b002c2b04002c03231827241bf0000000301700000103c000000304060e7f590d9c6c0db110fc00000004050405\
                 0f030030090a0b060c00000004060800000f980fe0b0142020000000000000000000000000000000000000000000000000000000\
                 001e0000fe00fe00",
        elements: "001e0000fe00fe0000140000fe07fe0400120000fe03f90400040000fc0bfe0400040000fe08fe04001a0000fe03fe0400040000\
                 fe03fe0400060000fefcf80e00060000fef7f809001c0000fefdf80d001a0000fe00f80d00080000fe06f81d00140000fe06f824\
                 00000000fefffb2400120000fef9fb1e00040000fef8fb1e001c0000fefafb1e00100000fef7fb1f00100000fef9fd1f",
    },
    Row {
        name: "version 1: planes of all four kinds, halves and rotated words",
        mode: Mode::Attributes,
        filter: Filter::None,
        count: 17,
        stride: 8,
        stream: "a1738a007d09f6fac567ce01411a16d63145d1c8021045a80900f14290623613756a26ebf3bf110302be01086455450100010300\
                 3d01279f34f9360f0f000000000000000000000000000007056804002800000162",
        elements: "07056804002800004804ef03002800004304100500240000be04580500100000bb050906001000005805240700140000a4049a06\
                 001c00008b055f06000000008a041407002400006903a707001800007604b106001400008104b70500040000ec04d70400380000\
                 d304ce04001c0000b0034c0400100000c702cd04000800002b03ac0500080000",
    },
    Row {
        name: "version 1: plain bytes, rotated words",
        mode: Mode::Attributes,
        filter: Filter::None,
        count: 19,
        stride: 8,
        stream: "a19a3a02085aa7c020ba0ba103000a0b003768772f881720906fc8d72f20c8070800e70140000100000000000000000000000000\
                 0000020000000024407201",
        elements: "000200000000244000120000000008400018000000003c40000c000000000040001800000000e83f0016000000002c40000e0000\
                 0000a03f000e00000000b03f000a00000000f83f000a00000000c03f001c000000002440000800000000b83f000800000000a03f\
                 001e00000000b03f000a0000000014400008000000001040001c000000001440000a000000001440000a00000000a03f",
    },
    Row {
        name: "version 1: bytes and rotated words",
        mode: Mode::Attributes,
        filter: Filter::None,
        count: 18,
        stride: 8,
        stream: "a1159a01100199a9010001010228c3d7040403030300030100bea6bb674709c8da2db6c3ee02005701c28001010603020da38baf\
                 50e866470f03000a03000000000000000000000000000001009500003800000062",
        elements: "0100950000380000000037ff000c0000000003ff002400000001dfff002800000001daff0008000000023eff0024000000033efe\
                 000c0000ff03ab01003000000005ab0100240000ff059401002400000005ef01001c0000ff07ef01003c00000005ef0100240000\
                 01048d01003c000002038d01002c0000010104ff0030000000ff04ff0018000000fed8ff00140000",
    },
    Row {
        name: "version 1: fewer elements than a group",
        mode: Mode::Attributes,
        filter: Filter::None,
        count: 5,
        stride: 4,
        stream: "a1ff002060a0e0003070b0f0004080c0ff005090d0ef000000000000000000000000000000000000000001040900",
        elements: "00010409101924314051647990a9c4e100214469",
    },
    Row {
        name: "octahedral, 8 bits",
        mode: Mode::Attributes,
        filter: Filter::Octahedral,
        count: 6,
        stride: 4,
        stream: "a0013ff0000070bd964b44013ff000001f1e6d160900020343430000000000000000000000000000000000000000000000000000\
                 00000000000000035a7f81",
        elements: "04772d814e64f77fd0760381423a5c7f013e6f813c44597f",
    },
    Row {
        name: "octahedral, 12 bits in 16",
        mode: Mode::Attributes,
        filter: Filter::Octahedral,
        count: 5,
        stride: 8,
        stream: "a1ffba00946e1b1400040c111600a87b9b81000c0f041000030403040000000000000000000000000000a6fa67fbff0701800001\
",
        elements: "01a46ab821cb01809bad8f2e2e56ff7f521fb384e8f10180dfae18e404a1ff7fd55c1b5865fe0180",
    },
    Row {
        name: "quaternions of 13 bits",
        mode: Mode::Attributes,
        filter: Filter::Quaternion,
        count: 5,
        stride: 8,
        stream: "a0013fc000009d677ece013f000000262d1e013f0000009526ab013fc00000060e2b1e0133c00000edf972013fc0000004211a27\
                 010780000004000000000000000000000000000000000000000000000000005ff564fefe0cfd0f",
        elements: "83495255dcc3e5f63252a5569e2d36067457feaf3d2e02f284b5cd383a579900e002630ae6c80773",
    },
    Row {
        name: "exponents of their own",
        mode: Mode::Attributes,
        filter: Filter::Exponential,
        count: 3,
        stride: 12,
        stream: "a1efffef000066003f6600000700bc5500a61000020000828900eccc000a23003e07000000000000000000002000f300d8fff48a\
                 3300d6000000",
        elements: "0000803f000020c000284e31000000000078ad600000e04000cccc3d00cc4c3e0098993e",
    },
    Row {
        name: "colour, 7 bits in 8",
        mode: Mode::Attributes,
        filter: Filter::Color,
        count: 6,
        stride: 4,
        stream: "a1ff001f18175782001d553160560057742b0e000009401010010000000000000000000000000000000000000058240c4600\
",
        elements: "e1c95018fb50a70648dda1872a99e7a7244e20c7fdd14cc1",
    },
    Row {
        name: "colour, 12 bits in 16",
        mode: Mode::Attributes,
        filter: Filter::Color,
        count: 4,
        stride: 8,
        stream: "a0013f000000d2041a012700000008013f000000fc59e8013c0000000308013f00000057eaa3011700000004013f000000e975d9\
                 010f0000000304000000000000000000000000000000000000000000000000e70a30ff8501310c",
        elements: "2889ccc62aa33886588a9bba9cd489975bc009a2389035508eedbffdeaae8882",
    },
    Row {
        name: "triangles: edges, vertices, numbers, neighbours of the last",
        mode: Mode::Triangles,
        filter: Filter::None,
        count: 48,
        stride: 2,
        stream: "e1fe1e100e100eff1fff1efe10ff1d0dff0f08ff060401047f0bf2f00400ffeff00401c804ffc9040000007687566778a9866589\
                 689801690000",
        elements: "0000010004000400010005000500010002000500020006000600020003000600030007000a000c000b000b000c000d0007000600\
                 409c409c0600419c000001000200020001000300090008002c012c0108002b012c012b012a01050005000500",
    },
    Row {
        name: "triangles: `next` begins again",
        mode: Mode::Triangles,
        filter: Filter::None,
        count: 18,
        stride: 4,
        stream: "e1f010fffe10fff101e2c50800ffcdc508ee887aef887a007687566778a9866589689801690000",
        elements: "000000000100000002000000020000000100000003000000ffffffff701101000300000000000000010000000200000002000000\
                 01000000030000000900000040420f0008000000",
    },
    Row {
        name: "two interleaved sequences",
        mode: Mode::Indices,
        filter: Filter::None,
        count: 10,
        stride: 2,
        stream: "d100a11f04050405c80f9b1facf00f0500000000",
        elements: "0000e8030100e9030200ea03f4010300ffff0400",
    },
    Row {
        name: "great steps",
        mode: Mode::Indices,
        filter: Filter::None,
        count: 7,
        stride: 4,
        stream: "d114028192f4010ce78ff401e891f401e5fdffff0700000000",
        elements: "050000000400000040420f00070000004600000041420f00ffffff1f",
    },
];

#[test]
fn streams_of_the_reference_encoder_become_what_its_decoder_makes_of_them() {
    for row in ROWS {
        let elements = row.decode(&row.stream()).expect(row.name);
        assert_eq!(elements, bytes(row.elements), "{}", row.name);
    }
}

#[test]
fn the_example_of_the_specification_has_its_deltas() {
    let mut stream = bytes("a002175ff0bc77a9210034b5000000");
    stream.resize(stream.len() + 32, 0);
    let elements = decode(Mode::Attributes, Filter::None, 16, 4, &stream).expect("a stream");
    let deltas = [-1, -4, -3, 26, -91, 0, -6, 6, -4, -4, 5, -5, 1, -1, 0, 0];
    let mut sum = 0_i8;
    for (element, delta) in elements.as_chunks::<4>().0.iter().zip(deltas) {
        sum = sum.wrapping_add(delta);
        assert_eq!(element, &[sum.cast_unsigned(), 0, 0, 0]);
    }
}

#[test]
fn blocks_continue_where_the_one_before_ended() {
    // 257 elements in blocks of 256 and 1: four planes of zero widths, then one whose first group adds 1 to byte 0.
    let mut stream = vec![0; 1 + 16];
    stream[0] = 0xa0;
    stream.extend([1, 0x80, 0, 0, 0, 0, 0, 0]);
    stream.extend([0; 28]);
    stream.extend([7, 8, 9, 10]);
    let elements = decode(Mode::Attributes, Filter::None, 257, 4, &stream).expect("a stream");
    assert_eq!(elements[..1024], [7, 8, 9, 10].repeat(256));
    assert_eq!(elements[1024..], [8, 8, 9, 10]);
}

#[test]
fn equal_elements_need_a_control_byte_a_block() {
    let mut stream = vec![0xaa; 1 + 4];
    stream[0] = 0xa1;
    stream.extend([0; 19]);
    stream.extend([1, 2, 3, 4, 0]);
    let elements = decode(Mode::Attributes, Filter::None, 1024, 4, &stream).expect("a stream");
    assert_eq!(elements, [1, 2, 3, 4].repeat(1024));
}

#[test]
fn exponential_elements_are_exact_and_beyond_their_range_rounded() {
    for (bits, value) in [
        (0x0000_0001, 1.0),
        (0xffff_ffff, -0.5),
        (0x9c80_0000, -8_388_608.0 / (1_u128 << 100) as f32),
        (0x647f_ffff, 8_388_607.0 * (1_u128 << 100) as f32),
        (0x7f7f_ffff, f32::INFINITY),
        (0x8000_0001, f32::from_bits(1 << 21)),
    ] {
        let mut element = u32::to_le_bytes(bits);
        filters::apply(Filter::Exponential, 4, &mut element).expect("any bits");
        assert_eq!(
            f32::from_le_bytes(element).to_bits(),
            f32::to_bits(value),
            "{bits:#x}"
        );
    }
}
