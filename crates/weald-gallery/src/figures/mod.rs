//! The figures of the publications that Weald implements, made again and measured. [`FIGURES`] is the registry.

mod ages;
mod banks;
mod canyon;
mod cases;
mod claim;
mod cone;
mod deposits;
mod dissolution;
mod drift;
mod fault;
mod figure;
mod flow_rate;
mod force;
mod forms;
mod grass;
mod ground;
mod han;
mod ifs;
mod lake;
mod layered;
mod levee;
mod page;
mod parameters;
mod printed;
mod registry;
mod spacing;
mod stability;
mod start;
mod views;
mod weathering;
mod write;

pub use claim::{Claim, Verdict};
pub(crate) use figure::texts;
pub use figure::{Detail, Figure, FigureOutput, GalleryJob, Make, Measured, Plate};
pub use registry::FIGURES;
pub use write::{Begun, Selection, draws, selectable, write, write_figures};
