//! Rivers: which cells they are, how wide and deep, and as lines from their heads to where they end.
//!
//! A cell is river where the land above it is large enough, and so is all below such a cell: a river goes on
//! until water leaves the grid or the data, or reaches a lake or the sea, by construction. Its size follows
//! from its discharge `Q` by the hydraulic geometry of
//!
//! ```text
//! width = a Q^b        depth = c Q^f
//! ```
//!
//! Leopold and Maddock 1953, "The hydraulic geometry of stream channels and some physiographic implications",
//! doi 10.3133/pp252: b = 0.5, f = 0.4. The coefficients for the mean annual discharge are those of Moody and
//! Troutman 2002, "Characterization of the spatial variability of channel morphology", doi 10.1002/esp.403:
//! a = 7.2, c = 0.27. Orders are Strahler's (1957, doi 10.1029/TR038i006p00913).

mod network;
mod reach;
mod smooth;
mod step;
mod trace;

pub use step::{ENTRY, RiversStep};

pub use reach::{End, Reach, RiverPoint, Rivers, Start};
use weald_core::error::Error;
use weald_core::landscape::Landscape;

impl Rivers {
    /// Reads the rivers out of the layers that the step `rivers` and the steps before it write: `river`,
    /// `river_width`, `river_depth`, `river_level`, `discharge`, `strahler`, `flow_direction`, `accumulation`,
    /// and `lake` if it is there.
    ///
    /// # Errors
    /// [`Error::Run`] for a layer that is missing, or directions that lead nowhere.
    pub fn of(landscape: &Landscape) -> Result<Self, Error> {
        trace::rivers(landscape)
    }

    /// The main stems: each from a head to an outlet, the sea, an end in a lake without outlet, or its
    /// confluence with a greater one. At a confluence the stem comes from the reach of greatest upslope area.
    /// Every reach is in one stem; each stem lists its reaches from head to end, the longest stems first.
    pub fn stems(&self) -> Vec<Vec<usize>> {
        let main = self.main_tributaries();
        let ends = (0..self.reaches.len())
            .filter(|&reach| self.reaches[reach].downstream.is_none_or(|next| main[next] != Some(reach)));
        let mut stems: Vec<Vec<usize>> = ends
            .map(|end| {
                let mut stem: Vec<_> = std::iter::successors(Some(end), |&reach| main[reach]).collect();
                stem.reverse();
                stem
            })
            .collect();
        let length = |stem: &Vec<usize>| stem.iter().map(|&reach| self.reaches[reach].length()).sum::<f64>();
        stems.sort_by(|a, b| length(b).total_cmp(&length(a)));
        stems
    }

    /// For each reach the one that flows into it and drains most.
    fn main_tributaries(&self) -> Vec<Option<usize>> {
        let mut main: Vec<Option<usize>> = vec![None; self.reaches.len()];
        for (reach, next) in
            self.reaches.iter().enumerate().filter_map(|(at, reach)| Some((at, reach.downstream?)))
        {
            let area = |reach: usize| self.reaches[reach].lowest_area();
            if main[next].is_none_or(|other| area(reach) > area(other)) {
                main[next] = Some(reach);
            }
        }
        main
    }
}
