//! Plants from codes: iterated function systems (IFS), the addresses of their points, and what bends them.
//!
//! An [`Ifs`] is a set of maps that contract; its points come from [random iteration](game) or from an
//! [expansion] of all codes, and each carries its [`Code`]. [`shapes`] has the built-in ones.

pub mod address;
pub mod code;
pub mod deform;
pub mod device;
pub mod expansion;
pub mod flame;
pub mod foliage;
pub mod game;
pub mod histogram;
pub mod lanes;
pub mod limbs;
pub mod map;
pub mod packing;
pub mod shader;
pub mod shapes;
mod support;
pub mod system;
pub mod table;
#[cfg(test)]
mod tests;
pub mod wind;

pub use address::code_of;
pub use code::{Code, Digits};
pub use deform::{Deform, Deformation};
pub use expansion::Coded;
pub use game::{Block, Game};
pub use histogram::{Histogram, Window};
pub use map::{Map, Point};
pub use packing::Packer;
pub use system::{Draft, Ifs, IfsFault, Role, Weighted, even_probabilities};
pub use table::Table;
pub use wind::{Pose, Sway, Wind};
