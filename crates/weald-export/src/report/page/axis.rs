//! Axes with ticks at round numbers.

use super::figures::{plain, power_of_ten};

/// Ticks that an axis has about.
const TICKS: f64 = 8.5;

/// A place on an axis that is named.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Tick {
    /// 0 at the beginning of the axis, 1 at its end.
    pub(super) place: f64,
    /// Markup of SVG text.
    pub(super) label: String,
}

/// An axis from one value to another.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Axis {
    /// What it measures, with its unit.
    pub(super) title: String,
    pub(super) ticks: Vec<Tick>,
    low: f64,
    high: f64,
    logarithmic: bool,
}

impl Axis {
    /// Even steps of 1, 2 or 5 times a power of ten, from the one below `low` to the one above `high`.
    pub(super) fn linear(title: &str, low: f64, high: f64) -> Self {
        let step = round_step((high - low).max(1e-9) / TICKS);
        let (first, last) = (libm::floor(low / step + 1e-9), libm::ceil(high / step - 1e-9));
        let last = last.max(first + 1.0);
        let decimals = (-power_of_ten(step)).max(0) as usize;
        let tick = |number: i64| Tick {
            place: (number as f64 - first) / (last - first),
            label: plain(number as f64 * step, decimals),
        };
        let ticks = (first as i64..=last as i64).map(tick).collect();
        Self { title: title.to_owned(), ticks, low: first * step, high: last * step, logarithmic: false }
    }

    /// Powers of ten, from the one below `low` to the one above `high`, both above 0.
    pub(super) fn logarithmic(title: &str, low: f64, high: f64) -> Self {
        let first = libm::floor(libm::log10(low) + 1e-9) as i32;
        let last = (libm::ceil(libm::log10(high) - 1e-9) as i32).max(first + 1);
        let tick = |power: i32| Tick {
            place: f64::from(power - first) / f64::from(last - first),
            label: power_label(power),
        };
        Self {
            title: title.to_owned(),
            ticks: (first..=last).map(tick).collect(),
            low: f64::from(first),
            high: f64::from(last),
            logarithmic: true,
        }
    }

    /// Where a value lies, 0 to 1 within the axis.
    pub(super) fn place(&self, value: f64) -> f64 {
        let value = if self.logarithmic { libm::log10(value) } else { value };
        (value - self.low) / (self.high - self.low)
    }
}

/// The least of 1, 2 and 5 times a power of ten that is no less than `step`.
pub(super) fn round_step(step: f64) -> f64 {
    let power = libm::exp10(f64::from(power_of_ten(step)));
    let times = [1.0, 2.0, 5.0].into_iter().find(|times| times * power >= step * (1.0 - 1e-9));
    times.unwrap_or(10.0) * power
}

fn power_label(power: i32) -> String {
    match power {
        0..=3 => plain(libm::exp10(f64::from(power)), 0),
        -2..=-1 => plain(libm::exp10(f64::from(power)), 2),
        _ => format!("10<tspan class=\"power\" dy=\"-5\">{}</tspan>", power.to_string().replace('-', "−")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(axis: &Axis) -> Vec<&str> {
        axis.ticks.iter().map(|tick| tick.label.as_str()).collect()
    }

    #[test]
    fn ticks_stand_at_round_numbers_around_the_values() {
        assert_eq!(labels(&Axis::linear("m", 130.0, 988.0)), ["0", "200", "400", "600", "800", "1000"]);
        assert_eq!(
            labels(&Axis::linear("m", -0.31, 0.22)),
            ["−0.4", "−0.3", "−0.2", "−0.1", "0", "0.1", "0.2", "0.3"]
        );
        assert_eq!(labels(&Axis::logarithmic("m²", 300.0, 2.0e4))[..2], ["100", "1000"]);
    }

    #[test]
    fn a_value_lies_in_its_place() {
        let (linear, powers) = (Axis::linear("", 0.0, 100.0), Axis::logarithmic("", 1.0, 1.0e4));
        assert!((linear.place(25.0) - 0.25).abs() < 1e-12);
        assert!((powers.place(100.0) - 0.5).abs() < 1e-12);
        assert_eq!(labels(&Axis::linear("", 5.0, 5.0)).len(), 2, "a single value has an axis too");
    }
}
