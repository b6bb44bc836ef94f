//! `weald new`.

use std::path::Path;

use weald::io::write_whole;
use weald::recipe::template;

use crate::failure::Failure;
use crate::stdout;

pub(crate) fn new(name: &Path, template: &str) -> Result<(), Failure> {
    let template = template::find(template).map_err(Failure::usage)?;
    let path = if name.extension().is_some_and(|extension| extension == "toml") {
        name.to_owned()
    } else {
        name.with_added_extension("toml")
    };
    let shown = path.display();
    if path.exists() {
        return Err(Failure::run(format!("{shown} exists already; choose another name")));
    }
    write_whole(&path, template.text.as_bytes())?;
    stdout::print(&format!("{shown}: {}\nrun it with: weald run {shown}\n", template.summary))
}
