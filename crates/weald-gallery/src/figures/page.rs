//! The page that says for each figure what the source shows and what came out here; above them all claims.

use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::Path;

use super::{Claim, Figure, FigureOutput, Measured};

const HEAD: &str = "# Gallery\n\nFigures of the publications that Weald implements, made again by `weald gallery`. \
    Each verdict follows from numbers of the run that made the figure: **shown**, **shown under a condition**, or \
    **not reproduced**. Fig. 1 of Han 2015 is a sketch of the pipes between cells; it shows no result and is not \
    made again.\n";

/// Starts the section of a figure, so that it can be replaced alone.
const MARK: &str = "<!-- figure ";

/// Starts the claims of a section: a table of claim, verdict and measure that ends with an empty line.
const CLAIMS: &str = "\n| claim | verdict | measured |\n| --- | --- | --- |\n";

/// File of a plate or a film of this name.
pub(super) fn file_name(figure: &Figure, name: &str) -> String {
    format!("{}-{name}.png", figure.id)
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

/// The page of `figures` in which the sections of the page `newer` stand for those of the page `older`.
pub fn merged_page(figures: &[Figure], older: &Path, newer: &Path) -> String {
    let mut merged = sections(older);
    merged.extend(sections(newer));
    assemble(figures, &merged)
}

/// The whole page, in the order of `figures`.
pub(super) fn assemble(figures: &[Figure], sections: &BTreeMap<String, String>) -> String {
    let present: Vec<(&Figure, &String)> =
        figures.iter().filter_map(|figure| Some((figure, sections.get(figure.id)?))).collect();
    let mut text = HEAD.to_owned() + &summary(&present);
    for (Figure { id, .. }, section) in present {
        // Writing to a string cannot fail.
        let _ = write!(text, "\n{MARK}{id} -->\n{}\n", section.trim_end());
    }
    text
}

/// All claims with their verdicts, each with a way to its figure.
fn summary(present: &[(&Figure, &String)]) -> String {
    let mut text = "\n| figure | claim | verdict |\n| --- | --- | --- |\n".to_owned();
    for (figure, section) in present {
        let claims = section.split_once(CLAIMS).map_or("", |(_, claims)| claims);
        for line in claims.lines().take_while(|line| !line.is_empty()) {
            let mut cells = line.trim_matches('|').split(" | ");
            let (claim, verdict) = (cells.next().unwrap_or_default(), cells.next().unwrap_or_default());
            let _ = writeln!(text, "| [{0}](#{0}) | {1} | {verdict} |", figure.id, claim.trim());
        }
    }
    text
}

/// The section of one figure.
pub(super) fn section(figure: &Figure, output: &FigureOutput) -> String {
    let Figure { id, title, source, shows, .. } = figure;
    let mut text = format!("<a id=\"{id}\"></a>\n\n## {title}\n\nSource: {source}.\n\n{shows}\n");
    let plates = output.plates.iter().map(|plate| (plate.name, &plate.caption));
    for (name, caption) in plates.chain(output.films.iter().map(|film| (film.name, &film.caption))) {
        let _ = write!(text, "\n![{caption}]({})\n\n*{caption}*\n", file_name(figure, name));
    }
    text + &table(&output.measured) + &claims(&output.claims)
}

fn row(cells: &[String]) -> String {
    // A bar would end the cell.
    let cells: Vec<String> = cells.iter().map(|cell| cell.replace('|', "\\|")).collect();
    format!("| {} |\n", cells.join(" | "))
}

fn table(measured: &Measured) -> String {
    let mut text = String::new();
    if !measured.header.is_empty() {
        let rule = vec!["---".to_owned(); measured.header.len()];
        text.extend(["\n".to_owned(), row(&measured.header), row(&rule)]);
        text.extend(measured.rows.iter().map(|cells| row(cells)));
    }
    text.extend(measured.remarks.iter().map(|remark| format!("\n{remark}\n")));
    text
}

fn claims(claims: &[Claim]) -> String {
    if claims.is_empty() {
        return String::new();
    }
    let rows = claims
        .iter()
        .map(|claim| row(&[claim.says.clone(), claim.verdict.to_string(), claim.measure.clone()]));
    CLAIMS.to_owned() + &rows.collect::<String>()
}
