//! What each step did, and where the run came from.

use super::figures::{count, number};
use super::html::{Cell, table};
use super::measures::with_network;
use crate::Finished;
use weald_engine::report::StepReport;
use weald_land::analyse::network::MEASURES;

/// Steps in their order.
pub(super) fn table_of(finished: &Finished<'_>) -> String {
    let row = |(at, step): (usize, &StepReport)| {
        vec![
            Cell::text(format!("{}. {}", at + 1, step.step)),
            Cell::number(count(step.iterations)),
            Cell::number(number(step.seconds)),
            Cell::number(number(step.cell_updates_per_second / 1.0e6)),
            Cell::text(step.notes.join("; ")),
        ]
    };
    let rows: Vec<_> = finished.steps.iter().enumerate().map(row).collect();
    if rows.is_empty() {
        return String::new();
    }
    let header = ["step", "iterations", "seconds", "million cell updates per second", "notes"];
    table("What each step did.", &header, &rows)
}

/// What steps measured; of simulations also the river network where the recipe has no step for it.
pub(super) fn measures(finished: &Finished<'_>) -> String {
    let measured = with_network(finished);
    let rows: Vec<_> = measured
        .iter()
        .flat_map(|(step, measures)| {
            measures.iter().map(move |(name, value)| {
                vec![
                    Cell::text(name.replace('_', " ")),
                    Cell::number(number(*value)),
                    Cell::text(step),
                    Cell::text(meaning(name)),
                ]
            })
        })
        .collect();
    if rows.is_empty() {
        return String::new();
    }
    let caption =
        "What steps measured. Measures of networks depend on the grid: only runs of the same size compare.";
    table(caption, &["measure", "value", "step", "what it is"], &rows)
}

/// What a measure is; nothing where its name says it.
fn meaning(name: &str) -> &'static str {
    MEASURES.iter().find(|(measure, _)| *measure == name).map_or("", |(_, meaning)| meaning)
}

/// Recipe, seed and version: with them the run can be made again.
pub(super) fn provenance(finished: &Finished<'_>) -> String {
    let domain = &finished.landscape.domain;
    let epsg = domain.georeference.as_ref().map(|place| {
        place.epsg.map_or("a coordinate reference system without EPSG code".to_owned(), |code| {
            format!("EPSG:{code}")
        })
    });
    let rows = [
        ("recipe", finished.recipe.to_owned()),
        ("BLAKE3 of the recipe", finished.hash.to_owned()),
        ("seed", finished.seed.to_string()),
        ("version", format!("Weald {}", env!("CARGO_PKG_VERSION"))),
        ("grid", format!("{} cells of {} m", domain.size, domain.cell)),
        ("georeferencing", epsg.unwrap_or_else(|| "none".to_owned())),
    ];
    let rows: Vec<_> = rows.into_iter().map(|(what, is)| vec![Cell::text(what), Cell::text(is)]).collect();
    table("With these the run can be made again.", &["what", "is"], &rows)
}
