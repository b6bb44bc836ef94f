//! Paths and definitions among the tokens of macros, which no parser knows the grammar of.

use proc_macro2::{Delimiter, TokenStream, TokenTree};

/// Words after which comes a name that is defined.
const DEFINING: [&str; 9] = ["struct", "enum", "trait", "type", "fn", "const", "static", "union", "mod"];

/// The names that items among the tokens define.
pub(crate) fn defined(tokens: TokenStream) -> Vec<String> {
    let mut names = Vec::new();
    let mut defining = false;
    for token in tokens {
        let TokenTree::Ident(word) = token else {
            defining = false;
            continue;
        };
        let word = word.to_string();
        let known = DEFINING.contains(&word.as_str());
        if defining && !known {
            names.push(word);
        }
        defining = known;
    }
    names
}

/// All paths among the tokens: `a::b`, `$crate::a`, and each name of `a::{b, c}`. Names after a dot are fields and
/// methods, and metavariables stand for something else; neither is a path.
pub(crate) fn paths(tokens: TokenStream) -> Vec<Vec<String>> {
    let mut found = Vec::new();
    scan(tokens, &[], &mut found);
    found
}

fn scan(tokens: TokenStream, prefix: &[String], found: &mut Vec<Vec<String>>) {
    let tokens: Vec<_> = tokens.into_iter().collect();
    let mut at = 0;
    while at < tokens.len() {
        match &tokens[at] {
            TokenTree::Group(group) => {
                scan(group.stream(), &[], found);
                at += 1;
            }
            TokenTree::Ident(_) => at = read_path(&tokens, at, prefix, found),
            _ => at += 1,
        }
    }
}

/// Reads the path that begins at a word, and says where it ends.
fn read_path(tokens: &[TokenTree], first: usize, prefix: &[String], found: &mut Vec<Vec<String>>) -> usize {
    let mut path = prefix.to_vec();
    let mut at = first;
    while let Some(TokenTree::Ident(word)) = tokens.get(at) {
        path.push(word.to_string());
        at += 1;
        if !(is_mark(tokens, at, ':') && is_mark(tokens, at + 1, ':')) {
            break;
        }
        at += 2;
        if let Some(TokenTree::Group(group)) = tokens.get(at)
            && group.delimiter() == Delimiter::Brace
        {
            scan(group.stream(), &path, found);
            return at + 1;
        }
    }
    if path.len() > 1 && path.last().is_some_and(|last| last == "self") {
        path.pop();
    }
    let before = first.checked_sub(1);
    let follows = |mark| before.is_some_and(|before| is_mark(tokens, before, mark));
    // `0..count` has two dots and names something, `place.count` has one.
    let member = follows('.') && !first.checked_sub(2).is_some_and(|at| is_mark(tokens, at, '.'));
    let variable = follows('$') && path[0] != "crate";
    if !member && !variable && !follows('\'') {
        found.push(path);
    }
    at
}

fn is_mark(tokens: &[TokenTree], at: usize, mark: char) -> bool {
    matches!(tokens.get(at), Some(TokenTree::Punct(found)) if found.as_char() == mark)
}
