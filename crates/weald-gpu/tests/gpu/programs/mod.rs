//! Small programs whose results can be told by hand, and the device that tests run on.

#![allow(dead_code, reason = "each test file uses a part")]

use std::sync::OnceLock;

use weald::Error;
use weald::engine::device::{Device, Loaded};
use weald::engine::program::{Buffer, Content, Pass, Program, Uniforms};
use weald::grid::Size;
use weald_gpu::Gpu;

/// The device that the tests of a file share. Without one they fail; a developer who has none, and cannot
/// install `mesa-vulkan-drivers`, sets `WEALD_NO_GPU=1` to leave them out.
pub(crate) fn gpu() -> Option<Gpu> {
    static GPU: OnceLock<Option<Gpu>> = OnceLock::new();
    let open = || {
        if std::env::var_os("WEALD_NO_GPU").is_some_and(|value| value == "1") {
            println!("WEALD_NO_GPU=1 is set: this test of the GPU engine is left out");
            return None;
        }
        Some(Gpu::any().expect("tests of the GPU engine need an adapter"))
    };
    GPU.get_or_init(open).clone()
}

/// What a device says that refuses something.
pub(crate) fn refusal<T>(result: Result<T, Error>) -> String {
    match result {
        Err(Error::Device(error)) => error.message,
        Err(other) => panic!("an error of another kind: {other}"),
        Ok(_) => panic!("it was not refused"),
    }
}

pub(crate) fn load(gpu: &Gpu, program: &Program, size: Size) -> Box<dyn Loaded> {
    gpu.load(program, size).expect("the program loads")
}

/// One step for each number, which every cell receives as the weather.
pub(crate) fn weather(rain: impl IntoIterator<Item = u32>) -> Vec<Vec<u32>> {
    rain.into_iter().map(|rain| vec![rain]).collect()
}

/// Whole numbers that stay exact in `f32`.
pub(crate) fn numbers(count: usize) -> Vec<f32> {
    (0..count).map(|at| (at * at % 911) as f32).collect()
}

/// Each cell mixes its own number, those of its neighbours that hold data, and the weather.
const MIX: &str = "
struct Weather { rain: u32 }

@compute @workgroup_size(16, 16)
fn mix_all(@builtin(global_invocation_id) invocation: vec3<u32>) {
    let cell = cell_of(invocation);
    if (inside(cell)) {
        let sides = link(cell, cell + EAST) * 5.0 * here[index(cell + EAST)]
            + link(cell, cell + WEST) * 7.0 * here[index(cell + WEST)]
            + link(cell, cell + NORTH) * 11.0 * here[index(cell + NORTH)]
            + link(cell, cell + SOUTH) * 13.0 * here[index(cell + SOUTH)];
        next[index(cell)] = f32((u32(3.0 * here[index(cell)] + sides) + weather.rain) % 997u);
    }
}
";

/// The same on the CPU.
pub(crate) fn mixed(size: Size, valid: &[bool], start: &[f32], weather: &[Vec<u32>]) -> Vec<f32> {
    let mut here: Vec<u32> = start.iter().map(|&value| value as u32).collect();
    for step in weather {
        let at = |x: usize, y: usize| {
            let whole = x < size.columns && y < size.rows;
            whole.then(|| y * size.columns + x).filter(|&cell| valid[cell]).map_or(0, |cell| here[cell])
        };
        let next = |cell: usize| {
            let (x, y) = (cell % size.columns, cell / size.columns);
            let sides = 5 * at(x + 1, y)
                + 7 * at(x.wrapping_sub(1), y)
                + 11 * at(x, y.wrapping_sub(1))
                + 13 * at(x, y + 1);
            (3 * here[cell] + if valid[cell] { sides } else { 0 } + step[0]) % 997
        };
        here = (0..size.cells()).map(next).collect();
    }
    here.into_iter().map(|value| value as f32).collect()
}

/// A program with one pass that writes `next` from `here`, which then exchange roles.
pub(crate) fn mix() -> Program {
    Program {
        name: "mix",
        buffers: vec![
            Buffer::new("here", 1, Content::State(vec![0])),
            Buffer::new("next", 1, Content::Scratch),
        ],
        passes: vec![pass("mix_all", MIX, vec![0], vec![1])],
        swaps: vec![[0, 1]],
        constants: Uniforms::default(),
        weather: Uniforms { name: "Weather", fields: vec![("rain", "u32")], words: vec![0] },
        flags: Vec::new(),
        counts: Vec::new(),
        mask: None,
        reach: 1,
        shown: None,
    }
}

/// The same where a mask, buffer 2, says which cells hold data.
pub(crate) fn mix_with_mask() -> Program {
    let mut program = mix();
    program.buffers.push(Buffer::new("mask", 2, Content::Constant(vec![1, 2])));
    program.mask = Some(2);
    program
}

/// A program whose weather is a number that every cell counts into the third sum and, where steps are
/// recorded, adds to a mean. State is the number of steps.
pub(crate) fn count() -> Program {
    const COUNT: &str = "
struct Weather { amount: f32 }

@compute @workgroup_size(16, 16)
fn count_all(@builtin(global_invocation_id) invocation: vec3<u32>) {
    let cell = cell_of(invocation);
    if (inside(cell)) {
        steps[index(cell)] += 1.0;
    }
    tally(2u, cell, weather.amount);
}
";
    const RECORD: &str = "
struct Weather { amount: f32 }

@compute @workgroup_size(16, 16)
fn record(@builtin(global_invocation_id) invocation: vec3<u32>) {
    let cell = cell_of(invocation);
    if (inside(cell)) {
        mean[index(cell)] += weather.amount;
    }
}
";
    let counting = Pass { tallies: true, ..pass("count_all", COUNT, vec![], vec![0]) };
    let recording = Pass { recorded: true, ..pass("record", RECORD, vec![], vec![1]) };
    Program {
        name: "count",
        buffers: vec![
            Buffer::new("steps", 1, Content::State(vec![0])),
            Buffer::new("mean", 1, Content::Mean),
        ],
        passes: vec![counting, recording],
        swaps: Vec::new(),
        weather: Uniforms { name: "Weather", fields: vec![("amount", "f32")], words: vec![0] },
        ..mix()
    }
}

/// A program that adds to each cell the whole number that a table holds for its column.
pub(crate) fn table(columns: usize) -> Program {
    const LOOK_UP: &str = "
@compute @workgroup_size(16, 16)
fn look_up(@builtin(global_invocation_id) invocation: vec3<u32>) {
    let cell = cell_of(invocation);
    if (inside(cell)) {
        found[index(cell)] += f32(of_columns[cell.x].y);
    }
}
";
    Program {
        name: "table",
        buffers: vec![
            Buffer::new("found", 1, Content::State(vec![0])),
            Buffer::of_words("of_columns", 2, Content::Table(columns)),
        ],
        passes: vec![pass("look_up", LOOK_UP, vec![1], vec![0])],
        swaps: Vec::new(),
        weather: Uniforms::default(),
        ..mix()
    }
}

/// A program without weather that adds constants to vectors of four and to three planes.
pub(crate) fn lanes() -> Program {
    const ADD: &str = "
struct Constants { first: f32, second: f32 }

@compute @workgroup_size(16, 16)
fn add(@builtin(global_invocation_id) invocation: vec3<u32>) {
    let cell = cell_of(invocation);
    if (!inside(cell)) {
        return;
    }
    vectors[index(cell)] += vec4<f32>(constants.first, constants.second, f32(cell.x), f32(cell.y));
    for (var plane = 0u; plane < 3u; plane++) {
        planes[plane * grid.columns * grid.rows + index(cell)] += f32(plane) + constants.second;
    }
}
";
    Program {
        name: "lanes",
        buffers: vec![
            Buffer::new("vectors", 4, Content::State(vec![0, 1, 2, 3])),
            Buffer::layered("planes", 3, Content::State(vec![4, 5, 6])),
        ],
        passes: vec![pass("add", ADD, vec![], vec![0, 1])],
        swaps: Vec::new(),
        constants: Uniforms {
            name: "Constants",
            fields: vec![("first", "f32"), ("second", "f32")],
            words: vec![0.5_f32.to_bits(), 8.0_f32.to_bits()],
        },
        weather: Uniforms::default(),
        ..mix()
    }
}

pub(crate) fn pass(name: &'static str, shader: &'static str, reads: Vec<usize>, writes: Vec<usize>) -> Pass {
    Pass { name, shaders: vec![shader], reads, writes, tallies: false, recorded: false }
}
