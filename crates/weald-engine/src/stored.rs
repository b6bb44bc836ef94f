//! A landscape that no process holds as a whole: its layers lie on disk, or each rank has its own rows of them, and steps
//! work on parts of them.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Debug;
use std::ops::Range;
use std::sync::Arc;

use crate::ranks::{Ranks, SharedRows, agreed, joined};
pub use crate::stored_plane::{StoredPlane, swap_margins};
use crate::stored_state::ResumedState;
use weald_core::domain::Domain;
use weald_core::error::{Error, NotFinite};
use weald_core::files::File;
use weald_core::grid::{Mask, Size};

/// Where planes are made.
pub trait Scratch: Debug + Sync {
    /// An empty file that is gone when it is closed, however the process ends; none where planes lie in memory.
    ///
    /// # Errors
    /// [`Error::Run`] where none can be made.
    fn file(&self) -> Result<Option<File>, Error>;
}

/// A layer.
#[derive(Debug)]
pub struct StoredLayer {
    /// Unit of its values.
    pub unit: String,
    /// Its values.
    pub plane: StoredPlane,
}

/// A landscape of which this process has its own rows.
#[derive(Debug)]
pub struct StoredLandscape<'a> {
    /// Its grid; which of its cells have data, [`StoredLandscape::valid`] tells.
    pub domain: Domain,
    /// Most bytes of memory that a step may take, the same on all ranks.
    pub memory: u64,
    /// The ranks that share it; one that is [alone](crate::ranks::Alone) has all rows. Steps call the same collective
    /// functions on all of them.
    pub ranks: Arc<dyn Ranks>,
    rows: SharedRows,
    scratch: &'a dyn Scratch,
    layers: BTreeMap<String, StoredLayer>,
    wanted: BTreeSet<String>,
    valid: Option<Arc<StoredPlane>>,
    /// Where the step that runs next goes on, if it was interrupted before.
    pub resumed: Option<ResumedState>,
}

impl<'a> StoredLandscape<'a> {
    /// A landscape without layers.
    pub fn new(domain: Domain, memory: u64, (scratch, ranks): (&'a dyn Scratch, Arc<dyn Ranks>)) -> Self {
        let rows = SharedRows::of((ranks.rank(), ranks.count()), domain.size.rows);
        let (layers, wanted) = (BTreeMap::new(), BTreeSet::new());
        Self { domain, memory, ranks, rows, scratch, layers, wanted, valid: None, resumed: None }
    }

    /// Which cells have data, as 1 and 0; `None` where all have.
    pub fn valid(&self) -> Option<&StoredPlane> {
        self.valid.as_deref()
    }

    /// Which cells of some rows have data; `None` where all have.
    ///
    /// # Errors
    /// Those of the disk.
    pub fn valid_rows(&self, rows: Range<usize>) -> Result<Option<Mask>, Error> {
        let Some(valid) = self.valid() else { return Ok(None) };
        let size = Size { columns: self.domain.size.columns, rows: rows.len() };
        Ok(Mask::new(size, valid.rows(rows)?.into_iter().map(|flag| flag > 0.0).collect()))
    }

    /// Says which cells have data, on all ranks.
    pub fn set_valid(&mut self, valid: Option<StoredPlane>) {
        self.valid = valid.map(Arc::new);
    }

    /// The same with so many rows around its own, for a step that lets go of it before another asks. All ranks call it
    /// together.
    ///
    /// # Errors
    /// As [`swap_margins`].
    pub fn valid_around(&mut self, margin: usize) -> Result<Option<Arc<StoredPlane>>, Error> {
        if let Some(valid) = &mut self.valid {
            let valid = Arc::get_mut(valid).expect("no step holds it that has ended");
            swap_margins(&mut [valid], margin, &*self.ranks)?;
        }
        Ok(self.valid.clone())
    }

    /// How its rows are shared.
    pub fn rows(&self) -> &SharedRows {
        &self.rows
    }

    /// Says which layers are needed from now on; the others are dropped, and none of another name is kept.
    pub fn want(&mut self, wanted: BTreeSet<String>) {
        self.layers.retain(|name, _| wanted.contains(name));
        self.wanted = wanted;
    }

    /// Whether a layer is needed by anything to come.
    pub fn wants(&self, name: &str) -> bool {
        self.wanted.contains(name)
    }

    /// A new plane of zeros.
    ///
    /// # Errors
    /// [`Error::Run`] where it cannot be made on any of the ranks, all of which make it together.
    pub fn plane(&self, name: &str) -> Result<StoredPlane, Error> {
        self.plane_of(name, (self.domain.size.columns, &self.rows))
    }

    /// The same on another grid.
    ///
    /// # Errors
    /// As [`StoredLandscape::plane`].
    pub fn plane_of(&self, name: &str, grid: (usize, &SharedRows)) -> Result<StoredPlane, Error> {
        agreed(&*self.ranks, self.plane_alone(name, grid))
    }

    /// The same on this rank alone.
    ///
    /// # Errors
    /// [`Error::Run`] where it cannot be made.
    pub fn plane_alone(&self, name: &str, grid: (usize, &SharedRows)) -> Result<StoredPlane, Error> {
        StoredPlane::new(name, self.scratch.file()?, grid)
    }

    /// A layer.
    ///
    /// # Errors
    /// [`Error::Run`] where there is none of that name.
    pub fn layer(&self, name: &str) -> Result<&StoredLayer, Error> {
        self.layers.get(name).ok_or_else(|| missing(name))
    }

    /// All layers by their names.
    pub fn layers(&self) -> impl Iterator<Item = (&str, &StoredLayer)> {
        self.layers.iter().map(|(name, layer)| (name.as_str(), layer))
    }

    /// Takes a layer out.
    pub fn remove(&mut self, name: &str) -> Option<StoredLayer> {
        self.layers.remove(name)
    }

    /// Puts in a layer that [is wanted](Self::wants), in place of one of that name.
    pub fn insert(&mut self, name: &str, unit: &str, plane: StoredPlane) {
        if self.wants(name) {
            self.layers.insert(name.to_owned(), StoredLayer { unit: unit.to_owned(), plane });
        }
    }

    /// The same, to be changed.
    ///
    /// # Errors
    /// As [`StoredLandscape::layer`].
    pub fn layer_mut(&mut self, name: &str) -> Result<&mut StoredLayer, Error> {
        self.layers.get_mut(name).ok_or_else(|| missing(name))
    }

    /// Least and greatest value of the cells of a layer that have data, over all ranks.
    ///
    /// # Errors
    /// [`Error::NotFinite`] naming the first cell that holds a NaN or an infinity; those of the disk.
    pub fn range(&self, name: &str) -> Result<(f32, f32), Error> {
        let seen = agreed(&*self.ranks, self.layer(name).and_then(|layer| seen(&layer.plane, self.valid())))?;
        let not_finite = match &seen {
            Seen::NotFinite([x, y], value) => Some([*x as f64, *y as f64, f64::from(*value)]),
            Seen::Range(_) => None,
        };
        if let Some([x, y, value]) = joined(&*self.ranks, not_finite, |first, _| first)? {
            let cell = [x as usize, y as usize];
            let message =
                format!("layer `{name}` became {value} at column {x}, row {y}; gentler parameters may help");
            let layer = name.to_owned();
            return Err(NotFinite { step: None, iteration: None, layer, cell, message }.into());
        }
        let own = match seen {
            Seen::Range(range) => range.map(|(low, high)| [f64::from(low), f64::from(high)]),
            Seen::NotFinite(..) => None,
        };
        let join = |[low, high]: [f64; 2], [other_low, other_high]: [f64; 2]| {
            [low.min(other_low), high.max(other_high)]
        };
        let range = joined(&*self.ranks, own, join)?;
        Ok(range.map(|[low, high]| (low as f32, high as f32)).unwrap_or_default())
    }
}

/// What this rank's own rows of a plane hold.
enum Seen {
    /// Column and row of the first value that is no finite number, and that.
    NotFinite([usize; 2], f32),
    /// Least and greatest value, where there are rows.
    Range(Option<(f32, f32)>),
}

fn seen(plane: &StoredPlane, valid: Option<&StoredPlane>) -> Result<Seen, Error> {
    let mut range: Option<(f32, f32)> = None;
    for rows in plane.runs_of_rows() {
        let values = plane.rows(rows.clone())?;
        let valid = valid.map(|valid| valid.rows(rows.clone())).transpose()?;
        let has_data = |at: usize| valid.as_ref().is_none_or(|valid| valid[at] > 0.0);
        for (at, &value) in values.iter().enumerate().filter(|&(at, _)| has_data(at)) {
            if !value.is_finite() {
                let columns = values.len() / rows.len();
                return Ok(Seen::NotFinite([at % columns, rows.start + at / columns], value));
            }
            let (low, high) = range.unwrap_or((value, value));
            range = Some((low.min(value), high.max(value)));
        }
    }
    Ok(Seen::Range(range))
}

fn missing(name: &str) -> Error {
    Error::Run(format!("the landscape has no layer `{name}`"))
}
