//! A program on a device: its buffers, its passes and its steps.

mod buffers;
mod extents;
mod kept;
mod parts;
mod ready;
mod running;
mod uniforms;
mod watch;

pub(crate) use running::Running;
