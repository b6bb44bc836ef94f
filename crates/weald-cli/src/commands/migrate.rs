//! `weald migrate`: a recipe of an earlier version in the words of today.

use std::path::{Path, PathBuf};

use weald::error::Error;
use weald::io::write_whole;
use weald::recipe::{Recipe, migrate as rewrite};

use crate::failure::Failure;
use crate::stdout;

/// Rewrites the recipe in place, or into another file.
pub(crate) fn migrate(recipe: &Path, out: Option<&PathBuf>) -> Result<(), Failure> {
    let shown = recipe.display();
    let text = Recipe::text_of(recipe).map_err(Error::from)?;
    let migrated = rewrite(&shown.to_string(), &text).map_err(Error::from)?;
    let target = out.map_or(recipe, PathBuf::as_path);
    if out.is_some() || migrated.text != text {
        write_whole(target, migrated.text.as_bytes())?;
    }
    let changes =
        migrated.changes.iter().map(|change| format!("{shown}:{}: {}\n", change.line, change.message));
    let end = match migrated.changes.len() {
        0 => format!("{shown}: nothing to rename\n"),
        count => format!("{}: rewritten, changes: {count}\n", target.display()),
    };
    stdout::print(&(changes.collect::<String>() + &end))
}
