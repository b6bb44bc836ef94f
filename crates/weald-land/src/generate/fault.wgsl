
// Every fault looks at every cell; the twin of fault.rs. Sums are whole numbers, so their order does not
// matter.

struct FaultConstants {
    count: u32,
}

/// First row of this band of the landscape, and the faults of this dispatch.
struct Faults {
    first_row: u32,
    first: u32,
    end: u32,
}

/// Above 0 on the side that goes up. A line is its start and its way.
fn side(line: vec4<i32>, x: i32, y: i32) -> i32 {
    return line.z * (y - line.y) - line.w * (x - line.x);
}

/// What the faults of this dispatch add to a cell.
fn moved(cell: vec2<i32>) -> i32 {
    let y = cell.y + i32(weather.first_row);
    var sum = 0;
    for (var number = weather.first; number < weather.end; number++) {
        let size = i32(constants.count - 1u - number);
        sum += select(-size, size, side(bitcast<vec4<i32>>(lines[number]), cell.x, y) > 0);
    }
    return sum;
}

@compute @workgroup_size(16, 16)
fn fault(@builtin(global_invocation_id) invocation: vec3<u32>) {
    let cell = cell_of(invocation);
    if (inside(cell)) {
        let before = select(0, bitcast<i32>(steps[index(cell)]), weather.first > 0u);
        steps[index(cell)] = bitcast<u32>(before + moved(cell));
    }
}
