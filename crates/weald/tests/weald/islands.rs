//! Landscapes that templates make from nothing: rivers end at the sea, nothing grows under it, and they are the same at every
//! size.

use weald::Landscape;
use weald::analyse::rivers::Rivers;
use weald::recipe::template;
use weald::recipe::{Overrides, Recipe};

/// What is asked of the island beside what it is.
const PLANTED: &str = r#"
[[step]]
do = "flow"
[[step]]
do = "rivers"
area = 300_000.0
[[step]]
do = "scatter"
plant = "fern"
spacing = 60.0
"#;

fn island(side: u64) -> Landscape {
    changed("island", PLANTED, side, &[])
}

/// The landscape of a template with more steps, and with other words in it.
fn changed(name: &str, more: &str, side: u64, changes: &[[&str; 2]]) -> Landscape {
    let template = template::find(name).expect("is there").text;
    let (steps, outputs) = template.split_at(template.find("[[output]]").expect("has outputs"));
    let mut text = format!("{steps}{more}{outputs}");
    for [from, to] in changes {
        assert!(text.contains(from), "{from}");
        text = text.replace(from, to);
    }
    let overrides = Overrides { size: Some(side), ..Overrides::default() };
    let recipe = Recipe::parse("changed.toml", &text, &overrides).unwrap_or_else(|error| panic!("{error}"));
    recipe.landscape().unwrap_or_else(|error| panic!("{error}"))
}

fn values<'a>(land: &'a Landscape, name: &str) -> &'a [f32] {
    land.field(name).unwrap_or_else(|error| panic!("{error}")).values()
}

/// Whether the cell of a place in metres from the north-western corner is sea.
fn in_sea(land: &Landscape, [east, south]: [f64; 2]) -> bool {
    let cell = land.domain.cell;
    let (x, y) = ((east / cell) as usize, (south / cell) as usize);
    land.field("sea_depth").expect("there is a sea").at(x, y) > 0.0
}

#[test]
fn no_river_runs_on_the_floor_of_the_sea_and_no_plant_stands_in_it() {
    let land = island(128);
    let sea = values(&land, "sea_depth").iter().filter(|&&depth| depth > 0.0).count();
    assert!((4_000..14_000).contains(&sea), "{sea} of 16,384 cells are sea");
    let reaches = Rivers::of(&land).expect("are there").reaches;
    assert!(reaches.len() > 20, "{} reaches", reaches.len());
    for reach in &reaches {
        // The last point may be that at which the river meets the sea.
        let on_land = &reach.points[..reach.points.len() - 1];
        assert!(on_land.iter().all(|point| !in_sea(&land, [point.x, point.y])), "{reach:?}");
    }
    let plants = &land.plants("plants").expect("are there").plants;
    assert!(plants.len() > 3_000, "{} plants", plants.len());
    assert!(plants.iter().all(|plant| plant.place[2] > -0.1), "plants stand in water no deeper than 0.1 m");
}

/// Area of the land in km², its mean height, and how far the heights are from those of a landscape twice as fine, as a
/// share of the highest: root mean square on land.
fn beside([coarse, fine]: [&Landscape; 2]) -> [f64; 3] {
    let side = coarse.domain.size.columns;
    let [own, finer] = [coarse, fine].map(|land| land.field("height").expect("there is ground"));
    let (mut squares, mut sum, mut cells) = (0.0, 0.0, 0.0);
    for (x, y) in (0..side).flat_map(|y| (0..side).map(move |x| (x, y))) {
        let mean = (0..4).map(|at| f64::from(finer.at(2 * x + at % 2, 2 * y + at / 2))).sum::<f64>() / 4.0;
        let height = f64::from(own.at(x, y));
        if height > 0.0 {
            squares += (height - mean).powi(2);
            sum += height;
            cells += 1.0;
        }
    }
    let highest = finer.range(None).map_or(1.0, |(_, high)| f64::from(high));
    [cells * coarse.domain.cell_area() / 1e6, sum / cells, (squares / cells).sqrt() / highest]
}

// On cells as small as the templates' a run would take a minute: what decides where rivers run is four times as coarse.
const SMALL: [[&str; 2]; 2] =
    [["settled = 40.0", "settled = 160.0"], ["coarsest = 40.0", "coarsest = 160.0"]];

#[test]
fn the_island_is_the_same_at_every_size() {
    let island = |side, changes: &[[&str; 2]]| changed("island", PLANTED, side, changes);
    let [coarse, fine] = [128, 256].map(|side| island(side, &SMALL));
    let [area, mean, off] = beside([&coarse, &fine]);
    assert!((110.0..135.0).contains(&area) && (150.0..200.0).contains(&mean), "{area} km² of {mean} m");
    assert!(off < 0.025, "{off} of the highest");
    // Ground made on the landscape's own cells, or cells that never settle, are another island.
    for change in [["finest = 2048", "finest = 128"], ["settled = 160.0", ""]] {
        let side = if change[0].starts_with("finest") { 128 } else { 256 };
        let other = island(side, &[&SMALL[..], &[change]].concat());
        let pair = if side == 128 { [&other, &fine] } else { [&coarse, &other] };
        assert!(beside(pair)[2] > 0.035, "{change:?}: {:?}", beside(pair));
    }
}

#[test]
fn ranges_and_fjords_are_the_same_at_every_size() {
    for name in ["range", "fjord"] {
        let [coarse, fine] = [128, 256].map(|side| changed(name, "", side, &SMALL));
        let off = beside([&coarse, &fine])[2];
        let other = changed(name, "", 128, &[&SMALL[..], &[["finest = 2048", "finest = 128"]]].concat());
        let apart = beside([&other, &fine])[2];
        println!("{name}: {off} and {apart}");
        assert!(off < 0.02 && apart > 0.03, "{name}: {off} of the highest, {apart} on its own ground");
    }
}
