//! What an export is: what it is given, what it needs and what it makes.

use std::fmt::Debug;
use std::path::Path;

use weald_core::domain::Domain;
use weald_core::error::Error;
use weald_core::landscape::Landscape;
use weald_core::parameter::{Diagnostics, Fault, Parameter, Parameters};
use weald_core::source::Table;
use weald_engine::report::StepReport;
use weald_io::{Part, PartName};

/// A landscape at the end of a run, and what is known of the run.
#[derive(Clone, Copy, Debug)]
pub struct Finished<'a> {
    /// The landscape.
    pub landscape: &'a Landscape,
    /// What each step did.
    pub steps: &'a [StepReport],
    /// Name of the recipe file.
    pub recipe: &'a str,
    /// BLAKE3 hash of the recipe, in hexadecimal.
    pub hash: &'a str,
    /// Seed of the landscape.
    pub seed: u64,
}

/// A kind of export with its parameters, checked and ready to write.
pub trait Export: Debug + Send + Sync {
    /// Names of the layers it needs.
    fn reads(&self) -> Vec<String>;

    /// Names of the plants it needs.
    fn plants(&self) -> Vec<String> {
        Vec::new()
    }

    /// Names of the grass it needs.
    fn meadows(&self) -> Vec<String> {
        Vec::new()
    }

    /// Names of the layers it uses where they exist.
    fn optional(&self) -> Vec<String> {
        Vec::new()
    }

    /// Names of the fractals it writes.
    fn fractals(&self) -> Vec<String> {
        Vec::new()
    }

    /// Faults that concern several parameters at once.
    fn faults(&self) -> Vec<Fault> {
        Vec::new()
    }

    /// Why this build cannot make the file, where that needs a feature which the build leaves out.
    fn left_out(&self, file: &Path) -> Option<String> {
        let _ = file;
        None
    }

    /// What the user should know of the files, such as what they cannot hold.
    fn notes(&self, finished: &Finished<'_>) -> Vec<String> {
        let _ = finished;
        Vec::new()
    }

    /// Names of all files that it may write, by its keys alone: a plan tells from them what would overwrite what.
    fn names(&self, file: &Path) -> Vec<PartName> {
        let _ = file;
        vec![PartName::Own]
    }

    /// What stands against the files of a landscape on such a grid: all that its keys and the grid tell before anything
    /// runs.
    ///
    /// # Errors
    /// Those that [`Export::parts`] would end with, whatever the layers hold.
    fn check_on(&self, domain: &Domain, file: &Path) -> Result<(), Error> {
        let _ = (domain, file);
        Ok(())
    }

    /// Bytes that it takes at most while it is made, beside the layers of a landscape of so many cells: as measured, with
    /// what its files need in memory.
    fn working_bytes(&self, cells: u64) -> u64 {
        24 * cells
    }

    /// The files, all of them of [`Export::names`]. `file` is the name of the output, whose extension is one of [`ExportEntry::extensions`].
    ///
    /// # Errors
    /// [`Error::Limit`] where a file would be too large, [`Error::Run`] where it cannot be made.
    fn parts(&self, finished: &Finished<'_>, file: &Path) -> Result<Vec<Part>, Error>;
}

/// An export's declaration in the registry.
#[derive(Clone, Copy, Debug)]
pub struct ExportEntry {
    /// Word after `export =`.
    pub name: &'static str,
    /// What it writes, in one sentence.
    pub summary: &'static str,
    /// The specification that the files follow.
    pub source: &'static str,
    /// Extensions of its files in lower case, without the dot.
    pub extensions: &'static [&'static str],
    /// Declares the parameters.
    pub parameters: fn() -> Vec<Parameter>,
    /// Reads them from an `[[output]]` table without its `export` and `file`.
    pub read: fn(&Table, &mut Diagnostics) -> Box<dyn Export>,
}

impl ExportEntry {
    /// The declaration of export type `T`.
    pub const fn of<T: Export + Parameters + 'static>(
        name: &'static str,
        extensions: &'static [&'static str],
        summary: &'static str,
        source: &'static str,
    ) -> Self {
        let read = |table: &Table, diagnostics: &mut Diagnostics| -> Box<dyn Export> {
            Box::new(T::read(table, diagnostics))
        };
        Self { name, summary, source, extensions, parameters: T::parameters, read }
    }
}
