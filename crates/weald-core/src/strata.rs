//! The thickness of each material of a landscape, from its layers or from what its materials declare.

use crate::error::Error;
use crate::grid::{Field, Mask};
use crate::landscape::Landscape;

/// Thickness of each material above the bedrock, in metres, lowest first, in ground whose surface is `ground`:
/// the layer of the material's name where there is one, else what the material declares. What the thicknesses
/// leave of `ground` is bedrock.
///
/// # Errors
/// [`Error::Run`] naming the first cell of a layer that holds less than nothing, or no number.
pub fn stack(landscape: &Landscape, ground: &Field) -> Result<Vec<Field>, Error> {
    let mut roof = ground.clone();
    let mut stack = Vec::new();
    for material in landscape.materials.iter().skip(1).rev() {
        let thickness = match landscape.field(&material.name) {
            Ok(layer) => checked(&material.name, layer, landscape.domain.valid.as_ref())?.clone(),
            Err(_) => material.under(&roof),
        };
        for (roof, thickness) in roof.values_mut().iter_mut().zip(thickness.values()) {
            *roof -= thickness;
        }
        stack.push(thickness);
    }
    stack.reverse();
    Ok(stack)
}

fn checked<'a>(name: &str, layer: &'a Field, valid: Option<&Mask>) -> Result<&'a Field, Error> {
    let counts = |cell: usize| valid.is_none_or(|valid| valid.is_valid_at(cell));
    let is_thickness = |value: f32| value.is_finite() && value >= 0.0;
    let fault =
        layer.values().iter().enumerate().find(|&(cell, &value)| counts(cell) && !is_thickness(value));
    let Some((cell, value)) = fault else { return Ok(layer) };
    let (x, y) = (cell % layer.size().columns, cell / layer.size().columns);
    Err(Error::Run(format!(
        "layer `{name}` holds {value} at column {x}, row {y}; the thickness of a material is 0 or more"
    )))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::domain::Domain;
    use crate::grid::Size;
    use crate::material::Material;
    use crate::material::topmost;
    use proptest::prelude::*;

    fn material(name: &str, thickness: f64, bottom: Option<f64>) -> Material {
        let rock = Material::built_in("rock").expect("built in");
        Material { name: name.to_owned(), thickness, bottom, ..rock }
    }

    /// A slope from 0 to 90 m in ten cells, of these materials.
    fn slope(above: &[Material]) -> (Landscape, Field) {
        let size = Size::new(10, 1).expect("small");
        let height = Field::from_function(size, |x, _| 10.0 * x as f32);
        let mut landscape = Landscape::new(Domain::new(size, 1.0));
        landscape.materials.truncate(1);
        landscape.materials.extend(above.iter().cloned());
        (landscape, height)
    }

    #[test]
    fn strata_fill_the_ground_between_their_bottoms_and_lie_under_an_even_cover() {
        let strata = [
            material("shale", 0.0, Some(20.0)),
            material("lime", 0.0, Some(50.0)),
            material("soil", 2.0, None),
        ];
        let (landscape, height) = slope(&strata);
        let stack = stack(&landscape, &height).expect("no layer is faulty");
        assert_eq!(stack[0].values(), [0.0, 0.0, 0.0, 8.0, 18.0, 28.0, 30.0, 30.0, 30.0, 30.0]);
        assert_eq!(stack[1].values(), [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 8.0, 18.0, 28.0, 38.0]);
        assert_eq!(stack[2].values(), [2.0; 10]);
        assert_eq!([0, 4, 9].map(|cell| topmost(&stack, cell, 0.01)), [3; 3]);
        assert_eq!([0, 4, 9].map(|cell| topmost(&stack[..2], cell, 0.01)), [0, 1, 2]);
    }

    #[test]
    fn a_layer_goes_before_a_declaration_and_may_not_be_negative() {
        let (mut landscape, height) = slope(&[material("sand", 3.0, None)]);
        landscape.insert("sand", "m", Field::filled(height.size(), 7.0));
        assert_eq!(stack(&landscape, &height).expect("a thickness")[0].values(), [7.0; 10]);
        let mut faulty = Field::filled(height.size(), 7.0);
        faulty.set(4, 0, -1.5);
        landscape.insert("sand", "m", faulty);
        let message = stack(&landscape, &height).expect_err("negative").to_string();
        assert!(message.contains("`sand` holds -1.5 at column 4, row 0"), "{message}");
    }

    proptest! {
        #[test]
        fn strata_end_where_the_next_one_begins(bottoms in prop::collection::vec(-20.0..120.0_f64, 1..7)) {
            let mut bottoms = bottoms;
            bottoms.sort_by(f64::total_cmp);
            let strata: Vec<_> = bottoms.iter().map(|&bottom| material("stratum", 0.0, Some(bottom))).collect();
            let (landscape, height) = slope(&strata);
            let stack = stack(&landscape, &height).expect("no layer is faulty");
            for cell in 0..10 {
                let ground = f64::from(height.values()[cell]);
                let whole: f32 = stack.iter().map(|layer| layer.values()[cell]).sum();
                let expected = (ground - bottoms[0]).max(0.0);
                prop_assert!((f64::from(whole) - expected).abs() < 1e-3, "{whole} instead of {expected}");
                prop_assert!(stack.iter().all(|layer| layer.values()[cell] >= 0.0));
            }
        }
    }
}
