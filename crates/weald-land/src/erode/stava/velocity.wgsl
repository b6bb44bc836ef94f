
@compute @workgroup_size(16, 16)
fn velocity_before_diffusion(@builtin(global_invocation_id) invocation: vec3<u32>) {
    let cell = cell_of(invocation);
    if (inside(cell)) {
        velocities[index(cell)] = velocity_of_flow(cell);
    }
}
