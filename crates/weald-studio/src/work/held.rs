//! A session with what the window needs beside it: stretches of steps as one, and what was taken back.

use std::path::Path;
use std::sync::Arc;

use weald::edit::{Action, Brush, Canvas, Change, Effect, History, Layout, Setting};
use weald::erode::interactive::InteractiveSimulation;
use weald::recipe::{Recipe, Session};
use weald::{Error, Field, Landscape};

use super::status::Moment;
use super::task::Opening;
use crate::document::Document;

/// A simulation under a person's hands.
#[derive(Debug)]
pub(super) struct HeldSession {
    session: Session,
    /// The text that it was opened from.
    file: String,
    text: String,
    names_files: bool,
    /// Moments that were left by going back, the last one first to return to.
    undone: Vec<usize>,
    strokes: Vec<Stroke>,
}

/// The moments of a stroke of the hand, of which there are several where it was painted piece by piece.
#[derive(Clone, Debug)]
struct Stroke {
    number: u64,
    before: usize,
    last: usize,
}

impl HeldSession {
    /// `names_files` says whether the recipe reads files beside its own.
    pub(super) fn new(session: Session, (file, text): (&str, &str), names_files: bool) -> Self {
        Self {
            session,
            file: file.to_owned(),
            text: text.to_owned(),
            names_files,
            undone: Vec::new(),
            strokes: Vec::new(),
        }
    }

    /// Takes a recipe that differs only after the step that is held; `false`, and nothing has changed, for any other.
    pub(super) fn adopt(&mut self, recipe: Recipe, (place, text): (usize, &str)) -> bool {
        let is_same = self.session.place_among_running() == place && self.session.adopt(recipe);
        if is_same {
            text.clone_into(&mut self.text);
        }
        is_same
    }

    pub(super) fn session(&mut self) -> &mut Session {
        &mut self.session
    }

    pub(super) fn steps(&self) -> u64 {
        self.session.steps()
    }

    pub(super) fn written_steps(&self) -> u64 {
        self.session.written_steps()
    }

    /// All that was done, in order.
    pub(super) fn actions(&mut self) -> Vec<Action> {
        self.session.history().actions().into_iter().cloned().collect()
    }

    pub(super) fn advance(&mut self, steps: u64) -> Result<(), Error> {
        self.session.advance(steps)?;
        self.undone.clear();
        Ok(())
    }

    pub(super) fn set(&mut self, setting: Setting) -> Result<(), Error> {
        self.session.set(setting)?;
        self.undone.clear();
        Ok(())
    }

    /// Paints more of a stroke of the hand, or all of it in place of what was painted of it.
    pub(super) fn paint(&mut self, brush: Brush, stroke: u64, replaces: bool) -> Result<(), Error> {
        let history = self.session.history();
        let here = history.here();
        let goes_on = self.strokes.last_mut().filter(|last| last.number == stroke);
        let Some(last) = goes_on else {
            let last = history.act(Change::Stroke(brush))?;
            self.undone.clear();
            self.strokes.push(Stroke { number: stroke, before: here, last });
            return Ok(());
        };
        if replaces && last.last == here {
            history.go_to(last.before)?;
        }
        match history.act(Change::Stroke(brush)) {
            Ok(moment) => last.last = moment,
            Err(error) => {
                // What was painted of it before stays.
                history.go_to(here)?;
                return Err(error);
            }
        }
        Ok(())
    }

    /// Does again what another session has done.
    pub(super) fn follow(&mut self, actions: Vec<Action>) -> Result<(), Error> {
        for action in actions {
            self.session.history().act(action)?;
        }
        Ok(())
    }

    /// Takes the last stretch back; `false` where there is none.
    pub(super) fn undo(&mut self) -> Result<bool, Error> {
        let history = self.session.history();
        let here = history.here();
        let stroke = self.strokes.iter().find(|stroke| stroke.last == here).map(|stroke| stroke.before);
        let Some(before) = stroke.or_else(|| start_of_stretch(history, here)) else { return Ok(false) };
        history.go_to(before)?;
        self.undone.push(here);
        Ok(true)
    }

    /// Returns to what was undone last; `false` where there is none.
    pub(super) fn redo(&mut self) -> Result<bool, Error> {
        let Some(moment) = self.undone.pop() else { return Ok(false) };
        self.session.history().go_to(moment)?;
        Ok(true)
    }

    pub(super) fn go_to(&mut self, moment: usize) -> Result<(), Error> {
        let history = self.session.history();
        let here = history.here();
        history.go_to(moment)?;
        // Whoever goes back on the same way can come again by redoing.
        self.undone.push(here);
        Ok(())
    }

    /// A text of the same recipe without the script of what was done by hand.
    pub(super) fn without_edits(&self, opening: &Opening) -> String {
        let mut document = Document::new(opening.file.clone(), opening.text.clone());
        // A text that no control can change has no script that a control has put there.
        match document.set_step_key(self.place(), "edits", None) {
            Ok(()) => document.text().to_owned(),
            Err(_) => opening.text.clone(),
        }
    }

    /// Place of the step, counted from 0.
    pub(super) fn place(&self) -> usize {
        self.session.replayed().0
    }

    /// Ground and water as they are, and the elevation of the ground.
    pub(super) fn surface(&mut self) -> Result<(Canvas, Field), Error> {
        let whole = self.session.history().simulation().whole();
        let canvas = self.session.patch(whole)?;
        let mut ground = canvas.bedrock.clone();
        for layer in &canvas.thickness {
            for (metres, more) in ground.values_mut().iter_mut().zip(layer.values()) {
                *metres += more;
            }
        }
        Ok((canvas, ground))
    }

    pub(super) fn landscape(&mut self) -> Result<Arc<Landscape>, Error> {
        Ok(Arc::new(self.session.landscape()?.0))
    }

    /// What was done on the way here, stretch by stretch, and what can be redone.
    pub(super) fn moments(&mut self) -> Vec<Moment> {
        let (undone, strokes) = (self.undone.first().copied(), self.strokes.clone());
        let history = self.session.history();
        let mut moments = stretches(history, history.here(), &strokes, true);
        let past = moments.len();
        let ahead = undone.map_or_else(Vec::new, |last| stretches(history, last, &strokes, false));
        let shares = moments.iter().zip(&ahead).take_while(|(one, other)| one.number == other.number).count();
        if shares == past {
            moments.extend(ahead.into_iter().skip(past));
        }
        moments
    }

    /// The recipe with all that was done, whose comments stay, and its script.
    pub(super) fn texts(&mut self, script: &str) -> Result<[String; 2], Error> {
        let (place, keys) = self.session.replayed();
        let mut document = Document::new(self.file.clone(), self.text.clone());
        let set = |document: &mut Document, key: &str, value: &str| {
            document.set_step_key(place, key, Some(value)).map_err(Error::Run)
        };
        for (key, value) in keys {
            set(&mut document, key, &value.shown())?;
        }
        set(&mut document, "edits", &format!("{script:?}"))?;
        let edits = self.session.history().script().1.text(Layout::JsonLines);
        Ok([document.text().to_owned(), edits])
    }

    /// Writes both; the script first, so that there is no recipe without one. Where the recipe names files and is written
    /// into another folder, it names them from there, in its canonical spelling.
    pub(super) fn save(&mut self, file: &Path) -> Result<(), Error> {
        if self.names_files && Path::new(&self.file).parent() != file.parent() {
            return self.session.save(file);
        }
        let script = file.with_extension("edits.jsonl");
        let name = script.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
        let [text, edits] = self.texts(&name)?;
        Recipe::parse(&file.display().to_string(), &text, &weald::recipe::Overrides::default())?;
        weald::io::write_whole(&script, edits.as_bytes())?;
        weald::io::write_whole(file, text.as_bytes())
    }
}

/// The moment before the stretch that ends at `here`: steps one after the other are one.
fn start_of_stretch(history: &History<InteractiveSimulation>, here: usize) -> Option<usize> {
    let (mut before, action) = history.led_to(here)?;
    if matches!(action, Action::Steps(_)) {
        while let Some((earlier, Action::Steps(_))) = history.led_to(before) {
            before = earlier;
        }
    }
    Some(before)
}

/// The way to a moment, stretch by stretch.
fn stretches(
    history: &History<InteractiveSimulation>,
    last: usize,
    strokes: &[Stroke],
    is_past: bool,
) -> Vec<Moment> {
    let mut path = Vec::new();
    let mut here = last;
    while let Some((before, action)) = history.led_to(here) {
        path.push((here, action));
        here = before;
    }
    // Strokes of other branches have numbers around those of this one.
    let is_here = |stroke: &&Stroke| path.iter().any(|(number, _)| *number == stroke.last);
    let here: Vec<_> = strokes.iter().filter(is_here).collect();
    let (mut moments, mut steps): (Vec<Moment>, u64) = (Vec::new(), 0);
    let mut stretch = 0;
    for (number, action) in path.into_iter().rev() {
        stretch = if let Action::Steps(more) = action { stretch + more } else { 0 };
        steps += if let Action::Steps(more) = action { *more } else { 0 };
        let moment = Moment { number, steps, label: label(action, stretch), is_steps: stretch > 0, is_past };
        // What was painted while the simulation ran belongs to the stroke, with the steps between.
        let in_stroke = here.iter().any(|stroke| stroke.before < number && number < stroke.last);
        match moments.last_mut() {
            _ if in_stroke => {}
            Some(last) if last.is_steps && moment.is_steps => *last = moment,
            _ => moments.push(moment),
        }
    }
    moments
}

fn label(action: &Action, stretch: u64) -> String {
    match action {
        Action::Steps(_) => format!("{stretch} steps"),
        Action::Change(Change::Set(setting)) => format!("{} = {}", setting.key, setting.value.shown()),
        Action::Change(Change::Stroke(brush)) => match &brush.effect {
            Effect::Add { material, .. } => format!("add {material}"),
            Effect::Remove { material, .. } => format!("remove {material}"),
            Effect::AddWater { .. } => "add water".to_owned(),
            Effect::RemoveWater { .. } => "remove water".to_owned(),
            Effect::Smooth { .. } => "smooth".to_owned(),
            Effect::Flatten { height } => format!("flatten to {height:.1} m"),
            Effect::Source { .. } => "spring".to_owned(),
            Effect::Drain { .. } => "drain".to_owned(),
            Effect::Rain { factor } => format!("rain × {factor}"),
            Effect::Freeze => "freeze".to_owned(),
            Effect::Thaw => "thaw".to_owned(),
            Effect::Mask => "mask".to_owned(),
            Effect::Unmask => "unmask".to_owned(),
        },
    }
}
