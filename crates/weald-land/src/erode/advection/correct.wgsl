
// MacCormack's step back, and the correction.

fn forward_around(cell: vec2<i32>) -> Stencil9 {
    return Stencil9(forward_across(cell + NORTH), forward_across(cell), forward_across(cell + SOUTH));
}

fn forward_across(cell: vec2<i32>) -> vec3<f32> {
    return vec3<f32>(forward[index(cell + WEST)], forward[index(cell)], forward[index(cell + EAST)]);
}

@compute @workgroup_size(16, 16)
fn correct(@builtin(global_invocation_id) invocation: vec3<u32>) {
    let cell = cell_of(invocation);
    let speed = velocity(cell);
    let links = links_of(cell);
    let back = departure(forward_around(cell), -speed, links);
    let arrived = corrected(forward[index(cell)], back, sediment_around(cell), speed, links);
    if (inside(cell)) {
        arrive(cell, arrived);
    }
}
