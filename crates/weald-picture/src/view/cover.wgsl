// Twin of `cover.rs`: what grows and lies on the ground.

// Slope that bumps come near but do not pass.
const STEEPEST = 0.75;
const STEEPEST_CROWN = 0.95;

// Steepness from which rock begins to be bare, and is all that there is.
const ROCK = vec2<f32>(1.08, 1.22);

// Slopes between which waves of the sea leave no sand, but bare rock, and heights of a beach between which those are; how
// uneven a beach is, by patches and by detail; and what is worn bare of soil above one of rock.
const SANDY = vec2<f32>(0.1, 0.28);
const OF_THE_SEA = vec2<f32>(0.3, 1.5);
const UNEVEN = vec2<f32>(1.6, 1.1);
const WASHED = 1.8;

// How much higher the score of trees is where woods spread everywhere than where nowhere, and the spread below which trees become
// fewer, down to none.
const SPREAD = 2.8;
const FEW = 0.1;

// How densely lone trees stand before a wood.
const LONE = 0.1;

// Light that a strand sends back beside dry gravel.
const STRAND = 0.66;

// Thickness of a bed of natural rock over the relief.
const THICK = 0.035;

// By how much rock is bare sooner on one of its blocks than on another.
const BLOCKY = 0.16;

// How ragged beds and joints are, by the fine detail and by crags.
const RAGGED = vec2<f32>(0.12, 0.3);
const BENT = vec2<f32>(0.5, 0.8);

// Slope of the facets of blocks on flat ground, and the least upward part of a normal by which it grows on walls.
const OUTCROPS = vec2<f32>(0.3, 0.9);
const GENTLE = 0.25;
const FACETS = 0.55;
const MASSIVE = 0.5;
const BROKEN = vec2<f32>(-0.25, 0.35);
const UPRIGHT = 0.4;

// Slope that bumps of bare rock come near.
const STEEPEST_ROCK = 1.9;

// Heath on open ground: its colour from that of withered grass to that of dark crowns, between which noise and with what share of
// crags it grows, its greatest share, and how wet ground is on which it becomes less.
const HEATH = 0.6;
const HEATH_PATCHES = vec2<f32>(-0.04, 0.26);
const HEATH_RIDGES = 0.6;
const HEATH_MOST = 0.5;
const HEATH_WET = vec2<f32>(0.5, 0.9);

// Share of a ledge that plants hide, and shares of the relief over which they vanish.
const GREEN = 0.8;
const GREEN_UP_TO = vec2<f32>(0.55, 0.9);

// Steepness from which trees become fewer, and from which there are none.
const CLIFF = vec2<f32>(0.72, 1.08);

// Share of the slope of crags that counts as that of the ground.
const CRAGGY = 0.6;
const CRAGGY_FROM = vec2<f32>(4.0, 12.0);

// What the highest ground adds to its steepness, and shares of the relief between which that grows.
const BARE = 0.4;
const BARREN = vec2<f32>(0.45, 0.95);

// What crests add and hollows take there, times how dry they are, and shares of the relief between which that grows.
const CRESTS = 1.1;
const SCOURED = vec2<f32>(0.2, 0.6);

// Light that needles and leaves send back beside that of a wood.
const NEEDLES = vec3<f32>(0.66, 0.79, 0.95);
const LEAVES = vec3<f32>(1.08, 1.05, 0.84);

// How far below the tree line leaves take the place of needles, and the greatest share of leaves.
const LEAVED = vec2<f32>(0.3, 2.2);
const MOST_LEAVES = 0.85;

// Height in metres above the water, and at most that share of a cell, from which trees stand.
const SHORE = vec2<f32>(2.5, 0.028);

// Share of the trees of the point in question that are drawn as such, and so not on the ground.
var<private> trees_drawn: f32 = 0.0;

// What lies under trees that are drawn as such, and how much of the ground it hides.
const LITTER = vec3<f32>(0.066, 0.043, 0.021);
const LITTERED = 0.9;

struct SurfacePoint {
    place: vec2<f32>,
    point: vec3<f32>,
    slope: f32,
    fall: vec2<f32>,
    footprint: f32,
    above: f32,
    beach: f32,
    bed: vec3<f32>,
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

// How the ground rises eastward and northward, without exaggeration.
fn rise_of(spot: SurfacePoint) -> vec2<f32> {
    return -spot.slope * spot.fall;
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
    texture.fine = octaves_at(Octaves(2.4 * cell, 8u, 0.6, 0x12u), spot.point.xy, spot.footprint);
    texture.crags = crags_at(spot.point, rise_of(spot), cell, spot.footprint);
    texture.evenness = pow(clamp(2.0 * spot.footprint / cell, 0.075, 1.0), 0.4);
    return texture;
}

// 1 where rock is bare on the average; trees stand by this.
fn slope_of_cells(spot: SurfacePoint, texture: Texture, soil: f32) -> f32 {
    return spot.slope / scene.limits.x + 0.25 * patchy_of(texture) + 0.4 * (0.4 - soil);
}

// The same, and more on the steep sides of ridges that are finer than cells.
fn steepness(spot: SurfacePoint, texture: Texture, here: vec2<f32>) -> f32 {
    let hilly = ramp(spot.slope / scene.limits.x, 0.35, 0.8) * ramp(scene.scale.x, CRAGGY_FROM.x, CRAGGY_FROM.y);
    let steeper = CRAGGY * hilly * dot(texture.crags.slope, spot.fall);
    let high = spot.point.z / max(scene.limits.w, 1e-3) + 0.25 * patchy_of(texture);
    let barren = BARE * ramp(high, BARREN.x, BARREN.y) + CRESTS * (0.5 - here.x) * ramp(high, SCOURED.x, SCOURED.y);
    return slope_of_cells(spot, texture, here.y) - steeper / scene.limits.x + barren;
}

// The share of conifers at a height.
fn share_of_conifers(height: f32) -> f32 {
    return 1.0 - MOST_LEAVES * ramp(below_tree_line(height), LEAVED.x, LEAVED.y);
}

// How densely trees stand at a point of natural ground, and the share of conifers among them.
fn wood_at(spot: SurfacePoint) -> vec2<f32> {
    let texture = texture_of(spot);
    let here = smooth_at(site, spot.place);
    let bare = ramp(slope_of_cells(spot, texture, here.y), CLIFF.x, CLIFF.y);
    let wooded = trees(spot, here.x, patchy_of(texture)) * (1.0 - bare);
    let strand = beach_at(spot, texture);
    let dry = (1.0 - strand.x) * (1.0 - strand.y);
    let density = wooded * (1.0 - snow_at(spot, texture, here.x, wooded)) * dry;
    return vec2<f32>(density, share_of_conifers(spot.point.z));
}

// Colour and roughness of a point.
fn cover_at(spot: SurfacePoint) -> SurfaceSample {
    if is_above(scene.has.z, 1.0, spot.footprint) {
        // The values of a layer, which nothing of the ground's own may hide.
        return SurfaceSample(min(material_at(spot.place), vec3<f32>(0.9)), vec2<f32>(0.0), vec4<f32>(0.0));
    }
    let texture = texture_of(spot);
    var skin: SurfaceSample;
    if is_above(scene.has.z, 0.0, spot.footprint) {
        skin = of_material(spot, material_at(mingled(spot, texture)), texture);
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
    let wet = moisture + 0.55 * patchy;
    let grassy = grass(wet, high + 0.25 * patchy) * (1.0 + 0.3 * fine + 0.3 * ridge);
    let green_ground = mix(grassy, mix(scene.dry.xyz, scene.forest_dark.xyz, HEATH), heath(spot, texture, wet));
    let turf = turf_at(spot.point, rise_of(spot), spot.footprint, green_ground, scene.dry.xyz);
    let wooded = trees(spot, moisture, patchy);
    let tufts = rough(texture, 0.12, 0.8 * ramp(spot.slope, 0.1, 0.7)) + turf.slope;
    let meadow = SurfaceSample(turf.albedo, tufts, vec4<f32>(0.0));

    let strand = beach_at(spot, texture);
    let steep = max(steepness(spot, texture, here.xy), ROCK.y * strand.y);
    let pebbles = scene.scree.xyz * (1.0 + 0.45 * fine);
    let scree = SurfaceSample(pebbles, rough(texture, 0.28, 0.8), vec4<f32>(0.0, 1.0, 0.0, 0.0));
    let fallen = 1.1 * here.w + ramp(here.w, 0.0, 0.2) * (0.6 * patchy + 0.6 * fine - 1.2 * ridge);
    let apron = 0.9 * ramp(fallen, 0.4, 1.15) * ramp(spot.slope, 0.32, 0.55);
    let fallen_over = mixed(meadow, scree, max(0.8 * ramp(steep, 0.97, 1.10) * (1.0 - 0.9 * ramp(wooded, 0.0, 0.2)), apron));
    let gravel = scene.gravel.xyz * (STRAND + 0.35 * fine);
    let sand = SurfaceSample(gravel, rough(texture, 0.1, 0.1), vec4<f32>(0.0, 1.0, 0.0, 0.0));
    let stony = mixed(fallen_over, sand, strand.x);
    var blocks = Fractures(0.0, 0.0, vec2<f32>(0.0), 0.0);
    if steep > ROCK.x - BLOCKY {
        blocks = rock_fractures(spot, texture, true);
    }
    let bare = ramp(steep + BLOCKY * blocks.tone, ROCK.x, ROCK.y);
    let green = GREEN * blocks.ledge * (1.0 - ramp(high, GREEN_UP_TO.x, GREEN_UP_TO.y));
    let ground = mixed(stony, mixed(rock(spot, texture, blocks), meadow, green), bare);
    let snow = SurfaceSample(scene.snow.xyz, rough(texture, 0.08, ramp(spot.slope, 0.2, 0.8)), vec4<f32>(0.0, 0.0, 0.0, 1.0));
    let cliff = ramp(slope_of_cells(spot, texture, here.y), CLIFF.x, CLIFF.y);
    let standing = wooded * (1.0 - cliff);
    let white = snow_at(spot, texture, moisture, standing);
    var open = mixed(ground, snow, white);
    open.bump = no_steeper(open.bump, mix(STEEPEST, STEEPEST_ROCK, bare * (1.0 - white)));
    let density = standing * (1.0 - white) * (1.0 - strand.x) * (1.0 - strand.y);
    return under_trees(spot, open, density, share_of_conifers(spot.point.z));
}

// Shares of sand, and of rock that is washed bare, at the edge of water.
fn beach_at(spot: SurfacePoint, texture: Texture) -> vec2<f32> {
    let uneven = 1.0 + UNEVEN.x * texture.broad + UNEVEN.y * texture.fine.value;
    let up = spot.above / max(spot.beach * max(uneven, 0.05), 1e-3);
    // Some stretches of a shore have sand, and others rock.
    let rocky = ramp(spot.slope - 0.6 * texture.broad, SANDY.x, SANDY.y);
    let steep = rocky * ramp(spot.beach, OF_THE_SEA.x, OF_THE_SEA.y);
    return vec2<f32>((1.0 - ramp(up, 0.9, 1.1)) * (1.0 - steep), (1.0 - ramp(up / WASHED, 0.8, 1.1)) * steep);
}

// Ground with a wood of such a density and share of conifers on it.
fn under_trees(spot: SurfacePoint, open: SurfaceSample, density: f32, conifers: f32) -> SurfaceSample {
    let seen = seen_crown(spot.point.xy, density, spot.footprint, aslant(spot));
    let canopy = canopy_of(seen, density, spot.footprint, scene.sun.xyz);
    let littered = LITTERED * trees_drawn * ramp(density, 0.1, 0.6);
    let floor_of_wood = SurfaceSample(LITTER, open.bump, vec4<f32>(1.0, 0.0, 0.0, 0.0));
    var shaded = mixed(open, floor_of_wood, littered);
    shaded.albedo *= mix(1.0, canopy.open, 1.0 - trees_drawn);
    let kind = mix(LEAVES, NEEDLES, ramp(conifers - canopy.chance, -0.08, 0.08));
    let crown = kind * mix(scene.forest_dark.xyz, scene.forest_light.xyz, clamp(canopy.tone, 0.0, 1.0));
    let wood = SurfaceSample(crown, no_steeper(canopy.slope, STEEPEST_CROWN), vec4<f32>(1.0, 0.0, 0.0, 0.0));
    return mixed(shaded, wood, canopy.share * (1.0 - trees_drawn));
}

fn grass(moisture: f32, high: f32) -> vec3<f32> {
    let parched = mix(scene.dry.xyz, scene.meadow.xyz, ramp(moisture, 0.15, 0.5));
    let low = mix(parched, scene.lush.xyz, ramp(moisture, 0.5, 0.85));
    return mix(low, mix(scene.alpine.xyz, scene.dry.xyz, ramp(moisture, 0.6, 0.2)), ramp(high, 0.35, 0.8));
}

// Share of heath on open ground that is so wet.
fn heath(spot: SurfacePoint, texture: Texture, wet: f32) -> f32 {
    let noise = texture.fine.value + HEATH_RIDGES * texture.crags.height;
    let uneven = ramp(noise, HEATH_PATCHES.x, HEATH_PATCHES.y) * ramp(scene.scale.x, CRAGGY_FROM.x, CRAGGY_FROM.y);
    return HEATH_MOST * uneven * (1.0 - ramp(wet, HEATH_WET.x, HEATH_WET.y));
}

// How far below the tree line a height is, in widths of the belt in which trees become fewer.
fn below_tree_line(height: f32) -> f32 {
    return (scene.limits.y - height) / max(0.12 * scene.limits.w, 1e-3);
}

// How densely trees stand.
fn trees(spot: SurfacePoint, moisture: f32, patchy: f32) -> f32 {
    let line = below_tree_line(spot.point.z);
    let steep = ramp(spot.slope / scene.limits.x, 0.95, 1.3);
    let spread = SPREAD * (scene.woods.x - 0.5);
    let wood = 1.1 * (moisture - 0.5) + 0.9 * patchy + 0.4 * clamp(line, -8.0, 0.8) - 0.4 * steep + spread;
    let density = max(ramp(wood, 0.02, 0.52), LONE * ramp(wood, -0.7, 0.1));
    let few = min(scene.woods.x / FEW, 1.0);
    return few * density * ramp(spot.above, 0.0, min(SHORE.x, SHORE.y * scene.scale.x));
}

fn rock_thickness() -> f32 {
    return THICK * max(scene.limits.w, 1e-3);
}

// The blocks of rock at a point.
fn rock_fractures(spot: SurfacePoint, texture: Texture, dips: bool) -> Fractures {
    let thickness = rock_thickness();
    let bend = BENT * min(scene.scale.x, thickness) * vec2<f32>(texture.fine.value, texture.crags.height);
    let level = spot.point.z + select(0.0, bed_dip(spot.point.xy) + thickness * rock_fold(texture), dips);
    let normal = vec3<f32>(spot.slope * spot.fall, 1.0) * inverseSqrt(1.0 + spot.slope * spot.slope);
    let found = fractures_at(Face(spot.point.xy + bend, level, normal, thickness, spot.footprint));
    let broken = MASSIVE + (1.0 - MASSIVE) * ramp(texture.broad, BROKEN.x, BROKEN.y);
    return Fractures(broken * found.tone, broken * found.crack, broken * found.facet, broken * found.ledge);
}

// By how many beds natural rock is folded: broadly, and a little by what is ragged.
fn rock_fold(texture: Texture) -> f32 {
    let ragged = RAGGED.x * texture.fine.value + RAGGED.y * texture.crags.height;
    return 1.4 * texture.broad + ragged * min(scene.scale.x / rock_thickness(), 1.0);
}

// Slope of the facets of blocks.
fn facets_of(spot: SurfacePoint) -> f32 {
    return FACETS * min(sqrt(1.0 + spot.slope * spot.slope), 1.0 / UPRIGHT);
}

// Rock with its beds and blocks: light and dark, sunk into cracks and joints.
fn rock(spot: SurfacePoint, texture: Texture, blocks: Fractures) -> SurfaceSample {
    let thick = rock_thickness();
    let bedding = bedding_at(spot, vec2<f32>(thick, thick / 5.3), rock_fold(texture), true);
    let seen = mix(GENTLE, 1.0, ramp(spot.slope, OUTCROPS.x, OUTCROPS.y));
    let tones = vec3<f32>(seen * vec2<f32>(bedding.thick.tone, bedding.thin.tone), blocks.tone);
    let warmth = 0.4 + dot(vec3<f32>(0.7, 0.3, 0.3), tones) + 0.9 * texture.broad;
    let tone = 0.92 + dot(vec3<f32>(0.45, 0.55, 0.6), tones) + 0.4 * texture.broad;
    let stone = mix(scene.rock_grey.xyz, scene.rock_warm.xyz, clamp(warmth, 0.0, 1.0)) * max(tone, 0.3);
    let joints = seen * (0.7 * bedding.thick.joint + 0.6 * bedding.thin.joint) + 1.1 * blocks.crack;
    let cracks = 0.22 - 0.6 * texture.fine.value - 2.2 * texture.crags.height + joints;
    let ledge = 0.4 * bedding.thick.ledge + 0.3 * bedding.thin.ledge;
    let albedo = mix(stone, scene.rock_dark.xyz, clamp(cracks, 0.0, 1.0));
    let facets = facets_of(spot);
    let bump = rough(texture, 0.2, 2.6) - spot.fall * ledge + facets * blocks.facet;
    return SurfaceSample(albedo, bump, vec4<f32>(0.0, 0.0, 1.0, 0.0));
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

// From which line on there is no snow at all.
const NO_SNOW = 9e29;

// Share of snow where trees stand so densely.
fn snow_at(spot: SurfacePoint, texture: Texture, moisture: f32, wooded: f32) -> f32 {
    if is_above(scene.limits.z, NO_SNOW, spot.footprint) {
        return 0.0;
    }
    let above = (spot.point.z - scene.limits.z) / max(scene.limits.w, 1e-3);
    let noise = vec3<f32>(texture.broad, texture.fine.value, -texture.crags.height);
    return snow_share(SnowSpot(above, spot.slope, spot.slope / scene.limits.x, spot.fall, moisture - 0.5, noise, wooded));
}
