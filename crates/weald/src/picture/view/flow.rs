//! How fast and where to water runs at its surface, by which ripples drift and foam forms.
//!
//! The direction is that of the mean fluxes of a simulation, the speed Manning's (1891)
//!
//! ```text
//! v = h^(2/3) S^(1/2) / n
//! ```
//!
//! with the slope `S` of the water's surface along the flow, and `n` of natural streams with stones. What differs: the
//! depth `h` is that of the water up to a limit, since lakes are level by their surface and not by their bed.

use super::surface::Surface;
use super::terrain::Terrain;
use crate::grid::Field;
use crate::landscape::Landscape;
use crate::picture::ground::drawable;
use crate::picture::sheet::Sheet;
use crate::picture::texture::smoothed;

/// Manning's coefficient of natural streams with stones, in seconds over the cube root of a metre.
const MANNING: f32 = 0.045;

/// Bounds of the depth in metres.
const DEPTHS: [f32; 2] = [0.25, 2.0];

/// Fastest flow in metres a second.
const FASTEST: f32 = 8.0;

/// Velocities of the water's surface, eastward and northward, in metres a second.
#[derive(Debug)]
pub(super) struct Flow {
    pub(super) velocity: [Surface; 2],
}

impl Flow {
    /// Of the fluxes of a landscape over a terrain of the sheet's size; `None` without them.
    pub(super) fn of(landscape: &Landscape, terrain: &Terrain, sheet: &Sheet) -> Option<Self> {
        let land = landscape.domain.land.as_ref();
        let layer = |name: &str| landscape.field(name).ok().map(|field| drawable(field, land, sheet));
        // A thread of water leads from cell to cell; the stream that it stands for is broader.
        let broad = |field: Field| [1, 2].into_iter().fold(field, |field, gap| smoothed(&field, gap));
        let [east, south] = [broad(layer("flux_x")?), broad(layer("flux_y")?)];
        let depth = layer("water");
        let size = east.size();
        let velocity = |cell: usize| {
            let (flux, x, y) =
                ([east.values()[cell], -south.values()[cell]], cell % size.columns, cell / size.columns);
            let length = (flux[0] * flux[0] + flux[1] * flux[1]).sqrt();
            if length <= 0.0 {
                return [0.0; 2];
            }
            let along = flux.map(|part| part / length);
            let [_, rise_east, rise_south] = terrain.top.with_slope([x as f32 + 1.0, y as f32 + 1.0]);
            let rise = [rise_east / terrain.spacing[0], -rise_south / terrain.spacing[1]];
            let fall = -(along[0] * rise[0] + along[1] * rise[1]);
            let depth = depth.as_ref().map_or(0.0, |depth| depth.values()[cell]);
            along.map(|part| part * manning(depth, fall))
        };
        let cells: Vec<[f32; 2]> = (0..size.cells()).map(velocity).collect();
        let axis = |axis: usize| {
            let field = Field::from_values(size, cells.iter().map(|velocity| velocity[axis]).collect());
            Surface::new(&smoothed(&field, 1))
        };
        Some(Self { velocity: [axis(0), axis(1)] })
    }
}

/// Speed of water of a depth in metres over a fall, as rise over run.
fn manning(depth: f32, fall: f32) -> f32 {
    let depth = depth.clamp(DEPTHS[0], DEPTHS[1]);
    (libm::powf(depth, 2.0 / 3.0) * fall.max(0.0).sqrt() / MANNING).min(FASTEST)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::domain::Domain;
    use crate::grid::Size;

    #[test]
    fn water_runs_with_its_flux_and_faster_where_it_is_steep() {
        let size = Size::square(40).expect("small");
        let mut landscape = Landscape::new(Domain::new(size, 10.0));
        let height = Field::from_function(size, |x, _| if x < 20 { 40.0 - x as f32 } else { 20.0 });
        landscape.insert("flux_x", "m³/step", Field::filled(size, 3.0));
        landscape.insert("flux_y", "m³/step", Field::filled(size, 0.0));
        let terrain = Terrain::new([10.0; 2], &height, None, -1.0);
        let sheet = Sheet::new(&landscape.domain, Some(40)).expect("small");
        let flow = Flow::of(&landscape, &terrain, &sheet).expect("there are fluxes");
        let at = |x: f32| flow.velocity.each_ref().map(|axis| axis.at([x, 20.0]));
        let expected = manning(0.0, 0.1);
        assert!((at(10.0)[0] - expected).abs() < 0.01 && expected > 1.0, "{:?} of {expected}", at(10.0));
        assert!(at(30.0)[0].abs() < 0.01 && at(10.0)[1].abs() < 0.01);
    }

    #[test]
    fn deeper_and_steeper_water_is_faster_up_to_a_limit() {
        assert!(manning(1.0, 0.02) > manning(0.5, 0.02) && manning(1.0, 0.04) > manning(1.0, 0.02));
        assert_eq!(manning(9.0, 9.0), FASTEST);
        assert_eq!(manning(1.0, -0.1), 0.0);
    }
}
