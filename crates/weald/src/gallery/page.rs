//! The page that says for each figure what the source shows and what came out here.

use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::Path;

use super::{Figure, FigureOutput, Measured, Plate};

const HEAD: &str =
    "# Gallery\n\nFigures of the publications that Weald implements, made again by `weald gallery`.\n";

/// Starts the section of a figure, so that it can be replaced alone.
const MARK: &str = "<!-- figure ";

/// Name of a plate's file.
pub(super) fn file_name(figure: &Figure, plate: &Plate) -> String {
    format!("{}-{}.png", figure.id, plate.name)
}

/// The sections of an older page, by figure; none where there is no page.
pub(super) fn sections(page: &Path) -> BTreeMap<String, String> {
    let text = std::fs::read_to_string(page).unwrap_or_default();
    let parts = text.split(MARK).skip(1);
    parts
        .filter_map(|part| part.split_once(" -->\n"))
        .map(|(id, text)| (id.to_owned(), text.to_owned()))
        .collect()
}

/// The whole page, in the order of `figures`.
pub(super) fn assemble(figures: &[Figure], sections: &BTreeMap<String, String>) -> String {
    let present = figures.iter().filter_map(|figure| Some((figure.id, sections.get(figure.id)?)));
    let sections = present.map(|(id, section)| format!("\n{MARK}{id} -->\n{}\n", section.trim_end()));
    std::iter::once(HEAD.to_owned()).chain(sections).collect()
}

/// The section of one figure.
pub(super) fn section(figure: &Figure, output: &FigureOutput) -> String {
    let mut text = format!("## {}\n\nSource: {}.\n\n{}\n", figure.title, figure.source, figure.shows);
    for plate in &output.plates {
        let caption = &plate.caption;
        // Writing to a string cannot fail.
        let _ = write!(text, "\n![{caption}]({})\n\n*{caption}*\n", file_name(figure, plate));
    }
    text + &table(&output.measured)
}

fn table(measured: &Measured) -> String {
    let row = |cells: &[String]| format!("| {} |\n", cells.join(" | "));
    let mut text = String::new();
    if !measured.header.is_empty() {
        let rule = vec!["---".to_owned(); measured.header.len()];
        text.extend(["\n".to_owned(), row(&measured.header), row(&rule)]);
        text.extend(measured.rows.iter().map(|cells| row(cells)));
    }
    text.extend(measured.remarks.iter().map(|remark| format!("\n{remark}\n")));
    text
}
