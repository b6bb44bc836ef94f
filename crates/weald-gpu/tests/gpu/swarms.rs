//! Fractals on a device have the digits of the CPU, its points to rounding, and sway as there.

use crate::programs::{gpu, refusal};
use weald::grow::ifs::device::digits_on_a_device;
use weald::grow::ifs::game::CHUNK;
use weald::grow::ifs::map::Map;
use weald::grow::ifs::wind::Wind;
use weald::grow::ifs::{Code, Draft, Game, Ifs, Pose, Role, Sway, Weighted, shapes};
use weald_gpu::{PointCloud, PointRates, SwayingPoints};

/// How far points may be from the CPU's, as a share of the fractal's diameter. A segment forgets where it began to
/// 2⁻²⁵, and a driver may fuse products with sums: each step then rounds a few units of 2⁻²⁴ otherwise, of which maps that
/// keep 0.95 leave twenty steps' worth.
const POINTS: f64 = 4e-6;

/// The same for swayed points: up to 24 turns, one after the other, each of which rounds some units of 2⁻²⁴.
const SWAYED: f32 = 1e-5;

/// All with a stem.
const PLANTS: [&str; 8] =
    ["fern", "cyclosorus", "culcita", "fishbone", "tree", "shrub", "fern-3d", "conifer"];

fn ifs(name: &str) -> Ifs {
    shapes::find(name).expect("built in").ifs()
}

/// A ring of so many small copies of itself, in space.
fn ring(maps: usize) -> Ifs {
    let map = |number: usize| {
        let angle = std::f64::consts::TAU * number as f64 / maps as f64;
        let (x, y) = (angle.cos(), angle.sin());
        let map = Map::spatial([
            [0.2 * x, -0.2 * y, 0.0, x],
            [0.2 * y, 0.2 * x, 0.05, y],
            [0.0, 0.1, 0.3, 0.2 * x * y],
        ]);
        Weighted { map, probability: 1.0 / maps as f64, role: Role::Branch }
    };
    let draft = Draft { name: "ring".to_owned(), maps: (0..maps).map(map).collect(), code_digits: None };
    Ifs::new(draft).expect("a fractal")
}

fn on_the_cpu(ifs: &Ifs, seed: u64, count: u64) -> Vec<([f32; 3], Code)> {
    let mut points = Vec::new();
    Game::new(ifs, seed).points(count, |block| {
        points.extend((0..block.len()).map(|i| (block.point(i), block.code(i, ifs))));
    });
    points
}

fn apart(a: [f32; 3], b: [f32; 3]) -> f32 {
    (0..3).map(|i| (a[i] - b[i]).powi(2)).sum::<f32>().sqrt()
}

fn farthest(ones: &[[f32; 3]], others: &[[f32; 3]]) -> f32 {
    assert_eq!(ones.len(), others.len());
    ones.iter().zip(others).map(|(&one, &other)| apart(one, other)).fold(0.0, f32::max)
}

fn squall() -> impl Iterator<Item = Pose> {
    let wind = Wind { speed: 25.0, gusts: 1.0, direction_deg: 30.0, ..Wind::default() };
    (0..4).map(move |frame| wind.pose(0.7 * f64::from(frame)))
}

/// Asserts that a device has the points of the CPU, and returns the worst distance as a share of the diameter.
fn assert_same(ifs: &Ifs, seed: u64, count: u64, (points, codes): (&[[f32; 3]], Option<&[Code]>)) -> f64 {
    let cpu = on_the_cpu(ifs, seed, count);
    assert_eq!(points.len() as u64, count);
    if let Some(codes) = codes {
        let length = digits_on_a_device(ifs);
        for (number, (found, (_, code))) in codes.iter().zip(&cpu).enumerate() {
            assert_eq!(*found, code.prefix(length), "{} {number}", ifs.name());
        }
        assert_eq!(codes.len() as u64, count);
    }
    let cpu: Vec<_> = cpu.into_iter().map(|(point, _)| point).collect();
    let worst = f64::from(farthest(points, &cpu)) / ifs.diameter();
    assert!(worst <= POINTS, "{}: {worst:e} of {} points", ifs.name(), count);
    worst
}

#[test]
fn a_device_takes_the_digits_of_the_cpu_to_the_bit_and_its_points_to_rounding() {
    let Some(gpu) = gpu() else { return };
    let mut sizes = Vec::new();
    let built_in = shapes::SHAPES.iter().map(shapes::Shape::ifs);
    for ifs in built_in.chain([ring(5), ring(8), ring(20), ring(256)]) {
        let count = 20_011;
        let mut swaying = SwayingPoints::new(&gpu, &ifs, 7, count).expect("played");
        let (points, codes) = (swaying.points().expect("read"), swaying.codes().expect("read"));
        let across = points.iter().map(|&point| apart(point, points[0])).fold(0.0, f32::max);
        assert!(f64::from(across) > 0.3 * ifs.diameter(), "{}: all within {across}", ifs.name());
        let worst = assert_same(&ifs, 7, count, (&points, Some(&codes)));
        println!("{} of {} maps: {worst:.1e}", ifs.name(), ifs.maps().len());
        sizes.push((ifs.maps().len(), ifs.is_planar()));
    }
    for size in [(2, true), (3, true), (4, true), (5, true), (8, true), (4, false), (5, false), (8, false)] {
        assert!(sizes.contains(&size), "{size:?}");
    }
}

#[test]
fn any_number_of_points_of_any_seed_is_the_beginning_of_the_same_game() {
    let Some(gpu) = gpu() else { return };
    for (name, seed, count) in
        [("fern", 0, 1), ("gasket", 1, 63), ("crown", 2, 4097), ("fern", u64::MAX, CHUNK + 12_345)]
    {
        let ifs = ifs(name);
        let mut cloud = PointCloud::new(&gpu, &ifs, seed, count).expect("played");
        assert_eq!((cloud.len(), cloud.is_empty()), (count, false));
        let points = cloud.points().expect("read");
        assert_same(&ifs, seed, count, (&points, None));
        let mut swaying = SwayingPoints::new(&gpu, &ifs, seed, count).expect("played");
        assert!(swaying.points().expect("read") == points, "codes change no point");
        assert_same(&ifs, seed, count, (&points, Some(&swaying.codes().expect("read"))));
    }
    let mut none = SwayingPoints::new(&gpu, &ifs("fern"), 1, 0).expect("nothing to do");
    none.sway(&Pose::calm()).expect("nothing to do");
    assert!(none.is_empty() && none.swayed().expect("nothing").is_empty());
}

#[test]
fn a_squall_puts_points_where_the_cpu_does() {
    let Some(gpu) = gpu() else { return };
    for name in PLANTS {
        let ifs = ifs(name);
        let (sway, size) = (Sway::of(&ifs), ifs.diameter() as f32);
        let mut swaying = SwayingPoints::new(&gpu, &ifs, 5, 5003).expect("played");
        let (rests, codes) = (swaying.points().expect("read"), swaying.codes().expect("read"));
        let (mut moved, mut worst, mut before) = (0.0_f32, 0.0_f32, rests.clone());
        for pose in squall() {
            swaying.sway(&pose).expect("swayed");
            let swayed = swaying.swayed().expect("read");
            let cpu: Vec<_> = rests
                .iter()
                .zip(&codes)
                .map(|(&rest, code)| sway.at(&pose, rest, |place| code.digit(place)))
                .collect();
            assert!(farthest(&swayed, &before) > 1e-3 * size, "{name}: each pose is another");
            moved = moved.max(farthest(&swayed, &rests));
            worst = worst.max(farthest(&swayed, &cpu));
            before = swayed;
        }
        println!("{name}: moved {:.2}, off by {:.1e} of its size", moved / size, worst / size);
        assert!(moved > 0.1 * size, "{name} moved by {moved}, so agreement would mean nothing");
        assert!(worst <= SWAYED * size, "{name}: {worst}");
        assert!(swaying.points().expect("read") == rests, "{name}: rest stays");
    }
}

#[test]
fn calm_keeps_the_bits_of_all_points() {
    let Some(gpu) = gpu() else { return };
    for name in PLANTS {
        let mut swaying = SwayingPoints::new(&gpu, &ifs(name), 5, 5003).expect("played");
        let rests = swaying.points().expect("read");
        assert!(swaying.swayed().expect("read") == rests, "{name}: as it was made");
        swaying.sway(&squall().last().expect("four")).expect("swayed");
        assert!(swaying.swayed().expect("read") != rests, "{name}: moved");
        swaying.sway(&Pose::calm()).expect("swayed");
        assert!(swaying.swayed().expect("read") == rests, "{name}: calm");
    }
}

/// All joints on the way to some points: the place at rest with the code of what holds it, and with that of what hangs.
fn joints(ifs: &Ifs) -> [Vec<([f32; 3], Code)>; 2] {
    assert_eq!(ifs.maps()[0].role, Role::Stem, "codes that end go on with a stem, which does not turn");
    let mut sides = [Vec::new(), Vec::new()];
    for (_, code) in on_the_cpu(ifs, 11, 400) {
        let turning =
            code.digits().take(20).take_while(|&digit| ifs.maps()[usize::from(digit)].role != Role::Stem);
        for place in 0..turning.count() {
            let [held, hangs] = [code.prefix(place), code.prefix(place + 1)];
            let joint = ifs.part(&hangs).at(ifs.root()).map(|x| x as f32);
            sides[0].push((joint, held));
            sides[1].push((joint, hangs));
        }
    }
    sides
}

#[test]
fn joints_never_part_on_a_device() {
    let Some(gpu) = gpu() else { return };
    for name in PLANTS {
        let ifs = ifs(name);
        let size = ifs.diameter() as f32;
        let [held, hangs] = joints(&ifs).map(|side| SwayingPoints::of(&gpu, &ifs, &side).expect("uploaded"));
        let mut sides = [held, hangs];
        let rests = sides[0].points().expect("read");
        assert!(rests.len() > 400, "{name}: {} joints", rests.len());
        let (mut moved, mut gap) = (0.0_f32, 0.0_f32);
        for pose in squall() {
            let [held, hangs] = sides.each_mut().map(|side| {
                side.sway(&pose).expect("swayed");
                side.swayed().expect("read")
            });
            moved = moved.max(farthest(&held, &rests));
            gap = gap.max(farthest(&held, &hangs));
        }
        println!("{name}: joints moved {:.2}, parted by {:.1e} of its size", moved / size, gap / size);
        assert!(moved > 0.05 * size, "{name}: joints moved by {moved}");
        assert!(gap <= 4e-6 * size, "{name}: {gap}");
    }
}

#[test]
fn points_in_pieces_and_in_many_submissions_are_the_same() {
    let Some(gpu) = gpu() else { return };
    let (ifs, count, pose) = (ifs("fern"), CHUNK + 5000, squall().last().expect("four"));
    let all = |gpu: &weald_gpu::Gpu| {
        let mut swaying = SwayingPoints::new(gpu, &ifs, 3, count).expect("played");
        swaying.sway(&pose).expect("swayed");
        (swaying.points().expect("read"), swaying.codes().expect("read"), swaying.swayed().expect("read"))
    };
    let whole = all(&gpu);
    let small = gpu.clone().with_memory(32 << 20).expect("enough");
    assert!(all(&small) == whole, "two pieces");
    assert!(small.peak() > 48 * count && small.peak() <= 32 << 20);
    assert_eq!(small.allocated(), 0);
    assert!(all(&gpu.moving_at_most(3_000_000)) == whole, "submissions of three megabytes");
}

#[test]
fn a_swarm_that_does_not_fit_is_refused_before_anything_is_made() {
    let Some(gpu) = gpu() else { return };
    let (gpu, ifs) = (gpu.with_memory(8 << 20).expect("enough"), ifs("fern"));
    for count in [200_000, u64::MAX] {
        let message = refusal(SwayingPoints::new(&gpu, &ifs, 1, count));
        assert!(message.contains(&format!("a swaying cloud of {count} points")), "{message}");
        assert!(message.contains("--gpu-memory"), "{message}");
    }
    assert!(gpu.peak() < 1 << 20 && gpu.allocated() == 0, "{} bytes", gpu.peak());
    let mut cloud = PointCloud::new(&gpu, &ifs, 1, 200_000).expect("points alone fit");
    assert_eq!(cloud.points().expect("read").len(), 200_000);
}

#[test]
fn every_call_to_a_swaying_cloud_of_a_lost_device_says_so() {
    if gpu().is_none() {
        return;
    }
    let gpu = weald_gpu::Gpu::any().expect("a device of its own");
    let fern = ifs("fern");
    let mut swaying = SwayingPoints::new(&gpu, &fern, 1, 1000).expect("played");
    gpu.lose();
    let calls = [
        ("sway", swaying.sway(&Pose::calm())),
        ("points", swaying.points().map(drop)),
        ("codes", swaying.codes().map(drop)),
        ("swayed", swaying.swayed().map(drop)),
        ("swaying", SwayingPoints::new(&gpu, &fern, 1, 1000).map(drop)),
        ("cloud", PointCloud::new(&gpu, &fern, 1, 1000).map(drop)),
        ("rates", PointRates::of(&gpu, &fern).map(drop)),
    ];
    for (call, result) in calls {
        let message = refusal(result);
        assert!(message.contains("the GPU was lost"), "{call}: {message}");
    }
}
