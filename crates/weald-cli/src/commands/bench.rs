//! `weald bench`.

use std::fmt::Display;
use std::sync::Arc;

use weald::engine::device::Device;
use weald_gallery::bench::{Measured, Record, Records};
use weald_gpu::{Gpu, PointRates};

use crate::arguments::{BenchArguments, kept_results};
use crate::engine::with_memory;
use crate::failure::Failure;
use crate::{interrupt, stdout};

/// Cells a side where none are given: on the CPU, a graphics card, and software that acts as one.
const SIDES: &[usize] = &[512, 1024, 2048];
const SIDES_OF_A_CARD: &[usize] = &[512, 1024, 2048, 4096];
const SIDES_OF_SOFTWARE: &[usize] = &[256];

pub(crate) fn bench(arguments: &BenchArguments) -> Result<(), Failure> {
    if arguments.fractals && arguments.engine == "gpu" {
        return Err(Failure::usage("--fractals measures the CPU; leave out --engine gpu"));
    }
    if arguments.grass && arguments.engine == "gpu" {
        return Err(Failure::usage("--grass measures the CPU; leave out --engine gpu"));
    }
    let mut unwritten = None;
    let mut print = |line: &dyn Display| {
        if let Err(failure) = stdout::print(&format!("{line}\n")) {
            unwritten = Some(failure);
        }
    };
    #[cfg(feature = "studio")]
    if arguments.studio {
        print(&weald_studio::response(None)?);
        return unwritten.map_or(Ok(()), Err);
    }
    if arguments.calibrate {
        return calibrate(&mut print).and_then(|()| unwritten.map_or(Ok(()), Err));
    }
    let then = arguments.against.as_deref().map(Records::read).transpose()?;
    let mut results = Records { version: env!("CARGO_PKG_VERSION").to_owned(), results: Vec::new() };
    if !arguments.recipe.is_empty() && !arguments.render {
        recipes(arguments, &mut print, &mut results)?;
    } else if arguments.render {
        super::bench_render::run(arguments, &mut print)?;
    } else if arguments.engine == "gpu" {
        on_the_gpu(arguments, &mut print)?;
    } else {
        if !arguments.fractals && !arguments.grass {
            let sides = given_or(&arguments.size, SIDES);
            weald_gallery::bench::run(sides, &arguments.threads, &mut |rate| {
                print(rate);
                results.results.extend(Record::of_rate(rate));
            })?;
        }
        if !arguments.grass {
            weald_gallery::bench::fractals(&arguments.threads, &mut print)?;
        }
        if !arguments.fractals {
            weald_gallery::bench::grass(&arguments.threads, &mut print)?;
        }
    }
    if let Some(path) = &arguments.save {
        results.write(path)?;
    }
    let slower = then.map_or_else(Vec::new, |then| {
        print(&format!("{} results beside those of {}", results.in_common(&then), then.version));
        results.slower_than(&then)
    });
    if !slower.is_empty() {
        return Err(Failure::run(slower.join("\n")));
    }
    unwritten.map_or(Ok(()), Err)
}

/// Runs the templates and keeps what they take where runs keep their results, for estimates.
fn calibrate(print: &mut dyn FnMut(&dyn Display)) -> Result<(), Failure> {
    let Some(folder) = kept_results(None) else {
        return Err(Failure::usage(
            "--calibrate keeps its times where results are kept, and WEALD_CACHE is off",
        ));
    };
    interrupt::end_at_once()?;
    let out = std::env::temp_dir().join(format!("weald-calibrate-{}", std::process::id()));
    let done = weald_gallery::bench::calibrate(&folder, &out, &mut |name, seconds| {
        print(&format!("{name:<24} {seconds:>6.1} s"));
    });
    // The folder is of temporary files; that it cannot be removed is no fault of what was measured.
    let _ = std::fs::remove_dir_all(&out);
    done?;
    print(&format!("kept in {}: `weald check` estimates times by them", folder.display()));
    Ok(())
}

/// Measures each step and each output of recipes, whose files go into a folder that is removed.
fn recipes(
    arguments: &BenchArguments,
    print: &mut (dyn FnMut(&dyn Display) + Send),
    results: &mut Records,
) -> Result<(), Failure> {
    interrupt::end_at_once()?;
    let out = std::env::temp_dir().join(format!("weald-bench-{}", std::process::id()));
    for recipe in &arguments.recipe {
        let measured = Measured {
            recipe,
            size: arguments.size.first().map(|&side| side as u64),
            runs: arguments.runs as usize,
            out: out.clone(),
        };
        let done = weald_gallery::bench::recipe(&measured, &arguments.threads, &mut |record| {
            print(&record);
            results.results.push(record);
        });
        // The folder is of temporary files; that it cannot be removed is no fault of what was measured.
        let _ = std::fs::remove_dir_all(&out);
        done?;
    }
    Ok(())
}

fn on_the_gpu(arguments: &BenchArguments, print: &mut dyn FnMut(&dyn Display)) -> Result<(), Failure> {
    let gpu = with_memory(Gpu::any()?, arguments.gpu_memory)?;
    print(&gpu.adapter());
    let usual = if gpu.is_software() { SIDES_OF_SOFTWARE } else { SIDES_OF_A_CARD };
    if gpu.is_software() && arguments.size.is_empty() {
        print(
            &"software that acts as a graphics card: only a small grid is measured, and its rates say little",
        );
    }
    print(&fern_rates(&gpu)?);
    let bandwidth = gpu.copy_bandwidth()?;
    let device: Arc<dyn Device> = Arc::new(gpu);
    weald_gallery::bench::run_on(&device, bandwidth, given_or(&arguments.size, usual), print)?;
    Ok(())
}

/// A fern on the device: its points made, and in the wind.
fn fern_rates(gpu: &Gpu) -> Result<PointRates, Failure> {
    let fern = weald::grow::ifs::shapes::find("fern").expect("built in").ifs();
    Ok(PointRates::of(gpu, &fern)?)
}

fn given_or<'a>(given: &'a [usize], usual: &'a [usize]) -> &'a [usize] {
    if given.is_empty() { usual } else { given }
}
