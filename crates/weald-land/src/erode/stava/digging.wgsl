
// Taking from a column of materials from the top down, and laying down what is too much; the twin of digging.rs.

/// Exchanges the materials of a cell with what is carried, and gives what is carried then. `which` picks the shares
/// of the materials.
fn dig(at: u32, room: f32, found: f32, which: u32, deposition: f32) -> f32 {
    var above = 0.0;
    var taken = 0.0;
    for (var material = MATERIALS - 1u; material > 0u; material--) {
        let place = layer_of(material, at);
        let thickness = column[place];
        let wanted = constants.materials[material][which] * max(room - above, 0.0);
        let left = exact(without_negligible(thickness - min(wanted, thickness)));
        taken += thickness - left;
        above += thickness;
        column[place] = left;
    }
    let bedrock = exact(column[at] - constants.materials[0][which] * max(room - above, 0.0));
    taken += column[at] - bedrock;
    column[at] = bedrock;
    return lay_down(layer_of(DEPOSIT, at), room, found, taken, deposition);
}

/// A number less this share of itself rounds to the next lower one.
const LAST_DIGIT: f32 = 1.5 * 0.5 * 1.1920929e-7;

/// Lays down a share of the surplus, and adds what was taken. A thickness that rounds up by more than is carried is
/// rounded down.
fn lay_down(place: u32, room: f32, found: f32, taken: f32, deposition: f32) -> f32 {
    let thickness = column[place];
    let up = exact(thickness + deposition * max(-room, 0.0));
    let down = max(exact(up - abs(up) * LAST_DIGIT), thickness);
    let after = select(down, up, up - thickness <= found);
    column[place] = after;
    return without_negligible(found + (taken - (after - thickness)));
}
