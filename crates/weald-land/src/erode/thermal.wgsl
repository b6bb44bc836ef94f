
// Ground steeper than its talus slides; the twin of thermal.rs. The schemes say what slides along an edge.

fn ground(cell: vec2<i32>) -> f32 {
    let at = index(cell);
    return base[at] + settled[at];
}

@compute @workgroup_size(16, 16)
fn slide(@builtin(global_invocation_id) invocation: vec3<u32>) {
    let cell = cell_of(invocation);
    let to_east = exact(slide_east(cell));
    let from_west = exact(slide_east(cell + WEST));
    let to_south = exact(slide_south(cell));
    let from_north = exact(slide_south(cell + NORTH));
    if (inside(cell)) {
        change[index(cell)] = settled[index(cell)] + ((from_west - to_east) + (from_north - to_south));
    }
}
