//! The two-dimensional Haar wavelet of PIZ, undone in place from the coarsest level to the finest.

/// Words that form a plane among others.
#[derive(Clone, Copy, Debug)]
pub(super) struct Plane {
    /// Position of its first word.
    pub(super) first: usize,
    pub(super) columns: usize,
    pub(super) rows: usize,
    /// Words from one column to the next.
    pub(super) step: usize,
}

impl Plane {
    fn at(&self, x: usize, y: usize) -> usize {
        self.first + (y * self.columns + x) * self.step
    }

    /// Turns wavelets into words. `greatest` is the greatest word there is: up to 14 bits leave room to work
    /// in plain 16-bit arithmetic, more need arithmetic modulo 2¹⁶.
    pub(super) fn undo(&self, words: &mut [u16], greatest: u16) {
        let pair = if greatest < 1 << 14 { plain } else { modular };
        let shorter = self.columns.min(self.rows);
        let mut reach = if shorter == 0 { 0 } else { 1 << shorter.ilog2() };
        while reach > 1 {
            let near = reach / 2;
            self.undo_level(words, near, pair);
            reach = near;
        }
    }

    /// Undoes the level at which words `near` apart are pairs.
    fn undo_level(&self, words: &mut [u16], near: usize, pair: fn(u16, u16) -> (u16, u16)) {
        let reach = 2 * near;
        let mut undo = |low: usize, high: usize| (words[low], words[high]) = pair(words[low], words[high]);
        let (whole_x, whole_y) = (self.columns / reach * reach, self.rows / reach * reach);
        for y in (0..whole_y).step_by(reach) {
            for x in (0..whole_x).step_by(reach) {
                let [here, east] = [self.at(x, y), self.at(x + near, y)];
                let [south, south_east] = [self.at(x, y + near), self.at(x + near, y + near)];
                undo(here, south);
                undo(east, south_east);
                undo(here, east);
                undo(south, south_east);
            }
            // A column that is left over has partners to the south alone.
            if self.columns & near != 0 {
                undo(self.at(whole_x, y), self.at(whole_x, y + near));
            }
        }
        if self.rows & near != 0 {
            for x in (0..whole_x).step_by(reach) {
                undo(self.at(x, whole_y), self.at(x + near, whole_y));
            }
        }
    }
}

/// Two words from their mean and difference.
fn plain(mean: u16, difference: u16) -> (u16, u16) {
    let (mean, difference) = (i32::from(mean as i16), i32::from(difference as i16));
    let first = mean + (difference & 1) + (difference >> 1);
    (first as u16, (first - difference) as u16)
}

/// As [`plain`], modulo 2¹⁶.
fn modular(mean: u16, difference: u16) -> (u16, u16) {
    let second = mean.wrapping_sub(difference >> 1);
    (difference.wrapping_add(second).wrapping_sub(1 << 15), second)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Mean and difference as the Technical Introduction gives them.
    fn mean_and_difference(first: u16, second: u16) -> (u16, u16) {
        let (first, second) = (i32::from(first), i32::from(second));
        (((first + second) >> 1) as u16, (first - second) as u16)
    }

    #[test]
    fn a_mean_and_a_difference_give_both_words_back() {
        for (first, second) in [(0, 0), (1, 0), (0, 1), (16383, 0), (0, 16383), (77, 78), (9000, 1234)] {
            let (mean, difference) = mean_and_difference(first, second);
            assert_eq!(plain(mean, difference), (first, second));
        }
    }

    #[test]
    fn a_plane_of_means_alone_is_level() {
        let plane = Plane { first: 0, columns: 7, rows: 5, step: 1 };
        let mut words = vec![0; 35];
        // The coarsest mean of each group: reach 4 over 7 × 5, and what is left over of each finer level.
        plane.undo(&mut words, 9);
        assert_eq!(words, [0; 35]);
        words[0] = 6;
        plane.undo(&mut words, 9);
        let level = [[6; 4].as_slice(), &[0; 3]].concat();
        assert_eq!(words[..28], [level.as_slice(); 4].concat());
    }
}
