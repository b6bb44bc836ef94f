//! Where water and solid went.

use super::figures::number;
use super::html::{Cell, table};
use crate::Finished;
use weald_engine::report::BudgetReport;

/// Tables of all simulations; nothing where there was none.
pub(super) fn tables(finished: &Finished<'_>) -> String {
    let budgets: Vec<(String, BudgetReport)> = finished
        .steps
        .iter()
        .enumerate()
        .filter_map(|(at, step)| Some((format!("{}. {}", at + 1, step.step), step.budget?)))
        .collect();
    let wet: Vec<_> = budgets.iter().filter(|(_, budget)| budget.water.incoming > 0.0).collect();
    let mut text = String::new();
    if !wet.is_empty() {
        let rows: Vec<_> = wet.into_iter().map(|(step, budget)| water(step, budget)).collect();
        let header = ["step", "in", "out", "stored", "relative error"];
        text +=
            &table("Water in m³; the relative error is what is missing over what came in.", &header, &rows);
    }
    if !budgets.is_empty() {
        let rows: Vec<_> = budgets.iter().map(|(step, budget)| solid(step, budget)).collect();
        let header = ["step", "ground before", "ground after", "loose", "suspended", "out", "relative error"];
        let caption = "Solid in m³ above the lowest cell of the start; the relative error is what is missing over the \
                       ground before, or over what moved where that is more.";
        text += &table(caption, &header, &rows);
    }
    text
}

fn row(step: &str, numbers: &[f64]) -> Vec<Cell> {
    std::iter::once(Cell::text(step))
        .chain(numbers.iter().map(|&value| Cell::number(number(value))))
        .collect()
}

fn water(step: &str, BudgetReport { water, .. }: &BudgetReport) -> Vec<Cell> {
    row(step, &[water.incoming, water.outgoing, water.stored, water.error])
}

fn solid(step: &str, BudgetReport { solid, .. }: &BudgetReport) -> Vec<Cell> {
    row(step, &[solid.start, solid.bedrock, solid.layers, solid.suspended, solid.outgoing, solid.error])
}
