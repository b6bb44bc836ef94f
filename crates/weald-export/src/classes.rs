//! Which layers hold numbers that stand for things, and for what.

use weald_core::error::Error;
use weald_core::grid::Field;
use weald_core::landscape::Landscape;
use weald_io::{Class, Classes};
use weald_land::flow::DirectionCodes;
use weald_picture::{Scale, encode};

/// The layer of directions of flow.
pub const DIRECTIONS: &str = "flow_direction";

/// Most lakes, watersheds or orders that get a line of a legend each.
const MAX_NAMED: u32 = 4096;

/// Greatest whole number up to which `f32` has all.
const GREATEST_WHOLE: f32 = 16_777_216.0;

/// What the values of a layer stand for; `None` for measures, and for a layer of that name that holds others than whole
/// numbers from 0 on.
///
/// # Errors
/// [`Error::Run`] where there is no such layer.
pub fn classes(landscape: &Landscape, layer: &str) -> Result<Option<Classes>, Error> {
    let field = landscape.field(layer)?;
    let Some(greatest) = greatest(landscape, field) else { return Ok(None) };
    let named = match layer {
        DIRECTIONS => return Ok((greatest <= 9).then(|| directions(DirectionCodes::Weald))),
        "river" => vec![class(0, "no river", [240, 240, 235]), class(1, "river", [40, 110, 200])],
        "strahler" => orders(greatest),
        "lake" => counted(greatest, "no lake", "lake"),
        "watershed" => counted(greatest, "no watershed", "watershed"),
        "material" => {
            let materials = landscape.materials.iter().enumerate();
            let byte = |share: f32| (share.clamp(0.0, 1.0) * 255.0).round() as u8;
            materials.map(|(at, it)| class(at as u32, &it.name, it.colour.map(byte))).collect()
        }
        _ => return Ok(None),
    };
    let greatest = greatest.max(named.last().map_or(0, |class| class.number));
    Ok(Some(Classes { named, greatest }))
}

/// Whether the values of a layer of this name may stand for things.
pub fn is_of_classes(layer: &str) -> bool {
    [DIRECTIONS, "river", "strahler", "lake", "watershed", "material"].contains(&layer)
}

/// The numbers of the directions of flow.
pub fn directions(codes: DirectionCodes) -> Classes {
    const NAMES: [&str; 8] =
        ["east", "south-east", "south", "south-west", "west", "north-west", "north", "north-east"];
    let mut named: Vec<Class> = (1..)
        .zip(NAMES)
        .map(|(own, name)| class(u32::from(codes.number(own)), name, hue(f64::from(own) / 8.0)))
        .collect();
    if codes == DirectionCodes::Weald {
        named.push(class(0, "outlet", [60, 60, 60]));
        named.push(class(9, "sea", [170, 205, 240]));
    } else {
        named.push(class(0, "outlet or sea", [60, 60, 60]));
    }
    named.sort_by_key(|class| class.number);
    let greatest = named.last().map_or(0, |class| class.number);
    Classes { named, greatest }
}

/// Directions of flow in the numbers of another program.
pub fn recoded(field: &Field, codes: DirectionCodes) -> Field {
    let values = field.values().iter().map(|&own| f32::from(codes.number(own as u8)));
    Field::from_values(field.size(), values.collect())
}

/// The greatest value, where all over cells with data are whole numbers from 0 on; 0 where none has data.
fn greatest(landscape: &Landscape, field: &Field) -> Option<u32> {
    let valid = landscape.domain.valid.as_ref();
    let held =
        field.values().iter().enumerate().filter(|(cell, _)| valid.is_none_or(|it| it.is_valid_at(*cell)));
    let mut greatest = 0.0_f32;
    for (_, &value) in held {
        if !(0.0..=GREATEST_WHOLE).contains(&value) || value.fract() != 0.0 {
            return None;
        }
        greatest = greatest.max(value);
    }
    Some(greatest as u32)
}

/// Numbers of things, with 0 for none.
fn counted(greatest: u32, none: &str, thing: &str) -> Vec<Class> {
    // Neighbours in number are far apart in colour: the golden section of the wheel.
    let colour = |number: u32| hue((f64::from(number) * 0.618_033_988_749_895).fract());
    let things = (1..=greatest.min(MAX_NAMED))
        .map(|number| class(number, &format!("{thing} {number}"), colour(number)));
    std::iter::once(class(0, none, [240, 240, 235])).chain(things).collect()
}

/// Orders of rivers, the darker the higher.
fn orders(greatest: u32) -> Vec<Class> {
    let ramp = Scale::Water.ramp();
    let mut named = counted(greatest, "no river", "order");
    for class in &mut named[1..] {
        // Not from the paper white that stands for none.
        class.colour = encode(ramp.at(0.3 + 0.7 * class.number as f32 / greatest as f32));
    }
    named
}

fn class(number: u32, name: &str, colour: [u8; 3]) -> Class {
    Class { number, name: name.to_owned(), colour }
}

/// A colour by its turn around the wheel, 0 to 1, in soft light.
fn hue(turn: f64) -> [u8; 3] {
    [0.0, 1.0 / 3.0, 2.0 / 3.0].map(|shift| {
        let away = ((turn + 1.0 - shift).fract() - 0.5).abs();
        (70.0 + 160.0 * (6.0 * away - 1.0).clamp(0.0, 1.0)) as u8
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use weald_core::domain::Domain;
    use weald_core::grid::{Mask, Size};

    #[test]
    fn a_layer_has_classes_only_under_a_name_that_may() {
        let names = [DIRECTIONS, "river", "strahler", "lake", "watershed", "material", "height", "rivers"];
        for name in names {
            let mut land = Landscape::new(Domain::new(Size::square(2).expect("small"), 1.0));
            land.insert(name, "1", Field::filled(land.domain.size, 1.0));
            let has = classes(&land, name).expect("is there").is_some();
            assert_eq!(has, is_of_classes(name), "{name}");
        }
    }

    #[test]
    fn layers_of_numbers_have_names_and_measures_have_none() {
        let size = Size { columns: 3, rows: 1 };
        let valid = Mask::new(size, vec![true, true, false]);
        let mut landscape = Landscape::new(Domain { valid, ..Domain::new(size, 1.0) });
        let field = |values: [f32; 3]| Field::from_values(size, values.to_vec());
        landscape.insert("lake", "1", field([0.0, 300.0, f32::NAN]));
        landscape.insert("river", "1", field([0.0, 0.5, 0.0]));
        landscape.insert("strahler", "1", field([0.0, 3.0, 0.0]));
        landscape.insert(DIRECTIONS, "1", field([1.0, 9.0, 0.0]));
        landscape.insert("material", "1", field([0.0, 1.0, 0.0]));
        landscape.insert("height", "m", field([1.0, 2.0, 3.0]));
        let of = |layer: &str| classes(&landscape, layer).expect("there");
        let lake = of("lake").expect("numbers");
        assert_eq!((lake.greatest, lake.named.len(), lake.named[300].name.as_str()), (300, 301, "lake 300"));
        assert_eq!((of("river"), of("height")), (None, None), "halves of a river are no classes");
        let orders = of("strahler").expect("numbers").named;
        let light = |class: &Class| class.colour.map(u32::from).iter().sum::<u32>();
        assert!(orders.windows(2).all(|pair| light(&pair[0]) > light(&pair[1])), "{orders:?}");
        let material = of("material").expect("numbers");
        assert_eq!(material.named[1].name, landscape.materials[1].name);
        let esri = directions(DirectionCodes::Esri);
        assert_eq!((esri.greatest, esri.named[8].name.as_str(), esri.named.len()), (128, "north-east", 9));
        assert_eq!(
            recoded(landscape.field(DIRECTIONS).expect("there"), DirectionCodes::Esri).values(),
            [1.0, 0.0, 0.0]
        );
    }
}
