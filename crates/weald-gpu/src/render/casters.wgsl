// What throws shadows, as the sun sees it: the vertices of the ground, its sides and rims in a cascade.

@group(2) @binding(0) var<uniform> caster_cascade: vec4<i32>;

struct Caster {
    @builtin(position) position: vec4<f32>,
    @location(0) point: vec3<f32>,
}

fn cast_shadow(point: vec3<f32>) -> Caster {
    return Caster(vec4<f32>(in_cascade(point, caster_cascade.x), 1.0), point);
}

@vertex
fn ground_caster(
    @builtin(vertex_index) index: u32,
    @location(0) patch_of: vec4<f32>,
    @location(1) slot: u32,
) -> Caster {
    return cast_shadow(ground_at_vertex(index, patch_of, slot));
}

@vertex
fn beyond_caster(
    @builtin(vertex_index) index: u32,
    @location(0) patch_of: vec4<f32>,
    @location(1) slot: u32,
) -> Caster {
    return cast_shadow(beyond_at_vertex(index, patch_of, slot));
}

@vertex
fn side_caster(
    @builtin(vertex_index) index: u32,
    @location(0) patch_of: vec4<f32>,
    @location(1) slot: u32,
    @location(2) edge: u32,
) -> Caster {
    return cast_shadow(side_at_vertex(index, patch_of, slot, edge));
}

@vertex
fn rim_caster(
    @builtin(vertex_index) index: u32,
    @location(0) ends: vec4<f32>,
    @location(1) normals: vec4<f32>,
) -> Caster {
    return cast_shadow(rim_at_vertex(index, ends));
}

// Where there is no land there is no shadow.
@fragment
fn caster_fragment(in: Caster) {
    if !is_valid(clamp(place_of(in.point), vec2<f32>(0.5), scene.grid.xy + 0.5)) {
        discard;
    }
}
