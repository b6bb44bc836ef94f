//! What holds for pictures of fractals.

use super::*;
use crate::Cutout;
use weald_core::error::Error;
use weald_core::parameter::Sides;
use weald_plants::ifs::{Code, Ifs, Point, shapes};

fn ifs(name: &str) -> Ifs {
    shapes::find(name).expect("built in").ifs()
}

fn look(columns: u64, rows: u64) -> Look {
    Look { size: Some(Sides { columns, rows }), samples: Some(40.0), ..Look::default() }
}

fn picture(look: &Look, ifs: &Ifs, motion: Option<&dyn Motion>) -> Cutout {
    let subject = look.subject(ifs, motion, 1, 0.0);
    let setting = Setting::of_still(look, &Extent::of(&subject)).expect("small");
    look.draw(&subject, &setting, &mut |_, _| Ok(())).expect("draws")
}

fn density(look: &Look, ifs: &Ifs) -> Density {
    let subject = look.subject(ifs, None, 1, 0.0);
    let setting = Setting::of_still(look, &Extent::of(&subject)).expect("small");
    look.count(&subject, &setting, &mut |_, _| Ok(())).expect("counts")
}

/// Mean darkness of what is drawn on white, 0 to 1. A larger picture has more white between its finer parts.
fn darkness(picture: &Cutout) -> f64 {
    let drawn: Vec<f64> =
        picture.image.rgb.iter().filter(|&&byte| byte < 255).map(|&byte| 255.0 - f64::from(byte)).collect();
    drawn.iter().sum::<f64>() / (255.0 * drawn.len() as f64)
}

#[test]
fn every_point_falls_inside_the_frame() {
    for name in ["fern", "dragon", "conifer", "maple"] {
        let counted = density(&look(90, 120), &ifs(name));
        assert_eq!((counted.inside(), counted.points), (432_000, 432_000), "{name}");
    }
}

#[test]
fn brightness_depends_neither_on_samples_nor_on_supersampling_nor_much_on_size() {
    let fern = ifs("fern");
    let base = look(150, 240);
    let usual = darkness(&picture(&base, &fern, None));
    assert!(usual > 0.1, "{usual}: there is a fern");
    let differs = |look: &Look| darkness(&picture(look, &fern, None)) / usual - 1.0;
    let samples = differs(&Look { samples: Some(640.0), ..base.clone() });
    let finer = differs(&Look { supersample: 4, samples: Some(160.0), ..base.clone() });
    let larger = differs(&Look { samples: Some(40.0), ..look(450, 720) });
    assert!(samples.abs() < 0.05 && finer.abs() < 0.12 && larger.abs() < 0.12, "{samples} {finer} {larger}");
    let brighter = differs(&Look { exposure: 2.0, ..base });
    assert!(brighter > 0.02, "{brighter}: two stops more cover more");
}

#[test]
fn the_gasket_is_the_same_in_its_mirror_and_has_its_holes() {
    let side = 128_usize;
    let look = Look { margin: 0.0, samples: Some(200.0), colour_by: ColourBy::Ink, ..look(128, 128) };
    let picture = picture(&look, &ifs("gasket"), None).image;
    let dark = |x: usize, y: usize| 255 - i32::from(picture.pixel(x, y)[1]);
    let mut worst = 0;
    for y in 0..side {
        for x in 0..side {
            // The triangle is its own mirror across the rising diagonal of the picture.
            worst = worst.max((dark(x, y) - dark(side - 1 - y, side - 1 - x)).abs());
        }
    }
    assert!(worst < 60, "{worst}: points are random, the shape is not");
    // The middle triangle, the largest hole, and one of the next size.
    assert_eq!([dark(60, 70), dark(40, 80), dark(28, 100)], [0, 0, 0]);
    assert!(dark(1, 127) > 100 && dark(90, 127) > 50, "the corner and the floor are full");
}

#[test]
fn threads_do_not_change_a_byte() {
    let turned = |point: Point, code: &Code| [point[0] + 0.01 * f64::from(code.digit(2)), point[1], point[2]];
    let look = Look { samples: Some(60.0), ..look(100, 120) };
    let drawn = |threads: usize, motion: Option<&dyn Motion>| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        pool.install(|| picture(&look, &ifs("fern"), motion))
    };
    for motion in [None, Some(&turned as &dyn Motion)] {
        let one = drawn(1, motion);
        assert!(darkness(&one) > 0.1);
        assert!([2, 3].iter().all(|&threads| drawn(threads, motion) == one));
    }
}

#[test]
fn a_motion_that_leaves_points_where_they_are_changes_nothing_but_the_frame() {
    let fern = ifs("fern");
    let look = look(100, 150);
    let rest = |point: Point, _: &Code| point;
    let subject = look.subject(&fern, None, 1, 0.0);
    let setting = Setting::of_still(&look, &Extent::of(&subject)).expect("small");
    let moved = look.subject(&fern, Some(&rest), 1, 0.0);
    let drawn = |subject: &Subject<'_>| look.draw(subject, &setting, &mut |_, _| Ok(())).expect("draws");
    assert_eq!(drawn(&moved), drawn(&subject));
    let aside = |point: Point, _: &Code| [point[0] + 0.5, point[1], point[2]];
    assert_ne!(drawn(&look.subject(&fern, Some(&aside), 1, 0.0)), drawn(&subject));
}

#[test]
fn what_moves_stays_in_the_frame() {
    let fern = ifs("fern");
    let look = look(100, 150);
    let spread = |point: Point, code: &Code| [point[0] + 2.0 * f64::from(code.digit(0)), 1.5 * point[1], 0.0];
    let subject = look.subject(&fern, Some(&spread), 1, 0.0);
    let setting = Setting::of_still(&look, &Extent::of(&subject)).expect("small");
    let counted = look.count(&subject, &setting, &mut |_, _| Ok(())).expect("counts");
    assert_eq!(counted.inside(), counted.points);
}

#[test]
fn a_picture_without_background_looks_on_white_as_one_with_white_behind_it() {
    let fern = ifs("fern");
    let white = picture(&look(60, 100), &fern, None).image;
    let clear = picture(&Look { background: Background::Transparent, ..look(60, 100) }, &fern, None);
    let covers = clear.alpha.as_ref().expect("a background that shows through");
    assert!(covers.contains(&0) && covers.iter().any(|&cover| cover > 200));
    let pixels = clear.image.rgb.chunks(3).zip(covers).zip(white.rgb.chunks(3));
    for ((colour, &cover), seen) in pixels {
        for (channel, seen) in colour.iter().zip(seen) {
            let share = f64::from(cover) / 255.0;
            let over = share * f64::from(*channel) + (1.0 - share) * 255.0;
            assert!((over - f64::from(*seen)).abs() <= 2.0, "{over} {seen}");
        }
    }
}

#[test]
fn parts_of_the_gasket_are_triangles_that_leave_its_holes_and_as_many_in_a_picture_as_in_a_file_of_vectors() {
    let look = Look { draw: Draw::Parts, depth: Some(4), margin: 0.0, ..look(64, 64) };
    let gasket = ifs("gasket");
    let image = picture(&look, &gasket, None).image;
    assert_eq!(image.pixel(30, 36), [255; 3], "the hole in the middle");
    assert_ne!(image.pixel(1, 62), [255; 3], "the corner");
    let subject = look.subject(&gasket, None, 1, 0.0);
    let setting = Setting::of_still(&look, &Extent::of(&subject)).expect("small");
    let svg = look.svg(&subject, &setting).expect("short");
    assert!(svg.starts_with("<svg xmlns") && svg.ends_with("</svg>\n"));
    assert_eq!(svg.matches('M').count(), 81);
    let dots = Look { draw: Draw::Dots, ..look };
    assert_eq!(dots.svg(&subject, &setting).expect("short").matches("h0").count(), 81);
}

#[test]
fn pictures_beyond_memory_and_too_many_parts_are_refused_before_they_begin() {
    let fern = ifs("fern");
    let refused = |look: &Look| {
        let subject = look.subject(&fern, None, 1, 0.0);
        let setting = Setting::of_still(look, &Extent::of(&subject)).expect("a frame");
        let error =
            look.draw(&subject, &setting, &mut |_, _| panic!("nothing is played")).expect_err("too large");
        assert_eq!(error.exit_code(), 5, "{error}");
        error.to_string()
    };
    assert!(refused(&Look { supersample: 4, ..look(10_000, 10_000) }).contains("at most 4096.0 MiB"));
    assert!(
        refused(&Look { samples: Some(1e5), ..look(5_000, 5_000) }).contains("at most 1000000000000 are")
    );
    assert!(
        refused(&Look { draw: Draw::Dots, depth: Some(12), ..look(100, 100) })
            .contains("a `depth` of 11 or less")
    );
    assert!(refused(&Look { draw: Draw::Parts, finest: Some(0.1), ..look(4_000, 4_000) }).contains("larger"));
}

#[test]
fn a_drawing_ends_when_it_is_told_to() {
    let (fern, look) = (ifs("fern"), look(400, 600));
    let subject = look.subject(&fern, None, 1, 0.0);
    let setting = Setting::of_still(&look, &Extent::of(&subject)).expect("small");
    let stop = |done: u64, all: u64| {
        if done > all / 4 { Err(Error::Interrupted("enough".to_owned())) } else { Ok(()) }
    };
    assert_eq!(look.draw(&subject, &setting, &mut { stop }).expect_err("stopped").exit_code(), 130);
}
