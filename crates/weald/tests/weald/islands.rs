//! The island that a template makes from nothing: rivers end at its sea, nothing grows under it, and it is the same at every
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
    let template = template::find("island").expect("is there").text;
    let (steps, outputs) = template.split_at(template.find("[[output]]").expect("has outputs"));
    let overrides = Overrides { size: Some(side), ..Overrides::default() };
    let text = format!("{steps}{PLANTED}{outputs}");
    let recipe = Recipe::parse("island.toml", &text, &overrides).unwrap_or_else(|error| panic!("{error}"));
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

#[test]
fn the_island_is_the_same_at_every_size() {
    let figures = |side: u64| {
        let land = island(side);
        let (height, sea) = (values(&land, "height"), values(&land, "sea_depth"));
        let on_land: Vec<f64> = height
            .iter()
            .zip(sea)
            .filter(|(_, sea)| **sea == 0.0)
            .map(|(&height, _)| f64::from(height))
            .collect();
        let area = on_land.len() as f64 * land.domain.cell_area() / 1e6;
        [area, on_land.iter().sum::<f64>() / on_land.len() as f64]
    };
    let [coarse, fine] = [128, 256].map(figures);
    let off = [0, 1].map(|figure| (coarse[figure] / fine[figure] - 1.0).abs());
    assert!(off[0] < 0.05 && off[1] < 0.1, "land and mean height are {coarse:?} and {fine:?} (km², m)");
}
