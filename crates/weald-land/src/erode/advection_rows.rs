//! What advection reads, on rows and on a device.

use crate::erode::sweep::Sweep;
use weald_engine::stencil::ring::Ring;

/// What the transport reads.
pub(crate) struct AdvectionRows<'a> {
    pub(crate) sediment: &'a Ring,
    /// Water before it flowed; its newest row is read alone.
    pub(crate) depth: &'a Ring,
    /// Velocities, or water through the eastern and southern faces where transport is in flux form.
    pub(crate) eastward: &'a Ring,
    pub(crate) southward: &'a Ring,
    pub(crate) sweep: Sweep<'a>,
}

/// What a model tells the shaders of the transport.
pub(crate) struct Advected<'a> {
    /// Shaders with `settled_sediment(cell)` and `velocity(cell)`; for transport in flux form `face_east(cell)`,
    /// `face_south(cell)` and `water_before(cell)` in place of the velocity.
    pub(crate) from: &'a [&'static str],
    /// Shaders with `arrive(cell, amount)`.
    pub(crate) into: &'a [&'static str],
    /// Buffers that `from` reads.
    pub(crate) reads: &'a [&'a str],
    /// Buffers that `into` reads; they are among those of `from`.
    pub(crate) keeps: &'a [&'a str],
    /// Buffer that `into` writes.
    pub(crate) writes: &'a str,
}
