//! Files that a recipe names: their paths start at its folder, their formats are known before it runs.

use std::cell::RefCell;
use std::path::{Path, PathBuf};

use super::words::Vocabulary;
use weald_core::parameter::{Diagnostics, Kind, Parameter, Variant};
use weald_core::source::{Node, Table, Value};
use weald_land::edit::Layout;

/// What is needed to understand the name of a file.
#[derive(Clone, Copy)]
pub(super) struct Files<'a> {
    pub(super) vocabulary: &'a Vocabulary,
    /// Folder of the recipe.
    pub(super) folder: &'a Path,
    /// The files that were named, with the line of the key.
    pub(super) named: &'a RefCell<Vec<(PathBuf, usize)>>,
}

impl Files<'_> {
    /// The table with each file where it is. No file is opened.
    pub(super) fn placed(&self, table: &Table, keys: &[Parameter], diagnostics: &mut Diagnostics) -> Table {
        let mut placed = table.clone();
        let is_file = |key: &&Parameter| matches!(key.kind, Kind::Raster | Kind::Script | Kind::Flame);
        for key in keys.iter().flat_map(with_variants).filter(is_file) {
            let Some(Node { value: Value::Text(name), line }) = placed.get_mut(key.name) else { continue };
            let path = self.folder.join(&*name);
            if let Some(problem) = self.problem(&path, &key.kind) {
                diagnostics.add(*line, format!("`{}`: {problem}", key.name));
            }
            *name = path.to_string_lossy().into_owned();
            self.named.borrow_mut().push((path, *line));
        }
        placed
    }

    fn problem(&self, path: &Path, kind: &Kind) -> Option<String> {
        if matches!(kind, Kind::Flame) {
            let is_flame = path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("flame"));
            return (!is_flame).then(|| format!("{} is no .flame file", path.display()));
        }
        if matches!(kind, Kind::Script) {
            return Layout::of(path).err();
        }
        match (self.vocabulary.format_of)(path) {
            Ok(format) if format.decode.is_none() => Some(format!("{} is written, not read", format.name)),
            Ok(_) => None,
            Err(problem) => Some(problem),
        }
    }
}

/// A key, and those that the words it may have bring into the same table.
fn with_variants(key: &Parameter) -> impl Iterator<Item = &Parameter> {
    let variants: &[Variant] = if let Kind::Variants(variants) = &key.kind { variants } else { &[] };
    std::iter::once(key).chain(variants.iter().flat_map(|variant| &variant.parameters))
}
