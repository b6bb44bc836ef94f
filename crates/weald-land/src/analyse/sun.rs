//! Where the sun stands and what comes through clear air.
//!
//! ```text
//! Γ = 2π (day - 1) / 365
//! δ = 0.006918 - 0.399912 cos Γ + 0.070257 sin Γ - 0.006758 cos 2Γ + 0.000907 sin 2Γ - 0.002697 cos 3Γ + 0.00148 sin 3Γ
//! E = 1.000110 + 0.034221 cos Γ + 0.001280 sin Γ + 0.000719 cos 2Γ + 0.000077 sin 2Γ
//! sin a = sin φ sin δ + cos φ cos δ cos ω
//! ```
//!
//! declination δ and distance factor E: Spencer 1971, "Fourier series representation of the position of the sun",
//! Search 2 (5), 172; the altitude a at latitude φ and hour angle ω: Iqbal 1983, "An Introduction to Solar
//! Radiation", doi 10.1016/B978-0-12-373750-2.X5001-0. A beam of 1361 W/m² (Kopp and Lean 2011, doi
//! 10.1029/2010GL045777) keeps τ^m of itself through the air mass m of Kasten and Young 1989, doi
//! 10.1364/AO.28.004735; of what comes from above, 0.271 - 0.294 τ^m is scattered light of the sky (Liu and Jordan
//! 1960, doi 10.1016/0038-092X(60)90062-1). A year is the twelve days of Klein 1977, doi
//! 10.1016/0038-092X(77)90001-9, each for its month. Time is solar time.

use std::f64::consts::PI;

/// Power on a surface that faces the sun outside the air, at the mean distance, in W/m².
const SOLAR_CONSTANT: f64 = 1361.0;

/// The mean day of each month and the days of that month.
const MONTHS: [(u32, u32); 12] = [
    (17, 31),
    (47, 28),
    (75, 31),
    (105, 30),
    (135, 31),
    (162, 30),
    (198, 31),
    (228, 31),
    (258, 30),
    (288, 31),
    (318, 30),
    (344, 31),
];

/// The sun for a short time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Sun {
    /// Unit vector to the sun: east, north, up.
    pub(super) direction: [f64; 3],
    /// Tangents of the altitude between which the sun moves in that time, lower first.
    pub(super) altitudes: [f64; 2],
    /// What a surface that faces the sun gets in that time, in kWh/m².
    pub(super) beam: f64,
    /// What level open ground gets from the sky in that time, in kWh/m².
    pub(super) sky: f64,
}

impl Sun {
    /// Radians clockwise from north, 0 to 2π.
    pub(super) fn azimuth(&self) -> f64 {
        let [east, north, _] = self.direction;
        let azimuth = libm::atan2(east, north);
        if azimuth < 0.0 { azimuth + 2.0 * PI } else { azimuth }
    }
}

/// What the sun of a day, or of the mean day of a year, is asked for.
#[derive(Clone, Copy, Debug)]
pub(super) struct Course {
    /// Day of the year, 1 to 365; `None` for the mean day of the year.
    pub(super) day: Option<u32>,
    /// Radians, north positive.
    pub(super) latitude: f64,
    /// Share of a beam from the zenith that comes through the air, 0 to 1.
    pub(super) transmissivity: f64,
    /// Places of the sun between its rise and its setting.
    pub(super) positions: u32,
}

impl Course {
    /// The sun from its rise to its setting; empty in a polar night.
    pub(super) fn suns(&self) -> Vec<Sun> {
        let days = self.day.map_or_else(|| MONTHS.to_vec(), |day| vec![(day, 365)]);
        days.into_iter().flat_map(|(day, of)| self.suns_of_day(day, f64::from(of) / 365.0)).collect()
    }

    fn suns_of_day(&self, day: u32, weight: f64) -> impl Iterator<Item = Sun> {
        let course = *self;
        let (declination, distance) = (declination(day), distance_factor(day));
        let setting = setting(course.latitude, declination);
        let step = 2.0 * setting / f64::from(course.positions);
        let hours = weight * step * 12.0 / PI;
        (0..course.positions).map(move |position| {
            let from = -setting + step * f64::from(position);
            let at = |hour_angle| direction(course.latitude, declination, hour_angle);
            let [before, direction, after] = [from, from + 0.5 * step, from + step].map(at);
            let through = transmitted(course.transmissivity, direction[2]);
            let power = SOLAR_CONSTANT * distance * hours / 1000.0;
            Sun {
                direction,
                altitudes: [tangent(before).min(tangent(after)), tangent(before).max(tangent(after))],
                beam: power * through,
                sky: power * direction[2].max(0.0) * (0.271 - 0.294 * through).max(0.0),
            }
        })
    }
}

fn turn_of_year(day: u32) -> f64 {
    2.0 * PI * (f64::from(day) - 1.0) / 365.0
}

/// Angle between the sun and the plane of the equator, in radians.
fn declination(day: u32) -> f64 {
    let turn = turn_of_year(day);
    0.006_918 - 0.399_912 * libm::cos(turn) + 0.070_257 * libm::sin(turn) - 0.006_758 * libm::cos(2.0 * turn)
        + 0.000_907 * libm::sin(2.0 * turn)
        - 0.002_697 * libm::cos(3.0 * turn)
        + 0.001_48 * libm::sin(3.0 * turn)
}

/// Square of the mean distance of the sun over that of a day.
fn distance_factor(day: u32) -> f64 {
    let turn = turn_of_year(day);
    1.000_110
        + 0.034_221 * libm::cos(turn)
        + 0.001_280 * libm::sin(turn)
        + 0.000_719 * libm::cos(2.0 * turn)
        + 0.000_077 * libm::sin(2.0 * turn)
}

/// Hour angle at which the sun sets: 0 where it does not rise, π where it does not set.
fn setting(latitude: f64, declination: f64) -> f64 {
    libm::acos((-libm::tan(latitude) * libm::tan(declination)).clamp(-1.0, 1.0))
}

fn direction(latitude: f64, declination: f64, hour_angle: f64) -> [f64; 3] {
    let (sin, cos) = (libm::sin, libm::cos);
    [
        -cos(declination) * sin(hour_angle),
        sin(declination) * cos(latitude) - cos(declination) * sin(latitude) * cos(hour_angle),
        sin(latitude) * sin(declination) + cos(latitude) * cos(declination) * cos(hour_angle),
    ]
}

/// Tangent of the altitude.
fn tangent([east, north, up]: [f64; 3]) -> f64 {
    up / libm::hypot(east, north).max(1e-9)
}

/// Share of a beam that comes through the air at a sine of the altitude.
fn transmitted(transmissivity: f64, sine: f64) -> f64 {
    if sine <= 0.0 {
        return 0.0;
    }
    let altitude_deg = libm::asin(sine.min(1.0)).to_degrees();
    let air_mass = 1.0 / (sine + 0.505_72 * libm::pow(altitude_deg + 6.079_95, -1.636_4));
    libm::pow(transmissivity, air_mass)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn course(latitude_deg: f64, day: u32) -> Course {
        Course { day: Some(day), latitude: latitude_deg.to_radians(), transmissivity: 1.0, positions: 96 }
    }

    /// Daily extraterrestrial radiation on flat ground in kWh/m²: Iqbal 1983, eq. 4.2.17.
    fn extraterrestrial(latitude_deg: f64, day: u32) -> f64 {
        let (latitude, declination) = (latitude_deg.to_radians(), declination(day));
        let set = setting(latitude, declination);
        24.0 / PI * SOLAR_CONSTANT / 1000.0
            * distance_factor(day)
            * (latitude.cos() * declination.cos() * set.sin() + set * latitude.sin() * declination.sin())
    }

    #[test]
    fn without_air_a_day_brings_the_closed_form_of_extraterrestrial_radiation() {
        for (latitude, day) in [(0.0, 80), (45.0, 172), (45.0, 355), (-30.0, 10), (75.0, 172), (66.0, 1)] {
            let level: f64 = course(latitude, day).suns().iter().map(|sun| sun.beam * sun.direction[2]).sum();
            let expected = extraterrestrial(latitude, day);
            assert!(
                (level - expected).abs() < 1e-3 * expected,
                "{latitude}°, day {day}: {level}, {expected}"
            );
        }
    }

    #[test]
    fn declination_follows_the_seasons() {
        let degrees = |day| declination(day).to_degrees();
        assert!((degrees(172) - 23.45).abs() < 0.05, "June solstice: {}", degrees(172));
        assert!((degrees(355) + 23.45).abs() < 0.05, "December solstice: {}", degrees(355));
        assert!(degrees(80).abs() < 0.5, "March equinox: {}", degrees(80));
    }

    #[test]
    fn a_polar_night_has_no_light_and_a_polar_day_no_end() {
        assert_eq!(course(80.0, 355).suns().iter().map(|sun| sun.beam + sun.sky).sum::<f64>(), 0.0);
        assert!(course(80.0, 172).suns().iter().all(|sun| sun.direction[2] > 0.1));
    }

    #[test]
    fn at_noon_the_northern_sun_is_in_the_south_and_the_morning_sun_in_the_east() {
        let suns = course(50.0, 80).suns();
        let noon = (suns[47].azimuth() + suns[48].azimuth()).to_degrees() / 2.0;
        assert!((noon - 180.0).abs() < 1e-9, "{noon}");
        assert!((suns[0].azimuth().to_degrees() - 90.0).abs() < 3.0);
    }

    #[test]
    fn thick_air_dims_a_low_sun_more() {
        assert!((transmitted(0.7, 1.0) - 0.7).abs() < 1e-3);
        assert!(transmitted(0.7, 0.1) < 0.1 && transmitted(0.7, 0.1) > 0.01);
    }
}
