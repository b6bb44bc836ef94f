//! No retired identifier or phrase stands in code, documents or messages: `docs/retired.toml` has the list.

use std::path::{Path, PathBuf};

use toml::Table;

/// What a piece of a file is.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Kind {
    Code,
    Comment,
    Text,
}

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").canonicalize().expect("the repository")
}

/// Files below a folder that people write: code, documents, recipes.
fn collect(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("an entry").path()) {
        let name = entry.file_name().and_then(|name| name.to_str()).unwrap_or_default().to_owned();
        if entry.is_dir() {
            let left_out = ["target", "fixtures", "corpus", "out", "data", "shared"];
            if !name.starts_with('.') && !left_out.contains(&name.as_str()) {
                collect(&entry, found);
            }
        } else if [".rs", ".wgsl", ".md", ".toml"].iter().any(|end| name.ends_with(end))
            && !["glossary.md", "retired.toml", "CHANGELOG.md", "Cargo.toml"].contains(&name.as_str())
        {
            found.push(entry);
        }
    }
}

fn files() -> Vec<PathBuf> {
    let mut found = Vec::new();
    collect(&root(), &mut found);
    assert!(found.len() > 500, "only {} files: the walk misses most", found.len());
    found
}

/// The length of what begins here and is no code, and its kind.
fn not_code(rest: &str, is_rust: bool) -> Option<(usize, Kind)> {
    let end_of = |end: &str| rest[2..].find(end).map_or(rest.len(), |at| at + 2 + end.len());
    if rest.starts_with("//") {
        return Some((rest.find('\n').unwrap_or(rest.len()), Kind::Comment));
    }
    if rest.starts_with("/*") {
        return Some((end_of("*/"), Kind::Comment));
    }
    if !is_rust {
        return None;
    }
    if let Some(raw) = rest.strip_prefix('r') {
        let hashes = raw.len() - raw.trim_start_matches('#').len();
        if raw[hashes..].starts_with('"') {
            let end = format!("\"{}", "#".repeat(hashes));
            let from = 2 + hashes;
            return Some((
                rest[from..].find(&end).map_or(rest.len(), |at| from + at + end.len()),
                Kind::Text,
            ));
        }
    }
    if rest.starts_with("'\"'") || rest.starts_with("'\\") {
        let close = rest[2..].find('\'').map_or(rest.len(), |at| at + 3);
        return Some((close.min(rest.len()), Kind::Code));
    }
    rest.starts_with('"').then(|| (string_length(rest), Kind::Text))
}

fn string_length(rest: &str) -> usize {
    let mut is_escaped = false;
    for (at, letter) in rest.char_indices().skip(1) {
        match letter {
            _ if is_escaped => is_escaped = false,
            '\\' => is_escaped = true,
            '"' => return at + 1,
            _ => {}
        }
    }
    rest.len()
}

/// The file in pieces of one kind; documents are text.
fn pieces<'a>(path: &Path, text: &'a str) -> Vec<(Kind, &'a str)> {
    let extension = path.extension().and_then(|end| end.to_str()).unwrap_or_default();
    if ["md", "toml"].contains(&extension) {
        return vec![(Kind::Text, text)];
    }
    let (mut found, mut start, mut at) = (Vec::new(), 0, 0);
    while at < text.len() {
        let starts_word = !text[..at].ends_with(|letter: char| letter.is_alphanumeric() || letter == '_');
        let other =
            not_code(&text[at..], extension == "rs").filter(|_| starts_word || !text[at..].starts_with('r'));
        match other {
            Some((length, Kind::Code)) => at += length,
            Some((length, kind)) => {
                found.extend([(Kind::Code, &text[start..at]), (kind, &text[at..at + length])]);
                at += length;
                start = at;
            }
            None => at += text[at..].chars().next().map_or(1, char::len_utf8),
        }
    }
    found.push((Kind::Code, &text[start..]));
    found
}

fn words(text: &str) -> impl Iterator<Item = &str> {
    text.split(|letter: char| !letter.is_alphanumeric() && letter != '_').filter(|word| !word.is_empty())
}

/// Whether a name has several words, so that it cannot be meant as a plain word of English.
fn is_compound(name: &str) -> bool {
    let humps = name.chars().zip(name.chars().skip(1)).any(|(a, b)| a.is_lowercase() && b.is_uppercase());
    humps || name.trim_matches('_').contains('_')
}

/// Text without the marks of comments and without line ends, in small letters.
fn flat(text: &str) -> String {
    let lines = text.lines().map(|line| {
        let line = line.trim().trim_end_matches('\\');
        line.trim_start_matches("//!").trim_start_matches("///").trim_start_matches("//").trim()
    });
    lines.collect::<Vec<_>>().join(" ").split_whitespace().collect::<Vec<_>>().join(" ").to_lowercase()
}

fn contains_phrase(text: &str, phrase: &str) -> bool {
    let is_letter = |letter: char| letter.is_alphanumeric() || letter == '_' || letter == '-';
    text.match_indices(phrase).any(|(at, found)| {
        !text[..at].ends_with(is_letter) && !text[at + found.len()..].starts_with(is_letter)
    })
}

/// What is found in a file: each retired word with what stands in its place.
fn found_in(path: &Path, text: &str, retired: &Table) -> Vec<String> {
    let [identifiers, phrases] =
        ["identifiers", "phrases"].map(|key| retired[key].as_table().expect("a table"));
    let (mut found, mut prose) = (Vec::new(), String::new());
    for (kind, piece) in pieces(path, text) {
        let names = words(piece).filter(|word| kind == Kind::Code || is_compound(word));
        found.extend(
            names.filter_map(|name| identifiers.get(name).map(|new| format!("`{name}` is now {new}"))),
        );
        if kind != Kind::Code {
            prose.push_str(piece);
            prose.push('\n');
        } else if !piece.trim().is_empty() {
            // Code between two comments keeps their words apart.
            prose.push_str("\n\u{0}\n");
        }
    }
    let prose = flat(&prose);
    let old = phrases.iter().filter(|(old, _)| contains_phrase(&prose, &old.to_lowercase()));
    found.extend(old.map(|(old, new)| format!("\"{old}\" is now {new}")));
    found.sort();
    found.dedup();
    found
}

fn retired() -> Table {
    let text = std::fs::read_to_string(root().join("docs/retired.toml")).expect("the list");
    text.parse().expect("TOML")
}

#[test]
fn no_retired_word_stands_in_code_documents_or_messages() {
    let (retired, root) = (retired(), root());
    let mut found = Vec::new();
    for path in files() {
        let text =
            std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
        let shown = path.strip_prefix(&root).expect("within").display().to_string();
        found.extend(found_in(&path, &text, &retired).into_iter().map(|what| format!("{shown}: {what}")));
    }
    assert!(found.is_empty(), "{} retired words:\n{}", found.len(), found.join("\n"));
}

#[test]
fn a_retired_word_is_found_in_code_comments_messages_and_over_line_ends() {
    let list: Table = "[identifiers]\nold_name = \"new_name\"\nlot = \"random\"\n[phrases]\n\"flows in a ring\" = \"flows in a cycle\"\n"
        .parse()
        .expect("TOML");
    let count = |file: &str, text: &str| found_in(Path::new(file), text, &list).len();
    assert_eq!(count("a.rs", "fn lot() {}\n"), 1, "an identifier in code");
    assert_eq!(
        count("a.rs", "// a lot of prose\nlet slot = \"a lot\";\n"),
        0,
        "plain words and parts of words"
    );
    assert_eq!(count("a.rs", "/// See [`old_name`].\n"), 1, "a name in a comment");
    assert_eq!(count("a.rs", "let x = '\"'; let y = r#\"lot\"#; lot()\n"), 1, "quotes do not hide code");
    assert_eq!(count("a.rs", "//! Water flows in\n//! a ring.\n"), 1, "over a line end");
    assert_eq!(count("a.rs", "panic!(\"it flows in \\\n        a ring\")\n"), 1, "in a message");
    assert_eq!(count("a.md", "It Flows in a ring, `old_name`.\n"), 2, "in a document");
}
