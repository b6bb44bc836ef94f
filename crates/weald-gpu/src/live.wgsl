// Ground and water of a program as it runs, in metres, one value a cell of the landscape: what its buffers hold, added up.

struct Place {
    // Columns and rows of the landscape, and of the simulation.
    columns: u32,
    rows: u32,
    simulated_columns: u32,
    simulated_rows: u32,
    // Column and row of the landscape at which the simulation begins.
    first_column: i32,
    first_row: i32,
    // Planes that are added to the base.
    added: u32,
    // Values a cell in the buffer of the water, and in that of the mask; 0 where there is none.
    water: u32,
    mask: u32,
    // Metres that are 1 in the simulation, and the elevation that is 0 there.
    unit: f32,
    lowest: f32,
}

@group(0) @binding(0) var<uniform> place: Place;
@group(0) @binding(1) var<storage, read> base: array<f32>;
@group(0) @binding(2) var<storage, read> added: array<f32>;
@group(0) @binding(3) var<storage, read> water: array<f32>;
@group(0) @binding(4) var<storage, read> mask: array<f32>;
@group(0) @binding(5) var<storage, read_write> ground: array<f32>;
@group(0) @binding(6) var<storage, read_write> depth: array<f32>;

@compute @workgroup_size(16, 16)
fn show(@builtin(global_invocation_id) at: vec3<u32>) {
    if at.x >= place.columns || at.y >= place.rows {
        return;
    }
    let x = i32(at.x) - place.first_column;
    let y = i32(at.y) - place.first_row;
    if x < 0 || y < 0 || x >= i32(place.simulated_columns) || y >= i32(place.simulated_rows) {
        return;
    }
    let cells = place.simulated_columns * place.simulated_rows;
    let taken = u32(y) * place.simulated_columns + u32(x);
    // The mask's first lane is 1 on cells that take part.
    if place.mask > 0u && mask[taken * place.mask] < 0.5 {
        return;
    }
    var height = base[taken];
    for (var plane = 0u; plane < place.added; plane++) {
        height += added[plane * cells + taken];
    }
    let into = at.y * place.columns + at.x;
    ground[into] = place.lowest + height * place.unit;
    if place.water > 0u {
        depth[into] = water[taken * place.water] * place.unit;
    }
}
