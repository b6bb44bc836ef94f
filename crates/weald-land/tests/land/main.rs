//! Processes, flow and edits by what they promise: equations, conservation, symmetry and the same bits on all engines.

mod combine;
mod common;
mod device_failure;
mod displace;
mod editing;
mod flow;
mod flow_paths;
mod flow_peers;
mod flow_tiled;
mod fluvial;
mod fluvial_banks;
mod fluvial_grid;
mod fluvial_ground;
mod layered_equations;
mod layered_physics;
mod physics;
mod published_equations;
mod reference;
mod runaway;
mod same_bits;
mod scaling;
mod stava;
mod stream_azimuths;
mod stream_power;
mod transport;
