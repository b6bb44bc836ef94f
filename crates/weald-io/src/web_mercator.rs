//! Web Mercator, the projection of maps on the web, as a CRS of elevation models.

use weald_core::domain::Georeference;
use weald_core::error::Error;

use super::Raster;

/// Web Mercator, whose metres are true at the equator alone.
const WEB_MERCATOR: [u32; 3] = [3857, 3785, 900_913];

/// Side of the cells on the ground, for a raster of square cells in Web Mercator, and a sentence for the user: at latitude φ,
/// where y = a ln tan(π/4 + φ/2), a metre of the map is cos φ / (1 − e² sin² φ)^0.5 metres to the east and
/// (1 − e²) / (1 − e² sin² φ) times that to the north, on the ellipsoid of WGS 84. The two are at most 0.7 % apart; cells
/// count by their geometric mean.
pub(super) fn true_cell(raster: &Raster) -> Result<Option<(f64, String)>, Error> {
    const SEMI_MAJOR: f64 = 6_378_137.0;
    const SQUARED_ECCENTRICITY: f64 = 0.006_694_379_990_14;
    let is_web = |place: &&Georeference| place.epsg.is_some_and(|code| WEB_MERCATOR.contains(&code));
    let Some(place) = raster.georeference.as_ref().filter(is_web) else { return Ok(None) };
    let [width, height] = place.pixel;
    if (width - height).abs() > 1e-6 * width {
        return Err(Error::Run(format!(
            "its cells of {width} × {height} are in Web Mercator, whose metres are true at the equator alone, and are not \
             square: gdalwarp it to a UTM zone"
        )));
    }
    let latitude = libm::atan(libm::sinh(place.middle(raster.field.size())[1] / SEMI_MAJOR));
    let sine = libm::sin(latitude);
    let below = 1.0 - SQUARED_ECCENTRICITY * sine * sine;
    let across = libm::cos(latitude) / below.sqrt();
    let cell = width * across * ((1.0 - SQUARED_ECCENTRICITY) / below).sqrt();
    let degrees = latitude.to_degrees();
    let note = format!(
        "the file is in Web Mercator, whose metres are true at the equator alone: at latitude {degrees:.2}° its cells of \
         {width:.2} count as {cell:.2} m"
    );
    Ok(Some((cell, note)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::square;
    use weald_core::grid::{Field, Size};

    /// At 60° a metre of the map is half a metre of the ground, and of the ellipsoid a little more.
    #[test]
    fn cells_in_web_mercator_count_as_they_are_on_the_ground() {
        let size = Size { columns: 40, rows: 40 };
        let raster = |north: f64| {
            let place = Georeference { epsg: Some(3857), origin: [0.0, north], pixel: [30.0; 2], keys: None };
            let field = Field::filled(size, 5.0);
            let raster = Raster { cell: Some(30.0), georeference: Some(place), ..Raster::from(field) };
            square(raster).expect("square")
        };
        let (there, note) = raster(8_399_737.89 + 600.0);
        let cell = there.cell.expect("metres");
        assert!((cell - 15.025).abs() < 0.03, "{cell}");
        assert_eq!(there.field.size(), size, "nothing is resampled");
        assert!(note.expect("a note").contains("at latitude 60.00° its cells of 30.00 count as 15.0"));
        let (equator, _) = raster(600.0);
        assert!((equator.cell.expect("metres") - 29.9).abs() < 0.01, "{:?}", equator.cell);
    }
}
