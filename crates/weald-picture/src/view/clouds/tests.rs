use super::*;
use crate::view::vector::{towards, unit};

pub(super) fn clouds(share: f64) -> (Sky, Option<Clouds>) {
    let sky = Sky::new(towards(200.0, 40.0), 0.53);
    let clouds = Clouds::new(share, &sky, [500.0, 1.0]);
    (sky, clouds)
}

pub(super) fn haze() -> Haze {
    Haze::new(60_000.0, 1.0)
}

/// Share of places of which the sun is hidden by more than a half.
fn shaded(share: f64) -> f32 {
    let (sky, clouds) = clouds(share);
    let clouds = clouds.expect("some");
    let at = |place: usize| [150.0 * (place % 100) as f32, 170.0 * (place / 100) as f32, 0.0];
    (0..10_000).filter(|&place| clouds.through(&sky, at(place)) < 0.6).count() as f32 / 10_000.0
}

#[test]
fn of_a_stretch_between_levels_what_lies_within_a_heap_counts() {
    for (before, here) in [(-1.0, 1.0), (1.0, -1.0), (-0.3, 0.1), (0.4, 0.2), (-0.2, -0.1), (0.0, 0.0)] {
        let at = |step: i32| before + (here - before) * (step as f32 + 0.5) / 1000.0;
        let mean = (0..1000).map(|step| at(step).max(0.0)).sum::<f32>() / 1000.0;
        let inside: Vec<_> = (0..1000).filter(|&step| at(step) > 0.0).collect();
        let [found, middle] = super::inside(before, here);
        assert!((found - mean).abs() < 1e-3, "{before} to {here}: {found} for {mean}");
        if let (Some(first), Some(last)) = (inside.first(), inside.last()) {
            let expected = 1.0 - (first + last) as f32 / 2000.0;
            assert!((middle - expected).abs() < 2e-3, "{before} to {here}: {middle} for {expected}");
        }
    }
}

#[test]
fn more_clouds_shade_more_of_the_land_and_none_none() {
    assert!(clouds(0.0).1.is_none());
    let shares = [0.2, 0.5, 0.9].map(shaded);
    assert!(shares[0] < 0.25 && shares[2] > 0.6 && shares.is_sorted(), "{shares:?}");
}

/// Share of cloud at a share of the heaps' height, without puffs, within a square of a side whose corner is so many sides away.
fn covered(clouds: &Clouds, share: f32, side: f32, corner: [usize; 2]) -> f32 {
    let at = |cell: usize, axis: usize| (corner[axis] as f32 + cell as f32 / 40.0) * side;
    let within = |cell: &usize| clouds.heap([at(cell % 40, 0), at(cell / 40, 1)], share, 50.0) > 0.0;
    (0..1600).filter(within).count() as f32 / 1600.0
}

#[test]
fn heaps_are_broadest_a_little_above_their_bases() {
    let clouds = clouds(0.3).1.expect("some");
    let [base, broadest, top] = [0.0, BROADEST, 0.8].map(|share| covered(&clouds, share, 90_000.0, [0, 0]));
    assert!(base < 0.75 * broadest && top < 0.75 * broadest, "{base}, {broadest}, {top}");
}

#[test]
fn clouds_stand_in_groups_with_clear_sky_between() {
    let clouds = clouds(0.25).1.expect("some");
    let mut squares: Vec<f32> =
        (0..144).map(|square| covered(&clouds, BROADEST, 4500.0, [square % 12, square / 12])).collect();
    squares.sort_by(f32::total_cmp);
    let mean = squares.iter().sum::<f32>() / 144.0;
    assert!(squares[14] < 0.35 * mean && squares[130] > 1.65 * mean, "{mean}: {squares:?}");
}

#[test]
fn shadows_lie_where_the_clouds_are_that_the_sun_shines_through() {
    let (sky, clouds) = clouds(0.5);
    let clouds = clouds.expect("some");
    for place in 0..200 {
        let point = [400.0 * place as f32, 90.0 * place as f32, 0.0];
        let seen = clouds.before((&sky, haze()), &Ray { from: point, direction: sky.sun }, 0.001);
        let dark = clouds.through(&sky, point) < 0.3;
        assert!(!dark || seen.open < 1.0, "at {point:?} nothing hides the sun");
    }
}

#[test]
fn heaps_low_over_the_horizon_do_not_end_in_combs() {
    let (sky, clouds) = clouds(0.2);
    let clouds = clouds.expect("some");
    let (mut odd, mut clouded) = (0, 0);
    for column in 0_u8..24 {
        let (sine, cosine) = libm::sincosf(0.26 * f32::from(column));
        let open = |row: u8| {
            let direction = unit([cosine, sine, 0.025 + 0.0003 * f32::from(row)]);
            clouds.before((&sky, haze()), &Ray { from: [0.0, 0.0, 600.0], direction }, 0.0003).open
        };
        let rows: Vec<f32> = (0..120).map(open).collect();
        for three in rows.windows(3) {
            // How much a pixel stands out of both the one below and the one above.
            let [below, above] = [three[1] - three[0], three[1] - three[2]];
            clouded += usize::from(three[1] < 0.95);
            odd += usize::from(below.min(above) > 0.02 || below.max(above) < -0.02);
        }
    }
    assert!(clouded > 1000 && 400 * odd < clouded, "{odd} of {clouded} stand out");
}

#[test]
fn clouds_are_seen_from_below_from_within_and_from_above() {
    let (sky, clouds) = clouds(1.0);
    let clouds = clouds.expect("some");
    let is_seen = |height: f32, direction: Vector| {
        let ray = Ray { from: [300.0, 700.0, height], direction: unit(direction) };
        clouds.before((&sky, haze()), &ray, 0.001) != CloudLight::NONE
    };
    let [up, down] = [[0.0, 0.6, 0.8], [0.0, 0.6, -0.8]];
    let seen = [0.0, 2100.0, 9000.0].map(|height| [up, down].map(|direction| is_seen(height, direction)));
    assert_eq!(seen, [[true, false], [true, true], [false, true]]);
    assert!(!is_seen(0.0, [0.0, 1.0, 0.0]) && is_seen(2100.0, [0.0, 1.0, 0.0]));
}

#[test]
fn what_is_seen_of_clouds_changes_evenly_as_an_eye_rises_through_them() {
    let (sky, clouds) = clouds(0.6);
    let clouds = clouds.expect("some");
    for direction in [[0.0, 0.9, 0.1], [0.5, 0.5, -0.2], [-0.7, 0.2, 0.5]].map(unit) {
        let at = |metres: usize| {
            let ray = Ray { from: [0.0, 0.0, 1600.0 + 0.1 * metres as f32], direction };
            clouds.before((&sky, haze()), &ray, 0.001).open
        };
        let most = (1..12_000).map(|metres| (at(metres) - at(metres - 1)).abs()).fold(0.0, f32::max);
        assert!(most < 0.03, "a leap of {most} in a decimetre along {direction:?}");
    }
}
