
// Transport of sediment by the velocity of its cell; the twin of advection.rs.

/// The cells around a cell: north, level, south; each west, middle, east.
struct Stencil9 {
    north: vec3<f32>,
    level: vec3<f32>,
    south: vec3<f32>,
}

/// Links of a cell to its western, eastern, northern and southern neighbours.
fn links_of(cell: vec2<i32>) -> vec4<f32> {
    return vec4<f32>(
        link(cell, cell + WEST), link(cell, cell + EAST), link(cell, cell + NORTH), link(cell, cell + SOUTH),
    );
}

/// Weights of the western, eastern, northern and southern neighbours.
fn weights(speed: vec2<f32>, links: vec4<f32>) -> vec4<f32> {
    let displacement = clamp(speed, vec2<f32>(-1.0), vec2<f32>(1.0));
    return vec4<f32>(
        max(displacement.x, 0.0) * links.x, max(-displacement.x, 0.0) * links.y, max(displacement.y, 0.0) * links.z, max(-displacement.y, 0.0) * links.w,
    );
}

fn across(row: vec3<f32>, west: f32, east: f32) -> f32 {
    return (west * row.x + east * row.z) + (1.0 - (west + east)) * row.y;
}

/// Value at the departure point of a cell.
fn departure(nine: Stencil9, speed: vec2<f32>, links: vec4<f32>) -> f32 {
    let weight = weights(speed, links);
    let north = across(nine.north, weight.x, weight.y);
    let level = across(nine.level, weight.x, weight.y);
    let south = across(nine.south, weight.x, weight.y);
    return (weight.z * north + weight.w * south) + (1.0 - (weight.z + weight.w)) * level;
}

/// The value of a row that lies up the stream.
fn aside(row: vec3<f32>, left: bool, right: bool) -> f32 {
    return select(select(row.y, row.z, right), row.x, left);
}

/// MacCormack's correction of the forward step by the error that the way back shows.
fn corrected(forward: f32, back: f32, nine: Stencil9, speed: vec2<f32>, links: vec4<f32>) -> f32 {
    let left = speed.x * links.x > 0.0;
    let right = speed.x * links.y < 0.0;
    let up = speed.y * links.z > 0.0;
    let down = speed.y * links.w < 0.0;
    let here = nine.level.y;
    let level = aside(nine.level, left, right);
    let above = vec2<f32>(nine.north.y, aside(nine.north, left, right));
    let below = vec2<f32>(nine.south.y, aside(nine.south, left, right));
    let beyond = select(select(vec2<f32>(here, level), below, down), above, up);
    let least = min(min(here, level), min(beyond.x, beyond.y));
    let most = max(max(here, level), max(beyond.x, beyond.y));
    return min(max(forward + (here - back) * 0.5, least), most);
}
