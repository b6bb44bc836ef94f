//! A studio in a page: files arrive and are handed out, and what is done is shared as a link.

use std::io::{Cursor, Write};
use std::path::{Path, PathBuf};

use weald::Error;
use weald::files;
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, ZipWriter};

use super::Studio;
use crate::work::Task;

/// Where what is to be shared is written; none of the folders that a page keeps.
const SHARED: &str = "/shared/landscape.toml";

impl Studio {
    /// Whether it is in a page.
    pub(crate) fn is_hosted(&self) -> bool {
        self.on_page.host.is_some()
    }

    /// Takes what has come, and gives out what is ready.
    pub(crate) fn tend_host(&mut self) {
        let Some(host) = self.on_page.host.clone() else { return };
        for arrived in host.arrived() {
            match arrived {
                Ok(path) => self.open(&path),
                Err(message) => self.say(message),
            }
        }
        if let Some((recipe, script)) = self.on_page.shares.then(shared).flatten() {
            self.on_page.shares = false;
            host.share(&recipe, &script);
        }
    }

    /// Lets the user choose a file.
    pub(crate) fn choose_file(&self) {
        if let Some(host) = &self.on_page.host {
            host.choose();
        }
    }

    /// Makes a link of what was done.
    pub(crate) fn share(&mut self) {
        if !self.document.diagnostics().is_empty() {
            return self.say("the recipe cannot run as it is: what is wrong is told beside it");
        }
        self.on_page.shares = true;
        self.work.ask(Task::Save(PathBuf::from(SHARED)));
    }

    /// Hands the files of a folder out as one, and removes them.
    pub(crate) fn hand_out(&self, folder: &Path) -> Result<(), Error> {
        let Some(host) = &self.on_page.host else { return Ok(()) };
        let name = folder.file_name().map_or_else(|| "landscape".into(), |name| name.to_string_lossy());
        let packed = zipped(folder).map_err(|cause| Error::Run(format!("{name}.zip: {cause}")))?;
        host.hand_out(&format!("{name}.zip"), &packed);
        files::remove_dir_all(folder).map_err(|cause| Error::write(folder, &cause))
    }
}

/// The recipe and the script, once the worker has written both.
fn shared() -> Option<(String, String)> {
    let recipe = files::read_to_string(SHARED).ok()?;
    let script = files::read_to_string(Path::new(SHARED).with_extension("edits.jsonl")).unwrap_or_default();
    // What is not there need not go.
    let _ = files::remove_dir_all(Path::new(SHARED).parent()?);
    Some((recipe, script))
}

/// All files of a folder, most of which are packed already.
fn zipped(folder: &Path) -> std::io::Result<Vec<u8>> {
    let mut zip = ZipWriter::new(Cursor::new(Vec::new()));
    let options = SimpleFileOptions::default().compression_method(CompressionMethod::Stored);
    let mut folders = vec![folder.to_owned()];
    while let Some(inner) = folders.pop() {
        for entry in files::read_dir(&inner)? {
            let path = entry?.path();
            if files::is_dir(&path) {
                folders.push(path);
                continue;
            }
            let name = path.strip_prefix(folder).unwrap_or(&path).to_string_lossy().into_owned();
            zip.start_file(name, options)?;
            zip.write_all(&files::read(&path)?)?;
        }
    }
    Ok(zip.finish()?.into_inner())
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Read;

    #[test]
    fn a_folder_is_packed_with_all_that_is_in_it() {
        let folder = tempfile::tempdir().expect("a folder");
        std::fs::create_dir_all(folder.path().join("tiles/0")).expect("made");
        std::fs::write(folder.path().join("report.json"), "{}").expect("written");
        std::fs::write(folder.path().join("tiles/0/1.raw"), [1, 2, 3]).expect("written");
        let packed = zipped(folder.path()).expect("packed");
        let mut zip = zip::ZipArchive::new(Cursor::new(packed)).expect("an archive");
        let mut names: Vec<_> = zip.file_names().map(|name| name.expect("a name").into_owned()).collect();
        names.sort();
        assert_eq!(names, ["report.json", "tiles/0/1.raw"]);
        let mut bytes = Vec::new();
        zip.by_name("tiles/0/1.raw").expect("there").read_to_end(&mut bytes).expect("whole");
        assert_eq!(bytes, [1, 2, 3]);
    }
}
