//! One page that shows a run: pictures, layers, statistics of the ground, rivers, budgets, and where it came from.
//!
//! A build without the feature `report` knows the export and says that it cannot make it.

#[cfg(feature = "report")]
mod page;

use std::path::Path;

use super::{Export, ExportEntry, Finished};
use weald_core::error::Error;
use weald_core::parameter::LayerName;
use weald_core::parameters;
use weald_io::Part;

/// The export's declaration.
pub const ENTRY: ExportEntry = ExportEntry::of::<Page>(
    "report",
    &["html"],
    "one self-contained HTML page: pictures, layers, statistics of the ground, rivers, budgets",
    "WHATWG HTML; W3C SVG 1.1",
);

parameters! {
    /// A page about a run.
    pub struct Page {
        /// Layer of heights in metres.
        of: LayerName = LayerName::of("height");
        /// Width of the relief picture; maps of layers are drawn at a third of it.
        width: u32 = 1080, range 240..=4096, unit "px";
        /// Whether the page has a map of each layer.
        maps: bool = true;
        /// How many of the longest rivers have their profiles drawn.
        profiles: u32 = 5, range 1..=8;
    }
}

impl Export for Page {
    fn reads(&self) -> Vec<String> {
        vec![self.of.0.clone()]
    }

    /// A relief and maps, four of them at a time.
    fn working_bytes(&self, cells: u64) -> u64 {
        (24 << 20) + 80 * cells
    }

    #[cfg(not(feature = "report"))]
    fn left_out(&self, _: &Path) -> Option<String> {
        Some(weald_core::error::left_out("the HTML report", "report"))
    }

    #[cfg(feature = "report")]
    fn parts(&self, finished: &Finished<'_>, _: &Path) -> Result<Vec<Part>, Error> {
        Ok(vec![Part::own(self.html(finished)?.into_bytes())])
    }

    #[cfg(not(feature = "report"))]
    fn parts(&self, _: &Finished<'_>, file: &Path) -> Result<Vec<Part>, Error> {
        Err(Error::Run(self.left_out(file).unwrap_or_default()))
    }
}

#[cfg(all(test, not(feature = "report")))]
mod tests {
    use super::*;

    #[test]
    fn a_build_without_the_page_names_its_feature() {
        let message = Page::default().left_out(Path::new("page.html")).expect("is left out");
        assert_eq!(message, "the HTML report is not part of this build: build with the feature `report`");
    }
}
