//! The keys of an edit: what `do` can say, and what goes with it.

use super::brush::{Brush, Effect, Falloff};
use super::change::{Change, Edit, Setting};
use weald_core::parameter::{Diagnostics, LayerName, Parameters, Places, nearest};
use weald_core::source::{Node, Table, Value};

/// Most places of one stroke.
pub const MAX_PLACES: usize = 10_000;

weald_core::parameters! {
    /// The keys of a stroke, beside `do`: add, remove, add-water, remove-water, smooth, flatten, source, drain,
    /// rain, freeze, thaw, mask or unmask. What is masked is left as it is by all strokes but the last two.
    /// `do = "set"` has others, [`SettingKeys`].
    pub struct EditKeys {
        /// Iteration before which the stroke happens; 0 is before the first.
        step: u64 = 0, range 0..=9_007_199_254_740_991_u64;
        /// Place `[x, y]` in metres from the north-western corner, east and south, or a list of places for a
        /// line through them.
        path: Places = Places::needed();
        /// Distance from the line to the edge of the stroke.
        radius: f64 = 50.0, range 0.001..=1_000_000.0, unit "m";
        /// How the effect falls off towards the edge.
        falloff: Falloff = Falloff::Smooth;
        /// Share of the effect in the middle.
        strength: f64 = 1.0, range 0.0..=1.0;
        /// Material that `add` and `remove` are about, or `bedrock`.
        material: Option<LayerName> = None;
        /// Metres of it.
        thickness: Option<f64> = None, range 0.0..=100_000.0, unit "m";
        /// Metres of water for `add-water` and `remove-water`.
        depth: Option<f64> = None, range 0.0..=100_000.0, unit "m";
        /// How many times `smooth` is done; 1 where it says nothing.
        times: Option<u32> = None, range 1..=64;
        /// Height that `flatten` brings the ground to.
        height: Option<f64> = None, range -100_000.0..=100_000.0, unit "m";
        /// Metres of water per iteration for `source` and `drain`.
        rate: Option<f64> = None, range 0.0..=1000.0, unit "m/iteration";
        /// Factor on the rain for `rain`.
        factor: Option<f64> = None, range 0.0..=1000.0;
    }
}

weald_core::parameters! {
    /// The keys of an edit that gives a key of the step another value, beside `do = "set"`; its `value` is a number, a
    /// flag or a word.
    pub struct SettingKeys {
        /// Iteration before which the value changes; 0 is before the first.
        step: u64 = 0, range 0..=9_007_199_254_740_991_u64;
        /// Key of the step; one within a table has its name behind a point: `thermal.talus`.
        key: Option<String> = None;
    }
}

/// The word after `do` of an edit that changes a key.
const SET: &str = "set";

/// A word after `do`, the keys that it needs, and those that it may have.
struct EditKind {
    word: &'static str,
    needs: &'static [&'static str],
    takes: &'static [&'static str],
    /// `None` where a key is missing.
    effect: fn(&EditKeys) -> Option<Effect>,
}

const EDIT_KINDS: &[EditKind] = &[
    EditKind {
        word: "add",
        needs: &["material", "thickness"],
        takes: &[],
        effect: |keys| Some(Effect::Add { material: keys.material.clone()?.0, thickness: keys.thickness? }),
    },
    EditKind {
        word: "remove",
        needs: &["material", "thickness"],
        takes: &[],
        effect: |keys| {
            Some(Effect::Remove { material: keys.material.clone()?.0, thickness: keys.thickness? })
        },
    },
    EditKind {
        word: "add-water",
        needs: &["depth"],
        takes: &[],
        effect: |keys| Some(Effect::AddWater { depth: keys.depth? }),
    },
    EditKind {
        word: "remove-water",
        needs: &["depth"],
        takes: &[],
        effect: |keys| Some(Effect::RemoveWater { depth: keys.depth? }),
    },
    EditKind {
        word: "smooth",
        needs: &[],
        takes: &["times"],
        effect: |keys| Some(Effect::Smooth { times: keys.times.unwrap_or(1) }),
    },
    EditKind {
        word: "flatten",
        needs: &["height"],
        takes: &[],
        effect: |keys| Some(Effect::Flatten { height: keys.height? }),
    },
    EditKind {
        word: "source",
        needs: &["rate"],
        takes: &[],
        effect: |keys| Some(Effect::Source { rate: keys.rate? }),
    },
    EditKind {
        word: "drain",
        needs: &["rate"],
        takes: &[],
        effect: |keys| Some(Effect::Drain { rate: keys.rate? }),
    },
    EditKind {
        word: "rain",
        needs: &["factor"],
        takes: &[],
        effect: |keys| Some(Effect::Rain { factor: keys.factor? }),
    },
    EditKind { word: "freeze", needs: &[], takes: &[], effect: |_| Some(Effect::Freeze) },
    EditKind { word: "thaw", needs: &[], takes: &[], effect: |_| Some(Effect::Thaw) },
    EditKind { word: "mask", needs: &[], takes: &[], effect: |_| Some(Effect::Mask) },
    EditKind { word: "unmask", needs: &[], takes: &[], effect: |_| Some(Effect::Unmask) },
];

/// Keys that go with some kinds of edits only.
const SPECIAL: [&str; 7] = ["material", "thickness", "depth", "times", "height", "rate", "factor"];

/// Reads the table of one edit; `None` where it is not understood in full.
pub(super) fn read(table: &Table, materials: &[&str], diagnostics: &mut Diagnostics) -> Option<Edit> {
    let before = diagnostics.found.len();
    "edit".clone_into(&mut diagnostics.subject);
    if matches!(table.get("do"), Some(Node { value: Value::Text(word), .. }) if word == SET) {
        return read_setting(table, diagnostics).filter(|_| diagnostics.found.len() == before);
    }
    let edit_kind = edit_kind(table, diagnostics)?;
    edit_kind.word.clone_into(&mut diagnostics.subject);
    let mut rest = table.clone();
    rest.take("do");
    let keys = EditKeys::read(&rest, diagnostics);
    edit_kind.check(table, diagnostics);
    check_material(table, &keys, materials, diagnostics);
    if keys.path.0.len() > MAX_PLACES {
        let places = keys.path.0.len();
        diagnostics.add(table.line, format!("`path` has {places} places; a stroke has at most {MAX_PLACES}"));
    }
    let effect = (edit_kind.effect)(&keys).filter(|_| diagnostics.found.len() == before)?;
    let EditKeys { step, path, radius, falloff, strength, .. } = keys;
    Some(Edit::stroke(step, Brush { path: path.0, radius, falloff, strength, effect }))
}

fn read_setting(table: &Table, diagnostics: &mut Diagnostics) -> Option<Edit> {
    SET.clone_into(&mut diagnostics.subject);
    let mut rest = table.clone();
    rest.take("do");
    let value = rest.take("value");
    let keys = SettingKeys::read(&rest, diagnostics);
    if keys.key.is_none() {
        diagnostics.add(table.line, "`key` is needed: the key of the step that changes".to_owned());
    }
    match &value {
        None => diagnostics.add(table.line, "`value` is needed: a number, a flag or a word".to_owned()),
        Some(Node { line, value: value @ (Value::List(_) | Value::Table(_)) }) => {
            let message = format!("`value` is {}, but must be a number, a flag or a word", value.shown());
            diagnostics.add(*line, message);
        }
        Some(_) => {}
    }
    let setting = Setting { key: keys.key?, value: value?.value };
    Some(Edit { step: keys.step, change: Change::Set(setting) })
}

fn edit_kind(table: &Table, diagnostics: &mut Diagnostics) -> Option<&'static EditKind> {
    let words: Vec<_> = EDIT_KINDS.iter().map(|edit_kind| edit_kind.word).chain([SET]).collect();
    let Some(Node { value, line }) = table.get("do") else {
        diagnostics.add(table.line, format!("`do` is needed: one of {}", words.join(", ")));
        return None;
    };
    let word = match value {
        Value::Text(word) => word.as_str(),
        _ => "",
    };
    let edit_kind = EDIT_KINDS.iter().find(|edit_kind| edit_kind.word == word);
    if edit_kind.is_none() {
        let hint = match nearest(word, &words) {
            Some(near) => format!("did you mean `{near}`?"),
            None => format!("it must be one of {}", words.join(", ")),
        };
        diagnostics.add(*line, format!("`do` is {}; {hint}", value.shown()));
    }
    edit_kind
}

impl EditKind {
    /// Complains of keys that are missing, and of those that mean nothing here.
    fn check(&self, table: &Table, diagnostics: &mut Diagnostics) {
        for key in SPECIAL {
            match table.get(key) {
                None if self.needs.contains(&key) => {
                    diagnostics.add(table.line, format!("`{key}` is needed"));
                }
                Some(node) if !self.needs.contains(&key) && !self.takes.contains(&key) => {
                    diagnostics.add(node.line, format!("`{key}` does not go with `{}`", self.word));
                }
                _ => {}
            }
        }
    }
}

fn check_material(table: &Table, keys: &EditKeys, materials: &[&str], diagnostics: &mut Diagnostics) {
    let Some(LayerName(name)) = &keys.material else { return };
    if name == weald_core::material::BEDROCK || materials.contains(&name.as_str()) {
        return;
    }
    let hint = match nearest(name, materials) {
        Some(near) => format!("did you mean `{near}`?"),
        None => format!("the ground is of: {}", materials.join(", ")),
    };
    let line = table.get("material").map_or(table.line, |node| node.line);
    diagnostics.add(line, format!("`material` is {name:?}, of which there is none; {hint}"));
}

/// The keys and values of an edit in JSON, which TOML reads too; those that are at their defaults are said.
pub(super) fn written(edit: &Edit) -> Vec<(&'static str, serde_json::Value)> {
    let Brush { path, radius, falloff, strength, effect } = match &edit.change {
        Change::Stroke(brush) => brush,
        Change::Set(Setting { key, value }) => {
            let (key, value) = (key.as_str().into(), plain(value));
            return vec![("step", edit.step.into()), ("do", SET.into()), ("key", key), ("value", value)];
        }
    };
    let (word, special) = kind_and_keys(effect);
    let mut keys: Vec<(&'static str, serde_json::Value)> =
        vec![("step", edit.step.into()), ("do", word.into())];
    keys.extend(special);
    keys.push(("path", path.iter().map(|place| place.to_vec()).collect()));
    keys.extend([
        ("radius", (*radius).into()),
        ("falloff", falloff.word().into()),
        ("strength", (*strength).into()),
    ]);
    keys
}

/// A value that is no list and no table.
fn plain(value: &Value) -> serde_json::Value {
    match value {
        Value::Flag(flag) => (*flag).into(),
        Value::Integer(number) => (*number).into(),
        Value::Number(number) => (*number).into(),
        Value::Text(text) => text.as_str().into(),
        Value::List(_) | Value::Table(_) => serde_json::Value::Null,
    }
}

/// The word after `do`, and the keys that go with it.
fn kind_and_keys(effect: &Effect) -> (&'static str, Vec<(&'static str, serde_json::Value)>) {
    match effect {
        Effect::Add { material, thickness } => {
            ("add", vec![("material", material.as_str().into()), ("thickness", (*thickness).into())])
        }
        Effect::Remove { material, thickness } => {
            ("remove", vec![("material", material.as_str().into()), ("thickness", (*thickness).into())])
        }
        Effect::AddWater { depth } => ("add-water", vec![("depth", (*depth).into())]),
        Effect::RemoveWater { depth } => ("remove-water", vec![("depth", (*depth).into())]),
        Effect::Smooth { times } => ("smooth", vec![("times", (*times).into())]),
        Effect::Flatten { height } => ("flatten", vec![("height", (*height).into())]),
        Effect::Source { rate } => ("source", vec![("rate", (*rate).into())]),
        Effect::Drain { rate } => ("drain", vec![("rate", (*rate).into())]),
        Effect::Rain { factor } => ("rain", vec![("factor", (*factor).into())]),
        Effect::Freeze => ("freeze", Vec::new()),
        Effect::Thaw => ("thaw", Vec::new()),
        Effect::Mask => ("mask", Vec::new()),
        Effect::Unmask => ("unmask", Vec::new()),
    }
}
