// Twin of `rock.rs`: beds of rock where they are seen.

const BED_DIP = 0.14;
const BED_DIP_TOWARDS = vec2<f32>(0.8, -0.6);
const BED_FACE = 0.72;
const BED_UNEVEN = 0.85;

struct Beds {
    tone: f32,
    joint: f32,
    ledge: f32,
}

struct BedSpot {
    point: vec3<f32>,
    fold: f32,
    thickness: f32,
    footprint: f32,
}

// A number of a bed by chance, from -0.5 to 0.5.
fn bed_chance(bed: f32, what: i32, seed: u32) -> f32 {
    return f32(grain_bits(i32(bed), what, seed) >> 8u) / 16777216.0 - 0.5;
}

fn bed_tone(bed: f32, seed: u32) -> f32 {
    return bed_chance(bed, 5, seed);
}

// Where a bed begins, in mean beds.
fn bed_begins(bed: f32, seed: u32) -> f32 {
    return bed + BED_UNEVEN * bed_chance(bed, 7, seed);
}

// Which bed lies at a level, where it begins there, and how thick it is beside the mean one.
fn bed_at(level: f32, seed: u32) -> vec3<f32> {
    let middle = floor(level);
    let above = select(middle, middle + 1.0, level >= bed_begins(middle + 1.0, seed));
    let number = select(above, middle - 1.0, level < bed_begins(middle, seed));
    let first = bed_begins(number, seed);
    return vec3<f32>(number, first, bed_begins(number + 1.0, seed) - first);
}

// How much deeper in the pile of beds that dip a place is, in metres.
fn bed_dip(place: vec2<f32>) -> f32 {
    return BED_DIP * dot(BED_DIP_TOWARDS, place);
}

// The beds at a point; level ones where they do not dip.
fn beds_at(spot: BedSpot, dips: bool, seed: u32) -> Beds {
    let dip = select(0.0, bed_dip(spot.point.xy), dips);
    let level = (spot.point.z + dip) / spot.thickness + spot.fold;
    let bed = bed_at(level, seed);
    let number = bed.x;
    let within = (level - bed.y) / bed.z;
    let blur = spot.footprint / (bed.z * spot.thickness);
    let seen = 1.0 - ramp(blur, 0.25, 0.8);
    let edge = ramp(within, 0.0, clamp(1.5 * blur, 0.06, 0.5));
    let deep = abs(bed_tone(number + 1000.0, seed)) + 0.5;
    return Beds(
        seen * mix(bed_tone(number - 1.0, seed), bed_tone(number, seed), edge),
        seen * deep * (1.0 - ramp(within, 0.0, 0.16 + blur)),
        seen * (0.4 - 1.4 * ramp(within, BED_FACE - 0.08, BED_FACE + 0.08)),
    );
}
