//! Which file uses names of which other.

use std::collections::BTreeSet;

use syn::visit::{self, Visit};
use syn::{ImplItemFn, Item, ItemMod, ItemUse, Macro, Visibility};

use super::names::{Meaning, Names, imports};
use super::tokens;
use super::workspace::{Module, Workspace, folder_of_children, for_tests};

/// A file uses a name that another file defines.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Arrow {
    pub(crate) from: String,
    pub(crate) to: String,
    pub(crate) name: String,
}

/// All arrows between files that have code. A facade has none: who uses what it re-exports uses the file that
/// defines it.
pub(crate) fn arrows(workspace: &Workspace) -> BTreeSet<Arrow> {
    let names = Names::of(workspace);
    let mut found = BTreeSet::new();
    for source in workspace.sources.iter().filter(|source| !source.facade) {
        let mut reader =
            Reader { names: &names, file: &source.file, module: source.module.clone(), found: &mut found };
        reader.visit_file(&source.syntax);
    }
    let facades: BTreeSet<_> =
        workspace.sources.iter().filter(|source| source.facade).map(|source| source.file.as_str()).collect();
    found.retain(|arrow| !facades.contains(arrow.to.as_str()));
    found
}

/// Reads a file.
struct Reader<'a> {
    names: &'a Names,
    file: &'a str,
    /// The module of what is being read: it may be one within the file.
    module: Module,
    found: &'a mut BTreeSet<Arrow>,
}

impl Reader<'_> {
    fn uses(&mut self, path: &[String]) {
        for meaning in self.names.meanings(&self.module, path) {
            let (to, name) = match meaning {
                Meaning::Item { file, name } => (file, name),
                // A bare word may as well be a variable of the same name.
                Meaning::Module(_) if path.len() == 1 => continue,
                Meaning::Module(module) => {
                    (self.names.file(&module).to_owned(), module.last().cloned().unwrap_or_default())
                }
            };
            if to != self.file {
                self.found.insert(Arrow { from: self.file.to_owned(), to, name });
            }
        }
    }

    /// Whether all that a path means lies below the module that is read.
    fn is_own_child(&self, path: &[String]) -> bool {
        let below = format!("{}/", folder_of_children(self.file));
        self.names.meanings(&self.module, path).iter().all(|meaning| match meaning {
            Meaning::Item { file, .. } => file.starts_with(&below),
            Meaning::Module(module) => module.starts_with(&self.module),
        })
    }
}

impl<'ast> Visit<'ast> for Reader<'_> {
    fn visit_item(&mut self, item: &'ast Item) {
        if !for_tests(attributes(item)) {
            visit::visit_item(self, item);
        }
    }

    fn visit_impl_item_fn(&mut self, method: &'ast ImplItemFn) {
        if !for_tests(&method.attrs) {
            visit::visit_impl_item_fn(self, method);
        }
    }

    fn visit_item_mod(&mut self, module: &'ast ItemMod) {
        if for_tests(&module.attrs) || module.content.is_none() {
            return;
        }
        self.module.push(module.ident.to_string());
        visit::visit_item_mod(self, module);
        self.module.pop();
    }

    /// A module that re-exports its children does not use them by that.
    fn visit_item_use(&mut self, item: &'ast ItemUse) {
        let reexport = !matches!(item.vis, Visibility::Inherited);
        for import in imports(&item.tree) {
            if !(reexport && self.is_own_child(&import.path)) {
                self.uses(&import.path);
            }
        }
    }

    fn visit_path(&mut self, path: &'ast syn::Path) {
        let words: Vec<_> = path.segments.iter().map(|segment| segment.ident.to_string()).collect();
        self.uses(&words);
        visit::visit_path(self, path);
    }

    fn visit_macro(&mut self, called: &'ast Macro) {
        if let Some(name) = called.path.get_ident().map(ToString::to_string)
            && self.names.meanings(&self.module, std::slice::from_ref(&name)).is_empty()
            && let Some(Meaning::Item { file, name }) = self.names.macro_above(&self.module, &name)
            && file != self.file
        {
            self.found.insert(Arrow { from: self.file.to_owned(), to: file, name });
        }
        for path in tokens::paths(called.tokens.clone()) {
            self.uses(&path);
        }
        visit::visit_macro(self, called);
    }

    /// Documentation and visibility name modules that nothing is taken from.
    fn visit_attribute(&mut self, _: &'ast syn::Attribute) {}

    fn visit_visibility(&mut self, _: &'ast Visibility) {}
}

fn attributes(item: &Item) -> &[syn::Attribute] {
    match item {
        Item::Const(item) => &item.attrs,
        Item::Enum(item) => &item.attrs,
        Item::Fn(item) => &item.attrs,
        Item::Impl(item) => &item.attrs,
        Item::Macro(item) => &item.attrs,
        Item::Static(item) => &item.attrs,
        Item::Struct(item) => &item.attrs,
        Item::Trait(item) => &item.attrs,
        Item::Type(item) => &item.attrs,
        Item::Use(item) => &item.attrs,
        _ => &[],
    }
}
