// What blades of a set are where it is looked at: once for each blade of a chosen set, and not for each of its vertices.

@group(2) @binding(0) var<uniform> grasses: Grasses;
@group(2) @binding(2) var<storage, read> sets: array<vec4<u32>>;
@group(2) @binding(3) var<storage, read> kept: array<u32>;
@group(2) @binding(4) var<storage, read> starts: array<u32>;
@group(2) @binding(5) var lit_sets: texture_storage_2d<rgba32uint, write>;
@group(2) @binding(6) var blades: texture_storage_2d<rgba32uint, write>;

fn store_set(place: u32, lit: LitSet) {
    let texel = texel_of_record(place);
    let record = packed_set(lit);
    textureStore(lit_sets, texel, record.first);
    textureStore(lit_sets, texel + vec2<u32>(1u, 0u), record.second);
}

fn store_blade(place: u32, blade: Blade) {
    let texel = texel_of_record(place);
    let record = packed_blade(blade);
    textureStore(blades, texel, record.first);
    textureStore(blades, texel + vec2<u32>(1u, 0u), record.second);
}

fn lit(instance: Instance, root: vec3<f32>, distance: f32) -> LitSet {
    let sun = sun_seen(root + vec3<f32>(0.0, 0.0, 0.3), vec3<f32>(0.0, 0.0, 1.0));
    let ground = normal_of(spline_with_slope(bed, place_of(root)).yz);
    // Blades that stand for others as well are as bright as those are in the mean.
    let drawn = drawn_as_blades(distance);
    let reached = mix(sunlit_leaves(ground, normalize(root - frame.eye.xyz)), 1.0, drawn * drawn);
    let growth = growth_at(instance.species, instance.tuft.soil, instance.tuft.light);
    return LitSet(
        root,
        wind_push(instance.place * vec2<f32>(1.0, -1.0), frame.moment.x, phase_of(instance.tuft)),
        vec2<f32>(sun * reached, leaves_at(place_of(root)).w),
        colour_of(instance.species, growth.blend, 0.0),
        colour_of(instance.species, growth.blend, 1.0),
        row_of(instance.species, 4u).z,
        height_share(rank_of(instance.tuft), distance),
    );
}

@compute @workgroup_size(GROUP)
fn light_sets(@builtin(global_invocation_id) at: vec3<u32>) {
    let count = arrayLength(&sets);
    if at.x >= starts[place_of_run(LISTS, 0u, count)] {
        return;
    }
    let instance = unpack(sets[kept[at.x]]);
    let root = grass_root(instance.place);
    let distance = length(root - frame.moment.yzw);
    store_set(at.x, lit(instance, root, distance));
    // Fewer blades are broader, so that a meadow stays as thick; none is thinner than it can be seen.
    let standing = select(1.0, share(distance), choice.thinned == 1u);
    let seen = 0.8 * distance * frame.eye.w / frame.pixel.z;
    for (var number = 0u; number < BLADES; number++) {
        var blade = blade_of(instance.species, instance.tuft, number);
        blade.width = max(blade.width * broader(standing), min(seen, 0.03));
        store_blade(at.x * BLADES + number, blade);
    }
}
