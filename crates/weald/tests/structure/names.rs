//! What names mean in each module, and the file that defines them.

use std::collections::{BTreeMap, BTreeSet};

use syn::{Item, ItemMacro, UseTree};

use super::tokens;
use super::workspace::{Module, Workspace, for_tests};

/// Longest chain of re-exports that is followed: imports may name each other in a circle.
const LONGEST_CHAIN: usize = 24;

/// What a path may mean.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Meaning {
    Module(Module),
    /// Something that a file defines.
    Item {
        file: String,
        name: String,
    },
}

/// One name of a `use`.
#[derive(Clone, Debug)]
pub(crate) struct Import {
    /// `None` for a glob.
    pub(crate) name: Option<String>,
    pub(crate) path: Vec<String>,
}

/// The names of a module.
#[derive(Default)]
struct Scope {
    file: String,
    children: BTreeSet<String>,
    /// Each with the file that defines it: exported macros are names of the root.
    items: BTreeMap<String, String>,
    imports: Vec<Import>,
}

/// The names of all modules.
pub(crate) struct Names {
    scopes: BTreeMap<Module, Scope>,
    /// The file of each macro, by crate and name.
    macros: BTreeMap<(String, String), String>,
}

impl Names {
    pub(crate) fn of(workspace: &Workspace) -> Self {
        let mut names = Self { scopes: BTreeMap::new(), macros: BTreeMap::new() };
        for source in &workspace.sources {
            names.add(&source.module, &source.file, &source.syntax.items);
        }
        names
    }

    fn add(&mut self, module: &[String], file: &str, items: &[Item]) {
        file.clone_into(&mut self.scopes.entry(module.to_vec()).or_default().file);
        for item in items {
            self.add_item(module, file, item);
        }
    }

    fn add_item(&mut self, module: &[String], file: &str, item: &Item) {
        let name = match item {
            Item::Const(item) => &item.ident,
            Item::Enum(item) => &item.ident,
            Item::Fn(item) => &item.sig.ident,
            Item::Static(item) => &item.ident,
            Item::Struct(item) => &item.ident,
            Item::Trait(item) => &item.ident,
            Item::Type(item) => &item.ident,
            Item::Union(item) => &item.ident,
            Item::Macro(item) => return self.add_macro(module, file, item),
            Item::Mod(item) if for_tests(&item.attrs) => return,
            Item::Mod(item) => {
                let name = item.ident.to_string();
                if let Some((_, items)) = &item.content {
                    self.add(&[module.to_vec(), vec![name.clone()]].concat(), file, items);
                }
                self.scope(module).children.insert(name);
                return;
            }
            Item::Use(item) if !for_tests(&item.attrs) => {
                return self.scope(module).imports.extend(imports(&item.tree));
            }
            _ => return,
        };
        self.define(module, file, name.to_string());
    }

    /// A macro is a name of its module, or of the crate where it is exported. One that is called as an item
    /// defines what it is given: `parameters! { pub struct Terrace { … } }`.
    fn add_macro(&mut self, module: &[String], file: &str, item: &ItemMacro) {
        let Some(name) = &item.ident else {
            for name in tokens::defined(item.mac.tokens.clone()) {
                self.define(module, file, name);
            }
            return;
        };
        self.macros.insert((module[0].clone(), name.to_string()), file.to_owned());
        self.define(module, file, name.to_string());
        if item.attrs.iter().any(|attribute| attribute.path().is_ident("macro_export")) {
            self.define(&module[..1], file, name.to_string());
        }
    }

    fn define(&mut self, module: &[String], file: &str, name: String) {
        self.scope(module).items.insert(name, file.to_owned());
    }

    fn scope(&mut self, module: &[String]) -> &mut Scope {
        self.scopes.entry(module.to_vec()).or_default()
    }

    /// The file of a module.
    pub(crate) fn file(&self, module: &[String]) -> &str {
        self.scopes.get(module).map_or("", |scope| &scope.file)
    }

    /// All that a path may mean in a module; empty for what no crate here defines.
    pub(crate) fn meanings(&self, module: &[String], path: &[String]) -> Vec<Meaning> {
        self.resolve(module, path, 0)
    }

    /// A macro that is in scope because it was defined above a `mod`, not because it was imported.
    pub(crate) fn macro_above(&self, module: &[String], name: &str) -> Option<Meaning> {
        let file = self.macros.get(&(module[0].clone(), name.to_owned()))?;
        Some(Meaning::Item { file: file.clone(), name: name.to_owned() })
    }

    fn resolve(&self, module: &[String], path: &[String], depth: usize) -> Vec<Meaning> {
        if depth > LONGEST_CHAIN {
            return Vec::new();
        }
        let (mut meanings, rest) = self.start(module, path, depth);
        for name in rest {
            let modules: Vec<_> = meanings.iter().filter_map(as_module).cloned().collect();
            if modules.is_empty() {
                break;
            }
            meanings = modules.iter().flat_map(|module| self.lookup(module, name, depth + 1)).collect();
            if meanings.is_empty() {
                // Made by a macro, out of sight: the module's file has it.
                let unseen = |module: &Module| Meaning::Item {
                    file: self.file(module).to_owned(),
                    name: name.clone(),
                };
                return modules.iter().map(unseen).collect();
            }
        }
        meanings
    }

    fn start<'a>(&self, module: &[String], path: &'a [String], depth: usize) -> (Vec<Meaning>, &'a [String]) {
        let Some((first, rest)) = path.split_first() else { return (Vec::new(), path) };
        match first.as_str() {
            "crate" | "$crate" => (vec![Meaning::Module(module[..1].to_vec())], rest),
            "self" => (vec![Meaning::Module(module.to_vec())], rest),
            "super" => {
                let ups = path.iter().take_while(|name| *name == "super").count();
                let above = &module[..module.len().saturating_sub(ups).max(1)];
                (vec![Meaning::Module(above.to_vec())], &path[ups..])
            }
            _ => {
                let own = self.lookup(module, first, depth + 1);
                let root = vec![first.clone()];
                let found = if own.is_empty() && self.scopes.contains_key(&root) {
                    vec![Meaning::Module(root)]
                } else {
                    own
                };
                (found, rest)
            }
        }
    }

    fn lookup(&self, module: &[String], name: &str, depth: usize) -> Vec<Meaning> {
        let Some(scope) = self.scopes.get(module) else { return Vec::new() };
        let child = scope.children.contains(name);
        let mut found: Vec<_> = child
            .then(|| Meaning::Module([module.to_vec(), vec![name.to_owned()]].concat()))
            .into_iter()
            .collect();
        if let Some(file) = scope.items.get(name) {
            found.push(Meaning::Item { file: file.clone(), name: name.to_owned() });
        }
        // `use grid;` names a crate, not itself.
        let named = |import: &&Import| import.name.as_deref() == Some(name) && import.path != [name];
        for import in scope.imports.iter().filter(named) {
            found.extend(self.resolve(module, &import.path, depth + 1));
        }
        if found.is_empty() {
            found = self.lookup_in_globs(module, scope, name, depth);
        }
        found.sort();
        found.dedup();
        found
    }

    fn lookup_in_globs(&self, module: &[String], scope: &Scope, name: &str, depth: usize) -> Vec<Meaning> {
        if depth > LONGEST_CHAIN {
            return Vec::new();
        }
        let globs = scope.imports.iter().filter(|import| import.name.is_none());
        let opened = globs.flat_map(|glob| self.resolve(module, &glob.path, depth + 1));
        let modules: Vec<_> = opened.filter_map(|meaning| as_module(&meaning).cloned()).collect();
        modules
            .iter()
            .filter(|opened| *opened != module)
            .flat_map(|opened| self.lookup(opened, name, depth + 1))
            .collect()
    }
}

fn as_module(meaning: &Meaning) -> Option<&Module> {
    match meaning {
        Meaning::Module(module) => Some(module),
        Meaning::Item { .. } => None,
    }
}

/// All names that a `use` brings.
pub(crate) fn imports(tree: &UseTree) -> Vec<Import> {
    let mut found = Vec::new();
    gather(tree, &mut Vec::new(), &mut found);
    found
}

fn gather(tree: &UseTree, path: &mut Vec<String>, found: &mut Vec<Import>) {
    match tree {
        UseTree::Path(step) => {
            path.push(step.ident.to_string());
            gather(&step.tree, path, found);
            path.pop();
        }
        UseTree::Group(group) => group.items.iter().for_each(|tree| gather(tree, path, found)),
        UseTree::Glob(_) => found.push(Import { name: None, path: path.clone() }),
        UseTree::Name(name) if name.ident == "self" => {
            found.push(Import { name: path.last().cloned(), path: path.clone() });
        }
        UseTree::Name(name) => {
            let name = name.ident.to_string();
            found.push(Import { path: [path.clone(), vec![name.clone()]].concat(), name: Some(name) });
        }
        UseTree::Rename(rename) => {
            let mut path = path.clone();
            if rename.ident != "self" {
                path.push(rename.ident.to_string());
            }
            found.push(Import { name: Some(rename.rename.to_string()), path });
        }
    }
}
