//! Directions of flow in the numbers of other programs.
//!
//! ```text
//!           Weald      ESRI         TauDEM   GRASS    RichDEM
//!           6 7 8   32 64 128       4 3 2    3 2 1    2 3 4
//!           5 · 1   16  ·   1       5 · 1    4 · 8    1 · 5
//!           4 3 2    8  4   2       6 7 8    5 6 7    8 7 6
//! ```
//!
//! ESRI's are those of `ArcGIS` ("How Flow Direction works") and of pysheds; `TauDEM`'s are those of its `D8FlowDir`; those
//! of GRASS are of `r.watershed`, and those of `RichDEM` of its D8.
//! Outlets and the sea are 0 in all but Weald's own.

use super::directions::SEA;

weald_core::choices! {
    /// Whose numbers directions of flow have.
    pub enum DirectionCodes {
        /// 1 east, 2 south-east, and on clockwise to 8 north-east; 0 outlet, 9 sea.
        Weald = "weald",
        /// 1 east, 2 south-east, 4 south, and on clockwise to 128 north-east; 0 outlet or sea. Also those of pysheds.
        Esri = "esri",
        /// 1 east, 2 north-east, and on anticlockwise to 8 south-east; 0 outlet or sea.
        TauDem = "taudem",
        /// 1 north-east, 2 north, and on anticlockwise to 8 east; 0 outlet or sea.
        Grass = "grass",
        /// 1 west, 2 north-west, and on clockwise to 8 south-west; 0 outlet or sea.
        RichDem = "richdem",
    }
}

impl DirectionCodes {
    /// Numbers of the eight neighbours from east over south, as Weald counts them.
    fn clockwise_from_east(self) -> [u8; 8] {
        match self {
            Self::Weald => [1, 2, 3, 4, 5, 6, 7, 8],
            Self::Esri => [1, 2, 4, 8, 16, 32, 64, 128],
            Self::TauDem => [1, 8, 7, 6, 5, 4, 3, 2],
            Self::Grass => [8, 7, 6, 5, 4, 3, 2, 1],
            Self::RichDem => [5, 6, 7, 8, 1, 2, 3, 4],
        }
    }

    /// The number for one of Weald's own codes.
    pub fn number(self, own: u8) -> u8 {
        match own {
            1..=8 => self.clockwise_from_east()[usize::from(own) - 1],
            SEA if self == Self::Weald => SEA,
            _ => 0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::flow::directions::STEPS;

    /// Angles anticlockwise from east, by which GRASS and `TauDEM` count; neighbours of `RichDEM` and pysheds as their sources
    /// list them, as columns eastward and rows southward.
    #[test]
    fn numbers_are_those_of_the_other_programs() {
        const RICHDEM: [(isize, isize); 8] =
            [(-1, 0), (-1, -1), (0, -1), (1, -1), (1, 0), (1, 1), (0, 1), (-1, 1)];
        const PYSHEDS: [(u8, (isize, isize)); 8] = [
            (64, (0, -1)),
            (128, (1, -1)),
            (1, (1, 0)),
            (2, (1, 1)),
            (4, (0, 1)),
            (8, (-1, 1)),
            (16, (-1, 0)),
            (32, (-1, -1)),
        ];
        for (own, step) in (1..).zip(STEPS) {
            let eighth = (8 + 1 - own) % 8; // anticlockwise from east
            assert_eq!(DirectionCodes::TauDem.number(own), eighth + 1);
            assert_eq!(DirectionCodes::Grass.number(own), if eighth == 0 { 8 } else { eighth });
            assert_eq!(RICHDEM[usize::from(DirectionCodes::RichDem.number(own)) - 1], step);
            assert!(PYSHEDS.contains(&(DirectionCodes::Esri.number(own), step)), "{own}");
            assert_eq!(DirectionCodes::Weald.number(own), own);
        }
        assert_eq!([0, 9].map(|own| DirectionCodes::Weald.number(own)), [0, 9]);
        assert_eq!([0, 9].map(|own| DirectionCodes::Esri.number(own)), [0, 0]);
    }
}
