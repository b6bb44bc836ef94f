//! An iterated function system: maps that contract, how often each is taken, and the set that is its own image,
//! `S = ∪ F_i(S)`.
//!
//! Sources: Hutchinson 1981, doi 10.1512/iumj.1981.30.30055 (the set exists and is one); Barnsley 1988, "Fractals
//! everywhere" (random iteration, probabilities). The fixed point of map 0 is where codes end: a code is followed
//! by digit 0 for ever, and a plant's map 0 is its stem, so that this point is its root and the image of the root
//! under a part's code is the **joint** by which the part hangs on the rest.

use super::code::{Code, Digits, MAX_MAPS};
use super::map::{Map, Point};
use super::support::{self, Copies};

/// What a map makes of a plant, for the wind.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Role {
    /// The stem between two joints: it goes where its part goes and does not turn in it.
    Stem,
    /// What goes on along the axis: bends slowly.
    Trunk,
    /// A branch, frond or leaf: quicker and less than what carries it.
    #[default]
    Branch,
}

impl Role {
    /// Its number in tables of vectors and shaders.
    pub(super) const fn number(self) -> u8 {
        match self {
            Self::Stem => 0,
            Self::Trunk => 1,
            Self::Branch => 2,
        }
    }
}

/// A map with its share of the points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Weighted {
    /// The map.
    pub map: Map,
    /// Share of the points that random iteration gives it, 0 to 1.
    pub probability: f64,
    /// What it makes of a plant.
    pub role: Role,
}

/// A fractal as written, not yet checked.
#[derive(Clone, Debug, PartialEq)]
pub struct Draft {
    /// Its name, for messages and files.
    pub name: String,
    /// Its maps, in the order of their digits.
    pub maps: Vec<Weighted>,
    /// Digits of a point's code; `None` takes what a precision of 1e-4 of its size needs, as far as there is room.
    pub code_digits: Option<usize>,
}

/// Why a system of maps is no fractal.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum IfsFault {
    /// Too few maps.
    #[error("a fractal needs at least 2 maps and has {0}")]
    TooFew(usize),
    /// Too many maps.
    #[error("a fractal of {0} maps is too large; a digit of a code names at most {MAX_MAPS}")]
    TooMany(usize),
    /// A number that is none.
    #[error("map {0} has a number that is not finite")]
    NotFinite(usize),
    /// A map that does not contract, nor do maps in a row.
    #[error(
        "map {map} does not contract: it lengthens by {ratio:.4}, and maps in a row do too; \
         each must bring points closer, by a ratio of at most {SLOWEST}"
    )]
    NotContracting {
        /// Number of the map.
        map: usize,
        /// Its greatest singular value.
        ratio: f64,
    },
    /// Numbers so large that the points have none.
    #[error("its points lie beyond what numbers hold; choose smaller offsets")]
    Boundless,
    /// A probability out of range.
    #[error("the probability of map {map} is {value}; it must be above 0 and at most 1")]
    Probability {
        /// Number of the map.
        map: usize,
        /// Its probability.
        value: f64,
    },
    /// Probabilities that do not sum to 1.
    #[error(
        "the probabilities sum to {sum}, not to 1; divide each by their sum, or leave all of them out",
        sum = without_rounding(*.0)
    )]
    ProbabilitySum(f64),
    /// Codes longer than the packing.
    #[error("codes of {digits} digits do not fit: with {maps} maps a code holds 1 to {room}")]
    CodeLength {
        /// Digits that were asked for.
        digits: usize,
        /// Number of maps.
        maps: usize,
        /// Digits that fit.
        room: usize,
    },
}

impl IfsFault {
    /// Number of the map that is to be mended, where it is one.
    pub fn map(&self) -> Option<usize> {
        match *self {
            Self::NotFinite(map) | Self::NotContracting { map, .. } | Self::Probability { map, .. } => {
                Some(map)
            }
            _ => None,
        }
    }
}

/// How fast words of maps contract.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Contraction {
    /// Greatest ratio of one map; 1 or more where only words of several contract.
    single: f64,
    /// Length of words all of which contract.
    word: usize,
    /// Greatest ratio of such a word.
    ratio: f64,
}

/// Ratio of the slowest maps, or words of maps, that count as contracting: closer to 1, codes would need more digits than
/// they have, and the box of the fractal more steps than anyone waits for.
const SLOWEST: f64 = 0.999;

/// Least share that random iteration can tell apart.
pub const MIN_PROBABILITY: f64 = 1.0 / 65536.0;

/// A checked fractal.
#[derive(Clone, Debug, PartialEq)]
pub struct Ifs {
    name: String,
    maps: Vec<Weighted>,
    digits: Digits,
    code_digits: usize,
    contraction: Contraction,
    root: Point,
    bounds: [Point; 2],
}

impl Ifs {
    /// Checks a draft, and finds the box that the fractal fills.
    ///
    /// # Errors
    /// [`IfsFault`], the first that is found.
    pub fn new(draft: Draft) -> Result<Self, IfsFault> {
        let count = draft.maps.len();
        if count < 2 {
            return Err(IfsFault::TooFew(count));
        }
        let digits = Digits::of(count).ok_or(IfsFault::TooMany(count))?;
        if let Some(map) = draft.maps.iter().position(|weighted| !weighted.map.is_finite()) {
            return Err(IfsFault::NotFinite(map));
        }
        check_probabilities(&draft.maps)?;
        let maps: Vec<Map> = draft.maps.iter().map(|weighted| weighted.map).collect();
        let contraction = contraction(&maps)?;
        let root = maps[0].fixed_point().ok_or(IfsFault::NotFinite(0))?;
        let mut ifs = Self {
            name: draft.name,
            maps: draft.maps,
            digits,
            code_digits: 1,
            contraction,
            root,
            bounds: [root; 2],
        };
        ifs.bounds = support::bounds(&Copies { maps: &maps, root, ball: ifs.ball() });
        if !ifs.diameter().is_finite() {
            return Err(IfsFault::Boundless);
        }
        ifs.code_digits = ifs.checked_length(draft.code_digits)?;
        Ok(ifs)
    }

    fn checked_length(&self, wanted: Option<usize>) -> Result<usize, IfsFault> {
        let room = self.digits.room();
        match wanted {
            Some(digits) if digits == 0 || digits > room => {
                Err(IfsFault::CodeLength { digits, maps: self.maps.len(), room })
            }
            Some(digits) => Ok(digits),
            None => Ok((1..room).find(|&digits| self.ratio_of(digits) <= 1e-4).unwrap_or(room)),
        }
    }

    /// Its name.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Its maps with their probabilities, which sum to 1, in the order of their digits.
    pub fn maps(&self) -> &[Weighted] {
        &self.maps
    }

    /// One map.
    #[inline]
    pub fn map(&self, digit: u8) -> &Map {
        &self.maps[usize::from(digit)].map
    }

    /// Its digits.
    pub fn digits(&self) -> Digits {
        self.digits
    }

    /// Digits of its points' codes.
    pub fn code_digits(&self) -> usize {
        self.code_digits
    }

    /// Whether it lies in the plane z = 0.
    pub fn is_planar(&self) -> bool {
        self.maps.iter().all(|weighted| weighted.map.is_planar())
    }

    /// The fixed point of map 0, with which every code ends: the root of a plant.
    pub fn root(&self) -> Point {
        self.root
    }

    /// Least and greatest coordinates of its points.
    pub fn bounds(&self) -> [Point; 2] {
        self.bounds
    }

    /// The diagonal of its box: no two of its points are further apart.
    pub fn diameter(&self) -> f64 {
        super::map::distance(self.bounds[0], self.bounds[1])
    }

    /// The point of a code.
    #[inline]
    pub fn point(&self, code: &Code) -> Point {
        code.digits().rev().fold(self.root, |point, digit| self.map(digit).at(point))
    }

    /// The map of a part: that of its first digit after that of its second, and so on.
    pub fn part(&self, code: &Code) -> Map {
        code.digits().fold(Map::IDENTITY, |part, digit| part.after(self.map(digit)))
    }

    /// Bound on the size of a part of so many digits, as a share of the whole: the product of the greatest ratios.
    pub fn ratio_of(&self, digits: usize) -> f64 {
        let Contraction { single, word, ratio } = self.contraction;
        let power = |base: f64, times: usize| (0..times).fold(1.0, |product, _| product * base);
        let by_words = power(ratio, digits / word) * power(single.max(1.0), digits % word);
        if single < 1.0 { power(single, digits) } else { by_words }
    }

    /// How far a point of a code of so many digits may lie from the point that it stands for.
    pub fn precision(&self, digits: usize) -> f64 {
        self.ratio_of(digits) * self.diameter()
    }

    /// The same shape in other units: every point becomes `scale x + shift`.
    #[must_use]
    pub fn in_units(&self, scale: f64, shift: Point) -> Self {
        let mut other = self.clone();
        for weighted in &mut other.maps {
            weighted.map = weighted.map.conjugate(scale, shift);
        }
        let seen = |p: Point| std::array::from_fn(|i| scale * p[i] + shift[i]);
        other.root = other.maps[0].map.fixed_point().unwrap_or_else(|| seen(self.root));
        other.bounds = self.bounds.map(seen);
        other
    }

    /// A ball that holds all its points.
    pub(super) fn ball(&self) -> (Point, f64) {
        let maps: Vec<Map> = self.maps.iter().map(|weighted| weighted.map).collect();
        let words = words(&maps, self.contraction.word);
        let needed =
            words.iter().map(|map| super::map::distance(map.at(self.root), self.root) / (1.0 - map.ratio()));
        (self.root, needed.fold(0.0, f64::max))
    }
}

/// Tolerance of the sum of probabilities, for numbers as people print them.
const SUM_TOLERANCE: f64 = 1e-6;

fn check_probabilities(maps: &[Weighted]) -> Result<(), IfsFault> {
    let wrong = |weighted: &Weighted| !(weighted.probability > 0.0 && weighted.probability <= 1.0);
    if let Some(map) = maps.iter().position(wrong) {
        return Err(IfsFault::Probability { map, value: maps[map].probability });
    }
    let sum: f64 = maps.iter().map(|weighted| weighted.probability).sum();
    if (sum - 1.0).abs() > SUM_TOLERANCE { Err(IfsFault::ProbabilitySum(sum)) } else { Ok(()) }
}

/// Most words that are looked at to see whether maps contract in a row.
const MAX_WORDS: usize = 65_536;

/// The shortest words all of which contract.
fn contraction(maps: &[Map]) -> Result<Contraction, IfsFault> {
    let greatest = |maps: &[Map]| maps.iter().map(Map::ratio).fold(0.0, f64::max);
    let single = greatest(maps);
    let mut word = 1;
    let mut powers = vec![Map::IDENTITY; maps.len()];
    while maps.len().checked_pow(word).is_some_and(|count| count <= MAX_WORDS) {
        powers = powers.iter().zip(maps).map(|(power, map)| power.after(map)).collect();
        // Words of one map alone are few, and where they do not contract the others need no look.
        if greatest(&powers) <= SLOWEST {
            let ratio = greatest(&words(maps, word as usize));
            if ratio <= SLOWEST {
                return Ok(Contraction { single, word: word as usize, ratio });
            }
        }
        word += 1;
    }
    let map = maps.iter().position(|map| map.ratio() > SLOWEST).unwrap_or(0);
    Err(IfsFault::NotContracting { map, ratio: maps[map].ratio() })
}

/// All maps of words of so many digits.
fn words(maps: &[Map], length: usize) -> Vec<Map> {
    let longer =
        |words: Vec<Map>| words.iter().flat_map(|word| maps.iter().map(|map| word.after(map))).collect();
    (0..length).fold(vec![Map::IDENTITY], |words, _| longer(words))
}

/// Shares by how much area or volume each map keeps, none below a hundredth: the density of the points is then
/// even (Barnsley 1988, section III.8).
pub fn even_probabilities(maps: &[Map]) -> Vec<f64> {
    let sizes: Vec<f64> = maps.iter().map(|map| map.determinant().abs()).collect();
    let total: f64 = sizes.iter().sum();
    let floor = 0.01 / maps.len().min(50) as f64;
    let shares: Vec<f64> =
        sizes.iter().map(|size| (size / total.max(f64::MIN_POSITIVE)).max(floor)).collect();
    let sum: f64 = shares.iter().sum();
    shares.iter().map(|share| share / sum).collect()
}

/// A sum as one would write it by hand.
fn without_rounding(sum: f64) -> f64 {
    const DIGITS: f64 = 1e9;
    (sum * DIGITS).round() / DIGITS
}
