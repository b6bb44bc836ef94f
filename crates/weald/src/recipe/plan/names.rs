//! Names of all files that a run writes, by the recipe alone: what would overwrite what is known before anything runs.

use std::collections::{BTreeMap, BTreeSet};
use std::ffi::OsStr;
use std::fmt::{Display, Formatter};
use std::path::{Path, PathBuf};

use super::films::{Film, Motion};
use super::outputs::{Content, Output, lower, same_file};
use super::steps::Planned;
use crate::recipe::checkpoint::PARTS_FOLDER;
use crate::recipe::{CHECKPOINT_FILE, REPORT_FILE};
use weald_core::parameter::Diagnostics;
use weald_export::classes::is_of_classes;
use weald_export::shades::shades;
use weald_io::Drawn;
use weald_io::PartName;

/// Folder inside the output folder in which a run makes its files before it gives them their names.
pub(in crate::recipe) const WORK_FOLDER: &str = ".weald";

/// Longest name of a file or a folder that is taken, in bytes: file systems have 255, and a file that is being written
/// has a longer name than the file.
const MAX_NAME: usize = 200;

/// Longest path inside the output folder that is taken, in bytes.
const MAX_PATH: usize = 1000;

/// What an output writes; paths are inside the output folder.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(in crate::recipe) enum Name {
    /// A file.
    File(PathBuf),
    /// A folder, which is replaced as a whole, and a file that is in every folder of its kind.
    Folder {
        /// The folder.
        path: PathBuf,
        /// The file, by its path in the folder.
        holds: String,
    },
    /// The numbered pictures of a film of that name, so many.
    Frames(PathBuf, u64),
}

impl Name {
    /// The name of a part of an output.
    fn of(part: &PartName, file: &Path) -> Self {
        match part {
            PartName::Inside(part) => Self::Folder { path: file.to_owned(), holds: part.clone() },
            other => Self::File(other.path(file)),
        }
    }

    /// A path that stands for it: of frames the last, which is the longest.
    pub(in crate::recipe) fn path(&self) -> PathBuf {
        match self {
            Self::File(path) | Self::Folder { path, .. } => path.clone(),
            Self::Frames(film, count) => Film::frame(film, count.saturating_sub(1)),
        }
    }

    /// A path that both would write to, as the first of them has it.
    fn clash(&self, other: &Self) -> Option<PathBuf> {
        match (self, other) {
            (Self::Frames(film, _), Self::Frames(..)) => {
                let first = Film::frame(film, 0);
                let theirs = other.first();
                same_file(&first, &theirs).then_some(first)
            }
            (Self::Frames(film, count), _) => frame_at(film, *count, &other.path()),
            (_, Self::Frames(film, count)) => frame_at(film, *count, &self.path()),
            _ => {
                let [mine, theirs] = [self.path(), other.path()].map(|path| lower(&path));
                (mine.starts_with(&theirs) || theirs.starts_with(&mine)).then(|| self.path())
            }
        }
    }

    fn first(&self) -> PathBuf {
        match self {
            Self::Frames(film, _) => Film::frame(film, 0),
            _ => self.path(),
        }
    }
}

/// The frame of a film that is a path or that is a folder above it.
fn frame_at(film: &Path, count: u64, path: &Path) -> Option<PathBuf> {
    path.ancestors().filter(|part| !part.as_os_str().is_empty()).find_map(|part| {
        let stem = lower(part).file_stem()?.to_str()?.to_owned();
        let number = stem.rsplit_once('-')?.1.parse().ok().filter(|number| *number < count)?;
        let frame = Film::frame(film, number);
        same_file(&frame, part).then_some(frame)
    })
}

/// What a file of a layer says of how it is drawn.
fn drawn(layer: &str) -> Drawn {
    match shades(layer) {
        Some(_) => Drawn::Shades,
        None if is_of_classes(layer) => Drawn::Classes,
        None => Drawn::Plain,
    }
}

impl Output {
    /// Everything that it may write, which the steps decide for a time-lapse.
    pub(in crate::recipe) fn names(&self, steps: &[Planned]) -> Vec<Name> {
        let own = || Name::File(self.file.clone());
        match &self.content {
            Content::Layer { name, encode, .. } => self.parts(&encode.names(drawn(name))),
            Content::Export { export, .. } => self.parts(&export.names(&self.file)),
            Content::Picture { .. } => vec![own()],
            Content::Film { film, .. } => {
                let has_own = Film::is_apng(&self.file) || Film::is_video(&self.file);
                let lapses = matches!(film.motion, Motion::TimeLapse(_));
                // Those of a time-lapse in one file are drawn before it, and are gone when it is whole.
                let frames = (lapses || !Film::is_apng(&self.file))
                    .then(|| Name::Frames(self.file.clone(), film.motion.frames(steps)));
                has_own.then(own).into_iter().chain(frames).collect()
            }
        }
    }

    fn parts(&self, parts: &[PartName]) -> Vec<Name> {
        // A folder holds many parts, and is one thing that is written; what lies right in it is in every such folder.
        let inside = parts.iter().filter(|part| matches!(part, PartName::Inside(_)));
        let folder = inside.min_by_key(|part| part.path(&self.file).components().count());
        let beside = parts.iter().filter(|part| !matches!(part, PartName::Inside(_)));
        beside.chain(folder).map(|part| Name::of(part, &self.file)).collect()
    }
}

impl Display for Name {
    fn fmt(&self, formatter: &mut Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Frames(..) => {
                write!(formatter, "{} to {}", self.first().display(), self.path().display())
            }
            _ => write!(formatter, "{}", self.path().display()),
        }
    }
}

/// Complains of two outputs that would write to the same place, and of names that no file can have.
pub(super) fn check(outputs: &[Output], steps: &[Planned], diagnostics: &mut Diagnostics) {
    "output".clone_into(&mut diagnostics.subject);
    let named: Vec<_> = outputs.iter().map(|output| (output, output.names(steps))).collect();
    let mut taken = Taken::default();
    for (at, (output, names)) in named.iter().enumerate() {
        let faults = names.iter().filter_map(fault).take(1);
        let twice = names.iter().enumerate().find_map(|(first, name)| clash_within(name, &names[..first]));
        let earlier = taken.near(names, at).into_iter().map(|at| &named[at]);
        let earlier = earlier.filter(|(earlier, _)| !same_file(&earlier.file, &output.file));
        let others = earlier.filter_map(|(earlier, theirs)| clash(output, (earlier, theirs), names));
        for message in faults.chain(twice).chain(others) {
            diagnostics.add(output.line, message);
        }
        taken.add(names, at);
    }
}

/// Which outputs have names in which folders, so that not every output is compared with every other.
#[derive(Default)]
struct Taken {
    /// Outputs by each of their paths and each folder above one.
    by_path: BTreeMap<PathBuf, BTreeSet<usize>>,
    /// The same, by the paths themselves alone.
    by_own_path: BTreeMap<PathBuf, BTreeSet<usize>>,
    /// Outputs with frames, which are more than one would list.
    with_frames: BTreeSet<usize>,
}

impl Taken {
    fn add(&mut self, names: &[Name], output: usize) {
        for name in names {
            if matches!(name, Name::Frames(..)) {
                self.with_frames.insert(output);
                continue;
            }
            let path = lower(&name.path());
            for part in path.ancestors() {
                self.by_path.entry(part.to_owned()).or_default().insert(output);
            }
            self.by_own_path.entry(path).or_default().insert(output);
        }
    }

    /// Outputs before `output` that may clash with names: those that have one of the paths, a folder above one or something
    /// below one, and those with frames.
    fn near(&self, names: &[Name], output: usize) -> BTreeSet<usize> {
        if names.iter().any(|name| matches!(name, Name::Frames(..))) {
            return (0..output).collect();
        }
        let mut near = self.with_frames.clone();
        for path in names.iter().map(|name| lower(&name.path())) {
            near.extend(self.by_path.get(&path).into_iter().flatten());
            near.extend(path.ancestors().filter_map(|part| self.by_own_path.get(part)).flatten());
        }
        near
    }
}

fn clash_within(name: &Name, earlier: &[Name]) -> Option<String> {
    let path = earlier.iter().find_map(|earlier| name.clash(earlier))?;
    Some(format!("would write {} twice; give its parts other names", path.display()))
}

fn clash(output: &Output, (earlier, theirs): (&Output, &[Name]), names: &[Name]) -> Option<String> {
    let path = names.iter().find_map(|name| theirs.iter().find_map(|other| name.clash(other)))?;
    let (path, file) = (path.display(), output.file.display());
    let (theirs, line) = (earlier.file.display(), earlier.line);
    Some(format!(
        "{file} would write {path}, where {theirs} of line {line} writes too; give one of them another name"
    ))
}

/// What is wrong with a name for itself.
fn fault(name: &Name) -> Option<String> {
    let path = name.path();
    let shown = path.display();
    let own = [REPORT_FILE, CHECKPOINT_FILE, PARTS_FOLDER, WORK_FOLDER];
    let top = path.components().next().map(|first| lower(Path::new(first.as_os_str())));
    if top.is_some_and(|top| own.iter().any(|own| top == Path::new(own))) {
        return Some(format!("would write {shown}, a name that every run uses itself"));
    }
    let longest = path.iter().map(OsStr::len).max().unwrap_or_default();
    if longest > MAX_NAME || path.as_os_str().len() > MAX_PATH {
        return Some(format!(
            "would write {shown}, which is too long: a name has at most {MAX_NAME} bytes, a path {MAX_PATH}"
        ));
    }
    None
}
