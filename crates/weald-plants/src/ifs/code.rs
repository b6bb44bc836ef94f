//! Codes: the address of a point on a fractal, packed.
//!
//! A point with the code `m₁ m₂ m₃ …` is `F_m₁(F_m₂(F_m₃(…)))`: `m₁` names the largest part that it lies in,
//! each further digit a part of that part. Source: Han and Kim 2007, "Fractal deformation using code and
//! displacement vectors", section 2. Digits stand coarsest first in 256 bits, two bits a digit up to four maps,
//! so that the order of the bits is the order of the codes.

use std::fmt;

/// Bits of a packed code.
const BITS: usize = 256;

/// Most maps of a fractal: a digit then takes eight bits, and a code holds 32.
pub const MAX_MAPS: usize = 256;

/// The digits of a fractal with so many maps.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Digits {
    maps: u16,
    bits: u8,
}

impl Digits {
    /// Digits 0 to `maps - 1`, of 1, 2, 4 or 8 bits; `None` without maps or beyond [`MAX_MAPS`].
    pub fn of(maps: usize) -> Option<Self> {
        let bits = match maps {
            1..=2 => 1,
            3..=4 => 2,
            5..=16 => 4,
            17..=MAX_MAPS => 8,
            _ => return None,
        };
        Some(Self { maps: maps as u16, bits })
    }

    /// How many there are.
    pub fn maps(self) -> usize {
        usize::from(self.maps)
    }

    /// Bits of one digit.
    pub fn bits(self) -> usize {
        usize::from(self.bits)
    }

    /// Most digits of a code: 256, 128, 64 or 32.
    pub fn room(self) -> usize {
        BITS / self.bits()
    }
}

/// A code: digits, coarsest first. What follows its last digit is digit 0 for ever.
#[derive(Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Code {
    words: [u64; 4],
    length: u16,
    bits: u8,
}

impl Code {
    /// The code without digits.
    pub fn empty(digits: Digits) -> Self {
        Self { words: [0; 4], length: 0, bits: digits.bits }
    }

    /// A code of these digits, coarsest first.
    ///
    /// # Errors
    /// A sentence for the user, where a digit names no map or there are more digits than a code holds.
    pub fn of(digits: Digits, values: &[u8]) -> Result<Self, String> {
        if values.len() > digits.room() {
            return Err(format!(
                "a code of {} digits does not fit: with {} maps it holds at most {}",
                values.len(),
                digits.maps(),
                digits.room()
            ));
        }
        if let Some(wrong) = values.iter().find(|&&digit| usize::from(digit) >= digits.maps()) {
            return Err(format!("{wrong} is no digit of a code: they are 0 to {}", digits.maps() - 1));
        }
        Ok(Self::packed(digits, values.iter().copied()))
    }

    /// Packs digits that are known to name maps, as many as there is room for.
    #[inline]
    pub(super) fn packed(digits: Digits, values: impl Iterator<Item = u8>) -> Self {
        let mut code = Self::empty(digits);
        for (place, digit) in values.take(digits.room()).enumerate() {
            let (word, shift) = code.place(place);
            code.words[word] |= u64::from(digit) << shift;
            code.length += 1;
        }
        code
    }

    /// From packed words whose bits beyond `length` digits are 0.
    #[inline]
    pub(super) fn of_words(digits: Digits, length: usize, words: [u64; 4]) -> Self {
        Self { words, length: length as u16, bits: digits.bits }
    }

    /// Reads `113` where digits are below ten, or `1,1,3`, which may end in a comma.
    ///
    /// # Errors
    /// A sentence for the user.
    pub fn parse(digits: Digits, text: &str) -> Result<Self, String> {
        let wrong = |part: &str| format!("`{part}` is no digit of a code; codes are written as 113 or 1,1,3");
        let parts: Vec<String> = if text.contains(',') {
            text.trim().trim_end_matches(',').split(',').map(|part| part.trim().to_owned()).collect()
        } else {
            text.trim().chars().map(String::from).collect()
        };
        let values: Result<Vec<u8>, _> =
            parts.iter().map(|part| part.parse().map_err(|_| wrong(part))).collect();
        Self::of(digits, &values?)
    }

    /// Number of digits.
    #[inline]
    pub fn len(&self) -> usize {
        usize::from(self.length)
    }

    /// Whether it has no digit.
    pub fn is_empty(&self) -> bool {
        self.length == 0
    }

    /// The digit at a place counted from 0, coarsest first; 0 beyond the last.
    #[inline]
    pub fn digit(&self, place: usize) -> u8 {
        if place >= self.len() {
            return 0;
        }
        let (word, shift) = self.place(place);
        ((self.words[word] >> shift) & self.mask()) as u8
    }

    /// All digits, coarsest first.
    pub fn digits(&self) -> impl DoubleEndedIterator<Item = u8> + ExactSizeIterator + '_ {
        (0..self.len()).map(|place| self.digit(place))
    }

    /// With another digit at a place that it has.
    #[must_use]
    pub fn replaced(mut self, place: usize, digit: u8) -> Self {
        let (word, shift) = self.place(place);
        self.words[word] = self.words[word] & !(self.mask() << shift) | u64::from(digit) << shift;
        self
    }

    /// With one more digit at its fine end. A code that is full stays as it is.
    #[must_use]
    pub fn with(mut self, digit: u8) -> Self {
        if self.len() >= BITS / usize::from(self.bits) {
            return self;
        }
        self.length += 1;
        self.replaced(self.len() - 1, digit)
    }

    /// Its first digits, all where it has no more.
    #[must_use]
    pub fn prefix(mut self, length: usize) -> Self {
        for place in length..self.len() {
            self = self.replaced(place, 0);
        }
        self.length = self.length.min(length.min(usize::from(u16::MAX)) as u16);
        self
    }

    /// Whether it begins with these digits; a code that ends earlier goes on with zeros.
    #[inline]
    pub fn starts_with(&self, prefix: &Self) -> bool {
        (0..prefix.len()).all(|place| self.digit(place) == prefix.digit(place))
    }

    /// The four words of the packing, coarsest first.
    pub fn words(&self) -> [u64; 4] {
        self.words
    }

    #[inline]
    fn mask(&self) -> u64 {
        (1 << self.bits) - 1
    }

    /// Word and shift of a digit; no digit lies across two words, as their bits divide 64.
    #[inline]
    fn place(&self, place: usize) -> (usize, usize) {
        let bits = usize::from(self.bits);
        let start = place * bits;
        (start / 64, 64 - bits - start % 64)
    }
}

impl fmt::Display for Code {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.digits().any(|digit| digit > 9) {
            return self.digits().try_for_each(|digit| write!(formatter, "{digit},"));
        }
        self.digits().try_for_each(|digit| write!(formatter, "{digit}"))
    }
}

impl fmt::Debug for Code {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "[{self}]")
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn digits_come_back_as_they_went_in(maps in 1_usize..=256, seed in any::<u64>()) {
            let digits = Digits::of(maps).expect("in range");
            let values: Vec<u8> = (0..digits.room() as i64)
                .map(|place| (weald_core::random::hash2(seed, place, 0) % maps as u64) as u8).collect();
            let code = Code::of(digits, &values).expect("fits");
            prop_assert_eq!(code.digits().collect::<Vec<_>>(), values.clone());
            prop_assert_eq!(Code::parse(digits, &code.to_string()).expect("as printed"), code);
            let half = values.len() / 2;
            prop_assert_eq!(code.prefix(half), Code::of(digits, &values[..half]).expect("fits"));
            prop_assert!(code.starts_with(&code.prefix(half)));
        }
    }

    #[test]
    fn codes_sort_as_their_digits() {
        let digits = Digits::of(4).expect("four maps");
        let code = |text| Code::parse(digits, text).expect("digits");
        assert!(code("1031") < code("11") && code("3") > code("2333"));
    }

    #[test]
    fn a_digit_that_names_no_map_and_a_code_too_long_are_refused() {
        let three = Digits::of(3).expect("three maps");
        assert_eq!(Code::parse(three, "103").unwrap_err(), "3 is no digit of a code: they are 0 to 2");
        let long = Code::of(three, &[0; 129]).unwrap_err();
        assert_eq!(long, "a code of 129 digits does not fit: with 3 maps it holds at most 128");
        assert!(Code::parse(three, "1x").is_err());
        assert!(Digits::of(0).is_none() && Digits::of(257).is_none());
    }
}
