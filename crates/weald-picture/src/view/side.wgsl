// Twin of `side.rs`: the cut sides of a landscape.

// The light of the sky and of the plain on a side of that level normal.
fn side_light(normal: vec3<f32>) -> vec3<f32> {
    let turn = atan2(normal.x, normal.y) / (2.0 * PI);
    let place = fract(turn) * f32(SIDE_NORMALS);
    let first = i32(place);
    let low = scene.side_light[first % SIDE_NORMALS].xyz;
    return mix(low, scene.side_light[(first + 1) % SIDE_NORMALS].xyz, place - floor(place));
}

// A rock's colour with its beds, which are gently folded.
fn bedded(colour: vec3<f32>, point: vec3<f32>, height: f32, seed: u32) -> vec3<f32> {
    let fold = octaves_at(Octaves(60.0 * scene.strata.x, 2u, 0.4, 0x71u), point.xy, 0.0).value;
    let level = height / scene.strata.x + 5.0 * fold;
    let thick = grain(vec2<f32>(0.7 * level, 0.37), 0x72u + seed).value;
    let thin = grain(vec2<f32>(3.1 * level, 0.61), 0x73u + seed).value;
    let tone = 0.82 + 0.7 * thick + 0.35 * thin;
    let warmth = 0.16 * grain(vec2<f32>(0.9 * level, 5.3), 0x74u).value;
    let tint = 1.0 + warmth * vec3<f32>(1.0, 0.0, -1.0);
    return clamp(colour * tone * tint, vec3<f32>(0.01), vec3<f32>(0.9));
}

// Thickness of a material above the bedrock, counted from 0.
fn strata_thickness(place: vec2<f32>, material: i32) -> f32 {
    let controls = vec2<f32>(textureDimensions(strata));
    let share = (share_of(place) * (controls - 4.0) + 2.0) / controls;
    return max(textureSampleLevel(strata, between, share, material / 4, 0.0)[material % 4], 0.0);
}

// Thickness of a material, in metres, that hides half of what it lies on.
const THINNEST = 0.05;

// The thickness of four materials at a place, of which the last is the height of the bedrock, as a spline.
fn strata_spline(place: vec2<f32>, layer: i32) -> vec4<f32> {
    let looks = spline_looks(place, vec2<f32>(textureDimensions(strata)));
    let above = mix(
        textureSampleLevel(strata, between, looks.low, layer, 0.0),
        textureSampleLevel(strata, between, vec2<f32>(looks.high.x, looks.low.y), layer, 0.0),
        looks.share.x,
    );
    let below = mix(
        textureSampleLevel(strata, between, vec2<f32>(looks.low.x, looks.high.y), layer, 0.0),
        textureSampleLevel(strata, between, looks.high, layer, 0.0),
        looks.share.x,
    );
    return mix(above, below, looks.share.y);
}

// Colour of the material, of so many above the bedrock, that lies at a place and a height in metres, where edges between materials
// are so many metres soft, and the height of the uppermost there.
fn strata_material(place: vec2<f32>, height: f32, soft: f32, count: i32) -> vec4<f32> {
    var colour = scene.strata_bedrock.xyz;
    var bottom = 0.0;
    var thickness = vec4<f32>(0.0);
    for (var material = 0; material < count; material++) {
        if material == 0 {
            bottom = strata_spline(place, 1).w;
        }
        if material % 4 == 0 {
            thickness = strata_spline(place, material / 4);
        }
        let own = max(thickness[material % 4], 0.0);
        let share = ramp(height - bottom, -soft, soft) * own / (own + THINNEST);
        colour = mix(colour, scene.strata_colours[material].xyz, share);
        bottom += own;
    }
    return vec4<f32>(colour, bottom);
}

// Colour of the ground at a place and a height in metres, whose surface is at `surface`.
fn strata_albedo(place: vec2<f32>, point: vec3<f32>, height: f32, surface: f32) -> vec3<f32> {
    var roof = surface;
    // As `is_above` has it: what hangs on the number alone would have software copy the shader.
    let count = i32(scene.strata.z + min(place.x + FAR_AWAY, 0.0));
    for (var material = count - 1; material >= 0; material--) {
        roof -= strata_thickness(place, material);
        if height >= roof {
            return bedded(scene.strata_colours[material].xyz, point, height, u32(material) + 1u);
        }
    }
    let bare = bedded(scene.strata_bedrock.xyz, point, height, 0u);
    if count > 0 {
        return bare;
    }
    let deep = (surface - height) / max(scene.strata.y, 1e-6);
    return mix(scene.strata_soil.xyz, bare, clamp(2.0 * deep - 1.0, 0.0, 1.0));
}
