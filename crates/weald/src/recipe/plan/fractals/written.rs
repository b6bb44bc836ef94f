//! From the keys of a `[[fractal]]` to what it is made of, or a fault with its line.

use super::keys::{FractalKeys, FractalSource, line_of};
use crate::recipe::plan::words::hint;
use weald_core::parameter::FlameFile;
use weald_core::source::{Table, Value};
use weald_plants::ifs::{Draft, Ifs, IfsFault, Map, Role, Weighted, even_probabilities, shapes};

/// A table with its keys.
pub(super) struct Written<'a> {
    pub(super) table: &'a Table,
    pub(super) keys: &'a FractalKeys,
}

/// Something, or a fault with its line.
type At<T> = Result<T, (usize, String)>;

impl Written<'_> {
    /// What the fractal is made of.
    pub(super) fn fractal_source(&self) -> At<FractalSource> {
        let given: Vec<_> =
            ["of", "maps", "flame"].into_iter().filter(|key| self.table.get(key).is_some()).collect();
        match given.as_slice() {
            ["of"] => self.built_in().map(|ifs| FractalSource::Known(Box::new(ifs))),
            ["maps"] => self.of_maps().map(|ifs| FractalSource::Known(Box::new(ifs))),
            ["flame"] => Ok(self.flame()),
            [first, second, ..] => {
                let message =
                    format!("`{first}` and `{second}` exclude each other: a fractal is made of one of them");
                Err((line_of(self.table, second), message))
            }
            _ => Err((
                self.table.line,
                "`of`, `maps` or `flame` is needed: a built-in fractal, its maps, or a file".to_owned(),
            )),
        }
    }

    fn at(&self, key: &str, message: impl Into<String>) -> (usize, String) {
        (line_of(self.table, key), message.into())
    }

    fn built_in(&self) -> At<Ifs> {
        let name = self.keys.of.as_deref().unwrap_or_default();
        let Some(shape) = shapes::find(name) else {
            let known: Vec<_> = shapes::SHAPES.iter().map(|shape| shape.name).collect();
            return Err(
                self.at("of", format!("there is no built-in fractal {name:?}; {}", hint(name, &known)))
            );
        };
        let ifs = shape.ifs();
        let code_digits = self.keys.code_digits.map_or(ifs.code_digits(), |digits| digits as usize);
        let (name, maps) = (self.keys.name.0.clone(), ifs.maps().to_vec());
        self.checked(Draft { name, maps, code_digits: Some(code_digits) })
    }

    fn flame(&self) -> FractalSource {
        let path = self.keys.flame.as_ref().map(FlameFile::path).unwrap_or_default();
        FractalSource::Flame { path, number: self.keys.flame_number as usize }
    }

    fn of_maps(&self) -> At<Ifs> {
        let count = self.keys.maps.len();
        let maps: Vec<Map> = (0..count).map(|place| self.map(place)).collect::<At<_>>()?;
        self.as_many("probabilities", self.keys.probabilities.len(), count)?;
        self.as_many("roles", self.keys.roles.len(), count)?;
        let probabilities = if self.keys.probabilities.is_empty() {
            even_probabilities(&maps)
        } else {
            self.keys.probabilities.clone()
        };
        let role = |map: usize| self.keys.roles.get(map).map_or(Role::Branch, |role| role.role());
        let weighted = maps.into_iter().zip(probabilities).enumerate();
        let maps =
            weighted.map(|(number, (map, probability))| Weighted { map, probability, role: role(number) });
        let name = self.keys.name.0.clone();
        let code_digits = self.keys.code_digits.map(|digits| digits as usize);
        self.checked(Draft { name, maps: maps.collect(), code_digits })
    }

    fn map(&self, place: usize) -> At<Map> {
        let numbers = &self.keys.maps[place];
        if let Ok(six) = <[f64; 6]>::try_from(numbers.as_slice()) {
            return Ok(Map::planar(six));
        }
        if numbers.len() == 12 {
            let row = |row: usize| std::array::from_fn(|column| numbers[4 * row + column]);
            return Ok(Map::spatial([row(0), row(1), row(2)]));
        }
        let message = format!("map {place} has {} numbers; a 2D map has 6, a 3D map 12", numbers.len());
        Err((self.line_of_map(place), message))
    }

    fn line_of_map(&self, place: usize) -> usize {
        match self.table.get("maps").map(|node| &node.value) {
            Some(Value::List(items)) => items.get(place).map_or(self.table.line, |item| item.line),
            _ => self.table.line,
        }
    }

    fn as_many(&self, key: &str, found: usize, maps: usize) -> At<()> {
        if found == 0 || found == maps {
            return Ok(());
        }
        Err(self.at(key, format!("`{key}` has {found} entries for {maps} maps; each map needs one")))
    }

    fn checked(&self, draft: Draft) -> At<Ifs> {
        Ifs::new(draft).map_err(|fault| {
            let line = match &fault {
                IfsFault::NotFinite(map) | IfsFault::NotContracting { map, .. } => self.line_of_map(*map),
                IfsFault::Probability { .. } | IfsFault::ProbabilitySum(_) => {
                    line_of(self.table, "probabilities")
                }
                IfsFault::CodeLength { .. } => line_of(self.table, "code_digits"),
                IfsFault::TooFew(_) | IfsFault::TooMany(_) | IfsFault::Boundless => {
                    line_of(self.table, "maps")
                }
            };
            (line, fault.to_string())
        })
    }
}
