//! Files of flames, right and wrong.

use proptest::prelude::*;

use super::super::game::Game;
use super::super::map::{Point, distance};
use super::super::shapes::{SHAPES, find};
use super::*;

/// A flame of two xforms with these elements after them.
fn flame(first: &str, second: &str, more: &str) -> String {
    format!("<flame name=\"mine\">\n<xform {first}/>\n<xform {second}/>\n{more}</flame>")
}

const HALF: &str = "weight=\"1\" linear=\"1\" coefs=\"0.5 0 0 0.5 0 0\"";
const OTHER: &str = "weight=\"3\" linear=\"1\" coefs=\"0.4 0.1 -0.1 0.4 1 2\"";

fn one(text: &str) -> Ifs {
    let mut all = parse(text.as_bytes()).unwrap_or_else(|fault| panic!("{fault}\n{text}"));
    assert_eq!(all.len(), 1);
    all.remove(0)
}

fn fault(text: &str) -> String {
    parse(text.as_bytes()).expect_err("a faulty file").to_string()
}

#[test]
fn six_numbers_are_columns_and_y_is_turned_round() {
    let ifs = one(&flame(HALF, "weight=\"3\" linear=\"1\" coefs=\"0.1 0.2 0.3 0.4 0.5 0.6\"", ""));
    // In the file: x' = 0.1 x + 0.3 y + 0.5, y' = 0.2 x + 0.4 y + 0.6.
    assert_eq!(ifs.maps()[1].map, Map::planar([0.1, -0.3, -0.2, 0.4, 0.5, -0.6]));
    assert_eq!((ifs.name(), ifs.maps()[0].probability, ifs.maps()[1].probability), ("mine", 0.25, 0.75));
}

#[test]
fn the_weight_of_linear_scales_before_the_second_map() {
    let text = "weight=\"1\" linear=\"0.25\" linear3D=\"0.25\" coefs=\"1 0 0 1 1 1\" post=\"0.5 0 0 1 3 0\"";
    let ifs = one(&flame(text, OTHER, ""));
    assert_eq!(ifs.maps()[0].map, Map::planar([0.25, 0.0, 0.0, 0.5, 3.25, -0.5]));
}

#[test]
fn older_spellings_of_linear_are_read() {
    let coefs = "weight=\"1\" coefs=\"0.5 0 0 0.5 0 0\"";
    let [number, list] =
        ["var1=\"0\"", "var=\"1 0 0 0\""].map(|old| one(&flame(&format!("{coefs} {old}"), OTHER, "")));
    assert_eq!(number, list);
    assert_eq!(number, one(&flame(HALF, OTHER, "")));
    let first = fault(&flame(&format!("{coefs} var1=\"2\""), OTHER, ""));
    assert!(first.contains("the variation `spherical` with weight 1"), "{first}");
    let second = fault(&flame(&format!("{coefs} var=\"1 0 0.5\""), OTHER, ""));
    assert!(second.contains("the variation `spherical` with weight 0.5"), "{second}");
}

#[test]
fn xforms_that_are_never_taken_are_left_out_whatever_they_are() {
    let unused = "<xform weight=\"0\" julia=\"1\"/>\n";
    assert_eq!(one(&flame(HALF, OTHER, unused)), one(&flame(HALF, OTHER, "")));
}

#[test]
fn flames_are_found_at_any_depth_and_in_their_order() {
    let [a, b] = ["a", "b"].map(|name| flame(HALF, OTHER, "").replace("mine", name));
    let unnamed = flame(HALF, OTHER, "").replace("name=\"mine\"", "");
    let text = format!("<all><more>{a}</more>{b}{unnamed}</all>");
    let names: Vec<String> =
        parse(text.as_bytes()).expect("three").iter().map(|ifs| ifs.name().to_owned()).collect();
    assert_eq!(names, ["a", "b", "flame-3"]);
}

#[test]
fn drafts_are_what_becomes_of_flames() {
    let [a, b] = ["a", "b"].map(|name| flame(HALF, OTHER, "").replace("mine", name));
    let text = format!("<all>{a}{b}</all>");
    let both: Vec<_> = drafts(text.as_bytes()).expect("two").into_iter().map(Ifs::new).collect();
    let parsed = parse(text.as_bytes()).expect("two");
    assert_eq!(both, parsed.into_iter().map(Ok).collect::<Vec<_>>());
}

#[test]
fn what_no_fractal_can_say_is_refused_by_name() {
    let with = |more: &str| fault(&flame(HALF, &format!("{OTHER} {more}"), ""));
    for (more, said) in [
        ("sinusoidal=\"0.5\"", "line 3, <xform>: it has the variation `sinusoidal` with weight 0.5"),
        ("epispiral=\"1\"", "it has what is no known attribute, `epispiral`"),
        ("chaos=\"1 0.5\"", "its `chaos` makes what follows depend on it"),
        ("plotmode=\"off\"", "it is hidden"),
        ("opacity=\"0\"", "it is hidden"),
        ("yzCoefs=\"0 1 -1 0 0 0\"", "`yzCoefs` turns it out of the plane"),
        ("post=\"1 0 0 1\"", "`post` has 4 numbers; it must have 6"),
        ("post=\"1 0 0 1 x 0\"", "`post` has `x` where a number must stand"),
        ("opacity=\"inf\"", "`opacity` is `inf`; it must be a number"),
    ] {
        assert!(with(more).contains(said), "{more}: {}", with(more));
    }
    let harmless =
        "chaos=\"1 1\" blob_low=\"2\" mod_gamma=\"1\" yzCoefs=\"1 0 0 1 0 0\" julia=\"0\" name=\"x\"";
    assert_eq!(one(&flame(HALF, &format!("{OTHER} {harmless}"), "")), one(&flame(HALF, OTHER, "")));
}

#[test]
fn faulty_files_are_told_apart() {
    let xform = |text: &str| fault(&flame(HALF, text, ""));
    assert!(fault("<flames/>").contains("no `<flame>` element"));
    assert!(fault("<flame>").contains("not well-formed XML"));
    assert!(fault("<!DOCTYPE a [<!ENTITY b \"c\">]><flame>&b;</flame>").contains("has a document type"));
    assert!(parse(b"<flame name=\"\xff\"/>").expect_err("Latin").to_string().contains("is not UTF-8"));
    assert!(xform("linear=\"1\" coefs=\"0.5 0 0 0.5 0 0\"").contains("it has no `weight`"));
    assert!(xform("weight=\"-1\" linear=\"1\"").contains("`weight` is -1; it must be 0 or more"));
    assert!(xform("weight=\"1\" coefs=\"0.5 0 0 0.5 0 0\"").contains("it names no variation"));
    let grows = xform("weight=\"1\" linear=\"1\" coefs=\"1.5 0 0 0.5 0 0\"");
    assert!(grows.starts_with("line 3, <xform>: map 1 does not contract: it lengthens by 1.5000"), "{grows}");
    let more = |text: &str| fault(&flame(HALF, OTHER, text));
    assert!(more("<symmetry kind=\"0\"/>").contains("`kind` is 0; it must be a whole number"));
    assert!(more("<symmetry kind=\"200\"/>").contains("its symmetries turn 2 xforms into 400"));
    let flat = "<finalxform linear=\"1\" coefs=\"1 0 0 0 0 0\"/>";
    assert!(more(flat).contains("it presses the plane flat"));
    assert!(more("<finalxform linear=\"1\"/><finalxform linear=\"1\"/>").contains("it is the second"));
    assert!(more("<finalxform color=\"0\" swirl=\"1\"/>").contains("`swirl`"));
    assert!(fault("<flame soloxform=\"1\"/>").contains("`soloxform` hides"));
    assert!(fault("<flame/>").contains("a fractal needs at least 2 maps and has 0"));
}

#[test]
fn sizes_beyond_the_limits_are_refused() {
    let limit = |text: &str| match parse(text.as_bytes()).expect_err("too large") {
        Fault::Limit(limit) => limit.to_string(),
        Fault::Damaged(what) => panic!("{what}"),
    };
    assert!(limit(&format!("<a>{}</a>", "<flame/>".repeat(MAX_FLAMES + 1))).contains("4096 flames"));
    assert!(limit(&format!("<a>{}</a>", "<b/>".repeat(MAX_NODES as usize))).contains("elements and texts"));
    assert!(limit(&" ".repeat(MAX_BYTES as usize + 1)).contains("at most 16777216 bytes"));
    let many = fault(&flame(HALF, OTHER, &format!("<xform {HALF}/>").repeat(MAX_MAPS)));
    assert!(many.contains("more than 256 xforms"), "{many}");
    let deep = 200_000;
    let text = format!("{}{}", "<a>".repeat(deep), "</a>".repeat(deep));
    assert!(parse(text.as_bytes()).is_err(), "a deep file ends without using up the stack");
}

#[test]
fn a_final_xform_moves_the_shape_and_not_the_game() {
    let plain = one(&flame(HALF, OTHER, ""));
    let moved = one(&flame(HALF, OTHER, "<finalxform linear=\"1\" coefs=\"2 0.3 0.1 1 5 -7\"/>\n"));
    let last = Map::planar([2.0, -0.1, -0.3, 1.0, 5.0, 7.0]);
    let (points, others) = (played(&plain, 5000), played(&moved, 5000));
    let off = points.iter().zip(&others).map(|(a, b)| distance(last.at(*a), *b)).fold(0.0, f64::max);
    assert!(off < 1e-4, "{off}");
    assert!(distance(points[0], others[0]) > 1.0, "nothing moved");
}

fn played(ifs: &Ifs, count: u64) -> Vec<Point> {
    let mut points = Vec::new();
    Game::new(ifs, 7).points(count, |block| {
        points.extend((0..block.len()).map(|i| block.point(i).map(f64::from)));
    });
    points
}

/// The points of flam3's own way: all maps drawn by their weights, symmetries among them.
fn drawn_with_symmetries(maps: &[(Map, f64)], count: usize) -> Vec<Point> {
    let total: f64 = maps.iter().map(|(_, weight)| weight).sum();
    let mut at = [0.1, 0.2, 0.0];
    let mut points = Vec::new();
    for step in 0..count + 100 {
        let mut draw =
            total * (weald_core::random::splitmix64(step as u64) >> 11) as f64 / (1_u64 << 53) as f64;
        let taken = maps.iter().position(|(_, weight)| {
            draw -= weight;
            draw < 0.0
        });
        at = maps[taken.unwrap_or(0)].0.at(at);
        points.push(at);
    }
    points.split_off(100)
}

/// Mean, and the means of squares and of a cubic, which tell a turned or mirrored density apart.
fn moments(points: &[Point]) -> [f64; 6] {
    let mean = |value: &dyn Fn(&Point) -> f64| points.iter().map(value).sum::<f64>() / points.len() as f64;
    [
        mean(&|p| p[0]),
        mean(&|p| p[1]),
        mean(&|p| p[0] * p[0]),
        mean(&|p| p[1] * p[1]),
        mean(&|p| p[0] * p[1]),
        mean(&|p| p[0] * p[0] * p[0] - 3.0 * p[0] * p[1] * p[1]),
    ]
}

#[test]
fn symmetries_draw_the_density_that_flam3_draws() {
    // Off the centre, with unequal weights, so that the parts are unlike.
    let maps = [
        (Map::planar([0.4, 0.1, -0.1, 0.4, 0.5, 0.2]), 0.3),
        (Map::planar([0.3, -0.2, 0.2, 0.3, -0.1, 0.7]), 0.9),
    ];
    let xforms = maps.map(|(map, weight)| {
        let coefs = xform::numbers(&map).map(|number| number.to_string()).join(" ");
        format!("weight=\"{weight}\" linear=\"1\" coefs=\"{coefs}\"")
    });
    for (kind, order) in [(3, 3), (-1, 2), (-3, 6), (4, 4), (-4, 8)] {
        let element = format!("<symmetry kind=\"{kind}\"/>\n");
        let ifs = one(&flame(&xforms[0], &xforms[1], &element));
        assert_eq!(ifs.maps().len(), 2 * order, "kind {kind}");
        let mirror = (kind < 0).then_some((Map::planar([-1.0, 0.0, 0.0, 1.0, 0.0, 0.0]), 1.0));
        let turns = (1..i32::abs(kind)).map(|k| {
            // In the rounded numbers of flam3.
            let (sin, cos) = (std::f64::consts::TAU * f64::from(k) / f64::from(kind.abs())).sin_cos();
            (Map::planar([cos, sin, -sin, cos, 0.0, 0.0]), 1.0)
        });
        let all: Vec<_> = maps.into_iter().chain(mirror).chain(turns).collect();
        let (theirs, ours) =
            (moments(&drawn_with_symmetries(&all, 400_000)), moments(&played(&ifs, 400_000)));
        let off = theirs.iter().zip(&ours).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(off < 0.01, "kind {kind}: {theirs:?} {ours:?}");
        assert!(theirs[2] > 0.05, "{theirs:?}");
        // As flam3 writes it: the element and its xforms as well.
        let rounded: Vec<String> = all[2..]
            .iter()
            .map(|(map, _)| {
                let coefs = xform::numbers(map).map(|number| format!("{number:.6}")).join(" ");
                format!("<xform weight=\"1\" linear=\"1\" coefs=\"{coefs}\"/>")
            })
            .collect();
        let twice = one(&flame(&xforms[0], &xforms[1], &(element + &rounded.concat())));
        assert_eq!(twice.maps().len(), 2 * order, "kind {kind}");
    }
}

#[test]
fn every_flat_shape_comes_back_from_its_flame() {
    let flat: Vec<Ifs> = SHAPES.iter().map(super::super::shapes::Shape::ifs).filter(Ifs::is_planar).collect();
    let text = write(&flat, &Frame::default()).expect("flat");
    let back = parse(text.as_bytes()).expect("our own file");
    assert!(flat.len() >= 10 && back.len() == flat.len());
    for (ifs, again) in flat.iter().zip(&back) {
        assert_same(ifs, again);
        assert_eq!(ifs.bounds(), again.bounds());
    }
}

fn assert_same(ifs: &Ifs, again: &Ifs) {
    assert_eq!(ifs.name(), again.name());
    assert_eq!(ifs.maps().len(), again.maps().len());
    for (map, other) in ifs.maps().iter().zip(again.maps()) {
        assert_eq!(map.map, other.map);
        assert!((map.probability - other.probability).abs() <= 1e-15, "{map:?} {other:?}");
    }
}

#[test]
fn a_fractal_of_space_is_not_written() {
    let fern = find("fern-3d").expect("built in").ifs();
    let message = write(&[fern], &Frame::default()).expect_err("of space").to_string();
    assert!(message.starts_with("`fern-3d` is a 3D fractal"), "{message}");
}

proptest! {
    #[test]
    fn any_flat_fractal_comes_back_from_its_flame(
        maps in prop::collection::vec((prop::array::uniform6(-0.6..0.6_f64), 0.01..1.0_f64), 2..9),
        name in "[a-z <>&\"']{1,12}[a-z]",
        offset in -1e6..1e6_f64,
    ) {
        let total: f64 = maps.iter().map(|(_, weight)| weight).sum();
        let weighted = |([a, b, c, d, e, f], weight): ([f64; 6], f64)| Weighted {
            map: Map::planar([a, b, c, d, e * offset, f]),
            probability: weight / total,
            role: Role::default(),
        };
        let name = name.trim().to_owned();
        let draft = Draft { name, maps: maps.into_iter().map(weighted).collect(), code_digits: None };
        let Ok(ifs) = Ifs::new(draft) else { return Ok(()) };
        let text = write(std::slice::from_ref(&ifs), &Frame::default()).expect("flat");
        assert_same(&ifs, &one(&text));
    }

    #[test]
    fn damaged_files_are_faults_and_never_panics(place in 0_usize..2000, byte in 0_u8..128) {
        let fern = find("fern").expect("built in").ifs();
        let mut bytes = write(&[fern], &Frame::default()).expect("flat").into_bytes();
        let place = place % bytes.len();
        bytes[place] = byte;
        let _ = parse(&bytes);
    }
}

#[test]
fn a_flame_of_an_empty_name_is_called_by_its_number() {
    assert_eq!(one(&flame(HALF, OTHER, "").replace("mine", " ")).name(), "flame-1");
}
