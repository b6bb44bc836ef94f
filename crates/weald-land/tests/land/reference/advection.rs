//! Departure points, found by their coordinates.

use super::World;

/// The cells around the departure point of cell `at` and their bilinear weights. The point lies at most one
/// cell away in each direction and stops before cells without data.
fn departure(world: &World, at: usize, velocity: [f64; 2]) -> Vec<(usize, f64)> {
    let columns = world.columns;
    let linked = |next: usize| world.valid[at] && world.valid.get(next).copied().unwrap_or(false);
    let along = |speed: f64, before: Option<usize>, after: Option<usize>, stride: i64| {
        let upwind = if speed > 0.0 { before } else { after };
        let share = if upwind.is_some_and(linked) { speed.abs().min(1.0) } else { 0.0 };
        let away = if speed > 0.0 { -stride } else { stride };
        [(0, 1.0 - share), (away, share)]
    };
    let (x, y) = (at % columns, at / columns);
    let west = (x > 0).then(|| at - 1);
    let east = (x + 1 < columns).then_some(at + 1);
    let north = (y > 0).then(|| at - columns);
    let across = along(velocity[0], west, east, 1);
    let down = along(velocity[1], north, Some(at + columns), columns as i64);
    let corners = across.iter().flat_map(|a| down.iter().map(move |d| (a.0 + d.0, a.1 * d.1)));
    corners
        .filter(|(_, weight)| *weight > 0.0)
        .map(|(away, weight)| ((at as i64 + away) as usize, weight))
        .collect()
}

/// `s(x - v)`.
pub fn depart(world: &World, values: &[f64], velocity: &[[f64; 2]], direction: f64) -> Vec<f64> {
    let cells = 0..values.len();
    let velocity = |at: usize| velocity[at].map(|speed| speed * direction);
    cells
        .map(|at| departure(world, at, velocity(at)).iter().map(|(from, w)| w * values[*from]).sum())
        .collect()
}

/// `A + (s - B) / 2`, no less and no more than the cells around the departure point hold.
pub fn maccormack(world: &World, velocity: &[[f64; 2]]) -> Vec<f64> {
    let forward = depart(world, &world.sediment, velocity, 1.0);
    let back = depart(world, &forward, velocity, -1.0);
    let corrected = |at: usize| {
        let around: Vec<f64> =
            departure(world, at, velocity[at]).iter().map(|(from, _)| world.sediment[*from]).collect();
        let least = around.iter().copied().fold(world.sediment[at], f64::min);
        let most = around.iter().copied().fold(world.sediment[at], f64::max);
        (forward[at] + (world.sediment[at] - back[at]) / 2.0).clamp(least, most)
    };
    (0..forward.len()).map(corrected).collect()
}
