//! The models of Han and of Mei et al. on a landscape of which this process has its own rows: in bands, some steps at a time, to the bit as in
//! memory.

mod start;

use std::collections::BTreeSet;
use std::ops::Range;
use std::sync::Arc;

use super::defaults::ResolvedKeys;
use super::keys::{Hydraulic, Model};
use super::pipe_models::PipeModel;
use crate::erode::finished::Flows;
use crate::erode::han::Han;
use crate::erode::mei::Mei;
use crate::erode::stored::lost_note;
use crate::erode::water_planes as plane;
use crate::erode::working::Totals;
use start::{MEANS, StartOnDisk};
use weald_core::error::{Error, NotFinite};
use weald_core::file_plane::VALUE;
use weald_engine::Job;
use weald_engine::ranks::{agreed, any, total};
use weald_engine::step::{Outcome, Step};
use weald_engine::stored::{StoredLandscape, StoredPlane};
use weald_engine::stored_bands::{BandsOf, StoredBands};
use weald_engine::stored_state::StoredState;

/// State planes that layers are made of, after the simulation.
const OF_LAYERS: usize = 3;

impl Hydraulic {
    /// Bytes on disk for a cell beside the layers, or what of the keys needs the whole in memory.
    pub(super) fn scratch_on_disk(&self, wanted: &BTreeSet<String>) -> Result<u64, String> {
        let cannot = [
            (self.model.stava().is_some(), "the model `stava`"),
            (self.edits.is_some(), "`edits`"),
            (self.region.is_some(), "`region`"),
        ];
        if let Some((_, what)) = cannot.into_iter().find(|(asked, _)| *asked) {
            return Err(format!("{what} needs the landscape in memory"));
        }
        let state = if matches!(self.model, Model::Mei(_)) { Mei::PLANES } else { Han::PLANES };
        let written = self.writes().iter().filter(|(name, _)| wanted.contains(name)).count();
        let means = if MEANS.iter().any(|name| wanted.contains(*name)) { MEANS.len() } else { 0 };
        // Layers are written when the simulation has ended, and so in the room of the fluxes.
        let planes = (state.len() + means).saturating_sub(written).max(OF_LAYERS + means);
        Ok(VALUE * planes as u64)
    }

    /// Runs the model on a landscape on disk.
    pub(super) fn run_bands_on_disk(
        &self,
        landscape: &mut StoredLandscape<'_>,
        job: &Job<'_>,
    ) -> Result<Outcome, Error> {
        match &self.model {
            Model::Han(_) => self.run_pipes::<Han>(landscape, job),
            Model::Mei(_) => self.run_pipes::<Mei>(landscape, job),
            Model::Stava(_) => Err(super::models::another_model(self)),
        }
    }

    fn run_pipes<M: PipeModel>(
        &self,
        landscape: &mut StoredLandscape<'_>,
        job: &Job<'_>,
    ) -> Result<Outcome, Error> {
        let ranks = Arc::clone(&landscape.ranks);
        let filled = self.filled(landscape.domain.cell);
        let mut ground = StartOnDisk::of(self, landscape)?;
        let (mut bands, recorded) = self.bands_on_disk::<M>(landscape, (&ground, &filled))?;
        ground.swap(bands.margin(), landscape)?;
        let standing = self.pour(landscape, &ground, &mut bands.state[plane::DEPTH])?;
        let done = go_on(&mut bands, landscape)?;
        let steps = (done, recorded.clone());
        self.advance_on_disk(&mut bands, (&ground, &filled), steps, (landscape, job))?;
        let sums = total(&*ranks, &agreed(&*ranks, ground.sums(&bands.state))?)?;
        let totals = Totals { standing, ..Totals::of(sums) };
        let budget = totals.budget(&Flows::from(bands.total()?), ground.cell);
        let layers = (bands.state, bands.means);
        let stored = ground.store(landscape, &self.layer.0, layers, recorded.end - recorded.start);
        agreed(&*ranks, stored)?;
        Ok(Outcome {
            iterations: u64::from(self.iterations),
            notes: if self.conserves() { Vec::new() } else { vec![lost_note(&budget)] },
            budget: Some(budget),
            ..Outcome::default()
        })
    }

    /// The state before the first step, and the steps of which means are taken.
    fn bands_on_disk<M: PipeModel>(
        &self,
        landscape: &StoredLandscape<'_>,
        (ground, filled): (&StartOnDisk, &ResolvedKeys),
    ) -> Result<(StoredBands<M>, Range<u64>), Error> {
        let process =
            M::around(self, filled, self.setting(filled, (ground.size(), ground.is_masked(landscape))))?;
        let all = u64::from(self.iterations);
        let (means, recorded) = if MEANS.iter().any(|name| landscape.wants(name)) {
            (M::MEANS, self.recorded(ground.cell))
        } else {
            (&[][..], all..all)
        };
        let grid = (ground.columns, ground.rows.clone());
        let plane = || landscape.plane_of("simulation", (ground.columns, &ground.rows));
        let (memory, ranks) = (landscape.memory, &landscape.ranks);
        let given = BandsOf { grid, means, memory, plane: &plane, ranks };
        Ok((StoredBands::new(Arc::new(process), given)?, recorded))
    }

    /// Lets water stand at the start where the keys say so; gives how much there is of it, in cells³.
    fn pour(
        &self,
        landscape: &StoredLandscape<'_>,
        ground: &StartOnDisk,
        depth: &mut StoredPlane,
    ) -> Result<f64, Error> {
        let Some(name) = &self.initial_water else { return Ok(0.0) };
        let poured = landscape.layer(&name.0).and_then(|layer| ground.pour(&layer.plane, depth));
        let [standing, ..] = total(&*landscape.ranks, &agreed(&*landscape.ranks, poured)?)?;
        Ok(standing)
    }

    /// All steps, in passes over the disk; those that are recorded and the others apart.
    fn advance_on_disk<M: PipeModel>(
        &self,
        bands: &mut StoredBands<M>,
        (ground, filled): (&StartOnDisk, &ResolvedKeys),
        (mut done, recorded): (u64, Range<u64>),
        (landscape, job): (&StoredLandscape<'_>, &Job<'_>),
    ) -> Result<(), Error> {
        let all = u64::from(self.iterations);
        while done < all {
            let is_recorded = recorded.contains(&done);
            let border = if is_recorded { recorded.end } else { recorded.start };
            let end = all.min(done + bands.steps() as u64);
            let end = if border > done { end.min(border) } else { end };
            let weather: Vec<_> = (done..end).map(|step| self.forcing(filled, step)).collect();
            let passed = &mut |rows: usize| {
                let share = rows as f64 / ground.rows.own().len() as f64;
                let steps = ((end - done) as f64 * share) as u64;
                job.watcher.progress(done + steps, all, ground.columns * ground.rows.count());
                Ok(())
            };
            let constants = |rows| ground.constants(rows);
            if let Some(wrong) = bands.advance(&weather, is_recorded, (&constants, passed))? {
                return Err(not_finite((M::PLANES, wrong), done..end));
            }
            done = end;
            if done < all {
                self.keep_if_asked(bands, ground, done, (landscape, job))?;
            }
        }
        Ok(())
    }

    /// Keeps the state between two passes where it is time for it, and where the run is to end.
    fn keep_if_asked<M: PipeModel>(
        &self,
        bands: &StoredBands<M>,
        ground: &StartOnDisk,
        iteration: u64,
        (landscape, job): (&StoredLandscape<'_>, &Job<'_>),
    ) -> Result<(), Error> {
        // A signal may have come to some ranks alone by now, and clocks differ.
        let ends = any(&*landscape.ranks, job.watcher.cancelled())?;
        if !any(&*landscape.ranks, ends || job.watcher.checkpoint_due())? {
            return Ok(());
        }
        let taken = (self.layer.0.as_str(), "m", &ground.height);
        let state = M::PLANES.iter().map(|&name| name.to_owned()).zip(&bands.state);
        let means = MEANS.iter().map(|name| format!("sum of {name}")).zip(&bands.means);
        let planes = state.chain(means).collect();
        let row_sums = bands.row_sums();
        job.watcher.keep(landscape, &StoredState { iteration, taken, planes, row_sums })?;
        if ends { Err(Error::Interrupted(format!("after {iteration} iterations"))) } else { Ok(()) }
    }
}

/// Goes on from the state that an earlier run has kept, where there is one; gives the steps done.
fn go_on<M: PipeModel>(
    bands: &mut StoredBands<M>,
    landscape: &mut StoredLandscape<'_>,
) -> Result<u64, Error> {
    let Some(kept) = landscape.resumed.take() else { return Ok(0) };
    let planes = kept.planes.into_iter().map(|(_, plane)| plane).collect();
    bands.go_on(planes, kept.row_sums)?;
    Ok(kept.iteration)
}

fn not_finite((names, [x, y, plane]): (&[&str], [usize; 3]), steps: Range<u64>) -> Error {
    let (name, Range { start, end }) = (names[plane], steps);
    let message = format!(
        "between the iterations {start} and {end}, `{name}` at column {x}, row {y} became no finite number; a lower \
         `flow_rate` or `erosion`, or `limiter = true`, makes the scheme stable"
    );
    NotFinite { step: None, iteration: Some(end), layer: name.to_owned(), cell: [x, y], message }.into()
}
