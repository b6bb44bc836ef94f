
// MacCormack transport that loses nothing; the twin of flux_corrected.rs, which has the equations and their
// sources.
//
// A model says what is carried and by what: settled_sediment(cell), water_before(cell), and the water through
// the eastern and southern faces, face_east(cell) and face_south(cell).

fn face_west(cell: vec2<i32>) -> f32 {
    return select(0.0, face_east(cell + WEST), cell.x > 0);
}

fn face_north(cell: vec2<i32>) -> f32 {
    return select(0.0, face_south(cell + NORTH), cell.y > 0);
}

/// Sediment in a unit of water, and the water that it is mixed in: never less than what flows out.
struct Mixed {
    concentration: f32,
    volume: f32,
}

fn mixed(cell: vec2<i32>) -> Mixed {
    let outflow = outflow_by(face_east(cell), face_west(cell), face_south(cell), face_north(cell));
    let volume = max(max(water_before(cell), 0.0) + constants.epsilon, outflow * (1.0 + RETAINED_SHARE));
    return Mixed(settled_sediment(cell) / volume, volume);
}

/// Antidiffusive flux through a face, positive to the east or south.
fn antidiffusion(flux: f32, here: Mixed, next: Mixed) -> f32 {
    let volume = select(next.volume, here.volume, flux > 0.0);
    let still = 1.0 - abs(flux) / volume;
    return 0.5 * abs(flux) * still * (next.concentration - here.concentration);
}
