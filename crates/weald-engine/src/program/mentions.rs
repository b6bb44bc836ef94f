//! Which buffers a shader reads and which it writes, as its text says.

/// What the text of a shader does with a buffer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mention {
    /// It does not name it.
    Never,
    /// It reads elements of it.
    Reads,
    /// It assigns to elements of it, and perhaps reads some too.
    Writes,
}

/// What a shader does with the buffer of this name: elements are written `name[…]`, and assigned to where `=` or
/// `+=` and the like stand behind that.
pub fn mention(shader: &str, buffer: &str) -> Mention {
    let mut found = Mention::Never;
    for line in shader.lines() {
        let code = line.split("//").next().unwrap_or_default();
        for (at, _) in code.match_indices(buffer) {
            let begins =
                !code[..at].ends_with(|before: char| before.is_alphanumeric() || "_.".contains(before));
            let Some(element) = code[at + buffer.len()..].strip_prefix('[').filter(|_| begins) else {
                continue;
            };
            if is_assignment(behind_the_bracket(element)) {
                return Mention::Writes;
            }
            found = Mention::Reads;
        }
    }
    found
}

/// What stands behind the bracket that is open at the start.
fn behind_the_bracket(text: &str) -> &str {
    let mut open = 1_usize;
    let end = text.find(|letter: char| {
        match letter {
            '[' => open += 1,
            ']' => open -= 1,
            _ => {}
        }
        open == 0
    });
    end.map_or("", |end| &text[end + 1..])
}

/// Whether a text begins with an assignment to an element, or to a part of it (`.x =`).
fn is_assignment(text: &str) -> bool {
    let part = |letter: char| letter.is_alphanumeric();
    let text = text.strip_prefix('.').map_or(text, |rest| rest.trim_start_matches(part)).trim_start();
    let text = text.strip_prefix(['+', '-', '*', '/']).unwrap_or(text);
    text.starts_with('=') && !text.starts_with("==")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn elements_are_told_from_other_words_and_assignments_from_comparisons() {
        let text = "let old_level = level; // level[0] = 1.0;\n\
                    if (depth[table[at]] == 0.0 && other.depth[0] > 0.0) {\n\
                    \x20   flows[at].x = height[at] + mean[index(cell)];\n\
                    \x20   mean[index(cell)] += 1.0;\n}";
        let said = |buffer| mention(text, buffer);
        assert_eq!([said("level"), said("able"), said("other")], [Mention::Never; 3]);
        assert_eq!([said("depth"), said("table"), said("height")], [Mention::Reads; 3]);
        assert_eq!([said("flows"), said("mean")], [Mention::Writes; 2]);
    }
}
