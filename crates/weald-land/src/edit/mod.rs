//! Changing a landscape by hand while it is simulated, as a library: no window, no mouse, the same bits again.
//!
//! A [`Brush`] changes a [`Canvas`], plain fields over a rectangle of cells that any engine can hand over and
//! take back. A [`Script`] says which stroke happens before which iteration, and a [`History`] goes back
//! and forth over strokes, settings and steps, and along branches.
//!
//! ```
//! use weald_land::edit::{Area, Brush, Canvas, Effect, Falloff};
//! use weald_core::material::Material;
//! use weald_core::Size;
//!
//! let area = Area { first: [0, 0], size: Size::square(32)? };
//! let mut canvas = Canvas::level(area, 10.0, &Material::default_stack());
//! let levee = Brush {
//!     path: vec![[40.0, 160.0], [280.0, 160.0]],
//!     radius: 25.0,
//!     falloff: Falloff::Smooth,
//!     strength: 1.0,
//!     effect: Effect::Add { material: "soil".to_owned(), thickness: 3.0 },
//! };
//! let moved = levee.paint(&mut canvas)?;
//! assert!(moved.solid_added > 10_000.0 && moved.solid_removed == 0.0, "{moved:?}");
//! assert!(canvas.thickness[0].at(16, 16) > 2.5, "the levee is nearly 3 m high along its middle");
//! # Ok::<(), weald_core::Error>(())
//! ```

mod at_rest;
mod brush;
mod canvas;
mod change;
mod history;
mod json_lines;
mod keys;
mod paint;
mod painted_layer;
mod script;

pub use brush::{Brush, Effect, Falloff};
pub use canvas::{Area, Canvas};
pub use change::{Action, Change, Edit, Setting};
pub use history::{History, Undoable};
pub use keys::{EditKeys, MAX_PLACES, SettingKeys};
pub use paint::Volumes;
pub use painted_layer::{ENTRY as PAINTED_LAYER, PaintedLayer, PaintedStroke};
pub use script::{Layout, MAX_BYTES, MAX_STROKES, Script};
