//! A domain that is larger than the budget of a device's memory runs tile by tile within that budget, and gives
//! the bits of the whole.

use std::sync::{Arc, Mutex};

use crate::common::{
    field, landscape, layered, mei, metres, rough, run_on, spring, stava, with, worst_difference,
};
use weald::engine::Engine;
use weald::engine::device::{Device, Loaded};
use weald::engine::program::Program;
use weald::erode::hydraulic::{Hydraulic, Transport};
use weald::erode::slippage_step::SlippageWithin;
use weald::recipe::parameter::{LayerName, Nested};
use weald::{Error, Field, Landscape, Size};
use weald_gpu::Gpu;

/// A device that remembers for what grids it was asked.
#[derive(Debug)]
struct Remembering {
    gpu: Gpu,
    grids: Mutex<Vec<Size>>,
}

impl Device for Remembering {
    fn adapter(&self) -> String {
        self.gpu.adapter()
    }

    fn memory(&self) -> u64 {
        self.gpu.memory()
    }

    fn largest_buffer(&self) -> u64 {
        self.gpu.largest_buffer()
    }

    fn load(&self, program: &Program, size: Size) -> Result<Box<dyn Loaded>, Error> {
        self.grids.lock().expect("no thread failed").push(size);
        self.gpu.load(program, size)
    }
}

/// Runs under a budget of device memory: the landscape, the grid that the device held, and the bytes that it
/// held at most.
fn run_within(step: &Hydraulic, ground: &Landscape, gpu: &Gpu, budget: u64) -> (Landscape, Size, u64) {
    let gpu = gpu.clone().with_memory(budget).expect("more than the least");
    let device = Arc::new(Remembering { gpu: gpu.clone(), grids: Mutex::default() });
    let mut land = ground.clone();
    run_on(step, &mut land, Engine::Device(device.clone()));
    let grids = device.grids.lock().expect("no thread failed");
    (land, grids[0], gpu.peak())
}

/// Runs whole and in at least `tiles` tiles, which give the same bits within the budget.
fn assert_tiles_are_the_whole(step: &Hydraulic, ground: &Landscape, budget: u64, tiles: usize) {
    let Some(gpu) = crate::programs::gpu() else { return };
    let (whole, grid, peak) = run_within(step, ground, &gpu, 2 << 30);
    let cells = ground.domain.size.cells();
    assert!(grid.cells() >= cells && peak > 3 * budget, "{grid:?} took {peak} bytes");
    let moved = worst_difference(field(ground, "height"), field(&whole, "height"));
    assert!(moved > 1e-3, "nothing moved, so agreement would mean nothing: {moved} m");
    let (tiled, grid, peak) = run_within(step, ground, &gpu, budget);
    assert!(tiles * grid.cells() <= cells, "a tile of {grid:?} is too large");
    assert!(peak <= budget && peak > budget / 2, "{peak} bytes of {budget}");
    for ((name, whole), (_, tiled)) in whole.layers().zip(tiled.layers()) {
        let mut pairs = whole.field.values().iter().zip(tiled.field.values());
        let differs = pairs.position(|(a, b)| a.to_bits() != b.to_bits());
        let place = differs.map(|at| [at % ground.domain.size.columns, at / ground.domain.size.columns]);
        assert_eq!(place, None, "`{name}` differs first at this column and row");
    }
}

/// Rain of three steps and two dry ones, of which the last five count into the means.
fn short_cycle(step: Hydraulic) -> Hydraulic {
    let step = with!(step, [Mei Stava] { rain: metres(0.05), dry_period: 2 });
    Hydraulic { rain_period: 3, ..step }
}

#[test]
fn a_million_and_a_half_cells_run_in_16_mebibytes_and_equal_the_whole() {
    let step = short_cycle(mei(6));
    let ground = landscape(rough(1500, 1000, 400.0, 5));
    assert_tiles_are_the_whole(&step, &ground, 16 << 20, 6);
}

#[test]
fn layers_tables_and_painted_weather_run_in_tiles_and_equal_the_whole() {
    let painted = Some(LayerName::of("painted"));
    let step = with!(short_cycle(stava(20)), [Stava] {
        transport: Transport::MacCormack,
        slippage: Some(Nested(SlippageWithin { strength: 0.05, softening: true })),
        rain_layer: painted.clone(),
        sources: vec![spring(40.0, 60.0)],
        drains: vec![spring(200.0, 120.0)],
    });
    let step = Hydraulic { region: painted, ..step };
    let mut ground = layered(rough(300, 200, 60.0, 5));
    let wall = |x: usize, y: usize| (100..110).contains(&x) && y > 50;
    let but_a_wall = Field::from_function(ground.domain.size, |x, y| if wall(x, y) { 0.0 } else { 1.0 });
    ground.insert("painted", "1", but_a_wall);
    assert_tiles_are_the_whole(&step, &ground, 4 << 20, 4);
}
