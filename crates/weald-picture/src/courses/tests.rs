//! Courses of rivers on flow and ground whose valleys are known.

use super::*;
use weald_core::domain::Domain;
use weald_core::grid::Field;

type Place = [f32; 2];

const SIDE: usize = 128;

fn plus([a, b]: Place, [c, d]: Place, times: f32) -> Place {
    [a + times * c, b + times * d]
}

fn dot([a, b]: Place, [c, d]: Place) -> f32 {
    a * c + b * d
}

fn direction(degrees: f32) -> Place {
    let radians = degrees.to_radians();
    [libm::cosf(radians), libm::sinf(radians)]
}

/// Place from the middle of the grid on axes that are turned.
fn turned(place: Place, degrees: f32) -> Place {
    let [x, y] = [place[0] - 0.5 * SIDE as f32, place[1] - 0.5 * SIDE as f32];
    let [cosine, sine] = direction(degrees);
    [x * cosine + y * sine, y * cosine - x * sine]
}

/// Rivers of a flow that is known everywhere, through the faces of the cells.
fn rivers_of(flow: impl Fn(Place) -> Place) -> Vec<Vec<Reach>> {
    let size = Size::square(SIDE).expect("small");
    let at = |x: usize, y: usize, face: Place| flow(plus([x as f32, y as f32], face, 1.0));
    let east = Field::from_function(size, |x, y| at(x, y, [1.0, 0.5])[0]);
    let south = Field::from_function(size, |x, y| at(x, y, [0.5, 1.0])[1]);
    courses(&Drainage::of([&east, &south], &Domain::new(size, 1.0)), least_area(size))
}

/// Flow of an inclined plane with a valley through the middle: rain runs down both sides, 30 cells long, into a river.
fn valley(place: Place, degrees: f32) -> Place {
    const SLOPE_LENGTH: f32 = 30.0;
    let [along, away] = turned(place, degrees);
    let sheet = (SLOPE_LENGTH - away.abs()).max(0.0);
    let [down, across] = [0.5 * sheet, -0.8 * sheet * away.signum() * (away.abs() / 2.0).min(1.0)];
    let river = 2.0 * SLOPE_LENGTH * (along + SIDE as f32);
    let down = down + river * libm::expf(-away * away) / std::f32::consts::PI.sqrt();
    let [cosine, sine] = direction(degrees);
    [down * cosine - across * sine, down * sine + across * cosine]
}

#[test]
fn a_river_lies_in_its_valley_and_runs_as_it_runs_whatever_the_angle() {
    for step in 0..10 {
        let degrees = 3.0 + 36.7 * step as f32;
        let rivers = rivers_of(|place| valley(place, degrees));
        assert_eq!(rivers.len(), 1, "at {degrees}°");
        let inner: Vec<Place> = rivers[0]
            .iter()
            .map(|reach| turned(reach.place, degrees))
            .filter(|[along, _]| along.abs() < 50.0)
            .collect();
        assert!(inner.len() > 65);
        for pair in inner.windows(5) {
            let run = plus(pair[4], pair[0], -1.0);
            let off = libm::atan2f(run[1], run[0]).to_degrees();
            assert!(pair[0][1].abs() < 0.5, "{} cells from the valley at {degrees}°", pair[0][1]);
            assert!(off.abs() < 2.0, "{off}° from the valley at {degrees}°");
        }
    }
}

#[test]
fn a_river_of_many_cells_width_is_one_line_along_its_middle() {
    for width in [1.5, 3.0, 6.0, 10.0] {
        let depth = |away: f32| (1.0 - (2.0 * away / width) * (2.0 * away / width)).max(0.0);
        let rivers = rivers_of(|[x, y]| [0.01, depth(x - 64.4) * (10.0 + y)]);
        assert_eq!(rivers.len(), 1, "{width} cells wide");
        assert!(rivers[0].len() > 110 && rivers[0].iter().all(|reach| (reach.place[0] - 64.4).abs() < 1.0));
    }
}

#[test]
fn a_plane_without_valleys_has_no_rivers_whatever_its_angle() {
    for step in 0..10 {
        let [cosine, sine] = direction(36.7 * step as f32);
        let sheet = |place: Place| 10.0 * (dot(place, [cosine, sine]) + 2.0 * SIDE as f32);
        assert_eq!(rivers_of(|place| [cosine * sheet(place), sine * sheet(place)]), Vec::<Vec<Reach>>::new());
        let rough = |place: Place| 1.0 + 0.3 * libm::sinf(2.1 * place[0]) * libm::cosf(1.7 * place[1]);
        let rivers = rivers_of(|place| [cosine, sine].map(|it| it * sheet(place) * rough(place)));
        assert_eq!(rivers, Vec::<Vec<Reach>>::new());
    }
}

/// Flow that comes from the west into a whirl round the middle, 12 cells from it, and there further and further in.
fn into_a_whirl(place: Place, inward: f32) -> Place {
    let [x, y] = turned(place, 20.0);
    let away = dot([x, y], [x, y]).sqrt().max(1.0);
    let strength = 2000.0 * libm::expf(-(away - 12.0) * (away - 12.0) / 3.0);
    let [round, in_] = [[y / away, -x / away], [-x / away, -y / away]];
    let whirl = plus([round[0] * strength, round[1] * strength], in_, inward * strength);
    let feeds =
        if x < 0.0 && away > 11.0 { 1000.0 * libm::expf(-(y - 12.0) * (y - 12.0) / 2.0) } else { 0.0 };
    turned(plus(plus(whirl, [feeds, 0.0], 1.0), [0.5 * SIDE as f32; 2], 1.0), -20.0)
}

#[test]
fn a_river_that_ends_in_a_whirl_does_not_curl() {
    for inward in [0.0, 0.1, 0.3] {
        let rivers = rivers_of(|place| into_a_whirl(place, inward));
        assert!(!rivers.is_empty());
        for river in rivers {
            let turn = |three: &[Reach]| {
                let [a, b] = [0, 1].map(|at| plus(three[at + 1].place, three[at].place, -1.0));
                libm::atan2f(a[0] * b[1] - a[1] * b[0], dot(a, b))
            };
            let turns: f32 = river.windows(3).map(turn).sum();
            assert!(turns.abs() < 5.0, "turns by {turns} in all");
            assert_eq!(crossings(&[river]), 0);
        }
    }
}

/// Heights of a winding valley with tributaries, all with round floors, on axes from the middle.
fn valleys([along, away]: Place) -> f32 {
    let sides = |away: f32| 0.35 * ((away * away + 16.0).sqrt() - 4.0);
    let bend = |along: f32| 6.0 * libm::sinf(along / 18.0);
    let trunk = sides(away - bend(along)) - 0.12 * along;
    let tributaries = [(-40.0, 1.1), (-22.0, -0.8), (5.0, 0.9), (24.0, -1.2)].map(|(joins, slant)| {
        let up = (away - bend(joins)) * f32::signum(slant);
        let aside = along - joins + up * slant.abs() * 0.7;
        let floor = 0.2 * up - 0.12 * joins;
        if up > 0.0 { floor + sides(aside) } else { f32::INFINITY }
    });
    tributaries.into_iter().fold(trunk, f32::min)
}

/// Flow over heights where it rains evenly: each cell gives to all lower neighbours by their slope (Freeman 1991).
fn flow_over(height: &Field) -> Vec<Place> {
    let size = height.size();
    let mut order: Vec<usize> = (0..size.cells()).collect();
    order.sort_by(|&a, &b| height.values()[b].total_cmp(&height.values()[a]));
    let (mut passing, mut vector) = (vec![1.0_f32; size.cells()], vec![[0.0; 2]; size.cells()]);
    for cell in order {
        let step = |other: usize| plus(centre(size, other), centre(size, cell), -1.0);
        let slope =
            |other: usize| (height.values()[cell] - height.values()[other]) / distance(step(other), [0.0; 2]);
        let lower: Vec<(usize, f32)> = size
            .neighbours(cell)
            .map(|other| (other, slope(other)))
            .filter(|it| it.1 > 0.0)
            .map(|(other, slope)| (other, libm::powf(slope, 1.1)))
            .collect();
        let all: f32 = lower.iter().map(|it| it.1).sum();
        for (other, share) in lower {
            let given = passing[cell] * share / all;
            passing[other] += given;
            for end in [cell, other] {
                vector[end] = plus(vector[end], step(other), 0.5 * given);
            }
        }
    }
    vector
}

fn rivers_over(height: impl Fn(Place) -> f32) -> Vec<Vec<Reach>> {
    let size = Size::square(SIDE).expect("small");
    let height = Field::from_function(size, |x, y| height([x as f32 + 0.5, y as f32 + 0.5]));
    let vector = flow_over(&height);
    let face = |axis: usize| {
        Field::from_function(size, |x, y| {
            let next = [(x + 1 - axis).min(SIDE - 1), (y + axis).min(SIDE - 1)];
            0.5 * (vector[size.index(x, y)][axis] + vector[size.index(next[0], next[1])][axis])
        })
    };
    let (east, south) = (face(0), face(1));
    courses(&Drainage::of([&east, &south], &Domain::new(size, 1.0)), least_area(size))
}

/// Distance of a place from a piece of a river.
fn from_piece(place: Place, piece: &[Reach]) -> f32 {
    let [long, offset] = [piece[1].place, place].map(|it| plus(it, piece[0].place, -1.0));
    let share = (dot(offset, long) / dot(long, long)).clamp(0.0, 1.0);
    distance(offset, [share * long[0], share * long[1]])
}

#[test]
fn rivers_do_not_know_how_the_grid_is_turned() {
    let turns = [0.0, 22.5];
    let [straight, askew] = turns.map(|degrees| {
        let mut rivers = rivers_over(|place| valleys(turned(place, degrees)));
        assert_eq!(rivers.len(), 5, "a trunk and its tributaries at {degrees}°");
        rivers.iter_mut().flatten().for_each(|reach| reach.place = turned(reach.place, degrees));
        rivers
    });
    for (those, others) in [(&straight, &askew), (&askew, &straight)] {
        let is_inner = |reach: &&Reach| distance(reach.place, [0.0; 2]) < 50.0 && reach.area > 1500.0;
        let inner: Vec<&Reach> = those.iter().flatten().filter(is_inner).collect();
        assert!(inner.len() > 200);
        for reach in inner {
            let pieces = others.iter().flat_map(|river| river.windows(2));
            let away = pieces.map(|piece| from_piece(reach.place, piece)).fold(f32::INFINITY, f32::min);
            assert!(away < 1.0, "{away} cells between the rivers at {:?}", reach.place);
        }
    }
}

#[test]
fn rivers_widen_downstream_and_end_on_others_without_crossing_any() {
    for degrees in [0.0, 22.5, 40.0, 77.0] {
        let rivers = rivers_over(|place| valleys(turned(place, degrees)));
        assert!(rivers.len() >= 5 && crossings(&rivers) == 0, "at {degrees}°");
        for (at, river) in rivers.iter().enumerate() {
            assert!(river.windows(2).all(|pair| pair[0].area <= pair[1].area), "at {degrees}°");
            let end = river[river.len() - 1];
            let is_out = end.place.iter().any(|&it| it == 0.0 || (it - SIDE as f32).abs() < 1.0e-3);
            let mut trunks = rivers[..at].iter().flat_map(|river| river.windows(2));
            let trunk = trunks.find(|piece| from_piece(end.place, piece) < 1.0e-3);
            assert!(is_out || trunk.is_some_and(|trunk| trunk[1].area >= end.area), "{end:?} at {degrees}°");
        }
    }
}

/// How often pieces of rivers cross that do not share an end.
fn crossings(rivers: &[Vec<Reach>]) -> usize {
    let pieces: Vec<[Place; 2]> =
        rivers.iter().flat_map(|river| river.windows(2)).map(|pair| [pair[0].place, pair[1].place]).collect();
    let side = |[from, to]: [Place; 2], place: Place| {
        let [a, b] = [plus(to, from, -1.0), plus(place, from, -1.0)];
        a[0] * b[1] - a[1] * b[0]
    };
    let cross = |a: [Place; 2], b: [Place; 2]| {
        side(a, b[0]) * side(a, b[1]) < 0.0 && side(b, a[0]) * side(b, a[1]) < 0.0
    };
    let pairs = pieces.iter().enumerate().flat_map(|(at, a)| pieces[..at].iter().map(move |b| (a, b)));
    pairs.filter(|(a, b)| cross(**a, **b)).count()
}

/// Southward flow of `discharge` at a row, spread over so many cells there.
fn fan(discharge: impl Fn(f32) -> f32, width: impl Fn(f32) -> f32) -> Vec<Vec<Reach>> {
    rivers_of(|[x, y]| {
        let away = (x - 64.4) / width(y);
        [0.01 * (64.4 - x), discharge(y) * libm::expf(-away * away) / width(y)]
    })
}

#[test]
fn a_river_that_spreads_on_a_fan_goes_on_to_where_it_is_a_channel_again() {
    let width = |y: f32| 1.0 + 15.0 * (1.0 - (y - 64.0).abs() / 24.0).max(0.0);
    let rivers = fan(|y| 100.0 * (10.0 + y), width);
    assert_eq!(rivers.len(), 1, "{:?}", rivers.iter().map(Vec::len).collect::<Vec<_>>());
    assert!(rivers[0].len() > 110, "{}", rivers[0].len());
    assert!(rivers[0].windows(2).all(|pair| pair[0].area <= pair[1].area), "it carries what it carried");
}

#[test]
fn a_river_that_runs_dry_ends() {
    let dry = |y: f32| 100.0 * (10.0 + y) * (1.0 - (y - 40.0) / 30.0).clamp(0.001, 1.0);
    let rivers = fan(dry, |y| 1.0 + (y - 40.0).clamp(0.0, 20.0));
    let lowest = rivers.iter().flatten().map(|reach| reach.place[1]).fold(0.0, f32::max);
    assert!((45.0..90.0).contains(&lowest), "it ends in row {lowest}");
}
