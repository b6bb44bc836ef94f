//! What a user can know of a parameter: its key, unit, type, range, default, and what it needs to have an effect.

/// What a user can know of one parameter.
#[derive(Clone, Debug)]
pub struct Parameter {
    /// Key in the recipe.
    pub name: &'static str,
    /// What it does.
    pub doc: &'static str,
    /// Unit of a number; `1` where it has none.
    pub unit: &'static str,
    /// Type and range.
    pub kind: Kind,
    /// Default in TOML notation; `None` where the key is needed or its absence means something.
    pub default: Option<String>,
    /// Default in words, also where TOML cannot say it, such as `0.01 × cell size`.
    pub default_in_words: Option<String>,
    /// Whether a recipe must give the key.
    pub required: bool,
    /// What the key depends on, all of it, to have an effect.
    pub needs: Vec<Needs>,
}

/// Type and range of a parameter.
#[derive(Clone, Debug)]
pub enum Kind {
    /// A number within both bounds.
    Number(f64, f64),
    /// A whole number within both bounds.
    Integer(f64, f64),
    /// `true` or `false`.
    Flag,
    /// One of these words.
    Choice(&'static [&'static str]),
    /// Any text.
    Text,
    /// A raster file that is read; its path starts at the folder of the recipe.
    Raster,
    /// A script of edits that is read; its path starts at the folder of the recipe.
    Script,
    /// A file of flames that is read; its path starts at the folder of the recipe.
    Flame,
    /// A colour as `"#rrggbb"`.
    Colour,
    /// A coordinate reference system as `"EPSG:4326"`.
    Crs,
    /// Cells a side, or a list of columns and rows.
    Sides,
    /// The name of a layer.
    Layer,
    /// A list of names of layers.
    Layers,
    /// A place as a list of two numbers, or a list of places.
    Places,
    /// A list of numbers, each within both bounds.
    Numbers(f64, f64),
    /// A list of lists of numbers.
    Rows,
    /// A list of these words.
    Choices(&'static [&'static str]),
    /// A table with parameters of its own.
    Table(Vec<Parameter>),
    /// A list of such tables.
    Tables(Vec<Parameter>),
    /// One of several words, each of which brings parameters of its own into the same table.
    Variants(Vec<Variant>),
}

impl Kind {
    /// The kind in words, for `weald steps` and errors.
    pub fn in_words(&self) -> String {
        match self {
            Self::Number(low, high) => format!("number, {}", range_in_words(*low, *high)),
            Self::Integer(low, high) => format!("whole number, {}", range_in_words(low.max(0.0), *high)),
            Self::Flag => "true or false".to_owned(),
            Self::Choice(words) => words_in_words(words.iter().copied()),
            Self::Variants(variants) => words_in_words(variants.iter().map(|variant| variant.word)),
            Self::Text => "text".to_owned(),
            Self::Raster => "raster file".to_owned(),
            Self::Script => "script of edits".to_owned(),
            Self::Flame => ".flame file".to_owned(),
            Self::Colour => "colour \"#rrggbb\"".to_owned(),
            Self::Crs => "CRS \"EPSG:…\"".to_owned(),
            Self::Sides => "whole number from 1, or [columns, rows]".to_owned(),
            Self::Layer => "layer name".to_owned(),
            Self::Layers => "list of layer names".to_owned(),
            Self::Numbers(low, high) => format!("list of numbers, {}", range_in_words(*low, *high)),
            Self::Rows => "list of lists of numbers".to_owned(),
            Self::Choices(names) => format!("list of {}", Self::Choice(names).in_words()),
            Self::Places => "[x, y], or a list of places".to_owned(),
            Self::Table(_) => "table".to_owned(),
            Self::Tables(_) => "list of tables".to_owned(),
        }
    }
}

fn words_in_words(words: impl Iterator<Item = &'static str>) -> String {
    words.map(|word| format!("{word:?}")).collect::<Vec<_>>().join(" | ")
}

pub(super) fn range_in_words(low: f64, high: f64) -> String {
    match (low.is_finite(), high.is_finite()) {
        (true, true) => format!("{low} to {high}"),
        (true, false) => format!("at least {low}"),
        (false, true) => format!("at most {high}"),
        (false, false) => "any finite".to_owned(),
    }
}

/// What a key depends on. Values are in TOML notation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Needs {
    /// This key has one of these values.
    Value(&'static str, &'static [&'static str]),
    /// This key has none of these values.
    OtherValue(&'static str, &'static [&'static str]),
    /// One of these keys is given.
    Given(&'static [&'static str]),
    /// This key is not given.
    Absent(&'static str),
    /// The output is a file of one of these extensions.
    File(&'static [&'static str]),
}

/// One of the words of a [`Kind::Variants`](super::Kind::Variants).
#[derive(Clone, Debug)]
pub struct Variant {
    /// The word in a recipe.
    pub word: &'static str,
    /// What it stands for.
    pub doc: &'static str,
    /// The parameters that only this word has, or has in its own way.
    pub parameters: Vec<Parameter>,
}
