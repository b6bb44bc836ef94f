//! Outputs that are made side by side.

use super::folders::Breaks;
use super::*;

/// The recipe with a dozen outputs more.
fn with_many_outputs() -> String {
    let more = (0..12).map(|number| format!("[[output]]\nlayer = \"height\"\nfile = \"h{number}.bits\"\n"));
    format!("{RECIPE}{}", more.collect::<String>())
}

fn run_on(threads: usize, text: &str, out: &Path, progress: &dyn Progress) -> Result<Report, Error> {
    let recipe = parse(text).expect("the recipe is good");
    let options = Options { threads: Some(threads), ..Options::into_folder(out) };
    Run { recipe: &recipe, options }.execute(progress)
}

#[test]
fn outputs_made_side_by_side_are_those_made_one_after_the_other_and_in_their_order() {
    let text = with_many_outputs();
    let made = |threads| {
        let out = folder();
        let report = run_on(threads, &text, out.path(), &Silent).expect("runs");
        let files: Vec<_> = report.outputs.iter().map(|output| output.file.clone()).collect();
        let all: Vec<_> = files.iter().map(|file| bytes(out.path(), file)).collect();
        (files, all)
    };
    let one = made(1);
    assert!(one.0.len() == 14 && one.0[13] == "h11.bits", "{:?}", one.0);
    assert!((2..5).all(|threads| made(threads) == one));
    let recipe = parse(&text).expect("good");
    let groups = recipe.output_groups(&recipe.landscape().expect("runs"));
    assert!(groups.len() > 1 && groups.iter().all(|group| (1..=8).contains(&group.len())), "{groups:?}");
    assert_eq!(groups.into_iter().flatten().collect::<Vec<_>>(), (0..14).collect::<Vec<_>>());
}

#[test]
fn of_outputs_that_fail_side_by_side_the_first_is_told() {
    let text = with_many_outputs();
    for threads in 1..5 {
        let out = folder();
        let breaks = Breaks { out: out.path(), recipe: &text, entries: &["h7.bits", "h4.bits"] };
        let error = run_on(threads, &text, out.path(), &breaks).expect_err("cannot be written").to_string();
        assert!(error.contains("h4.bits") && error.contains("no file has changed"), "{error}");
        assert!(files_in(out.path()).iter().all(|file| !file.contains("bits")), "on {threads} threads");
    }
}
