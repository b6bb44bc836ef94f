//! The sources of all crates, as parsed files that know which module they are.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use syn::{Item, Visibility};

/// A module by its path, the crate's name first: `["weald_core", "grid"]`.
pub(crate) type Module = Vec<String>;

/// A file of Rust that is compiled without tests.
pub(crate) struct Source {
    /// From the folder of the workspace: `crates/weald-core/src/grid.rs`.
    pub(crate) file: String,
    pub(crate) module: Module,
    pub(crate) syntax: syn::File,
    /// Declares modules and re-exports names, and has no code of its own.
    pub(crate) facade: bool,
}

/// All crates under `crates/`.
#[derive(Default)]
pub(crate) struct Workspace {
    pub(crate) sources: Vec<Source>,
    /// Of each crate, by the name of its folder, what its `Cargo.toml` says.
    pub(crate) manifests: BTreeMap<String, toml::Table>,
}

impl Workspace {
    /// The texts of all files of crates below the folder `crates` of a workspace.
    pub(crate) fn texts(root: &Path) -> BTreeMap<String, String> {
        let mut files = BTreeMap::new();
        collect(&root.join("crates"), "crates", &mut files);
        files
    }

    /// Crates from texts of files by their paths.
    pub(crate) fn of(files: &BTreeMap<String, String>) -> Self {
        let mut workspace = Self::default();
        for (path, text) in files {
            if let Some(name) = path.strip_prefix("crates/").and_then(|rest| rest.strip_suffix("/Cargo.toml"))
            {
                let manifest: toml::Table = text.parse().unwrap_or_else(|error| panic!("{path}: {error}"));
                workspace.manifests.insert(name.to_owned(), manifest);
            }
        }
        let names: Vec<_> = workspace.manifests.keys().cloned().collect();
        for name in names {
            workspace.add_crate(&name, files);
        }
        workspace
    }

    /// A crate may be a library, a program, or both: then the program is a root of its own.
    fn add_crate(&mut self, name: &str, files: &BTreeMap<String, String>) {
        let [library, program] = ["lib", "main"].map(|root| format!("crates/{name}/src/{root}.rs"));
        let underscored = name.replace('-', "_");
        let has_library = files.contains_key(&library);
        if has_library {
            self.add(&library, vec![underscored.clone()], files);
        }
        if files.contains_key(&program) {
            let root = if has_library { format!("{underscored} (program)") } else { underscored };
            self.add(&program, vec![root], files);
        }
    }

    fn add(&mut self, file: &str, module: Module, files: &BTreeMap<String, String>) {
        let text = files.get(file).unwrap_or_else(|| panic!("there is no {file}"));
        let syntax = syn::parse_file(text).unwrap_or_else(|error| panic!("{file}: {error}"));
        let base = folder_of_children(file);
        for child in declared(&syntax) {
            let places = [format!("{base}/{child}.rs"), format!("{base}/{child}/mod.rs")];
            let place = places.iter().find(|place| files.contains_key(*place));
            let place = place.unwrap_or_else(|| panic!("{file} declares `{child}`, which has no file"));
            self.add(place, [module.clone(), vec![child]].concat(), files);
        }
        let is_module_file = base != file.trim_end_matches(".rs") || has_other_files(base, file, files);
        let facade = is_module_file && syntax.items.iter().all(declares_or_reexports);
        self.sources.push(Source { file: file.to_owned(), module, syntax, facade });
    }

    /// All files, in order.
    pub(crate) fn files(&self) -> BTreeSet<&str> {
        self.sources.iter().map(|source| source.file.as_str()).collect()
    }
}

fn collect(folder: &Path, name: &str, files: &mut BTreeMap<String, String>) {
    let entries = std::fs::read_dir(folder).unwrap_or_else(|error| panic!("{}: {error}", folder.display()));
    for entry in entries {
        let path = entry.expect("a folder of the workspace can be listed").path();
        let own = path.file_name().unwrap_or_default().to_string_lossy();
        let inner = format!("{name}/{own}");
        if path.is_dir() {
            if own != "target" {
                collect(&path, &inner, files);
            }
        } else if own == "Cargo.toml"
            || (path.extension().is_some_and(|extension| extension == "rs") && inner.contains("/src/"))
        {
            let text = std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{inner}: {error}"));
            files.insert(inner, text);
        }
    }
}

/// `a/lib.rs` and `a/mod.rs` have their children in `a`, `a/b.rs` in `a/b`.
pub(crate) fn folder_of_children(file: &str) -> &str {
    let stem = file.strip_suffix(".rs").unwrap_or(file);
    match stem.rsplit_once('/') {
        Some((folder, "lib" | "main" | "mod")) => folder,
        _ => stem,
    }
}

fn has_other_files(folder: &str, file: &str, files: &BTreeMap<String, String>) -> bool {
    let below = format!("{folder}/");
    files.keys().any(|other| other != file && other.starts_with(&below))
}

fn declared(syntax: &syn::File) -> Vec<String> {
    let modules = syntax.items.iter().filter_map(|item| match item {
        Item::Mod(module) if module.content.is_none() && !for_tests(&module.attrs) => Some(module),
        _ => None,
    });
    modules.map(|module| module.ident.to_string()).collect()
}

fn declares_or_reexports(item: &Item) -> bool {
    match item {
        Item::Mod(module) => module.content.is_none() || for_tests(&module.attrs),
        Item::Use(import) => for_tests(&import.attrs) || !matches!(import.vis, Visibility::Inherited),
        _ => false,
    }
}

/// Whether attributes leave something out of the library: `#[cfg(test)]`, `#[cfg(all(test, …))]`, `#[test]`.
pub(crate) fn for_tests(attributes: &[syn::Attribute]) -> bool {
    attributes.iter().any(|attribute| {
        let condition = match &attribute.meta {
            syn::Meta::List(list) if list.path.is_ident("cfg") => list.tokens.to_string(),
            _ => return attribute.path().is_ident("test"),
        };
        let mut words = condition.split(|letter: char| !letter.is_alphanumeric() && letter != '_');
        words.any(|word| word == "test") && !condition.contains("not")
    })
}
