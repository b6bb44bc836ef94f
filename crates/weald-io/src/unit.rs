//! Units of length by their names, and how the numbers of a file become metres.
//!
//! Names are those of UDUNITS (which CF asks for), of EPSG and PROJ (which GDAL writes), and of ESRI. A value in a unit of
//! length becomes metres when it is read; one in another unit stays what it is, and whoever needs metres refuses it.

/// Units of length and their metres; the first name of each is the one that is written.
const LENGTHS: [(&[&str], f64); 10] = [
    (&["m", "metre", "meter", "metres", "meters"], 1.0),
    (
        &["international_foot", "ft", "foot", "feet", "ift", "international_feet", "foot_(international)"],
        FOOT,
    ),
    (
        &[
            "US_survey_foot",
            "US_survey_feet",
            "survey_foot",
            "survey_feet",
            "ftUS",
            "us-ft",
            "foot_us",
            "sft",
        ],
        SURVEY_FOOT,
    ),
    (&["km", "kilometre", "kilometer", "kilometres", "kilometers"], 1000.0),
    (&["dm", "decimetre", "decimeter", "decimetres", "decimeters"], 0.1),
    (&["cm", "centimetre", "centimeter", "centimetres", "centimeters"], 0.01),
    (&["mm", "millimetre", "millimeter", "millimetres", "millimeters"], 0.001),
    (&["yd", "yard", "yards"], 0.9144),
    (&["in", "inch", "inches"], 0.0254),
    (&["fathom", "fathoms"], 1.8288),
];

/// The international foot in metres.
pub(super) const FOOT: f64 = 0.3048;

/// The foot of surveys in the United States in metres.
pub(super) const SURVEY_FOOT: f64 = 1200.0 / 3937.0;

/// Metres in a unit of length by its name, or by a number of such, as `0.1 m`; `None` for what is no length that is known.
///
/// Symbols of one to three letters count in the case they are written in, for `Mm` and `mm` are not the same.
pub fn metres_in(name: &str) -> Option<f64> {
    let name = name.trim();
    let spelled = name.replace([' ', '-'], "_");
    let is_same = |known: &&str| {
        if known.len() > 3 { known.replace('-', "_").eq_ignore_ascii_case(&spelled) } else { *known == name }
    };
    let named = LENGTHS.iter().find(|(names, _)| names.iter().any(is_same));
    named.map(|(_, metres)| *metres).or_else(|| counted(name))
}

/// A number in front of a unit.
fn counted(text: &str) -> Option<f64> {
    let (number, unit) = text.split_once(' ')?;
    let number = number.parse::<f64>().ok().filter(|number| *number > 0.0 && number.is_finite())?;
    let (names, metres) = LENGTHS.iter().find(|(names, _)| names.contains(&unit.trim()))?;
    (!names.is_empty()).then_some(number * metres)
}

/// The name of a unit of so many metres, as UDUNITS knows it.
pub(super) fn name_of(metres: f64) -> String {
    let known = LENGTHS.iter().find(|(_, known)| *known == metres);
    known.map_or_else(|| format!("{metres:?} m"), |(names, _)| names[0].to_owned())
}

/// How the stored numbers of a layer become values: `(number · scale + offset)`, in metres where the unit is a length.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Measure {
    scale: f64,
    offset: f64,
    metres: f64,
    /// The unit as the file says it, where it says one.
    unit: Option<String>,
}

impl Measure {
    /// `unit` as the file says it; what says that there is none counts as nothing said.
    pub(super) fn new(scale: f64, offset: f64, unit: Option<&str>) -> Self {
        let unit = unit.map(str::trim).filter(|unit| !["", "1", "-", "none", "unitless"].contains(unit));
        let metres = unit.and_then(metres_in).unwrap_or(1.0);
        Self { scale, offset, metres, unit: unit.map(str::to_owned) }
    }

    /// The value behind a number.
    pub(super) fn value(&self, number: f64) -> f32 {
        if (self.scale, self.offset, self.metres) == (1.0, 0.0, 1.0) {
            return number as f32;
        }
        ((number * self.scale + self.offset) * self.metres) as f32
    }

    /// The unit of the values: metres where the file has a length.
    pub(super) fn unit(&self) -> Option<String> {
        let is_length = self.unit.as_deref().is_some_and(|unit| metres_in(unit).is_some());
        if is_length { Some("m".to_owned()) } else { self.unit.clone() }
    }

    /// What the user should know of it.
    pub(super) fn notes(&self) -> Vec<String> {
        let unit = self.unit.as_deref().unwrap_or_default();
        let converted = (self.metres != 1.0)
            .then(|| format!("values in {unit} became metres: 1 {unit} is {} m", self.metres));
        let (scale, offset) = (self.scale, self.offset);
        let packed = (scale, offset) != (1.0, 0.0);
        let packed = packed.then(|| format!("values are {scale} times the stored numbers, plus {offset}"));
        packed.into_iter().chain(converted).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lengths_are_known_as_udunits_gdal_and_esri_spell_them() {
        for (name, metres) in [
            ("m", 1.0),
            ("Metre", 1.0),
            ("feet", FOOT),
            ("ft", FOOT),
            ("US survey foot", SURVEY_FOOT),
            ("US_survey_foot", SURVEY_FOOT),
            ("us-ft", SURVEY_FOOT),
            ("Foot_US", SURVEY_FOOT),
            ("km", 1000.0),
            ("cm", 0.01),
            ("0.1 m", 0.1),
            ("201.168 m", 201.168),
        ] {
            assert_eq!(metres_in(name), Some(metres), "{name}");
        }
        for other in ["", "1", "K", "Mm", "MM", "m s-1", "m3", "degree", "-2 m", "0 m", "nan m", "2 furlongs"]
        {
            assert_eq!(metres_in(other), None, "{other}");
        }
    }

    #[test]
    fn a_unit_that_is_written_is_read_as_the_same_metres() {
        for metres in [1.0, FOOT, SURVEY_FOOT, 1000.0, 201.168, 0.001] {
            assert_eq!(metres_in(&name_of(metres)), Some(metres));
        }
    }

    #[test]
    fn numbers_become_metres_once_and_other_units_stay() {
        let measure = Measure::new(0.1, 1000.0, Some("feet"));
        assert_eq!(measure.value(469.0), ((469.0 * 0.1 + 1000.0) * 0.3048) as f32);
        assert_eq!(measure.unit().as_deref(), Some("m"));
        assert_eq!(measure.notes().len(), 2);
        let kelvin = Measure::new(1.0, 0.0, Some("K"));
        assert_eq!((kelvin.value(280.0), kelvin.unit().as_deref()), (280.0, Some("K")));
        assert_eq!(Measure::new(1.0, 0.0, Some("1")), Measure::new(1.0, 0.0, None));
    }
}
