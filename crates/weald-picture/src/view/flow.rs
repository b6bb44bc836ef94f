//! How fast and where to water runs at its surface, by which ripples drift and foam forms.
//!
//! The direction is that of the mean fluxes of a simulation, the speed the lesser of Manning's (1891), for gentle rivers,
//! and Jarrett's for mountain streams (1984, doi 10.1061/(ASCE)0733-9429(1984)110:11(1519)), in metres and seconds:
//!
//! ```text
//! v = h^(2/3) S^(1/2) / n      v = 3.17 h^0.83 S^0.12
//! ```
//!
//! with the slope `S` of the water's surface along the flow. What differs: the depth `h` is that of the water between
//! limits, since rivers thinner than a cell have no depth of their own.

use super::surface::Surface;
use crate::ground::drawable;
use crate::sheet::Sheet;
use crate::texture::smoothed;
use weald_core::grid::Field;
use weald_core::landscape::Landscape;

/// Manning's coefficient of natural rivers, in seconds over the cube root of a metre.
const MANNING: f32 = 0.035;

/// Bounds of the depth in metres.
const DEPTHS: [f32; 2] = [0.25, 2.0];

/// Steepest fall of a stream that the equations are meant for.
const STEEPEST: f32 = 0.4;

/// Velocities of the water's surface, eastward and northward, in metres per second; and how much of its height it loses
/// in a second, in metres, which is what makes it foam.
#[derive(Debug)]
pub(super) struct Flow {
    pub(super) velocity: [Surface; 2],
    pub(super) lost: Surface,
}

impl Flow {
    /// Of the fluxes of a landscape under a top of the sheet's size, of cells of such sides; `None` without them.
    pub(super) fn of(landscape: &Landscape, top: &Field, spacing: [f32; 2], sheet: &Sheet) -> Option<Self> {
        let top = Surface::new(top);
        let land = landscape.domain.valid.as_ref();
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
                return [0.0; 3];
            }
            let along = flux.map(|part| part / length);
            let [_, rise_east, rise_south] = top.with_slope([x as f32 + 1.0, y as f32 + 1.0]);
            let rise = [rise_east / spacing[0], -rise_south / spacing[1]];
            let fall = -(along[0] * rise[0] + along[1] * rise[1]);
            let depth = depth.as_ref().map_or(0.0, |depth| depth.values()[cell]);
            let speed = speed(depth, fall);
            [along[0] * speed, along[1] * speed, speed * fall.clamp(0.0, STEEPEST)]
        };
        let cells: Vec<[f32; 3]> = (0..size.cells()).map(velocity).collect();
        let axis = |axis: usize| {
            let field = Field::from_values(size, cells.iter().map(|velocity| velocity[axis]).collect());
            Surface::new(&smoothed(&field, 1))
        };
        Some(Self { velocity: [axis(0), axis(1)], lost: axis(2) })
    }

    /// The same for places that are counted in finer cells.
    #[must_use]
    pub(super) fn on_finer(self, fineness: usize) -> Self {
        Self {
            velocity: self.velocity.map(|axis| axis.on_finer(fineness)),
            lost: self.lost.on_finer(fineness),
        }
    }
}

/// Speed of water of a depth in metres over a fall, as rise over run.
fn speed(depth: f32, fall: f32) -> f32 {
    let (depth, fall) = (depth.clamp(DEPTHS[0], DEPTHS[1]), fall.clamp(0.0, STEEPEST));
    let manning = libm::powf(depth, 2.0 / 3.0) * fall.sqrt() / MANNING;
    let jarrett = 3.17 * libm::powf(depth, 0.83) * libm::powf(fall, 0.12);
    manning.min(jarrett)
}

#[cfg(test)]
mod tests {
    use super::*;
    use weald_core::domain::Domain;
    use weald_core::grid::Size;

    #[test]
    fn water_runs_with_its_flux_and_faster_where_it_is_steep() {
        let size = Size::square(40).expect("small");
        let mut landscape = Landscape::new(Domain::new(size, 10.0));
        let height = Field::from_function(size, |x, _| if x < 20 { 40.0 - x as f32 } else { 20.0 });
        landscape.insert("flux_x", "m³/step", Field::filled(size, 3.0));
        landscape.insert("flux_y", "m³/step", Field::filled(size, 0.0));
        let sheet = Sheet::new(&landscape.domain, Some(40)).expect("small");
        let flow = Flow::of(&landscape, &height, [10.0; 2], &sheet).expect("there are fluxes");
        let at = |x: f32| flow.velocity.each_ref().map(|axis| axis.at([x, 20.0]));
        let expected = speed(0.0, 0.1);
        assert!((at(10.0)[0] - expected).abs() < 0.01 && expected > 0.5, "{:?} of {expected}", at(10.0));
        assert!(at(30.0)[0].abs() < 0.01 && at(10.0)[1].abs() < 0.01);
    }

    #[test]
    fn deeper_and_steeper_water_is_faster_up_to_a_limit() {
        assert!(speed(1.0, 0.02) > speed(0.5, 0.02) && speed(1.0, 0.04) > speed(1.0, 0.02));
        // A gentle river of a metre runs at Manning's 0.9 m/s; a torrent of half a metre at about 1.4 m/s.
        assert!((speed(1.0, 0.001) - 0.903).abs() < 0.01, "{}", speed(1.0, 0.001));
        assert!((1.3..1.6).contains(&speed(0.5, 0.2)), "{}", speed(0.5, 0.2));
        assert_eq!(speed(1.0, -0.1), 0.0);
        assert_eq!(speed(9.0, 9.0), speed(2.0, STEEPEST));
    }
}
