//! Pipelines against plain loops over whole fields, and the worked example of CONTRIBUTING.

use naga::valid::{Capabilities, ValidationFlags, Validator};

use super::parts::Plane;
use super::*;
use crate::erode::creep;
use crate::erode::thermal::{Scheme, Slide, SlideConstants};
use weald_core::domain::Domain;
use weald_core::grid::{Field, Mask, Size};
use weald_core::landscape::Landscape;
use weald_core::random::signed2;
use weald_engine::kernel;
use weald_engine::machine::Snapshot;
use weald_engine::stencil::rows::{Layout, Rows};
use weald_engine::{Engine, Job};

const SIZE: Size = Size { columns: 23, rows: 31 };
const STEPS: usize = 9;

kernel! {
    /// A mean along a diagonal.
    pub(crate) struct Diagonal {
        reads { level, level_north_east, level_south_west }
        writes { mean }
    }
    fn cell() {
        mean = level * 0.5 + (level_north_east + level_south_west) * 0.25;
    }
}

kernel! {
    /// Changes the mean by that of the south.
    pub(crate) struct Lean {
        reads { mean_south }
        updates { mean }
    }
    fn cell() {
        mean += mean_south * 0.25;
    }
}

kernel! {
    /// The level after the step.
    pub(crate) struct Level {
        reads { level, mean, mean_north, level_west }
        writes { level_after }
        constants { share: f32 }
    }
    fn cell() {
        level_after = level * 0.5 + (mean + mean_north) * share + level_west * 0.125;
    }
}

kernel! {
    /// A trace of the level that leaves, which is read on its way.
    pub(crate) struct Trace {
        reads { trace, level_after_east, level_after_south }
        writes { trace_after }
    }
    fn cell() {
        trace_after = trace * 0.5 + (level_after_east - level_after_south);
    }
}

fn equations() -> Arc<Pipeline> {
    let state = [("level", "level_after"), ("trace", "trace_after")];
    let mut equations = Equations::new(&["base"], &state, &());
    equations
        .number("share", 0.125)
        .kernel::<Diagonal>()
        .kernel::<Lean>()
        .kernel::<Level>()
        .kernel::<Trace>();
    equations.finish()
}

/// The same over whole fields.
fn one_step([level, trace]: &[Field; 2]) -> [Field; 2] {
    let field = |value: &dyn Fn(usize, usize) -> f32| Field::from_function(SIZE, value);
    let beside = |field: &Field, x: usize, y: usize, east: isize, south: isize| {
        let x = x.checked_add_signed(east).filter(|&x| x < SIZE.columns);
        let y = y.checked_add_signed(south).filter(|&y| y < SIZE.rows);
        x.zip(y).map_or(0.0, |(x, y)| field.at(x, y))
    };
    let mean = field(&|x, y| {
        level.at(x, y) * 0.5 + (beside(level, x, y, 1, -1) + beside(level, x, y, -1, 1)) * 0.25
    });
    let mean = field(&|x, y| mean.at(x, y) + beside(&mean, x, y, 0, 1) * 0.25);
    let level = field(&|x, y| {
        level.at(x, y) * 0.5
            + (mean.at(x, y) + beside(&mean, x, y, 0, -1)) * 0.125
            + beside(level, x, y, -1, 0) * 0.125
    });
    let trace =
        field(&|x, y| trace.at(x, y) * 0.5 + (beside(&level, x, y, 1, 0) - beside(&level, x, y, 0, 1)));
    [level, trace]
}

#[test]
fn a_pipeline_does_on_rows_what_plain_loops_do_on_fields_on_every_engine() {
    let start =
        [1, 2].map(|seed| Field::from_function(SIZE, |x, y| signed2(seed, x as i64, y as i64) as f32));
    let mut expected = start.clone();
    for _ in 0..STEPS {
        expected = one_step(&expected);
    }
    let layout = Layout { columns: SIZE.columns, planes: 3 };
    let mut rows = Rows::new(layout, SIZE.rows);
    start.iter().enumerate().for_each(|(plane, field)| rows.scatter(plane, field.values()));
    let process: Stepped =
        Stepped::with_program(&equations(), (SIZE, false), equations().program("test", false));
    let process = Arc::new(process);
    let tiles = Engine::Tiles(Size { columns: 5, rows: 7 });
    for engine in [Engine::Cpu, Engine::Bands(3), Engine::Bands(6), tiles] {
        let start = Snapshot::start(rows.clone(), 0);
        let mut machine =
            weald_engine::machine_of_engine::start(&process, &[], &start, &engine).expect("it starts");
        machine.advance(&[(); STEPS], false).expect("it runs");
        let state = machine.snapshot().expect("it is there").state;
        for (plane, expected) in expected.iter().enumerate() {
            assert_eq!(state.gather(plane), expected.values(), "plane {plane}, {engine:?}");
        }
    }
}

#[test]
fn depths_and_distances_follow_from_the_rows_that_are_read() {
    let pipeline = equations();
    let behind: Vec<_> = pipeline.stages.iter().map(|stage| stage.behind).collect();
    assert_eq!(behind, [1, 2, 2, 3]);
    let leaves: Vec<_> =
        pipeline.leaves.iter().map(|&[_, leaving]| pipeline.planes[leaving].behind).collect();
    assert_eq!(leaves, [3], "the level leaves when the trace has read it");
    let depths: Vec<_> = pipeline.planes.iter().map(Plane::depth).collect();
    assert_eq!(depths, [2, 2, 2, 1, 1]);
    assert_eq!((pipeline.lag(), pipeline.begins(), pipeline.look_back(), pipeline.reach()), (3, 3, 3, 3));
    let slide = |scheme| Slide::new(scheme, SlideConstants { talus: 0.5, strength: 0.1 }).pipeline;
    let lag_and_reach = |scheme| (slide(scheme).lag(), slide(scheme).reach());
    assert_eq!(lag_and_reach(Scheme::Isotropic), (1, 1));
    assert_eq!(lag_and_reach(Scheme::IsotropicSymmetric), (2, 2));
}

#[test]
#[should_panic(expected = "the kernel `Lean` reads `mean_south`, which is no constant")]
fn a_row_that_no_earlier_kernel_writes_is_refused() {
    Equations::new(&["base"], &[("level", "level_after")], &()).kernel::<Lean>();
}

#[test]
#[should_panic(expected = "no kernel writes `level_after`")]
fn a_state_that_nothing_becomes_is_refused() {
    Equations::new(&["base"], &[("level", "level_after")], &()).kernel::<Diagonal>().finish();
}

/// Hills with a hole in the data.
fn hills(masked: bool) -> Landscape {
    let mut land = Landscape::new(Domain::new(SIZE, 2.0));
    let height = Field::from_function(SIZE, |x, y| 9.0 * signed2(5, x as i64, y as i64) as f32);
    land.insert("height", "m", height);
    if masked {
        let data = (0..SIZE.cells()).map(|at| at % SIZE.columns != 7 || at < 200).collect();
        land.domain.valid = Mask::new(SIZE, data);
    }
    land
}

/// The ground after the worked example, made on so many threads.
fn crept(land: &Landscape, engine: &Engine, threads: usize) -> Vec<f32> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
    let mut land = land.clone();
    for step in creep::variants() {
        let job = Job { engine: engine.clone(), ..Job::unwatched(1) };
        pool.install(|| step.run(&mut land, &job)).expect("it runs");
    }
    land.field("height").expect("it is there").values().to_vec()
}

#[test]
fn the_worked_example_keeps_the_ground_makes_it_smoother_and_has_the_same_bits_everywhere() {
    for masked in [false, true] {
        let land = hills(masked);
        let before = land.field("height").expect("h").values();
        let after = crept(&land, &Engine::Cpu, 1);
        let sum = |values: &[f32], power: i32| -> f64 {
            let cells = values.iter().enumerate();
            let land =
                cells.filter(|(at, _)| land.domain.valid.as_ref().is_none_or(|mask| mask.is_valid_at(*at)));
            land.map(|(_, &value)| f64::from(value).powi(power)).sum()
        };
        assert!((sum(before, 1) - sum(&after, 1)).abs() < 1e-3, "what one cell loses another gets");
        assert!(sum(&after, 2) < 0.2 * sum(before, 2), "hills become lower, and hollows less deep");
        let tiles = Engine::Tiles(Size { columns: 6, rows: 5 });
        for (engine, threads) in [(Engine::Cpu, 2), (Engine::Cpu, 5), (Engine::Bands(3), 1), (tiles, 1)] {
            assert_eq!(crept(&land, &engine, threads), after, "{engine:?} on {threads} threads");
        }
    }
}

#[test]
fn the_shader_of_the_worked_example_is_valid_and_reads_what_its_text_says() {
    for masked in [false, true] {
        let program = creep::equations(0.1).program("creep", masked);
        let [pass] = &program.passes[..] else { panic!("one pass") };
        let named =
            |buffers: &[usize]| -> Vec<_> { buffers.iter().map(|&at| program.buffers[at].name).collect() };
        assert_eq!((named(&pass.reads), named(&pass.writes)), (vec!["base", "change"], vec!["changed"]));
        let text = program.module(pass);
        let module = naga::front::wgsl::parse_str(&text).unwrap_or_else(|error| panic!("{error}"));
        let checked = Validator::new(ValidationFlags::all(), Capabilities::empty()).validate(&module);
        checked.unwrap_or_else(|error| panic!("{}", error.emit_to_string(&text)));
    }
}

#[test]
fn contributing_has_the_worked_example_word_for_word() {
    let text = include_str!("../../../../../CONTRIBUTING.md");
    for file in [
        include_str!("../../../tests/worked_example/creep.rs"),
        include_str!("../../../tests/worked_example/creep.wgsl"),
    ] {
        assert!(text.contains(&format!("\n{}```\n", file.trim_start())), "CONTRIBUTING.md lacks:\n{file}");
    }
}
