//! The folder of Weald's page in the browser, which any web server serves.

use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::Command;

use wasm_bindgen_cli_support::Bindgen;
use weald::Error;

/// What browsers run.
const TARGET: &str = "wasm32-unknown-unknown";

/// Settings of the build, and the folder that cargo has for it.
const PROFILE: &str = "web";

/// Brotli's greatest effort, and its largest window.
pub const GREATEST_EFFORT: u32 = 11;
const WINDOW: u32 = 24;

/// A file of the page, and its bytes as it is and by Brotli.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PageFile {
    /// Name in the folder.
    pub name: String,
    /// Bytes.
    pub bytes: usize,
    /// Bytes of what a browser loads that knows Brotli.
    pub packed: usize,
}

/// Builds the page into a folder, packed with an effort from 0 to [`GREATEST_EFFORT`], and gives its files.
///
/// # Errors
/// [`Error::Run`] where the compiler fails or a file cannot be written.
pub fn page(into: &Path, effort: u32) -> Result<Vec<PageFile>, Error> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let module = built(&root)?;
    fs::create_dir_all(into).map_err(|cause| Error::write(into, &cause))?;
    let mut bindgen = Bindgen::new();
    let unbound = |cause: &dyn std::fmt::Display| Error::Run(format!("the page's module: {cause}"));
    bindgen.input_path(&module).web(true).map_err(|cause| unbound(&cause))?.typescript(false);
    bindgen.generate(into).map_err(|cause| unbound(&cause))?;
    let sources = root.join("crates/weald-web/page");
    for name in files_of(&sources)? {
        let (from, to) = (sources.join(&name), into.join(&name));
        fs::copy(&from, &to).map_err(|cause| Error::write(&to, &cause))?;
    }
    let is_packed = |name: &String| Path::new(name).extension().is_some_and(|extension| extension == "br");
    let names = files_of(into)?.into_iter().filter(|name| !is_packed(name));
    names.map(|name| packed(into, name, effort)).collect()
}

/// Has cargo build the module.
fn built(root: &Path) -> Result<PathBuf, Error> {
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let mut command = Command::new(cargo);
    command.current_dir(root).args([
        "build",
        "--quiet",
        "-p",
        "weald-web",
        "--target",
        TARGET,
        "--profile",
        PROFILE,
    ]);
    let done = command.status().map_err(|cause| Error::Run(format!("cargo cannot be started: {cause}")))?;
    if !done.success() {
        let remedy = format!("where the target is missing: rustup target add {TARGET}");
        return Err(Error::Run(format!("the page's module cannot be built; {remedy}")));
    }
    let target = std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| root.join("target"), PathBuf::from);
    Ok(target.join(TARGET).join(PROFILE).join("weald_web.wasm"))
}

/// Names of the files in a folder, in order.
fn files_of(folder: &Path) -> Result<Vec<String>, Error> {
    let unlisted = |cause: std::io::Error| Error::Run(format!("{}: {cause}", folder.display()));
    let entries = fs::read_dir(folder).map_err(unlisted)?.flatten().filter(|entry| entry.path().is_file());
    let mut names: Vec<_> = entries.map(|entry| entry.file_name().to_string_lossy().into_owned()).collect();
    names.sort();
    Ok(names)
}

/// Puts a packed copy beside a file.
fn packed(folder: &Path, name: String, effort: u32) -> Result<PageFile, Error> {
    let (path, beside) = (folder.join(&name), folder.join(format!("{name}.br")));
    let unread = |cause: std::io::Error| Error::Run(format!("{}: {cause}", path.display()));
    let bytes = fs::read(&path).map_err(unread)?;
    let mut writer = brotli::CompressorWriter::new(Vec::new(), 1 << 16, effort, WINDOW);
    writer.write_all(&bytes).and_then(|()| writer.flush()).map_err(unread)?;
    let packed = writer.into_inner();
    fs::write(&beside, &packed).map_err(|cause| Error::write(&beside, &cause))?;
    Ok(PageFile { name, bytes: bytes.len(), packed: packed.len() })
}
