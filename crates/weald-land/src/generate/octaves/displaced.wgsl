
/// Noise of an octave, looked up some metres away from a cell.
fn displaced_octave_at(octave: u32, cell: vec2<i32>, away: vec2<f32>) -> f32 {
    let column = columns[octave * grid.columns + u32(cell.x)];
    let row = rows[octave * constants.rows + weather.first_row + u32(cell.y)];
    let whole = bitcast<vec2<i32>>(column.xy) + bitcast<vec2<i32>>(row.xy);
    let rest = bitcast<vec2<f32>>(column.zw) + bitcast<vec2<f32>>(row.zw);
    let turn = bitcast<vec2<f32>>(octaves[2u * octave + 1u].xy);
    let du = exact(turn.x * away.x) - exact(turn.y * away.y);
    let dv = exact(turn.y * away.x) + exact(turn.x * away.y);
    return noise(plane_of(octave), stepped(whole.x, rest.x + du), stepped(whole.y, rest.y + dv));
}
