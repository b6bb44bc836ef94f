// Twin of `woods.rs`: where the trees of woods stand, and their crowns as they look from above.

// Metres from one tree to the next where they stand closest.
const WOOD_SPACING = 7.0;

// Wavelengths in spacings by which crowns and groups of them are told from each other.
const WOOD_TOLD = vec2<f32>(1.0, 1.35);

const WOOD_LAYERS = 4u;
const WOOD_COARSER = 2.6;
const WOOD_SEED = 0x41u;
const CROWN_RADII = vec2<f32>(0.24, 0.64);
const CROWN_OFF = 0.35;
const WOOD_FULL = 0.9;
const CROWN_STEEP = vec2<f32>(0.36, 0.15);
const CROWN_SHADE = vec2<f32>(0.7, 1.1);
const BOUGHS = 4.5;
const BOUGHS_MOVED = 1.9;
const LEAFY = vec2<f32>(0.45, 0.35);

const TALLEST = 17.0;

// Tone of what grows below crowns, where one sees down to it.
const WOOD_BELOW = 0.3;

// By how much more than evenly broad crowns are many, in a stand of a middle age.
const MIDDLE_AGE = 1.35;

// Density and age of groups of crowns, of which some are missing.
const GROUPS = vec2<f32>(0.85, 1.1);

// Stands: their longest wavelength in metres, and what they add to the tone, to the size of crowns and to the number by which
// the kind of a group is chosen.
const STANDS = 900.0;
const STANDS_TONE = 0.8;
const STANDS_SIZE = 1.1;
const STANDS_KIND = 0.9;

struct Tree {
    place: vec2<f32>,
    size: f32,
    rank: f32,
    chance: f32,
    turn: f32,
}

// The tree of a square, whether it stands or not.
fn tree_of(square: vec2<i32>) -> Tree {
    let chances = wood_chances(square, WOOD_SEED);
    return Tree(
        WOOD_SPACING * wood_centre(square, chances.x), TALLEST * tallness(chances.y), part_of(chances.y, 0u),
        part_of(chances.y, 24u), 2.0 * PI * part_of(chances.y, 8u),
    );
}

// Height of a tree beside that of the tallest.
fn tallness(more: u32) -> f32 {
    return 0.55 + 0.45 * part_of(more, 16u);
}

struct Canopy {
    share: f32,
    tone: f32,
    slope: vec2<f32>,
    open: f32,
    chance: f32,
}

struct Dome {
    height: f32,
    slope: vec2<f32>,
    chance: f32,
}

// A share from eight bits of a hash.
fn part_of(hash: u32, shift: u32) -> f32 {
    return f32((hash >> shift) & 0xffu) * (1.0 / 255.0);
}

// The random bits of a square: those of its place, and more.
fn wood_chances(square: vec2<i32>, seed: u32) -> vec2<u32> {
    let hash = grain_bits(square.x, square.y, seed);
    return vec2<u32>(hash, grain_bits(i32(hash & 0x7fffu), square.y, seed ^ 0x5bd1u));
}

// Where the tree of a square stands, in spacings.
fn wood_centre(square: vec2<i32>, hash: u32) -> vec2<f32> {
    let off = vec2<f32>(f32(hash & 0xffffu), f32(hash >> 16u)) * (1.0 / 65535.0) - 0.5;
    return vec2<f32>(square) + 0.5 + 2.0 * CROWN_OFF * off;
}

// The uppermost of some domes at a place that is counted in spacings, where so large a share of them stand.
fn dome(place: vec2<f32>, seed: u32, density: f32, age: f32) -> Dome {
    let corner = vec2<i32>(floor(place - 0.5));
    var top = Dome(0.0, vec2<f32>(0.0), 0.0);
    var look = 0;
    loop {
        let square = corner + vec2<i32>(look & 1, look >> 1u);
        let chances = wood_chances(square, seed);
        let stands = part_of(chances.y, 0u) < min(density, WOOD_FULL);
        let away = place - wood_centre(square, chances.x);
        let radius = CROWN_RADII.x + (CROWN_RADII.y - CROWN_RADII.x) * min(age * part_of(chances.y, 8u), 1.0);
        let below = 1.0 - dot(away, away) / (radius * radius);
        let tall = tallness(chances.y);
        if stands && below * tall > top.height {
            top = Dome(below * tall, -2.0 * tall / (radius * radius) * away, part_of(chances.y, 24u));
        }
        look++;
        if look >= 4 {
            break;
        }
    }
    return top;
}

// How much lighter or darker one group of crowns is than another.
const WOOD_UNLIKE = 0.3;

// A place, or the direction that was eastward, on a lattice that is turned by 37 degrees.
fn turned_lattice(place: vec2<f32>) -> vec2<f32> {
    return vec2<f32>(0.8 * place.x + 0.6 * place.y, 0.8 * place.y - 0.6 * place.x);
}

// How much a layer of domes, which are so far apart, is seen of in a pixel of that footprint.
fn seen_of_layer(layer: u32, spacing: f32, footprint: f32) -> f32 {
    return grain_visible(footprint, select(WOOD_TOLD.x, WOOD_TOLD.y, layer > 0u) * spacing);
}

// What a wood of a density looks like at a point, for a pixel of that footprint.
fn canopy_of(point: vec2<f32>, wooded: f32, footprint: f32, sun: vec3<f32>) -> Canopy {
    let is_wooded = wooded > 0.0;
    let single = seen_of_layer(0u, WOOD_SPACING, footprint);
    var lumps = 0.0;
    var slope = vec2<f32>(0.0);
    var finer = single;
    var spacing = WOOD_SPACING;
    var place = point;
    var turn = vec2<f32>(1.0, 0.0);
    let stand = stand_at(point, footprint, wooded);
    var chance = 0.5 + STANDS_KIND * stand;
    var layer = 1u;
    loop {
        spacing *= WOOD_COARSER;
        place = turned_lattice(place);
        turn = turned_lattice(turn);
        let seen = select(0.0, seen_of_layer(layer, spacing, footprint), is_wooded);
        if seen > 0.0 {
            let group = dome(place / spacing, WOOD_SEED + layer, GROUPS.x, GROUPS.y);
            let weight = seen * (1.0 - 0.55 * finer);
            finer = seen;
            lumps += weight * (0.7 * (group.height - 0.45) + WOOD_UNLIKE * (group.chance - 0.5));
            chance += weight * 0.7 * (group.chance - 0.5);
            let along = vec2<f32>(dot(turn, group.slope), turn.x * group.slope.y - turn.y * group.slope.x);
            slope += weight * CROWN_STEEP.y * along;
        }
        layer++;
        if layer >= WOOD_LAYERS || !is_wooded {
            break;
        }
    }
    lumps += STANDS_TONE * stand;
    let density = clamp(wooded + 2.4 * lumps * wooded * (1.0 - wooded), 0.0, 1.0);
    let between = 0.9 * ramp(density, 0.25, 0.8);
    let covered = 0.75 * density * (2.0 - density) * 0.9;
    let far = Canopy(covered + (1.0 - covered) * between, 0.42 + 0.55 * lumps, slope, 1.0 - 0.4 * density, chance);
    var near = far;
    if single > 0.0 && density > 0.0 {
        near = crowns(point, vec2<f32>(density, between), stand, footprint, sun);
        near.tone += 0.45 * lumps;
        near.slope += slope;
    }
    return Canopy(
        mix(far.share, near.share, single), mix(far.tone, near.tone, single),
        mix(far.slope, near.slope, single), mix(far.open, near.open, single),
        mix(far.chance, near.chance, single),
    );
}

// What a stand is beside others; nothing where there is no wood.
fn stand_at(point: vec2<f32>, footprint: f32, wooded: f32) -> f32 {
    if wooded <= 0.0 {
        return 0.0;
    }
    return octaves_at(Octaves(STANDS, 6u, 0.6, WOOD_SEED + WOOD_LAYERS + 1u), point, footprint).value;
}

// Crowns that are seen one by one, with so much dark between them.
fn crowns(point: vec2<f32>, cover: vec2<f32>, stand: f32, footprint: f32, sun: vec3<f32>) -> Canopy {
    let density = cover.x;
    let between = cover.y;
    let boughs = octaves_at(Octaves(BOUGHS, 3u, 0.65, WOOD_SEED + WOOD_LAYERS), point, footprint);
    let place = (point + BOUGHS_MOVED * boughs.slope) / WOOD_SPACING;
    let age = MIDDLE_AGE + STANDS_SIZE * stand;
    let tree = dome(place, WOOD_SEED, density, age);
    let within = min(5.0 * tree.height, 1.0);
    let run = max(length(sun.xy), 1e-6);
    let reach = min(CROWN_SHADE.x * run / max(sun.z, 1e-3), CROWN_SHADE.y) / run;
    let shaded = dome(place + reach * sun.xy, WOOD_SEED, density, age);
    let dark = min(4.0 * shaded.height, 1.0) * (1.0 - within);
    return Canopy(
        within + (1.0 - within) * between,
        within * (0.35 + 0.36 * tree.height + 0.22 * (tree.chance - 0.5) + LEAFY.x * boughs.value) +
            (1.0 - within) * WOOD_BELOW,
        within * (CROWN_STEEP.x * tree.slope + LEAFY.y * boughs.slope),
        1.0 - 0.55 * dark,
        tree.chance,
    );
}
