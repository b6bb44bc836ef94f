//! Numbers as people read them.

/// Narrow space between thousands, which does not break.
const THIN: char = '\u{202f}';

/// Digits of which the first is not 0.
const DIGITS: i32 = 4;

/// A number to four digits as markup: thousands apart, very large and very small ones with a power of ten.
pub(super) fn number(value: f64) -> String {
    if value == 0.0 {
        return "0".to_owned();
    }
    if !value.is_finite() {
        return "–".to_owned();
    }
    let power = power_of_ten(value);
    if (-4..7).contains(&power) {
        return plain(value, (DIGITS - 1 - power).clamp(0, 7) as usize);
    }
    let scaled = format!("{value:.*e}", DIGITS as usize - 1);
    let (digits, power) = scaled.split_once('e').unwrap_or((&scaled, "0"));
    format!("{} × 10<sup>{}</sup>", minus(trimmed(digits)), minus(power))
}

/// A number to three digits, for legends.
pub(super) fn rough(value: f64) -> String {
    if value == 0.0 || !value.is_finite() {
        return number(value);
    }
    let unit = libm::exp10(f64::from(power_of_ten(value) - 2));
    number(libm::round(value / unit) * unit)
}

/// A whole number with its thousands apart.
pub(super) fn count(value: u64) -> String {
    grouped(&value.to_string())
}

/// A number with so many digits behind the point and no zeros at their end.
pub(super) fn plain(value: f64, decimals: usize) -> String {
    let shown = format!("{value:.decimals$}");
    let shown = trimmed(&shown);
    let (whole, part) = shown.split_once('.').map_or((shown, None), |(whole, part)| (whole, Some(part)));
    let whole = minus(&grouped(whole));
    // A negative number that rounds to nothing is nothing.
    let whole = if whole == "−0" && part.is_none() { "0".to_owned() } else { whole };
    part.map_or(whole.clone(), |part| format!("{whole}.{part}"))
}

/// The power of ten below or at a number other than 0.
pub(super) fn power_of_ten(value: f64) -> i32 {
    // A power of ten itself may miss its logarithm by the last digit.
    libm::floor(libm::log10(value.abs()) + 1e-12) as i32
}

fn trimmed(digits: &str) -> &str {
    if digits.contains('.') { digits.trim_end_matches('0').trim_end_matches('.') } else { digits }
}

fn minus(digits: &str) -> String {
    digits.replace('-', "−")
}

fn grouped(digits: &str) -> String {
    let (sign, digits) = digits.strip_prefix('-').map_or(("", digits), |digits| ("-", digits));
    // Four digits read well in one piece.
    if digits.len() < 5 {
        return format!("{sign}{digits}");
    }
    let mut grouped = String::from(sign);
    for (place, digit) in digits.chars().enumerate() {
        if place > 0 && (digits.len() - place).is_multiple_of(3) {
            grouped.push(THIN);
        }
        grouped.push(digit);
    }
    grouped
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_four_digits_thousands_apart_and_powers_where_they_are_long() {
        let shown = [0.0, 1234.56, -0.123_456, 1_234_567.0, 2.0e9, 1.5e-7, -3.0e-9, 20.0].map(number);
        let expected = [
            "0",
            "1235",
            "−0.1235",
            "1\u{202f}234\u{202f}567",
            "2 × 10<sup>9</sup>",
            "1.5 × 10<sup>−7</sup>",
            "−3 × 10<sup>−9</sup>",
            "20",
        ];
        assert_eq!(shown, expected);
        assert_eq!(
            (count(1000), count(12_345_678)),
            ("1000".to_owned(), "12\u{202f}345\u{202f}678".to_owned())
        );
        assert_eq!(plain(-0.001, 1), "0");
        assert_eq!([179.9, 0.012_345, -15_963.0].map(rough), ["180", "0.0123", "−16\u{202f}000"]);
    }

    #[test]
    fn powers_of_ten_are_their_own_and_stand_below_all_up_to_the_next() {
        for power in -12..=15 {
            let exactly = 10_f64.powi(power);
            assert_eq!([exactly, -exactly, 9.9 * exactly].map(power_of_ten), [power; 3]);
        }
    }
}
