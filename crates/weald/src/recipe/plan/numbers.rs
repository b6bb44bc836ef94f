//! Layers of numbers that stand for things, such as directions of flow: means of them, or other values under their name,
//! are of no use to those who read them.

use std::collections::{BTreeMap, BTreeSet};

use super::{Content, Output, Planned};
use weald_core::parameter::Diagnostics;

/// The layers that are read as such numbers, each with the steps that make it.
const NUMBERS: &[(&str, &[&str])] = &[("flow_direction", &["flow", "load"]), ("lake", &["lakes", "load"])];

/// Reports steps and outputs that read such a layer after another step has changed it.
pub(super) fn check(steps: &[Planned], outputs: &[Output], diagnostics: &mut Diagnostics) {
    let mut spoiled = Spoiled::default();
    for (index, planned) in steps.iter().enumerate() {
        planned.entry.name.clone_into(&mut diagnostics.subject);
        let reads = planned.step.reads().into_iter().chain(planned.step.reads_where_there());
        for message in reads.filter_map(|name| spoiled.fault(&name)) {
            diagnostics.add(planned.line, message);
        }
        spoiled.after(planned, index + 1);
    }
    "output".clone_into(&mut diagnostics.subject);
    let exports = outputs.iter().filter(|output| matches!(output.content, Content::Export { .. }));
    for output in exports {
        for message in output.reads().iter().filter_map(|name| spoiled.fault(name)) {
            diagnostics.add(output.line, format!("{}: {message}", output.file.display()));
        }
    }
}

/// Such layers that were made, and who changed them since.
#[derive(Default)]
struct Spoiled {
    made: BTreeSet<&'static str>,
    by: BTreeMap<&'static str, String>,
}

impl Spoiled {
    fn fault(&self, name: &str) -> Option<String> {
        let (maker, by) = NUMBERS.iter().find_map(|(known, makers)| {
            let by = self.by.get(known).filter(|_| *known == name)?;
            Some((makers.first()?, by))
        })?;
        Some(format!("reads `{name}`, whose numbers {by} has changed; put a step `{maker}` between them"))
    }

    fn after(&mut self, planned: &Planned, number: usize) {
        let writes = planned.step.writes();
        for (name, makers) in NUMBERS {
            let is_written = writes.iter().any(|(written, _)| written == name);
            if is_written && makers.contains(&planned.entry.name) {
                self.made.insert(name);
                self.by.remove(name);
            } else if is_written || (self.made.contains(name) && planned.step.resized().is_some()) {
                self.by.insert(name, planned.title(number));
            }
        }
    }
}
