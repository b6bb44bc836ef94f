// What all blades of a set have in common where it is looked at: once for each chosen set, and not for each of its vertices.

@group(2) @binding(0) var<uniform> grasses: Grasses;
@group(2) @binding(2) var<storage, read> sets: array<vec4<u32>>;
@group(2) @binding(3) var<storage, read> kept: array<u32>;
@group(2) @binding(4) var<storage, read> starts: array<u32>;
@group(2) @binding(5) var<storage, read_write> lit_sets: array<LitSet>;

@compute @workgroup_size(GROUP)
fn light_sets(@builtin(global_invocation_id) at: vec3<u32>) {
    let count = arrayLength(&sets);
    if at.x >= starts[place_of_run(LISTS, 0u, count)] {
        return;
    }
    let instance = unpack(sets[kept[at.x]]);
    let root = grass_root(instance.place);
    let sun = sun_seen(root + vec3<f32>(0.0, 0.0, 0.3), vec3<f32>(0.0, 0.0, 1.0));
    let push = wind_push(instance.place * vec2<f32>(1.0, -1.0), frame.moment.x, phase_of(instance.tuft));
    lit_sets[at.x] = LitSet(root, sun, push, leaves_at(place_of(root)).w, 0.0);
}
