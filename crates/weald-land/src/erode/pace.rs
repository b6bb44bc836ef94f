//! How many steps lie between two looks for NaN, interruption and checkpoints.

use std::time::Duration;

use weald_engine::Engine;

/// On the CPU: about this many cell-steps.
const CELL_STEPS: usize = 100_000_000;

/// On a device, where a look costs more than on the CPU and rates differ a thousandfold: about this long.
const TIME: Duration = Duration::from_millis(400);

/// Steps from one look to the next. They change how soon a run notices the user, and nothing else.
pub(crate) struct Pace {
    steps: u64,
    adapts: bool,
}

impl Pace {
    pub(crate) fn new(engine: &Engine, cells: usize, block: usize) -> Self {
        let adapts = matches!(engine, Engine::Device(_) | Engine::DeviceElseCpu(_));
        let steps = if adapts { block } else { (CELL_STEPS / cells).clamp(block, 256) };
        Self { steps: steps.max(1) as u64, adapts }
    }

    /// Steps of the next stretch.
    pub(crate) fn steps(&self) -> u64 {
        self.steps
    }

    /// Is told how long a stretch took.
    pub(crate) fn took(&mut self, time: Duration) {
        if self.adapts {
            let factor = TIME.as_secs_f64() / time.as_secs_f64().max(1e-6);
            self.steps = (self.steps as f64 * factor.clamp(0.25, 4.0)).clamp(1.0, 1e6) as u64;
        }
    }
}
