//! Ground of a recipe that names a finest grid: the steps that shape it run there, and the last of them leaves the means
//! over the landscape's cells.

use std::path::PathBuf;

use super::steps::Planned;
use super::{Ground, PlannedMaterial};
use weald_core::domain::Domain;
use weald_core::error::Error;
use weald_core::grid::Size;
use weald_core::landscape::Landscape;
use weald_core::material::Material;
use weald_core::parameter::{Fault, Sides};
use weald_engine::Job;
use weald_engine::step::{Entry, Layered, Outcome, Stage, Step, Work};
use weald_land::combine::resample::Resample;

/// How many steps run on the finest grid, of those that a recipe begins with: none where there is no finer one, or where a
/// material comes from a file, which has the landscape's cells. The last of them is given the means to take.
pub(super) fn run_on_finest(
    ground: &Ground,
    steps: &mut Vec<Planned>,
    materials: &[PlannedMaterial],
) -> usize {
    let &Ground::Empty { size, finest: Some(finest), .. } = ground else { return 0 };
    let count =
        steps.iter().take_while(|planned| shapes_ground(planned.entry, planned.step.as_ref())).count();
    let has_files = materials.iter().any(|planned| planned.file.is_some());
    if count == 0 || finest.columns <= size.columns || has_files {
        return 0;
    }
    let others = steps.split_off(count);
    let last = steps.pop().map(|last| {
        let step = Box::new(ThenMeans { step: last.step, size });
        Planned { step, ..last }
    });
    steps.extend(last.into_iter().chain(others));
    count
}

/// Whether a step makes or combines layers by places in metres alone. Numbers of materials have no mean, and a step that
/// changes the grid is asked for one. A mean of products is no product of means: made on their own cells, a coarse and a
/// fine landscape would be two.
fn shapes_ground(entry: &Entry, step: &dyn Step) -> bool {
    let makes = matches!(entry.stage, Stage::Generate | Stage::Combine);
    makes && step.resized().is_none() && step.layered() == Layered::Never
}

/// The finest grid over ground of so many cells of a length in metres.
pub(super) fn grid(size: Size, cell: f64, finest: Size) -> Domain {
    let cell = cell * size.columns as f64 / finest.columns as f64;
    Domain { finest: Some(finest), ..Domain::new(finest, cell) }
}

/// A landscape brought from the finest grid to that of its recipe.
///
/// # Errors
/// None but for grids that do not go together, which the recipe has been checked for.
pub(super) fn on_own_grid(ground: &Ground, mut landscape: Landscape) -> Result<Landscape, Error> {
    if let &Ground::Empty { size, .. } = ground {
        to(size).run(&mut landscape, &Job::unwatched(0))?;
    }
    Ok(landscape)
}

fn to(size: Size) -> Resample {
    Resample { size: Sides { columns: size.columns as u64, rows: size.rows as u64 } }
}

/// A step, and then means of all layers over the cells of a coarser grid.
#[derive(Debug)]
struct ThenMeans {
    step: Box<dyn Step>,
    size: Size,
}

impl Step for ThenMeans {
    fn reads(&self) -> Vec<String> {
        self.step.reads()
    }

    fn reads_where_there(&self) -> Vec<String> {
        self.step.reads_where_there()
    }

    fn writes(&self) -> Vec<(String, &'static str)> {
        self.step.writes()
    }

    fn layered(&self) -> Layered {
        self.step.layered()
    }

    fn files(&self) -> Vec<PathBuf> {
        self.step.files()
    }

    fn look_ahead(&self, materials: &[Material], domain: &Domain) -> Result<(), Error> {
        self.step.look_ahead(materials, domain)
    }

    fn faults(&self) -> Vec<Fault> {
        self.step.faults()
    }

    fn faults_among(&self, materials: &[Material]) -> Vec<Fault> {
        self.step.faults_among(materials)
    }

    fn range(&self, layer: &str) -> Option<(f64, f64)> {
        self.step.range(layer)
    }

    fn resized(&self) -> Option<(u32, u32)> {
        to(self.size).resized()
    }

    fn check_on(&self, domain: &Domain) -> Result<(), Error> {
        self.step.check_on(domain)?;
        to(self.size).check_on(domain)
    }

    fn domain_after(&self, domain: &Domain) -> Option<Domain> {
        to(self.size).domain_after(domain)
    }

    fn bytes_per_cell(&self) -> u64 {
        self.step.bytes_per_cell()
    }

    fn work(&self, domain: &Domain) -> Work {
        self.step.work(domain)
    }

    fn run(&self, landscape: &mut Landscape, job: &Job<'_>) -> Result<Outcome, Error> {
        let outcome = self.step.run(landscape, job)?;
        to(self.size).run(landscape, job)?;
        Ok(outcome)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::recipe::catalog::CATALOG;
    use weald_core::parameter::Diagnostics;
    use weald_core::source;

    #[test]
    fn steps_that_count_cells_or_name_kinds_do_not_run_on_the_finest_grid() {
        for entry in CATALOG {
            let table = source::parse("recipe", "").expect("empty");
            let step = (entry.read)(&table, &mut Diagnostics::default());
            let expected = match entry.stage {
                Stage::Generate => true,
                Stage::Combine => !["resample", "layers", "top-material"].contains(&entry.name),
                _ => false,
            };
            assert_eq!(shapes_ground(entry, step.as_ref()), expected, "{}", entry.name);
        }
    }
}
