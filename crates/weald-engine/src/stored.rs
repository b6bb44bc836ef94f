//! A landscape that does not fit into memory: its layers lie on disk, and steps work on parts of them.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Debug;

use weald_core::domain::Domain;
use weald_core::error::{Error, NotFinite};
use weald_core::file_plane::FilePlane;
use weald_core::files::File;
use weald_core::grid::Size;

/// Where planes are made that lie on disk.
pub trait Scratch: Debug + Sync {
    /// An empty file that is gone when it is closed, however the process ends.
    ///
    /// # Errors
    /// [`Error::Run`] where none can be made.
    fn file(&self) -> Result<File, Error>;
}

/// A layer on disk.
#[derive(Debug)]
pub struct StoredLayer {
    /// Unit of its values.
    pub unit: String,
    /// Its values.
    pub plane: FilePlane,
}

/// A landscape whose layers lie on disk.
#[derive(Debug)]
pub struct StoredLandscape<'a> {
    /// Its grid, where all cells have data.
    pub domain: Domain,
    /// Most bytes of memory that a step may take.
    pub memory: u64,
    scratch: &'a dyn Scratch,
    layers: BTreeMap<String, StoredLayer>,
    wanted: BTreeSet<String>,
}

impl<'a> StoredLandscape<'a> {
    /// A landscape without layers.
    pub fn new(domain: Domain, memory: u64, scratch: &'a dyn Scratch) -> Self {
        Self { domain, memory, scratch, layers: BTreeMap::new(), wanted: BTreeSet::new() }
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
    /// [`Error::Run`] where it cannot be made.
    pub fn plane(&self, name: &str, size: Size) -> Result<FilePlane, Error> {
        FilePlane::new(name, self.scratch.file()?, size)
    }

    /// A layer.
    ///
    /// # Errors
    /// [`Error::Run`] where there is none of that name.
    pub fn layer(&self, name: &str) -> Result<&StoredLayer, Error> {
        self.layers.get(name).ok_or_else(|| Error::Run(format!("the landscape has no layer `{name}`")))
    }

    /// Takes a layer out.
    pub fn remove(&mut self, name: &str) -> Option<StoredLayer> {
        self.layers.remove(name)
    }

    /// Puts in a layer that [is wanted](Self::wants), in place of one of that name.
    pub fn insert(&mut self, name: &str, unit: &str, plane: FilePlane) {
        if self.wants(name) {
            self.layers.insert(name.to_owned(), StoredLayer { unit: unit.to_owned(), plane });
        }
    }

    /// Least and greatest value of a layer.
    ///
    /// # Errors
    /// [`Error::NotFinite`] naming the first cell that holds a NaN or an infinity; those of the disk.
    pub fn range(&self, name: &str) -> Result<(f32, f32), Error> {
        let plane = &self.layer(name)?.plane;
        let mut range: Option<(f32, f32)> = None;
        for rows in plane.runs_of_rows() {
            let values = plane.rows(rows.clone())?;
            if let Some(at) = values.iter().position(|value| !value.is_finite()) {
                let columns = self.domain.size.columns;
                let (cell, value) = ([at % columns, rows.start + at / columns], values[at]);
                let message = format!(
                    "layer `{name}` became {value} at column {}, row {}; gentler parameters may help",
                    cell[0], cell[1]
                );
                return Err(
                    NotFinite { step: None, iteration: None, layer: name.to_owned(), cell, message }.into()
                );
            }
            for value in values {
                let (low, high) = range.unwrap_or((value, value));
                range = Some((low.min(value), high.max(value)));
            }
        }
        Ok(range.unwrap_or_default())
    }
}
