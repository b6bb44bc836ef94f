//! The words that a recipe can use, and what is said of others.

use crate::recipe::catalog::CATALOG;
use crate::recipe::parameter;
use crate::recipe::parameter::Diagnostics;
use crate::recipe::source::{Node, Table, Value};
use std::path::Path;
use weald_engine::step::Entry;
use weald_export::{EXPORTS, ExportEntry};
use weald_io::{self as io, Format};
use weald_picture::{PICTURES, PictureEntry};

/// The words that a recipe can use.
#[derive(Clone, Copy, Debug)]
pub(in crate::recipe) struct Vocabulary {
    pub(in crate::recipe) steps: &'static [Entry],
    pub(in crate::recipe) pictures: &'static [PictureEntry],
    pub(in crate::recipe) exports: &'static [ExportEntry],
    pub(in crate::recipe) format_of: fn(&Path) -> Result<&'static Format, String>,
}

impl Vocabulary {
    pub(super) const FULL: Self =
        Self { steps: CATALOG, pictures: PICTURES, exports: EXPORTS, format_of: io::format_of };
}

/// All tables of a `[[section]]`.
pub(super) fn tables<'a>(recipe: &'a Table, section: &str, diagnostics: &mut Diagnostics) -> Vec<&'a Table> {
    let Some(node) = recipe.get(section) else { return Vec::new() };
    let mut as_table = |item: &'a Node| match &item.value {
        Value::Table(table) => Some(table),
        other => {
            let message = format!("`{section}` holds {}; it is written [[{section}]]", other.shown());
            diagnostics.add(item.line, message);
            None
        }
    };
    match &node.value {
        Value::List(items) => items.iter().filter_map(as_table).collect(),
        Value::Table(_) => {
            diagnostics.add(node.line, format!("[{section}] has double brackets: [[{section}]]"));
            Vec::new()
        }
        _ => as_table(node).into_iter().collect(),
    }
}

/// "; did you mean …" where a name is near, else what there is.
pub(super) fn hint(word: &str, known: &[&str]) -> String {
    match parameter::nearest(word, known) {
        Some(near) => format!("did you mean `{near}`?"),
        None if known.is_empty() => "there is none yet".to_owned(),
        None => format!("there are: {}", known.join(", ")),
    }
}
