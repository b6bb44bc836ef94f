//! What a simulation counts on every row, in cells³.

/// Rain that fell, as it changed the depths.
pub(crate) const RAINED: usize = 0;
/// Evaporation, negative.
pub(crate) const EVAPORATED: usize = 1;
/// Deposit that the deposit ratio took out.
pub(crate) const SHRUNK: usize = 2;
/// Water that left over an open edge.
pub(crate) const WATER_OUT: usize = 3;
/// Sediment that left over an open edge.
pub(crate) const SEDIMENT_OUT: usize = 4;

#[cfg(test)]
mod tests {
    use super::*;
    use weald_engine::program::twin::number;
    use weald_engine::stencil::chain::SUMS;

    #[test]
    fn the_shaders_count_in_the_same_places() {
        let shader = include_str!("sums.wgsl");
        let ours = [
            ("RAINED", RAINED),
            ("EVAPORATED", EVAPORATED),
            ("SHRUNK", SHRUNK),
            ("WATER_OUT", WATER_OUT),
            ("SEDIMENT_OUT", SEDIMENT_OUT),
        ];
        assert_eq!(ours.len(), SUMS);
        for (name, place) in ours {
            assert_eq!(number(shader, name) as usize, place, "{name}");
        }
    }
}
