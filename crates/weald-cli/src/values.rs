//! Values of the command line: engines, places, sizes of pictures.

/// An amount of memory.
pub(crate) use weald::error::bytes_from_words as memory;

/// An engine that a user can ask for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum EngineChoice {
    /// A graphics card where there is one, else all cores.
    Auto,
    /// All cores.
    Cpu,
    /// The graphics card, or software that acts as one.
    Gpu,
    /// Bands that exchange halos; for tests.
    Bands(usize),
    /// Tiles of so many cells a side; for tests.
    Tiles(usize),
}

/// Reads the name of an engine.
pub(crate) fn choice(text: &str) -> Result<EngineChoice, String> {
    let count = |prefix: &str| text.strip_prefix(prefix).and_then(|count| count.parse().ok());
    match (text, count("bands:"), count("tiles:")) {
        ("auto", ..) => Ok(EngineChoice::Auto),
        ("cpu", ..) => Ok(EngineChoice::Cpu),
        ("gpu", ..) => Ok(EngineChoice::Gpu),
        (_, Some(count @ 1..=1024), _) => Ok(EngineChoice::Bands(count)),
        (_, _, Some(side @ 1..=65_536)) => Ok(EngineChoice::Tiles(side)),
        _ => Err("the engines are auto, cpu and gpu".to_owned()),
    }
}

/// A place in metres east and south of the north-western corner, with an elevation if one was given.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Point {
    pub(crate) east: f64,
    pub(crate) south: f64,
    pub(crate) elevation: Option<f64>,
}

/// Reads `X,Y` or `X,Y,Z`.
pub(crate) fn point(text: &str) -> Result<Point, String> {
    let wrong = || "it is written X,Y,Z or X,Y in metres, as in 5200,6100,1300".to_owned();
    let numbers: Vec<f64> =
        text.split(',').map(|part| part.trim().parse().map_err(|_| wrong())).collect::<Result<_, _>>()?;
    if !numbers.iter().all(|number| number.is_finite() && number.abs() <= MAX_METRES) {
        return Err(format!("its numbers lie between -{MAX_METRES} and {MAX_METRES} m"));
    }
    match numbers[..] {
        [east, south] => Ok(Point { east, south, elevation: None }),
        [east, south, elevation] => Ok(Point { east, south, elevation: Some(elevation) }),
        _ => Err(wrong()),
    }
}

/// Reads the place of a camera, which was its height in earlier versions.
pub(crate) fn eye(text: &str) -> Result<Point, String> {
    match text.trim().parse::<f64>() {
        Ok(height) => {
            Err(format!("it is a place, X,Y,Z or X,Y; the height above the ground is --eye-height {height}"))
        }
        Err(_) => point(text),
    }
}

/// Refuses `--camera`.
pub(crate) fn camera_of_before(text: &str) -> Result<Point, String> {
    Err(format!("it is now called --eye {text}, and its height above the ground --eye-height METRES"))
}

/// Refuses `--fov`.
pub(crate) fn field_of_view_of_before(text: &str) -> Result<f64, String> {
    Err(format!("it is now called --field-of-view-deg {text}"))
}

/// Farthest that a camera may be, in metres.
const MAX_METRES: f64 = 1e8;

/// Reads `WxH`.
pub(crate) fn size(text: &str) -> Result<[u32; 2], String> {
    let sides = text
        .split_once(['x', 'X'])
        .and_then(|(width, height)| Some([width.trim().parse().ok()?, height.trim().parse().ok()?]));
    sides.ok_or_else(|| "it is written WIDTHxHEIGHT in pixels, as in 1920x1080".to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn engines_for_tests_have_sound_numbers() {
        assert_eq!(choice("tiles:64"), Ok(EngineChoice::Tiles(64)));
        assert_eq!(choice("bands:3"), Ok(EngineChoice::Bands(3)));
        for text in ["tiles:0", "tiles:", "tiles:-1", "tiles:70000", "bands:0", "bands:2000", "GPU"] {
            assert!(choice(text).is_err(), "{text}");
        }
    }
}
