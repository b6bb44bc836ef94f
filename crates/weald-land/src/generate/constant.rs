//! Flat ground: the same height everywhere.

use std::ops::Range;

use weald_core::domain::Domain;
use weald_core::error::Error;
use weald_core::grid::{Field, Size};
use weald_core::parameter::LayerName;
use weald_core::parameters;
use weald_engine::generator::Generator;
use weald_engine::step::{Entry, Stage};

/// The step's declaration.
pub const ENTRY: Entry =
    Entry::of::<Constant>("constant", Stage::Generate, "flat ground: the same height everywhere", "Weald");

parameters! {
    /// Flat ground.
    ///
    /// ```
    /// # use weald_core::{Domain, Error, Landscape, Size};
    /// # use weald_engine::{Job, step::Step};
    /// # use weald_land::generate::constant::Constant;
    /// let mut landscape = Landscape::new(Domain::new(Size::new(8, 6)?, 10.0)); // columns, rows, metres
    /// Constant { height: 250.0, ..Constant::default() }.run(&mut landscape, &Job::unwatched(0))?;
    /// assert_eq!(landscape.field("height")?.range(None), Some((250.0, 250.0)));
    /// # Ok::<(), Error>(())
    /// ```
    pub struct Constant {
        /// Height everywhere.
        height: f64 = 0.0, range -1.0e6..=1.0e6, unit "m";
        /// Layer that is written.
        into: LayerName = LayerName::of("height");
    }
}

impl Generator for Constant {
    fn fill(&self, domain: &Domain, _: u64) -> Result<Field, Error> {
        Ok(Field::filled(domain.size, self.height as f32))
    }

    fn fill_rows(&self, domain: &Domain, _: u64, rows: Range<usize>) -> Option<Field> {
        let size = Size { columns: domain.size.columns, rows: rows.len() };
        Some(Field::filled(size, self.height as f32))
    }

    fn target(&self) -> &LayerName {
        &self.into
    }
}
