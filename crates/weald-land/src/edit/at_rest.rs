//! A stroke on a landscape at rest, between two steps.

use super::brush::Brush;
use super::canvas::{Area, Canvas};
use super::paint::Volumes;
use weald_core::error::Error;
use weald_core::grid::Field;
use weald_core::landscape::Landscape;
use weald_core::strata;

/// Layer of the ground.
const HEIGHT: &str = "height";

impl Brush {
    /// Changes a landscape: its layer `height`, and each layer of a [`Canvas`] that the stroke has touched, under the
    /// name that [`Canvas::fields`] gives it. Cells that the stroke does not change keep their bits.
    ///
    /// Materials lie as [`strata::stack`] says. What a simulation reads (`source`, `rain`) becomes a layer that
    /// its step can name.
    ///
    /// # Errors
    /// As [`Brush::paint`], and [`Error::Run`] where there is no `height`; the landscape is then as it was.
    pub fn paint_at_rest(&self, landscape: &mut Landscape) -> Result<Volumes, Error> {
        let before = canvas_of(landscape)?;
        let mut canvas = before.clone();
        let volumes = self.paint(&mut canvas)?;
        let old = landscape.field(HEIGHT)?;
        let height = Field::from_function(old.size(), |x, y| {
            let cell = old.size().index(x, y);
            let change = canvas.surface(cell) - before.surface(cell);
            // Adding 0 would turn -0 into 0.
            if change == 0.0 { old.at(x, y) } else { (f64::from(old.at(x, y)) + change) as f32 }
        });
        for ((name, now), (_, then)) in canvas.fields().zip(before.fields()) {
            if now != then {
                landscape.insert(name, unit_of(name), now.clone());
            }
        }
        landscape.insert(HEIGHT, "m", height);
        Ok(volumes)
    }
}

/// The whole of a landscape, with the water and the rain that its layers say.
fn canvas_of(landscape: &Landscape) -> Result<Canvas, Error> {
    let domain = &landscape.domain;
    let height = landscape.field(HEIGHT)?;
    let area = Area { first: [0, 0], size: domain.size };
    let mut canvas = Canvas::level(area, domain.cell, &landscape.materials);
    for (name, field) in canvas.fields_mut() {
        if let Ok(layer) = landscape.field(name) {
            field.clone_from(layer);
        }
    }
    canvas.valid.clone_from(&domain.valid);
    canvas.thickness = strata::stack(landscape, height)?;
    canvas.bedrock = Field::from_function(domain.size, |x, y| {
        let loose: f64 = canvas.thickness.iter().map(|layer| f64::from(layer.at(x, y))).sum();
        (f64::from(height.at(x, y)) - loose) as f32
    });
    Ok(canvas)
}

fn unit_of(layer: &str) -> &'static str {
    match layer {
        "source" => "m/iteration",
        "rain" | "frozen" | "painted_mask" => "1",
        _ => "m",
    }
}

#[cfg(test)]
mod tests {
    use super::super::Effect;
    use super::*;
    use weald_core::Domain;
    use weald_core::grid::{Mask, Size};

    fn slope() -> Landscape {
        let size = Size { columns: 20, rows: 10 };
        let mut landscape = Landscape::new(Domain::new(size, 5.0));
        landscape.insert(HEIGHT, "m", Field::from_function(size, |x, y| 0.1 * x as f32 + 0.7 * y as f32));
        landscape
    }

    fn soil(thickness: f64) -> Brush {
        Brush::dab(Effect::Add { material: "soil".to_owned(), thickness }, [50.0, 25.0], 12.0)
    }

    #[test]
    fn soil_comes_to_lie_on_the_ground_and_only_under_the_brush() {
        let (mut landscape, before) = (slope(), slope());
        let volumes = soil(2.0).paint_at_rest(&mut landscape).expect("paints");
        let (old, new) = (before.field(HEIGHT).expect("is"), landscape.field(HEIGHT).expect("is"));
        let soil = landscape.field("soil").expect("is made");
        for (cell, thickness) in soil.values().iter().enumerate() {
            let raised = new.values()[cell] - old.values()[cell];
            assert!((raised - thickness).abs() < 1e-5, "{raised} by {thickness}");
            assert!(*thickness > 0.0 || new.values()[cell].to_bits() == old.values()[cell].to_bits());
        }
        assert!(soil.at(10, 5) > 1.5 && soil.at(1, 1) == 0.0);
        assert!((volumes.solid_added - soil.sum() * 25.0).abs() < 1e-3 * volumes.solid_added);
        assert!(landscape.field("bedrock").is_err() && landscape.field("water").is_err());
    }

    #[test]
    fn no_data_stays_and_a_faulty_stroke_changes_nothing() {
        let mut landscape = slope();
        let east = (0..200).map(|cell| cell % 20 >= 10).collect();
        landscape.domain.valid = Mask::new(landscape.domain.size, east);
        soil(2.0).paint_at_rest(&mut landscape).expect("paints");
        assert!(landscape.field("soil").is_ok_and(|soil| soil.at(9, 5) == 0.0 && soil.at(10, 5) > 0.0));
        let before = landscape.clone();
        assert!(soil(-1.0).paint_at_rest(&mut landscape).is_err());
        assert_eq!(landscape, before);
    }
}
