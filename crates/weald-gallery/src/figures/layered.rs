//! What the figures of layered ground share: materials, runs of the model, pictures, and slopes.

use weald::recipe::run_steps;
use weald_core::domain::Domain;
use weald_core::error::Error;
use weald_core::grid::{Field, Size};
use weald_core::landscape::Landscape;
use weald_core::material::Material;
use weald_core::parameter::LayerName;
use weald_picture::{Along, Image, Materials, Picture, Section};

/// Publication of the model.
pub(super) const SOURCE: &str = "Šťava, Beneš, Brisbin, Křivánek 2008, doi 10.2312/SCA/SCA08/201-210";

/// Pixels across a picture, and between two.
const WIDTH: u32 = 800;
const GAP: usize = 10;

/// Depth of water from which it is drawn, in metres: floods and brooks of these figures are shallow.
const SHALLOWEST: f64 = 0.01;

/// Colours that tell the materials apart at a glance: slate, pale gravel, ochre, clay.
const COLOURS: [(&str, [f32; 3]); 4] = [
    ("rock", [0.42, 0.47, 0.54]),
    ("gravel", [0.87, 0.83, 0.72]),
    ("soil", [0.80, 0.60, 0.36]),
    ("clay", [0.62, 0.36, 0.27]),
];

/// What the right half of a stage shows, for captions.
pub(super) const CUT_OPEN: &str =
    "to the left from above, to the right cut open along the dashed line, with the ground as it was in red";

/// A material that is like a built-in one, under a name of its own and in a colour that stands out.
pub(super) fn material(name: &str, like: &str) -> Material {
    let built_in = Material::built_in(like).expect("figures name built-in materials only");
    let known = COLOURS.iter().find(|(known, _)| *known == like);
    let colour = known.map_or(built_in.colour, |&(_, colour)| colour);
    Material { name: name.to_owned(), colour, ..built_in }
}

/// Ground of these materials, with cells of `cell` metres.
pub(super) fn ground(height: Field, cell: f64, materials: Vec<Material>) -> Landscape {
    let mut landscape = Landscape::new(Domain::new(height.size(), cell));
    landscape.materials = materials;
    landscape.insert("height", "m", height);
    landscape
}

/// The ground after a run of the model over open edges, without rain and evaporation.
pub(super) fn simulated(start: &Landscape, iterations: u32, keys: &str) -> Result<Landscape, Error> {
    let mut landscape = start.clone();
    let keys = format!(
        "model = \"stava\"\niterations = {iterations}\nrain = 0.0\nevaporation = 0.0\nboundary = \"open\"\n{keys}"
    );
    run_steps(&mut landscape, 0, &[("hydraulic", &keys)])?;
    Ok(landscape)
}

/// How the stages of a figure are drawn: factor on heights in the shaded map, and where the ground is cut.
#[derive(Clone, Copy)]
pub(super) struct Look {
    pub(super) exaggeration: f64,
    pub(super) along: Along,
    pub(super) at: f64,
}

impl Look {
    /// One stage below the other: to the left from above, with the line of the cut, to the right cut open, with the
    /// ground as it was in the first.
    pub(super) fn stages(self, stages: &[(&str, &Landscape)]) -> Result<Image, Error> {
        let before = stages[0].1.field("height")?;
        let rows: Result<Vec<_>, Error> =
            stages.iter().map(|&(name, landscape)| self.stage(name, landscape, before)).collect();
        Ok(Image::below(&rows?, GAP))
    }

    fn stage(self, name: &str, landscape: &Landscape, before: &Field) -> Result<Image, Error> {
        let map = Materials {
            width: Some(WIDTH),
            exaggeration: Some(self.exaggeration),
            shallowest: Some(SHALLOWEST),
            ..Materials::default()
        };
        let mut map = map.render(landscape)?;
        self.mark(&mut map);
        let mut with_before = landscape.clone();
        with_before.insert(BEFORE, "m", before.clone());
        let before = Some(LayerName::of(BEFORE));
        let section = Section { along: self.along, at: self.at, width: WIDTH, before, ..Section::default() };
        let natural = Section { exaggeration: Some(1.0), ..section.clone() }.render(&with_before)?;
        let exaggeration = Some(map.height as f64 / natural.height as f64);
        let section = Section { exaggeration, ..section }.render(&with_before)?;
        Ok(Image::beside(&[map, section], GAP).titled(name))
    }

    /// Dashes along the cut.
    fn mark(self, map: &mut Image) {
        let down = self.along == Along::Column;
        let [length, across] = if down { [map.height, map.width] } else { [map.width, map.height] };
        let place = ((self.at * across as f64) as usize).min(across - 1);
        for along in (0..length).filter(|along| along % 20 < 11) {
            let [x, y] = if down { [place, along] } else { [along, place] };
            let at = 3 * (y * map.width + x);
            map.rgb[at..at + 3].copy_from_slice(&CUT);
        }
    }
}

/// Layer of the ground as it was, and colour of the line along which it is cut.
const BEFORE: &str = "before";
const CUT: [u8; 3] = [0xa8, 0x32, 0x1c];

/// The four neighbours of a cell that is not at the edge.
pub(super) fn four(size: Size, at: usize) -> [usize; 4] {
    [at - size.columns, at - 1, at + 1, at + size.columns]
}

/// Steepest fall to one of the four neighbours from a cell that is not at the edge, as a tangent.
pub(super) fn steepest_fall(height: &Field, at: usize, cell: f64) -> f64 {
    let fall = |next: usize| f64::from(height.values()[at] - height.values()[next]);
    four(height.size(), at).map(fall).into_iter().fold(0.0, f64::max) / cell
}
