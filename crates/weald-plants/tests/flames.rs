//! flam3 draws the flames that Weald writes as the same shapes, and Weald reads flam3's own.
//!
//! The client comes from the Debian package `flam3-utils`, version 3.1.1. A test fails where it is missing.
//!
//! **Support** is the set of pixels that are hit at all: here cells of a histogram with one point or more, there pixels
//! of a 16-bit picture of which a channel is not 0, drawn without flam3's filter and without spreading where points are
//! few. Both sides throw the same number of points, so many that most pixels of the shape are hit often. Of random
//! flames much is hit a thousand times less often than the rest, so that two runs of the same program agree on nine
//! pixels in ten: there a pixel belongs to the support if [`MIN_HITS`] points hit it, and as many pixels of flam3's,
//! the brightest under a white palette. **Overlap** is how much of all pixels of either support is in both.

use std::path::Path;
use std::process::Command;

use weald_plants::ifs::flame::{self, Frame};
use weald_plants::ifs::shapes::SHAPES;
use weald_plants::ifs::{Game, Histogram, Ifs, Window};

/// Pictures of shapes whose points are spread evenly.
const EVEN: Frame = Frame { size: [192; 2], quality: 600.0, spread: 0.0, filter: 0.0 };

/// Pictures of random flames.
const UNEVEN: Frame = Frame { size: [80; 2], quality: 8000.0, spread: 0.0, filter: 0.0 };

/// Points of a pixel of a random flame's support.
const MIN_HITS: u32 = 20;

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

/// The brightness of each pixel of the only flame of a file in flam3's picture, the highest row first.
fn drawn(text: &str, frame: &Frame) -> Vec<u32> {
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::write(folder.path().join("shape.flame"), text).expect("written");
    // A batch begins at a point off the shape, and 15 points later its points count, with `earlyclip` 100 points later;
    // and the batches are few.
    let settings = [
        ("in", "shape.flame"),
        ("out", "shape.png"),
        ("bpc", "16"),
        ("verbose", "0"),
        ("nthreads", "2"),
        ("sub_batch_size", "4000000"),
        ("earlyclip", "1"),
        ("isaac_seed", "weald"),
    ];
    flam3("flam3-render", folder.path(), &settings);
    let bytes = std::fs::read(folder.path().join("shape.png")).expect("flam3 wrote it");
    let mut reader = png::Decoder::new(std::io::Cursor::new(bytes)).read_info().expect("a PNG");
    assert_eq!(
        (reader.info().width, reader.info().height, reader.info().bytes_per_pixel()),
        (frame.size[0], frame.size[1], 8)
    );
    let mut pixels = vec![0; reader.output_buffer_size().expect("small")];
    reader.next_frame(&mut pixels).expect("whole");
    // Red, green and blue of 16 bits; the fourth channel is opaque everywhere.
    let channel = |pair: &[u8]| u32::from(pair[0]) << 8 | u32::from(pair[1]);
    pixels.chunks_exact(8).map(|pixel| pixel[..6].chunks_exact(2).map(channel).max().unwrap_or(0)).collect()
}

/// How many points of our game hit each pixel of the same picture, the highest row first.
fn played(ifs: &Ifs, frame: &Frame) -> Vec<u32> {
    let (low, scale) = frame.window(ifs);
    let window = Window { low: low.map(|x| x as f32), scale: [scale as f32; 2], size: frame.size };
    let mut histogram = Histogram::new(window);
    let points = (frame.quality * f64::from(frame.size[0] * frame.size[1])) as u64;
    Game::new(ifs, 7).points(points, |block| histogram.count(block));
    let counts: Vec<u32> = histogram.counts().collect();
    counts.chunks_exact(frame.size[0] as usize).rev().flatten().copied().collect()
}

/// The pixels that are hit.
fn hit(values: &[u32]) -> Vec<bool> {
    values.iter().map(|value| *value > 0).collect()
}

/// The greatest values, so many of them.
fn greatest(values: &[u32], count: usize) -> Vec<bool> {
    let mut order: Vec<usize> = (0..values.len()).collect();
    order.sort_by_key(|&pixel| std::cmp::Reverse(values[pixel]));
    let mut chosen = vec![false; values.len()];
    for &pixel in &order[..count] {
        chosen[pixel] = true;
    }
    chosen
}

/// Shares of all pixels that either hits: hit by both, and hit by one when the other is turned upside down.
fn overlaps(ours: &[bool], theirs: &[bool]) -> [f64; 2] {
    let side = ours.len().isqrt();
    let share = |ours: &mut dyn Iterator<Item = &bool>| {
        let (mut both, mut either) = (0, 0);
        for (a, b) in ours.zip(theirs) {
            both += u32::from(*a && *b);
            either += u32::from(*a || *b);
        }
        f64::from(both) / f64::from(either)
    };
    [share(&mut ours.iter()), share(&mut ours.chunks_exact(side).rev().flatten())]
}

#[test]
fn flam3_draws_every_flat_shape_as_we_do() {
    let flat: Vec<Ifs> =
        SHAPES.iter().map(weald_plants::ifs::shapes::Shape::ifs).filter(Ifs::is_planar).collect();
    assert_eq!(flat.len(), 12);
    for ifs in &flat {
        let text = flame::write(std::slice::from_ref(ifs), &EVEN).expect("flat");
        let (ours, theirs) = (hit(&played(ifs, &EVEN)), hit(&drawn(&text, &EVEN)));
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
fn reframed(text: &str, ifs: &Ifs, frame: &Frame) -> String {
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
    let (low, scale) = frame.window(ifs);
    let Frame { size: [side, _], quality, .. } = frame;
    let half = 0.5 * f64::from(*side) / scale;
    let (x, y) = (low[0] + half, -(low[1] + half));
    format!(
        "{opening} size=\"{side} {side}\" center=\"{x} {y}\" scale=\"{scale}\" filter=\"0\" quality=\"{quality}\" \
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
        let (ours, theirs) = (played(ifs, &UNEVEN), drawn(&reframed(text, ifs, &UNEVEN), &UNEVEN));
        let ours: Vec<bool> = ours.iter().map(|count| *count >= MIN_HITS).collect();
        let count = ours.iter().filter(|enough| **enough).count();
        assert!(count > 100, "{count} pixels are too few to compare");
        let theirs = greatest(&theirs, count);
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
    let theirs = hit(&drawn(&reframed(BY_HAND, &ifs, &EVEN), &EVEN));
    let [overlap, upside_down] = overlaps(&hit(&played(&ifs, &EVEN)), &theirs);
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
