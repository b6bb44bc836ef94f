// Twin of `crags.rs`: ridges and gullies that are finer than cells.

const CRAG_CELLS = 4.0;
const CRAG_OCTAVES = 5u;
const CRAG_GAIN = 0.65;
const CRAG_SEED = 0x13u;
const CRAG_SHARP = 0.0015;
const CRAG_MEAN = 0.18;

// Height in metres over the side of a cell, above 0 on ridges, and slope eastward and northward.
struct Crags {
    height: f32,
    slope: vec2<f32>,
}

// On ground that rises so eastward and northward.
fn crags_at(point: vec3<f32>, rise: vec2<f32>, cell: f32, footprint: f32) -> Crags {
    var sum = Crags(0.0, vec2<f32>(0.0));
    var strength = 1.0;
    var wavelength = CRAG_CELLS * cell;
    var place = point;
    var turn = vec2<f32>(1.0, 0.0);
    var seen = grain_visible(footprint, wavelength);
    if seen <= 0.0 {
        return sum;
    }
    var octave = 0u;
    loop {
        let here = solid_grain(place / wavelength, CRAG_SEED + octave * 0x9e3779b9u);
        let sharp = sqrt(here.value * here.value + CRAG_SHARP);
        let slope = -seen * here.value * cell / (sharp * wavelength) * here.slope;
        sum.height += seen * (CRAG_MEAN - sharp);
        sum.slope += vec2<f32>(turn.x * slope.x - turn.y * slope.y, turn.y * slope.x + turn.x * slope.y) + slope.z * rise;
        place = vec3<f32>(0.8 * place.x + 0.6 * place.y, 0.8 * place.y - 0.6 * place.x, place.z);
        turn = vec2<f32>(0.8 * turn.x - 0.6 * turn.y, 0.8 * turn.y + 0.6 * turn.x);
        strength *= CRAG_GAIN;
        wavelength *= 0.5;
        seen = strength * grain_visible(footprint, wavelength);
        octave++;
        if octave >= CRAG_OCTAVES || seen <= 0.0 {
            break;
        }
    }
    return sum;
}
