//! Pieces of a page.

use std::fmt::Display;

use base64::Engine;
use base64::prelude::BASE64_STANDARD;

use weald_picture::Image;

/// Text as it stands between tags and in attributes.
pub(super) fn escape(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for character in text.chars() {
        match character {
            '&' => escaped.push_str("&amp;"),
            '<' => escaped.push_str("&lt;"),
            '>' => escaped.push_str("&gt;"),
            '"' => escaped.push_str("&quot;"),
            // XML knows no other control characters, not even escaped.
            control if control.is_control() && !matches!(control, '\n' | '\t') => escaped.push('\u{fffd}'),
            other => escaped.push(other),
        }
    }
    escaped
}

/// A heading and what stands under it; nothing where there is nothing.
pub(super) fn section(heading: &str, content: &str) -> String {
    if content.is_empty() {
        return String::new();
    }
    format!("<section>\n<h2>{heading}</h2>\n{content}</section>\n")
}

/// A picture or chart with its caption, which is markup.
pub(super) fn figure(class: &str, content: &str, caption: &str) -> String {
    format!("<figure class=\"{class}\">\n{content}\n<figcaption>{caption}</figcaption>\n</figure>\n")
}

/// A picture inside the page.
pub(super) fn picture(image: &Image, alternative: &str) -> String {
    let data = BASE64_STANDARD.encode(image.to_png(&[]));
    format!(
        "<img src=\"data:image/png;base64,{data}\" width=\"{}\" height=\"{}\" alt=\"{}\"/>",
        image.width,
        image.height,
        escape(alternative)
    )
}

/// A cell of a table.
pub(super) enum Cell {
    /// Text, aligned to the left.
    Text(String),
    /// A number, aligned to the right.
    Number(String),
}

impl Cell {
    pub(super) fn text(text: impl Display) -> Self {
        Self::Text(escape(&text.to_string()))
    }

    pub(super) fn number(markup: impl Into<String>) -> Self {
        Self::Number(markup.into())
    }
}

/// A table with a caption; the first cell of each row names the row.
pub(super) fn table(caption: &str, header: &[&str], rows: &[Vec<Cell>]) -> String {
    let head: Vec<_> = header
        .iter()
        .enumerate()
        .map(|(column, name)| {
            let numbers = rows.first().is_some_and(|row| matches!(row.get(column), Some(Cell::Number(_))));
            format!("<th scope=\"col\"{}>{name}</th>", if numbers { " class=\"number\"" } else { "" })
        })
        .collect();
    let body: Vec<_> = rows.iter().map(|row| format!("<tr>{}</tr>\n", cells(row))).collect();
    format!(
        "<div class=\"scroll\">\n<table>\n<caption>{caption}</caption>\n<thead>\n<tr>{}</tr>\n</thead>\n\
         <tbody>\n{}</tbody>\n</table>\n</div>\n",
        head.concat(),
        body.concat()
    )
}

fn cells(row: &[Cell]) -> String {
    let cell = |(column, cell): (usize, &Cell)| match cell {
        Cell::Text(text) if column == 0 => format!("<th scope=\"row\">{text}</th>"),
        Cell::Text(text) => format!("<td>{text}</td>"),
        Cell::Number(number) => format!("<td class=\"number\">{number}</td>"),
    };
    row.iter().enumerate().map(cell).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn text_cannot_leave_its_place() {
        assert_eq!(escape("a<b & \"c\">\u{7}"), "a&lt;b &amp; &quot;c&quot;&gt;\u{fffd}");
    }

    #[test]
    fn a_table_names_its_rows_and_aligns_numbers() {
        let rows = [vec![Cell::text("R & D"), Cell::number("7")]];
        let table = table("caption", &["what", "count"], &rows);
        assert!(table.contains("<th scope=\"row\">R &amp; D</th><td class=\"number\">7</td>"), "{table}");
        assert!(table.contains("<th scope=\"col\" class=\"number\">count</th>"), "{table}");
    }
}
