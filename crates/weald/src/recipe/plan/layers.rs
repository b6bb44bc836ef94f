//! Which layers exist when: every layer that is read must have been written, and no step may work in vain.

use std::collections::{BTreeMap, BTreeSet};

use super::{Ground, Output, Planned, PlannedMaterial};
use crate::recipe::plan::words::hint;
use crate::recipe::written_layers::writer_of;
use weald_core::material::{BEDROCK, Material, layer_names};
use weald_core::parameter::Diagnostics;
use weald_core::sea;
use weald_engine::step::Layered;

/// All that makes layers.
pub(super) struct Made<'a> {
    pub(super) ground: &'a Ground,
    /// Whether there is a sea, which stands in the layer `water`.
    pub(super) sea: bool,
    pub(super) materials: &'a [PlannedMaterial],
    pub(super) steps: &'a [Planned],
}

pub(super) fn check(made: &Made<'_>, outputs: &[Output], diagnostics: &mut Diagnostics) {
    let wants_ground = outputs.is_empty() || !outputs.iter().all(Output::needs_no_ground);
    if wants_ground && made.steps.is_empty() && matches!(made.ground, Ground::Empty { .. }) {
        diagnostics.subject.clear();
        diagnostics.add(1, "a recipe needs a [[step]] table, or `from` in [landscape]: there is no ground");
    }
    let mut layers = made.at_the_start();
    let materials: Vec<_> = made.materials.iter().map(|planned| planned.material.clone()).collect();
    for (index, planned) in made.steps.iter().enumerate() {
        planned.entry.name.clone_into(&mut diagnostics.subject);
        layers.check_reads(planned, &materials, diagnostics);
        layers.check_writes(index + 1, planned, &materials, diagnostics);
        if planned.step.watched() > 0 {
            "output".clone_into(&mut diagnostics.subject);
            layers.check_lapses(outputs, &planned.title(index + 1), diagnostics);
        }
    }
    "output".clone_into(&mut diagnostics.subject);
    let simulates = made.steps.iter().any(|planned| planned.step.watched() > 0);
    for output in outputs.iter().filter(|output| output.lapses() && !simulates) {
        diagnostics.add(output.line, "`every` counts the iterations of simulations, and no step simulates");
    }
    for output in outputs {
        let missing = output.reads().into_iter().filter(|name| !layers.read(name));
        // An empty name is that of a key which is needed, and which is reported as such.
        let missing: Vec<_> = missing.filter(|name| !name.is_empty()).collect();
        for (names, hint) in layers.by_hint(missing, "", &materials) {
            let (file, names) = (output.file.display(), in_words(&names));
            let message = format!("{file} needs {names}, which no step of this recipe writes; {hint}");
            diagnostics.add(output.line, message);
        }
    }
    check_grown(made.steps, outputs, diagnostics);
}

/// Complains of outputs of plants that no step sets, and of grass that none grows.
fn check_grown(steps: &[Planned], outputs: &[Output], diagnostics: &mut Diagnostics) {
    let plants: BTreeSet<_> = steps.iter().flat_map(|planned| planned.step.plants()).collect();
    let meadows: BTreeSet<_> = steps.iter().flat_map(|planned| planned.step.meadows()).collect();
    for output in outputs {
        for (needed, grown, what) in [
            (output.plants(), &plants, ["plants", "sets", "scatter"]),
            (output.meadows(), &meadows, ["grass", "grows", "grass"]),
        ] {
            let known: Vec<_> = grown.iter().map(String::as_str).collect();
            for name in needed.iter().filter(|&name| !grown.contains(name) && !name.is_empty()) {
                let (file, [what, does, step]) = (output.file.display(), what);
                let hint = match known.as_slice() {
                    [] => format!("the step `{step}` does: put `[[step]] do = {step:?}` into the recipe"),
                    known => hint(name, known),
                };
                diagnostics
                    .add(output.line, format!("{file} needs {what} `{name}`, which no step {does}; {hint}"));
            }
        }
    }
}

impl Made<'_> {
    /// The layers before the first step: those that are read from files.
    fn at_the_start(&self) -> Layers {
        let mut layers = Layers::default();
        if let Ground::File { path, .. } = self.ground {
            layers.write(&format!("`from` ({})", path.display()), &["height".to_owned()]);
        }
        if self.sea {
            layers.write("`sea_level`", &sea::LAYERS.map(str::to_owned));
            for name in sea::LAYERS {
                layers.read(name);
            }
        }
        for planned in self.materials.iter().filter(|planned| planned.file.is_some()) {
            let name = &planned.material.name;
            layers.write(&format!("material `{name}` (line {})", planned.line), std::slice::from_ref(name));
        }
        layers
    }
}

/// The layers there are at one point of a recipe, and who wrote them.
#[derive(Default)]
struct Layers {
    writer_of: BTreeMap<String, usize>,
    writers: Vec<Writer>,
}

struct Writer {
    title: String,
    /// Layers of this writer that still stand.
    standing: usize,
    /// Whether any of its layers was ever read.
    used: bool,
}

impl Layers {
    fn check_reads(&mut self, planned: &Planned, materials: &[Material], diagnostics: &mut Diagnostics) {
        let reads = planned.step.reads().into_iter();
        let missing: Vec<_> = reads.filter(|name| !self.read(name)).collect();
        for (names, hint) in self.by_hint(missing, planned.entry.name, materials) {
            let message = format!("reads {}, which no earlier step writes; {hint}", in_words(&names));
            diagnostics.add(planned.line, message);
        }
        if planned.step.layered() != Layered::Never {
            // A material without a layer is made from its declaration, so none of them need be there.
            for name in layer_names(materials) {
                self.read(name);
            }
        }
    }

    fn check_writes(
        &mut self,
        number: usize,
        planned: &Planned,
        materials: &[Material],
        diagnostics: &mut Diagnostics,
    ) {
        let mut written: Vec<_> = planned.step.writes().into_iter().map(|(name, _)| name).collect();
        if planned.step.layered() == Layered::Changes {
            written.extend(layer_names(materials).map(str::to_owned));
        }
        let title = planned.title(number);
        for lost in self.write(&title, &written) {
            let message = format!(
                "overwrites all that {lost} made before any step reads it; remove that one, or write to \
                 another layer"
            );
            diagnostics.add(planned.line, message);
        }
    }

    /// A time-lapse sees the landscape within a step, before later steps have made their layers.
    fn check_lapses(&mut self, outputs: &[Output], step: &str, diagnostics: &mut Diagnostics) {
        let lapses = outputs.iter().filter(|output| output.lapses());
        for (output, name) in
            lapses.flat_map(|output| output.reads().into_iter().map(move |name| (output, name)))
        {
            if !self.read(&name) {
                let file = output.file.display();
                let message =
                    format!("{file} shows layer `{name}` during {step}, but no step writes it before");
                diagnostics.add(output.line, message);
            }
        }
    }

    /// Whether the layer exists, which is noted as read.
    fn read(&mut self, name: &str) -> bool {
        let writer = self.writer_of.get(name);
        if let Some(&writer) = writer {
            self.writers[writer].used = true;
        }
        writer.is_some()
    }

    /// Notes the layers of a writer and gives the titles of those whose whole work is lost by it. A layer
    /// beside others that were of use, such as the water of an earlier simulation, may well be overwritten.
    fn write(&mut self, title: &str, names: &[String]) -> Vec<String> {
        self.writers.push(Writer { title: title.to_owned(), standing: names.len(), used: false });
        let this = self.writers.len() - 1;
        let mut lost = Vec::new();
        for name in names {
            let Some(earlier) = self.writer_of.insert(name.clone(), this) else { continue };
            let earlier = &mut self.writers[earlier];
            earlier.standing -= 1;
            if earlier.standing == 0 && !earlier.used {
                lost.push(earlier.title.clone());
            }
        }
        lost
    }

    fn hint(&self, name: &str, reader: &str, materials: &[Material]) -> String {
        if materials.first().is_some_and(|first| first.name == name) {
            return format!("the layer of the first material is `{BEDROCK}`");
        }
        if materials.iter().any(|material| material.name == name) {
            return "a `layers` step writes the layers of all materials".to_owned();
        }
        let known: Vec<_> = self.writer_of.keys().map(String::as_str).collect();
        match writer_of(name, reader).filter(|_| name != "height") {
            Some(step) => format!("add a step {step}"),
            None => hint(name, &known),
        }
    }

    /// Layers that are missing, those together about which the same is to be said.
    fn by_hint(
        &self,
        missing: Vec<String>,
        reader: &str,
        materials: &[Material],
    ) -> Vec<(Vec<String>, String)> {
        let mut grouped: Vec<(Vec<String>, String)> = Vec::new();
        for name in missing {
            let hint = self.hint(&name, reader, materials);
            match grouped.iter_mut().find(|(_, known)| *known == hint) {
                Some((names, _)) => names.push(name),
                None => grouped.push((vec![name], hint)),
            }
        }
        grouped
    }
}

/// Layers in a message.
fn in_words(names: &[String]) -> String {
    let quoted: Vec<_> = names.iter().map(|name| format!("`{name}`")).collect();
    match quoted.split_last() {
        Some((last, [])) => format!("layer {last}"),
        Some((last, others)) => format!("layers {} and {last}", others.join(", ")),
        None => String::new(),
    }
}
