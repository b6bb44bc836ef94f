//! Flow tile by tile: the bits of the whole, however the grid is cut.

use std::path::Path;
use std::sync::Arc;

use crate::common::rough;
use weald_core::grid::Mask;
use weald_core::plane::{HeldPlane, Plane, Window};
use weald_core::random::{hash2, unit};
use weald_core::{Error, Field, Size};
use weald_engine::ranks::{Ranks, SharedRows, ranks_in_threads};
use weald_engine::stored::StoredPlane;
use weald_land::flow::tiled::{
    SharedPlane, StoredCodes, TiledFlow, TiledGround, Tiling, accumulate_tiled, route_tiled,
};
use weald_land::flow::{
    Depressions, DirectionRule, MultipleFlow, Routing, accumulate, accumulate_multiple, route,
};

/// Ground, what has data on it, and what each cell adds.
struct Case {
    height: Field,
    valid: Option<Mask>,
    weight: Field,
    sea_level: Option<f64>,
}

fn held<T: Copy>(size: Size, values: &[T]) -> HeldPlane<T> {
    HeldPlane::new(size, values.to_vec())
}

fn bits(values: &[f64]) -> Vec<u64> {
    values.iter().map(|value| value.to_bits()).collect()
}

/// Sums over tiles, all put once.
fn sums(flow: &TiledFlow<'_>) -> Vec<f64> {
    let size = flow.tiling.size();
    let mut plane = HeldPlane::new(size, vec![f64::NAN; size.cells()]);
    let mut put = 0;
    accumulate_tiled(
        flow,
        &mut |window, sums| {
            put += sums.len();
            plane.write(window, sums)
        },
        &mut |_| Ok(()),
    )
    .expect("no cycle");
    assert_eq!(put, size.cells(), "each tile is put once");
    plane.values().to_vec()
}

/// Compares everything that `flow` gives, whole and by tiles.
fn assert_same(case: &Case, tile: Size, what: &str) {
    for directions in [DirectionRule::Steepest, DirectionRule::LeastDeviation] {
        assert_same_by(directions, case, tile, &format!("{what}, {directions:?}"));
    }
}

fn assert_same_by(directions: DirectionRule, case: &Case, tile: Size, what: &str) {
    let size = case.height.size();
    let tiling = Tiling::new(size, tile).expect("legal");
    let routing = Routing { sea_level: case.sea_level, directions, ..Routing::default() };
    let valid = case.valid.as_ref();
    let whole = route(&case.height, valid, &routing);
    let flags =
        valid.map(|valid| held(size, &valid.flags().iter().map(|&flag| u8::from(flag)).collect::<Vec<_>>()));
    let flags = flags.as_ref().map(|flags| flags as &(dyn Plane<u8> + Sync));
    let (height, weight) = (held(size, case.height.values()), held(size, case.weight.values()));
    let (mut filled, mut codes) =
        (held(size, &vec![f32::NAN; size.cells()]), held(size, &vec![77_u8; size.cells()]));
    let ground = TiledGround { tiling: &tiling, height: &height, valid: flags };
    route_tiled(&ground, &routing, (&mut filled, &mut codes), &mut |_| Ok(())).expect("it is routed");
    let as_bits = |values: &[f32]| values.iter().map(|value| value.to_bits()).collect::<Vec<_>>();
    assert!(as_bits(filled.values()) == as_bits(whole.surface.values()), "levels: {what}");
    assert!(codes.values() == whole.directions.codes(), "directions: {what}");
    let flow = TiledFlow { tiling: &tiling, directions: &codes, valid: flags, weight: None, shared: None };
    let weighted = TiledFlow { weight: Some(&weight), ..flow };
    let shared = TiledFlow { shared: Some((&filled, 1.1)), ..weighted };
    assert!(bits(&sums(&flow)) == bits(&accumulate(&whole.directions, valid, None)), "areas: {what}");
    let discharge = accumulate(&whole.directions, valid, Some(&case.weight));
    assert!(bits(&sums(&weighted)) == bits(&discharge), "discharge: {what}");
    let multiple = MultipleFlow { routed: &whole, valid, exponent: 1.1 };
    assert!(
        bits(&sums(&shared)) == bits(&accumulate_multiple(&multiple, Some(&case.weight))),
        "shared: {what}"
    );
}

/// Rough ground; whole steps make flats, ties and nested depressions, and a lake bed lies across its middle.
fn case(seed: u64, size: Size) -> Case {
    let random = |of: i64| hash2(seed, of, 91);
    let step = [0.0, 0.5, 4.0, 15.0][random(1) as usize % 4];
    let bed = 12.0 + 10.0 * unit(random(2)) as f32;
    let lake = random(3) % 3 == 0;
    let ground = rough(size.columns.max(2), size.rows.max(2), 40.0, seed);
    let height = Field::from_function(size, |x, y| {
        let height = ground.at(x, y);
        let height = if step > 0.0 { (height / step).round() * step } else { height };
        let middle =
            size.columns / 4 < x && x < size.columns * 3 / 4 && size.rows / 4 < y && y < size.rows * 3 / 4;
        let height = if lake && middle { height.min(bed) } else { height };
        // Both zeros are among the heights.
        if height == bed { -0.0 } else { height - 11.0 }
    });
    let one_in = [3, 40, 700, u64::MAX][random(4) as usize % 4];
    let flags = (0..size.cells()).map(|cell| !hash2(seed, cell as i64, 5).is_multiple_of(one_in)).collect();
    let weight = Field::from_function(size, |x, y| unit(hash2(seed, x as i64, y as i64)) as f32 * 900.0);
    let sea_level = (random(5) % 2 == 0).then_some(-3.0 + 8.0 * unit(random(6)));
    Case { height, valid: Mask::new(size, flags), weight, sea_level }
}

#[test]
fn a_hundred_grounds_flow_by_tiles_as_they_do_whole() {
    for seed in 0..100 {
        let side = |of: i64, most: u64| 1 + (hash2(seed, of, 17) % most) as usize;
        let size = Size { columns: side(1, 90), rows: side(2, 90) };
        let tile = Size { columns: side(3, 40), rows: side(4, 40) };
        assert_same(&case(seed, size), tile, &format!("ground {seed}, {size} by {tile}"));
    }
}

#[test]
fn a_plain_is_drained_by_tiles_as_it_is_whole() {
    let size = Size { columns: 61, rows: 47 };
    let weight = Field::filled(size, 0.1);
    // One hill, which the distances of the whole plain know of.
    let height = Field::from_function(size, |x, y| if (x, y) == (40, 30) { 1.0 } else { 0.0 });
    let plain = Case { height, valid: None, weight, sea_level: None };
    for tile in [[7, 7], [61, 3], [1, 1], [13, 47]] {
        let tile = Size { columns: tile[0], rows: tile[1] };
        assert_same(&plain, tile, &format!("{tile}"));
    }
}

/// What a rank has in the end of its own rows: levels, codes, and sums of weights and of shares.
type OwnRows = (Vec<f32>, Vec<u8>, [Vec<f64>; 2]);

/// What each of so many ranks finds of its own rows.
fn over(count: usize, case: &Case, routing: &Routing, tile: Size) -> Vec<OwnRows> {
    let size = case.height.size();
    let flags = case.valid.as_ref().map(|valid| valid.flags().iter().map(|&flag| u8::from(flag)).collect());
    let flags: Option<Vec<u8>> = flags;
    let work = |ranks: Arc<dyn Ranks>| {
        let rows = SharedRows::of((ranks.rank(), count), size.rows);
        let own = rows.own();
        let grid = (size.columns, &rows);
        let new = || StoredPlane::new("plane", None, grid).expect("in memory");
        let with = |field: &Field| {
            let mut plane = new();
            let cells = own.start * size.columns..own.end * size.columns;
            plane.set_rows(own.clone(), &field.values()[cells]).expect("its own");
            plane.swap(&*ranks).expect("all are there");
            plane
        };
        let tiling = Tiling::over(grid, tile, &ranks).expect("legal");
        let flags = flags.as_ref().map(|flags| held(size, flags));
        let valid = flags.as_ref().map(|flags| flags as &(dyn Plane<u8> + Sync));
        let (height, weight) = (with(&case.height), with(&case.weight));
        let (mut filled, mut codes) = (new(), StoredCodes(new()));
        let ground = TiledGround { tiling: &tiling, height: &height, valid };
        route_tiled(&ground, routing, (&mut filled, &mut codes), &mut |_| Ok(())).expect("it is routed");
        let sums = [None, Some((&filled as &(dyn Plane<f32> + Sync), 1.1))].map(|shared| {
            let flow =
                TiledFlow { tiling: &tiling, directions: &codes, valid, weight: Some(&weight), shared };
            let mut sums = vec![f64::NAN; own.len() * size.columns];
            let put = &mut |window: &Window, values: &[f64]| {
                for (y, row) in window.rows.clone().zip(values.chunks_exact(window.columns.len())) {
                    let first = (y - own.start) * size.columns;
                    sums[first + window.columns.start..first + window.columns.end].copy_from_slice(row);
                }
                Ok(())
            };
            accumulate_tiled(&flow, put, &mut |_| Ok(())).expect("no cycle");
            sums
        });
        let whole = Window { columns: 0..size.columns, rows: own.clone() };
        (filled.rows(own).expect("its own"), codes.read(&whole).expect("its own"), sums)
    };
    std::thread::scope(|scope| {
        let running: Vec<_> =
            ranks_in_threads(count).into_iter().map(|ranks| scope.spawn(|| work(ranks))).collect();
        running.into_iter().map(|rank| rank.join().expect("no panic")).collect()
    })
}

#[test]
fn ranks_that_hold_their_own_rows_alone_find_what_the_whole_has() {
    for seed in 0..20 {
        let side = |of: i64, least: u64, most: u64| (least + hash2(seed, of, 18) % (most - least)) as usize;
        let size = Size { columns: side(1, 1, 70), rows: side(2, 20, 230) };
        let tile = Size { columns: side(3, 1, 40), rows: side(4, 1, 60) };
        let case = case(seed, size);
        let valid = case.valid.as_ref();
        let directions = [DirectionRule::Steepest, DirectionRule::LeastDeviation][seed as usize % 2];
        let routing = Routing { sea_level: case.sea_level, directions, ..Routing::default() };
        let whole = route(&case.height, valid, &routing);
        let multiple = MultipleFlow { routed: &whole, valid, exponent: 1.1 };
        let sums = [
            accumulate(&whole.directions, valid, Some(&case.weight)),
            accumulate_multiple(&multiple, Some(&case.weight)),
        ];
        for count in [1, 2, 3, 4, 6] {
            let (mut levels, mut codes, mut got) = (Vec::new(), Vec::new(), [Vec::new(), Vec::new()]);
            for (own_levels, own_codes, own_sums) in over(count, &case, &routing, tile) {
                levels.extend(own_levels.iter().map(|level| level.to_bits()));
                codes.extend(own_codes);
                got.iter_mut().zip(own_sums).for_each(|(got, own)| got.extend(bits(&own)));
            }
            let what = format!("ground {seed}, {size} by {tile}, {directions:?}, {count} ranks");
            let expected: Vec<_> = whole.surface.values().iter().map(|level| level.to_bits()).collect();
            assert!(levels == expected, "levels: {what}");
            assert!(codes == whole.directions.codes(), "directions: {what}");
            for (which, (got, expected)) in got.iter().zip(&sums).enumerate() {
                assert!(*got == bits(expected), "sums {which}: {what}");
            }
        }
    }
}

#[test]
fn a_model_of_real_ground_flows_by_tiles_as_it_does_whole() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../data/jacksboro_fault_utm16_80m.tif");
    let raster = weald_io::read(&path).unwrap_or_else(|error| panic!("{error}"));
    let weight =
        Field::from_function(raster.field.size(), |x, y| 300.0 + unit(hash2(3, x as i64, y as i64)) as f32);
    let real = Case { height: raster.field, valid: raster.valid, weight, sea_level: None };
    assert!(real.valid.is_some(), "its corners have no data");
    for tile in [[64, 64], [100, 37], [388, 50]] {
        let tile = Size { columns: tile[0], rows: tile[1] };
        assert_same(&real, tile, &format!("{tile}"));
    }
}

#[test]
fn what_cannot_be_done_by_tiles_is_refused_by_name() {
    let size = Size { columns: 6, rows: 5 };
    let tiling = Tiling::new(size, Size { columns: 3, rows: 3 }).expect("legal");
    let route_over = |height: f32, routing: &Routing| {
        let mut heights = vec![1.0; size.cells()];
        heights[16] = height;
        let height = held(size, &heights);
        let ground = TiledGround { tiling: &tiling, height: &height, valid: None };
        let planes: (&mut dyn SharedPlane<f32>, &mut dyn SharedPlane<u8>) =
            (&mut held(size, &[0.0; 30]), &mut held(size, &[0; 30]));
        route_tiled(&ground, routing, planes, &mut |_| Ok(()))
    };
    let said = |done: Result<(), Error>| done.expect_err("refused").to_string();
    let breach = Routing { depressions: Depressions::Breach, ..Routing::default() };
    assert!(said(route_over(1.0, &breach)).contains("depressions = \"fill\""));
    let not_finite = said(route_over(f32::NAN, &Routing::default()));
    assert!(not_finite.contains("column 4, row 2 is NaN"), "{not_finite}");
    let codes = held(size, &[vec![1, 5], vec![0; 28]].concat());
    let cycle = TiledFlow { tiling: &tiling, directions: &codes, valid: None, weight: None, shared: None };
    let cycle = said(accumulate_tiled(&cycle, &mut |_, _| Ok(()), &mut |_| Ok(())));
    assert!(cycle.contains("flows in a cycle through columns 0..1"), "{cycle}");
    assert!(route_over(1.0, &Routing::default()).is_ok());
    let mut visits = 0;
    let height = held(size, &[1.0; 30]);
    let ground = TiledGround { tiling: &tiling, height: &height, valid: None };
    let planes: (&mut dyn SharedPlane<f32>, &mut dyn SharedPlane<u8>) =
        (&mut held(size, &[0.0; 30]), &mut held(size, &[0; 30]));
    let stopped = route_tiled(&ground, &Routing::default(), planes, &mut |_| {
        visits += 1;
        if visits == 3 { Err(Error::Interrupted("here".to_owned())) } else { Ok(()) }
    });
    assert!(matches!(stopped, Err(Error::Interrupted(_))) && visits == 3);
}
