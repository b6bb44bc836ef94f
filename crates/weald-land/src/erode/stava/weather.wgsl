
// Water that comes and goes, and the height of all that is solid; the twin of weather.rs.

@compute @workgroup_size(16, 16)
fn weather_and_ground(@builtin(global_invocation_id) invocation: vec3<u32>) {
    let cell = cell_of(invocation);
    let at = index(cell);
    let before = carried[at].x;
    let share = painted_of(at);
    let wet = exact(before + (weather.rain * share.x + max(share.z, 0.0)) * valid(cell));
    let dried = (weather.evaporation * share.y + max(-share.z, 0.0)) * valid(cell);
    let depth = exact(without_negligible(wet - min(dried, wet)));
    tally(RAINED, cell, wet - before);
    tally(EVAPORATED, cell, depth - wet);
    drain_sediment(cell, wet, share.z);
    if (inside(cell)) {
        levels[at] = vec2<f32>(pile(at) + regolith_of(at), depth);
    }
}
