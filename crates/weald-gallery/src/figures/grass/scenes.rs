//! Figures 12 and 13: a field that grows from three maps, and a scene with other plants, as a device draws them.

use super::fields;
use crate::figures::{Claim, Figure, FigureOutput, GalleryJob, Make, Measured, Plate, Verdict, texts};
use weald::recipe::{Overrides, Recipe};
use weald_core::domain::Domain;
use weald_core::error::Error;
use weald_core::grid::{Field, Size};
use weald_core::landscape::Landscape;
use weald_core::parameter::Places;
use weald_picture::{Around, Frame, Image, Render, RenderDevice, RenderKeys, View};
use weald_plants::Vegetation;
use weald_plants::grass::{Bend, LEVELS, Maps, Meadow, SPECIES, Species};

pub(in crate::figures) const FIGURE_12: Figure = Figure {
    id: "grass-12",
    title: "A field from maps, from the eye level",
    source: "Kim and Cho 2009, fig. 12",
    shows: "The maps of grass-11 on gentle ground 48 m wide, drawn in real time: tall where the soil is rich, high and \
        narrow in shade, none on the path. Left from a person's height, right from above.",
    seconds: 12,
    make: Make::Drawn(field),
};

pub(in crate::figures) const FIGURE_13: Figure = Figure {
    id: "grass-13",
    title: "Grass with other plants",
    source: "Kim and Cho 2009, fig. 13",
    shows: "Grass of four kinds with ferns, shrubs and conifers, each where soil, moisture and light of one recipe suit \
        it, beside a stream that the same recipe's water cut.",
    seconds: 90,
    make: Make::Drawn(plants),
};

/// Cells of the maps along a side, and metres of each in the field.
const SIDE: usize = 96;
const CELL: f64 = 0.5;

/// Pixels between pictures.
const GAP: usize = 8;

/// Share of pixels whose green is above their red and their blue, by so many bytes.
fn green(image: &Image) -> f64 {
    let is_green =
        |pixel: &[u8]| pixel[1] > pixel[0].saturating_add(4) && pixel[1] > pixel[2].saturating_add(12);
    let count = image.rgb.chunks_exact(3).filter(|pixel| is_green(pixel)).count();
    count as f64 / (image.width * image.height) as f64
}

/// A clear day without woods, under a sun of an azimuth and altitude.
fn view(
    [width, height]: [u32; 2],
    field_of_view_deg: f64,
    [sun_azimuth_deg, sun_altitude_deg]: [f64; 2],
) -> View {
    View {
        width,
        height,
        field_of_view_deg,
        sun_azimuth_deg,
        sun_altitude_deg,
        visibility: Some(12_000.0),
        tree_line: Some(-100.0),
        exposure: 0.3,
        around: Some(Around::Block),
        ..View::default()
    }
}

/// A picture with the camera at a place, so high above the ground.
fn seen(
    landscape: &Landscape,
    device: &dyn RenderDevice,
    (eye, eye_height, target): ([f64; 2], f64, [f64; 2]),
    view: View,
) -> Result<Image, Error> {
    let [eye, target] = [eye, target].map(|place| Some(Places(vec![place])));
    let view = View { target, eye, eye_height, ..view };
    let render = Render { view, keys: RenderKeys::default() };
    let frame_sequence = render.frame_sequence(landscape, device)?;
    frame_sequence.set_up()?.draw(&frame_sequence.camera(Frame::STILL), 0.0)
}

/// The maps' field on ground with gentle waves.
fn mapped() -> Result<Landscape, Error> {
    let size = Size::square(SIDE)?;
    let mut landscape = Landscape::new(Domain::new(size, CELL));
    let height = Field::from_function(size, |x, y| {
        let [x, y] = [x, y].map(|at| at as f32 * CELL as f32);
        0.9 * libm::sinf(0.11 * x + 0.4) + 0.7 * libm::cosf(0.13 * y - 0.06 * x)
    });
    landscape.insert("height", "m", height);
    // Bare ground is dry earth.
    landscape.insert("moisture", "1", Field::filled(size, 0.1));
    landscape.sow(
        "grass",
        Meadow {
            species: vec![Species { splay: 0.0, ..SPECIES[0].clone() }],
            bend: Bend::Total,
            seed: 5,
            densest: 170.0,
            level: LEVELS as f32,
            mown_height: 0.05,
            deepest: 0.0,
            tussocks: 0.0,
            maps: Maps { cell: CELL, ..fields::maps() },
        },
    );
    Ok(landscape)
}

fn field(job: GalleryJob, device: &dyn RenderDevice) -> Result<FigureOutput, Error> {
    let landscape = mapped()?;
    let view = view(job.choose([620, 440], [96, 64]), 58.0, [250.0, 38.0]);
    let images = [
        seen(&landscape, device, ([20.0, 46.0], 1.6, [25.0, 24.0]), view.clone())?,
        seen(&landscape, device, ([24.0, 62.0], 24.0, [24.0, 22.0]), view)?,
    ];
    let meadow = landscape.meadow("grass")?;
    let sets = meadow.sets(&meadow.area()).len();
    let share = green(&images[1]);
    Ok(FigureOutput {
        plates: vec![Plate {
            name: "field",
            caption: "From a person's height, and from above".to_owned(),
            image: Image::beside(&images, GAP),
        }],
        measured: Measured {
            header: texts(["sets", "blades", "vertices at level 4"]),
            rows: vec![[sets, 6 * sets, 240 * sets].map(|count| count.to_string()).to_vec()],
            remarks: vec![format!("Drawn on {}.", device.adapter())],
        },
        claims: vec![Claim::new(
            "Three maps make a field",
            Verdict::of(sets > 10_000 && share > 0.2),
            format!("{sets} sets; {:.0} % of the picture from above is green", 100.0 * share),
        )],
        ..FigureOutput::default()
    })
}

/// A glade by a stream, 200 m wide.
const GLADE: &str = r#"
[landscape]
size = 200
cell = 1.0
seed = 12
[[step]]
do = "fbm"
relief = 26.0
wavelength = 150.0
octaves = 6
gain = 0.42
[[step]]
do = "hydraulic"
model = "han"
iterations = 900
boundary = "open"
rain = 0.0014
evaporation = 0.006
[[step]]
do = "flow"
[[step]]
do = "lakes"
[[step]]
do = "rivers"
area = 2500.0
lakes = "lake"
[[step]]
do = "slope"
[[step]]
do = "wetness"
[[step]]
do = "moisture"
rivers = "river"
lakes = "lake"
[[step]]
do = "soil"
erosion = "erosion"
deposition = "deposition"
moisture = "moisture"
[[step]]
do = "constant"
height = 0.85
into = "fertility"
[[step]]
do = "sunlight"
directions = 16
positions = 12
[[step]]
do = "scatter"
plant = "fern-3d"
count = 5000
spacing = 0.7
where = [{ layer = "moisture", above = 0.4, soft = 0.3 }, { layer = "slope", below = 40, soft = 10 }]
size = [0.5, 1.1]
into = "ferns"
[[step]]
do = "scatter"
plant = "shrub"
count = 130
spacing = 3.0
where = [{ layer = "slope", below = 40, soft = 10 }]
size = [1.0, 2.2]
into = "shrubs"
[[step]]
do = "scatter"
plant = "conifer"
count = 160
spacing = 4.0
where = [{ layer = "moisture", below = 0.7, soft = 0.2 }, { layer = "slope", below = 40, soft = 10 }]
size = [5.0, 13.0]
into = "conifers"
[[step]]
do = "grass"
sets = 160.0
species = [
    { name = "ryegrass" },
    { name = "oat-grass", share = 0.5, where = [{ layer = "moisture", above = 0.3, soft = 0.3 }] },
    { name = "reed", share = 4.0, where = [{ layer = "moisture", above = 0.85, soft = 0.1 }] },
    { name = "fescue", share = 0.4, where = [{ layer = "moisture", below = 0.4, soft = 0.2 }] },
]
[[output]]
layer = "height"
file = "height.npy"
"#;

fn plants(job: GalleryJob, device: &dyn RenderDevice) -> Result<FigureOutput, Error> {
    let size = job.choose(None, Some(48));
    let recipe = Recipe::parse("glade.toml", GLADE, &Overrides { size, ..Overrides::default() })?;
    let landscape = recipe.landscape()?;
    let view = view(job.choose([1100, 620], [96, 54]), 62.0, [235.0, 34.0]);
    let image = seen(&landscape, device, ([96.0, 104.0], 2.3, [66.0, 80.0]), view)?;
    let count = |name: &str| landscape.plants(name).map(|plants| plants.plants.len());
    let counts = [count("ferns")?, count("shrubs")?, count("conifers")?];
    let meadow = landscape.meadow("grass")?;
    let sets = meadow.expected(&meadow.area()).round();
    let mut row: Vec<_> = counts.iter().map(ToString::to_string).collect();
    row.push(format!("{sets}"));
    Ok(FigureOutput {
        plates: vec![Plate { name: "glade", caption: "A glade by a stream".to_owned(), image }],
        measured: Measured {
            header: texts(["ferns", "shrubs", "conifers", "sets of grass"]),
            rows: vec![row],
            remarks: vec![format!("Drawn on {}.", device.adapter())],
        },
        claims: vec![Claim::new(
            "Grass and other plants share one scene",
            Verdict::of(counts.iter().all(|&count| count > 5) && sets > 100.0),
            format!("{} plants stand among {sets} sets", counts.iter().sum::<usize>()),
        )],
        ..FigureOutput::default()
    })
}
