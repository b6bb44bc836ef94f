// Twin of `slope_grain.rs`: noise on the planes that the ground faces.

const SLOPE_ONE_PLANE = 0.25;

// Weights of the planes that are upright and face east or west, upright and face north or south, and level.
fn slope_planes(rise: vec2<f32>) -> vec3<f32> {
    let squares = vec3<f32>(rise * rise, 1.0);
    let facing = squares * squares;
    let most = max(max(facing.x, facing.y), 1.0);
    let held = max(facing / most - SLOPE_ONE_PLANE, vec3<f32>(0.0));
    return held * inverseSqrt(dot(held, held));
}

// The weights of planes without that of the level one, or of the one that faces east or west, or of the other.
fn without_plane(left: vec3<f32>, is_level: bool, is_east: bool) -> vec3<f32> {
    let upright = select(vec3<f32>(left.x, 0.0, left.z), vec3<f32>(0.0, left.yz), is_east);
    return select(upright, vec3<f32>(left.xy, 0.0), is_level);
}

fn greatest(weights: vec3<f32>) -> f32 {
    return max(max(weights.x, weights.y), weights.z);
}

// Noise at a point of ground that rises so, for a pixel of that footprint.
fn octaves_on_slope(octaves: Octaves, point: vec3<f32>, rise: vec2<f32>, footprint: f32) -> Grain {
    var sum = Grain(0.0, vec2<f32>(0.0));
    var left = select(vec3<f32>(0.0), slope_planes(rise), grain_visible(footprint, octaves.wavelength) > 0.0);
    // The planes that count, the first of them first: on most ground one alone.
    var weight = greatest(left);
    if weight <= 0.0 {
        return sum;
    }
    loop {
        let is_level = left.z == weight;
        let is_east = !is_level & (left.x == weight);
        let along = select(vec2<f32>(1.0, 0.0), vec2<f32>(0.0, 1.0), is_east);
        let upright = turned_lattice(vec2<f32>(dot(along, point.xy), point.z));
        let here = octaves_at(octaves, select(upright, point.xy, is_level), footprint);
        let level = 0.8 * here.slope.x - 0.6 * here.slope.y;
        let up = 0.6 * here.slope.x + 0.8 * here.slope.y;
        sum.value += weight * here.value;
        sum.slope += weight * select(level * along + up * rise, here.slope, is_level);
        left = without_plane(left, is_level, is_east);
        weight = greatest(left);
        if weight <= 0.0 {
            break;
        }
    }
    return sum;
}
