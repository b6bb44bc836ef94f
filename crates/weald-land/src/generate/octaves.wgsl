
// Noise of the octaves of a table. Of each, `octaves` has two elements: the plane and the amplitude, then the
// cosine and the sine of the lattice's turn by its steps a metre. Of each octave and column, or row, `columns`
// and `rows` have whole lattice steps and the rest in both directions.

/// First row of this band of the landscape.
struct Band {
    first_row: u32,
}

fn plane_of(octave: u32) -> vec2<u32> {
    return octaves[2u * octave].xy;
}

fn amplitude_of(octave: u32) -> f32 {
    return bitcast<f32>(octaves[2u * octave].z);
}

/// Noise of an octave at a cell.
fn octave_at(octave: u32, cell: vec2<i32>) -> f32 {
    let column = columns[octave * grid.columns + u32(cell.x)];
    let row = rows[octave * constants.rows + weather.first_row + u32(cell.y)];
    let whole = bitcast<vec2<i32>>(column.xy) + bitcast<vec2<i32>>(row.xy);
    let rest = bitcast<vec2<f32>>(column.zw) + bitcast<vec2<f32>>(row.zw);
    return noise(plane_of(octave), carried_over(whole.x, rest.x), carried_over(whole.y, rest.y));
}
