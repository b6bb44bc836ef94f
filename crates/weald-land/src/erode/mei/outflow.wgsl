
// Rain, and outflows to the four neighbours, scaled to the water that the cell has.

fn surface(cell: vec2<i32>) -> f32 {
    let at = index(cell);
    let ground = base[at] + change[at];
    return ground + rained(cell);
}

fn edge_level(cell: vec2<i32>) -> f32 {
    return base[index(cell)];
}

@compute @workgroup_size(16, 16)
fn outflow(@builtin(global_invocation_id) invocation: vec3<u32>) {
    let cell = cell_of(invocation);
    let at = index(cell);
    var flowing = wanted_outflows(cell, outflows[at]);
    if (LIMITER) {
        flowing = scaled(flowing, rained(cell));
    }
    if (weather.rain > 0.0) {
        tally(RAINED, cell, rained(cell) - carried[at].x);
    }
    if (inside(cell)) {
        outflows[at] = flowing;
    }
}
