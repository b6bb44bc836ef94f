//! How many cells have which value of the layer that is chosen.

use std::sync::Arc;

use eframe::egui::{Id, Ui};
use egui_plot::{Bar, BarChart, Plot};
use weald::Landscape;
use weald::picture::ColourScale;

use super::legend::colour;
use crate::studio::Studio;

/// Ranges that values are counted in.
const BINS: usize = 48;

/// Counts of a layer, which are kept as long as landscape and looks stay.
#[derive(Clone, Debug)]
struct Counted {
    number: (u64, u64),
    bars: Arc<Vec<(f64, f64, f32)>>,
    width: f64,
}

pub(crate) fn show(studio: &Studio, ui: &mut Ui) {
    let (Some(shown), Some(layer)) = (&studio.status.shown, &studio.looks.layer) else { return };
    let Some(drape) = studio.looks.drape(&shown.landscape) else { return };
    let (id, number) = (Id::unique("histogram"), (shown.number, studio.looks_number));
    let kept = ui.data(|data| data.get_temp::<Counted>(id)).filter(|kept| kept.number == number);
    let counted = kept.or_else(|| {
        let scale = drape.scale(&shown.landscape).ok()?;
        counted(&shown.landscape, layer, &scale, number)
    });
    let Some(counted) = counted else { return };
    ui.data_mut(|data| data.insert_temp(id, counted.clone()));
    let scale = drape.scale(&shown.landscape).ok();
    let bars = counted.bars.iter().map(|(value, share, place)| {
        let bar = Bar::new(*value, *share).width(counted.width);
        match &scale {
            Some(scale) => bar.fill(colour(scale, *place)),
            None => bar,
        }
    });
    Plot::new("histogram")
        .height(110.0)
        .allow_scroll(false)
        .allow_drag(false)
        .allow_zoom(false)
        .y_axis_label("% of the land")
        .show(ui, |plot| plot.bar_chart(BarChart::new(layer.clone(), bars.collect())));
}

/// Middle, share of the land in percent, and place on the scale, of each range.
fn counted(landscape: &Landscape, layer: &str, scale: &ColourScale, number: (u64, u64)) -> Option<Counted> {
    let (field, land) = (landscape.field(layer).ok()?, landscape.domain.valid.as_ref());
    let (low, high) = field.range(land).map(|(low, high)| (f64::from(low), f64::from(high)))?;
    let width = ((high - low) / BINS as f64).max(f64::MIN_POSITIVE);
    let (mut counts, mut whole) = ([0_u64; BINS], 0_u64);
    for (cell, value) in field.values().iter().enumerate() {
        if land.is_none_or(|land| land.is_valid_at(cell)) && value.is_finite() {
            counts[(((f64::from(*value) - low) / width) as usize).min(BINS - 1)] += 1;
            whole += 1;
        }
    }
    let bar = |(bin, count): (usize, &u64)| {
        let middle = low + (bin as f64 + 0.5) * width;
        (middle, 100.0 * *count as f64 / whole.max(1) as f64, scale.share(middle as f32))
    };
    Some(Counted { number, bars: Arc::new(counts.iter().enumerate().map(bar).collect()), width })
}

#[cfg(test)]
mod tests {
    use super::*;
    use weald::picture::Drape;
    use weald::{Domain, Field, Size};

    #[test]
    fn shares_add_up_to_all_of_the_land() {
        let size = Size::square(32).expect("legal");
        let mut landscape = Landscape::new(Domain::new(size, 1.0));
        landscape.insert("age", "yr", Field::from_function(size, |x, y| (x * x + y) as f32));
        let scale = Drape::of("age").scale(&landscape).expect("there");
        let counted = counted(&landscape, "age", &scale, (1, 1)).expect("counted");
        let sum: f64 = counted.bars.iter().map(|(_, share, _)| share).sum();
        assert!((sum - 100.0).abs() < 1e-9, "{sum}");
        assert!(counted.bars[0].1 > 2.0 * counted.bars[BINS - 1].1, "squares lie closer below");
    }
}
