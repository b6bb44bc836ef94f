// Twin of `grain.rs`: gradient noise and its slope, in octaves that fade before they could flicker.

struct Grain {
    value: f32,
    slope: vec2<f32>,
}

fn grain_bits(x: i32, y: i32, seed: u32) -> u32 {
    var h = (bitcast<u32>(x) * 0xc13fa9a9u + bitcast<u32>(y) * 0x91e10da5u) ^ seed;
    h = (h ^ (h >> 16u)) * 0x7feb352du;
    h = (h ^ (h >> 15u)) * 0x846ca68bu;
    return h ^ (h >> 16u);
}

fn grain_wave(turn: f32) -> f32 {
    let t = select(turn, turn - 2.0, turn > 1.0);
    return 4.0 * t * (1.0 - abs(t));
}

fn grain_gradient(x: i32, y: i32, seed: u32) -> vec2<f32> {
    let turn = f32(bitcast<i32>(grain_bits(x, y, seed)) >> 8u) * (1.0 / 8388608.0);
    let quarter = select(turn + 0.5, turn + 1.5, turn < -0.5);
    return vec2<f32>(grain_wave(quarter), grain_wave(turn));
}

// Noise at a place that is counted in wavelengths.
fn grain(place: vec2<f32>, seed: u32) -> Grain {
    let corner = floor(place);
    let x = i32(corner.x);
    let y = i32(corner.y);
    let t = place - corner;
    let ease = t * t * t * (t * (t * 6.0 - 15.0) + 10.0);
    let ease_slope = 30.0 * t * t * (t * (t - 2.0) + 1.0);
    let g0 = grain_gradient(x, y, seed);
    let g1 = grain_gradient(x + 1, y, seed);
    let g2 = grain_gradient(x, y + 1, seed);
    let g3 = grain_gradient(x + 1, y + 1, seed);
    let a = dot(g0, t);
    let b = dot(g1, t - vec2<f32>(1.0, 0.0));
    let c = dot(g2, t - vec2<f32>(0.0, 1.0));
    let d = dot(g3, t - vec2<f32>(1.0, 1.0));
    let twist = a - b - c + d;
    let blend = g0 + ease.x * (g1 - g0) + ease.y * (g2 - g0) + ease.x * ease.y * (g0 - g1 - g2 + g3);
    return Grain(
        a + ease.x * (b - a) + ease.y * (c - a) + ease.x * ease.y * twist,
        blend + ease_slope * vec2<f32>(b - a + ease.y * twist, c - a + ease.x * twist),
    );
}

// How much of an octave a pixel of that footprint still shows.
fn grain_visible(footprint: f32, wavelength: f32) -> f32 {
    let share = clamp((0.7 - footprint / wavelength) * (1.0 / 0.45), 0.0, 1.0);
    return share * share * (3.0 - 2.0 * share);
}

struct Octaves {
    wavelength: f32,
    count: u32,
    gain: f32,
    seed: u32,
}

// The sum at a point, for a pixel of that footprint in metres; the slope is a metre.
//
// It ends at the end of a turn, as loops of shaders do here: software that acts as a device goes through a whole turn more to
// find at its beginning that none is left.
fn octaves_at(octaves: Octaves, point: vec2<f32>, footprint: f32) -> Grain {
    var sum = Grain(0.0, vec2<f32>(0.0));
    var strength = 1.0;
    var wavelength = octaves.wavelength;
    var place = point;
    var turn = vec2<f32>(1.0, 0.0);
    var seen = grain_visible(footprint, wavelength);
    if seen <= 0.0 {
        return sum;
    }
    var octave = 0u;
    loop {
        let here = grain(place / wavelength, octaves.seed + octave * 0x9e3779b9u);
        sum.value += seen * here.value;
        let slope = seen * here.slope / wavelength;
        sum.slope += vec2<f32>(turn.x * slope.x - turn.y * slope.y, turn.y * slope.x + turn.x * slope.y);
        place = vec2<f32>(0.8 * place.x + 0.6 * place.y, 0.8 * place.y - 0.6 * place.x);
        turn = vec2<f32>(0.8 * turn.x - 0.6 * turn.y, 0.8 * turn.y + 0.6 * turn.x);
        strength *= octaves.gain;
        wavelength *= 0.5;
        seen = strength * grain_visible(footprint, wavelength);
        octave++;
        if octave >= octaves.count || seen <= 0.0 {
            break;
        }
    }
    return sum;
}
