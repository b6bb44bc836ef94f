// Twin of `cover.rs`: what grows and lies on the ground.

// Slope that bumps come near but do not pass.
const STEEPEST = 0.75;

struct SurfacePoint {
    place: vec2<f32>,
    point: vec3<f32>,
    slope: f32,
    fall: vec2<f32>,
    footprint: f32,
}

// With the shares of wood, scree, rock and snow, which have detail of their own from close by.
struct SurfaceSample {
    albedo: vec3<f32>,
    bump: vec2<f32>,
    kinds: vec4<f32>,
}

struct Texture {
    broad: f32,
    fine: Grain,
    streak: f32,
}

fn mixed(skin: SurfaceSample, other: SurfaceSample, share: f32) -> SurfaceSample {
    return SurfaceSample(
        mix(skin.albedo, other.albedo, share), mix(skin.bump, other.bump, share), mix(skin.kinds, other.kinds, share),
    );
}

// 0 below `low`, 1 above `high`, smooth between.
fn ramp(value: f32, low: f32, high: f32) -> f32 {
    let share = clamp((value - low) / (high - low), 0.0, 1.0);
    return share * share * (3.0 - 2.0 * share);
}

fn rough(texture: Texture, strength: f32) -> vec2<f32> {
    return strength * scene.scale.x * texture.fine.slope;
}

// Colour and roughness of a point.
fn cover_at(spot: SurfacePoint) -> SurfaceSample {
    let coloured = clamp(smooth_at(materials, spot.place).xyz, vec3<f32>(0.01), vec3<f32>(0.95));
    if scene.has.z > 1.0 {
        // The values of a layer, which nothing of the ground's own may hide.
        return SurfaceSample(min(coloured, vec3<f32>(0.9)), vec2<f32>(0.0), vec4<f32>(0.0));
    }
    let cell = scene.scale.x;
    var texture: Texture;
    texture.broad = octaves_at(Octaves(26.0 * cell, 5u, 0.55, 0x11u), spot.point.xy, spot.footprint).value;
    texture.fine = octaves_at(Octaves(2.4 * cell, 7u, 0.66, 0x12u), spot.point.xy, spot.footprint);
    texture.streak = streak(spot);
    var skin: SurfaceSample;
    if scene.has.z > 0.0 {
        skin = of_material(spot, coloured, texture);
    } else {
        skin = natural(spot, texture);
    }
    skin.albedo = clamp(skin.albedo, vec3<f32>(0.01), vec3<f32>(0.9));
    skin.bump /= sqrt(1.0 + dot(skin.bump, skin.bump) / (STEEPEST * STEEPEST));
    return skin;
}

fn natural(spot: SurfacePoint, texture: Texture) -> SurfaceSample {
    let fine = texture.fine.value;
    let patchy = 0.6 * texture.broad + 0.4 * fine;
    let here = smooth_at(site, spot.place);
    let moisture = here.x;
    let high = spot.point.z / max(scene.limits.w, 1e-3);
    let turf = grass(moisture + 0.55 * patchy, high + 0.25 * patchy) * (1.0 + 0.5 * fine + 0.35 * texture.streak);
    let wooded = trees(spot, moisture, patchy);
    let crown = clamp(0.4 + 1.1 * fine + 0.5 * texture.broad, 0.0, 1.0);
    let meadow = SurfaceSample(turf, rough(texture, 0.16), vec4<f32>(0.0));
    let wood = SurfaceSample(mix(scene.forest_dark.xyz, scene.forest_light.xyz, crown), rough(texture, 0.55), vec4<f32>(1.0, 0.0, 0.0, 0.0));
    let green = mixed(meadow, wood, wooded);

    let soil = here.y;
    let steep = spot.slope / scene.limits.x + 0.25 * patchy + 0.55 * texture.streak + 0.4 * (0.4 - soil);
    let pebbles = scene.scree.xyz * (1.0 + 0.45 * fine + 0.4 * texture.streak);
    let scree = SurfaceSample(pebbles, rough(texture, 0.18), vec4<f32>(0.0, 1.0, 0.0, 0.0));
    let stony = mixed(green, scree, 0.8 * ramp(steep, 0.97, 1.10) * (1.0 - 0.6 * wooded));
    let bare = SurfaceSample(rock(spot, texture), rough(texture, 0.45), vec4<f32>(0.0, 0.0, 1.0, 0.0));
    let ground = mixed(stony, bare, ramp(steep, 1.08, 1.22));
    let snow = SurfaceSample(scene.snow.xyz * (1.0 + 0.12 * texture.streak), rough(texture, 0.10), vec4<f32>(0.0, 0.0, 0.0, 1.0));
    return mixed(ground, snow, snow_share(spot, moisture, patchy));
}

// Noise drawn out along the fall line.
fn streak(spot: SurfacePoint) -> f32 {
    let steep = ramp(spot.slope / scene.limits.x, 0.35, 0.8);
    if steep <= 0.0 {
        return 0.0;
    }
    let marks = Octaves(1.1 * scene.scale.x, 3u, 0.75, 0x13u);
    var sum = 0.0;
    for (var step = -2; step <= 2; step++) {
        let ray_length = f32(step) * 0.55 * marks.wavelength;
        sum += octaves_at(marks, spot.point.xy + ray_length * spot.fall, spot.footprint).value;
    }
    return steep * 0.55 * sum;
}

fn grass(moisture: f32, high: f32) -> vec3<f32> {
    let parched = mix(scene.dry.xyz, scene.meadow.xyz, ramp(moisture, 0.15, 0.5));
    let low = mix(parched, scene.lush.xyz, ramp(moisture, 0.5, 0.85));
    return mix(low, mix(scene.alpine.xyz, scene.dry.xyz, ramp(moisture, 0.6, 0.2)), ramp(high, 0.35, 0.8));
}

// Share of forest.
fn trees(spot: SurfacePoint, moisture: f32, patchy: f32) -> f32 {
    let line = (scene.limits.y - spot.point.z) / max(0.12 * scene.limits.w, 1e-3);
    let steep = ramp(spot.slope / scene.limits.x, 0.85, 1.15);
    let wood = 1.1 * (moisture - 0.5) + 0.9 * patchy + 0.4 * clamp(line, -2.0, 0.8) - 0.5 * steep;
    return ramp(wood, 0.10, 0.24);
}

// Rock with its beds: light and dark, sunk into cracks.
fn rock(spot: SurfacePoint, texture: Texture) -> vec3<f32> {
    let bed = 0.035 * max(scene.limits.w, 1e-3);
    let level = spot.point.z / bed + 1.2 * texture.broad;
    let beds = grain(vec2<f32>(level, 0.4), 0x21u).value + 0.6 * grain(vec2<f32>(2.7 * level, 0.7), 0x22u).value;
    let warmth = clamp(0.5 + 1.0 * beds + 0.6 * texture.broad, 0.0, 1.0);
    let stone = mix(scene.rock_grey.xyz, scene.rock_warm.xyz, warmth);
    let cracks = 0.35 - 0.9 * texture.fine.value - 0.9 * texture.streak;
    return mix(stone, scene.rock_dark.xyz, clamp(cracks, 0.0, 1.0));
}

// Snow on gentle ground above its line, and in patches somewhat below it.
fn snow_share(spot: SurfacePoint, moisture: f32, patchy: f32) -> f32 {
    if scene.limits.z >= 1e30 {
        return 0.0;
    }
    let above = (spot.point.z - scene.limits.z) / max(0.10 * scene.limits.w, 1e-3);
    let hold = 1.25 - spot.slope / scene.limits.x;
    let hollow = moisture - 0.5;
    return ramp(above + 1.6 * min(hold, 0.6) + 1.2 * hollow + 1.1 * patchy, 0.55, 0.95);
}

fn of_material(spot: SurfacePoint, albedo: vec3<f32>, texture: Texture) -> SurfaceSample {
    let steep = ramp(spot.slope, 0.5, 1.2);
    let bed = 0.03 * max(scene.limits.w, 1e-3);
    let level = spot.point.z / bed + 0.8 * texture.broad;
    let beds = grain(vec2<f32>(level, 0.4), 0x21u).value + 0.6 * grain(vec2<f32>(3.1 * level, 0.7), 0x22u).value;
    let fine = (0.3 + 0.3 * steep) * texture.fine.value + 0.6 * texture.streak;
    let tone = 1.0 + 0.28 * texture.broad + fine + 0.5 * steep * beds;
    return SurfaceSample(albedo * tone, rough(texture, 0.12 + 0.4 * steep), vec4<f32>(0.0, 0.3, 0.7 * steep, 0.0));
}
