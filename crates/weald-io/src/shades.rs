//! How measures are drawn: colours between their least and their greatest value.

/// How colours are spread over values.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Spread {
    /// Evenly, from the least value to the greatest.
    Even,
    /// By the logarithm of values above 0, as suits upslope areas; the first colour is that of 0 and of a millionth of the
    /// greatest value.
    Logarithmic,
    /// About 0, which has the middle colour, equally far to both sides; the nearer 0, the finer.
    Centred,
    /// The same, finer still, where a few values lie hundreds of times as far from 0 as most.
    CentredFar,
    /// Round the compass in degrees, the last colour being the first; values below 0 have no direction.
    Compass,
}

/// Colours of measures.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Shades {
    /// How they are spread.
    pub spread: Spread,
    /// Two colours or more, red, green and blue.
    pub colours: Vec<[u8; 3]>,
}

/// Colour of what has no direction.
const NO_DIRECTION: [u8; 3] = [190, 190, 190];

/// Share of the greatest value from which a logarithmic spread distinguishes values.
const MIN_SHARE: f64 = 1e-6;

impl Shades {
    /// Values and their colours, values rising, from at most the least to at least the greatest value of a raster.
    pub fn stops(&self, (low, high): (f64, f64)) -> Vec<(f64, [u8; 3])> {
        match self.spread {
            Spread::Even => self.evenly([low, if high > low { high } else { low + 1.0 }]),
            Spread::Logarithmic => self.by_logarithm([low, if high > 0.0 { high } else { 1.0 }]),
            Spread::Centred => self.about_0([low, high], 2),
            Spread::CentredFar => self.about_0([low, high], 4),
            Spread::Compass => {
                let nowhere = (low < 0.0).then_some((low, NO_DIRECTION));
                nowhere.into_iter().chain(self.evenly([0.0, 360.0])).collect()
            }
        }
    }

    fn evenly(&self, [low, high]: [f64; 2]) -> Vec<(f64, [u8; 3])> {
        // The last is the greatest value itself, whatever is lost in rounding.
        self.placed(|share| if share < 1.0 { low + share * (high - low) } else { high })
    }

    fn by_logarithm(&self, [low, high]: [f64; 2]) -> Vec<(f64, [u8; 3])> {
        let lowest_shown = high * MIN_SHARE;
        let least = if (lowest_shown..high).contains(&low) { low } else { lowest_shown };
        let below = (low < least).then_some((low, self.colours[0]));
        let value = |share| if share < 1.0 { least * libm::pow(high / least, share) } else { high };
        below.into_iter().chain(self.placed(value)).collect()
    }

    fn about_0(&self, [low, high]: [f64; 2], power: i32) -> Vec<(f64, [u8; 3])> {
        let farthest = low.abs().max(high.abs());
        let most = if farthest > 0.0 { farthest } else { 1.0 };
        self.placed(|share| {
            let side = 2.0 * share - 1.0;
            most * side.signum() * side.abs().powi(power)
        })
    }

    /// Each colour at the value of its share of the way from the first to the last.
    fn placed(&self, value: impl Fn(f64) -> f64) -> Vec<(f64, [u8; 3])> {
        let last = self.colours.len().saturating_sub(1).max(1) as f64;
        let colours = self.colours.iter().enumerate();
        colours.map(|(at, &colour)| (value(at as f64 / last), colour)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn values(spread: Spread, range: (f64, f64)) -> Vec<f64> {
        let shades = Shades { spread, colours: (0..9).map(|at| [at; 3]).collect() };
        let stops = shades.stops(range);
        assert!(stops.windows(2).all(|pair| pair[0].0 < pair[1].0), "{spread:?} {range:?}: {stops:?}");
        stops.into_iter().map(|(value, _)| value).collect()
    }

    #[test]
    fn stops_rise_and_cover_whatever_a_raster_holds() {
        let ranges =
            [(0.0, 0.0), (0.0, 1.0), (-3.0, 8.0), (5.0, 5.0), (-2.0, -1.0), (400.0, 2.5e8), (1e-9, 3e-9)];
        for spread in [Spread::Even, Spread::Logarithmic, Spread::Centred, Spread::CentredFar] {
            for range in ranges {
                let values = values(spread, range);
                let (first, last) = (values[0], values[values.len() - 1]);
                assert!(first <= range.0 && last >= range.1, "{spread:?} {range:?}: {first} to {last}");
            }
        }
        assert_eq!(values(Spread::Compass, (-1.0, 359.0))[..2], [-1.0, 0.0]);
        assert_eq!(values(Spread::Compass, (3.0, 200.0))[8], 360.0);
    }

    #[test]
    fn areas_rise_by_equal_factors_and_curvatures_lie_about_0() {
        let areas = values(Spread::Logarithmic, (4.0e3, 4.0e8));
        let factor = libm::pow(1e5, 0.125);
        assert!(areas.windows(2).all(|pair| (pair[1] / pair[0] - factor).abs() < 1e-9), "{areas:?}");
        assert_eq!(values(Spread::Logarithmic, (0.0, 4.0e8))[..2], [0.0, 400.0]);
        let curvatures = values(Spread::Centred, (-0.02, 0.08));
        assert_eq!((curvatures[0], curvatures[4], curvatures[8]), (-0.08, 0.0, 0.08));
        let far = values(Spread::CentredFar, (-0.02, 0.08));
        assert_eq!((far[0], far[4], far[6], far[8]), (-0.08, 0.0, 0.08 / 16.0, 0.08));
    }
}
