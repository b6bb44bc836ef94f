//! Processes, grounds and cuts drawn at random, the same at every run.

use weald_core::grid::Mask;
use weald_core::parameter::{LayerName, Nested};
use weald_core::random::{hash2, unit};
use weald_core::{Landscape, Size};
use weald_engine::step::Step;
use weald_land::erode::dissolution_step::{DissolutionStep, DissolutionWithin};
use weald_land::erode::fluvial_step::Fluvial;
use weald_land::erode::hydraulic::{Boundary, Hydraulic, Slope, Transport, UptakeLaw};
use weald_land::erode::slippage_step::{SlippageStep, SlippageWithin};
use weald_land::erode::thermal::Scheme;
use weald_land::erode::thermal_step::{Thermal, ThermalWithin};
use weald_land::erode::transport_step::{self, Carry};

use crate::common::{self, layered, metres, rough, run, spring, with};

/// Every model with every transport, and each of the processes that are steps of their own.
pub(crate) const KINDS: u64 = 17;

/// Most steps between two looks of a simulation at itself: all runs are longer, so that all can be stopped.
const STRETCH: u64 = 256;

/// One case: a process on a ground, and when somebody looks at it.
pub(crate) struct Case {
    pub(crate) step: Box<dyn Step>,
    /// Layer that the process changes.
    pub(crate) changes: &'static str,
    pub(crate) ground: Landscape,
    pub(crate) looks: [u64; 2],
    pub(crate) bands: usize,
    pub(crate) tiles: Size,
}

/// The case of that number, of 300 steps and more.
pub(crate) fn case(number: u64) -> Case {
    case_of(number, 300)
}

/// The same of so many steps and more.
pub(crate) fn case_of(number: u64, steps: u64) -> Case {
    let mut draw = Draw { case: number, drawn: 0, steps };
    let ground = draw.ground();
    let kind = number % KINDS;
    let step: Box<dyn Step> = match kind {
        0..12 => Box::new(draw.hydraulic(kind)),
        12 => Box::new(draw.thermal()),
        13 => Box::new(draw.carry()),
        14 => Box::new(draw.slippage()),
        15 => Box::new(draw.fluvial()),
        _ => Box::new(draw.dissolution()),
    };
    let first = draw.among(1..STRETCH);
    Case {
        step,
        changes: if kind == 13 { "painted" } else { "height" },
        ground: if kind == 13 { with_rivers(ground) } else { ground },
        looks: [first, draw.among(first + 1..STRETCH + 30)],
        bands: draw.among(2..7) as usize,
        tiles: Size { columns: draw.among(14..40) as usize, rows: draw.among(20..80) as usize },
    }
}

/// What an earlier step of rain leaves for the transport.
fn with_rivers(mut ground: Landscape) -> Landscape {
    run(&common::hydraulic(100), &mut ground);
    ground
}

/// Random numbers of one case.
struct Draw {
    case: u64,
    drawn: i64,
    /// Fewest steps of a process.
    steps: u64,
}

impl Draw {
    fn bits(&mut self) -> u64 {
        self.drawn += 1;
        hash2(13, self.case as i64, self.drawn)
    }

    fn among(&mut self, range: std::ops::Range<u64>) -> u64 {
        range.start + self.bits() % (range.end - range.start)
    }

    fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * unit(self.bits())
    }

    /// Whether it is so, once in `times`.
    fn once_in(&mut self, times: u64) -> bool {
        self.among(0..times) == 0
    }

    fn one_of<T: Copy>(&mut self, choices: &[T]) -> T {
        choices[self.among(0..choices.len() as u64) as usize]
    }

    /// More than two seasons.
    fn steps(&mut self) -> u32 {
        self.among(self.steps..self.steps + 40) as u32
    }

    /// Rough layered ground. Some of it is so high that several steps go through it in one time block, whatever the
    /// reach of the process.
    fn ground(&mut self) -> Landscape {
        let columns = self.among(9..28) as usize;
        let rows = if self.once_in(3) { self.among(24..64) } else { self.among(64..128) } as usize;
        let mut ground = layered(rough(columns, rows, 25.0, self.bits() % 1000));
        ground.domain.valid = self.mask(ground.domain.size);
        ground
    }

    /// No mask, scattered holes, or a rim and a lake without data.
    fn mask(&mut self, size: Size) -> Option<Mask> {
        let kind = self.among(0..3);
        let every = self.among(5..40) as usize;
        let (left, lake) = (self.among(1..5) as usize, self.among(2..6) as usize);
        let land = move |at: usize| {
            let (x, y) = (at % size.columns, at / size.columns);
            match kind {
                1 => !(at * 7919).is_multiple_of(every),
                _ => x >= left && x.abs_diff(size.columns / 2).max(y.abs_diff(size.rows / 2)) > lake,
            }
        };
        (kind > 0).then(|| Mask::new(size, (0..size.cells()).map(land).collect()).expect("its size"))
    }

    fn hydraulic(&mut self, kind: u64) -> Hydraulic {
        let model = [common::hydraulic, common::mei, common::stava][kind as usize % 3](self.steps());
        let (transport, conserve) = [
            (Transport::Upwind, true),
            (Transport::SemiLagrangian, true),
            (Transport::MacCormack, false),
            (Transport::MacCormack, true),
        ][kind as usize / 3];
        let rain = metres(self.between(0.005, 0.05));
        let dry_period = if self.once_in(5) { 0 } else { self.among(5..70) as u32 };
        let step = with!(model, [Han Mei Stava] {
            transport: transport, conserve: conserve, rain: rain, dry_period: dry_period,
        });
        let step = Hydraulic {
            rain_period: self.among(20..80) as u32,
            boundary: self.one_of(&[Boundary::Closed, Boundary::Open]),
            initial_water: self.painted(6),
            ..step
        };
        let region = if step.boundary == Boundary::Closed { self.painted(6) } else { None };
        let step = Hydraulic { region, ..step };
        if kind % 3 == 2 {
            self.of_stava(step)
        } else {
            self.of_water_alone(step, kind.is_multiple_of(3), transport)
        }
    }

    fn painted(&mut self, once_in: u64) -> Option<LayerName> {
        self.once_in(once_in).then(|| LayerName::of("painted"))
    }

    /// What `han` and `mei` have beside their water. Flow without a limiter is stable where it is slow.
    fn of_water_alone(&mut self, step: Hydraulic, is_han: bool, transport: Transport) -> Hydraulic {
        let deposit_ratio = self.one_of(&[1.0, 0.3]);
        let thermal = self.once_in(2).then(|| Nested(self.thermal_within()));
        let mut step = with!(step, [Han Mei] { deposit_ratio: deposit_ratio, thermal: thermal });
        if transport == Transport::Upwind && self.once_in(3) {
            step = with!(step, [Han Mei] { limiter: false, flow_rate: 0.05 });
        }
        let law = self.one_of(&[UptakeLaw::Velocity, UptakeLaw::Dissolution]);
        if is_han {
            return with!(step, [Han] { law: law });
        }
        with!(step, [Mei] { slope: self.one_of(&[Slope::MeanSine, Slope::Central]) })
    }

    fn of_stava(&mut self, step: Hydraulic) -> Hydraulic {
        let spring = |draw: &mut Self| spring(draw.between(2.0, 20.0), draw.between(2.0, 20.0));
        let slippage = |softening| Nested(SlippageWithin { strength: 0.05, softening });
        with!(step, [Stava] {
            viscosity: self.one_of(&[0.0, 0.7]),
            dissolution: self.once_in(2).then(|| Nested(DissolutionWithin::default())),
            slippage: self.once_in(2).then(|| slippage(self.once_in(2))),
            rain_layer: self.painted(3),
            evaporation_layer: self.painted(3),
            sources: if self.once_in(3) { vec![spring(self)] } else { Vec::new() },
            drains: if self.once_in(3) { vec![spring(self)] } else { Vec::new() },
        })
    }

    fn thermal_within(&mut self) -> ThermalWithin {
        let scheme = self.one_of(&[Scheme::Axis, Scheme::Isotropic, Scheme::IsotropicSymmetric]);
        ThermalWithin { scheme, talus: self.between(0.1, 0.8), strength: self.between(0.02, 0.2) }
    }

    /// A flood of about as many steps as the others run.
    fn fluvial(&mut self) -> Fluvial {
        let deepest = 1.0;
        let step = 0.5 / (9.81_f64 * deepest).sqrt();
        let boundary = self.one_of(&[Boundary::Closed, Boundary::Open]);
        Fluvial {
            deepest,
            boundary,
            flow_time: f64::from(self.steps()) * step / 3600.0,
            duration: self.between(1.0, 5.0),
            rain: self.between(500.0, 5000.0),
            settling: self.between(0.0, 0.1),
            gathering: self.between(0.5, 5.0),
            channel_width: self.between(0.2, 4.0),
            region: if boundary == Boundary::Closed { self.painted(6) } else { None },
            ..Fluvial::default()
        }
    }

    fn thermal(&mut self) -> Thermal {
        let ThermalWithin { scheme, talus, strength } = self.thermal_within();
        Thermal { scheme, talus, strength, iterations: self.steps(), ..Thermal::default() }
    }

    fn carry(&mut self) -> Carry {
        let (scheme, conserve) = self.one_of(&[
            (transport_step::Scheme::SemiLagrangian, true),
            (transport_step::Scheme::MacCormack, false),
            (transport_step::Scheme::MacCormack, true),
        ]);
        let layer = LayerName::of("painted");
        Carry { layer, scheme, conserve, iterations: self.steps(), ..Carry::default() }
    }

    fn slippage(&mut self) -> SlippageStep {
        let softening = self.once_in(2);
        SlippageStep { strength: 0.06, softening, iterations: self.steps(), ..SlippageStep::default() }
    }

    fn dissolution(&mut self) -> DissolutionStep {
        let water = LayerName::of("painted");
        DissolutionStep { water, iterations: self.steps(), ..DissolutionStep::default() }
    }
}
