//! Every step that a program can use has an example in its documentation that says what comes of it.

use std::path::{Path, PathBuf};

/// Lines of an example that a reader sees.
const MAX_LINES: usize = 10;

/// Where a step of `weald::steps` is declared: `weald_land::analyse::slope::Slope` has the crate `weald-land`, the
/// modules `analyse` and `slope`, and the name `Slope`.
struct Declared {
    folder: PathBuf,
    name: String,
}

impl Declared {
    /// From a line such as `pub use weald_land::analyse::slope::Slope;`.
    fn of(line: &str) -> Option<Self> {
        let path = line.strip_prefix("pub use ")?.trim_end_matches(';').split(" as ").next()?;
        let (modules, name) = path.rsplit_once("::")?;
        let mut modules = modules.split("::");
        let package = modules.next()?.replace("crate", "weald").replace('_', "-");
        let crates = Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("lies in a folder");
        let folder = modules.fold(crates.join(package).join("src"), |folder, module| folder.join(module));
        Some(Self { folder, name: name.to_owned() })
    }

    /// The file of its module, and those below.
    fn files(&self) -> Vec<PathBuf> {
        let below = std::fs::read_dir(&self.folder).into_iter().flatten();
        let below = below.map(|entry| entry.expect("can be read").path());
        let files = below.filter(|path| path.extension().is_some_and(|extension| extension == "rs"));
        std::iter::once(self.folder.with_extension("rs")).chain(files).collect()
    }

    fn fault(&self) -> Option<String> {
        let read = |path: PathBuf| std::fs::read_to_string(&path).unwrap_or_default();
        let documented =
            self.files().into_iter().map(read).find_map(|source| documentation(&source, &self.name));
        let documentation = documented.unwrap_or_else(|| panic!("`{}` is declared nowhere", self.name));
        fault_of_example(&documentation, &self.name).map(|fault| format!("`{}`: {fault}", self.name))
    }
}

/// The documentation of a struct in a source.
fn documentation(source: &str, name: &str) -> Option<Vec<String>> {
    let lines: Vec<&str> = source.lines().map(str::trim).collect();
    let at = lines.iter().position(|line| *line == format!("pub struct {name} {{"))?;
    let documented = lines[..at].iter().rev().take_while(|line| line.starts_with("///"));
    let mut documented: Vec<_> = documented.map(|line| line[3..].trim_start().to_owned()).collect();
    documented.reverse();
    Some(documented)
}

/// The lines of the first block of code that runs: one without a language.
fn example(documentation: &[String]) -> Option<Vec<&str>> {
    let mut lines = documentation.iter().map(String::as_str);
    while let Some(fence) = lines.find(|line| line.starts_with("```")) {
        let block: Vec<_> = lines.by_ref().take_while(|line| *line != "```").collect();
        if fence == "```" {
            return Some(block);
        }
    }
    None
}

/// What is wrong with the example in a documentation.
fn fault_of_example(documentation: &[String], name: &str) -> Option<&'static str> {
    let Some(example) = example(documentation) else { return Some("has no example that runs") };
    let shown: Vec<_> = example.into_iter().filter(|line| !line.starts_with("# ")).collect();
    let says = |word: &str| shown.iter().any(|line| line.contains(word));
    if !says("assert") {
        return Some("its example asserts nothing that a reader sees");
    }
    if !(says(&format!("{name} {{")) || says(&format!("{name}::default()"))) {
        return Some("its example does not use it");
    }
    (shown.len() > MAX_LINES).then_some("its example is long")
}

#[test]
fn every_step_has_an_example_that_asserts_what_comes_of_it() {
    let declared: Vec<_> = include_str!("../../src/steps.rs").lines().filter_map(Declared::of).collect();
    assert_eq!(declared.len(), weald::recipe::catalog::CATALOG.len(), "all steps");
    let faults: Vec<_> = declared.iter().filter_map(Declared::fault).collect();
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

#[test]
fn examples_that_are_missing_hidden_empty_of_others_or_long_are_found() {
    let fault = |lines: &[&str]| {
        let lines: Vec<_> = lines.iter().map(|line| (*line).to_owned()).collect();
        fault_of_example(&lines, "Dune")
    };
    assert!(fault(&["Dunes.", "```text", "z = 1", "```"]).is_some_and(|fault| fault.contains("no example")));
    assert!(
        fault(&["```", "# assert!(true);", "Dune::default();", "```"])
            .is_some_and(|fault| fault.contains("asserts"))
    );
    assert!(
        fault(&["```", "assert!(true);", "```", "Dune::default()"])
            .is_some_and(|fault| fault.contains("use it"))
    );
    let long: Vec<_> =
        ["```", "Dune::default(); assert!(true);"].into_iter().chain([""; MAX_LINES]).collect();
    assert_eq!(fault(&long), Some("its example is long"));
    assert_eq!(fault(&["```", "Dune { height: 1.0 };", "assert!(true);", "```"]), None);
    let source = "/// Dunes.\npub struct Dune {\n";
    assert_eq!(documentation(source, "Dune"), Some(vec!["Dunes.".to_owned()]));
}
