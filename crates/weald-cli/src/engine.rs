//! Where simulations run, as a user says it.

use std::sync::Arc;

use weald::engine::Engine;
use weald::grid::Size;
use weald::picture::{RayMarched, RenderDevice};
use weald_gpu::Gpu;

use crate::arguments::Running;
use crate::failure::Failure;

/// An engine that a user can ask for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Choice {
    /// A graphics card where there is one, else all cores.
    Auto,
    /// All cores.
    Cpu,
    /// The graphics card, or software that acts as one.
    Gpu,
    /// Bands that exchange halos; for tests.
    Bands(usize),
    /// Tiles of so many cells a side; for tests.
    Tiles(usize),
}

/// An engine, and what the user should know of it.
pub(crate) struct Chosen {
    pub(crate) engine: Engine,
    pub(crate) note: Option<String>,
}

impl Choice {
    /// Opens it, with a budget of GPU memory in bytes.
    pub(crate) fn open(self, memory: Option<u64>) -> Result<Chosen, Failure> {
        if memory.is_some() && !matches!(self, Self::Auto | Self::Gpu) {
            return Err(Failure::usage("--gpu-memory goes with --engine gpu or auto"));
        }
        let engine = match self {
            Self::Auto => return automatic(memory),
            Self::Cpu => Engine::Cpu,
            Self::Gpu => Engine::Device(Arc::new(with_memory(Gpu::any()?, memory)?)),
            Self::Bands(count) => Engine::Bands(count),
            Self::Tiles(side) => Engine::Tiles(Size::square(side)?),
        };
        Ok(Chosen { engine, note: None })
    }
}

/// A card that is there and cannot be used is no reason not to run.
fn automatic(memory: Option<u64>) -> Result<Chosen, Failure> {
    let (found, note) = match Gpu::hardware() {
        Ok(found) => (found, None),
        Err(error) => (None, Some(format!("{error}; running on the CPU"))),
    };
    let engine = match found {
        Some(gpu) => Engine::DeviceElseCpu(Arc::new(with_memory(gpu, memory)?)),
        None => Engine::Cpu,
    };
    Ok(Chosen { engine, note })
}

/// The device that draws; the processor where it is to and there is no device.
pub(crate) fn drawing(running: &Running) -> Result<Arc<dyn RenderDevice>, Failure> {
    match Gpu::for_drawing() {
        Ok(gpu) => Ok(Arc::new(with_memory(gpu, running.gpu_memory)?)),
        Err(_) if running.fallback.is_some() => Ok(Arc::new(RayMarched)),
        Err(error) => Err(error.into()),
    }
}

/// The device with the budget that the user gave, if any.
pub(crate) fn with_memory(gpu: Gpu, memory: Option<u64>) -> Result<Gpu, weald::Error> {
    match memory {
        Some(bytes) => gpu.with_memory(bytes),
        None => Ok(gpu),
    }
}

/// Reads the name of an engine.
pub(crate) fn choice(text: &str) -> Result<Choice, String> {
    let count = |prefix: &str| text.strip_prefix(prefix).and_then(|count| count.parse().ok());
    match (text, count("bands:"), count("tiles:")) {
        ("auto", ..) => Ok(Choice::Auto),
        ("cpu", ..) => Ok(Choice::Cpu),
        ("gpu", ..) => Ok(Choice::Gpu),
        (_, Some(count @ 1..=1024), _) => Ok(Choice::Bands(count)),
        (_, _, Some(side @ 1..=65_536)) => Ok(Choice::Tiles(side)),
        _ => Err("the engines are auto, cpu and gpu".to_owned()),
    }
}

/// Least and most memory that can be given to the GPU engine.
const MEMORY: std::ops::RangeInclusive<u64> = 1 << 20..=1 << 50;

/// Reads an amount of memory: bytes, or a whole number of KiB, MiB or GiB.
pub(crate) fn memory(text: &str) -> Result<u64, String> {
    let digits = text.find(|letter: char| !letter.is_ascii_digit()).unwrap_or(text.len());
    let unit: u64 = match text[digits..].trim() {
        "" | "B" => 1,
        "KiB" => 1 << 10,
        "MiB" => 1 << 20,
        "GiB" => 1 << 30,
        other => return Err(format!("`{other}` is no unit; give bytes, KiB, MiB or GiB, as in 512MiB")),
    };
    let number = text[..digits].parse::<u64>().map_err(|_| "it is written as in 512MiB".to_owned())?;
    let bytes = number.checked_mul(unit).filter(|bytes| MEMORY.contains(bytes));
    bytes.ok_or_else(|| "it is at least 1MiB and at most 1048576GiB".to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn memory_is_read_in_all_its_units() {
        assert_eq!(memory("64MiB"), Ok(64 << 20));
        assert_eq!(memory("2 GiB"), Ok(2 << 30));
        assert_eq!(memory("2048KiB"), Ok(2 << 20));
        assert_eq!(memory("1048576"), Ok(1 << 20));
        assert_eq!(memory("1048577B"), Ok((1 << 20) + 1));
    }

    #[test]
    fn memory_that_makes_no_sense_is_refused_with_what_would() {
        for (text, part) in [
            ("64MB", "`MB` is no unit"),
            ("", "as in 512MiB"),
            ("MiB", "as in 512MiB"),
            ("-5MiB", "no unit"),
            ("1.5GiB", "no unit"),
            ("1000", "at least 1MiB"),
            ("99999999999GiB", "at most"),
            ("99999999999999999999999", "as in 512MiB"),
        ] {
            let error = memory(text).expect_err("it makes no sense");
            assert!(error.contains(part), "{text}: {error}");
        }
    }

    #[test]
    fn engines_for_tests_have_sound_numbers() {
        assert_eq!(choice("tiles:64"), Ok(Choice::Tiles(64)));
        assert_eq!(choice("bands:3"), Ok(Choice::Bands(3)));
        for text in ["tiles:0", "tiles:", "tiles:-1", "tiles:70000", "bands:0", "bands:2000", "GPU"] {
            assert!(choice(text).is_err(), "{text}");
        }
    }
}
