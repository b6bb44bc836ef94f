//! Cells in an order in which each comes before its receiver, and what gathers down the rivers.
//!
//! From each cell into which nothing drains the river is followed as far as all that drains into it is known (the stack of
//! Braun and Willett 2013 from its other end). Cells of a river so lie beside each other in the order, which is what makes
//! passes over it fast. The order depends on the receivers alone.

/// Each cell with data once, those upstream first.
#[derive(Debug)]
pub(super) struct Order {
    pub(super) downstream: Vec<u32>,
    /// Cells that drain into each and were not yet met.
    waiting: Vec<u8>,
}

/// The cell is in the order already.
const MET: u8 = u8::MAX;

impl Order {
    /// None yet, over so many cells.
    pub(super) fn none(cells: usize) -> Self {
        Self { downstream: Vec::with_capacity(cells), waiting: vec![0; cells] }
    }

    /// Orders the cells anew, and adds the area of each to all cells downstream. Those without data, at infinite heights, are
    /// left out.
    pub(super) fn find(&mut self, receivers: &[u32], heights: &[f64], area: &mut [f64]) {
        self.waiting.fill(0);
        for (cell, &receiver) in receivers.iter().enumerate() {
            self.waiting[receiver as usize] += u8::from(receiver as usize != cell);
        }
        self.downstream.clear();
        for (cell, &height) in heights.iter().enumerate() {
            if self.waiting[cell] == 0 && height < f64::INFINITY {
                self.follow(cell, receivers, area);
            }
        }
    }

    fn follow(&mut self, mut cell: usize, receivers: &[u32], area: &mut [f64]) {
        loop {
            self.downstream.push(cell as u32);
            self.waiting[cell] = MET;
            let receiver = receivers[cell] as usize;
            if receiver == cell {
                return;
            }
            // All that drains into the cell has come before it.
            area[receiver] += area[cell];
            self.waiting[receiver] -= 1;
            if self.waiting[receiver] > 0 {
                return;
            }
            cell = receiver;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_cell_comes_once_and_before_its_receiver() {
        // Two rivers that meet in cell 2 and end in 0, and a cell that drains nowhere.
        let receivers = [0, 2, 0, 2, 3, 1, 6];
        let mut order = Order::none(7);
        let mut area = vec![1.0; 7];
        order.find(&receivers, &[1.0; 7], &mut area);
        let place = |cell: u32| order.downstream.iter().position(|&other| other == cell).expect("is there");
        assert_eq!(order.downstream.len(), 7);
        assert!(
            (0..7).all(|cell| receivers[cell] == cell as u32 || place(cell as u32) < place(receivers[cell]))
        );
        assert_eq!(area, [6.0, 2.0, 5.0, 2.0, 1.0, 1.0, 1.0]);
    }
}
