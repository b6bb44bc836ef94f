//! Rivers and lakes on every generator: they end where they must, and carry what falls.

use weald::analyse::directions::{Directions, STEPS};
use weald::analyse::flow_step::{FlowStep, Method};
use weald::analyse::lakes::{Lakes, LakesStep, Source};
use weald::analyse::rivers::{End, Reach, RiverPoint, Rivers, RiversStep, Start};
use weald::engine::Job;
use weald::flow::Depressions;
use weald::grid::Mask;
use weald::random::{hash2, unit};
use weald::recipe::catalog::CATALOG;
use weald::recipe::parameter::{Diagnostics, LayerName};
use weald::recipe::source::Table;
use weald::step::{Entry, Stage, Step};
use weald::{Domain, Field, Landscape, Size};

const COLUMNS: usize = 26;
const ROWS: usize = 22;

fn values<'a>(land: &'a Landscape, name: &str) -> &'a [f32] {
    land.field(name).unwrap_or_else(|error| panic!("{error}")).values()
}

fn run(step: &dyn Step, land: &mut Landscape, seed: u64) {
    step.run(land, &Job::unwatched(seed)).unwrap_or_else(|error| panic!("{step:?}: {error}"));
}

/// Ground by a generator with its defaults; every other has holes in its data.
fn ground(entry: &Entry, seed: u64) -> Landscape {
    let size = Size::new(COLUMNS, ROWS).expect("legal");
    let holes = (0..size.cells()).map(|cell| !hash2(seed, cell as i64, 1).is_multiple_of(60)).collect();
    let land = if seed % 2 == 1 { Mask::new(size, holes) } else { None };
    let mut landscape = Landscape::new(Domain { valid: land, ..Domain::new(size, 20.0) });
    let step = (entry.read)(&Table::default(), &mut Diagnostics::default());
    run(step.as_ref(), &mut landscape, seed);
    landscape
}

/// The steps in one of many variants, chosen by the seed.
fn analysed(entry: &Entry, seed: u64) -> Landscape {
    let mut land = ground(entry, seed);
    let choice = |at: i64, of: u64| hash2(seed, at, 9) % of;
    let (low, high) =
        land.field("height").map(|h| h.range(land.domain.valid.as_ref())).expect("h").expect("cells");
    let sea_level = (choice(1, 3) == 0).then(|| f64::from(low) + 0.3 * f64::from(high - low));
    let breached = choice(2, 3) == 0;
    let flow = FlowStep {
        method: if choice(3, 2) == 0 { Method::D8 } else { Method::Multiple },
        depressions: if breached { Depressions::Breach } else { Depressions::Fill },
        deepest_breach: (breached && choice(4, 2) == 0).then_some(2.0),
        sea_level,
        weight: Some(LayerName::of("rain")),
        filled: Some(LayerName::of("filled")),
        ..FlowStep::default()
    };
    let rain = |x: usize, y: usize| 2000.0 * unit(hash2(seed, x as i64, 2000 + y as i64)) as f32;
    land.insert("rain", "mm/year", Field::from_function(land.domain.size, rain));
    run(&flow, &mut land, seed);
    run(&LakesStep { depth: 0.1, area: Some(2000.0), sea_level, ..LakesStep::default() }, &mut land, seed);
    let rivers = RiversStep {
        of: LayerName::of("filled"),
        area: Some(8000.0),
        discharge: Some(LayerName::of("discharge")),
        lakes: Some(LayerName::of("lake")),
        ..RiversStep::default()
    };
    run(&rivers, &mut land, seed);
    land
}

fn at_the_rim(land: &Landscape, cell: usize) -> bool {
    let size = land.domain.size;
    let has_data = |cell: usize| land.domain.valid.as_ref().is_none_or(|valid| valid.is_valid_at(cell));
    size.neighbours(cell).filter(|&other| has_data(other)).count() < 8
}

/// Follows the codes from a river cell, without the library's help.
fn check_end_of(land: &Landscape, start: usize) {
    let (codes, lake) = (values(land, "flow_direction"), values(land, "lake"));
    let mut cell = start;
    for _ in 0..COLUMNS * ROWS {
        if lake[cell] > 0.0 || codes[cell] == 9.0 {
            return;
        }
        if codes[cell] == 0.0 {
            assert!(at_the_rim(land, cell), "water vanishes inland, in cell {cell}");
            return;
        }
        assert_eq!(values(land, "river")[cell], 1.0, "a river goes on as a river");
        let (east, south) = STEPS[codes[cell] as usize - 1];
        cell = cell.wrapping_add_signed(south * COLUMNS as isize + east);
    }
    panic!("water of cell {start} flows in a cycle");
}

fn check_reach(land: &Landscape, rivers: &Rivers, at: usize) {
    let reach = &rivers.reaches[at];
    let cell_of = |point: usize| {
        let point = &reach.points[point];
        land.domain.size.index((point.x / 20.0) as usize, (point.y / 20.0) as usize)
    };
    let last = cell_of(reach.points.len() - 1);
    let (codes, lake) = (values(land, "flow_direction"), values(land, "lake"));
    match reach.end {
        End::Outlet => assert!(codes[last] == 0.0 && at_the_rim(land, last)),
        End::Sea => assert_eq!(codes[last], 9.0),
        End::Lake(number) => assert_eq!(lake[last], number as f32),
        End::Confluence => {
            let [x, y] = [|point: &RiverPoint| point.x, |point: &RiverPoint| point.y];
            let (own, other) =
                (reach.points.last(), reach.downstream.map(|next| &rivers.reaches[next].points[0]));
            let (own, other) = own.zip(other).expect("a reach has points, and a confluence a reach below");
            assert_eq!([x(own), y(own)], [x(other), y(other)], "reaches meet in one point");
        }
    }
    if reach.start == Start::Head || matches!(reach.start, Start::Lake(_)) {
        let into = rivers
            .reaches
            .iter()
            .filter(|other| other.downstream == Some(at) && other.end == End::Confluence);
        assert_eq!(into.count(), 0, "a head has no tributary");
    }
    assert!(reach.downstream.is_none_or(|next| next < at), "downstream comes first");
    assert!(!reach.points.is_empty() && reach.order >= 1);
    for pair in reach.points.windows(2) {
        assert!(pair[1].z <= pair[0].z, "a river never rises");
        let far = (pair[1].x - pair[0].x).hypot(pair[1].y - pair[0].y);
        assert!(far < 20.0 * 2.5, "a river has no gaps: {far}");
    }
}

/// Strahler's rule, by the reaches that meet at the start of one. In a lake they meet one after the other.
fn check_order(rivers: &Rivers, at: usize) {
    let meet_in_a_lake = |other: &Reach| other.downstream == Some(at) && matches!(other.end, End::Lake(_));
    let in_a_lake = rivers.reaches.iter().filter(|other| meet_in_a_lake(other)).count() > 1;
    let mut orders: Vec<u32> =
        rivers.reaches.iter().filter(|other| other.downstream == Some(at)).map(|other| other.order).collect();
    orders.sort_unstable_by(|a, b| b.cmp(a));
    let expected = match orders.as_slice() {
        [] => 1,
        [first, second, ..] if first == second => first + 1,
        [first, ..] => *first,
    };
    let order = rivers.reaches[at].order;
    assert!(order == expected || in_a_lake && order > expected, "{order}: {orders:?}");
}

#[test]
fn on_two_hundred_seeds_of_every_generator_rivers_reach_an_end_and_rain_is_conserved() {
    let (mut cells, mut ends) = (0, [0; 4]);
    for entry in CATALOG.iter().filter(|entry| entry.stage == Stage::Generate) {
        for seed in 0..200 {
            let land = analysed(entry, seed);
            let river = values(&land, "river");
            let of_rivers: Vec<usize> = (0..river.len()).filter(|&cell| river[cell] > 0.0).collect();
            cells += of_rivers.len();
            for &cell in &of_rivers {
                check_end_of(&land, cell);
            }
            let rivers = Rivers::of(&land).expect("the layers are there");
            for (at, reach) in rivers.reaches.iter().enumerate() {
                check_reach(&land, &rivers, at);
                ends[match reach.end {
                    End::Outlet => 0,
                    End::Lake(_) => 1,
                    End::Sea => 2,
                    End::Confluence => 3,
                }] += 1;
                check_order(&rivers, at);
            }
            let own: usize = rivers.reaches.iter().map(own_points).sum();
            assert_eq!(own, of_rivers.len(), "each river cell is a point of its own reach");
            check_rain(&land);
        }
    }
    assert!(cells > 50_000 && ends.iter().all(|&ends| ends > 500), "{cells} cells, ends {ends:?}");
}

/// Points that are not in another reach, a lake or the sea.
fn own_points(reach: &Reach) -> usize {
    reach.points.len() - usize::from(reach.end != End::Outlet)
}

fn check_rain(land: &Landscape) {
    let directions =
        Directions::of(land.field("flow_direction").expect("d"), land.domain.valid.as_ref()).expect("right");
    let has_data = |cell: usize| land.domain.valid.as_ref().is_none_or(|valid| valid.is_valid_at(cell));
    let ends = || (0..COLUMNS * ROWS).filter(|&cell| has_data(cell) && directions.downstream(cell).is_none());
    let sum = |name: &str| ends().map(|cell| f64::from(values(land, name)[cell])).sum::<f64>();
    let area = land.domain.valid_cells() as f64 * 400.0;
    assert!((sum("accumulation") / area - 1.0).abs() < 1e-6, "{} of {area}", sum("accumulation"));
    let fallen =
        (0..COLUMNS * ROWS).filter(|&cell| has_data(cell)).map(|cell| f64::from(values(land, "rain")[cell]));
    let fallen = fallen.sum::<f64>() * 400.0 / 1000.0 / (365.25 * 86400.0);
    assert!((sum("discharge") / fallen - 1.0).abs() < 1e-6);
}

/// A valley that runs south into a bowl, which overflows to the south.
fn valley_with_a_lake() -> Landscape {
    let size = Size::new(61, 120).expect("legal");
    let height = Field::from_function(size, |x, y| {
        let (x, y) = (x as f32 - 30.0, y as f32);
        let valley = 0.5 * (120.0 - y) + 0.3 * x.abs();
        let bowl = 12.0 * (1.0 - (x * x + (y - 60.0) * (y - 60.0)) / 225.0).max(0.0);
        valley - bowl
    });
    let mut land = Landscape::new(Domain::new(size, 10.0));
    land.insert("height", "m", height);
    run(&FlowStep::default(), &mut land, 1);
    run(&LakesStep { depth: 0.5, ..LakesStep::default() }, &mut land, 1);
    let rivers =
        RiversStep { area: Some(60_000.0), lakes: Some(LayerName::of("lake")), ..RiversStep::default() };
    run(&rivers, &mut land, 1);
    land
}

#[test]
fn a_river_ends_in_a_lake_and_another_leaves_it() {
    let land = valley_with_a_lake();
    let rivers = Rivers::of(&land).expect("the layers are there");
    let into = rivers.reaches.iter().position(|reach| reach.end == End::Lake(1)).expect("a river flows in");
    let out = rivers.reaches.iter().position(|reach| reach.start == Start::Lake(1)).expect("one flows out");
    assert_eq!(rivers.reaches[into].downstream, Some(out));
    let lake = &Lakes::of(&land).expect("the layers are there").lakes[0];
    let mouth = rivers.reaches[into].points.last().expect("points");
    assert!((mouth.z - lake.level).abs() < 1e-3, "{} beside {}", mouth.z, lake.level);
    let [x, y] = lake.outlet.expect("it overflows");
    let first = rivers.reaches[out].points[0];
    assert_eq!([first.x, first.y], [(x as f64 + 0.5) * 10.0, (y as f64 + 0.5) * 10.0]);
    assert_eq!(
        f64::from(values(&land, "height")[land.domain.size.index(x, y)]),
        lake.level,
        "a lake is as high as its outlet"
    );
    let stems = rivers.stems();
    assert!(stems[0].windows(2).any(|pair| pair == [into, out]), "the main stem goes through the lake");
    assert_eq!(stems.iter().map(Vec::len).sum::<usize>(), rivers.reaches.len());
}

#[test]
fn width_and_depth_follow_from_discharge() {
    let land = valley_with_a_lake();
    let rivers = Rivers::of(&land).expect("the layers are there");
    let point =
        rivers.reaches.iter().flat_map(|reach| &reach.points).max_by(|a, b| a.area.total_cmp(&b.area));
    let point = point.expect("there are rivers");
    let discharge = point.area * 0.5 / (365.25 * 86400.0);
    assert!((point.discharge / discharge - 1.0).abs() < 1e-5);
    assert!((point.width / (7.2 * discharge.sqrt()) - 1.0).abs() < 1e-5);
    assert!((point.depth / (0.27 * discharge.powf(0.4)) - 1.0).abs() < 1e-5);
}

/// A round bowl 40 m deep and 500 m wide within flat ground, with a notch 10 m deep.
fn bowl() -> Landscape {
    let size = Size::square(121).expect("legal");
    let height = Field::from_function(size, |x, y| {
        let (east, south) = (x as f32 - 60.0, y as f32 - 60.0);
        let share = (east * east + south * south) / 2500.0;
        let ground = 100.0 - 40.0 * (1.0 - share).max(0.0);
        if y == 60 && x > 60 { ground.min(90.0) } else { ground }
    });
    let mut land = Landscape::new(Domain::new(size, 10.0));
    land.insert("height", "m", height);
    land
}

#[test]
fn the_volume_of_a_bowl_is_that_of_the_paraboloid() {
    let mut land = bowl();
    run(&LakesStep::default(), &mut land, 1);
    let lakes = Lakes::of(&land).expect("the layers are there").lakes;
    assert_eq!(lakes.len(), 1);
    let lake = &lakes[0];
    assert_eq!((lake.level, lake.deepest), (90.0, 30.0));
    // z = 60 + 40 (r / 500)²: radius² at 90 m is 0.75 · 500², and half the cylinder is full.
    let area = std::f64::consts::PI * 0.75 * 250_000.0;
    assert!((lake.area / area - 1.0).abs() < 0.01, "{} of {area}", lake.area);
    assert!((lake.volume / (0.5 * area * 30.0) - 1.0).abs() < 0.01, "{}", lake.volume);
    let [x, y] = lake.outlet.expect("over the notch");
    assert!(y == 60 && (104..=106).contains(&x), "{x}, {y}");
    assert_eq!((lake.polygons.len(), lake.polygons[0].islands.len()), (1, 0));
}

#[test]
fn the_water_of_a_simulation_is_a_lake_where_it_is_deep_and_wide() {
    let mut land = bowl();
    let size = land.domain.size;
    let water: Vec<f32> = values(&land, "height").iter().map(|&ground| (75.0 - ground).max(0.02)).collect();
    land.insert("water", "m", Field::from_values(size, water));
    run(&LakesStep { from: Source::Water, ..LakesStep::default() }, &mut land, 1);
    let lakes = Lakes::of(&land).expect("the layers are there").lakes;
    assert_eq!(lakes.len(), 1, "a thin sheet of rain is no lake");
    assert!((lakes[0].level - 75.0).abs() < 1e-4);
    assert!((lakes[0].deepest - 15.0).abs() < 1e-4);
    run(&LakesStep { from: Source::Water, depth: 20.0, ..LakesStep::default() }, &mut land, 1);
    assert_eq!(Lakes::of(&land).expect("the layers are there"), Lakes::default());
}
