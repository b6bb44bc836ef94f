//! Contour lines as the share of a pixel that they cover.
//!
//! The distance of a pixel to the nearest multiple of the interval is its height above it over its slope, so a
//! line keeps its width on every slope and needs no tracing.

/// Intervals that the automatic choice aims for between the lowest and the highest ground.
const WANTED_INTERVALS: f64 = 14.0;

/// Every fifth line is an index contour.
const INDEX: f32 = 5.0;

/// Lines closer than this many line widths fade out, and are gone at half of it.
const CROWDED: f32 = 5.0;

/// Ground flatter than this share of the interval in a pixel bears no line: it would flood flat ground that
/// lies exactly on a multiple.
const FLAT: f32 = 1.0 / 600.0;

/// Lines at multiples of an interval.
#[derive(Clone, Copy, Debug)]
pub(super) struct Contours {
    /// Metres between neighbouring lines, above 0.
    pub(super) interval: f32,
    /// Lowest ground in metres. It bears no line, even where it is a multiple: plains would be ringed by noise.
    pub(super) lowest: f32,
    /// Width of an ordinary line in pixels.
    pub(super) line: f32,
}

impl Contours {
    /// Share of a pixel covered, and how strongly, at a height and its rise in a pixel.
    #[inline]
    pub(super) fn ink(self, height: f32, rise: f32) -> f32 {
        let plain = self.family(height, rise, self.interval, self.line);
        let index = self.family(height, rise, self.interval * INDEX, self.line * 1.7);
        (0.6 * plain).max(0.9 * index)
    }

    fn family(self, height: f32, rise: f32, interval: f32, width: f32) -> f32 {
        let flat = FLAT * self.interval;
        let nearest = (height / interval).round() * interval;
        if rise <= flat || nearest <= self.lowest + flat {
            return 0.0;
        }
        let cover = (0.5 * width + 0.5 - (height - nearest).abs() / rise).clamp(0.0, 1.0).min(width.max(0.3));
        let crowded = ramp(interval / rise / width, 0.5 * CROWDED, CROWDED);
        cover * crowded * ramp(rise, flat, 4.0 * flat)
    }
}

/// 0 below `low`, 1 above `high`, smooth between.
#[inline]
pub(super) fn ramp(value: f32, low: f32, high: f32) -> f32 {
    let share = ((value - low) / (high - low)).clamp(0.0, 1.0);
    share * share * (3.0 - 2.0 * share)
}

/// An interval of 1, 2 or 5 times a power of ten that cuts `relief` into about ten to fifteen; `None` on flat
/// ground.
pub(super) fn automatic_interval(relief: f64) -> Option<f64> {
    if relief <= 0.0 {
        return None;
    }
    let wanted = relief / WANTED_INTERVALS;
    let decade = libm::pow(10.0, libm::floor(libm::log10(wanted)));
    let series = [1.0, 2.0, 5.0, 10.0].map(|step| step * decade);
    series.into_iter().min_by(|a, b| (a / wanted).max(wanted / a).total_cmp(&(b / wanted).max(wanted / b)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_automatic_interval_is_of_the_one_two_five_series_and_cuts_into_about_a_dozen() {
        for relief in [0.003, 1.0, 37.0, 840.0, 900.0, 8848.0] {
            let interval = automatic_interval(relief).expect("there is relief");
            let mantissa = interval / libm::pow(10.0, libm::floor(libm::log10(interval * 1.000_001)));
            assert!([1.0, 2.0, 5.0].iter().any(|m| (mantissa - m).abs() < 1e-9), "{relief}: {interval}");
            assert!((8.5..=22.5).contains(&(relief / interval)), "{relief}: {}", relief / interval);
        }
        assert_eq!(automatic_interval(0.0), None);
    }

    #[test]
    fn ink_lies_on_multiples_of_the_interval_and_nowhere_else() {
        let contours = Contours { interval: 10.0, lowest: 20.0, line: 1.0 };
        assert!(contours.ink(30.0, 0.5) > 0.4);
        assert!(contours.ink(50.0, 0.5) > contours.ink(30.0, 0.5));
        assert_eq!(contours.ink(34.0, 0.5), 0.0);
        assert_eq!(contours.ink(30.0, 0.0), 0.0);
        assert_eq!(contours.ink(20.0, 0.5), 0.0, "the lowest ground");
    }
}
