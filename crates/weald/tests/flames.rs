//! flam3 draws the flames that Weald writes as the same shapes, and Weald reads flam3's own.
//!
//! The client comes from the Debian package `flam3-utils`, version 3.1.1. A test fails where it is missing.
//!
//! **Support** is the set of pixels that are hit at all: here cells of a histogram with one point or more, there pixels of
//! a 16-bit picture of which a channel is not 0, drawn without flam3's filter and without spreading where points are few.
//! Both sides throw the same number of points, so many that most pixels of the shape are hit often. **Overlap** is how
//! much of all pixels that either hits is hit by both.

use std::path::Path;
use std::process::Command;

use weald::grow::ifs::flame::{self, Frame};
use weald::grow::ifs::shapes::SHAPES;
use weald::grow::ifs::{Game, Histogram, Ifs, Window};

/// Side of a picture, and points for each of its pixels.
const SIDE: u32 = 192;
const QUALITY: f64 = 600.0;

fn frame() -> Frame {
    Frame { size: [SIDE; 2], quality: QUALITY, spread: 0.0, filter: 0.0 }
}

/// Runs a program of flam3 in a folder, with settings in its environment, and gives what it printed.
fn flam3(program: &str, folder: &Path, settings: &[(&str, &str)]) -> Vec<u8> {
    let run = Command::new(program).current_dir(folder).envs(settings.iter().copied()).output();
    let output = run.unwrap_or_else(|cause| {
        panic!("{program} does not start ({cause}); install it: apt-get install flam3-utils")
    });
    let message = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success() && !message.contains("rror"), "{program}: {message}");
    assert!(!message.contains("unrecognized"), "{program}: {message}");
    output.stdout
}

/// Which pixels of the only flame of a file flam3 hits, the highest row first.
fn drawn(text: &str) -> Vec<bool> {
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::write(folder.path().join("shape.flame"), text).expect("written");
    // A batch begins at a point off the shape, and 15 points later its points count; so there are few batches.
    let settings = [
        ("in", "shape.flame"),
        ("out", "shape.png"),
        ("bpc", "16"),
        ("verbose", "0"),
        ("nthreads", "2"),
        ("sub_batch_size", "4000000"),
        ("isaac_seed", "weald"),
    ];
    flam3("flam3-render", folder.path(), &settings);
    let bytes = std::fs::read(folder.path().join("shape.png")).expect("flam3 wrote it");
    let mut reader = png::Decoder::new(std::io::Cursor::new(bytes)).read_info().expect("a PNG");
    assert_eq!((reader.info().width, reader.info().height, reader.info().bytes_per_pixel()), (SIDE, SIDE, 8));
    let mut pixels = vec![0; reader.output_buffer_size().expect("small")];
    reader.next_frame(&mut pixels).expect("whole");
    // Red, green and blue of 16 bits; the fourth channel is opaque everywhere.
    pixels.chunks_exact(8).map(|pixel| pixel[..6].iter().any(|&byte| byte != 0)).collect()
}

/// Which cells of a window our game hits, the highest row first.
fn played(ifs: &Ifs, low: [f64; 2], scale: f64) -> Vec<bool> {
    let window = Window { low: low.map(|x| x as f32), scale: [scale as f32; 2], size: [SIDE; 2] };
    let mut histogram = Histogram::new(window);
    Game::new(ifs, 7).points((QUALITY * f64::from(SIDE * SIDE)) as u64, |block| histogram.count(block));
    let hit: Vec<bool> = histogram.counts().map(|count| count > 0).collect();
    hit.chunks_exact(SIDE as usize).rev().flatten().copied().collect()
}

/// Shares of all pixels that either hits: hit by both, and hit by one when the other is turned upside down.
fn overlaps(ours: &[bool], theirs: &[bool]) -> [f64; 2] {
    let share = |ours: &mut dyn Iterator<Item = &bool>| {
        let (mut both, mut either) = (0, 0);
        for (a, b) in ours.zip(theirs) {
            both += u32::from(*a && *b);
            either += u32::from(*a || *b);
        }
        f64::from(both) / f64::from(either)
    };
    [share(&mut ours.iter()), share(&mut ours.chunks_exact(SIDE as usize).rev().flatten())]
}

#[test]
fn flam3_draws_every_flat_shape_as_we_do() {
    let flat: Vec<Ifs> =
        SHAPES.iter().map(weald::grow::ifs::shapes::Shape::ifs).filter(Ifs::is_planar).collect();
    assert_eq!(flat.len(), 12);
    for ifs in &flat {
        let text = flame::write(std::slice::from_ref(ifs), &frame()).expect("flat");
        let (low, scale) = frame().window(ifs);
        let (ours, theirs) = (played(ifs, low, scale), drawn(&text));
        let [overlap, upside_down] = overlaps(&ours, &theirs);
        let share = ours.iter().filter(|hit| **hit).count() as f64 / ours.len() as f64;
        println!(
            "{:<12} overlap {overlap:.4}, upside down {upside_down:.4}, share of the picture {share:.3}",
            ifs.name()
        );
        assert!(share > 0.01, "{}: next to nothing is drawn", ifs.name());
        assert!(overlap >= 0.95, "{}: {overlap}", ifs.name());
        if ifs.name() == "fern" {
            assert!(upside_down < 0.6, "the fern stands upright in both: {upside_down}");
        }
    }
}

/// Each flame of a file of flam3's, as text.
fn each(text: &str) -> impl Iterator<Item = &str> {
    text.split_inclusive("</flame>").filter_map(|part| part.find("<flame ").map(|begin| &part[begin..]))
}

/// The same flame with another camera and no filter.
fn reframed(text: &str, low: [f64; 2], scale: f64) -> String {
    let camera = ["size", "center", "scale", "rotate", "filter", "quality", "estimator_radius"];
    let (opening, rest) = text.split_at(text.find('>').expect("an opening"));
    let mut opening = opening.to_owned();
    for attribute in camera {
        if let Some(begin) = opening.find(&format!(" {attribute}=\"")) {
            let value = begin + attribute.len() + 3;
            let end = value + opening[value..].find('"').expect("an end") + 1;
            opening.replace_range(begin..end, "");
        }
    }
    let half = 0.5 * f64::from(SIDE) / scale;
    let (x, y) = (low[0] + half, -(low[1] + half));
    format!(
        "{opening} size=\"{SIDE} {SIDE}\" center=\"{x} {y}\" scale=\"{scale}\" filter=\"0\" quality=\"{QUALITY}\" \
         estimator_radius=\"0\"{rest}"
    )
}

#[test]
fn flames_of_flam3s_own_generator_are_read_as_flam3_draws_them() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/flam3_linear.flame");
    let flames = flame::read(&path).unwrap_or_else(|error| panic!("{error}"));
    let text = std::fs::read_to_string(&path).expect("there");
    assert_eq!((flames.len(), each(&text).count()), (10, 10));
    for (ifs, text) in flames.iter().zip(each(&text)) {
        let (low, scale) = frame().window(ifs);
        let (ours, theirs) = (played(ifs, low, scale), drawn(&reframed(text, low, scale)));
        let [overlap, upside_down] = overlaps(&ours, &theirs);
        println!(
            "{}, {} maps: overlap {overlap:.4}, upside down {upside_down:.4}",
            ifs.name(),
            ifs.maps().len()
        );
        assert!(overlap >= 0.95, "{overlap}: {text}");
    }
}

/// What flam3's generator does not make.
const BY_HAND: &str = r#"<flame name="by hand" >
   <xform weight="2" color="0" linear="0.5" coefs="1 0.2 -0.1 0.9 0.3 0.1" post="1 0 0.2 0.8 0.1 -0.2"/>
   <xform weight="3" color="1" linear="0.3" coefs="0.9 -0.8 0.7 1 -1 0.8"/>
   <symmetry kind="-3"/>
   <finalxform color="0" linear="1" coefs="1.5 0.1 0.4 0.8 1 2"/>
   <palette count="2" format="RGB">FFFFFF80FF80</palette>
</flame>"#;

#[test]
fn scaled_xforms_second_maps_symmetries_and_final_xforms_mean_what_flam3_draws() {
    let ifs = flame::parse(BY_HAND.as_bytes()).expect("affine").remove(0);
    let (low, scale) = frame().window(&ifs);
    let [overlap, upside_down] = overlaps(&played(&ifs, low, scale), &drawn(&reframed(BY_HAND, low, scale)));
    println!("by hand: overlap {overlap:.4}, upside down {upside_down:.4}");
    assert!(overlap >= 0.95 && upside_down < 0.8, "{overlap} {upside_down}");
}

#[test]
fn the_test_genomes_of_flam3_are_refused_for_their_variation() {
    let path = Path::new("/usr/share/flam3/test.flam3");
    let error = flame::read(path).expect_err("spherical").to_string();
    let said = "/usr/share/flam3/test.flam3: line 3, <xform>: it has the variation `spherical` with weight 1";
    assert!(error.starts_with(said), "{error}");
}
