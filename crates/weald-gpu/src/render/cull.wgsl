// Which sets of grass are drawn, and how finely: those in sight, the fewer the farther, in three lists.

// What an indirect draw wants.
struct Draw {
    vertices: u32,
    instances: atomic<u32>,
    first_vertex: u32,
    first_instance: u32,
}

@group(2) @binding(0) var<uniform> grasses: Grasses;
@group(2) @binding(1) var<storage, read> sets: array<vec4<u32>>;
@group(2) @binding(2) var<storage, read_write> draws: array<Draw, 3>;
@group(2) @binding(3) var<storage, read_write> kept: array<u32>;

@compute @workgroup_size(64)
fn cull(@builtin(global_invocation_id) at: vec3<u32>) {
    let count = arrayLength(&sets);
    let number = at.y * 65535u * 64u + at.x;
    if number >= count {
        return;
    }
    let instance = unpack(sets[number]);
    let root = grass_root(instance.place);
    let away = root - frame.eye.xyz;
    let distance = length(root - frame.moment.yzw);
    if grass_height_share(instance.tuft, distance) <= 0.0 || !is_grass_in_sight(away, 2.0) {
        return;
    }
    let list = grass_list(distance);
    let place = atomicAdd(&draws[list].instances, BLADES) / BLADES;
    kept[list * count + place] = number;
}
