//! The page: its frame, and its sections in their order.
//!
//! It is one file of HTML that is also well-formed XML. It needs nothing beside itself: no script, no font, no
//! network; pictures are PNG in base64, charts are SVG. It follows the reader's choice of a light or a dark page.

mod axis;
mod budgets;
mod figures;
mod ground;
mod html;
mod hypsometry;
mod layers;
mod measures;
mod plot;
mod profiles;
mod slope_area;
mod steps;

use std::path::Path;

use super::Page;
use crate::Finished;
use ground::Ground;
use html::{escape, figure, section};
use weald_core::error::Error;
use weald_picture::{Picture, Relief};

/// The look of the page.
const STYLE: &str = include_str!("page/style.css");

impl Page {
    pub(super) fn html(&self, finished: &Finished<'_>) -> Result<String, Error> {
        let title = escape(&title(finished));
        let ground = Ground::of(finished.landscape, &self.of.0)?;
        let body = [
            self.head(finished, &title)?,
            section("The ground", &hypsometry::charts(&ground)),
            section("Rivers", &self.rivers(&ground)),
            section("Layers", &layers::section(finished.landscape, self)?),
            section("Steps", &steps::table_of(finished)),
            section("Budgets", &budgets::tables(finished)),
            section("Measures", &steps::measures(finished)),
            section("Where it came from", &steps::provenance(finished)),
        ];
        Ok(format!(
            "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\"/>\n\
             <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>\n\
             <meta name=\"color-scheme\" content=\"light dark\"/>\n<title>{title}</title>\n<style>\n{STYLE}</style>\n\
             </head>\n<body>\n<main>\n{}</main>\n</body>\n</html>\n",
            body.concat()
        ))
    }

    fn rivers(&self, ground: &Ground) -> String {
        profiles::charts(ground, self.profiles as usize, &slope_area::chart(ground))
    }

    /// The title, what the land is in one line, and its picture.
    fn head(&self, finished: &Finished<'_>, title: &str) -> Result<String, Error> {
        let landscape = finished.landscape;
        let relief = Relief { of: self.of.clone(), width: Some(self.width), ..Relief::default() };
        let picture = html::picture(&relief.render(landscape)?, &format!("Shaded relief of {title}"));
        let shown = "Shaded relief with contours; lakes and rivers where the run has water.";
        Ok(format!(
            "<header>\n<h1>{title}</h1>\n<p class=\"lead\">{}</p>\n</header>\n{}",
            escape(&ground::in_words(landscape, &self.of.0)?),
            figure("wide", &picture, shown)
        ))
    }
}

/// The name of the recipe without its folder and extension.
fn title(finished: &Finished<'_>) -> String {
    let stem = Path::new(finished.recipe).file_stem().and_then(|stem| stem.to_str());
    stem.unwrap_or(finished.recipe).to_owned()
}
