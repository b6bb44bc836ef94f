//! Displacement: exact on planes, and nothing comes from cells without data.

use weald_core::grid::Mask;
use weald_core::parameter::LayerName;
use weald_core::{Domain, Field, Landscape, Size};
use weald_engine::Job;
use weald_engine::step::Step;
use weald_land::combine::displace::Displace;

const COLUMNS: usize = 33;

fn run(step: &Displace, mut land: Landscape) -> Landscape {
    step.run(&mut land, &Job::unwatched(0)).expect("runs");
    land
}

#[test]
fn a_displaced_plane_is_the_plane_where_the_layers_point() {
    let mut land = Landscape::new(Domain::new(Size::new(COLUMNS, 21).expect("small"), 10.0));
    let plane = |x: f64, y: f64| (3.0 * x - 2.0 * y) as f32;
    let size = land.domain.size;
    let cell = land.domain.cell;
    land.insert("height", "m", Field::from_function(size, |x, y| plane(x as f64, y as f64)));
    let east = Field::from_function(size, |x, y| (((x + y) % 3) as f64 * 0.7 * cell) as f32);
    let south = Field::from_function(size, |x, _| ((x % 4) as f64 * -0.4 * cell) as f32);
    land.insert("east", "m", east.clone());
    land.insert("south", "m", south.clone());
    let step = Displace {
        east: Some(LayerName::of("east")),
        south: Some(LayerName::of("south")),
        into: Some(LayerName::of("bent")),
        ..Displace::default()
    };
    let land = run(&step, land);
    let bent = land.field("bent").expect("written");
    for (x, y) in (2..16).flat_map(|x| (2..14).map(move |y| (x, y))) {
        let [to_east, to_south] = [&east, &south].map(|offset| f64::from(offset.at(x, y)) / cell);
        let expected = plane(x as f64 + to_east, y as f64 + to_south);
        assert!((bent.at(x, y) - expected).abs() < 1e-3, "{x}, {y}: {} for {expected}", bent.at(x, y));
    }
    assert_ne!(bent, land.field("height").expect("there"), "something bent");
    assert!(Displace::default().faults()[0].message.contains("`east`"));
}

#[test]
fn a_displacement_takes_nothing_from_cells_without_data() {
    let mut land = Landscape::new(Domain::new(Size::new(COLUMNS, 21).expect("small"), 10.0));
    let size = land.domain.size;
    land.domain.valid = Mask::new(size, (0..size.cells()).map(|at| at % COLUMNS != 5).collect());
    land.insert("height", "m", Field::from_function(size, |x, _| if x == 5 { 1e6 } else { 2.0 }));
    let away = 1.4 * land.domain.cell;
    land.insert("east", "m", Field::filled(size, away as f32));
    let land = run(&Displace { east: Some(LayerName::of("east")), ..Displace::default() }, land);
    let height = land.field("height").expect("there");
    assert!(
        (0..size.cells()).filter(|at| at % COLUMNS != 5).all(|at| height.values()[at] == 2.0),
        "{height:?}"
    );
}
