//! Colours in a recipe.

use super::declaration::ParameterValue;
use super::diagnostics::Diagnostics;
use super::kind::Kind;
use super::values::wrong;
use crate::source::{Node, Value};

/// A colour as a recipe gives it, `"#rrggbb"`: red, green and blue in sRGB, 0 to 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Colour(pub [f32; 3]);

impl ParameterValue for Colour {
    fn kind(_: (f64, f64)) -> Kind {
        Kind::Colour
    }

    fn read(node: &Node, _: (f64, f64), _: &mut Diagnostics) -> Result<Self, String> {
        let Value::Text(text) = &node.value else { return Err(fault(node)) };
        let digits = text.strip_prefix('#').filter(|digits| digits.len() == 6);
        // `from_str_radix` takes a sign, which is no digit.
        let digits = digits.filter(|digits| digits.chars().all(|digit| digit.is_ascii_hexdigit()));
        let number =
            digits.and_then(|digits| u32::from_str_radix(digits, 16).ok()).ok_or_else(|| fault(node))?;
        Ok(Self([16, 8, 0].map(|shift| ((number >> shift) & 0xff) as f32 / 255.0)))
    }

    fn shown(&self) -> Option<String> {
        let [red, green, blue] = self.0.map(|channel| (channel * 255.0 + 0.5) as u8);
        Some(format!("\"#{red:02x}{green:02x}{blue:02x}\""))
    }
}

fn fault(node: &Node) -> String {
    wrong(node, "a colour: \"#\" and six hexadecimal digits, as \"#d9bd85\"")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<Colour, String> {
        let node = Node { line: 1, value: Value::Text(text.to_owned()) };
        Colour::read(&node, (0.0, 0.0), &mut Diagnostics::default())
    }

    #[test]
    fn a_colour_is_shown_as_it_was_read() {
        for text in ["#000000", "#d9bd85", "#ffffff", "#010203"] {
            assert_eq!(read(text).map(|colour| colour.shown()), Ok(Some(format!("{text:?}"))));
        }
        for text in ["d9bd85", "#d9bd8", "#d9bd855", "#+9bd85", "#d9bg85", "#é9bd8", "red", ""] {
            let problem = read(text).expect_err("no colour");
            assert!(problem.contains("six hexadecimal digits"), "{text}: {problem}");
        }
    }
}
