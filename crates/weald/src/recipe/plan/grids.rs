//! What the grid says of a recipe before anything runs: each step and each output is asked whether it can work on the grid
//! that it will find.

use std::borrow::Cow;

use super::{Content, Output, Planned, Recipe};
use weald_core::domain::Domain;
use weald_core::error::{Diagnostic, Error, RecipeError};

/// A step and the grid that it will find.
type OnGrid<'a> = (&'a Planned, Cow<'a, Domain>);

impl Recipe {
    /// All steps with the grids that they find from this one on, and the grid after the last.
    pub(in crate::recipe) fn grids<'a>(&'a self, first: &'a Domain) -> (Vec<OnGrid<'a>>, Cow<'a, Domain>) {
        self.grids_from(first, 0)
    }

    /// The same for the steps after so many.
    pub(in crate::recipe) fn grids_from<'a>(
        &'a self,
        first: &'a Domain,
        done: usize,
    ) -> (Vec<OnGrid<'a>>, Cow<'a, Domain>) {
        let mut here = Cow::Borrowed(first);
        let mut steps = Vec::with_capacity(self.steps.len());
        for planned in self.steps.iter().skip(done) {
            let after = planned.step.domain_after(&here).map(Cow::Owned);
            let before = match after {
                Some(after) => std::mem::replace(&mut here, after),
                None => here.clone(),
            };
            steps.push((planned, before));
        }
        (steps, here)
    }

    /// Refuses what cannot work on the grids that a first one leads to.
    ///
    /// # Errors
    /// [`Error::Recipe`] with all that is wrong; [`Error::Limit`] where that is nothing but a limit.
    pub(in crate::recipe) fn check_on(&self, first: &Domain) -> Result<(), Error> {
        let (steps, last) = self.grids(first);
        let of_steps = steps.iter().filter_map(|(planned, grid)| {
            let error = planned.step.check_on(grid).err()?;
            Some((planned.line, planned.entry.name.to_owned(), error))
        });
        // What a step refuses leaves no grid for what comes after it.
        let mut faults: Vec<_> = of_steps.collect();
        if faults.is_empty() {
            let of_outputs = self.outputs.iter().filter_map(|output| {
                let error = output.check_on(&last).err()?;
                Some((output.line, format!("output: {}", output.file.display()), error))
            });
            faults.extend(of_outputs);
        }
        self.refused_for(faults)
    }

    fn refused_for(&self, faults: Vec<(usize, String, Error)>) -> Result<(), Error> {
        let is_limit = |error: &Error| matches!(error, Error::Limit(_));
        if faults.iter().all(|(.., error)| is_limit(error)) {
            return match faults.into_iter().next() {
                Some((line, _, Error::Limit(limit))) => Err(limit.of(format!("{}:{line}", self.file)).into()),
                _ => Ok(()),
            };
        }
        let diagnostics = faults.into_iter().map(|(line, subject, error)| {
            let message = error.to_string();
            let has_subject = message.starts_with(&subject);
            Diagnostic { line, message: if has_subject { message } else { format!("{subject}: {message}") } }
        });
        Err(RecipeError { file: self.file.clone(), diagnostics: diagnostics.collect() }.into())
    }
}

impl Output {
    fn check_on(&self, domain: &Domain) -> Result<(), Error> {
        match &self.content {
            Content::Layer { .. } => Ok(()),
            Content::Picture { picture, .. } | Content::Film { picture, .. } => picture.check_on(domain),
            Content::Export { export, .. } => export.check_on(domain, &self.file),
        }
    }
}
