// Blades of grass, lit from both sides.

@group(2) @binding(0) var<uniform> grasses: Grasses;
@group(2) @binding(2) var<storage, read> sets: array<vec4<u32>>;
@group(2) @binding(3) var<storage, read> kept: array<u32>;
@group(2) @binding(4) var<storage, read> starts: array<u32>;
@group(2) @binding(5) var<storage, read> lit_sets: array<LitSet>;
@group(2) @binding(6) var<storage, read> blades: array<KeptBlade>;

// Whether the blades of what is drawn are kept.
override ARE_KEPT: bool = true;

// The blades of a set are one strip, in which the first and last vertex of each come twice.
fn leaf(list: u32, strip_vertex: u32, instance: u32) -> Leaf {
    let rows = choice.rows[list];
    let number = strip_vertex / (2u * rows + 2u);
    let vertex = clamp(strip_vertex % (2u * rows + 2u), 1u, 2u * rows) - 1u;
    let begin = starts[place_of_count(list, 0u, arrayLength(&sets))];
    let place = select(max(begin, KEPT_SETS), begin, ARE_KEPT) + instance;
    let known = lit_sets[place];
    let root = known.root;
    let distance = length(root - frame.moment.yzw);
    var seen: KeptBlade;
    if ARE_KEPT {
        seen = blades[place * BLADES + number];
    } else {
        let tuft = unpack(sets[kept[place]]);
        seen = seen_blade(tuft.species, tuft.tuft, number, distance);
    }
    let row = vertex / 2u;
    let along = (f32(row) - f32(row % 2u) * row_slide(list, distance)) / f32(rows - 1u);
    let side = f32(vertex % 2u) * 2.0 - 1.0;
    let blade = blade_kept(seen);
    let still = vertex_of(blade, along, side);
    let here = swayed(blade, still, vec2<f32>(known.push.x, -known.push.y));
    let tall = unpack2x16float(seen.look.x).y;
    let point = root + vec3<f32>(here.place.x, -here.place.z, here.place.y * tall - 0.02);
    let normal = vec3<f32>(here.normal.x, -here.normal.z, here.normal.y);
    let blue = unpack2x16float(seen.look.z);
    let green = vec3<f32>(unpack2x16float(seen.look.y), blue.x);
    let colour = mix(green, vec3<f32>(unpack2x16float(seen.look.w), blue.y), here.head);
    let above = known.leaves * (1.0 - along);
    let light = vec2<f32>(known.sun * through_leaves(above, scene.sun.z), sky_through_leaves(above));
    return Leaf(projected(point), point, normal, colour, light);
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
