//! Numbers on a picture, in digits of three by five squares.

use super::Image;

/// Rows of a glyph from top to bottom, three bits each.
const GLYPHS: [(char, [u8; 5]); 12] = [
    ('0', [0b111, 0b101, 0b101, 0b101, 0b111]),
    ('1', [0b010, 0b110, 0b010, 0b010, 0b111]),
    ('2', [0b111, 0b001, 0b111, 0b100, 0b111]),
    ('3', [0b111, 0b001, 0b011, 0b001, 0b111]),
    ('4', [0b101, 0b101, 0b111, 0b001, 0b001]),
    ('5', [0b111, 0b100, 0b111, 0b001, 0b111]),
    ('6', [0b111, 0b100, 0b111, 0b101, 0b111]),
    ('7', [0b111, 0b001, 0b010, 0b010, 0b010]),
    ('8', [0b111, 0b101, 0b111, 0b101, 0b111]),
    ('9', [0b111, 0b101, 0b111, 0b001, 0b111]),
    ('-', [0b000, 0b000, 0b111, 0b000, 0b000]),
    ('.', [0b000, 0b000, 0b000, 0b000, 0b010]),
];

/// Squares from one digit to the next.
const ADVANCE: usize = 4;

/// Squares from the top of a digit to its foot.
pub(super) const HEIGHT: usize = 5;

/// Width of a number in squares.
pub(super) fn width(text: &str) -> usize {
    (ADVANCE * text.chars().count()).saturating_sub(1)
}

/// Writes a number with its top left corner at (`left`, `top`), squares of `side` pixels, in `ink`. What does
/// not fit on the picture is cut off; letters that are no part of a number leave a gap.
pub(super) fn write(image: &mut Image, text: &str, [left, top]: [usize; 2], side: usize, ink: [u8; 3]) {
    for (place, letter) in text.chars().enumerate() {
        let Some((_, rows)) = GLYPHS.iter().find(|(known, _)| *known == letter) else { continue };
        for (square_y, row) in rows.iter().enumerate() {
            for square_x in (0..3).filter(|square| row & (0b100 >> square) != 0) {
                let x = left + (ADVANCE * place + square_x) * side;
                fill(image, [x, top + square_y * side], side, ink);
            }
        }
    }
}

fn fill(image: &mut Image, [left, top]: [usize; 2], side: usize, ink: [u8; 3]) {
    for y in top..(top + side).min(image.height) {
        for x in left..(left + side).min(image.width) {
            let at = 3 * (y * image.width + x);
            image.rgb[at..at + 3].copy_from_slice(&ink);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_number_is_as_wide_as_it_says_and_what_does_not_fit_is_cut_off() {
        let mut image = Image { width: 16, height: 10, rgb: vec![255; 480] };
        write(&mut image, "18", [1, 1], 2, [0; 3]);
        let inked = |x: usize| (0..10).any(|y| image.pixel(x, y) == [0; 3]);
        let columns: Vec<_> = (0..16).filter(|&x| inked(x)).collect();
        assert_eq!((columns[0], columns[columns.len() - 1]), (1, 2 * width("18")));
        write(&mut image, "888", [14, 8], 9, [0; 3]);
    }
}
