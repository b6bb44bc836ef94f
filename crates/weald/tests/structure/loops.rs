//! The graph among the entries of each folder, and its loops.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;

use super::arrows::Arrow;
use super::workspace::folder_of_children;

/// From one entry of a folder to another, with the arrows of files that it stands for.
pub(crate) type Edges<'a> = BTreeMap<(String, String), Vec<&'a Arrow>>;

/// The graph of each folder, by the folder's path. An arrow between two files counts where their paths part.
pub(crate) fn folders<'a>(
    arrows: &'a BTreeSet<Arrow>,
    files: &BTreeSet<&str>,
) -> BTreeMap<String, Edges<'a>> {
    let mut graphs: BTreeMap<String, Edges<'a>> = BTreeMap::new();
    for arrow in arrows {
        let [from, to] = [&arrow.from, &arrow.to].map(|file| place(file, files));
        let shared = from.iter().zip(&to).take_while(|(one, other)| one == other).count();
        // Crates are the matter of their manifests.
        if shared >= 3 {
            let edge = (from[shared].clone(), to[shared].clone());
            graphs.entry(from[..shared].join("/")).or_default().entry(edge).or_default().push(arrow);
        }
    }
    graphs
}

/// A file's path in parts; `a/b.rs` beside a folder `a/b` is that folder's, as `a/b/mod.rs` is.
pub(crate) fn place(file: &str, files: &BTreeSet<&str>) -> Vec<String> {
    let below = format!("{}/", folder_of_children(file));
    let has_folder = files.range(below.as_str()..).next().is_some_and(|next| next.starts_with(&below));
    let place =
        if has_folder && !file.starts_with(&below) { format!("{below}mod.rs") } else { file.to_owned() };
    place.split('/').map(str::to_owned).collect()
}

/// Groups of nodes each of which leads to all others of its group.
pub(crate) fn circles<'a>(edges: impl Iterator<Item = (&'a str, &'a str)>) -> Vec<BTreeSet<&'a str>> {
    let mut next: BTreeMap<&str, BTreeSet<&str>> = BTreeMap::new();
    for (from, to) in edges {
        next.entry(from).or_default().insert(to);
    }
    let reached: BTreeMap<_, _> = next.keys().map(|&node| (node, reachable(&next, node))).collect();
    let leads = |from: &str, to: &str| reached.get(from).is_some_and(|nodes| nodes.contains(to));
    let mut circles = BTreeSet::new();
    for (&node, nodes) in &reached {
        let circle: BTreeSet<_> = nodes.iter().copied().filter(|&other| leads(other, node)).collect();
        if !circle.is_empty() {
            circles.insert(circle);
        }
    }
    circles.into_iter().collect()
}

fn reachable<'a>(next: &BTreeMap<&'a str, BTreeSet<&'a str>>, from: &str) -> BTreeSet<&'a str> {
    let mut reached = BTreeSet::new();
    let mut open: Vec<_> = next.get(from).into_iter().flatten().copied().collect();
    while let Some(node) = open.pop() {
        if reached.insert(node) {
            open.extend(next.get(node).into_iter().flatten());
        }
    }
    reached
}

/// All loops of all folders, each with its arrows, to be read by who has to break them.
pub(crate) fn report(graphs: &BTreeMap<String, Edges<'_>>) -> Vec<String> {
    let mut loops = Vec::new();
    for (folder, edges) in graphs {
        let pairs = edges.keys().map(|(from, to)| (from.as_str(), to.as_str()));
        for circle in circles(pairs) {
            loops.push(told(folder, &circle, edges));
        }
    }
    loops
}

fn told(folder: &str, circle: &BTreeSet<&str>, edges: &Edges<'_>) -> String {
    let names: Vec<_> = circle.iter().copied().collect();
    let mut text = format!("{folder}: {} hang together in a loop: {}\n", names.len(), names.join(", "));
    let inner =
        edges.iter().filter(|((from, to), _)| circle.contains(from.as_str()) && circle.contains(to.as_str()));
    for ((from, to), arrows) in inner {
        writeln!(text, "  {from} -> {to}").expect("a string takes all");
        for (files, names) in by_files(folder, arrows) {
            writeln!(text, "    {files}: {}", names.join(", ")).expect("a string takes all");
        }
    }
    text
}

fn by_files(folder: &str, arrows: &[&Arrow]) -> BTreeMap<String, Vec<String>> {
    let mut lines: BTreeMap<String, Vec<String>> = BTreeMap::new();
    let inside =
        |file: &str| file.strip_prefix(folder).map_or(file, |rest| rest.trim_start_matches('/')).to_owned();
    for arrow in arrows {
        let files = format!("{} -> {}", inside(&arrow.from), inside(&arrow.to));
        lines.entry(files).or_default().push(arrow.name.clone());
    }
    lines
}
