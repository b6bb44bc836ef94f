//! The rate of flam3-render, by its clock for two qualities: what it takes to start, filter and write cancels out.

use std::fs;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::time::Instant;

use super::super::rate::RUNS;
use weald_core::error::Error;
use weald_plants::ifs::Ifs;
use weald_plants::ifs::flame::{Frame, write};

/// Points for each pixel of the two renders.
const QUALITIES: [f64; 2] = [2.0, 22.0];

/// The program, with the version that it prints.
pub(super) struct Flam3 {
    version: String,
}

impl Flam3 {
    /// flam3, if it is installed.
    ///
    /// # Errors
    /// [`Error::Run`] where it is and does not start.
    pub(super) fn installed() -> Result<Option<Self>, Error> {
        match Command::new("flam3-render").arg("--version").output() {
            Ok(output) => Ok(Some(Self { version: printed_version(&output) })),
            Err(cause) if cause.kind() == ErrorKind::NotFound => Ok(None),
            Err(cause) => Err(Error::Run(format!("flam3-render does not start: {cause}"))),
        }
    }

    /// Its name and version.
    pub(super) fn version(&self) -> String {
        format!("flam3 {}", self.version)
    }

    /// Million points per second into a square picture.
    ///
    /// # Errors
    /// [`Error::Run`] where it fails, or a file cannot be written.
    pub(super) fn rate(&self, ifs: &Ifs, side: u32, threads: usize) -> Result<f64, Error> {
        let folder = Folder::new()?;
        let frame = Frame { size: [side; 2], quality: 1.0, spread: 0.0, ..Frame::default() };
        let path = folder.0.join("fern.flame");
        fs::write(&path, write(std::slice::from_ref(ifs), &frame)?)
            .map_err(|cause| Error::write(&path, &cause))?;
        let mut best = [f64::INFINITY; 2];
        for _ in 0..RUNS {
            for (best, quality) in best.iter_mut().zip(QUALITIES) {
                *best = best.min(self.seconds(&folder.0, quality, threads)?);
            }
        }
        let points = (QUALITIES[1] - QUALITIES[0]) * f64::from(side) * f64::from(side);
        Ok(points / (best[1] - best[0]) / 1e6)
    }

    fn seconds(&self, folder: &Path, quality: f64, threads: usize) -> Result<f64, Error> {
        let begun = Instant::now();
        let run = Command::new("flam3-render")
            .current_dir(folder)
            .envs([("in", "fern.flame"), ("out", "fern.png"), ("verbose", "0")])
            .env("qs", quality.to_string())
            .env("nthreads", threads.to_string())
            .output();
        let seconds = begun.elapsed().as_secs_f64();
        let output = run.map_err(|cause| Error::Run(format!("flam3-render does not start: {cause}")))?;
        if output.status.success() && folder.join("fern.png").is_file() {
            return Ok(seconds);
        }
        let said = String::from_utf8_lossy(&output.stderr);
        Err(Error::Run(format!("{} drew no picture of our fern; it said: {}", self.version(), said.trim())))
    }
}

/// The last word of the first line that it prints of itself.
fn printed_version(output: &Output) -> String {
    let printed = String::from_utf8_lossy(&output.stdout);
    let word = printed.lines().next().and_then(|line| line.split_whitespace().last());
    word.unwrap_or("without a version").to_owned()
}

/// A folder of our own that is removed at the end.
struct Folder(PathBuf);

impl Folder {
    fn new() -> Result<Self, Error> {
        let path = std::env::temp_dir().join(format!("weald-bench-{}", std::process::id()));
        fs::create_dir_all(&path).map_err(|cause| Error::write(&path, &cause))?;
        Ok(Self(path))
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        // A folder that is left over in the temporary one harms no one.
        let _ = fs::remove_dir_all(&self.0);
    }
}
