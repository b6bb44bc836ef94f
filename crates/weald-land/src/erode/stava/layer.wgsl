
// Planes one after another in a buffer, one a material.

/// Where a material of a cell stands in a buffer of all materials.
fn layer_of(material: u32, at: u32) -> u32 {
    return material * (grid.columns * grid.rows) + at;
}
