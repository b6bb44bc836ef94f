// The least and greatest height of each square of control points of the ground, by which it is culled.

@group(0) @binding(0) var top: texture_2d<f32>;
@group(0) @binding(1) var<storage, read_write> bounds: array<vec2<f32>>;

// Control points along the side of a square, as `frustum.rs` has it.
const SMALLEST = 4u;

@compute @workgroup_size(8, 8)
fn bound(@builtin(global_invocation_id) at: vec3<u32>) {
    let size = textureDimensions(top);
    let squares = (size + SMALLEST - 1u) / SMALLEST;
    if any(at.xy >= squares) {
        return;
    }
    var least = 3.0e38;
    var greatest = -3.0e38;
    for (var look = 0u; look < SMALLEST * SMALLEST; look++) {
        let point = min(at.xy * SMALLEST + vec2<u32>(look % SMALLEST, look / SMALLEST), size - 1u);
        let height = textureLoad(top, point, 0).x;
        least = min(least, height);
        greatest = max(greatest, height);
    }
    bounds[at.y * squares.x + at.x] = vec2<f32>(least, greatest);
}
