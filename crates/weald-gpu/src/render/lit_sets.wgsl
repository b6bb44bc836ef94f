// Chosen sets and their blades as vertices read them: records of two texels (`records.wgsl`), which `light_sets.wgsl` makes
// anew for each picture.

// What all blades of a set have in common.
struct LitSet {
    root: vec3<f32>,
    // Of the wind.
    push: vec2<f32>,
    // The share of the sun that it sees, and the leaf area around it.
    light: vec2<f32>,
    // Linear light of leaves and of heads.
    leaf: vec3<f32>,
    head: vec3<f32>,
    fold: f32,
    // How high it stands, as a share: it sinks away before it is left out.
    tall: f32,
}

fn packed_set(lit: LitSet) -> Record {
    let rest = vec4<u32>(
        packed_colour(lit.leaf),
        packed_colour(lit.head),
        pack2x16float(lit.light),
        pack2x16float(vec2<f32>(lit.fold, lit.tall)),
    );
    return Record(vec4<u32>(bitcast<vec3<u32>>(lit.root), pack2x16float(lit.push)), rest);
}

fn unpacked_set(record: Record) -> LitSet {
    let shape = unpack2x16float(record.second.w);
    return LitSet(
        bitcast<vec3<f32>>(record.first.xyz),
        unpack2x16float(record.first.w),
        unpack2x16float(record.second.z),
        unpacked_colour(record.second.x),
        unpacked_colour(record.second.y),
        shape.x,
        shape.y,
    );
}

// Ten bits a channel, as many for dark colours as an eye tells apart.
fn packed_colour(linear: vec3<f32>) -> u32 {
    let steps = vec3<u32>(round(1023.0 * sqrt(clamp(linear, vec3<f32>(0.0), vec3<f32>(1.0)))));
    return steps.x | (steps.y << 10u) | (steps.z << 20u);
}

fn unpacked_colour(packed: u32) -> vec3<f32> {
    let root = vec3<f32>(vec3<u32>(packed, packed >> 10u, packed >> 20u) & vec3<u32>(1023u)) * (1.0 / 1023.0);
    return root * root;
}

// A blade without what it has from its set. Its stem begins at its root.
fn packed_blade(blade: Blade) -> Record {
    let stem = blade.stem;
    let points = vec4<u32>(
        pack2x16float(stem.b),
        pack2x16float(stem.c),
        pack2x16float(stem.d),
        pack2x16float(stem.e),
    );
    let rest = vec4<u32>(
        pack2x16float(blade.root),
        pack2x16snorm(blade.facing),
        pack2x16float(vec2<f32>(blade.width, blade.taper)),
        pack2x16float(vec2<f32>(blade.head_length, blade.head_width)),
    );
    return Record(points, rest);
}

fn unpacked_blade(record: Record, lit: LitSet) -> Blade {
    let leaf = unpack2x16float(record.second.z);
    let head = unpack2x16float(record.second.w);
    return Blade(
        Spline(
            vec2<f32>(0.0),
            unpack2x16float(record.first.x),
            unpack2x16float(record.first.y),
            unpack2x16float(record.first.z),
            unpack2x16float(record.first.w),
        ),
        unpack2x16float(record.second.x),
        unpack2x16snorm(record.second.y),
        leaf.x,
        leaf.y,
        lit.fold,
        head.x,
        head.y,
        0.0,
    );
}
