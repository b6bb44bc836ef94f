//! Unknown keys of outputs, with the kind of output that has them.

use weald_core::parameter::{Diagnostics, Kind, Parameter, synonym};
use weald_core::source::Table;

/// A kind of output by its keys.
pub(super) struct KindOfOutput {
    /// The key that names it, `picture` or `export`.
    pub(super) key: &'static str,
    /// All its keys but this one and `file`.
    pub(super) known: Vec<Parameter>,
    /// The kinds that this key can name, with what declares theirs.
    pub(super) others: Vec<(&'static str, Keys)>,
}

/// What declares the keys of a kind.
type Keys = fn() -> Vec<Parameter>;

/// Reports the unknown keys of an output, and takes them out of its table.
pub(super) fn take_unknown(kind: &KindOfOutput, table: &mut Table, diagnostics: &mut Diagnostics) {
    let mut names: Vec<_> = kind.known.iter().flat_map(names_of).collect();
    names.extend([kind.key, "file"]);
    let mut strange = Table { line: table.line, entries: Vec::new() };
    for (key, node) in table.entries.clone() {
        if names.contains(&key.as_str()) {
            continue;
        }
        table.take(&key);
        match kind.meant(&key, &names) {
            Some(meant) => diagnostics.add(node.line, format!("unknown key `{key}`; {meant}")),
            None => strange.entries.push((key, node)),
        }
    }
    diagnostics.unknown_keys(&strange, &names);
}

/// The name of a key, and those of the keys that its words bring with them.
fn names_of(parameter: &Parameter) -> Vec<&'static str> {
    let mut names = vec![parameter.name];
    if let Kind::Variants(variants) = &parameter.kind {
        names.extend(variants.iter().flat_map(|variant| variant.parameters.iter().map(|own| own.name)));
    }
    names
}

impl KindOfOutput {
    /// Which other kind has a key that is none here, and is not just called otherwise.
    fn meant(&self, key: &str, names: &[&str]) -> Option<String> {
        if synonym(key, names).is_some() {
            return None;
        }
        let has = |parameters: &Keys| parameters().iter().any(|own| own.name == key);
        let (other, _) = self.others.iter().find(|(_, parameters)| has(parameters))?;
        Some(format!("it is a key of {} = {other:?}", self.key))
    }
}

#[cfg(test)]
mod tests {
    use crate::recipe::{Overrides, Recipe};

    fn refusal(output: &str) -> String {
        let text = format!("[landscape]\nsize = 9\n[[step]]\ndo = \"constant\"\n[[output]]\n{output}");
        Recipe::parse("r.toml", &text, &Overrides::default()).expect_err("the recipe is bad").to_string()
    }

    #[test]
    fn keys_of_other_programs_are_answered_with_those_that_are_meant() {
        let view = "picture = \"view\"\nfile = \"a.png\"\n";
        for (keys, answer) in [
            ("camera = [1, 2]", "view: unknown key `camera`; did you mean `eye`?"),
            ("fov = 40", "view: unknown key `fov`; did you mean `field_of_view_deg`?"),
            ("fps = 30", "view: unknown key `fps`; did you mean `frames_per_second`?"),
            ("size = 30", "view: unknown key `size`; did you mean `width`?"),
            ("through = [1, 2]", "view: unknown key `through`; it is a key of picture = \"render\""),
            ("exposur = 1", "view: unknown key `exposur`; did you mean `exposure`?"),
        ] {
            let message = refusal(&format!("{view}{keys}\n"));
            assert!(message.contains(answer) && !message.contains('\n'), "{message}");
        }
        let message = refusal("picture = \"fractal\"\nfractal = \"fern\"\nfile = \"a.png\"\nwidth = 400\n");
        assert!(message.contains("fractal: unknown key `width`; did you mean `size`?"), "{message}");
    }

    #[test]
    fn the_list_of_keys_has_those_of_films_and_the_file() {
        let message = refusal("picture = \"view\"\nfile = \"a.png\"\nxyzzy = 1\n");
        let (_, keys) = message.split_once("the keys here are: of, width").expect("a list");
        assert!(keys.ends_with("every, frames, frames_per_second, picture, file"), "{keys}");
    }
}
