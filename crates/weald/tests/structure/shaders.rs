//! Operators in shaders as browsers read them: WGSL has no order between many of them and asks for parentheses, where wgpu's own
//! reader is content without (<https://www.w3.org/TR/WGSL/#operator-precedence-associativity>). A page would show nothing.

use std::fs;
use std::path::Path;

use proc_macro2::{Delimiter, Spacing, TokenStream, TokenTree};

/// Words after which `<` opens what a type is of.
const GENERIC: [&str; 9] = ["vec2", "vec3", "vec4", "array", "ptr", "atomic", "bitcast", "var", "enable"];

/// Words after which an operator has one operand.
const STATEMENTS: [&str; 5] = ["return", "if", "while", "switch", "case"];

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Operator {
    Arithmetic,
    Shift,
    Comparison,
    Bits(char),
    And,
    Or,
}

impl Operator {
    /// Of the marks of an operator; none where these part two expressions.
    fn of(marks: &str) -> Option<Self> {
        Some(match marks {
            "+" | "-" | "*" | "/" | "%" => Self::Arithmetic,
            "<<" | ">>" => Self::Shift,
            "<" | "<=" | ">" | ">=" | "==" | "!=" => Self::Comparison,
            "&" | "|" | "^" => Self::Bits(marks.chars().next()?),
            "&&" => Self::And,
            "||" => Self::Or,
            _ => return None,
        })
    }
}

/// Whether operators that stand side by side, without parentheses, have an order.
fn have_an_order(operators: &[Operator]) -> bool {
    let bits = operators.iter().find(|operator| matches!(operator, Operator::Bits(_)));
    let alike = bits.is_none_or(|bits| operators.iter().all(|operator| operator == bits));
    let are_mixed = operators.contains(&Operator::And) && operators.contains(&Operator::Or);
    let operands =
        operators.split(|operator| matches!(operator, Operator::Comparison | Operator::And | Operator::Or));
    let shifts = |operand: &[Operator]| operand.contains(&Operator::Shift) && operand.len() > 1;
    alike && !are_mixed && !operands.into_iter().any(shifts)
}

/// The expressions that a browser refuses.
fn refused(tokens: TokenStream) -> Vec<String> {
    let tokens: Vec<_> = tokens.into_iter().collect();
    let mut found = Vec::new();
    let (mut operators, mut has_operand) = (Vec::new(), false);
    let (mut begin, mut at) = (0, 0);
    while let Some(token) = tokens.get(at) {
        at += 1;
        let mut ends = false;
        match token {
            TokenTree::Group(group) => {
                found.extend(refused(group.stream()));
                (has_operand, ends) = (true, group.delimiter() == Delimiter::Brace);
            }
            TokenTree::Ident(word) => {
                let word = word.to_string();
                let is_generic = GENERIC.contains(&word.as_str())
                    || ["mat2x", "mat3x", "mat4x"].iter().any(|of| word.starts_with(of))
                    || word.starts_with("texture");
                if is_generic && is_mark(tokens.get(at), '<') {
                    at = behind_type(&tokens, at);
                }
                has_operand = !STATEMENTS.contains(&word.as_str());
            }
            TokenTree::Literal(_) => has_operand = true,
            TokenTree::Punct(_) => {
                let marks = marks_from(&tokens, at - 1);
                at += marks.len() - 1;
                match Operator::of(&marks) {
                    Some(operator) if has_operand => operators.push(operator),
                    Some(_) => {}
                    None => ends = !matches!(marks.as_str(), "." | "!" | "~"),
                }
                has_operand = false;
            }
        }
        if ends || at == tokens.len() {
            if !have_an_order(&operators) {
                found.push(tokens[begin..at].iter().cloned().collect::<TokenStream>().to_string());
            }
            operators.clear();
            (begin, has_operand) = (at, false);
        }
    }
    found
}

fn is_mark(token: Option<&TokenTree>, mark: char) -> bool {
    matches!(token, Some(TokenTree::Punct(found)) if found.as_char() == mark)
}

/// The marks that stand together from there on.
fn marks_from(tokens: &[TokenTree], first: usize) -> String {
    let mut marks = String::new();
    for token in &tokens[first..] {
        let TokenTree::Punct(mark) = token else { break };
        marks.push(mark.as_char());
        if mark.spacing() == Spacing::Alone {
            break;
        }
    }
    marks
}

/// Where what a type is of ends, from where it opens.
fn behind_type(tokens: &[TokenTree], first: usize) -> usize {
    let mut depth = 0_usize;
    for (at, token) in tokens.iter().enumerate().skip(first) {
        depth += usize::from(is_mark(Some(token), '<'));
        depth -= usize::from(is_mark(Some(token), '>'));
        if depth == 0 {
            return at + 1;
        }
    }
    tokens.len()
}

fn refused_in(text: &str) -> Vec<String> {
    refused(text.parse().expect("WGSL has the words and marks of Rust"))
}

fn shaders(folder: &Path, found: &mut Vec<std::path::PathBuf>) {
    for entry in fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("read").path()) {
        if entry.is_dir() {
            shaders(&entry, found);
        } else if entry.extension().is_some_and(|ending| ending == "wgsl") {
            found.push(entry);
        }
    }
}

#[test]
fn operators_of_shaders_have_an_order_in_a_browser() {
    let mut files = Vec::new();
    shaders(&super::root().join("crates"), &mut files);
    assert!(files.len() > 40, "only {} shaders were found", files.len());
    let told = files.iter().flat_map(|file| {
        let expressions = refused_in(&fs::read_to_string(file).expect("read"));
        expressions.into_iter().map(move |expression| format!("{}: {expression}", file.display()))
    });
    let told: Vec<_> = told.collect();
    assert!(told.is_empty(), "these need parentheses:\n{}", told.join("\n"));
}

#[test]
fn what_a_browser_refuses_is_found() {
    for expression in [
        "a <= 0.0 | b",
        "a & b == c",
        "a && b || c",
        "a << b + 1u",
        "f(a | b + 1u)",
        "a | b & c",
        "a & !b && c",
        "material < 2u & b",
    ] {
        let text = format!("fn f() -> vec2<f32> {{\n    if {expression} {{ return vec2<f32>(1.0); }}\n}}");
        assert_eq!(refused_in(&text).len(), 1, "{expression}");
    }
    for expression in [
        "(a <= 0.0) | b",
        "a < b && c >= d + 1.0",
        "a | b | c",
        "(a << 2u) + b",
        "-a & !b",
        "a << 2u < b + c",
        "f(&a, b * c)",
    ] {
        let text =
            format!("fn f(a: ptr<function, array<vec2<f32>, 4>>) {{ let x = {expression}; y >>= 1u + b; }}");
        assert!(refused_in(&text).is_empty(), "{expression}");
    }
}
