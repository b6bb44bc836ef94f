// Twin of `cover.rs`: what grows and lies on the ground.

// Slope that bumps come near but do not pass.
const STEEPEST = 0.75;
const STEEPEST_CROWN = 1.5;

// Steepness from which rock begins to be bare, and is all that there is.
const ROCK = vec2<f32>(1.08, 1.22);

// Steepness from which trees become fewer, and from which there are none.
const CLIFF = vec2<f32>(0.9, 1.3);

// Share of the slope of crags that counts as that of the ground.
const CRAGGY = 0.6;

// What the highest ground adds to its steepness, and shares of the relief between which that grows.
const BARE = 0.4;
const BARREN = vec2<f32>(0.45, 0.95);

// What crests add and hollows take there, times how dry they are, and shares of the relief between which that grows.
const CRESTS = 1.1;
const SCOURED = vec2<f32>(0.2, 0.6);

// How many times smaller than trees bushes and boulders are, how densely they lie at most, and their share of the light that
// the ground sends back.
const SMALLER = 1.7;
const SCATTERED = 0.3;
const BUSH = vec3<f32>(0.52, 0.6, 0.42);

// Height in metres above the water, and at most that share of a cell, from which trees stand.
const SHORE = vec2<f32>(2.5, 0.028);

// Share of the trees of the point in question that are drawn as such, and so not on the ground.
var<private> trees_drawn: f32 = 0.0;

// What lies under trees that are drawn as such.
const LITTER = vec3<f32>(0.034, 0.032, 0.016);

struct SurfacePoint {
    place: vec2<f32>,
    point: vec3<f32>,
    slope: f32,
    fall: vec2<f32>,
    footprint: f32,
    above: f32,
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
    crags: Crags,
    evenness: f32,
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

fn no_steeper(bump: vec2<f32>, steepest: f32) -> vec2<f32> {
    return bump / sqrt(1.0 + dot(bump, bump) / (steepest * steepest));
}

fn rough(texture: Texture, strength: f32, craggy: f32) -> vec2<f32> {
    return texture.evenness * (strength * scene.scale.x * texture.fine.slope + craggy * texture.crags.slope);
}

fn patchy_of(texture: Texture) -> f32 {
    return 0.6 * texture.broad + 0.4 * texture.fine.value;
}

fn texture_of(spot: SurfacePoint) -> Texture {
    let cell = scene.scale.x;
    var texture: Texture;
    texture.broad = octaves_at(Octaves(26.0 * cell, 5u, 0.55, 0x11u), spot.point.xy, spot.footprint).value;
    texture.fine = octaves_at(Octaves(2.4 * cell, 7u, 0.66, 0x12u), spot.point.xy, spot.footprint);
    texture.crags = crags_at(spot.point, -spot.slope * spot.fall, cell, spot.footprint);
    texture.evenness = pow(clamp(2.0 * spot.footprint / cell, 0.075, 1.0), 0.4);
    return texture;
}

// 1 where rock is bare on the average; trees stand by this.
fn slope_of_cells(spot: SurfacePoint, texture: Texture, soil: f32) -> f32 {
    return spot.slope / scene.limits.x + 0.25 * patchy_of(texture) + 0.4 * (0.4 - soil);
}

// The same, and more on the steep sides of ridges that are finer than cells.
fn steepness(spot: SurfacePoint, texture: Texture, here: vec2<f32>) -> f32 {
    let hilly = ramp(spot.slope / scene.limits.x, 0.35, 0.8);
    let steeper = CRAGGY * hilly * dot(texture.crags.slope, spot.fall);
    let high = spot.point.z / max(scene.limits.w, 1e-3) + 0.25 * patchy_of(texture);
    let barren = BARE * ramp(high, BARREN.x, BARREN.y) + CRESTS * (0.5 - here.x) * ramp(high, SCOURED.x, SCOURED.y);
    return slope_of_cells(spot, texture, here.y) - steeper / scene.limits.x + barren;
}

// How densely trees stand at a point of natural ground.
fn wood_density(spot: SurfacePoint) -> f32 {
    let texture = texture_of(spot);
    let here = smooth_at(site, spot.place);
    let wooded = trees(spot, here.x, patchy_of(texture));
    let bare = ramp(slope_of_cells(spot, texture, here.y), CLIFF.x, CLIFF.y);
    return wooded * (1.0 - bare) * (1.0 - snow_at(spot, texture, here.x));
}

// Colour and roughness of a point.
fn cover_at(spot: SurfacePoint) -> SurfaceSample {
    let coloured = clamp(smooth_at(materials, spot.place).xyz, vec3<f32>(0.01), vec3<f32>(0.95));
    if scene.has.z > 1.0 {
        // The values of a layer, which nothing of the ground's own may hide.
        return SurfaceSample(min(coloured, vec3<f32>(0.9)), vec2<f32>(0.0), vec4<f32>(0.0));
    }
    let texture = texture_of(spot);
    var skin: SurfaceSample;
    if scene.has.z > 0.0 {
        skin = of_material(spot, coloured, texture);
    } else {
        skin = natural(spot, texture);
    }
    skin.albedo = clamp(skin.albedo, vec3<f32>(0.01), vec3<f32>(0.9));
    return skin;
}

fn natural(spot: SurfacePoint, texture: Texture) -> SurfaceSample {
    let fine = texture.fine.value;
    let patchy = patchy_of(texture);
    let ridge = texture.crags.height;
    let here = smooth_at(site, spot.place);
    let moisture = here.x;
    let high = spot.point.z / max(scene.limits.w, 1e-3);
    let turf = grass(moisture + 0.55 * patchy, high + 0.25 * patchy) * (1.0 + 0.3 * fine + 0.3 * ridge);
    let wooded = trees(spot, moisture, patchy);
    let meadow = SurfaceSample(turf, rough(texture, 0.12, 1.4 * ramp(spot.slope, 0.1, 0.7)), vec4<f32>(0.0));

    let steep = steepness(spot, texture, here.xy);
    let pebbles = scene.scree.xyz * (1.0 + 0.45 * fine);
    let scree = SurfaceSample(pebbles, rough(texture, 0.28, 0.8), vec4<f32>(0.0, 1.0, 0.0, 0.0));
    let fallen = 1.1 * here.w + ramp(here.w, 0.0, 0.2) * (0.6 * patchy + 0.6 * fine - 1.2 * ridge);
    let apron = 0.9 * ramp(fallen, 0.4, 1.15) * ramp(spot.slope, 0.32, 0.55);
    let stony = mixed(meadow, scree, max(0.8 * ramp(steep, 0.97, 1.10) * (1.0 - 0.85 * wooded), apron));
    let bare = ramp(steep, ROCK.x, ROCK.y);
    let ground = mixed(stony, rock(spot, texture), bare);
    let snow = SurfaceSample(scene.snow.xyz, rough(texture, 0.08, ramp(spot.slope, 0.2, 0.8)), vec4<f32>(0.0, 0.0, 0.0, 1.0));
    let white = snow_at(spot, texture, moisture);
    var open = mixed(ground, snow, white);
    open.bump = no_steeper(open.bump, STEEPEST);
    let cliff = ramp(slope_of_cells(spot, texture, here.y), CLIFF.x, CLIFF.y);
    return under_trees(spot, open, wooded * (1.0 - cliff) * (1.0 - white));
}

// Ground with a wood of such a density on it.
fn under_trees(spot: SurfacePoint, open: SurfaceSample, density: f32) -> SurfaceSample {
    let canopy = canopy_of(spot.point.xy, density, spot.footprint);
    let littered = mix(open.albedo, LITTER, 0.8 * trees_drawn * ramp(density, 0.1, 0.6));
    let shaded = SurfaceSample(littered * mix(1.0, canopy.open, 1.0 - trees_drawn), open.bump, open.kinds);
    let crown = mix(scene.forest_dark.xyz, scene.forest_light.xyz, clamp(canopy.tone, 0.0, 1.0));
    let wood = SurfaceSample(crown, no_steeper(canopy.slope, STEEPEST_CROWN), vec4<f32>(1.0, 0.0, 0.0, 0.0));
    return mixed(shaded, wood, canopy.share * (1.0 - trees_drawn));
}

fn grass(moisture: f32, high: f32) -> vec3<f32> {
    let parched = mix(scene.dry.xyz, scene.meadow.xyz, ramp(moisture, 0.15, 0.5));
    let low = mix(parched, scene.lush.xyz, ramp(moisture, 0.5, 0.85));
    return mix(low, mix(scene.alpine.xyz, scene.dry.xyz, ramp(moisture, 0.6, 0.2)), ramp(high, 0.35, 0.8));
}

// How far below the tree line a height is, in widths of the belt in which trees become fewer.
fn below_tree_line(height: f32) -> f32 {
    return (scene.limits.y - height) / max(0.12 * scene.limits.w, 1e-3);
}

// How densely trees stand.
fn trees(spot: SurfacePoint, moisture: f32, patchy: f32) -> f32 {
    let line = below_tree_line(spot.point.z);
    let steep = ramp(spot.slope / scene.limits.x, 0.95, 1.3);
    let wood = 1.1 * (moisture - 0.5) + 0.9 * patchy + 0.4 * clamp(line, -8.0, 0.8) - 0.4 * steep;
    return ramp(wood, 0.02, 0.40) * ramp(spot.above, 0.0, min(SHORE.x, SHORE.y * scene.scale.x));
}

// Rock with its beds: light and dark, sunk into cracks and joints.
fn rock(spot: SurfacePoint, texture: Texture) -> SurfaceSample {
    let thick = 0.035 * max(scene.limits.w, 1e-3);
    let bedding = bedding_at(spot, vec2<f32>(thick, thick / 5.3), 1.4 * texture.broad + torn(texture), true);
    let warmth = 0.5 + 0.7 * bedding.thick.tone + 0.3 * bedding.thin.tone + 0.9 * texture.broad;
    let tone = 0.92 + 0.55 * bedding.thick.tone + 0.35 * bedding.thin.tone + 0.4 * texture.broad;
    let stone = mix(scene.rock_grey.xyz, scene.rock_warm.xyz, clamp(warmth, 0.0, 1.0)) * tone;
    let joints = 0.5 * bedding.thick.joint + 0.3 * bedding.thin.joint;
    let cracks = 0.3 - 0.5 * texture.fine.value - 1.6 * texture.crags.height + joints;
    let ledge = 0.35 * bedding.thick.ledge + 0.2 * bedding.thin.ledge;
    let albedo = mix(stone, scene.rock_dark.xyz, clamp(cracks, 0.0, 1.0));
    return SurfaceSample(albedo, rough(texture, 0.15, 2.4) - spot.fall * ledge, vec4<f32>(0.0, 0.0, 1.0, 0.0));
}

// By how many beds the edge of one is ragged.
fn torn(texture: Texture) -> f32 {
    return 0.25 * texture.fine.value + 0.9 * texture.crags.height;
}

struct Bedding {
    thick: Beds,
    thin: Beds,
}

// Beds of two thicknesses at a point.
fn bedding_at(spot: SurfacePoint, thickness: vec2<f32>, fold: f32, dips: bool) -> Bedding {
    let footprint = spot.footprint * spot.slope;
    let thin_fold = fold * thickness.x / thickness.y;
    return Bedding(
        beds_at(BedSpot(spot.point, fold, thickness.x, footprint), dips, 0x21u),
        beds_at(BedSpot(spot.point, thin_fold, thickness.y, footprint), dips, 0x22u),
    );
}

// Share of snow.
fn snow_at(spot: SurfacePoint, texture: Texture, moisture: f32) -> f32 {
    if scene.limits.z >= 1e30 {
        return 0.0;
    }
    let above = (spot.point.z - scene.limits.z) / max(scene.limits.w, 1e-3);
    let noise = vec3<f32>(texture.broad, texture.fine.value, -texture.crags.height);
    return snow_share(SnowSpot(above, spot.slope, spot.slope / scene.limits.x, spot.fall, moisture - 0.5, noise));
}

// Bushes and boulders on gentle ground of materials: the share that they hide, and the light that they leave beside them.
fn scattered(spot: SurfacePoint, texture: Texture, steep: f32) -> Canopy {
    let density = SCATTERED * ramp(texture.broad + 0.6 * texture.fine.value, -0.35, 0.5) * (1.0 - steep);
    return canopy_of(SMALLER * spot.point.xy, density, SMALLER * spot.footprint);
}

fn of_material(spot: SurfacePoint, albedo: vec3<f32>, texture: Texture) -> SurfaceSample {
    let steep = ramp(spot.slope, 0.5, 1.2);
    let thick = 0.03 * max(scene.limits.w, 1e-3);
    let bedding = bedding_at(spot, vec2<f32>(thick, thick / 4.1), 0.8 * texture.broad + torn(texture), false);
    let fine = (0.3 - 0.15 * steep) * texture.fine.value + 0.8 * steep * texture.crags.height;
    let tones = 0.75 * bedding.thick.tone + 0.5 * bedding.thin.tone;
    let bedded = tones - 0.35 * bedding.thick.joint - 0.2 * bedding.thin.joint;
    let tone = max(1.0 + 0.28 * texture.broad + fine + steep * bedded, 0.2);
    let ledge = steep * (0.3 * bedding.thick.ledge + 0.15 * bedding.thin.ledge);
    let bump = no_steeper(rough(texture, 0.08, 0.14 + 2.14 * steep) - spot.fall * ledge, STEEPEST);
    let bushes = scattered(spot, texture, steep);
    let hidden = mix(albedo * (tone * bushes.open), BUSH * albedo * (0.35 + bushes.tone), 0.85 * bushes.share);
    return SurfaceSample(hidden, bump, vec4<f32>(0.0, 0.3, 0.7 * steep, 0.0));
}
