//! Planes that tiles are read from and written to, of which a rank has its own rows.

use weald_core::error::Error;
use weald_core::grid::Size;
use weald_core::plane::{HeldPlane, Plane, Window};
use weald_engine::ranks::Ranks;
use weald_engine::stored::{StoredPlane, swap_margins};

/// Cells around a tile that are read: one for its neighbours, one for theirs.
pub const MARGIN: usize = 2;

/// A plane that ranks share, and of which threads read several windows at once.
pub trait SharedPlane<T>: Plane<T> + Sync {
    /// Gets the rows around its own as they are now, so that [`MARGIN`] cells around each tile can be read. All ranks call it
    /// together.
    ///
    /// # Errors
    /// Those of the disk; [`Error::Run`] where another rank can no longer be reached.
    fn swap(&mut self, ranks: &dyn Ranks) -> Result<(), Error>;
}

impl SharedPlane<f32> for StoredPlane {
    fn swap(&mut self, ranks: &dyn Ranks) -> Result<(), Error> {
        swap_margins(&mut [self], MARGIN, ranks)
    }
}

impl<T: Copy + Sync> SharedPlane<T> for HeldPlane<T> {
    fn swap(&mut self, ranks: &dyn Ranks) -> Result<(), Error> {
        if ranks.count() == 1 {
            return Ok(());
        }
        Err(Error::Run("a plane in the memory of one process is not shared among ranks".to_owned()))
    }
}

/// Flags as they are stored, 1 and 0, to be read.
#[derive(Debug)]
pub struct StoredFlags<'a>(pub &'a StoredPlane);

impl Plane<u8> for StoredFlags<'_> {
    fn size(&self) -> Size {
        self.0.size()
    }

    fn read(&self, window: &Window) -> Result<Vec<u8>, Error> {
        Ok(self.0.read(window)?.into_iter().map(|flag| flag as u8).collect())
    }

    fn write(&mut self, _: &Window, _: &[u8]) -> Result<(), Error> {
        Err(Error::Run("which cells have data does not change".to_owned()))
    }
}

/// Codes of directions as a layer has them.
#[derive(Debug)]
pub struct StoredCodes(pub StoredPlane);

impl Plane<u8> for StoredCodes {
    fn size(&self) -> Size {
        self.0.size()
    }

    fn read(&self, window: &Window) -> Result<Vec<u8>, Error> {
        Ok(self.0.read(window)?.into_iter().map(|code| code as u8).collect())
    }

    fn write(&mut self, window: &Window, codes: &[u8]) -> Result<(), Error> {
        self.0.write(window, &codes.iter().map(|&code| f32::from(code)).collect::<Vec<_>>())
    }
}

impl SharedPlane<u8> for StoredCodes {
    fn swap(&mut self, ranks: &dyn Ranks) -> Result<(), Error> {
        self.0.swap(ranks)
    }
}
