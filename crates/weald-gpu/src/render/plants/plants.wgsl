// Plants where they are looked at: how large each is seen, and which of its leaves that takes.

// The camera's view, then one for each cascade of the sun.
const VIEWS = 5u;

// Levels of detail, and lists of plants: even ones for a level alone, odd ones where it passes into the next.
const PLANT_LEVELS = 5u;
const LISTS = 10u;
const NO_LIST = 255u;

// Heights in pixels of a plant at which each level passes into the next; the last into nothing.
const ENDS = array<f32, 5>(200.0, 85.0, 17.0, 5.0, 1.2);

// From how much higher to how much lower than that.
const PASSES = 1.35;

// Pixels that a texel of a cascade is worth, and share of a large plant's pixels that count for its shadow, of a small one's
// all: shadows are smooth, and need less.
const TEXEL_PIXELS = 0.75;
const SHADOW_PIXELS = 0.35;
const SMALL_PIXELS = 15.0;

struct Kind {
    // Colour of leaves in linear light; reach from the root beside the height.
    leaf: vec4<f32>,
    // Colour of stems.
    stem: vec4<f32>,
    // Of a wood: how far its trees are drawn, 0 for other plants; whether it is of conifers; squares of its lattice along a
    // side of what is known of it.
    wood: vec4<f32>,
    // Leaflets on a side of a leaf from close by, and the share of its edge that they take; limbs; plants.
    leaflets: vec4<f32>,
}

struct PlacedPlant {
    // East, north, up.
    place: vec3<f32>,
    // Height in metres.
    size: f32,
    // The quaternion that turns it, to axes east, up, south.
    turn: vec2<u32>,
    // Phase in the wind, and a number of its own.
    phase: f32,
    chance: f32,
}

// Whether a view is drawn: cascades that are as they were keep their lists too.
fn is_drawn(view: u32) -> bool {
    return view == 0u || frame.stale[max(view, 1u) - 1u] > 0.0;
}

// The view of a number among those that are drawn, of which the camera's is the first: software would work on all plants for each
// view that is not.
fn drawn_view(number: u32) -> u32 {
    var found = 0u;
    var drawn = 0u;
    for (var view = 1u; view < VIEWS; view++) {
        drawn += select(0u, 1u, is_drawn(view));
        found = select(found, view, is_drawn(view) && drawn == number);
    }
    return found;
}

// How far a plant is at least from the eye, or from what stands for it in a cascade.
fn distance_in(view: u32, plant: PlacedPlant) -> f32 {
    if view == 0u || view == VIEWS - 1u {
        return length(plant.place - frame.moment.yzw);
    }
    let chosen = frame.detail_points[view - 1u];
    return max(length(plant.place - chosen.xyz) - chosen.w, 0.0);
}

// Height of a plant in pixels, or in what texels of a cascade are worth where that is less; the last cascade does not know
// the camera.
fn pixels_of(view: u32, plant: PlacedPlant) -> f32 {
    let distance = max(distance_in(view, plant), 0.05);
    let standing = select(1.0, drawn_as_trees_at(distance), kind.wood.x > 0.0);
    let pixels = standing * plant.size / (distance * frame.eye.w);
    if view == 0u {
        return pixels;
    }
    let texels = TEXEL_PIXELS * plant.size / texel_of(i32(view) - 1);
    let shaded = max(SHADOW_PIXELS * pixels, min(pixels, SMALL_PIXELS));
    return select(min(shaded, texels), texels, view == VIEWS - 1u);
}

// How broad the leaves of a tree of a wood are before the eye: one that stands around it gives way.
fn giving_way(view: u32, plant: PlacedPlant) -> f32 {
    let is_of_the_camera = view == 0u || view == VIEWS - 1u;
    let chosen = select(frame.detail_points[min(max(view, 1u), VIEWS - 2u) - 1u].xyz, frame.moment.yzw, is_of_the_camera);
    let away = plant.place - chosen;
    let share = clamp((length(away.xy) / plant.size - 0.35) / 0.2, 0.0, 1.0);
    return select(1.0, share, kind.wood.x > 0.0 && away.z > -1.2 * plant.size);
}

// Side in metres of a texel of a cascade.
fn texel_of(cascade: i32) -> f32 {
    let half = frame.cascades[cascade].zw;
    return 2.0 * max(half.x, half.y) / f32(SHADOW_TEXELS);
}

// The level of detail of such a height: whole numbers where a level stands alone.
fn detail_of(pixels: f32) -> f32 {
    var detail = 0.0;
    for (var level = 0u; level < PLANT_LEVELS; level++) {
        let fraction = clamp(log2(ENDS[level] * PASSES / pixels) / (2.0 * log2(PASSES)), 0.0, 1.0);
        detail += fraction * fraction * (3.0 - 2.0 * fraction);
    }
    return detail;
}

// How broad the leaves are that levels from the first to the last have.
fn share_of_levels(detail: f32, first: f32, last: f32) -> f32 {
    return clamp(min(detail - first + 1.0, last + 1.0 - detail), 0.0, 1.0);
}
