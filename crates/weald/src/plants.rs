//! Plants: where they stand in a landscape and how each differs from its neighbours.

/// All plants of a name.
#[derive(Clone, Debug, PartialEq)]
pub struct Plants {
    /// What they are: the name of a fractal.
    pub kind: String,
    /// Least distance in metres between two of them.
    pub spacing: f64,
    /// The plants from north to south; the place in this list is a plant's number.
    pub plants: Vec<Plant>,
}

/// One plant.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Plant {
    /// Metres east and south of the north-western corner of the landscape, and the height of the ground there.
    pub place: [f64; 3],
    /// Unit vector along the stem: east, south, up.
    pub up: [f32; 3],
    /// Height of the plant in metres.
    pub size: f32,
    /// Turn about the stem in radians, from 0 to 2π, clockwise seen from above.
    pub turn: f32,
    /// Where in a gust the plant is, from 0 to 1: neighbours do not sway as one.
    pub phase: f32,
    /// How well the ground suits it, from 0 to 1.
    pub suitability: f32,
}
