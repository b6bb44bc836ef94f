//! Rates of random iteration and of swaying on a device.

use std::fmt::{Display, Formatter, Result as Written};
use web_time::Instant;

use weald::Error;
use weald::grow::ifs::wind::Wind;
use weald::grow::ifs::{Game, Ifs};

use super::play::Play;
use super::points::{BYTES, Points};
use super::{SWAYING_POINT_BYTES, SwayingPoints};
use crate::gpu::Gpu;

/// Points that are made and that sway: those of a plant near the eye.
const POINTS: u64 = 1_000_000;

/// Seconds that a measurement should take, and most repetitions within one.
const SECONDS: f64 = 0.25;
const MAX_RUNS: f64 = 1000.0;

/// Measurements, of which the best counts: others' work only ever makes one slower.
const RUNS: usize = 3;

/// Millions of points per second, for a swaying cloud of a million.
#[derive(Clone, Debug, PartialEq)]
pub struct PointRates {
    /// Name of the fractal.
    pub name: String,
    /// Random iteration without codes.
    pub played: f64,
    /// Random iteration with codes.
    pub coded: f64,
    /// Points put where a pose of the wind wants them, the pose uploaded anew each time.
    pub swayed: f64,
    /// Bytes per second that the device reads and writes while it copies.
    pub bandwidth: f64,
}

impl PointRates {
    /// Measures them on a device; nothing is read back.
    ///
    /// # Errors
    /// [`Error::Device`] where its memory does not hold a million points, or it fails.
    pub fn of(gpu: &Gpu, ifs: &Ifs) -> Result<Self, Error> {
        let played = |coded: bool| {
            let play = Play::new(gpu, Game::new(ifs, 1), coded)?;
            let mut points = Points::new(gpu, POINTS, coded, 2 * BYTES)?;
            rate(|| play.fill(&mut points))
        };
        let mut swaying = SwayingPoints::new(gpu, ifs, 1, POINTS)?;
        let wind = Wind { speed: 20.0, ..Wind::default() };
        let mut frame = 0;
        let swayed = rate(|| {
            frame += 1;
            swaying.sway(&wind.pose(f64::from(frame) / 60.0))?;
            swaying.wait()
        })?;
        drop(swaying);
        let bandwidth = gpu.copy_bandwidth()?;
        Ok(Self {
            name: ifs.name().to_owned(),
            played: played(false)?,
            coded: played(true)?,
            swayed,
            bandwidth,
        })
    }

    /// Frames per second in which a million points can sway.
    pub fn frames(&self) -> f64 {
        self.swayed * 1e6 / POINTS as f64
    }
}

/// Million points per second.
fn rate(mut once: impl FnMut() -> Result<(), Error>) -> Result<f64, Error> {
    once()?;
    let mut seconds = |times: u32| {
        let begun = Instant::now();
        (0..times).try_for_each(|_| once())?;
        Ok::<_, Error>(begun.elapsed().as_secs_f64() / f64::from(times))
    };
    let times = (SECONDS / seconds(1)?).clamp(1.0, MAX_RUNS) as u32;
    let mut best = f64::INFINITY;
    for _ in 0..RUNS {
        best = best.min(seconds(times)?);
    }
    Ok(POINTS as f64 / best / 1e6)
}

impl Display for PointRates {
    fn fmt(&self, out: &mut Formatter<'_>) -> Written {
        let Self { name, played, coded, swayed, bandwidth } = self;
        let line = |what: &str, rate: f64, bytes: u64| {
            let share = 100.0 * rate * 1e6 * bytes as f64 / bandwidth;
            let gigabytes = bandwidth / 1e9;
            format!(
                "{name}, {what:<32} gpu  {rate:>8.1} M/s  {bytes} B a point; {share:.0} % of what copying at \
                 {gigabytes:.0} GB/s bounds"
            )
        };
        writeln!(out, "{}", line("random iteration", *played, BYTES))?;
        writeln!(out, "{}", line("random iteration with codes", *coded, 2 * BYTES))?;
        let frames = self.frames();
        write!(
            out,
            "{}; {frames:.1} frames per second",
            line("a million points in the wind", *swayed, SWAYING_POINT_BYTES)
        )
    }
}
