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
    /// Raised by uplift.
    pub uplifted: f64,
    /// Ground at the end; the bedrock alone where layers are kept apart from it.
    pub ground: f64,
    /// Loose materials and regolith at the end, where they are kept apart.
    pub layers: f64,
    /// Carried by water at the end.
    pub suspended: f64,
    /// Carried over an open edge or by drains, and what a deposit ratio below 1 takes out.
    pub outgoing: f64,
    /// What lies, hangs in water or went elsewhere than at the start: all that cells gained or lost, carry or let go.
    pub moved: f64,
}

impl SolidBudget {
    /// `start + uplifted - ground - layers - suspended - out`: what is missing, in cubic metres; below 0 what was made.
    pub fn lost(&self) -> f64 {
        self.start + self.uplifted - self.ground - self.layers - self.suspended - self.outgoing
    }

    /// What is missing, as a share of the solid at the start or of what moved, whichever is more: on flat ground there is
    /// nothing above its lowest place, and rounding would count against nothing.
    pub fn error(&self) -> f64 {
        relative(self.lost(), self.start.abs().max(self.moved))
    }
}

fn relative(difference: f64, whole: f64) -> f64 {
    if whole == 0.0 { difference } else { difference / whole }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn on_flat_ground_what_is_missing_counts_against_what_moved() {
        let dug = SolidBudget { ground: -1.49, moved: 1.5e6, ..SolidBudget::default() };
        assert!((dug.error() - 1.49 / 1.5e6).abs() < 1e-15, "{}", dug.error());
        let hill = SolidBudget { start: 2e6, ground: 2e6 - 4.0, moved: 10.0, ..SolidBudget::default() };
        assert_eq!(hill.error(), 2e-6, "of the hill, where that is more");
        assert_eq!(SolidBudget::default().error(), 0.0);
    }
}
