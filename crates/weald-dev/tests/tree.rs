//! The tree stays small enough to clone in a moment, and its documents link to what is there.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Files beside Rust and shaders, of which each method has its own.
const MAX_OTHER_FILES: usize = 300;
const MAX_BYTES: u64 = 20_000_000;

/// Folders that git ignores, for where there is no git to ask.
const IGNORED: [&str; 6] = [".git", "target", "out", "corpus", "artifacts", "coverage"];

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").canonicalize().expect("the tree")
}

/// Committed files, or all that lie in the tree where it is no checkout; relative to its root.
fn files() -> Vec<PathBuf> {
    let listed = Command::new("git").args(["ls-files", "-z"]).current_dir(root()).output();
    let names = listed.ok().filter(|listed| listed.status.success()).map(|listed| listed.stdout);
    let tracked = names.map(|names| {
        let text = String::from_utf8(names).expect("names in UTF-8");
        text.split_terminator('\0').map(PathBuf::from).filter(|file| root().join(file).exists()).collect()
    });
    tracked.filter(|files: &Vec<PathBuf>| !files.is_empty()).unwrap_or_else(|| walk(&root(), &root()))
}

fn walk(folder: &Path, root: &Path) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("an entry"));
    let wanted = entries.filter(|entry| !IGNORED.iter().any(|name| entry.file_name() == *name));
    let found = wanted.flat_map(|entry| {
        if entry.file_type().expect("a type").is_dir() {
            walk(&entry.path(), root)
        } else {
            vec![entry.path().strip_prefix(root).expect("below the root").to_owned()]
        }
    });
    found.collect()
}

fn size(file: &Path) -> u64 {
    root().join(file).symlink_metadata().expect("a file").len()
}

/// What the links of a document lead to within the tree, relative to its root, without what stands behind `#`.
fn links(document: &Path) -> Vec<PathBuf> {
    let text = std::fs::read_to_string(root().join(document)).expect("a document");
    let folder = document.parent().expect("a folder");
    let targets = text.split("](").skip(1).filter_map(|rest| Some(rest.split_once(')')?.0));
    let local = targets.filter(|link| !link.contains("://") && !link.starts_with('#'));
    local.map(|link| folder.join(link.split('#').next().unwrap_or_default())).collect()
}

fn documents() -> impl Iterator<Item = PathBuf> {
    files().into_iter().filter(|file| file.extension().is_some_and(|end| end == "md"))
}

#[test]
fn the_tree_stays_small() {
    let files = files();
    let bytes: u64 = files.iter().map(|file| size(file)).sum();
    let mut largest = files.clone();
    largest.sort_by_key(|file| std::cmp::Reverse(size(file)));
    largest.truncate(5);
    let is_code = |file: &&PathBuf| file.extension().is_some_and(|end| end == "rs" || end == "wgsl");
    let others = files.len() - files.iter().filter(is_code).count();
    println!("{} files, {others} beside code, {bytes} bytes", files.len());
    assert!(files.len() > 100, "the tree was not found: {} files", files.len());
    assert!(
        others <= MAX_OTHER_FILES && bytes <= MAX_BYTES,
        "{others} files beside code and {bytes} bytes are committed; at most {MAX_OTHER_FILES} and {MAX_BYTES} may be. The \
         largest: {largest:?}. Pack files that belong together, commit pictures by `weald-dev`",
    );
}

#[test]
fn no_file_of_the_tree_is_missed_without_git() {
    let walked: BTreeSet<PathBuf> = walk(&root(), &root()).into_iter().collect();
    let missed: Vec<_> = files().into_iter().filter(|file| !walked.contains(file)).collect();
    assert!(missed.is_empty(), "{missed:?}");
}

#[test]
fn every_link_of_a_document_leads_to_a_file() {
    let broken: Vec<_> = documents()
        .flat_map(|document| links(&document).into_iter().map(move |link| (document.clone(), link)))
        .filter(|(_, link)| !root().join(link).exists())
        .collect();
    assert!(broken.is_empty(), "{broken:?}");
}

#[test]
fn every_committed_picture_of_the_documents_is_shown_in_one_and_is_webp() {
    let shown: BTreeSet<PathBuf> = documents().flat_map(|document| links(&document)).collect();
    assert!(shown.len() > 50, "{} links", shown.len());
    let pictures = files().into_iter().filter(|file| file.starts_with("docs")).filter(|file| {
        file.extension().is_some_and(|end| ["png", "jpg", "webp"].iter().any(|picture| end == *picture))
    });
    let wrong: Vec<_> = pictures
        .filter(|picture| !shown.contains(picture) || picture.extension().is_none_or(|end| end != "webp"))
        .collect();
    assert!(wrong.is_empty(), "shown nowhere, or no WebP: {wrong:?}");
}
