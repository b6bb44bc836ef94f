//! Disjoint sets of basins, by a forest whose ways to the root are halved whenever they are walked (van der Weide
//! 1980; Tarjan and van Leeuwen 1984, doi 10.1145/62.2160). The root of a set is its lowest number.

/// Sets of basins.
pub(crate) struct DisjointSets {
    parent: Vec<u32>,
}

impl DisjointSets {
    /// Every basin alone.
    pub(crate) fn new(basins: usize) -> Self {
        Self { parent: (0..basins as u32).collect() }
    }

    /// The basin that stands for the set of another.
    pub(crate) fn root(&mut self, mut basin: u32) -> u32 {
        while self.parent[basin as usize] != basin {
            let above = self.parent[self.parent[basin as usize] as usize];
            self.parent[basin as usize] = above;
            basin = above;
        }
        basin
    }

    /// Joins the sets of two basins; false where they are one already.
    pub(crate) fn join(&mut self, basins: [u32; 2]) -> bool {
        let [a, b] = basins.map(|basin| self.root(basin));
        self.parent[a.max(b) as usize] = a.min(b);
        a != b
    }

    /// Makes basins sets of their own again, once all that were joined are listed.
    pub(crate) fn forget(&mut self, basins: [u32; 2]) {
        for basin in basins {
            self.parent[basin as usize] = basin;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sets_are_joined_once_under_their_lowest_number_and_fall_apart_when_forgotten() {
        let mut union = DisjointSets::new(5);
        assert_eq!([[4, 3], [2, 3], [4, 2], [0, 1]].map(|pair| union.join(pair)), [true, true, false, true]);
        assert_eq!([0, 1, 2, 3, 4].map(|basin| union.root(basin)), [0, 0, 2, 2, 2]);
        union.forget([4, 3]);
        assert_eq!([0, 1, 2, 3, 4].map(|basin| union.root(basin)), [0, 0, 2, 3, 4]);
    }
}
