//! Random recipes from the declarations of steps, pictures, exports and materials: the same seed, the same recipe.

use std::fmt::Write;

use weald::export::EXPORTS;
use weald::picture::PICTURES;
use weald::random::splitmix64;
use weald::recipe::catalog::CATALOG;
use weald::recipe::parameter::{Kind, Parameter};
use weald::recipe::{Overrides, Recipe};

/// Keys whose greater values take long and prove nothing more.
const SHORT: &[(&str, f64)] = &[
    ("iterations", 12.0),
    ("duration", 0.5),
    ("count", 400.0),
    ("max_sets", 500.0),
    ("samples", 2.0),
    ("rays", 16.0),
    ("octaves", 6.0),
    ("depth", 5.0),
    ("width", 90.0),
    ("texture", 300.0),
    ("height", 60.0),
    ("frames", 3.0),
    ("tiles", 3.0),
    ("directions", 16.0),
    ("size", 300.0),
    ("density", 2.0),
];

/// Keys of sizes that the check refuses where they are over a limit.
const SIZES: &[&str] = &["width", "texture", "size"];

/// Random numbers in a row.
pub(super) struct Dice(u64);

impl Dice {
    pub(super) fn new(seed: u64) -> Self {
        Self(splitmix64(seed))
    }

    fn next(&mut self) -> u64 {
        self.0 = splitmix64(self.0);
        self.0
    }

    fn below(&mut self, count: usize) -> usize {
        (self.next() % count.max(1) as u64) as usize
    }

    fn one_in(&mut self, count: usize) -> bool {
        self.below(count) == 0
    }

    fn share(&mut self) -> f64 {
        weald::random::unit(self.next())
    }

    fn pick<'a, T: ?Sized>(&mut self, among: &[&'a T]) -> &'a T {
        among[self.below(among.len())]
    }
}

/// A recipe that is being put together: what is refused is left out again.
pub(super) struct Made {
    dice: Dice,
    text: String,
    layers: Vec<String>,
    named: usize,
}

/// The text of a recipe, most of which have several steps and outputs.
pub(super) fn recipe(seed: u64) -> String {
    let mut made = Made { dice: Dice::new(seed), text: String::new(), layers: Vec::new(), named: 0 };
    made.landscape();
    for _ in 0..made.dice.below(6) {
        made.step();
    }
    for _ in 0..=made.dice.below(4) {
        made.output();
    }
    made.text
}

impl Made {
    fn landscape(&mut self) {
        let side = |dice: &mut Dice| {
            if dice.one_in(6) { 1 + dice.below(4) } else { 2 + dice.below(40) }
        };
        let [columns, rows] = [side(&mut self.dice), side(&mut self.dice)];
        let cells = [0.01, 1.0, 5.0, 20.0, 20.0, 90.0, 1000.0, 50_000.0];
        let cell = cells[self.dice.below(cells.len())];
        let _ = writeln!(
            self.text,
            "[landscape]\nsize = [{columns}, {rows}]\ncell = {cell}\nseed = {}",
            self.dice.below(1000)
        );
        if self.dice.one_in(4) {
            for name in ["rock", "soil", "sand"].iter().take(1 + self.dice.below(3)) {
                let _ = writeln!(self.text, "[[material]]\nname = {name:?}");
                if *name != "rock" {
                    let _ = writeln!(self.text, "thickness = {}", self.dice.below(5));
                }
            }
        }
        let reliefs = [1.0, 50.0, 900.0];
        let relief = reliefs[self.dice.below(3)];
        let _ = writeln!(self.text, "[[step]]\ndo = \"fbm\"\nrelief = {relief}");
        self.layers.push("height".to_owned());
    }

    /// Adds a step that the plan takes, if one of some attempts is.
    fn step(&mut self) {
        let entries: Vec<_> = CATALOG.iter().filter(|entry| entry.name != "load").collect();
        for attempt in 0..6 {
            let entry = self.dice.pick(&entries);
            let mut text = format!("[[step]]\ndo = {:?}\n", entry.name);
            self.keys(&mut text, &(entry.parameters)(), attempt);
            if entry.name == "fluvial" && !text.contains("\nduration") {
                text.push_str("duration = 0.3\n");
            }
            // A step needs an output beside it to be a recipe, whatever that is.
            let whole = format!("{}{text}[[output]]\nlayer = \"height\"\nfile = \"h.npy\"\n", self.text);
            if let Ok(recipe) = Recipe::parse("r.toml", &whole, &Overrides::default()) {
                let written = recipe.steps.iter().flat_map(|planned| planned.step.writes());
                for (name, _) in written {
                    if !self.layers.contains(&name) {
                        self.layers.push(name);
                    }
                }
                self.text.push_str(&text);
                return;
            }
        }
    }

    fn output(&mut self) {
        for attempt in 0..6 {
            let mut text = "[[output]]\n".to_owned();
            let number = self.named;
            self.named += 1;
            match self.dice.below(3) {
                0 => {
                    let formats = ["tif", "png", "exr", "raw", "r16", "r32", "asc", "npy", "nc", "zarr"];
                    let format = self.dice.pick(&formats);
                    let layer = self.layer();
                    let _ = writeln!(text, "layer = {layer:?}\nfile = \"o{number}.{format}\"");
                }
                1 => {
                    let entry = &PICTURES[self.dice.below(PICTURES.len())];
                    let _ = writeln!(text, "picture = {:?}", entry.name);
                    let mut extension = entry.extensions[self.dice.below(entry.extensions.len())];
                    if self.dice.one_in(5) {
                        let films = ["png", "apng"];
                        extension = films[self.dice.below(2)];
                        // A picture of every second step is hundreds of the same kind, and one of every fifty years of
                        // five million are hundreds of thousands.
                        let every = if self.text.contains("\"stream-power\"") { 2_000_000 } else { 50 };
                        let key = ["frames = 3".to_owned(), format!("every = {every}")];
                        let _ = writeln!(text, "{}", key[self.dice.below(2)]);
                    }
                    self.keys(&mut text, &(entry.parameters)(), attempt);
                    // Views have many pixels by default.
                    if ["view", "render"].contains(&entry.name) && !text.contains("\nwidth") {
                        text.push_str("width = 60\nheight = 40\nsamples = 1\n");
                    }
                    let _ = writeln!(text, "file = \"o{number}.{extension}\"");
                }
                _ => {
                    let entry = &EXPORTS[self.dice.below(EXPORTS.len())];
                    let extension = entry.extensions[self.dice.below(entry.extensions.len())];
                    let _ = writeln!(text, "export = {:?}\nfile = \"o{number}.{extension}\"", entry.name);
                    self.keys(&mut text, &(entry.parameters)(), attempt);
                }
            }
            let whole = format!("{}{text}", self.text);
            if Recipe::parse("r.toml", &whole, &Overrides::default()).is_ok() {
                self.text.push_str(&text);
                return;
            }
        }
    }

    fn layer(&mut self) -> String {
        let at = if self.dice.one_in(2) { 0 } else { self.dice.below(self.layers.len()) };
        self.layers[at].clone()
    }

    /// Some of the keys of a table, fewer at each attempt, all at hand for those that are needed.
    fn keys(&mut self, text: &mut String, parameters: &[Parameter], attempt: usize) {
        for parameter in parameters {
            let wanted = parameter.required || self.dice.one_in(4 + 3 * attempt);
            if !wanted {
                continue;
            }
            if let Kind::Variants(variants) = &parameter.kind {
                let variant = &variants[self.dice.below(variants.len())];
                let _ = writeln!(text, "{} = {:?}", parameter.name, variant.word);
                self.keys(text, &variant.parameters, attempt + 1);
            } else if let Some(value) = self.value(parameter) {
                let _ = writeln!(text, "{} = {value}", parameter.name);
            }
        }
    }

    fn value(&mut self, parameter: &Parameter) -> Option<String> {
        let value = match &parameter.kind {
            Kind::Number(low, high) => format!("{:?}", self.number(parameter, *low, *high)),
            Kind::Integer(low, high) => format!("{}", self.number(parameter, low.max(0.0), *high).round()),
            Kind::Flag => format!("{}", self.dice.one_in(2)),
            Kind::Choice(words) => format!("{:?}", self.dice.pick(words)),
            Kind::Choices(words) => format!("[{:?}]", self.dice.pick(words)),
            Kind::Layer => {
                let fresh = parameter.name == "into" && self.dice.one_in(2);
                let name = if fresh { format!("l{}", self.dice.below(9)) } else { self.layer() };
                format!("{name:?}")
            }
            Kind::Layers => format!("[{:?}]", self.layer()),
            Kind::Colour => "\"#4a6b2f\"".to_owned(),
            Kind::Places => format!("[{:?}, {:?}]", 60.0 * self.dice.share(), 60.0 * self.dice.share()),
            Kind::Numbers(low, high) => {
                let count = [1, 2, 3, 4][self.dice.below(4)];
                let numbers: Vec<_> =
                    (0..count).map(|_| format!("{:?}", self.number(parameter, *low, *high))).collect();
                format!("[{}]", numbers.join(", "))
            }
            Kind::Sides => match self.dice.below(2) {
                0 => format!("{}", 1 + self.dice.below(50)),
                _ => format!("[{}, {}]", 1 + self.dice.below(50), 1 + self.dice.below(50)),
            },
            Kind::Table(inner) => format!("{{ {} }}", self.inner(inner)),
            Kind::Tables(inner) => format!("[{{ {} }}]", self.inner(inner)),
            Kind::Text if parameter.name == "of" || parameter.name == "name" => "\"fern\"".to_owned(),
            _ => return None,
        };
        Some(value)
    }

    fn inner(&mut self, parameters: &[Parameter]) -> String {
        let mut text = String::new();
        self.keys(&mut text, parameters, 1);
        text.trim_end().replace('\n', ", ")
    }

    /// Often near the default, sometimes anywhere, at times at an end of the range.
    fn number(&mut self, parameter: &Parameter, low: f64, high: f64) -> f64 {
        let short = SHORT.iter().find(|(name, _)| *name == parameter.name).map(|(_, most)| *most);
        // At times a size that is far too large, which the check has to tell.
        let short = short.filter(|_| !(SIZES.contains(&parameter.name) && self.dice.one_in(25)));
        let high = high.min(1e6).min(short.map_or(f64::INFINITY, |most| most.max(low)));
        let low = low.max(-1e6);
        let default = parameter.default.as_deref().and_then(|default| default.parse::<f64>().ok());
        let value = match (self.dice.below(8), default) {
            (0, _) => low,
            (1, _) if short.is_some() => high,
            (2..=4, Some(default)) if default != 0.0 => default * (0.5 + 1.5 * self.dice.share()),
            (5, _) if low > 0.0 => low * (high / low).powf(self.dice.share()),
            _ if high - low > 1000.0 => low + 300.0 * self.dice.share(),
            _ => low + (high - low) * self.dice.share(),
        };
        value.clamp(low, high)
    }
}
