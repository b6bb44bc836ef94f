// Grass where its blades are too far away to be drawn: tussocks as they are seen aslant, and the light of their leaves. These tussocks are
// looks alone, and none of those that sets of blades share (`meadow.rs`).

// Light of the sun that leaves which it reaches send towards an eye which has it behind its back, and beside or before itself, as a
// share of what they would face to face; and of the sky, of which leaves that stand see half, and each other.
const OF_THE_SUN = vec2<f32>(0.68, 0.42);
const OF_THE_SKY = 0.62;

// Tussocks: metres from one to the next where they are smallest, how many times as far it is to the next larger ones, how many layers of
// them there are, and what is left of a layer where the finer one is seen as well.
const TUSSOCKS = 0.42;
const TUSSOCKS_COARSER = 2.7;
const TUSSOCK_LAYERS = 3u;
const TUSSOCKS_LEFT = 0.5;
const TUSSOCK_SEED = 0x81u;

// How high they are beside their spacing, at most so many metres; the share of their places that is taken, with how broad they are; and the
// spacing at which those of a layer are told from each other, beside that of noise.
const TUSSOCK_RISE = 0.36;
const TUSSOCK_MOST_RISE = 0.4;
const TUSSOCKS_STAND = vec2<f32>(0.9, 1.5);
const TUSSOCKS_TOLD = 1.2;

// Leaf areas below which there is no grass to speak of, and from which on it stands in tussocks; the mean height of tussocks beside that of the highest.
const NO_LEAVES = 1e-4;
const THIN_LEAVES = 0.1;
const TUSSOCK_MEAN = 0.28;

// Steps in which a line of sight comes down to them, height of an eye above the ground as a share of its distance, from which they are
// seen from no lower, and metres from the eye between which they come to stand: nearer by it is blades that do.
const TUSSOCK_STEPS = 6u;
const LOWEST_SIGHT_OF_GRASS = 0.1;
const TUSSOCKS_FROM = vec2<f32>(8.0, 24.0);

// What height and chance add to the tone of a tussock, chance to its dryness, and how steep its sides are.
const TUSSOCK_TONE = vec2<f32>(0.5, 0.3);
const TUSSOCK_DRY = 0.5;
const TUSSOCK_STEEP = 0.12;

// Patches of a meadow: their longest wavelength in metres, and what they add to its tone and its dryness.
const MEADOW_PATCHES = 38.0;
const PATCHES_TONE = 0.22;
const PATCHES_DRY = 0.6;

// Share of the tone of level noise that is left for a gaze along the ground, and cosines of the angle to its normal between which that grows to
// all: tops hide the gaps behind them, and a tone that lay flat would be drawn out in streaks.
const TUFTS_STAND = 0.3;
const TUFTS_FROM = vec2<f32>(0.06, 0.45);

fn tufts_seen(cosine: f32) -> f32 {
    return mix(TUFTS_STAND, 1.0, ramp(cosine, TUFTS_FROM.x, TUFTS_FROM.y));
}

// How much is seen of a layer of tussocks in a pixel of that footprint, where so much is of the finer one.
fn seen_of_tussocks(spacing: f32, finer: f32, footprint: f32) -> f32 {
    return grain_visible(footprint, TUSSOCKS_TOLD * spacing) * (1.0 - (1.0 - TUSSOCKS_LEFT) * finer);
}

// Metres that tussocks so far apart are high at most.
fn rise_of_tussocks(spacing: f32) -> f32 {
    return min(TUSSOCK_RISE * spacing, TUSSOCK_MOST_RISE);
}

// Metres that no tussock is higher than.
fn highest_tussock(footprint: f32) -> f32 {
    var sum = 0.0;
    var finer = 0.0;
    var spacing = TUSSOCKS;
    for (var layer = 0u; layer < TUSSOCK_LAYERS; layer++) {
        let seen = seen_of_tussocks(spacing, finer, footprint);
        sum += seen * rise_of_tussocks(spacing);
        finer = min(finer + seen, 1.0);
        spacing *= TUSSOCKS_COARSER;
    }
    return sum;
}

// Tussocks at a place, of all layers that are seen.
struct Tussock {
    // Metres above the ground.
    height: f32,
    // Sums over layers, about 0 in the mean: of heights as shares of the highest of their layer, and of numbers that tussocks have by chance.
    tone: f32,
    chance: f32,
    slope: vec2<f32>,
}

fn tussocks_at(point: vec2<f32>, footprint: f32) -> Tussock {
    var sum = Tussock(0.0, 0.0, 0.0, vec2<f32>(0.0));
    var place = turned_lattice(point);
    var turn = turned_lattice(vec2<f32>(1.0, 0.0));
    var finer = 0.0;
    var spacing = TUSSOCKS;
    var layer = 0u;
    loop {
        let seen = seen_of_tussocks(spacing, finer, footprint);
        if seen > 0.0 {
            let here = dome(place / spacing, TUSSOCK_SEED + layer, TUSSOCKS_STAND.x, TUSSOCKS_STAND.y);
            let slope = vec2<f32>(dot(turn, here.slope), turn.x * here.slope.y - turn.y * here.slope.x);
            sum.height += seen * rise_of_tussocks(spacing) * here.height;
            sum.tone += seen * (here.height - TUSSOCK_MEAN);
            sum.slope += seen * slope;
            // It fades where a tussock ends, and is none between them.
            sum.chance += seen * min(5.0 * here.height, 1.0) * (here.chance - 0.5);
            finer = min(finer + seen, 1.0);
        }
        spacing *= TUSSOCKS_COARSER;
        place = turned_lattice(place);
        turn = turned_lattice(turn);
        layer++;
        if layer >= TUSSOCK_LAYERS {
            break;
        }
    }
    return sum;
}

// How much of tussocks is shown from so far away, where so many leaves stand: none where all of these are drawn as blades.
fn shown_of_tussocks(view: ViewRay, leaf_area: f32) -> f32 {
    let undrawn = 1.0 - drawn_as_blades(view.ray_length);
    return undrawn * ramp(view.ray_length, TUSSOCKS_FROM.x, TUSSOCKS_FROM.y) * ramp(leaf_area, NO_LEAVES, THIN_LEAVES);
}

// The point of the ground, as a point to look at from straight above, where a line of sight to a point meets tussocks: relief
// mapping, as of the crowns of woods (`crown_relief.wgsl`).
fn seen_tussock(point: vec2<f32>, normal: vec3<f32>, view: ViewRay, shown: f32) -> vec2<f32> {
    let highest = shown * highest_tussock(view.footprint);
    // How far the line goes aside for each metre that it comes nearer to the ground.
    // Blades are as high however much heights are exaggerated.
    let rising = max(-dot(view.direction, normal) / max(normal.z, 0.2), LOWEST_SIGHT_OF_GRASS);
    let aslant = -view.direction.xy / rising;
    var found = 0.0;
    var above = vec2<f32>(highest, 0.0);
    var step = 0u;
    loop {
        let up = highest * (1.0 - f32(step) / f32(TUSSOCK_STEPS));
        let left = up - shown * tussocks_at(point + up * aslant, view.footprint).height;
        let is_met = step > 0u && left <= 0.0;
        found = select(found, crossed_at(above, vec2<f32>(up, left)), is_met);
        above = vec2<f32>(up, left);
        step++;
        if is_met || step > TUSSOCK_STEPS {
            break;
        }
    }
    return point + found * aslant;
}

// The grass at a point: its leaves, how much of its tussocks is shown, and the point to look at from straight above, which where no
// grass stands is the point itself.
struct GrassSeen {
    lawn: vec4<f32>,
    shown: f32,
    at: vec2<f32>,
}

fn grass_seen(point: vec2<f32>, place: vec2<f32>, normal: vec3<f32>, view: ViewRay) -> GrassSeen {
    var grass = GrassSeen(leaves_at(place), 0.0, point);
    if LAWN && grass.lawn.w > NO_LEAVES {
        grass.shown = shown_of_tussocks(view, grass.lawn.w);
        grass.at = seen_tussock(point, normal, view, grass.shown);
    }
    return grass;
}

// Of the sun on leaves that it reaches what they send towards an eye.
fn sun_on_leaves(direction: vec3<f32>) -> f32 {
    return mix(OF_THE_SUN.y, OF_THE_SUN.x, max(-dot(direction.xy, scene.sun.xy), 0.0));
}

// Grass that is seen as a whole, at a point to look at from straight above: what its tone adds, how dry it is, and the slope of its tussocks,
// of which a share is shown.
struct Sward {
    tone: f32,
    dry: f32,
    slope: vec2<f32>,
}

fn sward_at(at: vec2<f32>, cosine: f32, footprint: f32, shown: f32) -> Sward {
    let tussock = tussocks_at(at, footprint);
    let patches = tufts_seen(cosine) * octaves_at(Octaves(MEADOW_PATCHES, 5u, 0.6, 0x3cu), at, footprint).value;
    let tone = shown * (TUSSOCK_TONE.x * tussock.tone + TUSSOCK_TONE.y * tussock.chance) + PATCHES_TONE * patches;
    let dry = PATCHES_DRY * patches + shown * TUSSOCK_DRY * tussock.chance;
    return Sward(tone, dry, shown * TUSSOCK_STEEP * tussock.slope);
}

// The light of a sward of leaves of a colour.
fn canopy_radiance(colour: vec3<f32>, sward: Sward, normal: vec3<f32>, direction: vec3<f32>, seen: Seen, sun: f32) -> vec3<f32> {
    let bumpy = normalize(vec3<f32>(normal.xy - sward.slope, normal.z));
    let light = scene.sunlight.xyz * (sun_on_leaves(direction) * sunlit_leaves(bumpy, direction) * sun)
        + OF_THE_SKY * skylight_on(seen, bumpy);
    let warm = vec3<f32>(1.0 + 0.5 * sward.dry, 1.0 + 0.15 * sward.dry, 1.0 - 0.25 * sward.dry);
    return colour * warm * max(1.0 + sward.tone, 0.3) * light / PI;
}

// The light of soil with grass on it, of which the light of the soil alone is known as from the sun and from the sky.
fn with_canopy(soil: SoilLight, grass: GrassSeen, normal: vec3<f32>, view: ViewRay, seen: Seen, sun: f32) -> vec3<f32> {
    let lawn = grass.lawn;
    let cosine = abs(dot(view.direction, normal));
    let undrawn = lawn.w * (1.0 - drawn_as_blades(view.ray_length));
    let bare = through_leaves(undrawn, cosine);
    let sward = sward_at(grass.at, cosine, view.footprint, grass.shown);
    // What is seen between leaves is as light and dark as they are.
    let shade = max(1.0 + sward.tone * (1.0 - sky_through_leaves(lawn.w)), 0.3);
    let below = shade * (soil.in_sun * through_leaves(lawn.w, scene.sun.z) + soil.under_sky * sky_through_leaves(lawn.w));
    return mix(canopy_radiance(lawn.xyz, sward, normal, view.direction, seen, sun), below, bare);
}

// Light that soil sends back, of the sun and of the sky.
struct SoilLight {
    in_sun: vec3<f32>,
    under_sky: vec3<f32>,
}

// From where a point is looked at: along a direction, from so far away, with so wide a pixel.
struct ViewRay {
    direction: vec3<f32>,
    ray_length: f32,
    footprint: f32,
}
