//! Grass in a checkpoint: all but its maps in the header, the maps in the body.

use std::io::Write;

use serde::{Deserialize, Serialize};

use super::stream::{HashedReader, HashedWriter};
use weald_core::grid::{Field, Mask, Size};
use weald_plants::grass::{Bend, Curves, LightCurve, Maps, Meadow, SoilCurve, Species};

/// All but the maps.
#[derive(Debug, Serialize, Deserialize)]
pub(super) struct MeadowHeader {
    name: String,
    species: Vec<SpeciesHeader>,
    printed: bool,
    seed: u64,
    densest: f64,
    level: f32,
    mown_height: f32,
    deepest: f32,
    tussocks: f32,
    columns: usize,
    rows: usize,
    cell: f64,
    masked: bool,
    /// Whether there are maps of water, of what is mown, and of what is trodden.
    given: [bool; 3],
}

/// What of a species a recipe can change.
#[derive(Debug, Serialize, Deserialize)]
struct SpeciesHeader {
    name: String,
    height: f32,
    splay: f32,
    soil: [f32; 3],
    wide: [f32; 5],
    tall: [f32; 5],
}

impl MeadowHeader {
    pub(super) fn of(name: &str, meadow: &Meadow) -> Self {
        let Maps { cell, valid, density, water, mown, trodden, .. } = &meadow.maps;
        Self {
            name: name.to_owned(),
            species: meadow.species.iter().map(SpeciesHeader::of).collect(),
            printed: meadow.bend == Bend::Printed,
            seed: meadow.seed,
            densest: meadow.densest,
            level: meadow.level,
            mown_height: meadow.mown_height,
            deepest: meadow.deepest,
            tussocks: meadow.tussocks,
            columns: density.size().columns,
            rows: density.size().rows,
            cell: *cell,
            masked: valid.is_some(),
            given: [water, mown, trodden].map(Option::is_some),
        }
    }

    pub(super) fn bytes(&self) -> u128 {
        let given = self.given.iter().filter(|&&given| given).count();
        let maps = 3 + self.species.len() + given;
        self.columns as u128 * self.rows as u128 * (4 * maps as u128 + u128::from(self.masked))
    }

    pub(super) fn read(self, file: &mut HashedReader<'_>) -> Result<(String, Meadow), String> {
        let size = Size::new(self.columns, self.rows).map_err(|error| error.to_string())?;
        let valid = if self.masked { Mask::new(size, file.flags(size.cells())?) } else { None };
        let mut map = || Ok::<_, String>(Field::from_values(size, file.singles(size.cells())?));
        let (density, soil, light) = (map()?, map()?, map()?);
        let shares = self.species.iter().map(|_| map()).collect::<Result<_, _>>()?;
        let mut given = |place: usize| self.given[place].then(&mut map).transpose();
        let (water, mown, trodden) = (given(0)?, given(1)?, given(2)?);
        let maps = Maps { cell: self.cell, valid, density, soil, light, shares, water, mown, trodden };
        let meadow = Meadow {
            species: self.species.into_iter().map(SpeciesHeader::read).collect::<Result<_, _>>()?,
            bend: if self.printed { Bend::Printed } else { Bend::Total },
            seed: self.seed,
            densest: self.densest,
            level: self.level,
            mown_height: self.mown_height,
            deepest: self.deepest,
            tussocks: self.tussocks,
            maps,
        };
        Ok((self.name, meadow))
    }
}

impl SpeciesHeader {
    fn of(species: &Species) -> Self {
        let Curves { soil, width, height } = species.curves;
        Self {
            name: species.name.to_owned(),
            height: species.height,
            splay: species.splay,
            soil: soil.values(),
            wide: width.values(),
            tall: height.values(),
        }
    }

    fn read(self) -> Result<Species, String> {
        let species =
            Species::named(&self.name).ok_or_else(|| format!("there is no grass {:?}", self.name))?;
        let (soil, width, height) =
            (SoilCurve::new(self.soil)?, LightCurve::new(self.wide)?, LightCurve::new(self.tall)?);
        let (curves, splay) = (Curves { soil, width, height }, self.splay);
        Ok(Species { height: self.height, splay, curves, ..species.clone() })
    }
}

pub(super) fn write<W: Write>(meadow: &Meadow, out: &mut HashedWriter<W>) -> std::io::Result<()> {
    let Maps { valid, density, soil, light, shares, water, mown, trodden, .. } = &meadow.maps;
    if let Some(valid) = valid {
        out.flags(valid.flags())?;
    }
    let given = [water, mown, trodden].into_iter().flatten();
    let mut maps = [density, soil, light].into_iter().chain(shares).chain(given);
    maps.try_for_each(|map| out.singles(map.values()))
}
