//! Runs that are killed at random moments, also while they make videos and folders and give files their names.
//!
//! `WEALD_KILLS=1000 cargo test -p weald-cli --test command kills -- --nocapture` is the long version, whose figures stand
//! in CORRECTNESS.md.

use std::collections::BTreeMap;
use std::path::Path;
use std::process::Stdio;
use std::time::{Duration, Instant};

use crate::place::Place;

/// Kills of the short version.
const FEW: u64 = 20;
/// Seeds of two recipes that take turns in one folder.
const SEEDS: [&str; 2] = ["1", "2"];

pub(crate) const RECIPE: &str = "\
[landscape]
size = 48
cell = 10.0
[[step]]
do = \"diamond-square\"
relief = 100.0
[[step]]
do = \"hydraulic\"
iterations = 120
[[output]]
layer = \"height\"
file = \"maps/height.npy\"
[[output]]
layer = \"height\"
file = \"height.zarr\"
[[output]]
layer = \"water\"
file = \"water.raw\"
[[output]]
picture = \"relief\"
every = 40
width = 64
file = \"rise.mp4\"
[[output]]
picture = \"relief\"
every = 40
width = 32
file = \"short.apng\"
[[output]]
export = \"unity\"
tiles = 2
size = 33
file = \"unity.raw\"
";

/// All files below a folder but those of the work folder, with what is in them.
fn files(folder: &Path, below: &Path, found: &mut BTreeMap<String, Vec<u8>>) {
    let entries = std::fs::read_dir(folder.join(below)).into_iter().flatten().flatten();
    for entry in entries.filter(|entry| entry.file_name() != ".weald") {
        let name = below.join(entry.file_name());
        if entry.path().is_dir() {
            files(folder, &name, found);
        } else {
            found.insert(name.display().to_string(), std::fs::read(entry.path()).expect("it can be read"));
        }
    }
}

fn all_files(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut found = BTreeMap::new();
    files(folder, Path::new(""), &mut found);
    found
}

fn arguments<'a>(seed: &'a str, out: &'a str, goes_on: bool) -> Vec<&'a str> {
    let mut all = vec!["run", "r.toml", "--quiet", "--engine", "cpu", "--seed", seed, "--out", out];
    all.extend(["--threads", "1", "--checkpoint-every", "0"]);
    all.extend(goes_on.then_some("--resume"));
    all
}

/// Whether there is a checkpoint of the run with that seed: its header has the recipe.
fn has_checkpoint(place: &Place, seed: &str) -> bool {
    let bytes = std::fs::read(place.path("parts/checkpoint.weald")).unwrap_or_default();
    String::from_utf8_lossy(&bytes[..bytes.len().min(4000)]).contains(&format!("seed = {seed}"))
}

/// Runs to the end.
fn run(place: &Place, seed: &str, out: &str, goes_on: bool) {
    let output = place.weald(&arguments(seed, out, goes_on));
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
}

/// Runs and kills after so long; gives whether it was killed before its end.
fn kill(place: &Place, seed: &str, goes_on: bool, after: Duration) -> bool {
    let mut command = place.command(&arguments(seed, "parts", goes_on));
    let mut child = command.stdout(Stdio::null()).stderr(Stdio::piped()).spawn().expect("it starts");
    std::thread::sleep(after);
    // One that has ended cannot be killed.
    let _ = child.kill();
    let output = child.wait_with_output().expect("it ends");
    let failed = output.status.code().is_some_and(|code| code != 0);
    assert!(!failed, "{}", String::from_utf8_lossy(&output.stderr));
    output.status.code().is_none()
}

/// The files of a whole run, and the seed that its report names. Reports tell of seconds, which differ.
struct Whole(Vec<BTreeMap<String, Vec<u8>>>);

impl Whole {
    fn of(place: &Place) -> Self {
        Self(
            SEEDS
                .map(|seed| {
                    run(place, seed, seed, false);
                    all_files(&place.path(seed))
                })
                .to_vec(),
        )
    }

    /// Where there is a report, all files are those of its run; without one, each is of some run and whole.
    fn assert_is_set(&self, place: &Place) {
        let mut found = all_files(&place.path("parts"));
        // A checkpoint that was being written is removed by the next run.
        found.retain(|name, _| !name.starts_with("checkpoint.weald"));
        let report = found.remove("report.json");
        let seed = report.map(|report| {
            let report: serde_json::Value = serde_json::from_slice(&report).expect("a report is whole");
            report["seed"].as_u64().expect("a number") as usize - 1
        });
        let sets = seed.map_or(&self.0[..], |seed| &self.0[seed..=seed]);
        for (name, bytes) in &found {
            let is_whole = sets.iter().any(|set| set.get(name) == Some(bytes));
            assert!(is_whole, "{name} is of no whole run, report: {seed:?}");
        }
        if seed.is_some() {
            assert_eq!(found.len() + 1, sets[0].len(), "{:?}", found.keys());
        }
    }
}

#[test]
fn runs_that_are_killed_at_random_moments_go_on_to_the_same_files_and_leave_nothing_behind() {
    let kills = std::env::var("WEALD_KILLS").ok().and_then(|text| text.parse().ok()).unwrap_or(FEW);
    let place = Place::with(RECIPE);
    let whole = Whole::of(&place);
    let started = Instant::now();
    run(&place, SEEDS[0], "parts", false);
    let mut long = started.elapsed().as_secs_f64();
    let (mut cut, mut resumed, mut journals) = (0, 0, 0);
    for number in 0..4 * kills {
        if cut == kills {
            break;
        }
        if number % 100 == 0 {
            println!("{number} runs, {cut} of {kills} killed");
        }
        let seed = SEEDS[(number / 3 % 2) as usize];
        let goes_on = has_checkpoint(&place, seed) && number % 3 != 0;
        let share = weald::random::unit(weald::random::splitmix64(number));
        // The last tenth is where files get their names, which takes little time.
        let share = if number % 4 == 0 { 0.85 + 0.25 * share } else { 1.1 * share };
        let is_cut = kill(&place, seed, goes_on, Duration::from_secs_f64(share * long));
        cut += u64::from(is_cut);
        // How long a run takes changes with what else the machine does: three of four are killed before their end.
        long *= if is_cut { 1.03 } else { 0.9 };
        resumed += u64::from(goes_on);
        journals += u64::from(place.path("parts/.weald/journal.json").exists());
        whole.assert_is_set(&place);
        if number % 10 == 9 {
            run(&place, seed, "parts", has_checkpoint(&place, seed));
            whole.assert_is_set(&place);
            let mut names = place.names("parts");
            names.retain(|name| !name.starts_with("rise-") && !name.starts_with("unity_"));
            let expected = [
                "height.zarr",
                "maps",
                "report.json",
                "rise.mp4",
                "short.apng",
                "unity.raw.json",
                "water.raw",
            ];
            names.retain(|name| name != "water.raw.json");
            assert_eq!(names, expected, "nothing is left behind");
        }
    }
    println!("{cut} of {kills} killed, {resumed} went on, {journals} were giving files their names");
    assert_eq!(cut, kills, "most runs ended before they were killed");
}
