//! A 5 x 7 bitmap font for labels: printable ASCII, drawn here. No system fonts: pictures are the same everywhere.

/// Columns of a glyph.
pub(super) const WIDTH: u32 = 5;
/// Rows of a glyph.
pub(super) const HEIGHT: u32 = 7;

/// A line of 14 characters, and below it their pictures side by side, one blank column between; `#` is ink.
const GLYPHS: [[&str; 8]; 7] = [
    [
        "0123456789ABCD",
        " ###    #    ###   ###     #  #####  ###  #####  ###   ###   ###  ####   ###  #### ",
        "#   #  ##   #   # #   #   ##  #     #         # #   # #   # #   # #   # #   # #   #",
        "#  ##   #       #     #  # #  ####  #        #  #   # #   # #   # #   # #     #   #",
        "# # #   #      #    ##  #  #      # ####    #    ###   #### ##### ####  #     #   #",
        "##  #   #     #       # #####     # #   #  #    #   #     # #   # #   # #     #   #",
        "#   #   #    #    #   #    #  #   # #   #  #    #   #     # #   # #   # #   # #   #",
        " ###   ###  #####  ###     #   ###   ###   #     ###   ###  #   # ####   ###  #### ",
    ],
    [
        "EFGHIJKLMNOPQR",
        "##### #####  ###  #   #  ###    ### #   # #     #   # #   #  ###  ####   ###  #### ",
        "#     #     #   # #   #   #      #  #  #  #     ## ## ##  # #   # #   # #   # #   #",
        "#     #     #     #   #   #      #  # #   #     # # # ##  # #   # #   # #   # #   #",
        "####  ####  # ### #####   #      #  ##    #     # # # # # # #   # ####  #   # #### ",
        "#     #     #   # #   #   #      #  # #   #     #   # #  ## #   # #     # # # # #  ",
        "#     #     #   # #   #   #   #  #  #  #  #     #   # #  ## #   # #     #  #  #  # ",
        "##### #      ###  #   #  ###   ##   #   # ##### #   # #   #  ###  #      ## # #   #",
    ],
    [
        "STUVWXYZabcdef",
        " #### ##### #   # #   # #   # #   # #   # #####       #               #         ## ",
        "#       #   #   # #   # #   # #   # #   #     #       #               #        #   ",
        "#       #   #   # #   # #   #  # #   # #     #   ###  ####   ####  ####  ###  #### ",
        " ###    #   #   # #   # # # #   #     #     #       # #   # #     #   # #   #  #   ",
        "    #   #   #   # #   # # # #  # #    #    #     #### #   # #     #   # #####  #   ",
        "    #   #   #   #  # #  ## ## #   #   #   #     #   # #   # #     #   # #      #   ",
        "####    #    ###    #   #   # #   #   #   #####  #### ####   ####  ####  ###   #   ",
    ],
    [
        "ghijklmnopqrst",
        "      #       #      #  #      ##                                              #   ",
        "      #                 #       #                                              #   ",
        " #### ####   ##      #  #  #    #   ## #  ####   ###  ####   #### # ##   #### ###  ",
        "#   # #   #   #      #  # #     #   # # # #   # #   # #   # #   # ##    #      #   ",
        " #### #   #   #      #  ##      #   # # # #   # #   # ####   #### #      ###   #   ",
        "    # #   #   #   #  #  # #     #   # # # #   # #   # #         # #         #  #   ",
        " ###  #   #  ###   ##   #  #   ###  # # # #   #  ###  #         # #     ####    ## ",
    ],
    [
        "uvwxyz.,:;!?'\"",
        "                                                              #    ###    #    # # ",
        "                                                 ##    ##     #   #   #   #    # # ",
        "#   # #   # #   # #   # #   # #####              ##    ##     #       #            ",
        "#   # #   # # # #  # #  #   #    #                            #      #             ",
        "#   # #   # # # #   #    ####   #          ##    ##    ##     #     #              ",
        "#   #  # #  # # #  # #      #  #     ##     #    ##     #                          ",
        " ####   #    # #  #   #  ###  #####  ##    #           #      #     #              ",
    ],
    [
        "`|+-*/=_<>()[]",
        " #      #                           #                          #   #     ###   ### ",
        "  #     #     #           #       #                #   #      #     #    #       # ",
        "        #     #         # # #    #  #####         #     #    #       #   #       # ",
        "        #   ##### #####  ###    #                #       #   #       #   #       # ",
        "        #     #         # # #  #    #####         #     #    #       #   #       # ",
        "        #     #           #   #                    #   #      #     #    #       # ",
        "        #                                 #####                #   #     ###   ### ",
    ],
    [
        "{}#%&@$^~\\    ",
        "  ##   ##    # #  ##     ##    ###    #     #                                      ",
        "  #     #    # #  ##  # #  #  #   #  ####  # #        #                            ",
        "  #     #   #####    #  # #   # ### # #   #   #  #     #                           ",
        " #       #   # #    #    #    # # #  ###        # # #   #                          ",
        "  #     #   #####  #    # # # # ###   # #          #     #                         ",
        "  #     #    # #  #  ## #  #  #     ####                  #                        ",
        "  ##   ##    # #     ##  ## #  ###    #                                            ",
    ],
];

/// True where the glyph of `character` has ink; characters without a glyph are a filled box.
pub(super) fn ink(character: char, column: u32, row: u32) -> bool {
    if character == ' ' {
        return false;
    }
    GLYPHS
        .iter()
        .find_map(|[characters, rows @ ..]| {
            let index = characters.chars().position(|c| c == character)?;
            let at = index * (WIDTH as usize + 1) + column as usize;
            Some(rows[row as usize].as_bytes().get(at) == Some(&b'#'))
        })
        .unwrap_or(true)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_printable_character_has_a_glyph_of_its_own() {
        let mut seen: Vec<(char, Vec<bool>)> = Vec::new();
        for character in ' '..='~' {
            let bits: Vec<bool> = (0..HEIGHT * WIDTH)
                .map(|i| ink(character, i % WIDTH, i / WIDTH))
                .collect();
            let drawn = bits.contains(&true);
            assert_eq!(drawn, character != ' ', "{character:?} is drawn");
            assert!(bits.contains(&false), "{character:?} has no glyph");
            if let Some((twin, _)) = seen.iter().find(|(_, other)| *other == bits) {
                panic!("{character:?} looks like {twin:?}");
            }
            seen.push((character, bits));
        }
    }

    #[test]
    fn every_glyph_has_the_width_of_the_font() {
        for [characters, rows @ ..] in GLYPHS {
            for row in rows {
                assert_eq!(row.len(), 14 * 6 - 1, "{characters}: {row:?}");
                // The columns between glyphs are blank.
                for gap in (WIDTH as usize..row.len()).step_by(6) {
                    assert_eq!(row.as_bytes()[gap], b' ', "{characters}: {row:?} at {gap}");
                }
            }
        }
    }
}
