// Blades of grass, lit from both sides.

@group(2) @binding(0) var<uniform> grasses: Grasses;
@group(2) @binding(2) var lit_sets: texture_2d<u32>;
@group(2) @binding(3) var blades: texture_2d<u32>;

// Leaf area above a leaf from which on it is no darker: stands are some metres wide, and light comes from their sides as well.
const DEEPEST_IN_LEAVES = 1.2;

// A corner of a blade, in few numbers: what draws triangles works on each, and the point follows from where a pixel is.
struct Leaf {
    @builtin(position) position: vec4<f32>,
    // The normal, and the share of the sun that is seen among others.
    @location(0) normal: vec4<f32>,
    // The colour, and the share of the sky.
    @location(1) colour: vec4<f32>,
}

// Where a list of sets starts and ends.
struct ListEnds {
    @location(0) first: u32,
    @location(1) end: u32,
}

fn leaf(list: u32, ends: ListEnds, vertex_number: u32, instance_number: u32) -> Leaf {
    let vertices = 2u * choice.rows[list];
    let vertex = vertex_number % vertices;
    let number = instance_number * SETS_PER_INSTANCE * BLADES + vertex_number / vertices;
    let place = ends.first + number / BLADES;
    // The last instance has room for sets that there are not: all of their vertices lie in one point.
    if place >= ends.end {
        return Leaf(vec4<f32>(0.0, 0.0, 0.0, 1.0), vec4<f32>(0.0), vec4<f32>(0.0));
    }
    let lit = unpacked_set(record_at(lit_sets, place));
    let blade = unpacked_blade(record_at(blades, ends.first * BLADES + number), lit);
    let slide = row_slide(list, counted(length(lit.root - frame.moment.yzw)));
    let row = vertex / 2u;
    let along = (f32(row) - f32(row % 2u) * slide) / f32(choice.rows[list] - 1u);
    // A blade ends in a point, those too that taper less: their tips are thinner than a pixel, and so are not two corners.
    let side = select(f32(vertex % 2u) * 2.0 - 1.0, 0.0, row + 1u == choice.rows[list]);
    let here = swayed(blade, vertex_of(blade, along, side), vec2<f32>(lit.push.x, -lit.push.y));
    let point = lit.root + vec3<f32>(here.place.x, -here.place.z, here.place.y * lit.tall - 0.02);
    let normal = vec3<f32>(here.normal.x, -here.normal.z, here.normal.y);
    let above = min(lit.light.y * (1.0 - along), DEEPEST_IN_LEAVES);
    return Leaf(
        projected(point),
        vec4<f32>(normal, lit.light.x * through_leaves(above, scene.sun.z)),
        vec4<f32>(here.head * lit.head + (1.0 - here.head) * lit.leaf, sky_through_leaves(above)),
    );
}

@vertex
fn near_blade(ends: ListEnds, @builtin(vertex_index) vertex: u32, @builtin(instance_index) number: u32) -> Leaf {
    return leaf(0u, ends, vertex, number);
}

@vertex
fn middle_blade(ends: ListEnds, @builtin(vertex_index) vertex: u32, @builtin(instance_index) number: u32) -> Leaf {
    return leaf(1u, ends, vertex, number);
}

@vertex
fn far_blade(ends: ListEnds, @builtin(vertex_index) vertex: u32, @builtin(instance_index) number: u32) -> Leaf {
    return leaf(2u, ends, vertex, number);
}

@fragment
fn blade_fragment(in: Leaf) -> @location(0) vec4<f32> {
    // The middle of a pixel may lie beside what it has samples of, where a depth is none.
    let point = point_at(in.position.xy, max(in.position.z, 1e-9));
    // A pixel may have a sample on a blade and its middle beside it.
    let light = clamp(vec2<f32>(in.normal.w, in.colour.w), vec2<f32>(0.0), vec2<f32>(1.0));
    return leaf_light(in.colour.xyz, point, in.normal.xyz, light, THROUGH, 1.4);
}
