// A plant as it is seen in a view: what all corners of its leaves have in common, in the order of the lists. It is worked out
// once, when plants are chosen.
struct SeenPlant {
    // East, north, up.
    place: vec3<f32>,
    // Height in metres.
    size: f32,
    // The quaternion that turns it, to axes east, up, south.
    turn: vec4<f32>,
    // The push of the wind along x and z of the plant, and its phase there.
    push: vec2<f32>,
    phase: f32,
    // Its level of detail, the share of their breadth that its leaves have near the eye, and how old it is, 0 to 1.
    detail: f32,
    breadth: f32,
    age: f32,
    // The side from which the wind of its shared seats comes.
    side: u32,
}

// Steps in which ages, phases and breadths are stored.
const AGES = 31.0;
const PHASES = 4095.0;
const BREADTHS = 255.0;

fn packed_seen(plant: SeenPlant) -> Record {
    let phase = u32(round(PHASES * fract(plant.phase)));
    let age = u32(round(AGES * clamp(plant.age, 0.0, 1.0)));
    let breadth = u32(round(BREADTHS * clamp(plant.breadth, 0.0, 1.0)));
    let second = vec4<u32>(
        pack2x16snorm(plant.turn.xy),
        pack2x16snorm(plant.turn.zw),
        pack2x16float(plant.push),
        phase | (age << 12u) | (breadth << 17u) | (plant.side << 25u),
    );
    let stature = pack2x16float(vec2<f32>(plant.size, plant.detail));
    return Record(vec4<u32>(bitcast<vec3<u32>>(plant.place), stature), second);
}

fn unpacked_seen(record: Record) -> SeenPlant {
    let stature = unpack2x16float(record.first.w);
    let rest = record.second.w;
    return SeenPlant(
        bitcast<vec3<f32>>(record.first.xyz),
        stature.x,
        vec4<f32>(unpack2x16snorm(record.second.x), unpack2x16snorm(record.second.y)),
        unpack2x16float(record.second.z),
        f32(rest & 4095u) * (1.0 / PHASES),
        stature.y,
        f32((rest >> 17u) & 255u) * (1.0 / BREADTHS),
        f32((rest >> 12u) & 31u) * (1.0 / AGES),
        rest >> 25u,
    );
}

fn seen_plant(view: u32, plant: PlacedPlant) -> SeenPlant {
    let breeze = breeze_of(view, plant);
    return SeenPlant(
        plant.place,
        plant.size,
        turn_of(plant),
        breeze.push * breeze.wind.xz,
        plant.phase,
        detail_of(pixels_of(view, plant)),
        giving_way(view, plant),
        // Some plants are older and yellower than others.
        plant.chance * plant.chance,
        side_of(breeze),
    );
}
