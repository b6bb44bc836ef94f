//! `weald report`.

use std::path::Path;

use weald::recipe::{Options, Recipe};

use super::run::{default_folder, execute};
use crate::arguments::ReportArguments;
use crate::failure::Failure;
use crate::stdout;

pub(crate) fn report(arguments: &ReportArguments) -> Result<(), Failure> {
    let page = arguments.out.clone().unwrap_or_else(|| default_folder(&arguments.recipe).join("report.html"));
    let is_page = page.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("html"));
    let (Some(file), true) = (page.file_name(), is_page) else {
        return Err(Failure::usage(format!("--out is {}, but a page is an .html file", page.display())));
    };
    let recipe =
        Recipe::load(&arguments.recipe, &arguments.changes.overrides())?.for_page(Path::new(file))?;
    let folder = page.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let options = Options { report: false, ..Options::into_folder(folder) };
    execute(&recipe, options, &arguments.running)?;
    if arguments.running.quiet { Ok(()) } else { stdout::print(&format!("{}\n", page.display())) }
}
