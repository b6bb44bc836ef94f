//! Which machine an engine is.

use std::sync::Arc;

use super::cpu::CpuMachine;
use super::device_machine::{self, DeviceMachine};
use super::device_tiles::DeviceTiles;
use super::engine::Engine;
use super::machine::{Machine, Means, Snapshot};
use super::tiles::{CpuTiles, Plan, Tiled};
use crate::ranks::RanksMachine;
use crate::stencil::chain::Process;
use weald_core::error::Error;

/// The machine of an engine with `start` as its state. Over ranks the first one has it, and the others
/// [`follow`](crate::ranks::follow).
pub fn start<P: Process>(
    process: &Arc<P>,
    means: Means<'static>,
    start: &Snapshot,
    engine: &Engine,
) -> Result<Box<dyn Machine<P>>, Error> {
    let size = start.size();
    Ok(match engine {
        Engine::Cpu => Box::new(CpuMachine::new(process, means, start, None)),
        Engine::Bands(count) => Box::new(CpuMachine::new(process, means, start, Some(*count))),
        Engine::Tiles(own) => {
            let plan = Plan::of_own(*own, process.reach());
            Box::new(Tiled::new(CpuTiles { process: Arc::clone(process), means }, start, plan))
        }
        Engine::Ranks(ranks) => Box::new(RanksMachine::new(process, means, start, ranks)?),
        Engine::Device(device) | Engine::DeviceElseCpu(device) => {
            let program = process.program();
            let most = device_machine::most_cells(&program, &**device);
            if size.cells() as u64 <= most {
                Box::new(DeviceMachine::new(program, start, device)?)
            } else {
                let plan = Plan::of_memory(most, program.reach, size)?;
                let tile = plan.largest_tile(size);
                Box::new(Tiled::new(DeviceTiles::new(program, &**device, tile)?, start, plan))
            }
        }
    })
}
