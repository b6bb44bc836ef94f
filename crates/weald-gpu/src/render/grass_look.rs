//! How grass is looked at: whole, or as little of it as the picture needs.

/// What of a landscape's grass is drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GrassLook {
    /// Whether sets out of sight are left out. The picture is the same.
    pub culled: bool,
    /// Whether sets become fewer, and blades coarser, with the distance, up to 96 m. Otherwise all sets of the landscape
    /// are drawn, each blade with ten vertices a level of growth, as in the source.
    pub thinned: bool,
    /// Level of growth of all sets, 0 to 4, in place of their own.
    pub level: Option<f32>,
}

impl Default for GrassLook {
    fn default() -> Self {
        Self { culled: true, thinned: true, level: None }
    }
}
