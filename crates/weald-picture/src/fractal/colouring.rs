//! The colour of a point from its code.
//!
//! A colour runs along with the game, `c ← c + s_m (c_m - c)`: each map pulls it toward its own colour, so that the
//! coarsest digit counts most and parts of parts differ ever more finely. Source: Draves and Reckase 2003, "The
//! fractal flame algorithm", section 4, with the speeds `s_m` of flam3. A trunk pulls little, or the parts along an
//! axis would all look as the first.

use weald_plants::ifs::lanes::LANES;
use weald_plants::ifs::{Block, Code, Ifs, Role};

weald_core::choices! {
    /// What a colour tells.
    pub enum ColourBy {
        /// The whole code: parts of parts in ever finer shades.
        Code = "code",
        /// The map that was taken last: the largest parts, one colour each.
        Map = "map",
        /// Nothing: one ink.
        Ink = "ink",
    }
}

/// Where a map pulls the colour, 0 to 65535, and what share of the way, in 256ths.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Pull {
    toward: i32,
    speed: i32,
}

impl Pull {
    #[inline]
    fn on(self, colour: i32) -> i32 {
        colour + (((self.toward - colour) * self.speed) >> 8)
    }
}

/// Colours of the codes of one fractal.
#[derive(Clone, Debug)]
pub(super) struct Colouring {
    pulls: Vec<Pull>,
    /// Digits of a code.
    history: usize,
}

/// Colours of lanes as the game goes on.
pub(super) struct Running<'a> {
    colouring: &'a Colouring,
    lanes: Option<[i32; LANES]>,
}

impl Colouring {
    pub(super) fn new(ifs: &Ifs, by: ColourBy) -> Self {
        let roles: Vec<Role> = ifs.maps().iter().map(|weighted| weighted.role).collect();
        let is_plant = roles.contains(&Role::Trunk) || roles.contains(&Role::Stem);
        let pull = |map: usize| match by {
            ColourBy::Code if is_plant => of_role(&roles, map),
            ColourBy::Code => Pull { toward: spread(map, roles.len()), speed: 128 },
            ColourBy::Map => Pull { toward: spread(map, roles.len()), speed: 256 },
            ColourBy::Ink => Pull { toward: 0, speed: 256 },
        };
        Self { pulls: (0..roles.len()).map(pull).collect(), history: ifs.code_digits() }
    }

    pub(super) fn running(&self) -> Running<'_> {
        Running { colouring: self, lanes: None }
    }

    /// The colour of a code, 0 to 65535.
    pub(super) fn of(&self, code: &Code) -> u16 {
        self.after(code.digits().rev())
    }

    /// The colour after maps in the order in which they were taken.
    fn after(&self, maps: impl Iterator<Item = u8>) -> u16 {
        maps.fold(MIDDLE, |colour, map| self.pulls[usize::from(map)].on(colour)) as u16
    }
}

/// The colour that all begin with.
const MIDDLE: i32 = 1 << 15;

/// Places of maps from 0 to 65535.
fn spread(map: usize, maps: usize) -> i32 {
    (65535 * map / (maps - 1)) as i32
}

/// Of a plant: stems are darkest, what a trunk carries grows lighter, branches have shades in turn.
fn of_role(roles: &[Role], map: usize) -> Pull {
    let branches = roles.iter().filter(|&&role| role == Role::Branch).count();
    let earlier = roles[..map].iter().filter(|&&role| role == Role::Branch).count();
    match roles[map] {
        Role::Stem => Pull { toward: 0, speed: 200 },
        Role::Trunk => Pull { toward: 65535, speed: 12 },
        Role::Branch => {
            let share = if branches > 1 { earlier as f64 / (branches - 1) as f64 } else { 0.5 };
            Pull { toward: (65535.0 * (0.3 + 0.4 * share)) as i32, speed: 96 }
        }
    }
}

impl Running<'_> {
    /// The colours of a row of the next block of a chunk; rows must come in their order.
    #[inline]
    pub(super) fn row(&mut self, block: &Block, row: usize) -> [u16; LANES] {
        let colouring = self.colouring;
        let taken = block.coarsest(row);
        let history = colouring.history;
        let lanes = self.lanes.get_or_insert_with(|| {
            let before = |lane| (1..=history).rev().map(move |place| block.digit(row * LANES + lane, place));
            std::array::from_fn(|lane| i32::from(colouring.after(before(lane))))
        });
        for (colour, &map) in lanes.iter_mut().zip(taken) {
            *colour = colouring.pulls[usize::from(map)].on(*colour);
        }
        lanes.map(|colour| colour as u16)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use weald_plants::ifs::{Game, shapes};

    #[test]
    fn the_colour_that_runs_along_is_that_of_the_code() {
        for name in ["fern", "dragon", "conifer"] {
            let ifs = shapes::find(name).expect("built in").ifs();
            let colouring = Colouring::new(&ifs, ColourBy::Code);
            let (mut running, mut worst, mut seen) = (colouring.running(), 0, [u16::MAX, 0]);
            Game::new(&ifs, 1).points(20_000, |block| {
                for row in 0..block.rows().len() {
                    let colours = running.row(block, row);
                    let numbers = row * LANES..block.len();
                    for (number, colour) in numbers.zip(colours) {
                        let of_code = colouring.of(&block.code(number, &ifs));
                        worst = worst.max(of_code.abs_diff(colour));
                        seen = [seen[0].min(of_code), seen[1].max(of_code)];
                    }
                }
            });
            assert!(seen[1] - seen[0] > 20_000, "{name}: {seen:?}");
            // A trunk pulls so little that a colour remembers more than a code.
            let precise = if name == "dragon" { 2 } else { 3_500 };
            assert!(worst <= precise, "{name}: {worst}");
        }
    }

    #[test]
    fn by_map_every_part_has_one_colour() {
        let ifs = shapes::find("gasket").expect("built in").ifs();
        let colouring = Colouring::new(&ifs, ColourBy::Map);
        let of = |text| colouring.of(&Code::parse(ifs.digits(), text).expect("digits"));
        assert_eq!([of("0"), of("1"), of("211"), of("2")], [0, 32767, 65535, 65535]);
    }
}
