//! The reader of imports on small crates that are made up.

use std::collections::{BTreeMap, BTreeSet};

use super::arrows::{self, Arrow};
use super::workspace::Workspace;
use super::{drawn, layers, loops};

/// Crates of these files; each needs a manifest, which is empty where none is given.
fn crates(files: &[(&str, &str)]) -> Workspace {
    let mut all: BTreeMap<_, _> =
        files.iter().map(|(path, text)| (format!("crates/{path}"), (*text).to_owned())).collect();
    for (path, _) in files {
        let name = path.split('/').next().expect("a path begins with its crate");
        all.entry(format!("crates/{name}/Cargo.toml")).or_default();
    }
    Workspace::of(&all)
}

/// Arrows as `from -> to: name`, by paths below `crates/`.
fn told(workspace: &Workspace) -> Vec<String> {
    let below = |file: &str| file.trim_start_matches("crates/").to_owned();
    let told = |arrow: &Arrow| format!("{} -> {}: {}", below(&arrow.from), below(&arrow.to), arrow.name);
    arrows::arrows(workspace).iter().map(told).collect()
}

fn loops_of(workspace: &Workspace) -> Vec<String> {
    loops::report(&loops::folders(&arrows::arrows(workspace), &workspace.files()))
}

#[test]
fn a_loop_of_two_files_is_found_and_told_with_its_names() {
    let workspace = crates(&[
        ("a/src/lib.rs", "mod one; mod other;"),
        ("a/src/one.rs", "use crate::other::Other; pub struct One(Other);"),
        ("a/src/other.rs", "pub struct Other; fn f(one: super::one::One) {}"),
    ]);
    let loops = loops_of(&workspace);
    assert_eq!(loops.len(), 1, "{loops:?}");
    for part in ["crates/a/src: 2", "one.rs -> other.rs: Other", "other.rs -> one.rs: One"] {
        assert!(loops[0].contains(part), "{part}: {}", loops[0]);
    }
}

#[test]
fn folders_hang_together_where_none_of_their_files_do() {
    let workspace = crates(&[
        ("a/src/lib.rs", "mod one; mod other;"),
        ("a/src/one/mod.rs", "mod high; mod low;"),
        ("a/src/one/high.rs", "use crate::other::high::High; pub struct A(High);"),
        ("a/src/one/low.rs", "pub struct Low;"),
        ("a/src/other/mod.rs", "pub mod high; mod low;"),
        ("a/src/other/high.rs", "pub struct High;"),
        ("a/src/other/low.rs", "use crate::one::low::Low; pub struct B(Low);"),
    ]);
    let loops = loops_of(&workspace);
    assert_eq!(loops.len(), 1, "{loops:?}");
    assert!(loops[0].starts_with("crates/a/src: 2 hang together in a loop: one, other"), "{}", loops[0]);
}

#[test]
fn what_a_facade_re_exports_is_used_of_the_file_that_defines_it() {
    let workspace = crates(&[
        ("a/src/lib.rs", "mod user; mod kept; pub use kept::Deep;"),
        ("a/src/user.rs", "use crate::kept::{self, Deep as D}; use crate::Deep; fn f(x: kept::Other) {}"),
        ("a/src/kept/mod.rs", "mod deep; pub use deep::*; pub use self::deep::Deep;"),
        ("a/src/kept/deep.rs", "pub struct Deep; pub enum Other {}"),
    ]);
    let deep = |name: &str| format!("a/src/user.rs -> a/src/kept/deep.rs: {name}");
    assert_eq!(told(&workspace), [deep("Deep"), deep("Other")]);
}

#[test]
fn a_crate_that_re_exports_another_is_followed() {
    let workspace = crates(&[
        ("weald-low/src/lib.rs", "pub mod job;"),
        ("weald-low/src/job.rs", "pub struct Job; #[macro_export] macro_rules! jobs { () => {} }"),
        ("weald/src/lib.rs", "pub use weald_low as low; pub use weald_low::jobs;"),
        ("top/src/main.rs", "fn main() { let _: weald::low::job::Job; weald::jobs!(); }"),
    ]);
    let job = |name: &str| format!("top/src/main.rs -> weald-low/src/job.rs: {name}");
    assert_eq!(told(&workspace), [job("Job"), job("jobs")]);
}

#[test]
fn code_beside_declarations_makes_a_module_file_a_node() {
    for module in ["a/src/b/mod.rs", "a/src/b.rs"] {
        let workspace = crates(&[
            ("a/src/lib.rs", "pub mod b;"),
            (module, "pub mod c; pub trait T {} pub const ALL: &[&dyn T] = &[&c::C];"),
            ("a/src/b/c.rs", "use super::T; pub struct C; impl T for C {}"),
        ]);
        let loops = loops_of(&workspace);
        assert_eq!(loops.len(), 1, "{module}: {loops:?}");
        assert!(
            loops[0].starts_with("crates/a/src/b: 2 hang together in a loop: c.rs, mod.rs"),
            "{}",
            loops[0]
        );
    }
}

#[test]
fn a_module_file_with_code_may_re_export_the_children_that_use_it() {
    let workspace = crates(&[
        ("a/src/lib.rs", "pub mod b;"),
        ("a/src/b/mod.rs", "mod c; pub use c::C; pub trait T {}"),
        ("a/src/b/c.rs", "use super::T; pub struct C; impl T for C {}"),
    ]);
    assert_eq!(told(&workspace), ["a/src/b/c.rs -> a/src/b/mod.rs: T"]);
}

#[test]
fn tests_are_left_out() {
    let workspace = crates(&[
        ("a/src/lib.rs", "mod b; mod c; #[cfg(test)] mod looks;"),
        (
            "a/src/b.rs",
            "pub struct B; #[cfg(test)] use crate::c::C; #[test] fn t() { crate::c::C; }
             #[cfg(test)] mod tests { use crate::c::C; }",
        ),
        ("a/src/c.rs", "use crate::b::B; pub struct C(B);"),
    ]);
    assert_eq!(told(&workspace), ["a/src/c.rs -> a/src/b.rs: B"]);
}

#[test]
fn paths_within_macros_are_read() {
    let workspace = crates(&[
        ("a/src/lib.rs", "#[macro_use] mod made; mod kind; mod list; mod used;"),
        ("a/src/made.rs", "macro_rules! made { ($a:ident) => { $crate::kind::Kind::$a }; }"),
        ("a/src/kind.rs", "pub enum Kind { A } pub fn f() {}"),
        ("a/src/list.rs", "use crate::used; vec! { pub struct Listed { x: u8 } }"),
        ("a/src/used.rs", "fn g() { made!(A); assert!(crate::list::Listed { x: 0..kind.f }); }"),
    ]);
    assert_eq!(
        told(&workspace),
        [
            "a/src/list.rs -> a/src/used.rs: used",
            "a/src/made.rs -> a/src/kind.rs: Kind",
            "a/src/used.rs -> a/src/list.rs: Listed",
            "a/src/used.rs -> a/src/made.rs: made",
        ]
    );
}

#[test]
fn a_stage_that_imports_another_is_told_and_so_is_flow_above_erosion() {
    let valid = [
        ("weald-land/src/lib.rs", "pub mod generate; pub mod erode; pub mod flow;"),
        ("weald-land/src/generate.rs", "use crate::erode::Rain; use crate::flow::Area;"),
        ("weald-land/src/erode/mod.rs", "pub struct Rain; use crate::flow::Area;"),
        ("weald-land/src/flow.rs", "pub struct Area; fn f(_: crate::erode::Rain) {}"),
    ];
    assert_eq!(
        layers::forbidden(&arrows::arrows(&crates(&valid))),
        [
            "crates/weald-land/src/flow.rs -> crates/weald-land/src/erode/mod.rs: Rain",
            "crates/weald-land/src/generate.rs -> crates/weald-land/src/erode/mod.rs: Rain",
        ]
    );
}

#[test]
fn crates_keep_to_the_table() {
    let workspace = crates(&[
        ("high/Cargo.toml", "[dependencies]\nlow = { workspace = true }\nwgpu = \"30\""),
        ("low/Cargo.toml", "[dependencies]\n[dev-dependencies]\nhigh = { workspace = true }"),
    ]);
    assert_eq!(layers::diagnostics(&workspace, &[("high", &["low"]), ("low", &[])]), Vec::<String>::new());
    let upside_down = layers::diagnostics(&workspace, &[("low", &[]), ("high", &["low"])]);
    assert_eq!(upside_down, ["high -> low leads upward in the table of layers"]);
    let unknown = layers::diagnostics(&workspace, &[("low", &["high"]), ("high", &[])]);
    assert_eq!(
        unknown,
        [
            "high -> low is not in the table of layers (crates/high/Cargo.toml)",
            "low -> high is in the table of layers and in no Cargo.toml",
        ]
    );
    assert_eq!(layers::strays(&workspace), ["high depends on wgpu"]);
}

#[test]
fn the_graph_is_drawn_from_top_to_bottom() {
    let workspace = crates(&[
        ("a/src/lib.rs", "mod bottom; mod side; mod top; mod middle;"),
        ("a/src/top.rs", "use crate::middle::low::M; use crate::bottom::B;"),
        ("a/src/middle/mod.rs", "mod low;"),
        ("a/src/middle/low.rs", "use crate::bottom::B; pub struct M(B);"),
        ("a/src/bottom.rs", "pub struct B;"),
        ("a/src/side.rs", ""),
    ]);
    let graph = drawn::graph(&workspace, &arrows::arrows(&workspace), &[("a", &[])]);
    assert_eq!(graph, "```text\na uses nothing here\n    top\n    middle\n    bottom side\n```\n");
}

#[test]
fn circles_are_told_apart() {
    let edges = [("a", "b"), ("b", "a"), ("b", "c"), ("c", "d"), ("d", "e"), ("e", "c"), ("f", "f")];
    let circle = |nodes: &[&'static str]| nodes.iter().copied().collect::<BTreeSet<_>>();
    assert_eq!(
        loops::circles(edges.into_iter()),
        [circle(&["a", "b"]), circle(&["c", "d", "e"]), circle(&["f"])]
    );
}
