
// One doubling of the lattice; the twin of diamond_square.rs. Each point of the finer lattice finds the centres
// beside it by itself.

/// A level: the part of its lattice that is made, the columns of the coarser one, intervals along a side of the
/// whole lattice, the plane of its random numbers and their amplitude.
struct Level {
    columns: u32,
    rows: u32,
    coarse_columns: u32,
    side: u32,
    start: u32,
    key: u32,
    amplitude: f32,
}

fn coarse_at(x: i32, y: i32) -> f32 {
    return coarse[u32(y) * weather.coarse_columns + u32(x)];
}

fn offset(x: i32, y: i32) -> f32 {
    return signed_of(vec2<u32>(weather.start, weather.key), x, y) * weather.amplitude;
}

/// Centre of the square south-east of a coarse point; 0 beyond the border.
fn centre(x: i32, y: i32) -> f32 {
    let squares = i32(weather.side / 2u);
    if (x < 0 || y < 0 || x >= squares || y >= squares) {
        return 0.0;
    }
    let north = coarse_at(x, y) + coarse_at(x + 1, y);
    let south = coarse_at(x, y + 1) + coarse_at(x + 1, y + 1);
    return (north + south) * 0.25 + offset(2 * x + 1, 2 * y + 1);
}

/// Share of each neighbour of the middle of an edge.
fn share_at(place: i32) -> f32 {
    return select(0.25, 1.0f / 3.0f, place == 0 || place == i32(weather.side));
}

fn point_at(x: i32, y: i32) -> f32 {
    if (weather.side == 1u) {
        return offset(x, y);
    }
    let west = x / 2;
    let north = y / 2;
    switch (u32(x) % 2u) * 2u + u32(y) % 2u {
        case 0u: {
            return coarse_at(west, north);
        }
        case 1u: {
            let ends = coarse_at(west, north) + coarse_at(west, north + 1);
            return (ends + (centre(west - 1, north) + centre(west, north))) * share_at(x) + offset(x, y);
        }
        case 2u: {
            let ends = coarse_at(west, north) + coarse_at(west + 1, north);
            return (ends + (centre(west, north - 1) + centre(west, north))) * share_at(y) + offset(x, y);
        }
        default: {
            return centre(west, north);
        }
    }
}

@compute @workgroup_size(16, 16)
fn refine(@builtin(global_invocation_id) invocation: vec3<u32>) {
    let cell = cell_of(invocation);
    if (u32(cell.x) < weather.columns && u32(cell.y) < weather.rows) {
        fine[u32(cell.y) * weather.columns + u32(cell.x)] = point_at(cell.x, cell.y);
    }
}
