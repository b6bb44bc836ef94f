//! How long a step takes over ranks: a model of computing, latency and bandwidth.
//!
//! ```text
//! T(p) = columns (rows/p + h) / rate  +  m (latency / block + bytes / bandwidth)
//! h = reach (block - 1)    rows that a rank computes for its neighbours, on both sides together, in a step of a block
//! m = 0, 1 or 2            neighbours
//! ```
//!
//! A block is the steps between two exchanges. Between them a rank computes rows of its neighbours again, fewer with each
//! step, in place of a message a step.

/// What ranks do on the machine at hand.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Machine {
    /// Cells a second of one rank.
    pub(crate) rate: f64,
    /// Seconds until a short message is there.
    pub(crate) latency: f64,
    /// Bytes per second to one neighbour.
    pub(crate) bandwidth: f64,
}

/// What a simulation asks of them.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Traffic {
    /// How many rows off a cell feels others in a step.
    pub(crate) reach: f64,
    /// Steps between two exchanges.
    pub(crate) block: f64,
    /// Bytes a step, neighbour and column.
    pub(crate) bytes: f64,
}

/// What a step takes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct StepTime {
    pub(crate) computing: f64,
    pub(crate) messages: f64,
}

impl StepTime {
    pub(crate) fn seconds(self) -> f64 {
        self.computing + self.messages
    }
}

/// A step of a grid over so many ranks, of which the slowest has two neighbours where there are three or more.
pub(crate) fn step_time(
    machine: Machine,
    traffic: Traffic,
    [columns, rows]: [f64; 2],
    ranks: usize,
) -> StepTime {
    let neighbours = ranks.saturating_sub(1).min(2) as f64;
    let others = traffic.reach * (traffic.block - 1.0) * neighbours / 2.0;
    let messages = machine.latency / traffic.block + traffic.bytes * columns / machine.bandwidth;
    StepTime {
        computing: columns * (rows / ranks as f64 + others) / machine.rate,
        messages: neighbours * messages,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const MACHINE: Machine = Machine { rate: 1e8, latency: 1e-6, bandwidth: 1e9 };
    const TRAFFIC: Traffic = Traffic { reach: 4.0, block: 4.0, bytes: 85.0 };

    #[test]
    fn one_rank_computes_alone_and_many_are_bound_by_their_messages() {
        let grid = [1000.0, 1000.0];
        let alone = step_time(MACHINE, TRAFFIC, grid, 1);
        assert_eq!(alone, StepTime { computing: 0.01, messages: 0.0 });
        let two = step_time(MACHINE, TRAFFIC, grid, 2);
        assert!((two.computing - 1000.0 * 506.0 / 1e8).abs() < 1e-12, "{two:?}");
        assert!((two.messages - (0.25e-6 + 85e-6)).abs() < 1e-12, "{two:?}");
        let three = step_time(MACHINE, TRAFFIC, grid, 3);
        assert!((three.messages - 2.0 * two.messages).abs() < 1e-12);
        let most = step_time(MACHINE, TRAFFIC, grid, 1_000_000).seconds();
        assert!(most > 2.0 * 85e-6 && most < alone.seconds(), "{most}");
    }
}
