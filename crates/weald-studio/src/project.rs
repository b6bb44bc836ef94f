//! Projects: a folder with the recipe and the script of all that was done by hand, as text, for `weald run` too.

use std::fs::TryLockError;
use std::path::{Path, PathBuf};

use weald::Error;
use weald::files::{self, File};
use weald::recipe::template::{self, Template};
use weald::recipe::{Overrides, Recipe};

use crate::own_files::OwnFiles;
use crate::state::State;

/// The recipe of a project.
const RECIPE: &str = "landscape.toml";

/// What is written every second while something is not saved, and taken away when it is.
const AUTOSAVE: &str = "autosave.toml";
const SCRIPT: &str = "autosave.edits.jsonl";

/// A text that was typed and cannot run yet.
const TYPED: &str = "typed.toml";

const TAKEN_UP: &str = "what was not saved has been taken up again; save to keep it";

/// Cameras that were kept.
const CAMERAS: &str = "cameras.toml";

/// By which a second studio knows that a project is open.
const LOCK: &str = "open.lock";

/// Endings of elevation models.
pub(crate) const MODELS: [&str; 9] = ["asc", "exr", "hgt", "nc", "npy", "png", "tif", "tiff", "zarr"];

/// Where a landscape is kept.
#[derive(Debug, Default)]
pub(crate) struct Project {
    /// Its folder, once it has one.
    folder: Option<PathBuf>,
    /// The recipe that it was opened from, where that is not in a project.
    recipe: Option<PathBuf>,
    /// Locked as long as the project is open.
    lock: Option<File>,
    /// What was saved last, and what was kept last in case that the program is killed.
    saved: State,
    kept: State,
    /// Where it is kept as long as it has no folder, which is locked too.
    unsaved: Option<(PathBuf, File)>,
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
        let project = Project { saved: State::AS_READ, kept: State::AS_READ, ..Project::default() };
        Self { project, text: template.text.to_owned(), note: None }
    }
}

impl Project {
    /// Opens a project, a recipe or an elevation model.
    pub(crate) fn open(path: &Path) -> Result<Start, Error> {
        let ending =
            path.extension().map(|ending| ending.to_string_lossy().to_lowercase()).unwrap_or_default();
        if files::is_dir(path) && files::is_file(&path.join(RECIPE)) {
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
            let project = Self { recipe, saved: State::AS_READ, kept: State::AS_READ, ..Self::default() };
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
        let (text, note) = match kept_in(&folder, Some(&folder.join(RECIPE))) {
            Some(later) => (later, Some(TAKEN_UP.to_owned())),
            None => (text, None),
        };
        // What was taken up again is not what is saved.
        let saved = if note.is_some() { State::default() } else { State::AS_READ };
        let project =
            Self { folder: Some(folder), lock: Some(lock), saved, kept: State::AS_READ, ..Self::default() };
        Ok(Start { project, text, note })
    }

    fn of_model(path: &Path) -> Result<Start, Error> {
        let path = absolute(path)?;
        files::metadata(&path).map_err(|cause| Error::Run(format!("{}: {cause}", path.display())))?;
        let template = template::find("dem").map_err(Error::Run)?;
        let mut document = crate::document::Document::new("untitled.toml", template.text);
        let file = format!("{:?}", path.display().to_string());
        document.set_landscape_key("from", Some(&file)).map_err(Error::Run)?;
        let text = document.text().to_owned();
        Ok(Start { project: Self::default(), text, note: None })
    }

    /// Name of the recipe's file in messages, from whose folder its paths start.
    pub(crate) fn recipe_name(&self) -> String {
        let kept = self.unsaved.as_ref().map(|(folder, _)| folder.join(AUTOSAVE));
        let file = self.recipe_file().or_else(|| self.recipe.clone()).or(kept);
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

    /// Where cameras are kept, once it has a folder.
    pub(crate) fn cameras_file(&self) -> Option<PathBuf> {
        self.folder.as_ref().map(|folder| folder.join(CAMERAS))
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

    /// Where pictures of many seeds go.
    pub(crate) fn seeds_folder(&self) -> String {
        let folder = self.folder.clone().unwrap_or_else(home);
        folder.join("seeds").display().to_string()
    }

    /// A name for a picture that no file has yet.
    pub(crate) fn picture_file(&self) -> PathBuf {
        let folder = self.folder.clone().unwrap_or_else(home);
        let names = (1..).map(|number| folder.join(format!("picture-{number:03}.png")));
        names.into_iter().find(|name| !files::exists(name)).unwrap_or_else(|| folder.join("picture.png"))
    }

    /// Takes a folder for the project, which no other studio has open.
    pub(crate) fn settle(&mut self, folder: &Path) -> Result<PathBuf, Error> {
        files::create_dir_all(folder)
            .map_err(|cause| Error::Run(format!("{} cannot be made: {cause}", folder.display())))?;
        let folder = absolute(folder)?;
        if self.folder.as_ref() != Some(&folder) {
            self.lock = Some(lock(&folder)?);
        }
        let file = folder.join(RECIPE);
        self.folder = Some(folder);
        Ok(file)
    }

    /// What a studio that was killed has left in a folder of its own, where no other has taken it up.
    pub(crate) fn left_in(folder: PathBuf) -> Option<Start> {
        let lock = lock(&folder).ok()?;
        let text = kept_in(&folder, None)?;
        let project = Self { unsaved: Some((folder, lock)), kept: State::AS_READ, ..Self::default() };
        Some(Start { project, text, note: Some(TAKEN_UP.to_owned()) })
    }

    /// Counts what is done by hand from this number on.
    pub(crate) fn count_from(&mut self, changes: u64) {
        for state in [&mut self.saved, &mut self.kept] {
            if *state == State::AS_READ {
                state.changes = changes;
            }
        }
    }

    /// Notes what was saved: what was kept in case that the program is killed can go.
    pub(crate) fn saved(&mut self, state: State) {
        (self.saved, self.kept) = (state, state);
        if let Some(folder) = &self.folder {
            forget(folder);
        }
        self.forget_unsaved();
    }

    /// Takes away what was kept of a project that has no folder: it is saved, or not wanted.
    pub(crate) fn forget_unsaved(&mut self) {
        if let Some((folder, lock)) = self.unsaved.take() {
            drop(lock);
            // What cannot be taken away is offered once more, which does no harm.
            let _ = files::remove_dir_all(folder);
        }
    }

    /// Whether there is something that is not saved.
    pub(crate) fn is_unsaved(&self, state: State) -> bool {
        state != self.saved
    }

    /// Whether nothing has changed since it was last saved or kept.
    pub(crate) fn is_kept(&self, state: State) -> bool {
        !self.is_unsaved(state) || state == self.kept
    }

    /// The file for what is not saved, where that has changed since it was last kept.
    pub(crate) fn keep(&mut self, own: &OwnFiles, state: State) -> Option<PathBuf> {
        if self.is_kept(state) {
            return None;
        }
        self.kept = state;
        Some(self.kept_folder(own)?.join(AUTOSAVE))
    }

    /// Keeps a text that cannot run yet.
    pub(crate) fn keep_text(&mut self, own: &OwnFiles, state: State, text: &str) -> Result<(), Error> {
        if self.is_kept(state) {
            return Ok(());
        }
        self.kept = state;
        let Some(folder) = self.kept_folder(own) else { return Ok(()) };
        weald::io::write_whole(&folder.join(TYPED), text.as_bytes())
    }

    /// Saves a text that cannot run, and of which nothing has run yet. It is the recipe, unless the folder has one that can run:
    /// beside that it is kept as what is typed. Gives whether it is the recipe.
    pub(crate) fn save_text(&mut self, text: &str, state: State) -> Result<bool, Error> {
        let Some(folder) = self.folder.clone() else { return Ok(false) };
        let recipe = folder.join(RECIPE);
        let is_recipe = Recipe::load(&recipe, &Overrides::default()).is_err();
        if is_recipe {
            weald::io::write_whole(&recipe, text.as_bytes())?;
            self.saved(state);
        } else {
            self.kept = state;
            weald::io::write_whole(&folder.join(TYPED), text.as_bytes())?;
        }
        Ok(is_recipe)
    }

    /// Its folder, or one among those of projects that have none.
    fn kept_folder(&mut self, own: &OwnFiles) -> Option<PathBuf> {
        if let Some(folder) =
            self.folder.clone().or_else(|| self.unsaved.as_ref().map(|(folder, _)| folder.clone()))
        {
            return Some(folder);
        }
        self.unsaved = own.new_folder().and_then(|folder| lock(&folder).ok().map(|lock| (folder, lock)));
        self.unsaved.as_ref().map(|(folder, _)| folder.clone())
    }
}

/// What was kept in a folder, where it is later than the recipe there.
fn kept_in(folder: &Path, recipe: Option<&Path>) -> Option<String> {
    let files =
        [AUTOSAVE, TYPED].map(|name| folder.join(name)).into_iter().filter(|file| files::is_file(file));
    let last = files.max_by_key(|file| written(file))?;
    let is_later = recipe.is_none_or(|recipe| written(&last) > written(recipe));
    is_later.then(|| Recipe::text_of(&last).ok()).flatten()
}

/// Takes away what was kept in a folder: what is not there need not go.
fn forget(folder: &Path) {
    for name in [AUTOSAVE, SCRIPT, TYPED] {
        let _ = files::remove_file(folder.join(name));
    }
}

fn written(path: &Path) -> Option<web_time::SystemTime> {
    files::metadata(path).and_then(|data| data.modified()).ok()
}

fn absolute(path: &Path) -> Result<PathBuf, Error> {
    files::absolute(path).map_err(|cause| Error::Run(format!("{}: {cause}", path.display())))
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
    files::current_dir()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

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
        let (own, mut project) = (OwnFiles::default(), Project::default());
        let file = project.settle(folder.path()).expect("made");
        fs::write(&file, "# saved").expect("written");
        let state = State { revision: 2, changes: 3 };
        let kept = project.keep(&own, state).expect("something is not saved");
        assert_eq!(project.keep(&own, state), None, "it is kept already");
        std::thread::sleep(std::time::Duration::from_millis(20));
        fs::write(kept, "# later").expect("written");
        let typed = State { revision: 3, changes: 3 };
        std::thread::sleep(std::time::Duration::from_millis(20));
        project.keep_text(&own, typed, "# no recipe yet [").expect("written");
        drop(project);
        let mut start = Project::open(folder.path()).expect("open");
        assert_eq!(start.text, "# no recipe yet [");
        assert!(start.note.is_some() && start.project.is_unsaved(State::AS_READ));
        start.project.saved(state);
        assert!(!start.project.is_unsaved(state));
        drop(start);
        assert_eq!(Project::open(folder.path()).expect("open").text, "# saved");
    }

    #[test]
    fn what_is_none_of_ours_is_refused_with_what_would_be() {
        let error = Project::open(Path::new("letter.docx")).expect_err("no landscape").to_string();
        assert!(error.contains("no recipe (.toml)") && error.contains(".tif"), "{error}");
    }
}
