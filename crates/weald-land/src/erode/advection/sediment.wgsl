
/// The sediment around a cell as the exchange with the ground left it.
fn sediment_around(cell: vec2<i32>) -> Stencil9 {
    return Stencil9(sediment_across(cell + NORTH), sediment_across(cell), sediment_across(cell + SOUTH));
}

fn sediment_across(cell: vec2<i32>) -> vec3<f32> {
    return vec3<f32>(settled_sediment(cell + WEST), settled_sediment(cell), settled_sediment(cell + EAST));
}
