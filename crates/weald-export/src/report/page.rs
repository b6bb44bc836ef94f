//! The parameters of a page.

use weald_core::parameter::LayerName;
use weald_core::parameters;

parameters! {
    /// A page about a run.
    pub struct Page {
        /// Layer of heights in metres.
        of: LayerName = LayerName::of("height");
        /// Width of the relief picture; maps of layers are drawn at a third of it.
        width: u32 = 1080, range 240..=4096, unit "px";
        /// Whether the page has a map of each layer.
        maps: bool = true;
        /// How many of the longest rivers have their profiles drawn.
        profiles: u32 = 5, range 1..=8;
    }
}
