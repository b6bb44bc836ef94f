// Twin of `materials.rs`: ground of the materials that a recipe names.

// What blocks of a material and the cracks between them add to its tone.
const BLOCKS = vec2<f32>(0.6, 1.3);

// Slopes from which a face of a material shows its beds, and shows them whole; and by how many cells times their noise materials
// reach into each other, on gentle ground and on such faces.
const BEDDED = vec2<f32>(0.5, 1.2);
const MINGLED = vec2<f32>(3.0, 0.3);

// Longest wavelength of the grain of a steep face over the thickness of a bed.
const GRAINED = 1.8;

// Spacing of trees over that of bushes and boulders; the share of the places for them that are taken where they are densest.
const CLOSER = 0.8;
const SCATTERED = 0.95;

// Slopes from which they become fewer and from which there are none, and from which more and more of them are boulders.
const BUSHY = vec2<f32>(0.6, 0.95);
const LOOSE = vec2<f32>(0.3, 0.6);

// Share of light that bushes send back, and boulders beside the material that they lie on.
const BUSH = vec3<f32>(0.092, 0.102, 0.046);
const BOULDER = vec3<f32>(0.9, 0.88, 0.86);

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
fn scattered(spot: SurfacePoint, texture: Texture) -> Canopy {
    let patchy = ramp(texture.broad + 0.6 * texture.fine.value, -1.4, 0.8);
    let density = SCATTERED * patchy * (1.0 - ramp(spot.slope, BUSHY.x, BUSHY.y));
    let footprint = CLOSER * spot.footprint;
    let seen = seen_crown(CLOSER * spot.point.xy, density, footprint, aslant(spot));
    return canopy_of(seen, density, footprint);
}

// Noise of a steep face, on the upright planes beside it: on the level plane it would be drawn out downward.
fn grain_of_wall(spot: SurfacePoint, thick: f32) -> f32 {
    let octaves = Octaves(GRAINED * thick, 6u, 0.6, 0x17u);
    let shares = spot.fall * spot.fall;
    let on_east = octaves_at(octaves, spot.point.yz, spot.footprint).value;
    return shares.x * on_east + shares.y * octaves_at(octaves, spot.point.xz, spot.footprint).value;
}

fn of_material(spot: SurfacePoint, albedo: vec3<f32>, texture: Texture) -> SurfaceSample {
    let steep = ramp(spot.slope, BEDDED.x, BEDDED.y);
    let thick = 0.03 * max(scene.limits.w, 1e-3);
    let bedding = bedding_at(spot, vec2<f32>(thick, thick / 4.1), 0.3 * texture.broad + torn(texture), false);
    let tones = 0.8 * bedding.thick.tone + 0.8 * bedding.thin.tone;
    let bedded = tones - 0.35 * bedding.thick.joint - 0.25 * bedding.thin.joint;
    var blocks = Fractures(0.0, 0.0, vec2<f32>(0.0), 0.0);
    var grained = 0.0;
    if steep > 0.0 {
        blocks = rock_fractures(spot, texture, false);
        grained = grain_of_wall(spot, thick);
    }
    let fine = 0.4 * (1.0 - steep) * texture.fine.value + steep * (0.9 * grained + 0.7 * texture.crags.height);
    let broken = BLOCKS.x * blocks.tone - BLOCKS.y * blocks.crack;
    let tone = max(1.0 + 0.28 * texture.broad + fine + steep * (bedded + broken), 0.2);
    let ledge = steep * (0.35 * bedding.thick.ledge + 0.25 * bedding.thin.ledge);
    let slope = rough(texture, 0.16, 0.3 + 2.6 * steep) - spot.fall * ledge + steep * facets_of(spot) * blocks.facet;
    let bump = no_steeper(slope, mix(STEEPEST, STEEPEST_ROCK, steep));
    let bushes = scattered(spot, texture);
    let kinds = vec4<f32>(0.0, 0.3, 0.7 * steep, 0.0);
    let shaded = SurfaceSample(albedo * (tone * bushes.open), bump, kinds);
    let loose = 0.7 * ramp(spot.slope, LOOSE.x, LOOSE.y);
    let kind = mix(BUSH, BOULDER * albedo, ramp(bushes.chance + loose, 0.8, 0.88));
    let bush = SurfaceSample(kind * (0.35 + bushes.tone), no_steeper(bushes.slope, STEEPEST_CROWN), kinds);
    return mixed(shaded, bush, 0.85 * bushes.share);
}
