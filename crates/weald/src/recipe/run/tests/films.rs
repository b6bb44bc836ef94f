//! Films of runs: time-lapses and turns.

use super::*;

/// Frame `number` of a film, as the numbers in its one pixel.
fn frame(folder: &Path, film: &str, number: usize) -> Vec<u8> {
    let file = std::fs::File::open(folder.join(format!("{film}-{number:05}.png"))).expect("a frame");
    let mut reader = png::Decoder::new(std::io::BufReader::new(file)).read_info().expect("a PNG");
    let mut pixel = vec![0; 3];
    reader.next_frame(&mut pixel).expect("one pixel");
    pixel
}

const FILMS: &str = "\
[landscape]
size = [9, 7]
seed = 5
[[step]]
do = \"rough\"
relief = 100.0
[[step]]
do = \"wear\"
iterations = 10
[[step]]
do = \"wear\"
iterations = 7
[[output]]
picture = \"dot\"
every = 3
file = \"rise.png\"
[[output]]
picture = \"dot\"
frames = 4
file = \"turn.png\"
";

#[test]
fn a_time_lapse_shows_each_moment_once_and_a_turn_goes_once_around() {
    let folder = folder();
    let report = run(FILMS, folder.path(), false, &Silent).expect("runs");
    // 0, 3, 6 and 9 of the first simulation, 3 and 6 of the second.
    assert_eq!((report.outputs[0].frames, report.outputs[1].frames), (Some(6), Some(4)));
    let heights: Vec<_> = (0..6).map(|number| frame(folder.path(), "rise", number)[1]).collect();
    assert!(heights[0] > 10, "{heights:?}");
    assert!(heights.windows(2).all(|pair| pair[1] < pair[0]), "{heights:?}");
    assert!(!folder.path().join("rise-00006.png").exists());
    let shares: Vec<_> = (0..4).map(|number| frame(folder.path(), "turn", number)[2]).collect();
    assert_eq!(shares, [0, 2, 4, 6]);
}

#[test]
fn an_interrupted_time_lapse_goes_on_with_the_same_frames() {
    let (whole, halves) = (folder(), folder());
    run(FILMS, whole.path(), false, &Silent).expect("runs");
    run(FILMS, halves.path(), false, &StopsAfter::new(13)).expect_err("stopped");
    assert_eq!(files_in(halves.path()), [".weald", CHECKPOINT_FILE], "frames have no names yet");
    let made = new_files(halves.path(), &parse(FILMS).expect("good"));
    let drawn = |frame: &str| made.join(frame).exists();
    assert!(drawn("rise-00003.png") && !drawn("rise-00005.png"));
    run(FILMS, halves.path(), true, &Silent).expect("goes on");
    for number in 0..6 {
        assert_eq!(frame(halves.path(), "rise", number), frame(whole.path(), "rise", number), "{number}");
    }
}

#[test]
fn a_checkpoint_whose_frames_are_gone_is_refused_and_those_of_another_recipe_stay() {
    let out = folder();
    run(FILMS, out.path(), false, &StopsAfter::new(13)).expect_err("stopped");
    // A run of another recipe that ends before its first checkpoint leaves the frames of this one.
    let other = FILMS.replace("seed = 5", "seed = 6");
    drop(WorkFolder::take(out.path(), &parse(&other).expect("good")).expect("free"));
    let made = new_files(out.path(), &parse(FILMS).expect("good"));
    assert!(made.join("rise-00003.png").exists());
    std::fs::remove_file(made.join("rise-00001.png")).expect("there");
    let error = run(FILMS, out.path(), true, &Silent).expect_err("no frame").to_string();
    assert!(error.contains("rise-00001.png is gone; run without --resume"), "{error}");
    run(FILMS, out.path(), false, &Silent).expect("starts anew");
    assert!(!out.path().join(".weald").exists());
}
