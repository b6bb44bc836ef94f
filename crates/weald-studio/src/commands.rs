//! Everything that a key, the palette or a button can do: one list, of which the palette, the keys and their documentation
//! are made.

use std::fmt::Write;

use eframe::egui::{Key, KeyboardShortcut, Modifiers};

use crate::brushes::Tool;
use crate::navigation::Mode;

/// Something that can be done.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Command {
    /// Shows the templates.
    New,
    /// Asks for a recipe or a project.
    Open,
    /// Writes the project.
    Save,
    /// Asks for a place to write it to.
    SaveAs,
    /// Asks for a folder to write the outputs to.
    Export,
    /// Makes landscapes of several seeds, to choose one.
    Seeds,
    /// Takes the last change back.
    Undo,
    /// Makes it again.
    Redo,
    /// Lets the simulation run, or stands it still.
    Play,
    /// Simulates a step.
    Step,
    /// Runs the simulation to the recipe's end.
    PlayToEnd,
    /// Goes back to the beginning of the simulation.
    ToStart,
    /// Shows the landscape whole.
    Frame,
    /// Looks down from above.
    TopView,
    /// How the camera moves.
    Camera(Mode),
    /// Lets the camera go round the landscape by itself.
    Turntable,
    /// Keeps where the camera is.
    KeepCamera,
    /// Lets the pointer draw a line to be measured.
    Measure,
    /// Keeps what is shown, to compare what comes with it.
    Pin,
    /// Chooses a brush; without one, the pointer moves the camera.
    Brush(Tool),
    /// A wider brush.
    Wider,
    /// A narrower brush.
    Narrower,
    /// A stronger brush.
    Stronger,
    /// A weaker brush.
    Weaker,
    /// Shows the palette of commands.
    Palette,
    /// Shows the recipe as cards or as text.
    Text,
    /// Shows the window dark or light.
    Theme,
    /// Shows everything larger.
    Larger,
    /// Shows everything smaller.
    Smaller,
    /// Writes what the viewport shows into a picture, larger than the screen.
    Picture,
    /// Shows the tour.
    Tour,
    /// Ends the program.
    Quit,
}

/// A command with its name, what it does, and its key.
#[derive(Clone, Copy, Debug)]
pub struct Entry {
    /// The command.
    pub command: Command,
    /// Its name in the palette.
    pub name: &'static str,
    /// What it does, in a sentence without a full stop.
    pub what: &'static str,
    /// Its key.
    pub keys: Keys,
}

/// The keys of a command.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Keys {
    /// None.
    None,
    /// A key alone.
    Alone(Key),
    /// A key with Ctrl, or with the command key of a Mac.
    Command(Key),
    /// The same with Shift.
    Shift(Key),
}

impl Keys {
    /// As the window knows them.
    pub fn shortcut(self) -> Option<KeyboardShortcut> {
        let (modifiers, key) = match self {
            Self::None => return None,
            Self::Alone(key) => (Modifiers::NONE, key),
            Self::Command(key) => (Modifiers::COMMAND, key),
            Self::Shift(key) => (Modifiers::COMMAND.plus(Modifiers::SHIFT), key),
        };
        Some(KeyboardShortcut::new(modifiers, key))
    }

    /// In words, as `Ctrl+S`; empty where there are none.
    pub fn in_words(self) -> String {
        match self {
            Self::None => String::new(),
            Self::Alone(key) => key.symbol_or_name().to_owned(),
            Self::Command(key) => format!("Ctrl+{}", key.symbol_or_name()),
            Self::Shift(key) => format!("Ctrl+Shift+{}", key.symbol_or_name()),
        }
    }
}

const fn entry(command: Command, name: &'static str, what: &'static str, keys: Keys) -> Entry {
    Entry { command, name, what, keys }
}

/// All of them.
#[rustfmt::skip] // one entry a line
pub const COMMANDS: &[Entry] = &[
    entry(Command::New, "New landscape", "shows the templates to start from", Keys::Command(Key::N)),
    entry(Command::Open, "Open", "opens a recipe, an elevation model or a project", Keys::Command(Key::O)),
    entry(Command::Save, "Save", "saves the project: the recipe and all that was done by hand", Keys::Command(Key::S)),
    entry(Command::SaveAs, "Save as", "saves the project in another folder", Keys::Shift(Key::S)),
    entry(Command::Export, "Export", "runs the recipe with all that was done and writes its outputs", Keys::Command(Key::E)),
    entry(Command::Seeds, "Many seeds", "makes small landscapes of many seeds beside each other, to choose one", Keys::Shift(Key::E)),
    entry(Command::Undo, "Undo", "takes the last stroke, setting, step or change of the recipe back", Keys::Command(Key::Z)),
    entry(Command::Redo, "Redo", "does again what was undone last", Keys::Shift(Key::Z)),
    entry(Command::Play, "Play or pause", "lets the simulation run, or stands it still", Keys::Alone(Key::Space)),
    entry(Command::Step, "One step", "simulates one step", Keys::Alone(Key::Period)),
    entry(Command::PlayToEnd, "Play to the end", "runs the simulation for as long as the recipe says", Keys::Command(Key::Period)),
    entry(Command::ToStart, "Back to the start", "goes back to the beginning of the simulation", Keys::Alone(Key::Home)),
    entry(Command::Frame, "Show all", "shows the landscape whole", Keys::Alone(Key::F)),
    entry(Command::TopView, "From above", "looks straight down", Keys::Alone(Key::T)),
    entry(Command::Camera(Mode::Orbit), "Orbit", "moves the camera round the landscape", Keys::Alone(Key::Num1)),
    entry(Command::Camera(Mode::Fly), "Fly", "moves the camera freely: W A S D, Q down, E up", Keys::Alone(Key::Num2)),
    entry(Command::Camera(Mode::Walk), "Walk", "stands on the ground at a person's height: W A S D", Keys::Alone(Key::Num3)),
    entry(Command::Turntable, "Turntable", "lets the camera go round the landscape by itself, or stops it", Keys::Alone(Key::O)),
    entry(Command::KeepCamera, "Keep camera", "keeps where the camera is, to come back to it", Keys::Command(Key::B)),
    entry(Command::Measure, "Section", "draws a line over the landscape: its profile, distance, rise and slope", Keys::Alone(Key::C)),
    entry(Command::Pin, "Compare", "pins what is shown beside what comes, with a bar between them; again, lets it go", Keys::Alone(Key::N)),
    entry(Command::Brush(Tool::None), "No brush", "the pointer moves the camera again", Keys::Alone(Key::Escape)),
    entry(Command::Brush(Tool::Add), "Brush: add", "adds a material", Keys::Alone(Key::B)),
    entry(Command::Brush(Tool::Remove), "Brush: remove", "takes a material away", Keys::Alone(Key::X)),
    entry(Command::Brush(Tool::Water), "Brush: water", "pours water", Keys::Alone(Key::V)),
    entry(Command::Brush(Tool::Dry), "Brush: dry", "takes water away", Keys::None),
    entry(Command::Brush(Tool::Smooth), "Brush: smooth", "smooths the ground", Keys::Alone(Key::M)),
    entry(Command::Brush(Tool::Level), "Brush: level", "brings the ground to the height where the stroke begins", Keys::Alone(Key::L)),
    entry(Command::Brush(Tool::Flatten), "Brush: flatten", "brings the ground to a stated height", Keys::None),
    entry(Command::Brush(Tool::Spring), "Brush: spring", "lets water rise", Keys::Alone(Key::P)),
    entry(Command::Brush(Tool::Drain), "Brush: drain", "lets water run off", Keys::None),
    entry(Command::Brush(Tool::Rain), "Brush: rain", "changes the rain", Keys::Alone(Key::R)),
    entry(Command::Brush(Tool::Freeze), "Brush: freeze", "holds the simulation still where it touches", Keys::None),
    entry(Command::Brush(Tool::Thaw), "Brush: thaw", "lets the simulation go on where it touches", Keys::None),
    entry(Command::Brush(Tool::Mask), "Brush: mask", "protects the ground from other brushes, as far as the strength says", Keys::Alone(Key::K)),
    entry(Command::Brush(Tool::Unmask), "Brush: unmask", "takes that protection away", Keys::Alone(Key::J)),
    entry(Command::Brush(Tool::Plant), "Brush: plant", "lets grass, ferns or trees stand densely", Keys::Alone(Key::G)),
    entry(Command::Brush(Tool::Clear), "Brush: clear", "takes grass, ferns or trees away", Keys::Alone(Key::H)),
    entry(Command::Wider, "Wider brush", "a quarter wider", Keys::Alone(Key::CloseBracket)),
    entry(Command::Narrower, "Narrower brush", "a fifth narrower", Keys::Alone(Key::OpenBracket)),
    entry(Command::Stronger, "Stronger brush", "a tenth stronger", Keys::Alone(Key::Quote)),
    entry(Command::Weaker, "Weaker brush", "a tenth weaker", Keys::Alone(Key::Semicolon)),
    entry(Command::Palette, "Commands", "finds a command by its name", Keys::Command(Key::K)),
    entry(Command::Text, "Cards or text", "shows the recipe as cards or as text", Keys::Command(Key::T)),
    entry(Command::Theme, "Dark or light", "shows the window dark or light", Keys::None),
    entry(Command::Larger, "Larger interface", "shows everything a tenth larger", Keys::Command(Key::Plus)),
    entry(Command::Smaller, "Smaller interface", "shows everything a tenth smaller", Keys::Command(Key::Minus)),
    entry(Command::Picture, "Picture", "writes what the viewport shows, twice as fine, into a PNG file", Keys::Command(Key::P)),
    entry(Command::Tour, "Tour", "shows in a minute what is where", Keys::Alone(Key::F1)),
    entry(Command::Quit, "Quit", "ends the program; what is not saved is offered at the next start", Keys::Command(Key::Q)),
];

/// The table of keys of the guide.
pub fn table() -> String {
    let mut text = "| Key | Command | What it does |\n| --- | --- | --- |\n".to_owned();
    for entry in COMMANDS {
        let keys = entry.keys.in_words();
        let keys = if keys.is_empty() { keys } else { format!("`{keys}`") };
        let _ = writeln!(text, "| {keys} | {} | {} |", entry.name, entry.what);
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_two_commands_have_one_key_or_one_name() {
        for (place, entry) in COMMANDS.iter().enumerate() {
            for other in &COMMANDS[..place] {
                assert_ne!(entry.name, other.name);
                assert_ne!(entry.command, other.command);
                assert!(
                    entry.keys == Keys::None || entry.keys != other.keys,
                    "{} and {}",
                    entry.name,
                    other.name
                );
            }
        }
    }

    #[test]
    fn every_brush_and_every_way_to_move_is_a_command() {
        let has = |command| COMMANDS.iter().any(|entry| entry.command == command);
        assert!(
            Tool::ALL.iter().all(|(tool, ..)| has(Command::Brush(*tool))) && has(Command::Brush(Tool::None))
        );
        assert!(Mode::ALL.iter().all(|(mode, _)| has(Command::Camera(*mode))));
    }
}
