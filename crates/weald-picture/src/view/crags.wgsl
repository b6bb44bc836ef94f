// Twin of `crags.rs`: ridges and gullies that are finer than cells.

const CRAG_CELLS = 4.0;
const CRAG_OCTAVES = 5u;
const CRAG_GAIN = 0.65;
const CRAG_SHARP = 0.004;
const CRAG_MEAN = 0.21;
const CRAG_LEAST = 0.08;

// Height in metres over the side of a cell, above 0 on ridges, and slope eastward and northward.
struct Crags {
    height: f32,
    slope: vec2<f32>,
}

// On a plane of which so large a share is seen: height, and slopes along it.
fn crags_on(plane: vec2<f32>, share: f32, cell: f32, footprint: f32, seed: u32) -> vec3<f32> {
    var sum = vec3<f32>(0.0);
    var strength = share;
    var wavelength = CRAG_CELLS * cell;
    var place = plane;
    var turn = vec2<f32>(1.0, 0.0);
    for (var octave = 0u; octave < CRAG_OCTAVES; octave++) {
        let seen = strength * grain_visible(footprint, wavelength);
        if seen <= 0.0 {
            break;
        }
        let here = grain(place / wavelength, seed + octave * 0x9e3779b9u);
        let sharp = sqrt(here.value * here.value + CRAG_SHARP);
        let slope = -seen * here.value * cell / (sharp * wavelength) * here.slope;
        sum += vec3<f32>(
            seen * (CRAG_MEAN - sharp), turn.x * slope.x - turn.y * slope.y, turn.y * slope.x + turn.x * slope.y,
        );
        place = vec2<f32>(0.8 * place.x + 0.6 * place.y, 0.8 * place.y - 0.6 * place.x);
        turn = vec2<f32>(0.8 * turn.x - 0.6 * turn.y, 0.8 * turn.y + 0.6 * turn.x);
        strength *= CRAG_GAIN;
        wavelength *= 0.5;
    }
    return sum;
}

// On ground that rises so eastward and northward.
fn crags_at(point: vec3<f32>, rise: vec2<f32>, cell: f32, footprint: f32) -> Crags {
    let squares = vec3<f32>(rise * rise, 1.0);
    let facing = squares * squares;
    let faced = max(facing / (facing.x + facing.y + facing.z) - CRAG_LEAST, vec3<f32>(0.0));
    let shares = faced / (faced.x + faced.y + faced.z);
    let planes = array<vec2<f32>, 3>(point.yz, point.xz, point.xy);
    var sums: array<vec3<f32>, 3>;
    for (var plane = 0; plane < 3; plane++) {
        sums[plane] = crags_on(planes[plane], shares[plane], cell, footprint, 0x13u + u32(plane));
    }
    // What stands out of an upright plane is higher by what the ground rises there.
    let upward = sums[0].z + sums[1].z;
    let level = vec2<f32>(sums[1].y + sums[2].y, sums[0].y + sums[2].z);
    return Crags(sums[0].x + sums[1].x + sums[2].x, level + upward * rise);
}
