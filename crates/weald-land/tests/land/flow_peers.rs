//! Upslope areas on a real elevation model, beside those of other programs. `tests/data/README.md` has their
//! commands.

use std::path::{Path, PathBuf};

use weald_core::grid::Mask;
use weald_io::Raster;
use weald_land::flow::{Routed, Routing, accumulate, route};

fn near(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(path)
}

fn read(path: &str) -> Raster {
    weald_io::read(&near(path)).unwrap_or_else(|error| panic!("{error}"))
}

/// Pearson's correlation.
fn correlation(pairs: &[[f64; 2]]) -> f64 {
    let count = pairs.len() as f64;
    let mean = |axis: usize| pairs.iter().map(|pair| pair[axis]).sum::<f64>() / count;
    let (x, y) = (mean(0), mean(1));
    let product = |f: &dyn Fn(&[f64; 2]) -> f64| pairs.iter().map(f).sum::<f64>();
    let covariance = product(&|pair| (pair[0] - x) * (pair[1] - y));
    covariance / (product(&|pair| (pair[0] - x).powi(2)) * product(&|pair| (pair[1] - y).powi(2))).sqrt()
}

/// Ours and theirs.
struct Areas {
    routed: Routed,
    valid: Mask,
    ours: Vec<f64>,
    theirs: Vec<f32>,
}

impl Areas {
    fn beside(path: &str) -> Self {
        let ground = read("../../data/jacksboro_fault_utm16_80m.tif");
        let land = ground.valid.expect("its corners have no data");
        let theirs = read(path);
        assert_eq!(Some(&land), theirs.valid.as_ref(), "the same cells have data");
        let routed = route(&ground.field, Some(&land), &Routing::default());
        let ours = accumulate(&routed.directions, Some(&land), None);
        Self { routed, valid: land, ours, theirs: theirs.field.into_values() }
    }

    /// Correlation of the logarithms over some of the cells, of which many must be rivers.
    fn agreement(&self, takes_part: impl Fn(usize) -> bool) -> f64 {
        let cells = (0..self.ours.len()).filter(|&cell| self.valid.is_valid_at(cell) && takes_part(cell));
        let pairs: Vec<_> = cells.map(|cell| [self.ours[cell], f64::from(self.theirs[cell])]).collect();
        let rivers = pairs.iter().filter(|pair| pair[1] > 1000.0).count();
        assert!(pairs.len() > 140_000 && rivers > 500, "{rivers} of {} cells are rivers", pairs.len());
        let same = pairs.iter().filter(|pair| pair[0] == pair[1]).count() as f64 / pairs.len() as f64;
        let agreement = correlation(&pairs.iter().map(|pair| pair.map(f64::ln)).collect::<Vec<_>>());
        println!("correlation of logarithms {agreement:.4}; the same in {:.1} % of the cells", 100.0 * same);
        agreement
    }
}

#[test]
fn areas_agree_with_those_of_richdem() {
    let areas = Areas::beside("tests/data/jacksboro_areas_richdem.tif");
    let agreement = areas.agreement(|_| true);
    assert!(agreement >= 0.99, "{agreement}");
}

/// Ways over level water are a choice, and `r.terraflow` chooses others.
#[test]
fn areas_on_slopes_agree_with_those_of_terraflow() {
    let areas = Areas::beside("tests/data/jacksboro_areas_terraflow.tif");
    let level = areas.routed.surface.values();
    let slopes =
        |cell: usize| areas.routed.directions.downstream(cell).is_none_or(|next| level[next] < level[cell]);
    let agreement = areas.agreement(slopes);
    assert!(agreement >= 0.99, "{agreement}");
}
