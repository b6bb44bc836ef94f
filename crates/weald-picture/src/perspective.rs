//! Perspective views as pictures: on the processor, and as a device draws them.

use super::picture::Picture;
use super::view::most_cells;
use super::{Image, Render, View};
use weald_core::domain::Domain;
use weald_core::error::Error;
use weald_core::landscape::Landscape;
use weald_core::parameter::{Nested, Places};

/// Beyond so many sides of the landscape from it, a camera or what it looks at is probably a mistake.
const FAR_EYE: f64 = 10.0;
const FAR_TARGET: f64 = 1.0;

/// Least cells for which the visible sky is known where ground is steep, and most.
const SKY_OF_STEEP: u64 = 512 * 512;
const SKY_MOST: u64 = 1024 * 1024;

/// What to count of the bytes that a view takes only where some ground is steep, which is drawn on finer cells. Only the ground
/// that a run makes tells whether any is: with so much of them the sum is within a third either way.
fn if_steep(bytes: u64) -> u64 {
    21 * bytes / 40
}

impl Picture for View {
    fn reads(&self) -> Vec<String> {
        let drape = self.drape.iter().map(|Nested(drape)| drape.of.0.clone());
        std::iter::once(self.of.0.clone()).chain(drape).collect()
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

    fn notes(&self, landscape: &Landscape) -> Vec<String> {
        let [width, length] = landscape.domain.extent();
        let beyond = |key, places: &Option<Places>, margin: f64| {
            let [x, y] = *places.as_ref()?.0.first()?;
            let margin = margin * width.max(length);
            let is_within = |at: f64, side: f64| (-margin..=side + margin).contains(&at);
            let message = format!("`{key}` [{x}, {y}] is far from the landscape of {width} m × {length} m");
            (!is_within(x, width) || !is_within(y, length)).then_some(message)
        };
        beyond("eye", &self.eye, FAR_EYE)
            .into_iter()
            .chain(beyond("target", &self.target, FAR_TARGET))
            .collect()
    }

    /// Trees of bounds for rays, surfaces, what of the sky each cell sees, and what steep ground takes more.
    fn working_bytes(&self, cells: u64) -> u64 {
        let finer = most_cells(cells) - cells;
        let more_sky = if finer > 0 { SKY_OF_STEEP.saturating_sub(cells) } else { 0 };
        21 * cells + 57 * cells.min(SKY_MOST) + if_steep(8 * finer + 57 * more_sky)
    }

    fn optional_bytes(&self, layer: &str, cells: u64) -> u64 {
        match layer {
            "water" => 50 * cells + if_steep(2 * (most_cells(cells) - cells)),
            "soil_depth" | "moisture" | "deposition" => 11 * cells,
            _ => 0,
        }
    }

    fn check_on(&self, _: &Domain) -> Result<(), Error> {
        self.check()
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

    fn notes(&self, landscape: &Landscape) -> Vec<String> {
        self.view.notes(landscape)
    }

    fn working_bytes(&self, cells: u64) -> u64 {
        self.view.working_bytes(cells)
    }

    fn optional_bytes(&self, layer: &str, cells: u64) -> u64 {
        self.view.optional_bytes(layer, cells)
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
