//! What the keys of a layer's output say of its grid and of its numbers.

use crate::recipe::layer_output::{OutputGrid, Treatment, usual};
use weald_core::parameter::{Diagnostics, Legal, read_key};
use weald_core::source::{Table, Value};
use weald_export::classes::DIRECTIONS;
use weald_io::Resampling;
use weald_land::flow::DirectionCodes;

/// What is done to a layer before it is written.
pub(super) fn read(table: &Table, layer: &str, diagnostics: &mut Diagnostics) -> Treatment {
    let grid = read_key(table, "grid", OutputGrid::Landscape, Legal::ANY, diagnostics);
    let resampling: Option<Resampling> = read_key(table, "resampling", None, Legal::ANY, diagnostics);
    let codes: Option<DirectionCodes> = read_key(table, "codes", None, Legal::ANY, diagnostics);
    let mut refuse = |key: &str, message: &str| diagnostics.add(table.line_of(key), message);
    if resampling.is_some() && grid != OutputGrid::Source {
        refuse("resampling", "`resampling` has no effect without grid = \"source\"");
    }
    if codes.is_some() && layer != DIRECTIONS {
        refuse("codes", "`codes` goes with layer = \"flow_direction\" alone");
    }
    if grid == OutputGrid::Source && layer == DIRECTIONS {
        let message = "`grid` is \"source\", but directions of flow lead to neighbours that another grid has not; leave it \
                       out, or write `river` and `accumulation` there";
        refuse("grid", message);
    }
    let to_source = (grid == OutputGrid::Source).then(|| resampling.unwrap_or(usual(layer)));
    Treatment { to_source, codes }
}

/// Refuses the grid of the source where the ground comes from no file.
pub(super) fn check_source(
    treatment: Treatment,
    recipe: &Table,
    table: &Table,
    diagnostics: &mut Diagnostics,
) {
    let is_of_a_file = || match recipe.get("landscape").map(|node| &node.value) {
        Some(Value::Table(landscape)) => landscape.get("from").is_some(),
        _ => false,
    };
    if treatment.to_source.is_some() && !is_of_a_file() {
        let message =
            "`grid` is \"source\", which needs `from` in [landscape]: no file has the ground of this recipe";
        diagnostics.add(table.line_of("grid"), message);
    }
}
