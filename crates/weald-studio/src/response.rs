//! How soon the window answers: 600 frames of a session that drives itself, each from its input until the device has drawn the
//! frame that shows it.

use std::fmt;
use std::path::PathBuf;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Instant;

use eframe::egui::{Context, RawInput, Ui, ViewportCommand};
use weald::Error;
use weald::edit::{Brush, Effect};

use crate::navigation;
use crate::options::Options;
use crate::studio::Studio;
use crate::window::show;
use crate::work::Task;

/// Frames of each part of the session.
const FRAMES: usize = 150;

/// What the session does, one part after the other.
const PARTS: [&str; 4] =
    ["the interface alone", "the camera moves", "the simulation runs", "it runs and is painted on"];

/// What was measured.
#[derive(Clone, Debug, Default)]
pub struct Response {
    /// Device that draws.
    pub device: String,
    /// Milliseconds of each frame, part by part.
    milliseconds: [Vec<f64>; PARTS.len()],
    /// Steps that the simulation did in each part, and seconds that the part took.
    steps: [(u64, f64); PARTS.len()],
}

impl fmt::Display for Response {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(
            formatter,
            "{}: milliseconds from an input to the frame that shows it, {FRAMES} frames each",
            self.device
        )?;
        for (part, name) in PARTS.iter().enumerate() {
            let mut sorted = self.milliseconds[part].clone();
            sorted.sort_by(f64::total_cmp);
            let at = |share: f64| {
                sorted
                    .get(((sorted.len() as f64 * share) as usize).min(sorted.len().saturating_sub(1)))
                    .copied()
            };
            let [middle, most, last] = [0.5, 0.99, 1.0].map(|share| at(share).unwrap_or(f64::NAN));
            let (steps, seconds) = self.steps[part];
            let pace = steps as f64 / seconds.max(1e-9);
            writeln!(
                formatter,
                "  {name:<28} median {middle:>7.1}  99 % {most:>7.1}  most {last:>7.1}  {pace:>7.1} steps/s"
            )?;
        }
        Ok(())
    }
}

struct Driven {
    studio: Studio,
    frame: usize,
    input: Option<Instant>,
    began: Option<(Instant, u64)>,
    measured: Arc<Mutex<Response>>,
}

/// Opens a window with a recipe, drives it for 600 frames, closes it, and gives what was measured.
///
/// # Errors
/// As [`open`](crate::open).
pub fn response(what: Option<PathBuf>) -> Result<Response, Error> {
    let measured = Arc::new(Mutex::new(Response::default()));
    let told = Arc::clone(&measured);
    // What a bench leaves behind is not offered at the next start.
    let own_files = Some(std::env::temp_dir().join(format!("weald-bench-{}", std::process::id())));
    let options = Options { what, own_files: own_files.clone(), ..Options::default() };
    let done = show(move |context| {
        let studio = Studio::of(context, options.clone())?;
        Ok(Driven { studio, frame: 0, input: None, began: None, measured: Arc::clone(&told) })
    });
    if let Some(folder) = own_files {
        let _ = std::fs::remove_dir_all(folder);
    }
    done?;
    let measured = measured.lock().unwrap_or_else(PoisonError::into_inner);
    Ok(measured.clone())
}

impl eframe::App for Driven {
    fn raw_input_hook(&mut self, _: &Context, _: &mut RawInput) {
        if let Some(viewport) = &self.studio.viewport {
            viewport.wait();
        }
        let now = Instant::now();
        if let (Some(input), Some(part)) = (self.input, self.part()) {
            let mut measured = self.measured.lock().unwrap_or_else(PoisonError::into_inner);
            measured.milliseconds[part].push(1000.0 * (now - input).as_secs_f64());
        }
        self.input = Some(now);
    }

    fn logic(&mut self, context: &Context, frame: &mut eframe::Frame) {
        self.studio.logic(context, frame);
        context.request_repaint();
        if self.studio.is_drawn() || self.frame > 0 {
            self.drive(context);
            self.frame += 1;
        } else {
            self.studio.asked = None;
        }
    }

    fn ui(&mut self, ui: &mut Ui, frame: &mut eframe::Frame) {
        self.studio.ui(ui, frame);
    }

    fn on_exit(&mut self) {
        self.studio.on_exit();
    }
}

impl Driven {
    /// The part of the session that a frame belongs to.
    fn part(&self) -> Option<usize> {
        let part = self.frame.checked_sub(1)? / FRAMES;
        (part < PARTS.len()).then_some(part)
    }

    fn drive(&mut self, context: &Context) {
        let (part, within) = (self.frame / FRAMES, self.frame % FRAMES);
        if within == 0 {
            self.turn(part, context);
        }
        let studio = &mut self.studio;
        if part == 1
            && let (Some(camera), Some(viewport)) = (studio.camera, &studio.viewport)
            && let Some(middle) = viewport.middle()
        {
            studio.camera = Some(navigation::orbit(camera, middle, [0.005, 0.0]));
        }
        if part == 3
            && let Some(shown) = &studio.status.shown
        {
            let extent = shown.landscape.domain.cell * shown.landscape.domain.size.columns as f64;
            let at = extent * (0.2 + 0.6 * within as f64 / FRAMES as f64);
            let brush = Brush::dab(Effect::AddWater { depth: 1.0 }, [at, 0.5 * extent], 0.03 * extent);
            studio.work.ask(Task::Stroke { brush, stroke: 1, replaces: false });
        }
    }

    /// Begins a part, and closes after the last.
    fn turn(&mut self, part: usize, context: &Context) {
        let (now, steps) = (Instant::now(), self.studio.status.steps);
        if let Some((began, before)) = self.began.replace((now, steps)) {
            let mut measured = self.measured.lock().unwrap_or_else(PoisonError::into_inner);
            measured.steps[part - 1] = (steps.saturating_sub(before), (now - began).as_secs_f64());
            measured.device =
                self.studio.viewport.as_ref().map_or_else(String::new, |viewport| viewport.device());
        }
        match part {
            2 => self.studio.work.ask(Task::Play(true)),
            4 => {
                self.studio.is_closing = true;
                context.send_viewport_cmd(ViewportCommand::Close);
            }
            _ => {}
        }
    }
}
