//! One sheet of small pictures of what each step does, for the list from which steps are added.

use std::path::Path;

use weald::Error;
use weald::picture::Image;
use weald::recipe::catalog::CATALOG;
use weald::recipe::{Options, Overrides, Recipe, Run, Silent};

use crate::coding::decode;

/// Recipes, a part a step.
const RECIPES: &str = include_str!("step_pictures.txt");

/// What parts a recipe from the next.
const PART: &str = "\n### ";

/// Cells of each landscape; the pictures have half as many pixels along each side.
const CELLS: [usize; 2] = [192, 108];

/// Pictures beside each other.
const COLUMNS: usize = 8;

const LANDSCAPE: &str = "weald = 1\n[landscape]\nsize = [192, 108]\ncell = 20.0\nseed = 7\n";
const SEA: &str = "sea_level = 220.0\n";
const BEDS: &str = r##"
[[material]]
name = "rock"
[[material]]
name = "shale"
like = "clay"
bottom = 180.0
colour = "#8d5b47"
[[material]]
name = "sandstone"
like = "rock"
bottom = 260.0
colour = "#cb8e58"
"##;
const SOIL: &str = "[[material]]\nname = \"soil\"\nthickness = 1.0\n";
const HILLS: &str = "[[step]]\ndo = \"fbm\"\nrelief = 500.0\nwavelength = 1500.0\n";

/// Makes the sheet, a PNG that names its steps in their order, and gives their number.
///
/// # Errors
/// [`Error::Run`] for a step of the catalogue without a recipe, and whatever ends a recipe.
pub fn step_pictures(into: &Path) -> Result<usize, Error> {
    let folder = tempfile::tempdir().map_err(|cause| Error::Run(format!("no temporary folder: {cause}")))?;
    let ground = format!("{LANDSCAPE}{HILLS}[[output]]\nlayer = \"height\"\nfile = \"ground.tif\"\n");
    run(folder.path(), &ground)?;
    let names: Vec<_> = CATALOG.iter().map(|entry| entry.name).collect();
    let pictures = names.iter().map(|name| picture_of(folder.path(), name));
    let pictures = pictures.collect::<Result<Vec<_>, Error>>()?;
    let bytes = encoded(&sheet(&pictures), &names.join(" "))
        .map_err(|cause| Error::Run(format!("cannot encode the sheet: {cause}")))?;
    weald::io::write_whole(into, &bytes)?;
    Ok(names.len())
}

fn run(folder: &Path, text: &str) -> Result<(), Error> {
    let recipe = Recipe::parse(&folder.join("step.toml").display().to_string(), text, &Overrides::default())?;
    Run { recipe: &recipe, options: Options::into_folder(folder) }.execute(&Silent).map(drop)
}

fn picture_of(folder: &Path, name: &str) -> Result<Image, Error> {
    run(folder, &recipe_of(name)?)?;
    halved(&decode(&folder.join("step.png"))?)
}

/// The whole recipe of the picture of a step.
fn recipe_of(name: &str) -> Result<String, Error> {
    let part = |part: &&str| part.split_whitespace().next() == Some(name);
    let part = RECIPES.split(PART).find(part);
    let missing = || Error::Run(format!("step_pictures.txt has no part for the step `{name}`"));
    let (head, steps) = part.and_then(|part| part.split_once('\n')).ok_or_else(missing)?;
    let is = |word: &str| head.split_whitespace().skip(1).any(|other| other == word);
    let mut text = LANDSCAPE.to_owned();
    for (wanted, more) in [
        (is("sea"), SEA),
        (is("beds") || is("materials"), BEDS),
        (is("materials"), SOIL),
        (!is("alone"), HILLS),
        (true, steps),
        (!steps.contains("[[output]]"), "\n[[output]]\npicture = \"relief\"\n"),
        (steps.contains("picture = \"map\""), "\nlegend = false\n"),
        (true, "\nwidth = 192\nfile = \"step.png\"\n"),
    ] {
        text += if wanted { more } else { "" };
    }
    Ok(text)
}

/// A picture of as many pixels as there are cells, half as large; what is lower or higher lies or is cut around its middle.
fn halved(image: &Image) -> Result<Image, Error> {
    let [width, height] = CELLS;
    if image.width != width {
        return Err(Error::Run(format!("a picture has {} × {} pixels", image.width, image.height)));
    }
    let (above, below) = (height.saturating_sub(image.height) / 2, image.height.saturating_sub(height) / 2);
    let mut half = Image::paper(width / 2, height / 2);
    for (at, value) in half.rgb.iter_mut().enumerate() {
        let (pixel, channel) = (at / 3, at % 3);
        let (x, y) = (2 * (pixel % (width / 2)), 2 * (pixel / (width / 2)) + below);
        let of = |right: usize, down: usize| {
            let row = (y + down).checked_sub(above).filter(|&row| row < image.height);
            row.map_or(*value, |row| image.rgb[3 * (row * width + x + right) + channel])
        };
        let sum: u32 = [of(0, 0), of(1, 0), of(0, 1), of(1, 1)].map(u32::from).iter().sum();
        *value = (sum / 4) as u8;
    }
    Ok(half)
}

/// All pictures in rows.
fn sheet(pictures: &[Image]) -> Image {
    let [width, height] = CELLS.map(|cells| cells / 2);
    let mut sheet = Image::paper(COLUMNS * width, pictures.len().div_ceil(COLUMNS) * height);
    for (number, picture) in pictures.iter().enumerate() {
        let (left, top) = (number % COLUMNS * width, number / COLUMNS * height);
        for (y, row) in picture.rgb.chunks_exact(3 * width).enumerate() {
            sheet.rgb[3 * ((top + y) * sheet.width + left)..][..3 * width].copy_from_slice(row);
        }
    }
    sheet
}

/// As a PNG with the names of its steps. Colours have 32 levels a channel: nobody sees more at this size, and the file is
/// a third as large.
fn encoded(sheet: &Image, names: &str) -> Result<Vec<u8>, png::EncodingError> {
    let rgb: Vec<u8> = sheet.rgb.iter().map(|value| value & 0xf8 | value >> 5).collect();
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, sheet.width as u32, sheet.height as u32);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_compression(png::Compression::High);
    encoder.add_text_chunk("Steps".to_owned(), names.to_owned())?;
    encoder.write_header()?.write_image_data(&rgb)?;
    Ok(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_step_of_the_catalogue_has_a_recipe_that_holds() {
        for entry in CATALOG {
            let text = recipe_of(entry.name).unwrap_or_else(|error| panic!("{error}"));
            assert!(text.contains(&format!("do = \"{}\"", entry.name)), "{text}");
            Recipe::parse("step.toml", &text, &Overrides::default())
                .unwrap_or_else(|error| panic!("{}: {error}", entry.name));
        }
        let parts = RECIPES.split(PART).skip(1).count();
        assert_eq!(parts, CATALOG.len(), "a part for each step, and no other");
    }
}
