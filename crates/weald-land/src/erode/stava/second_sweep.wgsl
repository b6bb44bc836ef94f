
fn velocity_before(cell: vec2<i32>) -> vec2<f32> {
    return velocities_once[index(cell)];
}

@compute @workgroup_size(16, 16)
fn second_sweep(@builtin(global_invocation_id) invocation: vec3<u32>) {
    let cell = cell_of(invocation);
    if (inside(cell)) {
        velocities[index(cell)] = diffused(cell);
    }
}
