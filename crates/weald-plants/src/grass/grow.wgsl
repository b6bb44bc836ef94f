
struct DispatchRange {
    // Workgroup with which the dispatch begins.
    first: u32,
    points: u32,
}

@group(0) @binding(0) var<uniform> grasses: Grasses;
@group(0) @binding(1) var<uniform> range: DispatchRange;
@group(0) @binding(2) var<storage, read> sets: array<vec4<u32>>;
@group(0) @binding(3) var<storage, read> corners: array<vec4<f32>>;
@group(0) @binding(4) var<storage, read_write> places: array<vec4<f32>>;
@group(0) @binding(5) var<storage, read_write> normals: array<vec4<f32>>;

@compute @workgroup_size(64)
fn grow(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) place: u32) {
    let point = (range.first + group.x) * 64u + place;
    if point >= range.points {
        return;
    }
    let instance = unpack(sets[point]);
    let corner = corners[point];
    let number = u32(corner.x);
    let blade = blade_of(instance.species, instance.tuft, number / 2u);
    let still = vertex_of(blade, corner.y, f32(number % 2u) * 2.0 - 1.0);
    let vertex = swayed(blade, still, corner.zw);
    places[point] = vec4<f32>(vertex.place, vertex.blend);
    normals[point] = vec4<f32>(vertex.normal, vertex.head);
}
