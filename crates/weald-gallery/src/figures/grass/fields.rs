//! Figures 10 and 11: a field that grows by maps of soil, light and density, beside one whose blades are all alike.

use super::raster::{Air, Camera, Corner, picture};
use super::tufts::Brush;
use crate::figures::views::map;
use crate::figures::{Claim, Figure, FigureOutput, GalleryJob, Make, Measured, Plate, Verdict, texts};
use weald_core::domain::Domain;
use weald_core::error::Error;
use weald_core::grid::{Field, Size};
use weald_core::landscape::Landscape;
use weald_picture::{Image, Linear, Map, Picture, Scale};
use weald_plants::grass::{Bend, Growth, Instance, LEVELS, Maps, Meadow, SPECIES, Species};

pub(in crate::figures) const FIGURE_10: Figure = Figure {
    id: "grass-10",
    title: "The old way and the new",
    source: "Kim and Cho 2009, fig. 10",
    shows: "Left, as before: one set everywhere. Right, the same sets grown by the soil and the light of their places.",
    seconds: 15,
    make: Make::Alone(|job| Ok(comparison(job))),
};

pub(in crate::figures) const FIGURE_11: Figure = Figure {
    id: "grass-11",
    title: "A field grown from three maps",
    source: "Kim and Cho 2009, fig. 9, 11 and 12",
    shows: "Maps of soil, light and density, brighter being better or more, and the field that grows from them. The source's \
        images are lost; these have a stream of rich soil, the shade of three trees, and a trodden path.",
    seconds: 15,
    make: Make::Alone(mapped),
};

/// Cells of the maps along a side, and metres of each.
const SIDE: usize = 96;
const CELL: f64 = 0.125;

/// Pixels between pictures.
const GAP: usize = 8;

/// Bare soil, in linear light.
const EARTH: Linear = [0.11, 0.075, 0.045];

fn field(of: impl Fn(f32, f32) -> f32) -> Field {
    let size = Size { columns: SIDE, rows: SIDE };
    let share = |at: usize| (at as f32 + 0.5) / SIDE as f32;
    Field::from_function(size, |x, y| of(share(x), share(y)).clamp(0.0, 1.0))
}

/// 1 on a line and 0 beyond its width.
fn band(apart: f32, width: f32) -> f32 {
    let share = (1.0 - apart.abs() / width).clamp(0.0, 1.0);
    share * share * (3.0 - 2.0 * share)
}

/// The three maps.
pub(super) fn maps() -> Maps {
    let soil = field(|x, y| {
        let course = 0.68 + 0.14 * libm::sinf(5.5 * y) - 0.1 * y;
        0.12 + 0.25 * libm::sinf(9.0 * x + 4.0 * y).powi(2) + 0.85 * band(x - course, 0.3)
    });
    let light = field(|x, y| {
        let shade = |at: [f32; 2], reach: f32| 0.75 * band((x - at[0]).hypot(y - at[1]), reach);
        1.0 - shade([0.22, 0.3], 0.3) - shade([0.5, 0.72], 0.26) - shade([0.86, 0.24], 0.24)
    });
    let density = field(|x, y| 1.0 - 1.05 * band(x - (0.34 + 0.2 * y + 0.05 * libm::sinf(7.0 * y)), 0.09));
    let (land, water, mown, trodden) = (None, None, None, None);
    Maps {
        cell: CELL,
        valid: land,
        density,
        soil,
        light,
        shares: vec![field(|_, _| 1.0)],
        water,
        mown,
        trodden,
    }
}

fn meadow(job: GalleryJob) -> Meadow {
    Meadow {
        species: vec![Species { height: 0.85, splay: 0.0, ..SPECIES[0].clone() }],
        bend: Bend::Total,
        seed: 5,
        densest: job.choose(150.0, 6.0),
        level: LEVELS as f32,
        mown_height: 0.05,
        deepest: 0.0,
        tussocks: 0.0,
        maps: maps(),
    }
}

fn sets(meadow: &Meadow) -> Vec<Instance> {
    meadow.sets(&meadow.area()).into_iter().map(Instance::unpack).collect()
}

/// A field as seen from a camera in its middle's metres.
fn seen(meadow: &Meadow, sets: &[Instance], camera: Camera, air: &Air) -> Image {
    let half = 0.5 * SIDE as f32 * CELL as f32;
    let brush = Brush { camera: &camera, bend: meadow.bend, rows: 7, shade: 0.28 };
    let mut triangles = ground(half, air.clear.is_finite());
    for set in sets {
        let [x, y] = set.place.map(|along| along - half);
        brush.tuft(&meadow.species[0], &set.tuft, [x, 0.0, y], &mut triangles);
    }
    picture(&triangles, camera, air)
}

/// The soil under the field, and the land around it.
fn ground(half: f32, around: bool) -> Vec<[Corner; 3]> {
    let far = 40.0 * half;
    let corner = |x: f32, y: f32, colour, low: f32| Corner {
        place: [x, -low, y],
        normal: [0.0, 1.0, 0.0],
        colour,
        open: 0.8,
        through: 0.0,
    };
    let square = |side: f32, colour, low| {
        let [a, b, c, d] = [[-1.0, -1.0], [1.0, -1.0], [-1.0, 1.0], [1.0, 1.0]]
            .map(|[x, y]: [f32; 2]| corner(side * x, side * y, colour, low));
        [[a, b, c], [c, b, d]]
    };
    // What reaches behind the camera is not drawn: the surroundings are cut into tiles.
    let tiles = (0..64 * 64).filter(|_| around).flat_map(|tile| {
        let along = |at: usize| far * (at as f32 / 32.0 - 1.0);
        let [west, north, east, south] = [tile % 64, tile / 64, tile % 64 + 1, tile / 64 + 1].map(along);
        let at = |x: f32, y: f32| corner(x, y, [0.12, 0.15, 0.05], 0.02);
        [
            [at(west, north), at(east, north), at(west, south)],
            [at(west, south), at(east, north), at(east, south)],
        ]
    });
    square(half, EARTH, 0.0).into_iter().chain(tiles).collect()
}

/// How much a number differs over the sets: its deviation as a share of its mean.
fn deviation(numbers: &[f32]) -> f32 {
    let mean = numbers.iter().sum::<f32>() / numbers.len() as f32;
    let square =
        numbers.iter().map(|number| (number - mean) * (number - mean)).sum::<f32>() / numbers.len() as f32;
    square.sqrt() / mean
}

fn heights(meadow: &Meadow, sets: &[Instance]) -> Vec<f32> {
    sets.iter().map(|set| set.tuft.height(&meadow.species[0], meadow.bend)).collect()
}

fn blends(meadow: &Meadow, sets: &[Instance]) -> Vec<f32> {
    let curves = &meadow.species[0].curves;
    sets.iter().map(|set| Growth::at(curves, set.tuft.soil, set.tuft.light).blend).collect()
}

fn comparison(job: GalleryJob) -> FigureOutput {
    let new = meadow(job);
    let mut old = new.clone();
    old.species[0].variation = 0.0;
    let grown = sets(&new);
    let mut alike = sets(&old);
    for set in &mut alike {
        (set.tuft.soil, set.tuft.light, set.tuft.seed) = (0.6, 0.6, 9);
    }
    let camera = Camera {
        eye: [-1.0, 1.75, 8.6],
        target: [0.1, 0.0, -1.0],
        view_deg: 34.0,
        size: job.choose([620, 420], [60, 40]),
    };
    let images = [
        seen(&old, &alike, camera, &Air::SUMMER).titled("one set everywhere"),
        seen(&new, &grown, camera, &Air::SUMMER).titled("grown by soil and light"),
    ];
    let [before, after] = [(&old, &alike), (&new, &grown)]
        .map(|(meadow, sets)| [deviation(&heights(meadow, sets)), deviation(&blends(meadow, sets))]);
    let row = |name: &str, sets: &[Instance], numbers: [f32; 2]| {
        let percent = numbers.map(|number| format!("{:.0} %", 100.0 * number));
        vec![name.to_owned(), sets.len().to_string(), percent[0].clone(), percent[1].clone()]
    };
    FigureOutput {
        plates: vec![Plate {
            name: "ways",
            caption: "The same field: one set everywhere, and grown by soil and light".to_owned(),
            image: Image::beside(&images, GAP),
        }],
        measured: Measured {
            header: texts(["way", "sets", "heights differ by", "colours differ by"]),
            rows: vec![row("one set", &alike, before), row("grown", &grown, after)],
            remarks: texts(["Deviations as shares of the mean."]),
        },
        claims: vec![Claim::new(
            "Grown grass differs from place to place",
            Verdict::of(after[0] > 0.15 && after[1] > 0.15 && before[0] < 0.01),
            format!("heights differ by {:.0} %, colours by {:.0} %", 100.0 * after[0], 100.0 * after[1]),
        )],
        ..FigureOutput::default()
    }
}

fn mapped(job: GalleryJob) -> Result<FigureOutput, Error> {
    let meadow = meadow(job);
    let grown = sets(&meadow);
    let half = 0.5 * SIDE as f32 * CELL as f32;
    let camera = Camera {
        eye: [0.0, 9.0, 15.0],
        target: [0.0, 0.0, 0.8],
        view_deg: 28.0,
        size: job.choose([900, 500], [90, 50]),
    };
    let tiles = drawn_maps(&meadow.maps, job)?;
    let image = Image::below(&[tiles, seen(&meadow, &grown, camera, &Air::PAPER)], GAP);
    let (heights, blends) = (heights(&meadow, &grown), blends(&meadow, &grown));
    let mean = |numbers: &[f32], of: &dyn Fn(&Instance) -> bool| {
        let chosen: Vec<_> =
            grown.iter().zip(numbers).filter(|(set, _)| of(set)).map(|(_, number)| *number).collect();
        chosen.iter().sum::<f32>() / chosen.len().max(1) as f32
    };
    let [rich, poor] = [mean(&blends, &|set| set.tuft.soil > 0.7), mean(&blends, &|set| set.tuft.soil < 0.3)];
    let poor_soil = |set: &Instance| set.tuft.soil < 0.4;
    let [shade, sun] = [
        mean(&heights, &|set| poor_soil(set) && set.tuft.light < 0.5),
        mean(&heights, &|set| poor_soil(set) && set.tuft.light > 0.9),
    ];
    let on_path = |set: &&Instance| {
        let [x, y] = set.place.map(|along| along / (2.0 * half));
        (x - (0.34 + 0.2 * y + 0.05 * libm::sinf(7.0 * y))).abs() < 0.02
    };
    let path = grown.iter().filter(on_path).count() as f32 / grown.len() as f32 / 0.04;
    Ok(FigureOutput {
        plates: vec![Plate {
            name: "field",
            caption: "Soil, light, density, and the field that grows from them".to_owned(),
            image,
        }],
        measured: Measured {
            header: texts(["sets", "blades", "vertices at level 4"]),
            rows: vec![
                [grown.len(), 6 * grown.len(), 240 * grown.len()].map(|count| count.to_string()).to_vec(),
            ],
            remarks: Vec::new(),
        },
        claims: vec![
            Claim::new(
                "On better soil grass is greener",
                Verdict::of(rich > 1.3 * poor),
                format!("its share of the good colour is {rich:.2} on rich soil and {poor:.2} on poor"),
            ),
            Claim::new(
                "In the shade grass is taller",
                Verdict::of(shade > 1.2 * sun),
                format!(
                    "{:.0} cm in the shade, {:.0} cm in the sun, both on poor soil",
                    100.0 * shade,
                    100.0 * sun
                ),
            ),
            Claim::new(
                "Density says how many blades there are",
                Verdict::of(path < 0.1),
                format!("on the path stand {:.0} % of the sets of as much ground elsewhere", 100.0 * path),
            ),
        ],
        ..FigureOutput::default()
    })
}

/// The maps beside each other in grey.
fn drawn_maps(maps: &Maps, job: GalleryJob) -> Result<Image, Error> {
    let width = job.choose(294, 28);
    let named = [("soil", &maps.soil), ("light", &maps.light), ("density", &maps.density)];
    let drawn = named.map(|(name, field)| {
        let mut only = Landscape::new(Domain::new(field.size(), maps.cell));
        only.insert(name, "1", field.clone());
        let grey =
            Map { ramp: Scale::Grey, width: Some(width), low: Some(0.0), high: Some(1.0), ..map(name) };
        Ok::<_, Error>(grey.render(&only)?.titled(name))
    });
    let [soil, light, density] = drawn;
    Ok(Image::beside(&[soil?, light?, density?], (900 - 3 * 294) / 2))
}
