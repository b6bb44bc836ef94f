
struct DispatchRange {
    // Workgroup with which the dispatch begins.
    first: u32,
    points: u32,
}

@group(0) @binding(0) var<uniform> range: DispatchRange;
@group(0) @binding(1) var<storage, read> limbs: array<Limb>;
@group(0) @binding(2) var<storage, read> rests: array<vec4<f32>>;
@group(0) @binding(3) var<storage, read> winds: array<vec4<f32>>;
@group(0) @binding(4) var<storage, read_write> swayed: array<vec4<f32>>;
@group(0) @binding(5) var<storage, read_write> pushes: array<vec4<f32>>;

// Where a point goes that is so far along a limb and whose rest is `rest`.
fn bent(breeze: LocalWind, first: u32, first_along: f32, rest: vec3<f32>, normal: vec3<f32>) -> Bent {
    var found = Bent(rest, normal);
    var along = first_along;
    var number = first;
    while number != NO_PARENT {
        let limb = limbs[number];
        let half = half_turn(limb, along, breeze);
        let turn = vec4<f32>(half, 1.0) / sqrt(1.0 + dot(half, half));
        let arm = found.point - limb.joint;
        found.point += rotated(turn, arm) - arm;
        found.normal = rotated(turn, found.normal);
        along = limb.along;
        number = limb.tie & NO_PARENT;
    }
    return found;
}

@compute @workgroup_size(64)
fn bend(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) place: u32) {
    let point = (range.first + group.x) * 64u + place;
    if point >= range.points {
        return;
    }
    let wind = winds[point];
    let push = wind_push(wind.xy, wind.z, 0.0);
    let breeze = wind_on(push, wind.z, 0.0);
    let rest = rests[point];
    let bent_there = bent(breeze, u32(wind.w), rest.w, rest.xyz, vec3<f32>(0.0, 1.0, 0.0));
    swayed[point] = vec4<f32>(bent_there.point, 0.0);
    pushes[point] = vec4<f32>(push, 0.0, 0.0);
}
