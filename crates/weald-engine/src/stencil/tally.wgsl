
// Sums over all cells and steps. Each workgroup adds its cells in a fixed order and keeps its own total with
// the rounding error of each addition beside it (Knuth's two-sum), so that thousands of steps lose nothing.

var<workgroup> amounts: array<f32, 256>;

/// Adds what a cell has to count. All invocations of a workgroup must call it, those beyond the grid too.
fn tally(which: u32, cell: vec2<i32>, amount: f32) {
    let place = u32(cell.y) % GROUP * GROUP + u32(cell.x) % GROUP;
    amounts[place] = select(0.0, amount, owned(cell));
    for (var half = GROUP * GROUP / 2u; half > 0u; half /= 2u) {
        workgroupBarrier();
        if (place < half) {
            amounts[place] += amounts[place + half];
        }
    }
    if (place == 0u) {
        let group = u32(cell.y) / GROUP * grid.groups_across + u32(cell.x) / GROUP;
        add_exactly(group * SUMS + which, amounts[0]);
    }
    workgroupBarrier();
}

fn owned(cell: vec2<i32>) -> bool {
    let column = u32(cell.x);
    let row = u32(cell.y);
    return column >= grid.own_first_column && column < grid.own_end_column
        && row >= grid.own_first_row && row < grid.own_end_row;
}

fn add_exactly(slot: u32, amount: f32) {
    let before = sums[slot];
    let total = exact(before.x + amount);
    let added = exact(total - before.x);
    let kept = exact(total - added);
    let error = exact(before.x - kept) + exact(amount - added);
    sums[slot] = vec2<f32>(total, before.y + error);
}
