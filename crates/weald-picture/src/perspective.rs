//! Perspective views as pictures: on the processor, and as a device draws them.

use super::picture::Picture;
use super::{Image, Render, View};
use weald_core::error::Error;
use weald_core::landscape::Landscape;

impl Picture for View {
    fn reads(&self) -> Vec<String> {
        vec![self.of.0.clone()]
    }

    fn optional(&self) -> Vec<String> {
        let water: &[&str] = if self.water { &["water", "flux_x", "flux_y"] } else { &[] };
        ["soil_depth", "moisture", "deposition"].iter().chain(water).map(|name| (*name).to_owned()).collect()
    }

    fn turned(&self, share: f64, _: f64) -> Option<Box<dyn Picture>> {
        Some(Box::new(Self::turned(self, share)))
    }

    fn as_view(&self) -> Option<&View> {
        Some(self)
    }

    fn render(&self, landscape: &Landscape) -> Result<Image, Error> {
        self.drawn(landscape, None)
    }
}

impl Picture for Render {
    fn reads(&self) -> Vec<String> {
        self.view.reads()
    }

    fn optional(&self) -> Vec<String> {
        self.view.optional()
    }

    fn turned(&self, share: f64, _: f64) -> Option<Box<dyn Picture>> {
        Some(Box::new(Self { view: self.view.turned(share), ..self.clone() }))
    }

    fn as_view(&self) -> Option<&View> {
        Some(&self.view)
    }

    fn as_render(&self) -> Option<&Render> {
        Some(self)
    }

    fn render(&self, _: &Landscape) -> Result<Image, Error> {
        Err(Error::Run(
            "a picture of kind `render` is drawn by a device, which this caller has not".to_owned(),
        ))
    }
}
