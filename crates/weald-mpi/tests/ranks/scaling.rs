//! `weald-mpi bench`: what it measures, and the model beside it.

use std::process::Output;

use crate::launched::{mpirun, said};

/// The bench over so many ranks.
fn bench(count: usize, arguments: &[&str]) -> Output {
    mpirun(count).args(arguments).output().expect("mpirun is installed")
}

/// The number before a word in the line that begins so.
fn number(text: &str, line: &str, word: &str) -> f64 {
    let line =
        text.lines().find(|found| found.starts_with(line)).unwrap_or_else(|| panic!("no {line} in {text}"));
    let words: Vec<_> = line.split([' ', ';', ',']).filter(|word| !word.is_empty()).collect();
    let at = words.iter().position(|found| *found == word).unwrap_or_else(|| panic!("no {word} in {line}"));
    words[at - 1].parse().unwrap_or_else(|_| panic!("no number before {word} in {line}"))
}

#[test]
fn a_bench_counts_the_bytes_of_the_formula_and_prints_the_model_of_a_larger_grid() {
    for (model, planes) in [("han", 5.0), ("mei", 7.0)] {
        let arguments = ["bench", "--model", model, "--size", "256", "--steps", "128", "--threads", "1"];
        let output = bench(2, &[&arguments[..], &["--larger", "4096"]].concat());
        assert!(output.status.success(), "{}", said(&output));
        let text = String::from_utf8(output.stdout).expect("text");
        println!("{text}");
        let block = number(&text, "messages", "steps");
        // 4 bytes × columns × planes × (reach × steps + 1), by the steps of a block.
        let formula = 4.0 * 256.0 * planes * (4.0 * block + 1.0) / block / 1e3;
        let counted = number(&text, "messages", "kB");
        assert!((counted / formula - 1.0).abs() < 0.02, "{model}: {counted} kB, by the formula {formula}");
        assert!(
            number(&text, "one rank alone", "s") > 0.0 && number(&text, "all ranks, measured", "s") > 0.0
        );
        let rows: Vec<_> = text.lines().skip_while(|line| !line.contains("speed-up")).skip(1).collect();
        let speed_ups: Vec<f64> = rows
            .iter()
            .map(|row| row.split_whitespace().last().expect("a row").parse().expect("a number"))
            .collect();
        assert!(speed_ups.len() == 8 && (speed_ups[0] - 1.0).abs() < 1e-9, "{speed_ups:?}");
        assert!(speed_ups.windows(2).take(4).all(|pair| pair[1] > pair[0]), "{speed_ups:?}");
    }
}

#[test]
fn a_bench_says_in_how_many_exchanges_the_inside_came_first() {
    let arguments = ["bench", "--size", "256", "--steps", "128", "--threads", "1", "--inside-first"];
    for (when, always) in [("always", true), ("never", false)] {
        let output = bench(2, &[&arguments[..], &[when]].concat());
        assert!(output.status.success(), "{}", said(&output));
        let text = String::from_utf8(output.stdout).expect("text");
        let [first, all] = ["of", "exchanges"].map(|word| number(&text, "inside first", word));
        let expected = if always { all } else { 0.0 };
        assert!(all > 100.0 && (first - expected).abs() < 0.5, "{when}: {text}");
    }
}

#[test]
fn a_rank_alone_has_no_messages_and_a_model_all_the_same() {
    let arguments = ["bench", "--size", "128", "--steps", "64", "--latency", "2", "--bandwidth", "12"];
    let output = bench(1, &arguments);
    assert!(output.status.success(), "{}", said(&output));
    let text = String::from_utf8(output.stdout).expect("text");
    assert!(
        !text.contains("all ranks, measured") && text.contains("messages of 2.0 µs and 12.00 GB/s"),
        "{text}"
    );
}
