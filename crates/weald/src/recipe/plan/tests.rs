use proptest::prelude::*;

use super::*;
use crate::recipe::testing::{VOCABULARY, parse, refusal};
use weald_core::error::Quantity;

const GOOD: &str = "\
[landscape]
size = [8, 4]
cell = 2.5
seed = 3
[[step]]
do = \"rough\"
[[step]]
do = \"wear\"
iterations = 5
[[output]]
layer = \"height\"
file = \"a/./height.bits\"
[[output]]
picture = \"dot\"
file = \"dot.png\"
";

/// The good recipe with one text in place of another.
fn with(old: &str, new: &str) -> String {
    assert!(GOOD.contains(old), "the good recipe has {old:?}");
    GOOD.replacen(old, new, 1)
}

#[test]
fn a_good_recipe_becomes_a_plan() {
    let recipe = parse(GOOD).expect("good");
    let size = Size::new(8, 4).expect("small");
    assert_eq!(recipe.ground, Ground::Empty { size, cell: 2.5, finest: None });
    assert_eq!(recipe.steps.iter().map(|step| step.entry.name).collect::<Vec<_>>(), ["rough", "wear"]);
    assert_eq!(recipe.outputs[0].file, Path::new("a/height.bits"));
}

#[test]
fn the_hash_is_that_of_the_meaning_and_not_of_the_spelling() {
    let hash = |text: &str| parse(text).expect("good").hash();
    assert_eq!(hash(GOOD), hash(&with("cell = 2.5\nseed = 3", "# a comment\nseed = 3\ncell = 2.5")));
    assert_ne!(hash(GOOD), hash(&with("seed = 3", "seed = 4")));
}

#[test]
fn the_effective_recipe_gives_the_same_plan() {
    let recipe = parse(GOOD).expect("good");
    assert_eq!(parse(recipe.effective()).expect("good").hash(), recipe.hash());
}

#[test]
fn a_grid_over_the_limit_says_how_many_cells_are_asked_for_and_allowed() {
    let limit = |text: &str| match parse(text) {
        Err(Error::Limit(limit)) => limit,
        other => panic!("{other:?}"),
    };
    let whole = limit(&with("[8, 4]", "[20000, 16000]"));
    assert_eq!((whole.what, whole.asked, whole.allowed), (Quantity::Cells, Some(320_000_000), 0..=1 << 28));
    let side = limit(&with("[8, 4]", "[2000000, 4]"));
    assert_eq!((side.what, side.asked, side.allowed), (Quantity::CellsPerSide, Some(2_000_000), 1..=1 << 20));
}

#[test]
fn a_value_out_of_range_names_file_line_key_value_and_range() {
    let message = refusal(&with("iterations = 5", "iterations = 0"));
    assert_eq!(message, "folder/r.toml:9: wear: `iterations` is 0, outside its range: 1 to 1000");
}

#[test]
fn a_misspelt_word_is_answered_with_the_nearest_one() {
    let near = |old, new, meant: &str| {
        let message = refusal(&with(old, new));
        assert!(message.contains(&format!("did you mean `{meant}`?")), "{message}");
    };
    near("iterations", "iteratoins", "iterations");
    near("do = \"wear\"", "do = \"waer\"", "wear");
    near("layer = \"height\"", "layer = \"heigth\"", "height");
    near("picture = \"dot\"", "picture = \"dots\"", "dot");
    near("[landscape]", "[landscap]", "landscape");
    near("seed", "sead", "seed");
}

#[test]
fn all_faults_come_in_one_go_in_the_order_of_their_lines() {
    let text = GOOD.replace("cell = 2.5", "cell = -1").replace("iterations = 5", "iterations = 5.5");
    let text = text.replace("dot.png", "../dot.png").replace("seed = 3", "sed = 3");
    let Err(Error::Recipe(error)) = parse(&text) else { panic!("four faults") };
    assert_eq!(error.diagnostics.iter().map(|c| c.line).collect::<Vec<_>>(), [3, 4, 9, 15], "{error}");
}

#[test]
fn a_layer_must_be_written_before_it_is_read() {
    let message = refusal(&with("do = \"rough\"", "do = \"rough\"\ninto = \"hight\""));
    assert!(message.contains("r.toml:8: wear: reads layer `height`"), "{message}");
    assert!(message.contains("did you mean `hight`?"), "{message}");
}

#[test]
fn an_unknown_step_is_no_cause_for_complaints_of_its_layers() {
    let Err(Error::Recipe(error)) = parse(&with("do = \"rough\"", "do = \"ruogh\"")) else { panic!("bad") };
    assert_eq!(error.diagnostics.len(), 1, "{error}");
}

#[test]
fn a_step_whose_work_is_lost_is_refused() {
    let message = refusal(&with("[[step]]\n", "[[step]]\ndo = \"rough\"\n[[step]]\n"));
    assert!(message.contains("step 1 (`rough`, line 5)"), "{message}");
    let twice = with("[[output]]", "[[step]]\ndo = \"wear\"\n[[output]]");
    parse(&twice).expect("the first wear's height is read, so its debris may go");
}

#[test]
fn outputs_stay_inside_their_folder() {
    for name in ["/etc/x.bits", "../x.bits", "a/../../x.bits", "", ".", "a/", "report.json", "./report.json"]
    {
        let message = refusal(&with("a/./height.bits", name));
        assert!(message.contains(":12: output: `file` is"), "{name}: {message}");
    }
}

#[test]
fn the_same_file_twice_is_refused() {
    let again = "[[output]]\nlayer = \"height\"\nfile = \"a/height.bits\"\n";
    let message = refusal(&format!("{GOOD}{again}"));
    assert!(message.contains(":18: output: `file` is a/height.bits a second time; line 10"), "{message}");
    let message = refusal(&format!("{GOOD}{}", again.replace("height.bits", "Height.bits")));
    assert!(message.contains("a second time"), "some file systems do not tell H from h: {message}");
}

#[test]
fn a_recipe_without_output_or_ground_is_refused() {
    let message = refusal("[landscape]\nsize = 4\n[[step]]\ndo = \"rough\"\n");
    assert!(message.contains("needs an [[output]] table"), "{message}");
    let message = refusal("[landscape]\nsize = 4\n[[output]]\nlayer = \"height\"\nfile = \"a.bits\"\n");
    assert!(message.contains("needs a [[step]] table"), "{message}");
    let message = refusal("");
    assert!(message.contains("`size` is needed"), "{message}");
}

#[test]
fn size_and_from_exclude_each_other() {
    let message = refusal(&with("seed = 3", "from = \"x.bits\""));
    assert!(message.contains(":2: landscape: `size` does not go with `from`"), "{message}");
    assert!(message.contains("bits is written, not read"), "{message}");
}

#[test]
fn a_grid_over_the_limit_is_an_error_of_its_own() {
    for size in ["[20000, 20000]", "9223372036854775807"] {
        let error = parse(&with("[8, 4]", size)).expect_err("too large");
        assert_eq!(error.exit_code(), 5, "{error}");
    }
    for size in ["0", "-4", "[4]", "[4, 0]", "\"4\"", "4.0"] {
        let error = parse(&with("[8, 4]", size)).expect_err("no size");
        assert_eq!(error.exit_code(), 3, "{error}");
        assert!(error.to_string().contains(":2: landscape: `size` is "), "{error}");
    }
}

#[test]
fn numbers_that_are_none_are_refused() {
    for number in ["nan", "inf", "-inf"] {
        let message = refusal(&with("cell = 2.5", &format!("cell = {number}")));
        assert!(message.contains(":3: landscape: `cell` is"), "{message}");
    }
}

#[test]
fn single_brackets_are_answered_with_double_ones() {
    let message = refusal("[landscape]\nsize = 4\n[step]\ndo = \"rough\"\n[output]\n");
    assert!(message.contains(":3: step: [step] has double brackets: [[step]]"), "{message}");
    assert!(message.contains(":5: output: [output] has double brackets: [[output]]"), "{message}");
}

#[test]
fn the_first_step_of_a_kind_has_the_seed_of_the_landscape_and_later_ones_their_own() {
    let more = |into: &str| format!("[[step]]\ndo = \"rough\"\ninto = \"{into}\"\n");
    let text = with("[[output]]", &format!("{}{}[[output]]", more("second"), more("third")));
    let recipe = parse(&text).expect("good");
    let seeds: Vec<_> = recipe.steps.iter().map(|step| step.seed(3)).collect();
    // SplitMix64 of 3 ^ 1 and of 3 ^ 2.
    assert_eq!(seeds, [3, 3, 0x9758_35de_1c97_56ce, 0x910a_2dec_8902_5cc1]);
}

#[test]
fn a_step_that_is_off_is_left_out_and_the_others_keep_their_seeds() {
    let more = |into: &str, off: &str| format!("[[step]]\ndo = \"rough\"\ninto = \"{into}\"\n{off}");
    let text =
        with("[[output]]", &format!("{}{}[[output]]", more("second", "off = true\n"), more("third", "")));
    let recipe = parse(&text).expect("good");
    assert_eq!(recipe.steps.iter().map(|step| step.place).collect::<Vec<_>>(), [0, 1, 3]);
    assert_eq!(recipe.steps[2].seed(3), 0x910a_2dec_8902_5cc1, "as where the second runs");
    assert!(recipe.effective().contains("off = true"), "it stays in what is saved: {}", recipe.effective());
    let on = parse(&text.replace("off = true", "off = false")).expect("good");
    assert_eq!(on.steps.len(), 4);
    let wrong = parse(&text.replace("off = true", "off = 1")).expect_err("no flag").to_string();
    assert!(wrong.contains("`off` is 1"), "{wrong}");
    let reads = with(
        "[[output]]",
        &format!(
            "{}[[output]]\nlayer = \"second\"\nfile = \"s.bits\"\n[[output]]",
            more("second", "off = true\n")
        ),
    );
    let missing = parse(&reads).expect_err("nobody writes it").to_string();
    assert!(missing.contains("second"), "{missing}");
}

#[test]
fn overrides_are_checked_like_the_recipe() {
    let changed = |set: &str, value: &str| {
        let set = vec![(set.to_owned(), value.to_owned())];
        Recipe::parse_with(&VOCABULARY, "r.toml", GOOD, &Overrides { set, ..Overrides::default() })
    };
    changed("wear.iterations", "7").expect("in range");
    let message = changed("wear.iterations", "0").expect_err("out of range").to_string();
    assert_eq!(
        message,
        "r.toml, as changed on the command line: wear: `iterations` is 0, outside its range: 1 to 1000"
    );
    let message = changed("step.2.iteration", "7").expect_err("unknown").to_string();
    assert!(message.contains("did you mean `iterations`?"), "{message}");
}

proptest! {
    #[test]
    fn no_text_makes_the_parser_panic(text in any::<String>()) {
        let _ = Recipe::parse("r.toml", &text, &Overrides::default());
        let _ = parse(&text);
    }

    #[test]
    fn no_mutation_of_a_recipe_makes_the_parser_panic(
        cuts in prop::collection::vec((0..GOOD.len(), 0..GOOD.len(), 0..GOOD.len()), 1..6),
    ) {
        let mut text = GOOD.as_bytes().to_vec();
        for (from, length, to) in cuts {
            let (from, to) = (from % text.len().max(1), to % text.len().max(1));
            let piece: Vec<u8> = text.iter().skip(from).take(length % 20).copied().collect();
            text.splice(to..to, piece);
            text.drain(from..(from + length % 10).min(text.len()));
        }
        let _ = parse(&String::from_utf8_lossy(&text));
    }
}

#[test]
fn outputs_that_cannot_be_written_say_what_there_is() {
    let output = |keys: &str| {
        let steps = "[landscape]\nsize = 9\n[[step]]\ndo = \"rough\"\n[[output]]\n";
        refusal(&format!("{steps}{keys}\n"))
    };
    let says = |keys: &str, words: &str| {
        let message = output(keys);
        assert!(message.contains(words), "{keys}: {message}");
    };
    says("export = \"taly\"\nfile = \"a.txt\"", "there is no export \"taly\"; did you mean `tally`?");
    says("export = \"tally\"\nfile = \"a.png\"", "`file` is a.png; export = \"tally\" is written as .txt");
    says("export = \"tally\"\nof = \"heigth\"\nfile = \"a.txt\"", "needs layer `heigth`");
    says(
        "layer = \"height\"\nexport = \"tally\"\nfile = \"a.txt\"",
        "`layer` and `export` exclude each other",
    );
    says(
        "layer = \"height\"\nfile = \"a.bits\"\npreset = \"thrice\"",
        "bits has no preset \"thrice\"; it has: twice",
    );
    says("file = \"a.bits\"", "`layer`, `picture` or `export` is needed");
}

#[test]
fn films_that_cannot_be_made_say_why() {
    let says = |steps: &str, keys: &str, words: &str| {
        let text = format!("[landscape]\nsize = 9\n{steps}[[output]]\npicture = \"dot\"\n{keys}\n");
        let message = refusal(&text);
        assert!(message.contains(words), "{keys}: {message}");
    };
    let rough = "[[step]]\ndo = \"rough\"\n";
    let wear = "[[step]]\ndo = \"rough\"\n[[step]]\ndo = \"wear\"\n";
    says(
        rough,
        "file = \"a.mp4\"",
        "a film: add `frames` (a turn of the camera, or the wind) or `every` (a frame every so many iterations)",
    );
    says(
        wear,
        "every = 3\nfile = \"a.gif\"",
        "`file` is a.gif; a film is written as .png or .apng or .mp4 or .webm",
    );
    says(rough, "every = 3\nfile = \"a.png\"", "no step simulates");
    says(wear, "every = 3\nframes = 4\nfile = \"a.png\"", "exclude each other");
    says(wear, "frames = 1\nfile = \"a.png\"", "`frames` is 1, outside its range: 2 to 9999");
    says(
        wear,
        "frames_per_second = 30\nfile = \"a.png\"",
        "`frames_per_second` has no effect without `every` or `frames`",
    );
    says(wear, "every = 3\nof = \"debris2\"\nfile = \"a.png\"", "shows layer `debris2` during step 2");
}

#[test]
#[cfg(not(any(feature = "exr", feature = "report")))]
fn a_build_names_the_features_that_it_lacks_at_the_lines_that_ask_for_them() {
    let whole = with("a/./height.bits", "height.tif").replace("\"rough\"", "\"fbm\"");
    let whole = whole.replace("\"wear\"", "\"thermal\"").replace("\"dot\"", "\"relief\"");
    let parse = |text: &str| Recipe::parse("a.toml", text, &Overrides::default());
    let lacking = |what: &str, feature: &str| {
        format!("{what} is not part of this build: build with the feature `{feature}`")
    };
    let others = "\
[[output]]
export = \"report\"
file = \"page.html\"
[[output]]
export = \"terrain3d\"
file = \"ground.exr\"
";
    let error =
        parse(&(whole.replace("height.tif", "height.exr") + others)).expect_err("left out").to_string();
    let expected = [
        format!("a.toml:12: output: `file`: `height.exr`: {}", lacking("OpenEXR", "exr")),
        format!("a.toml:18: output: `file`: {}", lacking("the HTML report", "report")),
        format!("a.toml:21: output: `file`: {}; .r16 is written without it", lacking("OpenEXR", "exr")),
    ];
    assert_eq!(error.lines().collect::<Vec<_>>(), expected);

    let page = parse(&whole).expect("good").for_page(Path::new("page.html"));
    let error = page.expect_err("left out").to_string();
    assert_eq!(error, format!("a.toml:1: {}", lacking("the HTML report", "report")));
}

#[test]
fn what_is_missing_is_answered_with_the_step_that_makes_it() {
    let ground = "[landscape]\nsize = 9\n[[step]]\ndo = \"constant\"\n";
    let refused = |more: &str, parts: &[&str]| {
        let text = format!("{ground}{more}");
        let message = Recipe::parse("r.toml", &text, &Overrides::default()).expect_err("bad").to_string();
        assert!(parts.iter().all(|part| message.contains(part)), "{message}");
        message
    };
    let grass = "[[step]]\ndo = \"grass\"\n[[output]]\nlayer = \"grass\"\nfile = \"a.tif\"\n";
    refused(grass, &["`light`", "add a step `sunlight`", "add a step `soil`", "add a step `moisture`"]);
    let plants = "[[output]]\nexport = \"plants\"\nfile = \"a.csv\"\n";
    refused(plants, &["needs plants `plants`, which no step sets; the step `scatter` does"]);
    let message = refused("[[output]]\npicture = \"map\"\nfile = \"a.png\"\n", &["`of` is needed"]);
    assert!(!message.contains("needs layer"), "{message}");
}

/// The good recipe with these outputs in place of its own.
fn with_outputs(outputs: &str) -> String {
    let (before, _) = GOOD.split_once("[[output]]").expect("it has outputs");
    format!("{before}{outputs}")
}

#[test]
fn two_outputs_that_would_write_one_name_are_told_apart_before_anything_runs() {
    let film = |keys: &str, file: &str| format!("[[output]]\npicture = \"dot\"\n{keys}\nfile = {file:?}\n");
    let dot = |file: &str| film("", file);
    let tally = |file: &str| format!("[[output]]\nexport = \"tally\"\nfile = {file:?}\n");
    let clashes = [
        (
            film("frames = 3", "a.mp4") + &film("every = 2", "A.png"),
            "A.png would write A-00000.png, where a.mp4",
        ),
        (
            film("frames = 3", "a.png") + &dot("a-00002.png"),
            "a-00002.png would write a-00002.png, where a.png",
        ),
        (
            film("every = 2", "a.apng") + &dot("a-00001.png"),
            "would write a-00001.png, where a.apng of line 10",
        ),
        (tally("a.txt") + &tally("a_steps.txt"), "would write a_steps.txt, where a.txt of line 10"),
        (dot("a.png") + &dot("a.png/b.png"), "a.png/b.png would write a.png/b.png, where a.png"),
        (film("frames = 3", "a.png") + &dot("a-00001.png/b.png"), "would write a-00001.png, where a.png"),
    ];
    for (outputs, told) in clashes {
        let message = refusal(&with_outputs(&outputs));
        assert!(message.contains(told), "{message}");
    }
    let apart = film("frames = 3", "a.png") + &dot("a-00003.png") + &dot("a-1.png") + &tally("b/a.txt");
    assert!(parse(&with_outputs(&apart)).is_ok());
}

#[test]
fn names_that_no_file_can_have_or_that_a_run_uses_are_refused() {
    let long = "n".repeat(210);
    for (file, told) in [
        (format!("{long}.png"), "is too long: a name has at most 200 bytes"),
        ("d/".repeat(600) + "a.png", "a path 1000"),
        (".weald/a.png".to_owned(), "a name that every run uses itself"),
        ("report.json/a.png".to_owned(), "a name that every run uses itself"),
    ] {
        let output = format!("[[output]]\npicture = \"dot\"\nfile = \"{file}\"\n");
        let message = refusal(&with_outputs(&output));
        assert!(message.contains(told), "{message}");
    }
}
