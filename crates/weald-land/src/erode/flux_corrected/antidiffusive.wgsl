
/// Antidiffusive fluxes through the eastern, western, southern and northern face of a cell.
fn antidiffusive_of(cell: vec2<i32>) -> vec4<f32> {
    let to = antidiffusive[index(cell)];
    let from_west = select(0.0, antidiffusive[index(cell + WEST)].x, cell.x > 0);
    let from_north = select(0.0, antidiffusive[index(cell + NORTH)].y, cell.y > 0);
    return vec4<f32>(to.x, from_west, to.y, from_north);
}
