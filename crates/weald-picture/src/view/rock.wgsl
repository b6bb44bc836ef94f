// Twin of `rock.rs`: beds of rock where they are seen.

const BED_DIP = 0.14;
const BED_DIP_TOWARDS = vec2<f32>(0.8, -0.6);
const BED_FACE = 0.72;

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

fn bed_tone(bed: f32, seed: u32) -> f32 {
    return f32(grain_bits(i32(bed), 5, seed) >> 8u) / 16777216.0 - 0.5;
}

// How much deeper in the pile of beds that dip a place is, in metres.
fn bed_dip(place: vec2<f32>) -> f32 {
    return BED_DIP * dot(BED_DIP_TOWARDS, place);
}

// The beds at a point; level ones where they do not dip.
fn beds_at(spot: BedSpot, dips: bool, seed: u32) -> Beds {
    let dip = select(0.0, bed_dip(spot.point.xy), dips);
    let level = (spot.point.z + dip) / spot.thickness + spot.fold;
    let number = floor(level);
    let within = level - number;
    let blur = spot.footprint / spot.thickness;
    let seen = 1.0 - ramp(blur, 0.25, 0.8);
    let edge = ramp(within, 0.0, clamp(1.5 * blur, 0.06, 0.5));
    let deep = abs(bed_tone(number + 1000.0, seed)) + 0.5;
    return Beds(
        seen * mix(bed_tone(number - 1.0, seed), bed_tone(number, seed), edge),
        seen * deep * (1.0 - ramp(within, 0.0, 0.16 + blur)),
        seen * (0.4 - 1.4 * ramp(within, BED_FACE - 0.08, BED_FACE + 0.08)),
    );
}
