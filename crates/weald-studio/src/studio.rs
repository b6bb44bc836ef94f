//! What the parts of the window share: the recipe, the work on it, and how it is looked at.

mod camera;
mod changes;
mod hosted;
mod obey;
mod views;

use std::path::{Path, PathBuf};
use web_time::Instant;

use eframe::egui::Context;
use weald::engine::Engine;
use weald::picture::Camera;
use weald::recipe::source::Value;
use weald::recipe::template::TEMPLATES;
use weald::{Error, Field};

use crate::brushes::{Settings, Stroke};
#[cfg(not(target_arch = "wasm32"))]
use crate::dialogs;
use crate::dialogs::{Chooser, Dialog};
use crate::document::Document;
use crate::drawing::{Drawing, allow_slow_clicks};
use crate::looks::Looks;
use crate::navigation::Mode;
use crate::on_page::OnPage;
use crate::options::Options;
use crate::own_files::OwnFiles;
use crate::pick::Place;
use crate::presets::Outputs;
use crate::project::{Project, Start};
use crate::rays::Rays;
use crate::section::Measuring;
use crate::state::{Did, State};
use crate::viewport::{Viewport, WindowDevice, device_of};
#[cfg(not(target_arch = "wasm32"))]
use crate::work::Thread;
use crate::work::{Phase, Status, Task, Work};

/// What the left side shows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum Left {
    /// The recipe as cards.
    #[default]
    Cards,
    /// The recipe as text.
    Text,
}

/// What lies below the landscape on a narrow screen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Part {
    /// The recipe.
    Recipe,
    /// The simulation, brushes, looks and the history.
    Simulation,
}

/// What is asked for in a window of its own.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Asked {
    /// A template, or something to open.
    Start,
    /// A file to open.
    Open(String),
    /// A folder to save in.
    SaveAs(String),
    /// A folder to export to.
    Export(String),
    /// Whether to leave what is not saved.
    Leave,
}

/// Revision of the text, and place of the preset.
pub(crate) type OfText = (u64, Option<usize>);

/// Which outputs an export writes.
#[derive(Clone, Debug, Default)]
pub(crate) struct Exporting {
    /// Place among the presets; those of the recipe where none is chosen.
    pub(crate) preset: Option<usize>,
    /// What is written, with what it follows from.
    pub(crate) known: Option<(OfText, Result<Outputs, String>)>,
}

/// What is asked of a sheet of many seeds.
#[derive(Clone, Debug)]
pub(crate) struct Sheet {
    pub(crate) first: u64,
    pub(crate) count: u64,
    pub(crate) folder: String,
}

/// What is typed to find a command, and which of those found is chosen.
#[derive(Clone, Debug, Default)]
pub(crate) struct Palette {
    pub(crate) wanted: String,
    pub(crate) chosen: usize,
}

/// The studio.
pub struct Studio {
    pub(crate) document: Document,
    pub(crate) project: Project,
    pub(crate) work: Work,
    pub(crate) status: Status,
    pub(crate) viewport: Option<Box<dyn Drawing>>,
    pub(crate) camera: Option<Camera>,
    /// The middle of the landscape that the camera was placed for.
    pub(crate) framed: Option<[f32; 2]>,
    pub(crate) mode: Mode,
    pub(crate) looks: Looks,
    /// Grows with every change of the looks.
    pub(crate) looks_number: u64,
    pub(crate) brush: Settings,
    pub(crate) stroke: Option<Stroke>,
    pub(crate) strokes: u64,
    /// How hard a pen is pressed, 0 to 1, where one that tells it touches.
    pub(crate) pressure: Option<f64>,
    pub(crate) pointed: Option<Place>,
    pub(crate) selected: Option<usize>,
    /// The step whose result gets another name, and what is typed for it.
    pub(crate) renaming: Option<(usize, String)>,
    pub(crate) left: Left,
    /// What lies below the landscape on a narrow screen.
    pub(crate) part: Option<Part>,
    pub(crate) measuring: Measuring,
    /// Share of the viewport's width that what is pinned takes.
    pub(crate) wipe: f32,
    /// Whether the camera goes round by itself.
    pub(crate) turns: bool,
    /// Cameras that were kept, and the name that is typed for the next.
    pub(crate) cameras: Vec<(String, Camera)>,
    pub(crate) camera_name: String,
    pub(crate) asked: Option<Asked>,
    pub(crate) palette: Option<Palette>,
    pub(crate) search: String,
    /// What is typed to name a moment.
    pub(crate) name: String,
    /// Keys of the step that is held that were changed while it ran.
    pub(crate) set: Vec<(String, Value)>,
    pub(crate) recent: Vec<PathBuf>,
    pub(crate) own: OwnFiles,
    pub(crate) tour: Option<usize>,
    /// What the window is called.
    pub(crate) title: String,
    /// The sheet of many seeds, where it is open.
    pub(crate) sheet: Option<Sheet>,
    pub(crate) chooser: Option<Chooser>,
    /// A dialog of the system that is open.
    pub(crate) dialog: Option<Dialog>,
    /// Which outputs an export writes.
    pub(crate) exporting: Exporting,
    /// Something said to the user, and when.
    pub(crate) message: Option<(String, Instant)>,
    /// Revision of the document that was opened last.
    pub(crate) opened: u64,
    /// Revision that was there in the last frame, and when it became another.
    pub(crate) seen: u64,
    pub(crate) changed_at: f64,
    pub(crate) on_page: OnPage,
    keeps_edits: bool,
    /// What was done, in the order of undoing.
    done: Vec<Did>,
    undone: Vec<Did>,
    /// What could be redone before the last thing was done, in case that it is refused.
    undone_before: Vec<Did>,
    /// How much that was refused is known of.
    noted_refused: u64,
    engine: Engine,
    pub(crate) is_closing: bool,
    /// What was saved and exported last, as far as the user was told.
    pub(crate) noted_saved: Option<(PathBuf, State)>,
    /// Number of the task that saves, of those that were asked.
    pub(crate) saving: u64,
    pub(crate) kept_at: Instant,
    pub(crate) noted_export: Option<PathBuf>,
}

impl Studio {
    /// A studio in the window of a program, with what its options say.
    ///
    /// # Errors
    /// [`Error::Device`] where the window's device cannot draw landscapes, those of opening what it begins with.
    pub fn of(context: &eframe::CreationContext<'_>, options: Options) -> Result<Self, Error> {
        Self::new(&context.egui_ctx, device_of(context), options)
    }

    /// What the thread that works has shown last.
    pub fn status(&self) -> &Status {
        &self.status
    }

    /// Shows the controls around the landscape.
    pub fn show_controls(&mut self) {
        self.on_page.is_bare = false;
    }

    /// What was said to the user last.
    #[doc(hidden)]
    pub fn message(&self) -> Option<&str> {
        self.message.as_ref().map(|(message, _)| message.as_str())
    }

    /// The text of the recipe.
    #[doc(hidden)]
    pub fn text(&self) -> &str {
        self.document.text()
    }

    /// Elevations of the last whole landscape, and whether nothing was done since.
    #[doc(hidden)]
    pub fn heights(&self) -> Option<(&Field, bool)> {
        let shown = self.status.shown.as_ref()?;
        Some((shown.landscape.field("height").ok()?, shown.changes == self.status.changes))
    }

    /// Whether all that the hand did so far has been done, and is seen in the status.
    #[doc(hidden)]
    pub fn is_settled(&self) -> bool {
        let runs = self.document.diagnostics().is_empty() && self.opened != self.document.revision();
        let waits = self.stroke.is_some() || runs || self.work.asked() != self.status.done;
        self.status.phase == Phase::Idle && !waits
    }

    /// Whether what is not saved would be there if the program were killed.
    #[doc(hidden)]
    pub fn is_kept(&self) -> bool {
        self.is_settled() && self.project.is_kept(self.state())
    }

    /// Whether the landscape that there is now is drawn, as finely as it will be.
    #[doc(hidden)]
    pub fn is_drawn(&self) -> bool {
        let shown = self.status.shown.as_ref().map(|shown| (shown.number, self.looks_number));
        self.viewport.as_ref().is_some_and(|viewport| shown.is_some() && viewport.is_drawn(shown))
    }

    /// Whether something is pinned and drawn.
    #[doc(hidden)]
    pub fn is_compared(&self) -> bool {
        self.viewport.as_ref().is_some_and(|viewport| viewport.pinned_texture().is_some())
    }

    /// What stands against drawing it.
    #[doc(hidden)]
    pub fn drawing_error(&self) -> Option<String> {
        self.viewport.as_ref()?.error()
    }

    fn new(context: &Context, window: Option<&WindowDevice>, options: Options) -> Result<Self, Error> {
        let own = OwnFiles::new(options.own_files);
        let what = options.what.as_deref();
        let work = match options.remote {
            Some(remote) => Work::Remote(remote),
            #[cfg(not(target_arch = "wasm32"))]
            None => {
                let told = context.clone();
                Work::Thread(Thread::new(move || told.request_repaint())?)
            }
            #[cfg(target_arch = "wasm32")]
            None => return Err(Error::Run("a page has a worker".to_owned())),
        };
        let on_device = window.map(|window| Viewport::new((window, options.gpu), context, options.finest));
        let viewport: Box<dyn Drawing> = match on_device.transpose()? {
            Some(viewport) => Box::new(viewport),
            None => Box::new(Rays::new(context, options.finest)),
        };
        if viewport.is_software() {
            allow_slow_clicks(context);
        }
        let start = what.map(Project::open).transpose()?;
        let start = start.or_else(|| own.left_behind().into_iter().find_map(Project::left_in));
        let asked = (start.is_none() && !options.plays).then_some(Asked::Start);
        let start = start.unwrap_or_else(|| Start::of_template(&TEMPLATES[0]));
        let engine = viewport.engine();
        let mut studio = Self {
            document: Document::new(start.project.recipe_name(), start.text),
            project: start.project,
            work,
            status: Status::default(),
            viewport: Some(viewport),
            camera: None,
            framed: None,
            mode: Mode::default(),
            looks: Looks::default(),
            looks_number: 1,
            brush: Settings::default(),
            stroke: None,
            strokes: 0,
            pressure: None,
            pointed: None,
            selected: None,
            renaming: None,
            left: Left::default(),
            part: None,
            measuring: Measuring::default(),
            wipe: 0.5,
            turns: false,
            cameras: Vec::new(),
            camera_name: String::new(),
            asked,
            palette: None,
            search: String::new(),
            name: String::new(),
            set: Vec::new(),
            recent: own.recent(),
            own,
            tour: None,
            sheet: None,
            #[cfg(not(target_arch = "wasm32"))]
            chooser: options.chooser.or_else(|| Some(dialogs::of_system())),
            // A page has a way of its own to choose files.
            #[cfg(target_arch = "wasm32")]
            chooser: options.chooser,
            dialog: None,
            exporting: Exporting::default(),
            message: None,
            opened: 0,
            seen: 0,
            title: String::new(),
            changed_at: 0.0,
            on_page: OnPage::new(options.host, options.plays),
            keeps_edits: false,
            done: Vec::new(),
            undone: Vec::new(),
            undone_before: Vec::new(),
            noted_refused: 0,
            engine,
            is_closing: false,
            noted_saved: None,
            saving: 0,
            kept_at: Instant::now(),
            noted_export: None,
        };
        studio.read_cameras();
        if let Some(note) = start.note {
            studio.say(note);
        }
        Ok(studio)
    }

    /// Says something to the user, at the foot of the window.
    pub(crate) fn say(&mut self, message: impl Into<String>) {
        self.message = Some((message.into(), Instant::now()));
    }

    /// Takes another recipe or project in place of this one.
    pub(crate) fn begin(&mut self, start: Start) {
        self.document = Document::new(start.project.recipe_name(), start.text);
        self.project.forget_unsaved();
        self.project = start.project;
        self.project.count_from(self.status.changes);
        (self.opened, self.keeps_edits) = (0, false);
        (self.camera, self.selected, self.asked) = (None, None, None);
        (self.done, self.undone, self.set) = (Vec::new(), Vec::new(), Vec::new());
        self.undone_before = Vec::new();
        self.brush.material = Settings::default().material;
        if !self.has_run() {
            self.work.ask(Task::Close);
        }
        self.renaming = None;
        (self.measuring, self.turns) = (Measuring::default(), false);
        self.read_cameras();
        if let Some(note) = start.note {
            self.say(note);
        }
    }

    /// Opens a recipe, an elevation model or a project.
    pub(crate) fn open(&mut self, path: &Path) {
        match Project::open(path) {
            Ok(start) => {
                self.own.remember(path);
                self.recent = self.own.recent();
                self.begin(start);
            }
            Err(error) => self.say(error.to_string()),
        }
    }
}
