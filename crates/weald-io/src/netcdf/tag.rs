//! Tags of the lists in a header.

pub(super) const ABSENT: u32 = 0;
pub(super) const DIMENSIONS: u32 = 10;
pub(super) const VARIABLES: u32 = 11;
pub(super) const ATTRIBUTES: u32 = 12;
