//! The table of layers: which crate may use which, and what must never be imported.

use std::collections::{BTreeMap, BTreeSet};

use super::arrows::Arrow;
use super::workspace::Workspace;

/// All crates from top to bottom, each with those that it may use. A recipe goes through them from top to bottom.
pub(crate) const LAYERS: &[(&str, &[&str])] = &[
    ("weald-dev", &["weald-gallery", "weald"]),
    ("weald-py", &["weald-gpu", "weald"]),
    ("weald-mpi", &["weald"]),
    ("weald-web", &["weald-studio", "weald-gpu", "weald"]),
    ("weald-cli", &["weald-studio", "weald-gallery", "weald-gpu", "weald"]),
    ("weald-studio", &["weald-gpu", "weald"]),
    (
        "weald-gallery",
        &[
            "weald",
            "weald-export",
            "weald-picture",
            "weald-plants",
            "weald-land",
            "weald-io",
            "weald-engine",
            "weald-core",
        ],
    ),
    ("weald-gpu", &["weald"]),
    (
        "weald",
        &[
            "weald-export",
            "weald-picture",
            "weald-plants",
            "weald-land",
            "weald-io",
            "weald-engine",
            "weald-core",
        ],
    ),
    (
        "weald-export",
        &["weald-picture", "weald-plants", "weald-land", "weald-io", "weald-engine", "weald-core"],
    ),
    ("weald-picture", &["weald-plants", "weald-io", "weald-engine", "weald-core"]),
    ("weald-plants", &["weald-io", "weald-engine", "weald-core"]),
    ("weald-land", &["weald-io", "weald-engine", "weald-core"]),
    ("weald-io", &["weald-core"]),
    ("weald-engine", &["weald-core"]),
    ("weald-core", &[]),
];

/// Stages, none of which ever imports another: what two of them need lies below both.
const STAGES: &[&str] = &[
    "crates/weald-land/src/generate",
    "crates/weald-land/src/combine",
    "crates/weald-land/src/erode",
    "crates/weald-land/src/analyse",
    "crates/weald-plants/src",
];

/// What lies below all stages, so that each may use it.
const FOUNDATIONS: &[&str] = &["crates/weald-land/src/flow", "crates/weald-land/src/edit"];

/// Dependencies that stay within some crates.
const CONFINED: &[(&str, &[&str])] = &[("mpi", &["weald-mpi"]), ("wgpu", &["weald-gpu"])];

/// What the crates' dependencies have against a table: arrows that it does not have, arrows that it has in vain, and
/// arrows that lead upward.
pub(crate) fn diagnostics(workspace: &Workspace, layers: &[(&str, &[&str])]) -> Vec<String> {
    let allowed: BTreeSet<_> = layers
        .iter()
        .flat_map(|(from, uses)| uses.iter().map(|to| ((*from).to_owned(), (*to).to_owned())))
        .collect();
    let found = arrows_of_crates(workspace);
    let undeclared = found
        .difference(&allowed)
        .map(|(from, to)| format!("{from} -> {to} is not in the table of layers (crates/{from}/Cargo.toml)"));
    let unused = allowed
        .difference(&found)
        .map(|(from, to)| format!("{from} -> {to} is in the table of layers and in no Cargo.toml"));
    let place = |name: &str| layers.iter().position(|(layer, _)| *layer == name);
    let upward = allowed
        .iter()
        .filter(|(from, to)| place(to) <= place(from))
        .map(|(from, to)| format!("{from} -> {to} leads upward in the table of layers"));
    let unknown = workspace.manifests.keys().filter(|name| place(name).is_none());
    let unknown = unknown.map(|name| format!("{name} is not in the table of layers"));
    undeclared.chain(unused).chain(upward).chain(unknown).collect()
}

fn arrows_of_crates(workspace: &Workspace) -> BTreeSet<(String, String)> {
    let mut found = BTreeSet::new();
    for (name, manifest) in &workspace.manifests {
        let Some(toml::Value::Table(uses)) = manifest.get("dependencies") else { continue };
        let ours = uses.keys().filter(|used| workspace.manifests.contains_key(*used));
        found.extend(ours.map(|used| (name.clone(), used.clone())));
    }
    found
}

/// Crates that depend on what is confined to others, for tests as well.
pub(crate) fn strays(workspace: &Workspace) -> Vec<String> {
    let mut found = Vec::new();
    for (name, manifest) in &workspace.manifests {
        for (confined, _) in CONFINED.iter().filter(|(_, homes)| !homes.contains(&name.as_str())) {
            let tables = ["dependencies", "dev-dependencies", "build-dependencies"];
            if tables
                .iter()
                .any(|table| manifest.get(*table).is_some_and(|table| table.get(confined).is_some()))
            {
                found.push(format!("{name} depends on {confined}"));
            }
        }
    }
    found
}

/// What of the studio may know the graphics interface, which it has by way of its window's library: the landscape in the
/// window, and the controls where software draws them.
const WINDOW: [&str; 2] = ["crates/weald-studio/src/viewport", "crates/weald-studio/src/interface"];

/// Sources of the studio beside those that name the graphics interface.
pub(crate) fn graphics_in_the_studio(files: &BTreeMap<String, String>) -> Vec<String> {
    let names_it = |(file, text): &(&String, &String)| {
        let may = WINDOW.iter().any(|module| lies_in(file, module));
        file.starts_with("crates/weald-studio/src/") && !may && text.contains("wgpu")
    };
    let told = |file: &String| format!("{file} names wgpu; only {} may", WINDOW.join(" and "));
    files.iter().filter(names_it).map(|(file, _)| told(file)).collect()
}

/// Crates that a browser runs too, where the standard library has neither files nor clocks.
const IN_A_BROWSER: [&str; 9] =
    ["weald", "core", "engine", "export", "io", "land", "picture", "plants", "studio"];

/// What the standard library refuses there; `files` and `web_time` have it.
const REFUSED: [&str; 5] =
    ["std::fs", "path::absolute", ".canonicalize()", "env::current_dir", "process::id"];

/// What is not compiled for browsers, or asks for what is there on some systems only.
const OF_MACHINES: [&str; 8] = [
    "core/src/files",
    "io/src/atomic.rs",
    "studio/src/response.rs",
    "studio/src/trace.rs",
    "studio/src/window.rs",
    "weald/src/recipe/cache/follows.rs",
    "weald/src/recipe/memory.rs",
    "weald/src/recipe/run/work.rs",
];

/// Sources that would find neither files nor clocks in a browser, beside their tests.
pub(crate) fn not_in_a_browser(files: &BTreeMap<String, String>) -> Vec<String> {
    let mut found = Vec::new();
    for (file, text) in files {
        let Some(short) =
            file.strip_prefix("crates/").map(|file| file.strip_prefix("weald-").unwrap_or(file))
        else {
            continue;
        };
        let runs_there = IN_A_BROWSER.iter().any(|name| short.starts_with(&format!("{name}/src/")));
        let is_test = short.ends_with("/tests.rs") || short.contains("/tests/");
        if !runs_there || is_test || OF_MACHINES.iter().any(|of| short.starts_with(of)) {
            continue;
        }
        let code = text.split("#[cfg(test)]\nmod tests {").next().unwrap_or_default();
        // A word for what a lock can say is there in all systems.
        let code = code.replace("std::fs::TryLockError", "");
        let names_clock = |line: &str| {
            line.contains("std::time::") && (line.contains("Instant") || line.contains("SystemTime"))
        };
        let clock = code.lines().any(names_clock);
        let refused = REFUSED.iter().find(|word| code.contains(*word)).copied();
        if let Some(word) = refused.or(clock.then_some("a clock of std::time")) {
            found.push(format!(
                "{file} names {word}, which no browser has; weald_core::files and web_time have it"
            ));
        }
    }
    found
}

/// Arrows from a stage to another, and from a foundation of the stages to a stage.
pub(crate) fn forbidden(arrows: &BTreeSet<Arrow>) -> Vec<String> {
    let wrong = |arrow: &&Arrow| {
        let to = STAGES.iter().position(|stage| lies_in(&arrow.to, stage));
        let from = STAGES.iter().position(|stage| lies_in(&arrow.from, stage));
        let from_below = FOUNDATIONS.iter().any(|module| lies_in(&arrow.from, module));
        to.is_some() && (from_below || from.is_some_and(|from| Some(from) != to))
    };
    let told = |arrow: &Arrow| format!("{} -> {}: {}", arrow.from, arrow.to, arrow.name);
    arrows.iter().filter(wrong).map(told).collect()
}

/// Modules that the rules name and that are no longer where they were: a rule about nothing is always kept.
pub(crate) fn vanished(files: &BTreeSet<&str>) -> Vec<String> {
    let there = |module: &&&str| !files.iter().any(|file| lies_in(file, module));
    STAGES.iter().chain(FOUNDATIONS).filter(there).map(|module| (**module).to_owned()).collect()
}

fn lies_in(file: &str, module: &str) -> bool {
    file.strip_prefix(module).is_some_and(|rest| rest == ".rs" || rest.starts_with('/'))
}
