
// Heights of the tops of all materials, from the bedrock up.

@compute @workgroup_size(16, 16)
fn pile_up(@builtin(global_invocation_id) invocation: vec3<u32>) {
    let cell = cell_of(invocation);
    let at = index(cell);
    if (!inside(cell)) {
        return;
    }
    var top = base[at] + column[at];
    tops[at] = top;
    for (var material = 1u; material < MATERIALS; material++) {
        top += column[layer_of(material, at)];
        tops[layer_of(material, at)] = top;
    }
}
