//! A landscape: one domain, the named layers on it, the plants, and what else is attached by name.

use std::collections::BTreeMap;
use std::sync::Arc;

use crate::attachment::{Attachment, Attachments};
use crate::domain::Domain;
use crate::error::Error;
use crate::grid::Field;
use crate::material::Material;
use crate::plants::Plants;

/// A named field with its unit.
#[derive(Clone, Debug, PartialEq)]
pub struct Layer {
    /// Unit of the values: `m`, `m³/s`, `1` …
    pub unit: String,
    /// One value a cell.
    pub field: Field,
}

/// A domain, its layers, its plants and its attachments. Layers come out in the order of their names, whatever the
/// order they went in.
#[derive(Clone, Debug, PartialEq)]
pub struct Landscape {
    /// Grid, cell size, georeference, mask.
    pub domain: Domain,
    /// What the ground is made of, bedrock first: 1 to [`MAX_MATERIALS`](crate::material::MAX_MATERIALS).
    pub materials: Vec<Material>,
    /// Layers and plants are shared: each step works on a copy of the landscape, and most of them stay as they are.
    layers: BTreeMap<String, Arc<Layer>>,
    plants: BTreeMap<String, Arc<Plants>>,
    attachments: Attachments,
}

impl Landscape {
    /// A landscape without layers, of the default materials.
    pub fn new(domain: Domain) -> Self {
        let (layers, plants) = (BTreeMap::new(), BTreeMap::new());
        let attachments = Attachments::default();
        Self { domain, materials: Material::default_stack(), layers, plants, attachments }
    }

    /// Adds or replaces a layer.
    ///
    /// # Panics
    /// If the field's size is not the domain's: a bug of the caller.
    pub fn insert(&mut self, name: &str, unit: &str, field: Field) {
        assert_eq!(field.size(), self.domain.size, "a layer has the size of its domain");
        self.layers.insert(name.to_owned(), Arc::new(Layer { unit: unit.to_owned(), field }));
    }

    /// The layer of that name.
    ///
    /// # Errors
    /// [`Error::Run`] naming the layers that exist.
    pub fn layer(&self, name: &str) -> Result<&Layer, Error> {
        self.layers.get(name).map(Arc::as_ref).ok_or_else(|| {
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

    /// Whether a layer is the same one as in another landscape, or in neither: a copy shares its layers until they are
    /// replaced.
    pub fn shares_layer(&self, other: &Self, name: &str) -> bool {
        match (self.layers.get(name), other.layers.get(name)) {
            (Some(mine), Some(others)) => Arc::ptr_eq(mine, others),
            (None, None) => true,
            _ => false,
        }
    }

    /// Takes a layer of another landscape on the same grid in place of its own, shared.
    ///
    /// # Panics
    /// If the grids differ: a bug of the caller.
    pub fn share_layer(&mut self, other: &Self, name: &str) {
        assert_eq!(self.domain.size, other.domain.size, "layers are shared on one grid");
        if let Some(layer) = other.layers.get(name) {
            self.layers.insert(name.to_owned(), Arc::clone(layer));
        }
    }

    /// Takes a layer out.
    pub fn remove(&mut self, name: &str) -> Option<Layer> {
        self.layers.remove(name).map(Arc::unwrap_or_clone)
    }

    /// All layers in the order of their names.
    pub fn layers(&self) -> impl Iterator<Item = (&str, &Layer)> {
        self.layers.iter().map(|(name, layer)| (name.as_str(), layer.as_ref()))
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

    /// Attaches something by name, in place of what of its kind had the name.
    pub fn attach<T: Attachment>(&mut self, name: &str, attachment: impl Into<Arc<T>>) {
        self.attachments.insert(name, attachment.into());
    }

    /// The attachment of that kind and name.
    ///
    /// # Errors
    /// [`Error::Run`] naming those of the kind that exist.
    pub fn attached<T: Attachment>(&self, name: &str) -> Result<Arc<T>, Error> {
        self.attachments.get(name)
    }

    /// All attachments of a kind in the order of their names.
    pub fn all_attached<T: Attachment>(&self) -> impl Iterator<Item = (&str, Arc<T>)> {
        self.attachments.all()
    }

    /// Takes away all attachments of a kind.
    pub fn detach_all<T: Attachment>(&mut self) {
        self.attachments.clear::<T>();
    }

    /// Attaches all that is attached to another landscape.
    pub fn attach_all_of(&mut self, other: &Self) {
        self.attachments.clone_from(&other.attachments);
    }
}
