//! Grass and fractals of a landscape, by name.

use std::sync::Arc;

use weald_core::{Attachment, Error, Landscape};

use crate::fractal::Fractal;
use crate::grass::Meadow;

impl Attachment for Meadow {
    const KIND: &'static str = "grass";
}

impl Attachment for Fractal {
    const KIND: &'static str = "fractal";
}

/// What grows in a landscape besides its layers.
pub trait Vegetation {
    /// Adds or replaces grass.
    fn sow(&mut self, name: &str, meadow: impl Into<Arc<Meadow>>);

    /// The grass of that name.
    ///
    /// # Errors
    /// [`Error::Run`] naming the grass that exists.
    fn meadow(&self, name: &str) -> Result<Arc<Meadow>, Error>;

    /// All grass in the order of the names.
    fn all_meadows(&self) -> impl Iterator<Item = (&str, Arc<Meadow>)>;

    /// Replaces the fractals of the recipe.
    fn set_fractals(&mut self, fractals: Vec<Fractal>);

    /// The fractal of that name: one of the recipe, or else a built-in one.
    ///
    /// # Errors
    /// [`Error::Run`] where there is none.
    fn fractal(&self, name: &str) -> Result<Arc<Fractal>, Error>;
}

impl Vegetation for Landscape {
    fn sow(&mut self, name: &str, meadow: impl Into<Arc<Meadow>>) {
        self.attach(name, meadow);
    }

    fn meadow(&self, name: &str) -> Result<Arc<Meadow>, Error> {
        self.attached(name)
    }

    fn all_meadows(&self) -> impl Iterator<Item = (&str, Arc<Meadow>)> {
        self.all_attached()
    }

    fn set_fractals(&mut self, fractals: Vec<Fractal>) {
        self.detach_all::<Fractal>();
        for fractal in fractals {
            self.attach(&fractal.name.clone(), fractal);
        }
    }

    fn fractal(&self, name: &str) -> Result<Arc<Fractal>, Error> {
        let own = self.attached(name).ok();
        own.or_else(|| Fractal::built_in(name).map(Arc::new)).ok_or_else(|| {
            Error::Run(format!("there is no fractal `{name}`, neither in the recipe nor built in"))
        })
    }
}
