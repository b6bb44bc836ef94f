
// The column of materials of a cell: change of the bedrock, then thicknesses; the twin of planes.rs.

/// The top of the column: bedrock as start and change, and what lies on it.
fn pile(at: u32) -> f32 {
    var ground = base[at] + column[at];
    for (var material = 1u; material < MATERIALS; material++) {
        ground += column[layer_of(material, at)];
    }
    return ground;
}
