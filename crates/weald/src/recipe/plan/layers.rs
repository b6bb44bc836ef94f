//! Which layers exist when: every layer that is read must have been written, and no step may work in vain.

use std::collections::BTreeMap;

use super::{Ground, Output, Planned, hint};
use crate::recipe::parameter::Complaints;

pub(super) fn check(ground: &Ground, steps: &[Planned], outputs: &[Output], complaints: &mut Complaints) {
    let mut layers = Layers::default();
    if let Ground::File { path, .. } = ground {
        layers.write(&format!("`from` ({})", path.display()), &["height".to_owned()]);
    }
    for (index, planned) in steps.iter().enumerate() {
        planned.entry.name.clone_into(&mut complaints.subject);
        for name in planned.step.reads() {
            if !layers.read(&name) {
                let message =
                    format!("reads layer `{name}`, which no earlier step writes; {}", layers.hint(&name));
                complaints.add(planned.line, message);
            }
        }
        let written: Vec<_> = planned.step.writes().into_iter().map(|(name, _)| name).collect();
        let title = format!("step {} (`{}`, line {})", index + 1, planned.entry.name, planned.line);
        for lost in layers.write(&title, &written) {
            let message = format!(
                "overwrites all that {lost} made before any step reads it; remove that one, or write to \
                 another layer"
            );
            complaints.add(planned.line, message);
        }
    }
    "output".clone_into(&mut complaints.subject);
    for output in outputs {
        for name in output.reads() {
            if !layers.read(&name) {
                let (file, hint) = (output.file.display(), layers.hint(&name));
                let message = format!("{file} needs layer `{name}`, which no step writes; {hint}");
                complaints.add(output.line, message);
            }
        }
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

    fn hint(&self, name: &str) -> String {
        hint(name, &self.writer_of.keys().map(String::as_str).collect::<Vec<_>>())
    }
}
