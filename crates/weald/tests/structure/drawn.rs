//! The graph as ARCHITECTURE shows it: crates from top to bottom, and in each its modules in levels.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;

use super::arrows::Arrow;
use super::loops::{self, Edges};
use super::workspace::Workspace;

/// Between these lines of ARCHITECTURE.md stands the graph.
const BEGIN: &str = "<!-- The graph: written by `UPDATE_GRAPH=1 cargo test -p weald --test structure`. -->\n";
const END: &str = "<!-- End of the graph. -->\n";

/// Longest line.
const WIDTH: usize = 110;

/// The graph: under each crate its files and folders, from top to bottom; each line uses only lines below it.
pub(crate) fn graph(workspace: &Workspace, arrows: &BTreeSet<Arrow>, layers: &[(&str, &[&str])]) -> String {
    let files = workspace.files();
    let graphs = loops::folders(arrows, &files);
    let mut text = String::from("```text\n");
    for (name, uses) in layers {
        let uses = if uses.is_empty() { "nothing here".to_owned() } else { uses.join(", ") };
        wrapped(&mut text, &format!("{name} uses {uses}"), "        ");
        let root = format!("crates/{name}/src");
        for level in levels(&entries(workspace, &root, &files), graphs.get(&root)) {
            wrapped(&mut text, &format!("    {}", level.join(" ")), "    ");
        }
    }
    text + "```\n"
}

/// The files and folders of a folder that have code of their own or below them.
fn entries(workspace: &Workspace, root: &str, files: &BTreeSet<&str>) -> BTreeSet<String> {
    let depth = root.split('/').count();
    let sources = workspace.sources.iter().filter(|source| !source.facade);
    let places = sources.map(|source| loops::place(&source.file, files));
    places
        .filter(|place| place.join("/").starts_with(&format!("{root}/")))
        .map(|place| place[depth].clone())
        .collect()
}

/// Entries by how long the longest path down from them is, the longest first.
fn levels(entries: &BTreeSet<String>, edges: Option<&Edges<'_>>) -> Vec<Vec<String>> {
    let mut height: BTreeMap<&str, usize> = entries.iter().map(|entry| (entry.as_str(), 0)).collect();
    // In a graph without loops as many rounds as entries are enough; with one the test of loops fails.
    for _ in entries {
        for (from, to) in edges.into_iter().flat_map(BTreeMap::keys) {
            let above = height.get(to.as_str()).map_or(0, |below| below + 1);
            if let Some(own) = height.get_mut(from.as_str()) {
                *own = above.max(*own).min(entries.len());
            }
        }
    }
    let mut levels: BTreeMap<usize, Vec<String>> = BTreeMap::new();
    for (entry, height) in height {
        levels.entry(height).or_default().push(entry.trim_end_matches(".rs").to_owned());
    }
    levels.into_values().rev().collect()
}

fn wrapped(text: &mut String, line: &str, indent: &str) {
    let first = line.len() - line.trim_start().len();
    let mut now = " ".repeat(first);
    for word in line.split_whitespace() {
        if now.len() + word.len() > WIDTH {
            writeln!(text, "{}", now.trim_end()).expect("a string takes all");
            indent.clone_into(&mut now);
        }
        now += word;
        now.push(' ');
    }
    writeln!(text, "{}", now.trim_end()).expect("a string takes all");
}

/// A document with another graph in it.
pub(crate) fn with_graph(document: &str, graph: &str) -> String {
    let (before, rest) = document.split_once(BEGIN).expect("ARCHITECTURE.md has the line before the graph");
    let (_, after) = rest.split_once(END).expect("ARCHITECTURE.md has the line after the graph");
    format!("{before}{BEGIN}{graph}{END}{after}")
}
