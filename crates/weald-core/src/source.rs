//! A recipe as written: TOML in which every key and value knows its line.

use toml::de::{DeTable, DeValue};

use crate::error::{Diagnostic, RecipeError};

/// Longest recipe that is read, in bytes. A recipe is a page of text; more is a mistake.
pub const MAX_BYTES: usize = 1 << 20;

/// A value and the line it stands on.
#[derive(Clone, Debug, PartialEq)]
pub struct Node {
    /// Line in the file, counted from 1; 0 for a value that came from the command line.
    pub line: usize,
    /// The value.
    pub value: Value,
}

/// A TOML value.
#[derive(Clone, Debug, PartialEq)]
pub enum Value {
    /// `true` or `false`.
    Flag(bool),
    /// A whole number.
    Integer(i64),
    /// A number with a point or an exponent.
    Number(f64),
    /// A string.
    Text(String),
    /// `[…]`.
    List(Vec<Node>),
    /// `{…}`, or everything under a `[header]`.
    Table(Table),
}

impl Value {
    /// The value as a user would write it.
    pub fn shown(&self) -> String {
        match self {
            Self::Flag(flag) => flag.to_string(),
            Self::Integer(number) => number.to_string(),
            Self::Number(number) => format!("{number:?}"),
            Self::Text(text) => format!("{text:?}"),
            Self::List(_) => "a list".to_owned(),
            Self::Table(_) => "a table".to_owned(),
        }
    }
}

/// Keys and values in the order of the file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Table {
    /// Line of the header, or of the first key.
    pub line: usize,
    /// Keys, with their own lines, and values.
    pub entries: Vec<(String, Node)>,
}

impl Table {
    /// The value of a key.
    pub fn get(&self, key: &str) -> Option<&Node> {
        self.entries.iter().find(|(name, _)| name == key).map(|(_, node)| node)
    }

    /// The value of a key, to be changed.
    pub fn get_mut(&mut self, key: &str) -> Option<&mut Node> {
        self.entries.iter_mut().find(|(name, _)| name == key).map(|(_, node)| node)
    }

    /// Sets a key, keeping its place where it exists.
    pub fn set(&mut self, key: &str, node: Node) {
        match self.entries.iter_mut().find(|(name, _)| name == key) {
            Some((_, old)) => *old = node,
            None => self.entries.push((key.to_owned(), node)),
        }
    }

    /// Takes a key out.
    pub fn take(&mut self, key: &str) -> Option<Node> {
        let index = self.entries.iter().position(|(name, _)| name == key)?;
        Some(self.entries.remove(index).1)
    }

    /// The line of a key, or of a key deep inside as [`Fault`](super::parameter::Fault) writes it; where it is absent, that of what
    /// is around it.
    pub fn line_of(&self, path: &str) -> usize {
        let (key, rest) = path.split_once('.').map_or((path, None), |(key, rest)| (key, Some(rest)));
        let Some(node) = self.get(key) else { return self.line };
        rest.map_or(node.line, |rest| line_in(node, rest))
    }
}

fn line_in(node: &Node, path: &str) -> usize {
    match &node.value {
        Value::Table(table) if path.split('.').next().is_some_and(|key| table.get(key).is_some()) => {
            table.line_of(path)
        }
        Value::List(items) => {
            let (place, rest) =
                path.split_once('.').map_or((path, None), |(place, rest)| (place, Some(rest)));
            let item = place.parse::<usize>().ok().and_then(|place| items.get(place.checked_sub(1)?));
            item.map_or(node.line, |item| rest.map_or(item.line, |rest| line_in(item, rest)))
        }
        _ => node.line,
    }
}

/// Parses TOML.
///
/// # Errors
/// A [`RecipeError`] with the line of every syntax fault.
pub fn parse(file: &str, text: &str) -> Result<Table, RecipeError> {
    let fail = |line, message| RecipeError {
        file: file.to_owned(),
        diagnostics: vec![Diagnostic { line, message }],
    };
    if text.len() > MAX_BYTES {
        return Err(fail(1, format!("a recipe of {} bytes; at most {MAX_BYTES} are read", text.len())));
    }
    let lines = Lines::of(text);
    let parsed = DeTable::parse(text).map_err(|error| {
        let span = error.span().unwrap_or(0..0);
        let line = lines.line(span.start);
        if let Some(remedy) = text.lines().nth(line - 1).and_then(quotes_are_missing) {
            return fail(line, remedy);
        }
        // The message of some faults, such as a key that is there twice, does not say what it is about.
        let about = text.get(span.clone()).and_then(|about| about.lines().next()).unwrap_or_default();
        let about = if about.is_empty() { String::new() } else { format!(": `{about}`") };
        fail(line, format!("{}{about}", error.message()))
    })?;
    let mut unfit = Vec::new();
    let table = convert_table(parsed.get_ref(), 1, &lines, &mut unfit);
    if unfit.is_empty() {
        return Ok(table);
    }
    Err(RecipeError { file: file.to_owned(), diagnostics: unfit })
}

/// What to do about a line `key = word`. TOML takes a bare word for the beginning of `true`, `false` or a number.
fn quotes_are_missing(line: &str) -> Option<String> {
    let (key, value) = line.split_once('=')?;
    let (key, value) = (key.trim(), value.split('#').next()?.trim());
    let is_word = value.starts_with(|letter: char| letter.is_alphabetic())
        && value.chars().all(|letter| letter.is_alphanumeric() || "-_./".contains(letter))
        && !["true", "false", "inf", "nan"].contains(&value);
    is_word.then(|| format!("text stands in quotes: {key} = \"{value}\""))
}

/// Byte positions of line starts.
pub struct Lines(Vec<usize>);

impl Lines {
    /// The lines of a text.
    pub fn of(text: &str) -> Self {
        let starts = text.bytes().enumerate().filter(|&(_, byte)| byte == b'\n').map(|(at, _)| at + 1);
        Self(std::iter::once(0).chain(starts).collect())
    }

    /// The line of a byte, counted from 1.
    pub fn line(&self, byte: usize) -> usize {
        self.0.partition_point(|&start| start <= byte)
    }
}

fn convert_table(table: &DeTable<'_>, line: usize, lines: &Lines, unfit: &mut Vec<Diagnostic>) -> Table {
    let mut entries: Vec<(usize, String, Node)> = table
        .iter()
        .map(|(key, value)| {
            let line = lines.line(key.span().start);
            let node = Node { line, value: convert(value.get_ref(), line, lines, unfit) };
            (key.span().start, key.get_ref().to_string(), node)
        })
        .collect();
    entries.sort_by_key(|(start, ..)| *start);
    Table { line, entries: entries.into_iter().map(|(_, key, node)| (key, node)).collect() }
}

fn convert(value: &DeValue<'_>, line: usize, lines: &Lines, unfit: &mut Vec<Diagnostic>) -> Value {
    let mut report_fault = |message: String| {
        unfit.push(Diagnostic { line, message });
        Value::Flag(false)
    };
    match value {
        DeValue::String(text) => Value::Text(text.to_string()),
        DeValue::Boolean(flag) => Value::Flag(*flag),
        DeValue::Integer(number) => match i64::from_str_radix(number.as_str(), number.radix()) {
            Ok(number) => Value::Integer(number),
            Err(_) => report_fault(format!("{number} does not fit in 64 bits")),
        },
        DeValue::Float(number) => match number.as_str().parse() {
            Ok(number) => Value::Number(number),
            Err(_) => report_fault(format!("{number} is not a number")),
        },
        DeValue::Datetime(date) => report_fault(format!("{date} is a date; no key takes one")),
        DeValue::Array(items) => Value::List(
            items
                .iter()
                .map(|item| {
                    let line = lines.line(item.span().start);
                    Node { line, value: convert(item.get_ref(), line, lines, unfit) }
                })
                .collect(),
        ),
        DeValue::Table(table) => Value::Table(convert_table(table, line, lines, unfit)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_key_knows_its_line() {
        let table = parse("r", "a = 1\n\n[b]\nc = 2.5\n[[d]]\ne = \"x\"\n[[d]]\n").expect("parses");
        assert_eq!(table.get("a").map(|node| node.line), Some(1));
        let Some(Node { value: Value::Table(b), .. }) = table.get("b") else { panic!("b is a table") };
        assert_eq!(b.get("c"), Some(&Node { line: 4, value: Value::Number(2.5) }));
        let Some(Node { value: Value::List(d), .. }) = table.get("d") else { panic!("d is a list") };
        assert_eq!(d.iter().map(|node| node.line).collect::<Vec<_>>(), [5, 7]);
    }

    #[test]
    fn a_word_without_quotes_is_answered_with_them() {
        for word in ["fbm", "thermal", "noise", "infinite", "diamond-square", "out/a.png"] {
            let error = parse("r.toml", &format!("a = 1\ndo = {word} # rough\n")).expect_err("no quotes");
            assert_eq!(error.diagnostics[0].line, 2, "{word}");
            let message = &error.diagnostics[0].message;
            assert_eq!(*message, format!("text stands in quotes: do = \"{word}\""));
        }
        assert!(parse("r.toml", "a = true\nb = nan\nc = inf\n").is_ok());
    }

    #[test]
    fn a_syntax_fault_names_its_line() {
        let error = parse("r.toml", "a = 1\nb = = 2\n").expect_err("bad syntax");
        assert_eq!(error.diagnostics[0].line, 2);
        assert!(error.to_string().starts_with("r.toml:2: "), "{error}");
    }
}
