//! Round numbers along a scale: multiples of 1, 2 or 5 times a power of ten, or the powers themselves.

/// Intervals that a scale is cut into, at most about so many.
const WANTED: f64 = 6.0;

/// A logarithmic scale of fewer decades also has the 2 and the 5 of each.
const FEW_DECADES: f64 = 2.5;

/// Numbers from here on, or below, are written with a power of ten.
const LARGE: f64 = 1e6;
const SMALL: f64 = 1e-4;

/// Numbers along a scale: the place of each, 0 to 1, and how it is written.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Ticks(pub(super) Vec<(f64, String)>);

impl Ticks {
    /// Numbers on an even scale from `low` to `high`.
    pub(super) fn linear([low, high]: [f64; 2]) -> Self {
        let width = high - low;
        if !width.is_finite() || width == 0.0 {
            return Self(vec![(0.0, written(low, 0.0))]);
        }
        let step = step(width.abs() / WANTED);
        let [first, last] =
            [libm::ceil(low.min(high) / step - 1e-9), libm::floor(low.max(high) / step + 1e-9)];
        let count = (last - first).max(0.0) as usize;
        let tick = |k: usize| {
            let value = (first + k as f64) * step;
            ((value - low) / width, written(value, step))
        };
        Self((0..=count).map(tick).collect())
    }

    /// Numbers on a scale on which every decade takes the same length; both ends are above 0.
    pub(super) fn logarithmic([low, high]: [f64; 2]) -> Self {
        if low <= 0.0 || high <= low || !high.is_finite() {
            return Self::linear([low, high]);
        }
        let [bottom, top] = [low, high].map(libm::log10);
        let mantissas: &[f64] = if top - bottom < FEW_DECADES { &[1.0, 2.0, 5.0] } else { &[1.0] };
        let stride = libm::ceil((top - bottom) / (2.0 * WANTED)).max(1.0) as i32;
        let decades =
            (libm::floor(bottom) as i32..=libm::ceil(top) as i32).filter(|decade| decade % stride == 0);
        let values =
            decades.flat_map(|decade| mantissas.iter().map(move |m| m * libm::pow(10.0, f64::from(decade))));
        let place = |value: f64| (libm::log10(value) - bottom) / (top - bottom);
        let within = values.filter(|&value| (-1e-9..=1.0 + 1e-9).contains(&place(value)));
        Self(within.map(|value| (place(value), written(value, value))).collect())
    }
}

/// The smallest step of the series 1, 2, 5 that is at least `least`.
pub(super) fn step(least: f64) -> f64 {
    let decade = libm::pow(10.0, libm::floor(libm::log10(least)));
    let series = [1.0, 2.0, 5.0].map(|step| step * decade);
    series.into_iter().find(|step| *step >= least * (1.0 - 1e-9)).unwrap_or(10.0 * decade)
}

/// A multiple of `step` in as many figures as it needs.
fn written(value: f64, step: f64) -> String {
    let size = value.abs().max(step.abs());
    if value == 0.0 {
        return "0".to_owned();
    }
    let sign = if value < 0.0 { "−" } else { "" };
    if !(SMALL..LARGE).contains(&size) {
        return format!("{sign}{}", with_power(value.abs()));
    }
    let places = if step > 0.0 { libm::ceil(-libm::log10(step) - 1e-9).max(0.0) as usize } else { 3 };
    format!("{sign}{:.places$}", value.abs())
}

/// A number as a mantissa of at most three figures and a power of ten.
fn with_power(value: f64) -> String {
    let exponent = libm::floor(libm::log10(value) + 1e-9);
    let mantissa = format!("{:.2}", value / libm::pow(10.0, exponent));
    let mantissa = mantissa.trim_end_matches('0').trim_end_matches('.');
    let raised = |figure: char| match figure {
        '-' => '⁻',
        figure => figure.to_digit(10).and_then(|at| "⁰¹²³⁴⁵⁶⁷⁸⁹".chars().nth(at as usize)).unwrap_or(figure),
    };
    let power: String = format!("{exponent}").chars().map(raised).collect();
    if mantissa == "1" { format!("10{power}") } else { format!("{mantissa}·10{power}") }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn words(ticks: &Ticks) -> Vec<&str> {
        ticks.0.iter().map(|(_, text)| text.as_str()).collect()
    }

    #[test]
    fn numbers_are_round_and_lie_where_they_belong() {
        let ticks = Ticks::linear([-93.3, 1573.3]);
        assert_eq!(words(&ticks), ["0", "500", "1000", "1500"]);
        assert!((ticks.0[1].0 - (500.0 + 93.3) / (1573.3 + 93.3)).abs() < 1e-12);
        assert_eq!(
            words(&Ticks::linear([0.0, 0.05])),
            ["0.00", "0.01", "0.02", "0.03", "0.04", "0.05"].map(|t| if t == "0.00" { "0" } else { t })
        );
        assert_eq!(words(&Ticks::linear([-2.0, 2.0])), ["−2", "−1", "0", "1", "2"]);
        assert_eq!(words(&Ticks::linear([7.0, 7.0])), ["7.000"]);
        assert_eq!(words(&Ticks::linear([0.0, 5e7])), ["0", "10⁷", "2·10⁷", "3·10⁷", "4·10⁷", "5·10⁷"]);
    }

    #[test]
    fn a_logarithmic_scale_has_its_powers_of_ten() {
        assert_eq!(words(&Ticks::logarithmic([2.5, 25_000.0])), ["10", "100", "1000", "10000"]);
        assert_eq!(words(&Ticks::logarithmic([1.0, 50.0])), ["1", "2", "5", "10", "20", "50"]);
        assert_eq!(words(&Ticks::logarithmic([1e-7, 1e-3])), ["10⁻⁷", "10⁻⁶", "10⁻⁵", "0.0001", "0.001"]);
        let ticks = Ticks::logarithmic([1.0, 1e4]);
        assert!(
            ticks
                .0
                .iter()
                .zip([0.0, 0.25, 0.5, 0.75, 1.0])
                .all(|((place, _), expected)| (place - expected).abs() < 1e-12)
        );
    }

    proptest! {
        #[test]
        fn every_scale_has_a_few_rising_numbers(low in -1e7_f64..1e7, width in 1e-4_f64..1e7) {
            let ticks = Ticks::linear([low, low + width]).0;
            prop_assert!((2..=8).contains(&ticks.len()), "{ticks:?}");
            prop_assert!(ticks.windows(2).all(|pair| pair[1].0 > pair[0].0));
            prop_assert!(ticks.iter().all(|(place, _)| (-1e-6..=1.0 + 1e-6).contains(place)));
        }
    }
}
