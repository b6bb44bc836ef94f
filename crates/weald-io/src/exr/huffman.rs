//! The canonical Huffman code of PIZ: lengths of codes, then bits from the highest of each byte on.
//!
//! Of two codes of different length the longer one has the smaller number; of the same length they follow the
//! order of their symbols. The last symbol of the table repeats the word before it as often as the next eight
//! bits say.

/// Words and the symbol for repetitions.
const SYMBOLS: usize = (1 << 16) + 1;
/// Longest code in bits.
const LONGEST: usize = 58;
/// Lengths from here on stand for runs of symbols that do not occur: 2 to 5 of them,
const SHORT_RUN: u64 = 59;
/// or 6 to 261.
const LONG_RUN: u64 = 63;
const SHORTEST_LONG_RUN: u64 = 6;

/// As many words as wanted from a code.
pub(super) fn decode(packed: &[u8], wanted: usize) -> Result<Vec<u16>, String> {
    let (header, rest) = packed.split_first_chunk::<20>().ok_or("its code ends within its header")?;
    let number = |at: usize| u32::from_le_bytes([0, 1, 2, 3].map(|byte| header[4 * at + byte])) as usize;
    let [first, last, _, data_bits, _] = [0, 1, 2, 3, 4].map(number);
    if first > last || last >= SYMBOLS {
        return Err(format!("its code is of symbols {first} to {last} of {SYMBOLS}"));
    }
    let mut bits = Bits::new(rest);
    let code = Code::read(&mut bits, first, last)?;
    let mut data = Bits::new(bits.whole_bytes_left());
    if data_bits > 8 * data.bytes.len() {
        return Err(format!("its code has {data_bits} bits in {} bytes", data.bytes.len()));
    }
    data.end = data_bits;
    code.words(&mut data, wanted)
}

/// Bits, the highest of a byte first.
struct Bits<'a> {
    bytes: &'a [u8],
    next: usize,
    end: usize,
}

impl<'a> Bits<'a> {
    fn new(bytes: &'a [u8]) -> Self {
        Self { bytes, next: 0, end: 8 * bytes.len() }
    }

    fn bit(&mut self) -> Result<u64, String> {
        if self.next == self.end {
            return Err("its code ends too early".to_owned());
        }
        let bit = self.bytes[self.next / 8] >> (7 - self.next % 8) & 1;
        self.next += 1;
        Ok(u64::from(bit))
    }

    fn number(&mut self, count: usize) -> Result<u64, String> {
        (0..count).try_fold(0, |number, _| Ok(number << 1 | self.bit()?))
    }

    fn whole_bytes_left(&self) -> &'a [u8] {
        &self.bytes[self.next.div_ceil(8)..]
    }
}

/// A code, sorted by length.
struct Code {
    /// First code of each length.
    first: [u64; LONGEST + 1],
    /// Where the symbols of each length begin in `symbols`, and where those of the last end.
    starts: [usize; LONGEST + 2],
    symbols: Vec<u32>,
    /// The symbol that repeats.
    repeats: u32,
}

impl Code {
    fn read(bits: &mut Bits<'_>, first: usize, last: usize) -> Result<Self, String> {
        let mut lengths = Vec::with_capacity(last + 1 - first);
        while lengths.len() < last + 1 - first {
            let (length, count) = match bits.number(6)? {
                LONG_RUN => (0, bits.number(8)? + SHORTEST_LONG_RUN),
                run @ SHORT_RUN.. => (0, run - SHORT_RUN + 2),
                length => (length as u8, 1),
            };
            lengths.extend(std::iter::repeat_n(length, count as usize));
        }
        if lengths.len() > last + 1 - first {
            return Err("its code has more lengths than symbols".to_owned());
        }
        Ok(Self::of(&lengths, first, last))
    }

    /// The code of symbols from `first` on with these lengths; 0 for those that do not occur.
    fn of(lengths: &[u8], first: usize, last: usize) -> Self {
        let mut starts = [0; LONGEST + 2];
        for &length in lengths.iter().filter(|&&length| length > 0) {
            starts[usize::from(length) + 1] += 1;
        }
        let mut codes = [0; LONGEST + 1];
        let mut next = 0;
        for length in (1..=LONGEST).rev() {
            codes[length] = next;
            next = (next + starts[length + 1] as u64) >> 1;
        }
        for length in 1..LONGEST + 2 {
            starts[length] += starts[length - 1];
        }
        let mut symbols: Vec<u32> =
            (0..lengths.len() as u32).filter(|&at| lengths[at as usize] > 0).collect();
        // Stable, so symbols of a length keep their order.
        symbols.sort_by_key(|&at| lengths[at as usize]);
        for symbol in &mut symbols {
            *symbol += first as u32;
        }
        Self { first: codes, starts, symbols, repeats: last as u32 }
    }

    fn symbol(&self, bits: &mut Bits<'_>) -> Result<u32, String> {
        let mut code = 0;
        for length in 1..=LONGEST {
            code = code << 1 | bits.bit()?;
            let among = code.wrapping_sub(self.first[length]);
            if among < (self.starts[length + 1] - self.starts[length]) as u64 {
                return Ok(self.symbols[self.starts[length] + among as usize]);
            }
        }
        Err("its code has bits that stand for nothing".to_owned())
    }

    fn words(&self, bits: &mut Bits<'_>, wanted: usize) -> Result<Vec<u16>, String> {
        let mut words: Vec<u16> = Vec::with_capacity(wanted);
        while words.len() < wanted {
            let symbol = self.symbol(bits)?;
            if symbol != self.repeats {
                words.push(symbol as u16);
                continue;
            }
            let count = bits.number(8)? as usize;
            let last = *words.last().ok_or("its code repeats a word before the first")?;
            if words.len() + count > wanted {
                return Err(format!("its code holds more than {wanted} words"));
            }
            words.extend(std::iter::repeat_n(last, count));
        }
        Ok(words)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Lengths 1, 2, 2 give the codes 1, 00, 01: the longer the code, the smaller its number.
    #[test]
    fn longer_codes_have_smaller_numbers() {
        let code = Code::of(&[2, 1, 0, 2], 5, 8);
        // 1, 00, then 01 and 00000010: the word before it twice more.
        let words = |bytes: &[u8], wanted| code.words(&mut Bits::new(bytes), wanted);
        assert_eq!(words(&[0b1000_1000, 0b0001_0000], 4), Ok(vec![6, 5, 5, 5]));
        assert!(words(&[0b1000_1000, 0b0001_0000], 3).is_err_and(|what| what.contains("more than 3")));
        assert!(words(&[0b0100_0000, 0b0100_0000], 3).is_err_and(|what| what.contains("before the first")));
        assert!(words(&[0b1000_0000], 9).is_err_and(|what| what.contains("too early")));
    }

    #[test]
    fn runs_of_symbols_that_do_not_occur_are_skipped() {
        // Symbol 0 of length 1, a long run of 6 + 3, a short run of 2, symbol 12 of length 1.
        let bits = [(1_u64, 6), (LONG_RUN, 6), (3, 8), (SHORT_RUN, 6), (1, 6)];
        let joined = bits.iter().fold(0, |joined, (number, count)| joined << count | number) << (64 - 32);
        let bytes = u64::to_be_bytes(joined);
        let code = Code::read(&mut Bits::new(&bytes), 0, 12).expect("whole");
        assert_eq!(code.symbols, [0, 12]);
        assert!(Code::read(&mut Bits::new(&bytes), 0, 11).is_ok_and(|code| code.symbols == [0]));
        assert!(Code::read(&mut Bits::new(&bytes), 0, 10).is_err(), "the run goes on beyond the last symbol");
    }
}
