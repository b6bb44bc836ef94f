//! A control for every key of every step, made from its declaration alone: unit, range, default, and the documentation on
//! hover.

use eframe::egui::{Checkbox, Color32, ComboBox, DragValue, Response, RichText, TextEdit, Ui};
use weald::recipe::parameter::{Kind, Parameter, Variant};
use weald::recipe::source::{Node, Table, Value};

/// What a person did with a control.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Turned {
    /// The key, with the tables that it is in before points.
    pub(crate) key: String,
    /// Its new value in TOML notation, or `None` to leave it to its default.
    pub(crate) value: Option<String>,
}

/// Keys that are shown before the others are folded away.
const SHOWN: usize = 8;

/// Keys that are no controls: those that name the step, and the script that the window itself keeps.
const WITHOUT: [&str; 2] = ["do", "edits"];

/// All controls of a table; those that are set, and the first few others, stand above a fold.
pub(crate) fn controls(ui: &mut Ui, table: &Table, parameters: &[Parameter], id: &str) -> Option<Turned> {
    let known: Vec<_> = parameters.iter().filter(|parameter| !WITHOUT.contains(&parameter.name)).collect();
    let all: Vec<&Parameter> = parameters.iter().collect();
    let has_effect = |parameter: &Parameter| parameter.needs.iter().all(|needs| needs.is_met(table, &all));
    let (mut above, mut below) = (Vec::new(), Vec::new());
    for parameter in
        known.into_iter().filter(|parameter| has_effect(parameter) || table.get(parameter.name).is_some())
    {
        let stands_above = above.len() < SHOWN || table.get(parameter.name).is_some() || parameter.required;
        if stands_above { above.push(parameter) } else { below.push(parameter) }
    }
    let mut turned = None;
    for parameter in above {
        turned = control(ui, table, parameter, id).or(turned);
    }
    if !below.is_empty() {
        ui.collapsing(format!("More keys ({})", below.len()), |ui| {
            for parameter in below {
                turned = control(ui, table, parameter, id).or(turned.take());
            }
        });
    }
    turned
}

/// One control, on a line of its own.
fn control(ui: &mut Ui, table: &Table, parameter: &Parameter, id: &str) -> Option<Turned> {
    let node = table.get(parameter.name);
    let key = parameter.name;
    let within = |turned: Turned| Turned { key: format!("{key}.{}", turned.key), value: turned.value };
    match &parameter.kind {
        Kind::Table(inner) => {
            let given = match node {
                Some(Node { value: Value::Table(given), .. }) => given.clone(),
                _ => Table::default(),
            };
            let header = ui.collapsing(key, |ui| controls(ui, &given, inner, &format!("{id}.{key}")));
            header.header_response.on_hover_text(parameter.doc);
            header.body_returned.flatten().map(within)
        }
        Kind::Variants(variants) => variant(ui, table, (parameter, variants), id),
        _ => line(ui, parameter, node, id),
    }
}

/// The word that brings keys of its own, and these keys.
fn variant(ui: &mut Ui, table: &Table, of: (&Parameter, &[Variant]), id: &str) -> Option<Turned> {
    let (parameter, variants) = of;
    let words: Vec<_> = variants.iter().map(|variant| variant.word).collect();
    let value = shown(table.get(parameter.name), parameter);
    let word = value.trim_matches('"').to_owned();
    let turned = labelled(ui, parameter, table.get(parameter.name).is_some(), |ui| {
        choice(ui, &words, &word, (parameter, id))
    });
    let inner = variants.iter().find(|variant| variant.word == word);
    let inner = inner.and_then(|variant| {
        ui.indent(format!("{id}.{word}"), |ui| {
            controls(ui, table, &variant.parameters, &format!("{id}.{word}"))
        })
        .inner
    });
    turned.or(inner)
}

/// Name, control and unit of a plain key; a name that was set is bright, and can be set back.
fn line(ui: &mut Ui, parameter: &Parameter, node: Option<&Node>, id: &str) -> Option<Turned> {
    let value = shown(node, parameter);
    labelled(ui, parameter, node.is_some(), |ui| match &parameter.kind {
        Kind::Number(low, high) => number(ui, parameter, &value, [*low, *high]),
        Kind::Integer(low, high) => integer(ui, parameter, &value, [*low, *high]),
        Kind::Flag => {
            let mut flag = value == "true";
            let response = ui.add(Checkbox::without_text(&mut flag));
            named(&response, parameter);
            response.changed().then(|| flag.to_string())
        }
        Kind::Choice(words) => choice(ui, words, value.trim_matches('"'), (parameter, id)),
        Kind::Colour => colour(ui, parameter, &value),
        Kind::Text | Kind::Raster | Kind::Script | Kind::Flame | Kind::Layer | Kind::Crs => {
            typed(ui, parameter, value.trim_matches('"'), id).map(|text| format!("{text:?}"))
        }
        _ => typed(ui, parameter, &value, id),
    })
}

fn labelled(
    ui: &mut Ui,
    parameter: &Parameter,
    is_set: bool,
    contents: impl FnOnce(&mut Ui) -> Option<String>,
) -> Option<Turned> {
    ui.horizontal(|ui| {
        let name = RichText::new(parameter.name);
        let name = if is_set { name.strong() } else { name.weak() };
        ui.label(name).on_hover_text(hover(parameter));
        let given = contents(ui);
        let resets = is_set
            && !parameter.required
            && ui
                .small_button("reset")
                .on_hover_text(format!("Set {} back to its default", parameter.name))
                .clicked();
        let key = parameter.name.to_owned();
        (resets || given.is_some()).then(|| Turned { key, value: given.filter(|_| !resets) })
    })
    .inner
}

/// Documentation, kind and default, as `weald steps` has them.
fn hover(parameter: &Parameter) -> String {
    let unit = if parameter.unit == "1" { String::new() } else { format!(" {}", parameter.unit) };
    let default =
        parameter.default_in_words.as_ref().map_or(String::new(), |words| format!("\nDefault: {words}"));
    format!("{}\n{}{unit}{default}", parameter.doc.trim(), parameter.kind.in_words())
}

/// A screen reader, and a test, finds a control by the name of its key.
fn named(response: &Response, parameter: &Parameter) {
    let (id, name) = (response.id, parameter.name);
    response.ctx.accesskit_node_builder(id, |node| node.set_label(name));
}

/// The value as given or by default; empty where there is neither.
fn shown(node: Option<&Node>, parameter: &Parameter) -> String {
    node.map_or_else(|| parameter.default.clone().unwrap_or_default(), |node| toml(&node.value))
}

/// A value in TOML notation.
pub(super) fn toml(value: &Value) -> String {
    match value {
        Value::List(items) => {
            let items: Vec<_> = items.iter().map(|item| toml(&item.value)).collect();
            format!("[{}]", items.join(", "))
        }
        Value::Table(table) => {
            let entries: Vec<_> =
                table.entries.iter().map(|(key, node)| format!("{key} = {}", toml(&node.value))).collect();
            format!("{{ {} }}", entries.join(", "))
        }
        plain => plain.shown(),
    }
}

fn unit(parameter: &Parameter) -> String {
    if parameter.unit == "1" { String::new() } else { format!(" {}", parameter.unit) }
}

fn number(ui: &mut Ui, parameter: &Parameter, value: &str, [low, high]: [f64; 2]) -> Option<String> {
    let Ok(mut number) = value.parse::<f64>() else { return give(ui, parameter, low.max(0.0).min(high)) };
    // A drag over the width of a hand goes through about the size of the value.
    let speed = (number.abs() * 0.01).max(1e-4_f64.max((high - low).min(1.0) * 1e-3));
    let drag =
        DragValue::new(&mut number).range(low..=high).speed(speed).max_decimals(6).suffix(unit(parameter));
    let response = ui.add(drag);
    named(&response, parameter);
    response.changed().then(|| format!("{number:?}"))
}

fn integer(ui: &mut Ui, parameter: &Parameter, value: &str, [low, high]: [f64; 2]) -> Option<String> {
    let Ok(mut number) = value.parse::<i64>() else {
        return give(ui, parameter, low.max(0.0)).map(|text| whole(&text));
    };
    let speed = (number as f64 * 0.01).abs().max(0.1);
    let range = low.max(i64::MIN as f64) as i64..=high.min(i64::MAX as f64) as i64;
    let drag = DragValue::new(&mut number).range(range).speed(speed).suffix(unit(parameter));
    let response = ui.add(drag);
    named(&response, parameter);
    response.changed().then(|| number.to_string())
}

fn whole(text: &str) -> String {
    text.trim_end_matches(".0").to_owned()
}

/// A key whose absence means something: what it means, and a button that gives it a value.
fn give(ui: &mut Ui, parameter: &Parameter, first: f64) -> Option<String> {
    let words = parameter.default_in_words.as_deref().unwrap_or("not given");
    let response = ui.button(format!("{words} …"));
    named(&response, parameter);
    response.on_hover_text("Give it a value of its own").clicked().then(|| format!("{first:?}"))
}

fn choice(ui: &mut Ui, words: &[&str], word: &str, (parameter, id): (&Parameter, &str)) -> Option<String> {
    let mut chosen = None;
    let combo = ComboBox::from_id_salt((id, parameter.name)).selected_text(if word.is_empty() {
        "by default"
    } else {
        word
    });
    let shown = combo.show_ui(ui, |ui| {
        for other in words {
            if ui.selectable_label(*other == word, *other).clicked() && *other != word {
                chosen = Some(format!("{other:?}"));
            }
        }
    });
    named(&shown.response, parameter);
    chosen
}

fn colour(ui: &mut Ui, parameter: &Parameter, value: &str) -> Option<String> {
    let mut colour = Color32::from_hex(value.trim_matches('"')).unwrap_or(Color32::GRAY);
    let response = ui.color_edit_button_srgba(&mut colour);
    named(&response, parameter);
    let [red, green, blue, _] = colour.to_array();
    response.changed().then(|| format!("\"#{red:02x}{green:02x}{blue:02x}\""))
}

/// A text that counts once the field is left, so that no half of it is ever run.
fn typed(ui: &mut Ui, parameter: &Parameter, value: &str, id: &str) -> Option<String> {
    let place = ui.scope_id().with((id, parameter.name, "typed"));
    let mut text = ui.data(|data| data.get_temp::<String>(place)).unwrap_or_else(|| value.to_owned());
    let response = ui.add(TextEdit::singleline(&mut text).desired_width(140.0));
    named(&response, parameter);
    if response.has_focus() {
        ui.data_mut(|data| data.insert_temp(place, text.clone()));
    }
    if !response.lost_focus() {
        return None;
    }
    ui.data_mut(|data| data.remove::<String>(place));
    (text != value).then_some(text)
}
