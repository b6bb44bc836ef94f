
// Gradient noise on a square lattice; the twin of noise.rs. The places of columns and rows on the lattice come
// in tables from the host, so that far from the origin nothing is lost.

const HALF_TURN: f32 = 2147483648.0;
const RISE: f32 = 16.0f / 3.0f / HALF_TURN;

/// A lattice point before a place, and the way from there.
struct Place {
    whole: i32,
    offset: f32,
}

/// As `stepped` for a `offset` from 0 to 2.
fn carried_over(whole: i32, offset: f32) -> Place {
    if (offset >= 1.0) {
        return Place(whole + 1, offset - 1.0);
    }
    return Place(whole, offset);
}

/// The lattice point before a place that is `offset` steps beyond `whole`, and the way from there.
fn stepped(whole: i32, far: f32) -> Place {
    let offset = clamp(far, -4000000.0, 4000000.0);
    let steps = floor(offset);
    return Place(whole + i32(steps), offset - steps);
}

fn mixed(a: f32, b: f32, share: f32) -> f32 {
    return a + exact(share * exact(b - a));
}

fn fade(t: f32) -> f32 {
    return exact(t * t * t) * (exact(t * (exact(t * 6.0) - 15.0)) + 10.0);
}

/// `4/3 sin(π t)` for `t` = `turn` / 2^31, as two parabolas.
fn wave(turn: i32) -> f32 {
    let part = f32(turn);
    return part * (RISE - exact(RISE / HALF_TURN * abs(part)));
}

/// Height of the plane through a lattice point, at a place relative to it.
fn height_of(plane: vec2<u32>, point: u32, x: f32, y: f32) -> f32 {
    let bits = bits_of(plane, point);
    return exact(wave(bitcast<i32>(bits + (1u << 30u))) * x) + exact(wave(bitcast<i32>(bits)) * y);
}

fn noise(plane: vec2<u32>, u: Place, v: Place) -> f32 {
    let north_west = point_of(plane, u.whole, v.whole);
    let south_west = north_west + STEP_SOUTH;
    let x = u.offset;
    let y = v.offset;
    let share = fade(x);
    let north = mixed(
        height_of(plane, north_west, x, y), height_of(plane, north_west + STEP_EAST, x - 1.0, y), share,
    );
    let south = mixed(
        height_of(plane, south_west, x, y - 1.0),
        height_of(plane, south_west + STEP_EAST, x - 1.0, y - 1.0),
        share,
    );
    return mixed(north, south, fade(y));
}
