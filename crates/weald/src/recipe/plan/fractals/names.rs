//! Whether the fractals that steps and outputs name are there, and such that they can be planted.

use super::super::{Output, Planned};
use super::PlannedFractal;
use crate::recipe::plan::words::hint;
use weald_core::parameter::Diagnostics;
use weald_plants::ifs::shapes;

/// Complains of steps and outputs that name a fractal that is not there.
pub(in crate::recipe::plan) fn check_names(
    fractals: &[PlannedFractal],
    steps: &[Planned],
    outputs: &[Output],
    diagnostics: &mut Diagnostics,
) {
    let own = fractals.iter().map(|fractal| fractal.name.as_str());
    let known: Vec<_> = own.chain(shapes::SHAPES.iter().map(|shape| shape.name)).collect();
    let mut check = |subject: &str, line: usize, names: Vec<String>| {
        subject.clone_into(&mut diagnostics.subject);
        for name in names.iter().filter(|name| !known.contains(&name.as_str())) {
            diagnostics.add(line, format!("there is no fractal {name:?}; {}", hint(name, &known)));
        }
    };
    for planned in steps {
        check(planned.entry.name, planned.line, planned.step.fractals());
    }
    for output in outputs {
        check("output", output.line, output.fractals());
    }
    check_plants(fractals, steps, diagnostics);
}

/// Complains of planted fractals that are deformed: leaves and fronds are made from the maps.
fn check_plants(fractals: &[PlannedFractal], steps: &[Planned], diagnostics: &mut Diagnostics) {
    for planned in steps {
        planned.entry.name.clone_into(&mut diagnostics.subject);
        let names = planned.step.fractals();
        let is_bent = |fractal: &&PlannedFractal| names.contains(&fractal.name) && !fractal.deform.is_empty();
        for bent in fractals.iter().filter(is_bent) {
            diagnostics.add(
                planned.line,
                format!(
                    "the fractal {:?} has `deform`, but plants have the shape of the maps alone; plant one without it",
                    bent.name
                ),
            );
        }
    }
}
