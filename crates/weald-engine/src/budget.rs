//! Where water and solid came from and went, measured.

/// Water and solid of one simulation step of a recipe, in cubic metres.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Budget {
    /// Water.
    pub water: WaterBudget,
    /// Ground and sediment.
    pub solid: SolidBudget,
}

/// Water in cubic metres.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct WaterBudget {
    /// Rained, and standing at the start.
    pub incoming: f64,
    /// Evaporated, and run over an open edge.
    pub outgoing: f64,
    /// Standing at the end.
    pub stored: f64,
}

impl WaterBudget {
    /// `(in - out - stored) / in`; 0 where no water ever came.
    pub fn error(&self) -> f64 {
        relative(self.incoming - self.outgoing - self.stored, self.incoming.abs())
    }
}

/// Solid in cubic metres, measured from the lowest ground of the start, so that a landscape on a high
/// plateau does not hide an error behind the rock beneath it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SolidBudget {
    /// Ground at the start.
    pub start: f64,
    /// Ground at the end; the bedrock alone where layers are kept apart from it.
    pub ground: f64,
    /// Loose materials and regolith at the end, where they are kept apart.
    pub layers: f64,
    /// Carried by water at the end.
    pub suspended: f64,
    /// Carried over an open edge, and what a deposit ratio below 1 takes out.
    pub outgoing: f64,
}

impl SolidBudget {
    /// `(start - ground - layers - suspended - out) / start`; 0 where there was no solid.
    pub fn error(&self) -> f64 {
        let left = self.start - self.ground - self.layers - self.suspended - self.outgoing;
        relative(left, self.start.abs())
    }
}

fn relative(difference: f64, whole: f64) -> f64 {
    if whole == 0.0 { difference } else { difference / whole }
}
