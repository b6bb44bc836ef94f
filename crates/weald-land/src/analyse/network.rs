//! How far a landscape has formed a network of rivers.
//!
//! Lengths, heights and depths are in cells. Common measures of digital elevation models, chosen so that they
//! tell connected river networks from scattered gullies; they depend on the grid, so only landscapes of the
//! same size compare. Cells without data take no part; what drains to their edge has arrived.

mod carve;
mod discharge;
mod drainage;
mod drains;
mod ground;
mod hack;
mod input;
mod power_law;
mod river_width;
mod slope_area;
mod strahler;
mod transects;
mod valleys;

pub use carve::Carve;
pub use transects::ValleyForm;

use drainage::Drainage;
use ground::Ground;
use input::CHANNEL_AREA;
pub use input::NetworkInput;
use weald_core::grid::Field;

/// What each measure is, under the name that it has in reports.
pub const MEASURES: &[(&str, &str)] = &[
    ("chan", "share of cells whose mean flow carries the rain of at least 100 cells"),
    (
        "reach",
        "length of the longest connected valley over the longer side of the grid (no reach of a river)",
    ),
    ("valley_largest", "share of the valley cells that belong to the largest connected valley"),
    (
        "drains",
        "share of the land outside lakes from which water reaches a lake or the border without crossing a pit deeper \
         than half a cell size",
    ),
    ("pits", "inner cells without a lower neighbour among eight"),
    ("heads", "channel heads: places on the filled ground from which on 100 cells drain through"),
    ("strahler", "greatest Strahler order of these channels"),
    (
        "flux_gini",
        "Gini coefficient of the mean flow of the cells: 0 the same everywhere, nearly 1 all in one cell",
    ),
    ("river_width", "mean width in cells of the simulated rivers outside lakes; not the layer of that name"),
    ("theta", "concavity θ of the channels: slope falls with upslope area as A^-θ"),
    ("hack", "Hack's exponent h: the longest river of a drainage area A is as long as A^h"),
    ("valley_spacing", "length of all rows and columns over the number of valleys on them, in cells"),
    ("valley_width", "mean width of the valleys at half their depth, in cells"),
    (
        "valley_shape",
        "mean ratio of the widths at a quarter and three quarters of the depth: 1/3 a V, 1 a slot",
    ),
    ("valley_depth", "mean depth of the valleys, in cell sizes"),
    (
        "carve_reach",
        "length of the longest connected cut over the longer side of the grid; cuts are the twentieth that lost most",
    ),
    ("carve_largest", "share of the cells of the cuts that belong to the largest connected one"),
    ("carve_against_area", "correlation of the logarithms of lost height and of upslope area"),
];

/// The measures.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NetworkMeasures {
    /// Share of cells whose mean flow carries the rain of at least 100 cells.
    pub chan: f64,
    /// Mean width in cells of the rivers that these cells make outside lakes; `None` where there are none.
    pub river_width: Option<f64>,
    /// Length of the longest connected valley over the longer side of the grid, among the twentieth of the land
    /// that lies deepest below its surroundings.
    pub reach: f64,
    /// Share of the valley cells that belong to the largest connected valley.
    pub valley_largest: f64,
    /// Share of the land outside lakes from which water reaches a lake or the border without crossing a pit
    /// deeper than half a cell.
    pub drains: f64,
    /// Inner cells without a lower neighbour among eight.
    pub pits: usize,
    /// Places where channels begin: on the flooded ground 100 cells drain through them.
    pub heads: usize,
    /// Greatest Strahler order of these channels.
    pub strahler: u32,
    /// Concavity θ: slope falls with area as `A^-θ`. `None` on grids too small to tell.
    pub theta: Option<f64>,
    /// Hack's exponent h: the longest river of a basin grows as `A^h`. `None` on grids too small to tell.
    pub hack: Option<f64>,
    /// Gini coefficient of the mean flow of the cells: 0 where it is the same everywhere, nearly 1 where one
    /// cell has all.
    pub flux_gini: f64,
    /// Spacing, width and shape of the valleys; `None` where none is a cell deep.
    pub valleys: Option<ValleyForm>,
    /// Connection of the deepest cuts, where the ground before is known.
    pub carve: Option<Carve>,
}

impl NetworkMeasures {
    /// All measures that there are, by name; lengths in cells.
    pub fn named(&self) -> Vec<(&'static str, f64)> {
        let always = [
            ("chan", self.chan),
            ("reach", self.reach),
            ("valley_largest", self.valley_largest),
            ("drains", self.drains),
            ("pits", self.pits as f64),
            ("heads", self.heads as f64),
            ("strahler", f64::from(self.strahler)),
            ("flux_gini", self.flux_gini),
        ];
        let valley = |of: fn(&ValleyForm) -> f64| self.valleys.as_ref().map(of);
        let carve = |of: fn(&Carve) -> f64| self.carve.as_ref().map(of);
        let where_known = [
            ("river_width", self.river_width),
            ("theta", self.theta),
            ("hack", self.hack),
            ("valley_spacing", valley(|form| form.spacing)),
            ("valley_width", valley(|form| form.width)),
            ("valley_shape", valley(|form| form.shape)),
            ("valley_depth", valley(|form| form.depth)),
            ("carve_reach", carve(|carve| carve.reach)),
            ("carve_largest", carve(|carve| carve.largest)),
            ("carve_against_area", carve(|carve| carve.against_area)),
        ];
        let where_known = where_known.into_iter().filter_map(|(name, value)| Some((name, value?)));
        always.into_iter().chain(where_known).collect()
    }
}

/// Measures a landscape.
///
/// # Panics
/// If the fields differ in size: a bug of the caller.
pub fn measure(input: &NetworkInput<'_>) -> NetworkMeasures {
    let size = input.ground.size();
    for field in [input.depth, input.mean_flux_x, input.mean_flux_y].into_iter().chain(input.before) {
        assert_eq!(field.size(), size, "all fields have the size of the ground");
    }
    let in_cells =
        |field: &Field| field.values().iter().map(|&value| f64::from(value) / input.cell).collect();
    let (height, depth) = (in_cells(input.ground), in_cells(input.depth));
    let ground = Ground { size, valid: input.valid, height, depth };
    let lakes = ground.lakes();
    // Each measure is one thread's work; those that need the drainage wait for it, the others do not.
    let of_ground = || {
        rayon::join(
            || drains::draining_share(&ground, &lakes),
            || (valleys::valleys(&ground), drains::pits(&ground), transects::valley_form(&ground)),
        )
    };
    let of_drainage = || {
        let drainage = Drainage::new(&ground, &lakes);
        rayon::join(
            || {
                (
                    strahler::channels(&drainage),
                    slope_area::theta(&drainage),
                    hack::exponent_of_length(&drainage),
                )
            },
            || input.before.map(|before| carve::carve(&ground, &in_cells(before), &drainage)),
        )
    };
    let of_flow = || {
        let carries = discharge::effective_areas(input);
        let is_river = |(&area, lake): (&f64, &bool)| area >= CHANNEL_AREA && !lake;
        let river: Vec<bool> = carries.iter().zip(&lakes).map(is_river).collect();
        let carries: Vec<f64> = ground.cells().map(|cell| carries[cell]).collect();
        let river_width = river_width::river_width(size, &river);
        (share_of_channels(&carries), river_width, discharge::gini(carries))
    };
    let (
        ((drains, (valley, pits, valleys)), (chan, river_width, flux_gini)),
        ((channels, theta, hack), carve),
    ) = rayon::join(|| rayon::join(of_ground, of_flow), of_drainage);
    NetworkMeasures {
        chan,
        river_width,
        reach: valley.reach,
        valley_largest: valley.largest,
        drains,
        pits,
        heads: channels.heads,
        strahler: channels.order,
        theta,
        hack,
        flux_gini,
        valleys,
        carve,
    }
}

fn share_of_channels(carries: &[f64]) -> f64 {
    let channels = carries.iter().filter(|&&area| area >= CHANNEL_AREA);
    channels.count() as f64 / carries.len().max(1) as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use weald_core::grid::Mask;
    use weald_core::grid::Size;

    const SIDE: usize = 80;

    fn size() -> Size {
        Size::square(SIDE).expect("legal")
    }

    fn dry(ground: &Field, cell: f64) -> NetworkMeasures {
        let none = Field::filled(size(), 0.0);
        measure(&NetworkInput { cell, ..still(ground, &none) })
    }

    /// Ground on which `none` flows and stands.
    fn still<'a>(ground: &'a Field, none: &'a Field) -> NetworkInput<'a> {
        NetworkInput {
            ground,
            before: None,
            depth: none,
            mean_flux_x: none,
            mean_flux_y: none,
            mean_rain: 0.005,
            cell: 1.0,
            valid: None,
        }
    }

    #[test]
    fn a_plane_drains_everywhere_and_has_no_pit() {
        let plane = Field::from_function(size(), |x, y| 3.0 * x as f32 + y as f32);
        let measures = dry(&plane, 1.0);
        assert_eq!((measures.drains, measures.pits, measures.chan), (1.0, 0, 0.0));
    }

    #[test]
    fn a_straight_valley_reaches_from_border_to_border() {
        let valley = Field::from_function(size(), |x, y| {
            y as f32 * 0.1 + if (38..42).contains(&x) { 0.0 } else { 20.0 }
        });
        let measures = dry(&valley, 1.0);
        assert_eq!(measures.reach, (SIDE - 1) as f64 / SIDE as f64);
        assert_eq!(measures.valley_largest, 1.0);
    }

    #[test]
    fn measures_do_not_depend_on_the_unit_of_length() {
        let rough = |scale: f32| {
            Field::from_function(size(), |x, y| {
                scale * (20.0 * weald_core::random::signed2(3, x as i64 / 3, y as i64 / 5) as f32)
            })
        };
        assert_eq!(dry(&rough(1.0), 1.0), dry(&rough(16.0), 16.0));
        assert!(dry(&rough(1.0), 1.0).drains < 0.9);
    }

    #[test]
    fn a_pit_cuts_off_its_own_cells_and_those_above_if_it_is_deep() {
        let tilted = |depth: f32| {
            Field::from_function(size(), |x, y| if (x, y) == (40, 40) { 40.0 - depth } else { x as f32 })
        };
        let (shallow, deep) = (dry(&tilted(1.4), 1.0), dry(&tilted(3.0), 1.0));
        assert_eq!((shallow.pits, deep.pits), (1, 1));
        assert_eq!(shallow.drains, 1.0);
        assert!(deep.drains < 1.0 && deep.drains > 0.9, "{}", deep.drains);
    }

    #[test]
    fn a_lake_is_an_outlet_for_the_land_around_it() {
        let bowl = Field::from_function(size(), |x, y| {
            let (x, y) = (x as f32 - 40.0, y as f32 - 40.0);
            (x * x + y * y).sqrt().min(30.0)
        });
        let water = Field::from_values(size(), bowl.values().iter().map(|h| (8.0 - h).max(0.0)).collect());
        let none = Field::filled(size(), 0.0);
        let with = |depth| measure(&NetworkInput { depth, ..still(&bowl, &none) });
        assert_eq!(with(&water).drains, 1.0);
        assert!(with(&none).drains < 0.6);
    }

    #[test]
    fn a_river_that_carries_the_rain_of_a_hundred_cells_is_channel() {
        let ground = Field::filled(size(), 0.0);
        let south = Field::from_function(size(), |x, y| if x == 40 { y as f32 * 2.0 * 0.005 } else { 0.0 });
        let none = Field::filled(size(), 0.0);
        let input = NetworkInput { mean_flux_y: &south, ..still(&ground, &none) };
        let channel = measure(&input).chan * (SIDE * SIDE) as f64;
        assert_eq!(channel.round(), 29.0, "half-sums 2y - 1 from row 51 to row 79");
    }

    #[test]
    fn what_was_carved_connects_where_a_ditch_was_cut() {
        let before = Field::from_function(size(), |x, _| x as f32);
        let ditch = |y: usize, width: f32| if (y as f32 - 40.0).abs() < width { 5.0 } else { 0.0 };
        let after = Field::from_function(size(), |x, y| x as f32 - ditch(y, 1.0));
        let none = Field::filled(size(), 0.0);
        let carve = measure(&NetworkInput { before: Some(&before), ..still(&after, &none) }).carve;
        let carve = carve.expect("the ground before is known");
        assert_eq!((carve.reach, carve.largest), ((SIDE - 1) as f64 / SIDE as f64, 1.0));
        assert_eq!(dry(&after, 1.0).carve, None);
    }

    #[test]
    fn cells_without_data_are_no_pits_no_valleys_and_take_what_drains_to_them() {
        let hole = |x: usize, y: usize| (30..50).contains(&x) && (30..50).contains(&y);
        // Without the mask, a deep pit without a way out.
        let ground = Field::from_function(size(), |x, y| if hole(x, y) { -500.0 } else { x as f32 });
        let valid = (0..SIDE * SIDE).map(|cell| !hole(cell % SIDE, cell / SIDE)).collect();
        let valid = Mask::new(size(), valid);
        let none = Field::filled(size(), 0.0);
        let masked = measure(&NetworkInput { valid: valid.as_ref(), ..still(&ground, &none) });
        assert_eq!((masked.drains, masked.pits, masked.valleys), (1.0, 0, None));
        let whole = dry(&ground, 1.0);
        assert!(whole.drains < 0.9 && whole.valleys.is_some(), "{whole:?}");
    }
}
