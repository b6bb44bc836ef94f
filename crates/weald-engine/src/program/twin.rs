//! Numbers that stand in a shader and in Rust, for tests that compare them.

/// The number `const NAME: TYPE = NUMBER;` of a shader.
pub fn number(shader: &str, name: &str) -> f64 {
    let start = format!("const {name}: ");
    let line = shader.lines().find(|line| line.starts_with(&start));
    let (_, number) = line.and_then(|line| line.split_once("= ")).unwrap_or_else(|| panic!("no `{name}`"));
    let digits = number.trim_end_matches(';').trim_end_matches('u');
    digits.parse().unwrap_or_else(|_| panic!("`{name}` is {number}"))
}
