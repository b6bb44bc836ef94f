// Blades of grass, lit from both sides.

@group(2) @binding(0) var<uniform> grasses: Grasses;
@group(2) @binding(2) var<storage, read> sets: array<vec4<u32>>;
@group(2) @binding(3) var<storage, read> kept: array<u32>;
@group(2) @binding(4) var<storage, read> starts: array<u32>;
@group(2) @binding(5) var<storage, read> lit_sets: array<LitSet>;

fn leaf(list: u32, vertex_number: u32, instance_number: u32) -> Leaf {
    let count = arrayLength(&sets);
    let vertices = 2u * choice.rows[list];
    let vertex = vertex_number % vertices;
    let number = instance_number * SETS_PER_INSTANCE * BLADES + vertex_number / vertices;
    let place = starts[place_of_run(list, 0u, count)] + number / BLADES;
    // The last instance has room for sets that there are not: all of their vertices lie in one point.
    if place >= starts[place_of_run(list + 1u, 0u, count)] {
        return Leaf(vec4<f32>(0.0, 0.0, 0.0, 1.0), vec3<f32>(0.0), vec3<f32>(0.0), vec3<f32>(0.0), vec2<f32>(0.0));
    }
    let instance = unpack(sets[kept[place]]);
    let known = lit_sets[place];
    let root = known.root;
    let distance = length(root - frame.moment.yzw);
    let as_counted = counted(distance);
    let tall = height_share(rank_of(instance.tuft), distance);
    let row = vertex / 2u;
    let along = (f32(row) - f32(row % 2u) * row_slide(list, as_counted)) / f32(choice.rows[list] - 1u);
    let side = f32(vertex % 2u) * 2.0 - 1.0;
    var blade = blade_of(instance.species, instance.tuft, number % BLADES);
    // Fewer blades are broader, so that a meadow stays as thick; none is thinner than it can be seen.
    let standing = select(1.0, share(distance), choice.thinned == 1u);
    let seen = 0.8 * distance * frame.eye.w;
    blade.width = max(blade.width * broader(standing), min(seen, 0.03));
    let still = vertex_of(blade, along, side);
    let here = swayed(blade, still, vec2<f32>(known.push.x, -known.push.y));
    let offset = vec3<f32>(here.place.x, -here.place.z, here.place.y * tall - 0.02);
    let point = root + offset;
    let normal = vec3<f32>(here.normal.x, -here.normal.z, here.normal.y);
    let above = known.leaves * (1.0 - along);
    return Leaf(
        projected(point), point, normal, colour_of(instance.species, here.blend, here.head), vec2<f32>(known.sun * through_leaves(above, scene.sun.z), sky_through_leaves(above)),
    );
}

@vertex
fn near_blade(@builtin(vertex_index) vertex: u32, @builtin(instance_index) number: u32) -> Leaf {
    return leaf(0u, vertex, number);
}

@vertex
fn middle_blade(@builtin(vertex_index) vertex: u32, @builtin(instance_index) number: u32) -> Leaf {
    return leaf(1u, vertex, number);
}

@vertex
fn far_blade(@builtin(vertex_index) vertex: u32, @builtin(instance_index) number: u32) -> Leaf {
    return leaf(2u, vertex, number);
}

@fragment
fn blade_fragment(in: Leaf) -> @location(0) vec4<f32> {
    return leaf_light(in.colour, in.point, in.normal, in.light, THROUGH, 1.4);
}
