//! The system's own dialogs for files, each in a thread of its own: the window never waits for one.

use std::path::PathBuf;
use std::rc::Rc;
use std::sync::mpsc::{Receiver, TryRecvError};
use std::time::Duration;

use web_time::Instant;

/// What is to be chosen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Wanted {
    /// A recipe, an elevation model or the recipe of a project.
    File,
    /// A folder.
    Folder,
}

/// Opens a dialog, and gives where the answer comes from: a path, or nothing where none was chosen or no dialog came.
pub type Chooser = Rc<dyn Fn(Wanted) -> Receiver<Option<PathBuf>>>;

/// No hand leaves a dialog as quickly as this: whoever answers sooner has shown none. The system does not say which it was.
const TOO_QUICK: Duration = Duration::from_millis(250);

/// A dialog that is open, or was tried.
#[derive(Debug)]
pub(crate) struct Dialog {
    answer: Receiver<Option<PathBuf>>,
    began: Instant,
}

/// What came of a dialog.
#[derive(Debug, PartialEq, Eq)]
pub(crate) enum Answer {
    /// Nothing yet.
    Waits,
    /// A path.
    Chosen(PathBuf),
    /// It was left without choosing.
    Left,
    /// The system has none to show.
    NoDialog,
}

impl Dialog {
    pub(crate) fn open(chooser: &Chooser, wanted: Wanted) -> Self {
        Self { began: Instant::now(), answer: chooser(wanted) }
    }

    pub(crate) fn answer(&self) -> Answer {
        match self.answer.try_recv() {
            Ok(Some(path)) => Answer::Chosen(path),
            Err(TryRecvError::Empty) => Answer::Waits,
            Ok(None) | Err(TryRecvError::Disconnected) if self.began.elapsed() < TOO_QUICK => {
                Answer::NoDialog
            }
            Ok(None) | Err(TryRecvError::Disconnected) => Answer::Left,
        }
    }
}

/// The dialogs of this system: by its portal on Linux, or `zenity` where there is no portal.
#[cfg(not(target_arch = "wasm32"))]
pub(crate) fn of_system() -> Chooser {
    Rc::new(|wanted| {
        let (sender, receiver) = std::sync::mpsc::channel();
        let ask = move || {
            // Where the window is gone meanwhile, nobody wants the answer.
            let _ = sender.send(ask(wanted));
        };
        // Without a thread the channel is closed at once, which counts as no dialog.
        let _ = std::thread::Builder::new().name("weald-dialog".to_owned()).spawn(ask);
        receiver
    })
}

#[cfg(not(target_arch = "wasm32"))]
fn ask(wanted: Wanted) -> Option<PathBuf> {
    let dialog = rfd::FileDialog::new();
    match wanted {
        Wanted::Folder => dialog.pick_folder(),
        Wanted::File => {
            let models = crate::project::MODELS;
            let all: Vec<_> = std::iter::once("toml").chain(models).collect();
            dialog
                .add_filter("Recipes and elevation models", &all)
                .add_filter("All files", &["*"])
                .pick_file()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_answer_that_comes_at_once_without_a_path_is_that_of_no_dialog() {
        let of = |path: Option<PathBuf>, waited: Duration| {
            let (sender, answer) = std::sync::mpsc::channel();
            sender.send(path).expect("open");
            Dialog { answer, began: Instant::now().checked_sub(waited).expect("later than its begin") }
                .answer()
        };
        assert_eq!(of(None, Duration::ZERO), Answer::NoDialog);
        assert_eq!(of(None, Duration::from_secs(2)), Answer::Left);
        assert_eq!(of(Some("a.toml".into()), Duration::ZERO), Answer::Chosen("a.toml".into()));
        let (_sender, answer) = std::sync::mpsc::channel();
        assert_eq!(Dialog { answer, began: Instant::now() }.answer(), Answer::Waits);
    }
}
