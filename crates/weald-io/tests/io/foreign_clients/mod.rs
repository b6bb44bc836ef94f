//! Files of others, value by value: each is what GDAL or xarray reads, or refused with a reason.
//!
//! The files are made while the test runs, by the drivers of GDAL and by xarray. Where our reading and theirs differ the
//! specification of the format decides; those cases say so, and CORRECTNESS.md lists them.

mod gdal;
mod xarray;

use std::collections::BTreeMap;
use std::path::PathBuf;

use weald_io::Raster;

use crate::rows::difference_of_rows;

/// What must come of a file.
#[derive(Clone, Debug)]
pub(crate) enum Verdict {
    /// The same values as theirs.
    Same,
    /// An error that has these words.
    Refused(String),
    /// Other values than theirs, by the specification of the format: these cells have no data.
    NoDataAt(Vec<usize>),
}

/// A file of others.
#[derive(Clone, Debug)]
pub(crate) struct Foreign {
    /// What it is, first the group of the table.
    pub(crate) group: String,
    pub(crate) name: String,
    pub(crate) path: PathBuf,
    /// Metres in a unit of its heights.
    pub(crate) metres: f64,
    pub(crate) verdict: Verdict,
}

/// What others read of a file: a value a cell, NaN without data, from north to south.
pub(crate) struct Theirs(pub(crate) Vec<f64>);

impl Theirs {
    /// With the last row first.
    fn turned(self, columns: usize) -> Self {
        Self(self.0.chunks(columns).rev().flatten().copied().collect())
    }
}

impl Foreign {
    /// What is wrong with our reading, beside theirs; nothing where all is well.
    pub(crate) fn fault(&self, theirs: &Result<Theirs, String>) -> Option<String> {
        let ours = weald_io::read(&self.path);
        if let Some(difference) = difference_of_rows(&self.path, &ours) {
            return Some(format!("{} {}: {difference}", self.group, self.name));
        }
        let ours = ours.map_err(|error| error.to_string());
        let fault = match (&ours, &self.verdict) {
            (Err(error), Verdict::Refused(words)) if error.contains(words.as_str()) => None,
            (Err(error), _) => Some(format!("refused: {error}")),
            (Ok(_), Verdict::Refused(words)) => Some(format!("read, and not refused with {words:?}")),
            (Ok(raster), Verdict::Same) => self.difference(raster, theirs, &[]),
            (Ok(raster), Verdict::NoDataAt(cells)) => self.difference(raster, theirs, cells),
        };
        fault.map(|fault| format!("{} {}: {fault}", self.group, self.name))
    }

    fn difference(&self, ours: &Raster, theirs: &Result<Theirs, String>, none: &[usize]) -> Option<String> {
        let Theirs(theirs) = match theirs {
            Ok(theirs) => theirs,
            Err(cause) => return Some(format!("they do not read it: {cause}")),
        };
        let ours = values(ours);
        if ours.len() != theirs.len() {
            return Some(format!("{} cells for {}", ours.len(), theirs.len()));
        }
        let expected =
            |cell: usize| if none.contains(&cell) { f32::NAN } else { (theirs[cell] * self.metres) as f32 };
        let at = ours.iter().enumerate().position(|(cell, ours)| {
            let expected = expected(cell);
            let is_near = (ours - expected).abs() <= expected.abs() * 2e-7;
            !(is_near || ours.is_nan() && expected.is_nan())
        })?;
        Some(format!("cell {at} holds {}, not {}, by their {}", ours[at], expected(at), theirs[at]))
    }
}

/// The values, NaN without data.
fn values(raster: &Raster) -> Vec<f32> {
    let land = raster.valid.as_ref();
    let cells = raster.field.values().iter().enumerate();
    cells
        .map(|(cell, value)| if land.is_none_or(|land| land.is_valid_at(cell)) { *value } else { f32::NAN })
        .collect()
}

/// Prints how many of each group are the same, refused, or decided by the specification; panics with all faults.
pub(crate) fn judge(files: &[Foreign], faults: &[String]) {
    let mut groups: BTreeMap<&str, [usize; 3]> = BTreeMap::new();
    for file in files {
        let column = match file.verdict {
            Verdict::Same => 0,
            Verdict::Refused(_) => 1,
            Verdict::NoDataAt(_) => 2,
        };
        groups.entry(&file.group).or_default()[column] += 1;
    }
    println!("| files | equal | refused with a reason | by the specification |\n|---|---|---|---|");
    for (group, [same, refused, specified]) in &groups {
        println!("| {group} | {same} | {refused} | {specified} |");
    }
    println!("| all {} | | | |", files.len());
    assert!(faults.is_empty(), "{} of {} files:\n{}", faults.len(), files.len(), faults.join("\n"));
}
