// The trees of a wood around the camera: one in each square of its lattice, or none.

@group(2) @binding(0) var<uniform> kind: Kind;
@group(2) @binding(1) var<storage, read_write> plants: array<PlacedPlant>;

// Distance in metres by which roots reach into the ground, beside the height of the plant, as `batch.rs` has it.
const ROOTED = 0.01;

// Squares by which what is known moves with the camera at once, as `wood.rs` has it.
const STRIDE = 8.0;

fn word_of(part: f32) -> u32 {
    return u32(i32(round(32767.0 * part))) & 0xffffu;
}

@compute @workgroup_size(256)
fn grow_wood(@builtin(global_invocation_id) at: vec3<u32>) {
    let number = i32(at.x);
    if number >= i32(arrayLength(&plants)) {
        return;
    }
    let side = i32(kind.wood.z);
    let middle = vec2<i32>(floor(frame.moment.yz / (STRIDE * WOOD_SPACING))) * i32(STRIDE);
    let square = middle + vec2<i32>(number % side, number / side) - side / 2;
    let found = tree_in(square);
    let tree = found.tree;
    let stands = found.stands && found.is_conifer == (kind.wood.y > 0.0);
    let up = found.ground - ROOTED * tree.size;
    let turn = vec2<u32>(word_of(sin(0.5 * tree.turn)) << 16u, word_of(cos(0.5 * tree.turn)) << 16u);
    let size = select(0.0, tree.size, stands);
    plants[number] = PlacedPlant(vec3<f32>(tree.place, up), size, turn, tree.chance, fract(5.0 * tree.turn));
}
