//! Where and how simulations run.

use std::sync::Arc;

use crate::device::{Device, ShownGround};
use crate::ranks::Ranks;
use weald_core::error::Error;
use weald_core::grid::Size;

/// What a note says of a simulation that a device could not finish: its bits are partly those of the CPU.
pub const WENT_ON_ON_CPU: &str = "went on on the CPU";

/// Where and how simulations run. On all but devices the bits of the result do not depend on it.
#[derive(Clone, Debug, Default)]
pub enum Engine {
    /// All threads of the current rayon pool, in shared memory.
    #[default]
    Cpu,
    /// The domain cut into this many bands that own their memory and exchange halos by messages: what a
    /// cluster's ranks do, without a cluster.
    Bands(usize),
    /// The domain cut into tiles of up to this many columns and rows, one after the other: what a device
    /// does whose memory is too small, without a device.
    Tiles(Size),
    /// Processes that compute together, each with a band of the domain: all of them run the same steps.
    Ranks(Arc<dyn Ranks>),
    /// A device; an error where it fails.
    Device(Arc<dyn Device>),
    /// A device, and the CPU from the last checkpoint on where it fails.
    DeviceElseCpu(Arc<dyn Device>),
}

impl Engine {
    /// Name in the report.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Cpu => "cpu",
            Self::Bands(_) => "bands",
            Self::Tiles(_) => "tiles",
            Self::Ranks(_) => "ranks",
            Self::Device(_) | Self::DeviceElseCpu(_) => "gpu",
        }
    }

    /// The ranks, where another one leads than this.
    pub fn led_by(&self) -> Option<&Arc<dyn Ranks>> {
        match self {
            Self::Ranks(ranks) if !ranks.leads() => Some(ranks),
            _ => None,
        }
    }

    /// Tells a device where the ground of the next simulation lies.
    pub fn shows(&self, ground: &ShownGround<'_>) -> Result<(), Error> {
        match self {
            Self::Device(device) | Self::DeviceElseCpu(device) => device.shows(ground),
            _ => Ok(()),
        }
    }

    /// The adapter in the report.
    pub fn adapter(&self) -> Option<String> {
        match self {
            Self::Device(device) | Self::DeviceElseCpu(device) => Some(device.adapter()),
            _ => None,
        }
    }
}
