//! `weald fractal`.

use std::fmt::Write;
use std::path::{Path, PathBuf};

use weald::Error;
use weald::grow::ifs::shapes::SHAPES;
use weald::recipe::{FractalRequest, Options, Recipe, Run};

use crate::arguments::FractalArguments;
use crate::failure::Failure;
use crate::progress::ProgressPrinter;
use crate::{interrupt, stdout};

/// The word in place of a name that lists the built-in fractals.
const LIST: &str = "list";

pub(crate) fn fractal(arguments: &FractalArguments) -> Result<(), Failure> {
    if arguments.name == LIST {
        return stdout::print(&list());
    }
    let files = [picture(arguments), points(arguments)];
    let recipes: Vec<(PathBuf, Recipe)> = files
        .into_iter()
        .flatten()
        .map(|(path, keys)| Ok((path.clone(), recipe(arguments, &path, keys)?)))
        .collect::<Result<_, Failure>>()?;
    interrupt::listen_without_checkpoint()?;
    for (path, recipe) in &recipes {
        draw(arguments, path, recipe)?;
    }
    Ok(())
}

type Keys = Vec<(String, String)>;

/// The picture, unless points alone are asked for.
fn picture(arguments: &FractalArguments) -> Option<(PathBuf, Keys)> {
    let path = match (&arguments.output, &arguments.points) {
        (Some(path), _) => path.clone(),
        (None, Some(_)) => return None,
        (None, None) => Path::new(Path::new(&arguments.name).file_stem()?).with_extension("png"),
    };
    let mut keys = vec![key("picture", "\"fractal\"")];
    keys.extend(arguments.picture.clone());
    let has = |name: &str| arguments.picture.iter().any(|(key, _)| key == name);
    // A depth makes sense for an expansion alone.
    if has("depth") && !has("draw") {
        keys.push(key("draw", "\"dots\""));
    }
    Some((path, keys))
}

fn points(arguments: &FractalArguments) -> Option<(PathBuf, Keys)> {
    let path = arguments.points.clone()?;
    let mut keys = vec![key("export", "\"points\"")];
    keys.extend(arguments.export.clone());
    let of_picture = |name: &str| arguments.picture.iter().find(|(key, _)| key == name).cloned();
    // An expansion draws no points at random.
    keys.extend(of_picture("depth").or_else(|| of_picture("seed")));
    Some((path, keys))
}

fn key(key: &str, value: &str) -> (String, String) {
    (key.to_owned(), value.to_owned())
}

fn recipe(arguments: &FractalArguments, path: &Path, mut keys: Keys) -> Result<Recipe, Failure> {
    let Some(file) = path.file_name() else {
        return Err(Failure::usage(format!("{} is no name of a file", path.display())));
    };
    keys.push(key("file", &format!("{:?}", file.to_string_lossy())));
    let request =
        FractalRequest { of: arguments.name.clone(), deform: arguments.deform.clone(), outputs: vec![keys] };
    request.recipe().map_err(|error| match error {
        Error::Recipe(error) if error.diagnostics.iter().all(|diagnostic| diagnostic.line == 0) => {
            let messages: Vec<_> =
                error.diagnostics.iter().map(|diagnostic| diagnostic.message.as_str()).collect();
            Failure::usage(messages.join("\n"))
        }
        other => other.into(),
    })
}

/// Writes the file, with progress on stderr.
fn draw(arguments: &FractalArguments, path: &Path, recipe: &Recipe) -> Result<(), Failure> {
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let threads = arguments.threads.map(usize::from);
    let options = Options { threads, report: false, ..Options::into_folder(folder) };
    let shown = ProgressPrinter::new(arguments.quiet);
    let report = Run { recipe, options }.execute(&shown);
    shown.end();
    let report = report?;
    if arguments.quiet {
        return Ok(());
    }
    let mut text = String::new();
    for file in report.outputs[0].files() {
        // As it was asked for: a name without a folder stays one.
        let _ = writeln!(text, "{}", path.with_file_name(file).display());
    }
    stdout::print(&text)
}

/// A line for each built-in fractal.
fn list() -> String {
    let mut text = String::new();
    for shape in SHAPES {
        let ifs = shape.ifs();
        let dimensions = if ifs.is_planar() { "2D" } else { "3D" };
        let maps = ifs.maps().len();
        let _ = writeln!(text, "{:<12} {maps} maps, {dimensions}  {}", shape.name, shape.summary);
    }
    text
}
