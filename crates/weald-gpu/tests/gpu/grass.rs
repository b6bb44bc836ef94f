//! Grass grows on a device as on the CPU.

use crate::programs::gpu;
use weald::grow::grass::{BLADES, Bend, Blade, Grasses, Instance, Packed, SPECIES, Set, Vertex};
use weald::random::{splitmix64, unit};
use weald_gpu::grow_blades;

const INPUTS: u64 = 10_000;

/// How far a vertex may be from the CPU's, as a share of its species' greatest height. Both sum a dozen products of
/// numbers up to that height; a driver may fuse them, and divide and take roots to a few units of 2⁻²⁴.
const APART: f32 = 1e-5;

/// How far a normal may be from the CPU's: slopes are differences of points that lie close together where a blade hardly
/// grows.
const TURNED: f32 = 1e-3;

/// A random number from 0 to 1 that is 0 or 1 now and then, as maps are.
fn share(number: u64, purpose: u64) -> f32 {
    let bits = splitmix64(number ^ splitmix64(purpose));
    match bits % 16 {
        0 => 0.0,
        1 => 1.0,
        _ => unit(bits) as f32,
    }
}

fn input(number: u64) -> (Packed, [f32; 4]) {
    let share = |purpose| share(number, purpose);
    let set = Set {
        soil: share(0),
        light: share(1),
        level: 4.0 * share(2),
        cut: share(3).max(0.3),
        trodden: (share(4) - 0.5).max(0.0),
        seed: (65536.0 * share(5)) as u32 & 0xffff,
    };
    let species = (SPECIES.len() as f32 * share(6)).min(4.0) as u32;
    let instance = Instance { place: [1000.0 * share(7), 1000.0 * share(8)], species, tuft: set };
    let number = (2.0 * BLADES as f32 * share(9)).min(11.0).floor();
    let windy = if share(10) < 0.5 { 1.0 } else { 0.0 };
    (instance.pack(), [number, share(11), windy * (share(12) - 0.5), windy * (share(13) - 0.5)])
}

fn on_the_cpu(packed: Packed, [number, along, east, south]: [f32; 4], bend: Bend) -> (Vertex, f32) {
    let instance = Instance::unpack(packed);
    let species = &SPECIES[instance.species as usize];
    let number = number as u32;
    let blade = Blade::of(species, &instance.tuft, number / 2, bend);
    let side = if number.is_multiple_of(2) { -1.0 } else { 1.0 };
    (blade.swayed(&blade.vertex(along, side), [east, south]), species.top())
}

fn farthest(ones: [f32; 3], others: [f32; 3]) -> f32 {
    (0..3).map(|i| (ones[i] - others[i]).abs()).fold(0.0, f32::max)
}

#[test]
fn ten_thousand_vertices_of_all_species_are_those_of_the_cpu() {
    let Some(gpu) = gpu() else { return };
    let (sets, corners): (Vec<_>, Vec<_>) = (0..INPUTS).map(input).unzip();
    for bend in [Bend::Total, Bend::Printed] {
        let found = grow_blades(&gpu, &Grasses::new(&SPECIES, bend), &sets, &corners).expect("grown");
        assert_eq!(found.len() as u64, INPUTS);
        let (mut apart, mut turned, mut heads, mut high) = (0.0_f32, 0.0_f32, 0, 0);
        for (number, vertex) in found.iter().enumerate() {
            let (cpu, top) = on_the_cpu(sets[number], corners[number], bend);
            apart = apart.max(farthest(vertex.place, cpu.place) / top);
            turned = turned.max(farthest(vertex.normal, cpu.normal));
            assert!((vertex.blend - cpu.blend).abs() < 1e-6 && (vertex.head - cpu.head).abs() < 1e-4);
            heads += usize::from(vertex.head > 0.5);
            high += usize::from(vertex.place[1] > 0.1 * top);
        }
        println!("{bend:?}: off by {apart:.1e} of the height, normals by {turned:.1e}");
        assert!(heads > 100 && high > 500, "{heads} in heads, {high} high: else agreement would mean little");
        assert!(apart <= APART, "{apart:e}");
        assert!(turned <= TURNED, "{turned:e}");
    }
}
