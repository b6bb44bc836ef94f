// Twin of `materials.rs`: ground of the materials that a recipe names.

// What blocks of a material and the cracks between them add to its tone.
const BLOCKS = vec2<f32>(0.6, 1.3);

// Slopes from which a face of a material shows its beds, and shows them whole; and by how many cells times their noise materials
// reach into each other, on gentle ground and on such faces.
const BEDDED = vec2<f32>(0.5, 1.2);
const MINGLED = vec2<f32>(3.0, 0.3);

// How many times smaller than trees bushes and boulders are, how densely they lie at most, and how much light the
// one and the other send back beside the material that they stand on.
const SMALLER = 1.1;
const SCATTERED = 0.6;
const BUSH = vec3<f32>(0.34, 0.42, 0.28);
const BOULDER = vec3<f32>(1.25, 1.2, 1.15);

// Colour of the material at a place.
fn material_at(place: vec2<f32>) -> vec3<f32> {
    return clamp(smooth_at(materials, place).xyz, vec3<f32>(0.01), vec3<f32>(0.95));
}

// The place of which the material lies at a point: materials mingle along their borders.
fn mingled(spot: SurfacePoint, texture: Texture) -> vec2<f32> {
    let cells = mix(MINGLED.x, MINGLED.y, ramp(spot.slope, BEDDED.x, BEDDED.y));
    return spot.place + cells * scene.scale.w / scene.grid.zw * vec2<f32>(texture.fine.value, texture.crags.height);
}

// By how many beds the edge of one is ragged.
fn torn(texture: Texture) -> f32 {
    return 0.12 * texture.fine.value + 0.22 * texture.crags.height;
}

// Bushes and boulders on gentle ground of materials: the share that they hide, and the light that they leave beside them.
fn scattered(spot: SurfacePoint, texture: Texture, steep: f32) -> Canopy {
    let density = SCATTERED * ramp(texture.broad + 0.6 * texture.fine.value, -0.35, 0.5) * (1.0 - steep);
    return canopy_of(SMALLER * spot.point.xy, density, SMALLER * spot.footprint);
}

fn of_material(spot: SurfacePoint, albedo: vec3<f32>, texture: Texture) -> SurfaceSample {
    let steep = ramp(spot.slope, BEDDED.x, BEDDED.y);
    let thick = 0.03 * max(scene.limits.w, 1e-3);
    let bedding = bedding_at(spot, vec2<f32>(thick, thick / 4.1), 0.3 * texture.broad + torn(texture), false);
    let fine = (0.4 - 0.25 * steep) * texture.fine.value + 1.1 * steep * texture.crags.height;
    let tones = 0.9 * bedding.thick.tone + 1.1 * bedding.thin.tone;
    let bedded = tones - 0.7 * bedding.thick.joint - 0.6 * bedding.thin.joint;
    var blocks = Fractures(0.0, 0.0, vec2<f32>(0.0), 0.0);
    if steep > 0.0 {
        blocks = rock_fractures(spot, texture, false);
    }
    let broken = BLOCKS.x * blocks.tone - BLOCKS.y * blocks.crack;
    let tone = max(1.0 + 0.28 * texture.broad + fine + steep * (bedded + broken), 0.2);
    let ledge = steep * (0.35 * bedding.thick.ledge + 0.25 * bedding.thin.ledge);
    let slope = rough(texture, 0.16, 0.3 + 2.6 * steep) - spot.fall * ledge + steep * facets_of(spot) * blocks.facet;
    let bump = no_steeper(slope, mix(STEEPEST, STEEPEST_ROCK, steep));
    let bushes = scattered(spot, texture, steep);
    let kinds = vec4<f32>(0.0, 0.3, 0.7 * steep, 0.0);
    let shaded = SurfaceSample(albedo * (tone * bushes.open), bump, kinds);
    let kind = mix(BUSH, BOULDER, ramp(bushes.chance, 0.55, 0.65));
    let bush = SurfaceSample(kind * albedo * (0.35 + bushes.tone), no_steeper(bushes.slope, STEEPEST_CROWN), kinds);
    return mixed(shaded, bush, 0.85 * bushes.share);
}
