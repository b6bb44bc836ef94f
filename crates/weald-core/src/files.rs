//! The file system: that of the machine, or, in a browser, where there is none, one in memory.
//!
//! All of Weald reads and writes through this module, under the names that the standard library has for it.

#[cfg(any(target_arch = "wasm32", test))]
pub mod in_memory;

#[cfg(not(target_arch = "wasm32"))]
mod of_machine;

#[cfg(target_arch = "wasm32")]
pub use in_memory::*;
#[cfg(not(target_arch = "wasm32"))]
pub use of_machine::*;
