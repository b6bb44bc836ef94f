//! A recipe is run as far as the step that can be held.

use std::sync::Arc;

use weald::edit::Action;
use weald::engine::Engine;
use weald::erode::interactive_names;
use weald::recipe::{Overrides, Recipe, Session, SessionOptions};
use weald::{Error, Landscape};

use super::Worker;
use crate::work::held::HeldSession;
use crate::work::shared::Told;
use crate::work::status::Shown;
use crate::work::task::Opening;

impl Worker {
    pub(super) fn open(&mut self, number: u64, mut opening: Opening) -> Result<(), Error> {
        self.shared.change(|status| {
            (status.revision, status.notes) = (opening.revision, Vec::new());
            (status.plays, status.pace) = (false, 0.0);
            status.engine = self.in_words(&opening.engine);
        });
        self.until = None;
        if let Some(held) = self.held.as_ref().filter(|_| opening.keeps_edits) {
            // What the text says was done by hand is among what is done again.
            opening.text = held.without_edits(&opening);
        }
        if !opening.keeps_edits {
            // Another project: whatever comes of it, nothing of the one before is saved in its place.
            (self.held, self.opening) = (None, Some(opening.clone()));
            self.shared.change(|status| (status.saved, status.autosaved) = (None, None));
        }
        let recipe = Recipe::parse(&opening.file, &opening.text, &Overrides::default())?;
        let wanted = opening.steps.unwrap_or(recipe.steps.len());
        let names = interactive_names();
        let can_hold = recipe.steps[..wanted.min(recipe.steps.len())]
            .iter()
            .rposition(|planned| names.contains(&planned.entry.name));
        if let Some(place) = can_hold
            && self.adopt(&opening, place)
        {
            self.opening = Some(opening);
            self.is_finished = false;
            return Ok(());
        }
        let again = self.again(&opening);
        let progress = Told { shared: &self.shared, number, watched: &self.shared.superseded };
        let Some(place) = can_hold else {
            let landscape = self.coarse_first(&opening, &recipe, wanted, &progress);
            self.held = None;
            self.is_finished = true;
            let landscape = landscape?;
            self.publish(&opening, Arc::new(landscape), wanted);
            self.opening = Some(opening);
            return Ok(());
        };
        let options = SessionOptions {
            engine: opening.engine.clone(),
            step: Some(place + 1),
            cache: Some(Arc::clone(&self.cache)),
            ..SessionOptions::default()
        };
        let names_files = !recipe.inputs().is_empty();
        let session = Session::open(recipe, options, &progress)?;
        let mut held = HeldSession::new(session, (&opening.file, &opening.text), names_files);
        if let Err(error) = held.follow(again) {
            let note =
                format!("what was done by hand could not all be done again on the new ground: {error}");
            self.shared.change(|status| status.notes.push(note));
        }
        let (landscape, materials) = (held.landscape()?, held.surface()?.0.materials);
        self.shared.change(|status| status.materials = materials);
        self.held = Some(held);
        self.publish(&opening, landscape, place + 1);
        self.opening = Some(opening);
        self.is_finished = false;
        self.show_mask()
    }

    /// Where simulations run.
    fn in_words(&self, engine: &Engine) -> String {
        let why = self.without_device.as_ref().map_or_else(String::new, |why| format!(": {why}"));
        engine.adapter().unwrap_or_else(|| format!("the processor{why}"))
    }

    /// Whether the recipe differs only after the step that is held, which then goes on as it is.
    fn adopt(&mut self, opening: &Opening, place: usize) -> bool {
        let is_same_file = self.opening.as_ref().is_some_and(|before| before.file == opening.file);
        let Some(held) = self.held.as_mut().filter(|_| opening.keeps_edits && is_same_file) else {
            return false;
        };
        let recipe = Recipe::parse(&opening.file, &opening.text, &Overrides::default());
        recipe.is_ok_and(|recipe| held.adopt(recipe, (place, &opening.text)))
    }

    /// What is to be done again on the new ground: all, where the same step is held.
    fn again(&mut self, opening: &Opening) -> Vec<Action> {
        match &mut self.held {
            Some(held) if opening.keeps_edits => held.actions(),
            _ => Vec::new(),
        }
    }

    /// The landscape of a recipe without a simulation, shown coarse until it is there in full.
    fn coarse_first(
        &self,
        opening: &Opening,
        recipe: &Recipe,
        steps: usize,
        progress: &Told<'_>,
    ) -> Result<Landscape, Error> {
        let preview = Overrides { preview: true, ..Overrides::default() };
        let coarse = Recipe::parse(&opening.file, &opening.text, &preview);
        if let Ok(coarse) = coarse.as_ref().map_err(ToString::to_string)
            && coarse.effective() != recipe.effective()
        {
            // What cannot be shown coarse is shown once it is there.
            if let Ok(landscape) = coarse.landscape_after(steps, &opening.engine, Some(&self.cache), progress)
            {
                self.publish(opening, Arc::new(landscape), steps);
            }
        }
        recipe.landscape_after(steps, &opening.engine, Some(&self.cache), progress)
    }

    pub(super) fn publish(&self, opening: &Opening, landscape: Arc<Landscape>, steps: usize) {
        let valid = landscape.domain.valid.as_ref();
        let lowest = landscape
            .field("height")
            .ok()
            .and_then(|height| height.range(valid))
            .map_or(0.0, |range| range.0);
        let recipe = Arc::new((opening.file.clone(), opening.text.clone()));
        self.shared.change(|status| {
            let (number, changes) =
                (status.shown.as_ref().map_or(1, |shown| shown.number + 1), status.changes);
            let (revision, recipe) = (opening.revision, Arc::clone(&recipe));
            status.shown = Some(Shown { landscape, lowest, number, revision, steps, changes, recipe });
            status.surface = None;
        });
    }
}
