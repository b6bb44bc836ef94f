// Twin of `wind.rs`, after the functions of `grain.wgsl`: gusts that travel.

const WIND_TOWARDS = vec2<f32>(0.92, 0.39191836);
const WIND_SPEED = 3.5;

// The push east and north at a place in metres east and north, a moment in seconds, and a phase from 0 to 1.
fn wind_push(place: vec2<f32>, seconds: f32, phase: f32) -> vec2<f32> {
    let drift = seconds * WIND_SPEED;
    let gust = octaves_at(Octaves(14.0, 3u, 0.6, 0x61u), place - drift * WIND_TOWARDS, 0.0).value;
    let strength = 0.16 + 0.28 * gust + 0.05 * wind_wave(1.7 * seconds + phase);
    return max(strength, 0.0) * WIND_TOWARDS;
}

// A wave like a sine, of parabolas, by the turns since it began.
fn wind_wave(turns: f32) -> f32 {
    let along = 2.0 * (turns - floor(turns));
    let t = select(along, along - 2.0, along > 1.0);
    return 4.0 * t * (1.0 - abs(t));
}
