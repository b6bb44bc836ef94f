//! Frames become files: numbered pictures, one file of all, or pictures and a video where ffmpeg is there.

use std::path::Path;
use std::process::{Command, Stdio};

use crate::recipe::plan::Film;
use weald_core::error::Error;
use weald_io::{write_through, write_whole};
use weald_picture::{Cutout, write_apng};

/// How many frames, and how they are kept.
#[derive(Clone, Debug)]
pub struct Frames<'a> {
    /// How many there are.
    pub count: u64,
    /// How many are shown in a second.
    pub per_second: f64,
    /// Keys and words in each numbered picture.
    pub text: &'a [(String, String)],
}

impl Frames<'_> {
    /// Draws all frames into a file whose extension is one of [`FILM_EXTENSIONS`](crate::recipe::FILM_EXTENSIONS), each as soon as
    /// it is drawn, and gives what the user should know.
    ///
    /// # Errors
    /// [`Error::Run`] where a file cannot be written or ffmpeg fails, and those of `draw`.
    pub fn write(
        &self,
        path: &Path,
        draw: &mut dyn FnMut(u64) -> Result<Cutout, Error>,
    ) -> Result<Option<&'static str>, Error> {
        if Film::is_apng(path) {
            return write_apng(path, (self.count, self.per_second), draw).map(|()| None);
        }
        for number in 0..self.count {
            write_whole(&Film::frame(path, number), &draw(number)?.to_png(self.text))?;
        }
        self.video(path)
    }

    /// Makes the video of frames that are there, if the file is one.
    pub(super) fn video(&self, path: &Path) -> Result<Option<&'static str>, Error> {
        match (Film::is_video(path), can_make(path)) {
            (false, _) => Ok(None),
            (true, false) => Ok(Some(NO_FFMPEG)),
            (true, true) => encode(path, self.per_second, self.count).map(|()| None),
        }
    }
}

/// Whether this video can be made: ffmpeg is there, and was built with the encoder.
pub(super) fn can_make(path: &Path) -> bool {
    let asked = Command::new("ffmpeg").args(["-hide_banner", "-encoders"]).stderr(Stdio::null()).output();
    let encoder = if is_webm(path) { "libvpx-vp9" } else { "libx264" };
    asked.is_ok_and(|output| String::from_utf8_lossy(&output.stdout).contains(encoder))
}

fn is_webm(path: &Path) -> bool {
    path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("webm"))
}

/// What is reported where a video cannot be made.
pub(super) const NO_FFMPEG: &str = "ffmpeg with libx264 and libvpx-vp9 is not there, so the frames are written and no video; install it (Debian, Ubuntu: \
     sudo apt-get install ffmpeg) and run again";

/// Makes a video of numbered frames that are there.
fn encode(path: &Path, frames_per_second: f64, frames: u64) -> Result<(), Error> {
    let codec: &[&str] = if is_webm(path) {
        &["-f", "webm", "-c:v", "libvpx-vp9", "-crf", "24", "-b:v", "0", "-row-mt", "1"]
    } else {
        &["-f", "mp4", "-c:v", "libx264", "-crf", "17", "-preset", "slow", "-movflags", "+faststart"]
    };
    write_through(path, |temporary| {
        let mut ffmpeg = Command::new("ffmpeg");
        ffmpeg.args(["-nostdin", "-loglevel", "error", "-y", "-framerate"]);
        ffmpeg.arg(frames_per_second.to_string()).arg("-start_number").arg("0");
        ffmpeg.arg("-i").arg(pattern(path)).arg("-frames:v").arg(frames.to_string());
        // Both codecs halve the resolution of colour, which needs even sides.
        ffmpeg.args(["-vf", "crop=trunc(iw/2)*2:trunc(ih/2)*2", "-pix_fmt", "yuv420p"]).args(codec);
        let output = ffmpeg.arg(temporary).output().map_err(|cause| Error::write(path, &cause))?;
        if output.status.success() {
            return Ok(());
        }
        let said = String::from_utf8_lossy(&output.stderr);
        let (path, said) = (path.display(), said.trim());
        Err(Error::Run(format!("cannot write {path}: ffmpeg says: {said}; its frames are whole")))
    })
}

/// The name of all frames, as ffmpeg wants it.
fn pattern(path: &Path) -> std::path::PathBuf {
    let stem = path.file_stem().unwrap_or_default().to_string_lossy().replace('%', "%%");
    path.with_file_name(format!("{stem}-%05d.png"))
}
