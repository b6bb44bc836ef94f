//! Outputs for other programs, chosen at once: which files a preset writes of a recipe, and what each of them loses.

use toml_edit::DocumentMut;
use weald::Field;
use weald::export::EXPORTS;
use weald::io::{FORMATS, Raster};
use weald::recipe::{Content, Output, Overrides, Recipe};
use weald::{Error, Landscape, Size};

/// A choice of outputs.
pub(crate) struct Preset {
    pub(crate) name: &'static str,
    /// What it is for.
    pub(crate) what: &'static str,
    /// The `[[output]]` tables that it would like, without their heads.
    wishes: fn(&Made) -> Vec<String>,
}

/// All of them, beside what the recipe itself says.
pub(crate) const PRESETS: [Preset; 6] = [
    Preset { name: "Unreal", what: "heights, weight maps and meshes for Unreal Engine", wishes: unreal },
    Preset { name: "Godot (Terrain3D)", what: "terrain and plants for Godot", wishes: godot },
    Preset { name: "Unity", what: "terrain and meshes for Unity", wishes: unity },
    Preset {
        name: "Blender",
        what: "ground, plants and grass as meshes, heights as an image",
        wishes: blender,
    },
    Preset {
        name: "GIS",
        what: "every layer as a GeoTIFF for the cloud, rivers and lakes as vectors",
        wishes: gis,
    },
    Preset {
        name: "Everything",
        what: "every format and every kind of export that there is",
        wishes: everything,
    },
];

/// What a recipe makes that can be written.
struct Made {
    layers: Vec<String>,
    /// Materials above the bedrock.
    materials: Vec<String>,
    plants: Vec<String>,
    grass: Vec<String>,
}

/// What a preset writes.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Outputs {
    /// The `[[output]]` tables.
    pub(crate) text: String,
    /// Each file, with what it is and what is lost in it.
    pub(crate) files: Vec<(String, String)>,
    /// What cannot be written of this recipe, with the reason.
    pub(crate) left_out: Vec<String>,
}

impl Preset {
    /// The outputs of a recipe that can run; `shown` is the landscape that it makes, where there is one.
    pub(crate) fn outputs(
        &self,
        (file, text): (&str, &str),
        shown: Option<&Landscape>,
    ) -> Result<Outputs, String> {
        let recipe = Recipe::parse(file, text, &Overrides::default()).map_err(|error| error.to_string())?;
        let mut outputs = Outputs::default();
        for wish in (self.wishes)(&Made::of(&recipe)) {
            let table = format!("[[output]]\n{wish}\n");
            match parsed(file, text, &format!("{}{table}", outputs.text)) {
                Ok(recipe) => {
                    outputs.files.extend(recipe.outputs.last().map(|output| said(output, shown)));
                    outputs.text.push_str(&table);
                }
                Err(reason) => outputs.left_out.push(format!("{}: {reason}", wish.replace('\n', ", "))),
            }
        }
        Ok(outputs)
    }
}

/// What the outputs of a recipe write as it is.
pub(crate) fn of_recipe((file, text): (&str, &str), shown: Option<&Landscape>) -> Result<Outputs, String> {
    let recipe = Recipe::parse(file, text, &Overrides::default()).map_err(|error| error.to_string())?;
    let files = recipe.outputs.iter().map(|output| said(output, shown)).collect();
    Ok(Outputs { files, ..Outputs::default() })
}

/// A recipe with other outputs; all else stays as it is written.
///
/// # Errors
/// [`Error::Run`] for a text that is no TOML.
pub(crate) fn with_outputs(text: &str, outputs: &str) -> Result<String, Error> {
    let parsed = text.parse::<DocumentMut>();
    let mut document =
        parsed.map_err(|error| Error::Run(format!("the recipe is no TOML: {}", error.message())))?;
    document.remove("output");
    Ok(format!("{}\n\n{outputs}", document.to_string().trim_end()))
}

fn parsed(file: &str, text: &str, outputs: &str) -> Result<Recipe, String> {
    let text = with_outputs(text, outputs).map_err(|error| error.to_string())?;
    Recipe::parse(file, &text, &Overrides::default()).map_err(|error| {
        let said = error.to_string();
        // The first fault, without the place in a text that nobody has seen.
        let first = said.lines().next().unwrap_or_default();
        first.rsplit_once(": output: ").map_or(first, |(_, reason)| reason).to_owned()
    })
}

/// A file, and what is lost in it.
fn said(output: &Output, shown: Option<&Landscape>) -> (String, String) {
    let what = match &output.content {
        Content::Layer { name, holds, .. } => {
            let losses = holds.losses(&raster_of(shown));
            let losses = if losses.is_empty() { "nothing is lost".to_owned() } else { losses.join("; ") };
            format!("{name}: {losses}")
        }
        Content::Export { name, .. } => {
            EXPORTS.iter().find(|entry| entry.name == *name).map_or("", |entry| entry.summary).to_owned()
        }
        Content::Picture { name, .. } | Content::Film { name, .. } => format!("{name}: a picture, no data"),
    };
    (output.file.display().to_string(), what)
}

/// All that a raster of the landscape would know, with a single value.
fn raster_of(shown: Option<&Landscape>) -> Raster {
    let one = Size { columns: 1, rows: 1 };
    let domain = shown.map(|landscape| &landscape.domain);
    Raster {
        cell: Some(1.0),
        valid: domain.and_then(|domain| domain.valid.clone()),
        georeference: domain.and_then(|domain| domain.georeference.clone()),
        ..Raster::from(Field::filled(one, 0.0))
    }
}

impl Made {
    fn of(recipe: &Recipe) -> Self {
        let mut layers = vec!["height".to_owned()];
        let steps = || recipe.steps.iter().map(|planned| &planned.step);
        for (name, _) in steps().flat_map(|step| step.writes()) {
            if !layers.contains(&name) {
                layers.push(name);
            }
        }
        let materials =
            recipe.materials.iter().skip(1).map(|planned| planned.material.name.clone()).collect();
        let plants = steps().flat_map(|step| step.plants()).collect();
        let grass = steps().flat_map(|step| step.meadows()).collect();
        Self { layers, materials, plants, grass }
    }

    /// Plants and grass as meshes.
    fn meshes(&self, folder: &str) -> Vec<String> {
        let land = format!("export = \"mesh\"\nfile = \"{folder}land.glb\"");
        let plants = self.plants.iter().map(|name| grown("plants", name, &format!("{folder}{name}.glb")));
        let grass = self.grass.iter().map(|name| grown("grass", name, &format!("{folder}{name}.glb")));
        std::iter::once(land).chain(plants).chain(grass).collect()
    }
}

fn grown(export: &str, of: &str, file: &str) -> String {
    format!("export = \"{export}\"\nof = \"{of}\"\nfile = \"{file}\"")
}

fn layer(name: &str, file: &str) -> String {
    format!("layer = \"{name}\"\nfile = \"{file}\"")
}

fn unreal(made: &Made) -> Vec<String> {
    let masks: Vec<_> =
        made.materials.iter().map(|name| format!("{{ layer = \"{name}\", high = 2.0 }}")).collect();
    let masks = if masks.is_empty() { String::new() } else { format!("\nmasks = [{}]", masks.join(", ")) };
    let heights = format!("export = \"unreal\"\nfile = \"unreal/height.png\"{masks}");
    let plain = "export = \"unreal\"\nfile = \"unreal/height.png\"".to_owned();
    // Materials without layers of their own have no weight maps.
    let landscape =
        if made.materials.iter().all(|name| made.layers.contains(name)) { heights } else { plain };
    std::iter::once(landscape).chain(made.meshes("unreal/").into_iter().skip(1)).collect()
}

fn godot(made: &Made) -> Vec<String> {
    let terrain = "export = \"terrain3d\"\nfile = \"godot/height.exr\"".to_owned();
    std::iter::once(terrain).chain(made.meshes("godot/").into_iter().skip(1)).collect()
}

fn unity(made: &Made) -> Vec<String> {
    let terrain = "export = \"unity\"\nfile = \"unity/height.raw\"".to_owned();
    std::iter::once(terrain).chain(made.meshes("unity/").into_iter().skip(1)).collect()
}

fn blender(made: &Made) -> Vec<String> {
    let heights = "layer = \"height\"\npreset = \"blender\"\nfile = \"blender/height.exr\"".to_owned();
    made.meshes("blender/").into_iter().chain([heights]).collect()
}

fn gis(made: &Made) -> Vec<String> {
    let layers = made
        .layers
        .iter()
        .map(|name| format!("layer = \"{name}\"\npreset = \"cog\"\nfile = \"gis/{name}.tif\""));
    let vectors =
        ["rivers", "lakes"].map(|name| format!("export = \"{name}\"\nfile = \"gis/{name}.geojson\""));
    // A layer of the same name has its style, too.
    let plants = made.plants.iter().map(|name| grown("plants", name, &format!("gis/{name}-points.geojson")));
    layers.chain(vectors).chain(plants).collect()
}

/// Every format with each of its presets, every layer, and every kind of export, as the registries have them.
fn everything(made: &Made) -> Vec<String> {
    let mut wishes = Vec::new();
    for format in FORMATS.iter().filter(|format| format.encode.is_some()) {
        let extension = format.extensions[0];
        wishes.push(layer("height", &format!("height.{extension}")));
        for preset in format.presets {
            let file = format!("height-{}.{extension}", preset.name);
            wishes.push(format!("preset = \"{}\"\n{}", preset.name, layer("height", &file)));
        }
    }
    wishes.extend(made.layers.iter().skip(1).map(|name| layer(name, &format!("{name}.tif"))));
    for export in EXPORTS {
        let named = match export.name {
            "plants" => &made.plants,
            "grass" => &made.grass,
            _ => &Vec::new(),
        };
        for extension in export.extensions {
            let file = |name: &str| format!("{}/{name}.{extension}", export.name);
            if named.is_empty() {
                wishes.push(format!("export = \"{}\"\nfile = \"{}\"", export.name, file("landscape")));
            }
            wishes.extend(named.iter().map(|name| grown(export.name, name, &file(name))));
        }
    }
    wishes
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = "[landscape]\nsize = 32\ncell = 20.0\n\n[[step]]\ndo = \"diamond-square\" # rough\n\n\
        [[step]]\ndo = \"scatter\"\n\n[[output]]\nlayer = \"height\"\nfile = \"mine.tif\"\n";

    fn outputs(name: &str) -> Outputs {
        let preset = PRESETS.iter().find(|preset| preset.name == name).expect("there");
        preset.outputs(("a.toml", TEXT), None).expect("outputs")
    }

    #[test]
    fn every_preset_gives_a_recipe_that_can_run_and_all_else_stays() {
        for preset in PRESETS {
            let Outputs { text, files, .. } = outputs(preset.name);
            let whole = with_outputs(TEXT, &text).expect("a text");
            let recipe = Recipe::parse("a.toml", &whole, &Overrides::default())
                .unwrap_or_else(|error| panic!("{error}"));
            assert_eq!(recipe.outputs.len(), files.len(), "{}", preset.name);
            assert!(!files.is_empty() && !whole.contains("mine.tif") && whole.contains("# rough"), "{whole}");
        }
    }

    #[test]
    fn what_is_lost_and_what_cannot_be_written_is_said_with_its_reason() {
        let all = outputs("Everything");
        let said =
            |file: &str| all.files.iter().find(|(name, _)| name == file).map(|(_, said)| said.as_str());
        assert!(
            said("height.png").is_some_and(|said| said.contains("rounded to a 65,535th")),
            "{:?}",
            all.files
        );
        assert!(said("height.tif").is_some_and(|said| said.contains("nothing is lost")));
        assert!(said("plants/plants.glb").is_some() && said("unity/landscape.raw").is_some());
        let formats = FORMATS.iter().filter(|format| format.encode.is_some());
        for format in formats {
            assert!(said(&format!("height.{}", format.extensions[0])).is_some(), "{}", format.name);
        }
        let rivers = all.left_out.iter().find(|one| one.contains("rivers")).expect("no river was made");
        assert!(rivers.contains("no step"), "{rivers}");
    }
}
