//! What steps measured, and the river network of a simulation where no step measured it.

use std::collections::BTreeMap;

use crate::Finished;
use weald_engine::Job;
use weald_engine::report::StepReport;
use weald_engine::step::Step;
use weald_land::analyse::network_step::Network;

/// Measures by the step that made them.
pub(super) type Measured<'a> = Vec<(&'a str, BTreeMap<String, f64>)>;

/// All measures of the run.
pub(super) fn with_network<'a>(finished: &'a Finished<'_>) -> Measured<'a> {
    let steps = finished.steps.iter().filter(|step| !step.measures.is_empty());
    let mut measured: Measured<'a> = steps.map(|step| (step.step.as_str(), step.measures.clone())).collect();
    let known = measured.iter().any(|(_, measures)| measures.contains_key("drains"));
    if !known {
        measured.extend(network(finished));
    }
    measured
}

/// Measures of the network of the last simulation with water.
fn network<'a>(finished: &'a Finished<'_>) -> Option<(&'a str, BTreeMap<String, f64>)> {
    let step = finished.steps.iter().rev().find(|step| mean_rain(step, finished).is_some())?;
    let network = Network { rain: mean_rain(step, finished), ..Network::default() };
    if !network.reads().iter().all(|name| finished.landscape.layer(name).is_ok()) {
        return None;
    }
    let mut landscape = finished.landscape.clone();
    let outcome = network.run(&mut landscape, &Job::unwatched(0)).ok()?;
    let measures = outcome.measures.into_iter().map(|(name, value)| (name.to_owned(), value));
    Some((&step.step, measures.collect()))
}

/// Rain of a simulation in metres per iteration, by its budget.
fn mean_rain(step: &StepReport, finished: &Finished<'_>) -> Option<f64> {
    let domain = &finished.landscape.domain;
    let area = domain.valid_cells() as f64 * domain.cell_area();
    let water = step.budget?.water;
    let rain = water.incoming / area / step.iterations as f64;
    (rain.is_finite() && rain > 0.0).then_some(rain)
}
