//! The layers of the workspace: which crate uses which, and that no folder of any crate hangs together in a loop.
//!
//! All imports are read from the sources, tests left out, and followed to the file that defines what is imported.

mod arrows;
mod drawn;
mod layers;
mod loops;
mod made_up;
mod names;
mod shaders;
mod steps_have_examples;
mod tokens;
mod words;
mod workspace;

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::LazyLock;

use arrows::Arrow;
use layers::LAYERS;
use workspace::Workspace;

/// Files are parsed once for all tests; syntax trees cannot be shared between threads, what is read of them can.
struct Read {
    arrows: BTreeSet<Arrow>,
    loops: Vec<String>,
    graph: String,
    rules: Vec<String>,
}

static READ: LazyLock<Read> = LazyLock::new(|| {
    let texts = Workspace::texts(&root());
    let workspace = Workspace::of(&texts);
    let arrows = arrows::arrows(&workspace);
    let files = workspace.files();
    let mut rules = layers::diagnostics(&workspace, LAYERS);
    rules.extend(layers::strays(&workspace));
    rules.extend(layers::graphics_in_the_studio(&texts));
    rules.extend(layers::not_in_a_browser(&texts));
    rules.extend(layers::vanished(&files).into_iter().map(|module| format!("there is no {module}")));
    rules.extend(layers::forbidden(&arrows));
    Read {
        loops: loops::report(&loops::folders(&arrows, &files)),
        graph: drawn::graph(&workspace, &arrows, LAYERS),
        rules,
        arrows,
    }
});

fn root() -> PathBuf {
    let own = std::env::var("CARGO_MANIFEST_DIR").expect("cargo says where the crate is");
    Path::new(&own).join("../..")
}

#[test]
fn no_folder_of_any_crate_has_a_loop_of_imports() {
    let Read { loops, arrows, .. } = &*READ;
    assert!(arrows.len() > 1000, "only {} imports were found: they are not read", arrows.len());
    assert!(loops.is_empty(), "{} loops\n\n{}", loops.len(), loops.join("\n"));
}

#[test]
fn crates_and_stages_keep_to_the_table_of_layers() {
    assert!(READ.rules.is_empty(), "\n{}", READ.rules.join("\n"));
}

#[test]
fn architecture_shows_the_graph_as_it_is() {
    let path = root().join("ARCHITECTURE.md");
    let document = std::fs::read_to_string(&path).expect("ARCHITECTURE.md can be read");
    let wanted = drawn::with_graph(&document, &READ.graph);
    if std::env::var_os("UPDATE_GRAPH").is_some() {
        std::fs::write(&path, &wanted).expect("ARCHITECTURE.md can be written");
    } else {
        assert!(document == wanted, "the graph is now, to be written by UPDATE_GRAPH=1:\n{}", READ.graph);
    }
}
