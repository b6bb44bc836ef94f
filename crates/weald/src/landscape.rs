//! A landscape: one domain, the named layers on it, the plants, and the grass.

use std::collections::BTreeMap;
use std::sync::Arc;

use crate::domain::Domain;
use crate::error::Error;
use crate::grid::Field;
use crate::grow::Fractal;
use crate::grow::grass::Meadow;
use crate::material::Material;
use crate::plants::Plants;

/// A named field with its unit.
#[derive(Clone, Debug, PartialEq)]
pub struct Layer {
    /// Unit of the values: `m`, `m/step`, `1` …
    pub unit: String,
    /// One value a cell.
    pub field: Field,
}

/// A domain, its layers, its plants and its grass. Layers come out in the order of their names, whatever the order they went in.
#[derive(Clone, Debug, PartialEq)]
pub struct Landscape {
    /// Grid, cell size, georeference, mask.
    pub domain: Domain,
    /// What the ground is made of, bedrock first: 1 to [`MOST`](crate::material::MOST).
    pub materials: Vec<Material>,
    /// The fractals of the recipe; built-in ones are there without.
    pub fractals: Vec<Fractal>,
    layers: BTreeMap<String, Layer>,
    /// Shared, because each step works on a copy of the landscape.
    plants: BTreeMap<String, Arc<Plants>>,
    meadows: BTreeMap<String, Arc<Meadow>>,
}

impl Landscape {
    /// A landscape without layers, of the default materials.
    pub fn new(domain: Domain) -> Self {
        let (layers, plants, meadows) = (BTreeMap::new(), BTreeMap::new(), BTreeMap::new());
        Self { domain, materials: Material::default_stack(), fractals: Vec::new(), layers, plants, meadows }
    }

    /// Adds or replaces a layer.
    ///
    /// # Panics
    /// If the field's size is not the domain's: a bug of the caller.
    pub fn insert(&mut self, name: &str, unit: &str, field: Field) {
        assert_eq!(field.size(), self.domain.size, "a layer has the size of its domain");
        self.layers.insert(name.to_owned(), Layer { unit: unit.to_owned(), field });
    }

    /// The layer of that name.
    ///
    /// # Errors
    /// [`Error::Run`] naming the layers that exist.
    pub fn layer(&self, name: &str) -> Result<&Layer, Error> {
        self.layers.get(name).ok_or_else(|| {
            let known: Vec<_> = self.layers.keys().map(String::as_str).collect();
            Error::Run(format!("there is no layer `{name}`; the landscape has: {}", known.join(", ")))
        })
    }

    /// The field of the layer of that name.
    ///
    /// # Errors
    /// As [`Landscape::layer`].
    pub fn field(&self, name: &str) -> Result<&Field, Error> {
        Ok(&self.layer(name)?.field)
    }

    /// Takes a layer out.
    pub fn remove(&mut self, name: &str) -> Option<Layer> {
        self.layers.remove(name)
    }

    /// All layers in the order of their names.
    pub fn layers(&self) -> impl Iterator<Item = (&str, &Layer)> {
        self.layers.iter().map(|(name, layer)| (name.as_str(), layer))
    }

    /// Adds or replaces plants.
    pub fn plant(&mut self, name: &str, plants: impl Into<Arc<Plants>>) {
        self.plants.insert(name.to_owned(), plants.into());
    }

    /// The plants of that name.
    ///
    /// # Errors
    /// [`Error::Run`] naming the plants that exist.
    pub fn plants(&self, name: &str) -> Result<&Arc<Plants>, Error> {
        self.plants.get(name).ok_or_else(|| {
            let known: Vec<_> = self.plants.keys().map(String::as_str).collect();
            Error::Run(format!("there are no plants `{name}`; the landscape has: {}", known.join(", ")))
        })
    }

    /// All plants in the order of their names.
    pub fn all_plants(&self) -> impl Iterator<Item = (&str, &Arc<Plants>)> {
        self.plants.iter().map(|(name, plants)| (name.as_str(), plants))
    }

    /// Adds or replaces grass.
    pub fn sow(&mut self, name: &str, meadow: impl Into<Arc<Meadow>>) {
        self.meadows.insert(name.to_owned(), meadow.into());
    }

    /// The grass of that name.
    ///
    /// # Errors
    /// [`Error::Run`] naming the grass that exists.
    pub fn meadow(&self, name: &str) -> Result<&Arc<Meadow>, Error> {
        self.meadows.get(name).ok_or_else(|| {
            let known: Vec<_> = self.meadows.keys().map(String::as_str).collect();
            Error::Run(format!("there is no grass `{name}`; the landscape has: {}", known.join(", ")))
        })
    }

    /// All grass in the order of the names.
    pub fn all_meadows(&self) -> impl Iterator<Item = (&str, &Arc<Meadow>)> {
        self.meadows.iter().map(|(name, meadow)| (name.as_str(), meadow))
    }
}
