//! Fractals on a device: shaders, and what they are given, as data. The crate `weald-gpu` runs them.
//!
//! A device wants thousands of lanes where a chunk has 64. So each lane is cut into **segments** of its steps, one an
//! invocation, which begin so many steps earlier that where they began is forgotten to the last place of single precision.
//! Draws are hashes of (lane, step): digits are those of [`Game`] to the bit, points to what rounding leaves.

use super::code::{Code, Digits};
use super::game::{Game, STEPS};
use super::lanes::LANES;
use super::shader::Shader;
use super::system::Ifs;
use super::wind::WORDS;
use weald_engine::uniform;

/// Random iteration: fills `rests`, and `codes` where wanted, from the rows of [`Table`](super::Table), its bounds, and
/// the keys of each chunk.
pub const PLAY: Shader = Shader {
    name: "play",
    text: &[include_str!("game.wgsl")],
    group: LANES as u32,
    uniforms: &["rules", "range"],
    buffers: &[("maps", false), ("bounds", false), ("keys", false), ("rests", true), ("codes", true)],
};

uniform! {
    /// What a dispatch works on.
    pub struct DispatchRange {
        /// Workgroup with which it begins.
        pub first: u32,
        /// Points of the buffers.
        pub points: u32,
    }
}

uniform! {
    /// The uniform of [`PLAY`].
    pub struct Rules {
        /// Where lanes begin.
        root: [f32; 4],
        /// Bits of a code that count: all of its digits, or as many as fit.
        kept: [u32; WORDS],
        /// Number of maps.
        maps: u32,
        /// Bits of a digit.
        bits: u32,
        /// Steps of a chunk before its first point.
        history: u32,
        /// Steps after which it no longer matters where a lane began.
        forgotten: u32,
        /// Points of a segment, a power of two.
        pub segment: u32,
        /// Whether codes are written.
        coded: u32,
    }
}

/// Share of the size of a fractal that single precision does not tell apart.
const FORGOTTEN: f64 = 1.0 / (1 << 25) as f64;

/// Least points of a segment: enough to be worth the steps before them.
const MIN_SEGMENT: usize = 64;

impl Game<'_> {
    /// The rules as a shader is given them; `coded` where codes are wanted.
    pub fn rules(&self, coded: bool) -> Rules {
        let (ifs, history) = (self.ifs, self.ifs.code_digits());
        let enough = |&steps: &usize| ifs.ratio_of(steps) <= FORGOTTEN;
        let forgotten = (history..history + STEPS).find(enough).unwrap_or(history + STEPS);
        let [x, y, z] = ifs.root().map(|x| x as f32);
        let bits = ifs.digits().bits();
        Rules {
            root: [x, y, z, 0.0],
            kept: mask(digits_on_a_device(ifs) * bits),
            maps: ifs.maps().len() as u32,
            bits: bits as u32,
            history: history as u32,
            forgotten: forgotten as u32,
            segment: forgotten.next_power_of_two().clamp(MIN_SEGMENT, STEPS) as u32,
            coded: u32::from(coded),
        }
    }
}

/// Digits of a point's code that a device keeps: those of the fractal, as far as 128 bits hold them.
pub fn digits_on_a_device(ifs: &Ifs) -> usize {
    ifs.code_digits().min(32 * WORDS / ifs.digits().bits())
}

/// The first 128 bits of a code, coarsest first.
pub fn packed(code: &Code) -> [u32; WORDS] {
    let [coarse, fine, ..] = code.words();
    [(coarse >> 32) as u32, coarse as u32, (fine >> 32) as u32, fine as u32]
}

/// The code of so many digits that a device holds as these words, whose bits beyond are 0.
pub fn unpacked(digits: Digits, length: usize, [a, b, c, d]: [u32; WORDS]) -> Code {
    let joined = |coarse: u32, fine: u32| u64::from(coarse) << 32 | u64::from(fine);
    Code::of_words(digits, length, [joined(a, b), joined(c, d), 0, 0])
}

/// So many ones, coarsest first.
fn mask(ones: usize) -> [u32; WORDS] {
    std::array::from_fn(|word| match ones.saturating_sub(32 * word).min(32) {
        0 => 0,
        here => u32::MAX << (32 - here),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ifs::shapes;

    #[test]
    fn codes_come_back_from_the_words_of_a_device() {
        for shape in shapes::SHAPES {
            let ifs = shape.ifs();
            let length = digits_on_a_device(&ifs);
            let kept = mask(length * ifs.digits().bits());
            Game::new(&ifs, 3).points(500, |block| {
                for number in 0..block.len() {
                    let code = block.code(number, &ifs);
                    let words: [u32; WORDS] = std::array::from_fn(|word| packed(&code)[word] & kept[word]);
                    assert_eq!(unpacked(ifs.digits(), length, words), code.prefix(length), "{}", shape.name);
                }
            });
        }
    }

    #[test]
    fn a_mask_has_its_ones_at_the_coarse_end() {
        assert_eq!(mask(48), [u32::MAX, 0xffff_0000, 0, 0]);
        assert_eq!((mask(0), mask(128)), ([0; 4], [u32::MAX; 4]));
    }

    #[test]
    fn segments_are_longer_where_a_fractal_contracts_slowly() {
        let segment = |name| {
            let ifs = shapes::find(name).expect("built in").ifs();
            Game::new(&ifs, 1).rules(true).segment
        };
        assert_eq!((segment("gasket"), segment("fern"), segment("cyclosorus")), (64, 128, 512));
    }
}
