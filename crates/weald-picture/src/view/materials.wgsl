// Twin of `materials.rs`: ground of the materials that a recipe names.

// What beds of a face add to its tone, and the thick and the thin joints between them.
const BEDS = 0.48;
const JOINTS = vec2<f32>(0.45, 0.25);

// What blocks of a material and the cracks between them add to its tone, how much they lean beside those of other rock, and the
// pixel at which they are looked at over that of the picture.
const BLOCKS = vec2<f32>(0.5, 2.4);
const LEANING = 1.5;
const SHARP = 0.7;

// By how many of its beds the edge of one is ragged beside those of other rock.
const TORN_BEDS = 0.4;

// How fast ground grows darker by what is taken from its tone, which never comes to 0.
const DARKER = 1.2;

// Slopes from which a face of a material shows its beds, and shows them whole; and by how many cells times their noise materials
// reach into each other, on gentle ground and on such faces.
const BEDDED = vec2<f32>(0.5, 1.2);
const MINGLED = vec2<f32>(3.0, 0.3);

// Cells uphill of such a face where the column still has what the face has lost, and the least softness of the edge of a material.
const UPHILL = 1.5;
const SOFT = 0.15;

// How ragged the edge of a material is by the grain of a face, in thicknesses of a bed.
const TORN_EDGE = 0.25;

// Longest wavelength of the grain of a steep face over the thickness of a bed.
const GRAINED = 1.8;

// Spacing of trees over that of bushes and boulders; the share of the places for them that are taken where they are densest.
const CLOSER = 1.05;
const SCATTERED = 0.62;

// Height of trees over that of bushes: shadows are as short as those of trees under a sun that is as much higher.
const LOWER = 2.3;

// Slopes from which they become fewer and from which there are none, and from which more and more of them are boulders; what
// such slopes and rubble add to the chance that one is, and the chances from which some are, and all.
const BUSHY = vec2<f32>(0.6, 0.95);
const LOOSE = vec2<f32>(0.3, 0.6);
const LOOSER = 0.3;
const BOULDERS = vec2<f32>(0.86, 0.92);

// What patches and fine detail add to the tone of gentle ground, and how rough that is.
const PATCHES = 0.48;
const DETAIL = 0.3;
const ROUGH = 0.16;

// Rubble below walls: how much rougher it is by crags than other ground, and the share of bushes that do not grow on it.
const RUBBLE_ROUGH = 0.8;
const RUBBLE_BARE = 0.5;

// How many times as close together stones are as bushes, the share of their places that are taken, on other ground and
// in rubble, and slopes from which fewer lie, and from which none do.
const STONY = 2.7;
const STONES = vec2<f32>(0.06, 0.6);
const STONELESS = vec2<f32>(0.7, 1.2);

// Share of light that bushes send back, and boulders beside the material that they lie on.
const BUSH = vec3<f32>(0.066, 0.074, 0.034);
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
fn scattered(spot: SurfacePoint, texture: Texture, rubble: f32) -> Canopy {
    let patchy = ramp(texture.broad + 0.6 * texture.fine.value, -1.4, 0.8);
    let grown = (1.0 - ramp(spot.slope, BUSHY.x, BUSHY.y)) * (1.0 - RUBBLE_BARE * rubble);
    let density = SCATTERED * patchy * grown;
    return crowns_of(spot, CLOSER, density);
}

// Crowns so many times as close together as those of trees, of a density.
fn crowns_of(spot: SurfacePoint, closer: f32, density: f32) -> Canopy {
    let footprint = closer * spot.footprint;
    let seen = seen_crown(closer * spot.point.xy, density, footprint, aslant(spot));
    return canopy_of(seen, density, footprint, vec3<f32>(scene.sun.xy, LOWER * scene.sun.z));
}

// Noise of a steep face, on the upright planes beside it: on the level plane it would be drawn out downward.
fn grain_of_wall(spot: SurfacePoint, thick: f32) -> f32 {
    let octaves = Octaves(GRAINED * thick, 6u, 0.6, 0x17u);
    let shares = spot.fall * spot.fall;
    // On lattices that stand upright it would be drawn in bars.
    let on_east = octaves_at(octaves, turned_lattice(spot.point.yz), spot.footprint).value;
    let on_north = octaves_at(octaves, turned_lattice(spot.point.xz), spot.footprint).value;
    return shares.x * on_east + shares.y * on_north;
}

// Colour of ground of a colour, of which a share is a face that shows the edges of its beds, ragged by so many metres.
fn with_face(spot: SurfacePoint, albedo: vec3<f32>, steep: f32, ragged: f32) -> vec3<f32> {
    let cells = UPHILL * scene.scale.w / scene.grid.zw;
    let there = spot.place + cells * spot.bed.yz;
    let soft = max(SOFT, 0.5 * spot.footprint * min(spot.slope, 1.0));
    let height = spot.bed.x + ragged;
    // What is gentle turns no loop, which software would take for all pixels.
    let count = select(0, i32(scene.strata.z), steep > 0.0);
    let face = strata_material(there, height, soft, count);
    // What stands higher than the ground uphill of it is a crest, of which that does not tell.
    let share = select(0.0, steep * (1.0 - ramp(height - face.w, -soft, soft)), count > 0);
    return mix(albedo, face.xyz, share);
}

// What colour is multiplied by where so much is added to its tone.
fn toned(more: f32) -> f32 {
    return select(1.0 + more, 1.0 / (1.0 - DARKER * more), more < 0.0);
}

fn of_material(spot: SurfacePoint, mingled: vec3<f32>, texture: Texture) -> SurfaceSample {
    let steep = ramp(spot.slope, BEDDED.x, BEDDED.y);
    let thick = 0.03 * max(scene.limits.w, 1e-3);
    let fold = 0.3 * texture.broad + TORN_BEDS * torn(texture);
    let bedding = bedding_at(spot, vec2<f32>(thick, thick / 4.1), fold, false);
    let tones = BEDS * (bedding.thick.tone + bedding.thin.tone);
    let bedded = tones - JOINTS.x * bedding.thick.joint - JOINTS.y * bedding.thin.joint;
    var blocks = Fractures(0.0, 0.0, vec2<f32>(0.0), 0.0);
    var grained = 0.0;
    if steep > 0.0 {
        var sharper = spot;
        sharper.footprint *= SHARP;
        blocks = rock_fractures(sharper, texture, false);
        grained = grain_of_wall(spot, thick);
    }
    let albedo = with_face(spot, mingled, steep, TORN_EDGE * thick * grained);
    let rubble = (1.0 - steep) * smooth_at(site, spot.place).w;
    let gentle = (1.0 - steep) * (PATCHES * texture.broad + DETAIL * texture.fine.value);
    let broken = BLOCKS.x * blocks.tone - BLOCKS.y * blocks.crack;
    let tone = toned(gentle + steep * (bedded + broken));
    let ledge = steep * (0.35 * bedding.thick.ledge + 0.25 * bedding.thin.ledge);
    let uneven = rough(texture, (1.0 - steep) * ROUGH, 0.3 + 1.2 * steep + RUBBLE_ROUGH * rubble);
    let slope = uneven - spot.fall * ledge + steep * LEANING * facets_of(spot) * blocks.facet;
    let bump = no_steeper(slope, mix(STEEPEST, STEEPEST_ROCK, steep));
    let bushes = scattered(spot, texture, rubble);
    let kinds = vec4<f32>(0.0, 0.3, 0.7 * steep, 0.0);
    // It is darker below bushes than below trees, whose crowns begin higher up.
    let shaded = SurfaceSample(albedo * (tone * bushes.open * bushes.open), bump, kinds);
    let loose = LOOSER * (ramp(spot.slope, LOOSE.x, LOOSE.y) + rubble);
    let kind = mix(BUSH, BOULDER * albedo, ramp(bushes.chance + loose, BOULDERS.x, BOULDERS.y));
    let bush = SurfaceSample(kind * (0.35 + bushes.tone), no_steeper(bushes.slope, STEEPEST_CROWN), kinds);
    return mixed(with_stones(spot, albedo, rubble, shaded), bush, 0.85 * bushes.share);
}

// Share of the places for stones that are taken on such a slope, of which a share is rubble.
fn stony(slope: f32, rubble: f32) -> f32 {
    let lies = 1.0 - ramp(slope, STONELESS.x, STONELESS.y);
    return lies * mix(STONES.x, STONES.y, rubble);
}

// Ground with the stones of its rubble.
fn with_stones(spot: SurfacePoint, albedo: vec3<f32>, rubble: f32, ground: SurfaceSample) -> SurfaceSample {
    let stones = crowns_of(spot, STONY * CLOSER, stony(spot.slope, rubble));
    let colour = BOULDER * albedo * (0.55 + 0.9 * stones.tone);
    let stone = SurfaceSample(colour, no_steeper(stones.slope, STEEPEST_CROWN), ground.kinds);
    return mixed(SurfaceSample(ground.albedo * stones.open, ground.bump, ground.kinds), stone, stones.share);
}
