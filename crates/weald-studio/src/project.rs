//! Projects: a folder with the recipe and the script of all that was done by hand, as text, for `weald run` too.

use std::fs::{self, File, TryLockError};
use std::path::{Path, PathBuf};

use weald::Error;
use weald::recipe::Recipe;
use weald::recipe::template::{self, Template};

/// The recipe of a project.
const RECIPE: &str = "landscape.toml";

/// What is written every second while something is not saved, and taken away when it is.
const AUTOSAVE: &str = "autosave.toml";

/// By which a second studio knows that a project is open.
const LOCK: &str = "open.lock";

/// Most names in the list of what was open of late.
const MOST_RECENT: usize = 12;

/// Endings of elevation models.
const MODELS: [&str; 9] = ["asc", "exr", "hgt", "nc", "npy", "png", "tif", "tiff", "zarr"];

/// Where a landscape is kept.
#[derive(Debug, Default)]
pub(crate) struct Project {
    /// Its folder, once it has one.
    folder: Option<PathBuf>,
    /// The recipe that it was opened from, where that is not in a project.
    recipe: Option<PathBuf>,
    /// Held as long as the project is open.
    lock: Option<File>,
    saved_text: String,
    saved_changes: u64,
    autosaved_changes: u64,
}

/// A landscape to begin with.
#[derive(Debug)]
pub(crate) struct Start {
    pub(crate) project: Project,
    pub(crate) text: String,
    /// Something to be said about it.
    pub(crate) note: Option<String>,
}

impl Start {
    /// A template, which is kept nowhere yet.
    pub(crate) fn of_template(template: &Template) -> Self {
        let text = template.text.to_owned();
        Self { project: Project { saved_text: text.clone(), ..Project::default() }, text, note: None }
    }
}

impl Project {
    /// Opens a project, a recipe or an elevation model.
    pub(crate) fn open(path: &Path) -> Result<Start, Error> {
        let ending =
            path.extension().map(|ending| ending.to_string_lossy().to_lowercase()).unwrap_or_default();
        if path.is_dir() && path.join(RECIPE).is_file() {
            return Self::open_folder(path);
        }
        if path.file_name().is_some_and(|name| name == RECIPE)
            && let Some(folder) = path.parent()
        {
            return Self::open_folder(folder);
        }
        if ending == "toml" {
            let text = Recipe::text_of(path)?;
            let recipe = Some(absolute(path)?);
            let project = Self { recipe, saved_text: text.clone(), ..Self::default() };
            return Ok(Start { project, text, note: None });
        }
        if MODELS.contains(&ending.as_str()) {
            return Self::of_model(path);
        }
        let message = format!(
            "{} is no recipe (.toml), no elevation model (.{}) and no folder with a {RECIPE}",
            path.display(),
            MODELS.join(", .")
        );
        Err(Error::Run(message))
    }

    fn open_folder(folder: &Path) -> Result<Start, Error> {
        let folder = absolute(folder)?;
        let lock = lock(&folder)?;
        let text = Recipe::text_of(&folder.join(RECIPE))?;
        let kept = folder.join(AUTOSAVE);
        let (text, note) = match Recipe::text_of(&kept) {
            Ok(later) if is_later(&kept, &folder.join(RECIPE)) => {
                (later, Some("what was not saved has been taken up again; save to keep it".to_owned()))
            }
            _ => (text, None),
        };
        // What was taken up again is not what is saved.
        let saved_text = if note.is_some() { String::new() } else { text.clone() };
        let project = Self { folder: Some(folder), lock: Some(lock), saved_text, ..Self::default() };
        Ok(Start { project, text, note })
    }

    fn of_model(path: &Path) -> Result<Start, Error> {
        let path = absolute(path)?;
        fs::metadata(&path).map_err(|cause| Error::Run(format!("{}: {cause}", path.display())))?;
        let template = template::find("dem").map_err(Error::Run)?;
        let mut document = crate::document::Document::new("untitled.toml", template.text);
        let file = format!("{:?}", path.display().to_string());
        document.set_landscape_key("from", Some(&file)).map_err(Error::Run)?;
        let text = document.text().to_owned();
        Ok(Start { project: Self::default(), text, note: None })
    }

    /// Name of the recipe's file in messages, from whose folder its paths start.
    pub(crate) fn recipe_name(&self) -> String {
        let file = self.recipe_file().or_else(|| self.recipe.clone());
        file.map_or_else(|| "untitled.toml".to_owned(), |file| file.display().to_string())
    }

    /// What the title of the window says.
    pub(crate) fn title(&self) -> String {
        let place = self.folder.as_ref().or(self.recipe.as_ref());
        let name = place.and_then(|place| place.file_name()).map(|name| name.to_string_lossy().into_owned());
        name.unwrap_or_else(|| "untitled".to_owned())
    }

    /// The recipe of the project, once it has a folder.
    pub(crate) fn recipe_file(&self) -> Option<PathBuf> {
        self.folder.as_ref().map(|folder| folder.join(RECIPE))
    }

    /// A folder that a project without one could have.
    pub(crate) fn suggested(&self) -> String {
        let beside =
            self.folder.clone().or_else(|| self.recipe.as_ref().map(|recipe| recipe.with_extension("")));
        let folder = beside.unwrap_or_else(|| home().join("landscape"));
        folder.display().to_string()
    }

    /// Where its outputs go.
    pub(crate) fn export_folder(&self) -> String {
        let folder = self.folder.clone().unwrap_or_else(home);
        folder.join("out").display().to_string()
    }

    /// A name for a picture that no file has yet.
    pub(crate) fn picture_file(&self) -> PathBuf {
        let folder = self.folder.clone().unwrap_or_else(home);
        let names = (1..).map(|number| folder.join(format!("picture-{number:03}.png")));
        names.into_iter().find(|name| !name.exists()).unwrap_or_else(|| folder.join("picture.png"))
    }

    /// Takes a folder for the project, which no other studio has open.
    pub(crate) fn settle(&mut self, folder: &Path) -> Result<PathBuf, Error> {
        fs::create_dir_all(folder)
            .map_err(|cause| Error::Run(format!("{} cannot be made: {cause}", folder.display())))?;
        let folder = absolute(folder)?;
        if self.folder.as_ref() != Some(&folder) {
            self.lock = Some(lock(&folder)?);
        }
        let file = folder.join(RECIPE);
        self.folder = Some(folder);
        Ok(file)
    }

    /// Notes that all was saved, at so many changes by hand.
    pub(crate) fn saved(&mut self, text: &str, changes: u64) {
        text.clone_into(&mut self.saved_text);
        (self.saved_changes, self.autosaved_changes) = (changes, changes);
        if let Some(folder) = &self.folder {
            // What is not there need not go.
            for name in [AUTOSAVE, "autosave.edits.jsonl"] {
                let _ = fs::remove_file(folder.join(name));
            }
        }
    }

    /// Whether there is something that is not saved.
    pub(crate) fn is_unsaved(&self, text: &str, changes: u64) -> bool {
        text != self.saved_text || changes != self.saved_changes
    }

    /// The file for what is not saved, where that has changed since it was last written.
    pub(crate) fn autosave(&mut self, text: &str, changes: u64) -> Option<PathBuf> {
        let folder = self.folder.as_ref()?;
        if !self.is_unsaved(text, changes) || changes == self.autosaved_changes {
            return None;
        }
        self.autosaved_changes = changes;
        Some(folder.join(AUTOSAVE))
    }
}

fn absolute(path: &Path) -> Result<PathBuf, Error> {
    std::path::absolute(path).map_err(|cause| Error::Run(format!("{}: {cause}", path.display())))
}

fn is_later(one: &Path, other: &Path) -> bool {
    let written = |path: &Path| fs::metadata(path).and_then(|data| data.modified()).ok();
    written(one) > written(other)
}

fn lock(folder: &Path) -> Result<File, Error> {
    let path = folder.join(LOCK);
    let failed =
        |cause: std::io::Error| Error::Run(format!("{} cannot be locked: {cause}", folder.display()));
    let file = File::create(&path).map_err(failed)?;
    match file.try_lock() {
        Ok(()) => Ok(file),
        Err(TryLockError::WouldBlock) => {
            let message =
                format!("{} is open in another studio; close it there, or open a copy", folder.display());
            Err(Error::Run(message))
        }
        Err(TryLockError::Error(cause)) => Err(failed(cause)),
    }
}

fn home() -> PathBuf {
    std::env::current_dir().unwrap_or_default()
}

fn recent_file() -> Option<PathBuf> {
    Some(dirs::state_dir().or_else(dirs::data_local_dir)?.join("weald").join("recent.txt"))
}

/// What was open of late and is still there, the last first.
pub(crate) fn recent() -> Vec<PathBuf> {
    let text = recent_file().and_then(|file| fs::read_to_string(file).ok()).unwrap_or_default();
    text.lines().map(PathBuf::from).filter(|path| path.exists()).take(MOST_RECENT).collect()
}

/// Remembers that this was open; a list that cannot be written is none.
pub(crate) fn remember(path: &Path) {
    let (Some(file), Ok(path)) = (recent_file(), absolute(path)) else { return };
    let others = recent().into_iter().filter(|other| *other != path);
    let all: Vec<_> = std::iter::once(path.clone()).chain(others).take(MOST_RECENT).collect();
    let text = all.iter().map(|path| path.display().to_string()).collect::<Vec<_>>().join("\n");
    let written = file.parent().map_or(Ok(()), fs::create_dir_all).and_then(|()| fs::write(&file, text));
    drop(written);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_project_is_open_once_and_free_again_when_it_is_closed() {
        let folder = tempfile::tempdir().expect("a folder");
        fs::write(folder.path().join(RECIPE), template::TEMPLATES[0].text).expect("written");
        let first = Project::open(folder.path()).expect("open");
        let second = Project::open(folder.path()).expect_err("it is open");
        assert!(second.to_string().contains("is open in another studio"), "{second}");
        drop(first);
        Project::open(&folder.path().join(RECIPE)).expect("free again");
    }

    #[test]
    fn what_was_not_saved_is_taken_up_again_and_goes_when_it_is_saved() {
        let folder = tempfile::tempdir().expect("a folder");
        let mut project = Project::default();
        let file = project.settle(folder.path()).expect("made");
        fs::write(&file, "# saved").expect("written");
        let kept = project.autosave("# later", 3).expect("something is not saved");
        assert_eq!(project.autosave("# later", 3), None, "it is written already");
        std::thread::sleep(std::time::Duration::from_millis(20));
        fs::write(kept, "# later").expect("written");
        drop(project);
        let mut start = Project::open(folder.path()).expect("open");
        assert_eq!(start.text, "# later");
        assert!(start.note.is_some() && start.project.is_unsaved("# later", 0));
        start.project.saved("# later", 3);
        assert!(!start.project.is_unsaved("# later", 3));
        drop(start);
        assert_eq!(Project::open(folder.path()).expect("open").text, "# saved");
    }

    #[test]
    fn what_is_none_of_ours_is_refused_with_what_would_be() {
        let error = Project::open(Path::new("letter.docx")).expect_err("no landscape").to_string();
        assert!(error.contains("no recipe (.toml)") && error.contains(".tif"), "{error}");
    }
}
