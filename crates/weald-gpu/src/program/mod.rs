//! A program on a device: its buffers, its passes and its steps.

mod bound_passes;
mod buffers;
mod extents;
mod parts;
mod running;
mod state_copy;
mod uniforms;
mod watch;

pub(crate) use running::Running;
