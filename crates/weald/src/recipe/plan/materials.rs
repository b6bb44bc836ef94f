//! The `[[material]]` tables: what the ground is made of, bedrock first.

use std::path::PathBuf;

use super::files::Files;
use super::words::tables;
use crate::recipe::layer_file::{FileUnit, said};
use weald_core::material::{MAX_MATERIALS, Material, RESERVED};
use weald_core::parameter::{Colour, CrsCode, Diagnostics, LayerName, Parameters, RasterFile};
use weald_core::source::Table;
use weald_io::Said;

weald_core::choices! {
    /// The built-in materials.
    pub enum BuiltIn {
        /// Hard and steep: bedrock.
        Rock = "rock",
        /// Soft and dark.
        Soil = "soil",
        /// The softest, and the flattest at rest.
        Sand = "sand",
        /// Coarse: water moves it less than soil.
        Gravel = "gravel",
        /// Fine and sticky: it stands steeper than soil and wears less.
        Clay = "clay",
    }
}

weald_core::parameters! {
    /// The keys of `[[material]]`. Without a table, ground is of rock, and of soil where water lays it down.
    pub struct MaterialKeys {
        /// Name, and that of the layer of its thickness; the first material is the bedrock, whose layer is
        /// `bedrock`, the height of its top.
        name: LayerName = LayerName::needed();
        /// Built-in material whose values stand for keys that are absent. By default the one of this name,
        /// else rock for the bedrock and soil for all others.
        like: Option<BuiltIn> = None;
        /// Share of the unused transport capacity of the water that an iteration takes from this material.
        erodibility: Option<f64> = None, range 0.0..=1.0;
        /// Share of the regolith still missing that standing water makes of it in an iteration: how readily it softens.
        solubility: Option<f64> = None, range 0.0..=1.0;
        /// Steepest slope that rests.
        talus_deg: Option<f64> = None, range 0.0..=89.0, unit "deg";
        /// Colour in pictures.
        colour: Option<Colour> = None;
        /// Thickness, the same everywhere. Not for the bedrock.
        thickness: Option<f64> = None, range 0.0..=100_000.0, unit "m";
        /// Elevation at which the material begins, in place of a thickness: it fills the ground from there up
        /// to what lies on it, so that several bottoms are level strata. Not for the bedrock.
        bottom: Option<f64> = None, range -100_000.0..=100_000.0, unit "m";
        /// File of thicknesses, in place of one thickness, as many cells as the landscape has at its start.
        /// Not for the bedrock.
        from: Option<RasterFile> = None;
        /// Metres that a 1 in that file stands for. By default 1.
        scale: Option<f64> = None, range 1.0e-9..=1.0e9, unit "m", with from;
        /// Unit of the values of that file, where it names none; without it they are metres.
        unit: Option<FileUnit> = None, with from;
        /// Coordinate reference system of that file, where it names none.
        crs: Option<CrsCode> = None, with from;
        /// Number of the cells without data in that file, where it does not say it.
        nodata: Option<f64> = None, with from;
    }
}

/// A material, and the file of its thickness at the start.
#[derive(Clone, Debug, PartialEq)]
pub struct PlannedMaterial {
    /// Line of its table; 0 for a material of a recipe that names none.
    pub line: usize,
    /// The material.
    pub material: Material,
    /// The file, with the metres that a 1 in it stands for and what the recipe says of it.
    pub file: Option<(PathBuf, f64, Said)>,
}

pub(super) fn read(files: Files<'_>, recipe: &Table, diagnostics: &mut Diagnostics) -> Vec<PlannedMaterial> {
    "material".clone_into(&mut diagnostics.subject);
    let tables = tables(recipe, "material", diagnostics);
    if recipe.get("material").is_none() {
        let plain = |material| PlannedMaterial { line: 0, material, file: None };
        return Material::default_stack().into_iter().map(plain).collect();
    }
    if let Some(table) = tables.get(MAX_MATERIALS) {
        let message =
            format!("there are {} materials; the ground takes at most {MAX_MATERIALS}", tables.len());
        diagnostics.add(table.line, message);
    }
    let mut materials: Vec<PlannedMaterial> = Vec::new();
    for table in tables {
        let keys = files.placed(table, &MaterialKeys::parameters(), diagnostics);
        let keys = MaterialKeys::read(&keys, diagnostics);
        let checked = Checked { table, keys: &keys, below: &materials };
        checked.report_fault(diagnostics);
        let material = material(&keys, materials.is_empty());
        let said = said(keys.crs, keys.unit, keys.nodata);
        let file = keys.from.map(|from| (from.path(), keys.scale.unwrap_or(1.0), said));
        materials.push(PlannedMaterial { line: table.line, material, file });
    }
    materials
}

/// The material that the keys describe.
fn material(keys: &MaterialKeys, bedrock: bool) -> Material {
    let name = &keys.name.0;
    let usual = if bedrock { BuiltIn::Rock } else { BuiltIn::Soil };
    let like = match keys.like {
        Some(like) => like.word(),
        None => name,
    };
    let like = Material::built_in(like).or_else(|| Material::built_in(usual.word()));
    let like = like.expect("every word of `BuiltIn` is a built-in material");
    Material {
        name: name.clone(),
        erodibility: keys.erodibility.unwrap_or(like.erodibility),
        solubility: keys.solubility.unwrap_or(like.solubility),
        talus_deg: keys.talus_deg.unwrap_or(like.talus_deg),
        colour: keys.colour.map_or(like.colour, |colour| colour.0),
        thickness: keys.thickness.unwrap_or(like.thickness),
        bottom: keys.bottom,
    }
}

/// A table with those before it, to be checked for contradictions.
struct Checked<'a> {
    table: &'a Table,
    keys: &'a MaterialKeys,
    below: &'a [PlannedMaterial],
}

impl Checked<'_> {
    fn report_fault(&self, diagnostics: &mut Diagnostics) {
        let faults = [self.name(), self.bedrock(), self.several(), self.bottom()];
        for (key, fault) in faults.into_iter().flatten() {
            let line = self.table.get(key).map_or(self.table.line, |node| node.line);
            diagnostics.add(line, fault);
        }
    }

    /// The keys that say how thick the material is, of those that are given.
    fn extents(&self) -> impl Iterator<Item = &'static str> {
        ["thickness", "bottom", "from"].into_iter().filter(|key| self.table.get(key).is_some())
    }

    fn name(&self) -> Option<(&'static str, String)> {
        let name = &self.keys.name.0;
        if RESERVED.contains(&name.as_str()) {
            let fault = format!("`name` is {name:?}, a layer that is no material; choose another name");
            return Some(("name", fault));
        }
        let twin = self.below.iter().find(|below| !name.is_empty() && below.material.name == *name)?;
        Some(("name", format!("`name` is {name:?} a second time; line {} has it first", twin.line)))
    }

    fn bedrock(&self) -> Option<(&'static str, String)> {
        let key = self.extents().next().filter(|_| self.below.is_empty())?;
        Some((key, format!("`{key}` is not for the first material: it is the bedrock and reaches down")))
    }

    fn several(&self) -> Option<(&'static str, String)> {
        let [first, second] = [0, 1].map(|place| self.extents().nth(place));
        let (first, second) = first.zip(second)?;
        Some((second, format!("`{second}` does not go with `{first}`: either says how thick it is")))
    }

    /// Strata are named from below; one that begins under another would have no room.
    fn bottom(&self) -> Option<(&'static str, String)> {
        let bottom = self.keys.bottom?;
        let mut lower = self.below.iter().rev();
        let (name, under) = lower.find_map(|below| Some((&below.material.name, below.material.bottom?)))?;
        (bottom <= under).then(|| {
            let fault =
                format!("`bottom` is {bottom}, but must be above {under}, where `{name}` under it begins");
            ("bottom", fault)
        })
    }
}

#[cfg(test)]
mod tests {
    use crate::recipe::testing::{parse, refusal};

    /// A recipe whose first material stands on line 2.
    fn recipe(materials: &str) -> String {
        format!(
            "# materials\n{materials}[landscape]\nsize = 4\n[[step]]\ndo = \"rough\"\n[[output]]\nlayer = \
             \"height\"\nfile = \"a.bits\"\n"
        )
    }

    const ROCK: &str = "[[material]]\nname = \"granite\"\n";

    fn second(keys: &str) -> String {
        recipe(&format!("{ROCK}[[material]]\n{keys}"))
    }

    #[test]
    fn without_a_table_ground_is_rock_and_soil() {
        let names: Vec<_> = parse(&recipe("")).expect("good").materials;
        assert_eq!(
            names.iter().map(|planned| planned.material.name.as_str()).collect::<Vec<_>>(),
            ["rock", "soil"]
        );
    }

    #[test]
    fn absent_keys_are_those_of_the_material_it_is_like() {
        let text = second(
            "name = \"dune\"\nlike = \"sand\"\ncolour = \"#ff8000\"\nbottom = 20\n[[material]]\nname = \"clay\"\n",
        );
        let materials = parse(&text).expect("good").materials;
        let talus: Vec<_> = materials.iter().map(|planned| planned.material.talus_deg).collect();
        assert_eq!(talus, [75.0, 30.0, 40.0], "rock by place, sand by `like`, clay by name");
        assert_eq!(materials[1].material.colour, [1.0, 128.0 / 255.0, 0.0]);
        assert_eq!(materials[1].material.bottom, Some(20.0));
    }

    #[test]
    fn contradictions_are_told_with_their_lines() {
        let assert_refused = |text: &str, parts: &[&str]| {
            let message = refusal(text);
            assert!(parts.iter().all(|part| message.contains(part)), "{message}");
        };
        assert_refused(
            &second("name = \"water\"\n"),
            &["r.toml:5: material: `name` is \"water\"", "no material"],
        );
        assert_refused(
            &second("name = \"granite\"\n"),
            &[":5: material: `name` is \"granite\" a second time; line 2"],
        );
        assert_refused(
            &second("name = \"sand dune\"\n"),
            &[":5: material: `name` is \"sand dune\"", "letters"],
        );
        assert_refused(&second("like = \"sand\"\n"), &[":4: material: `name` is needed"]);
        assert_refused(
            &second("name = \"a\"\nlike = \"marble\"\n"),
            &[":6: material: `like` is", "\"gravel\""],
        );
        assert_refused(
            &second("name = \"a\"\ntalus = 30\n"),
            &[":6: material: unknown key `talus`; did you mean `talus_deg`?"],
        );
        assert_refused(
            &second("name = \"a\"\ntalus_deg = 90\n"),
            &[":6: ", "is 90, outside its range: 0 to 89"],
        );
        assert_refused(
            &second("name = \"a\"\ncolour = \"red\"\n"),
            &[":6: material: `colour` is \"red\"", "#d9bd85"],
        );
        assert_refused(
            &second("name = \"a\"\nthickness = 1\nbottom = 2\n"),
            &[":7: material: `bottom` does not go with `thickness`"],
        );
        assert_refused(
            &second("name = \"a\"\nscale = 2\n"),
            &[":6: material: `scale` has no effect without `from`"],
        );
        assert_refused(
            &second("name = \"a\"\nfrom = \"a.doc\"\n"),
            &[":6: material: `from`: ", "folder/a.doc"],
        );
        assert_refused(
            &recipe("[[material]]\nname = \"a\"\nbottom = 3\n"),
            &[":4: material: `bottom` is not for the first"],
        );
    }

    #[test]
    fn strata_are_named_from_below() {
        let strata = |upper: f64| {
            second(&format!(
                "name = \"a\"\nbottom = 50\n[[material]]\nname = \"b\"\nthickness = 1\n[[material]]\nname = \"c\"\nbottom = {upper}\n"
            ))
        };
        parse(&strata(50.5)).expect("above");
        let message = refusal(&strata(50.0));
        assert!(
            message.contains(":12: material: `bottom` is 50, but must be above 50, where `a`"),
            "{message}"
        );
    }

    #[test]
    fn a_ninth_material_is_refused() {
        let some = |count: usize| {
            let tables: Vec<_> = (0..count).map(|i| format!("[[material]]\nname = \"m{i}\"\n")).collect();
            recipe(&tables.concat())
        };
        parse(&some(8)).expect("eight are fine");
        let message = refusal(&some(9));
        assert_eq!(message, "folder/r.toml:18: material: there are 9 materials; the ground takes at most 8");
    }
}
