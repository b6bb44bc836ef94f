// What every pass knows: the grid, its cells and their neighbours. Row 0 is north.

struct Grid {
    columns: u32,
    rows: u32,
    // The cells whose sums are counted.
    own_first_column: u32,
    own_first_row: u32,
    own_end_column: u32,
    own_end_row: u32,
    // First row of this dispatch.
    first_row: u32,
    // Workgroups from west to east.
    groups_across: u32,
}

const WEST: vec2<i32> = vec2<i32>(-1, 0);
const EAST: vec2<i32> = vec2<i32>(1, 0);
const NORTH: vec2<i32> = vec2<i32>(0, -1);
const SOUTH: vec2<i32> = vec2<i32>(0, 1);

/// The cell of an invocation.
fn cell_of(invocation: vec3<u32>) -> vec2<i32> {
    return vec2<i32>(i32(invocation.x), i32(invocation.y + grid.first_row));
}

fn inside(cell: vec2<i32>) -> bool {
    return all(cell >= vec2<i32>(0, 0)) && cell.x < i32(grid.columns) && cell.y < i32(grid.rows);
}

/// Place of a cell in a buffer; beyond a wall that of the nearest cell, to which no link leads.
fn index(cell: vec2<i32>) -> u32 {
    let last = vec2<i32>(i32(grid.columns) - 1, i32(grid.rows) - 1);
    let nearest = clamp(cell, vec2<i32>(0, 0), last);
    return u32(nearest.y) * grid.columns + u32(nearest.x);
}

/// The number, as rounded as it is here. Drivers compute as if numbers were real ones: they take `(a + b) - a` for
/// `b` and `a * b + a * c` for `a * (b + c)`, and fuse products with sums. What rests on rounding goes through here:
/// what a cell lost and another gets, and what passes an edge, which the cells on both its sides work out. It is a
/// change by a bit that is 0 on every grid, which no driver knows: one more instruction.
fn exact(number: f32) -> f32 {
    return bitcast<f32>(bitcast<u32>(number) ^ (grid.columns >> 31u));
}

/// 1 where both cells hold data, else 0.
fn link(here: vec2<i32>, there: vec2<i32>) -> f32 {
    return valid(here) * valid(there);
}

/// Reciprocal of the number of neighbours that hold data; 0 where there are none.
fn neighbour_share(cell: vec2<i32>) -> f32 {
    let neighbours = (valid(cell + WEST) + valid(cell + EAST)) + (valid(cell + NORTH) + valid(cell + SOUTH));
    return select(0.0, valid(cell) / neighbours, neighbours > 0.0);
}
