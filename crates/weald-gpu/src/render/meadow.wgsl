// Which sets of grass are drawn where it is looked at, and how finely: the twin of choice.rs, with the same names.

// Distances in metres up to which blades have their finest and middle shapes.
const NEAR = 4.5;
const MIDDLE = 14.0;

// Lists by distance.
const LISTS = 3u;

// Sets that one thread chooses from, one after the other.
const RUN = 16u;

// Sets of an instance that is drawn.
const SETS_PER_INSTANCE = 8u;

// Threads of a workgroup.
const GROUP = 256u;

// Share of ranks over which a set that is left out sinks away, so that none vanishes at once.
const SINKING = 0.25;

// Share of a list's farthest distance at which its rows begin to slide.
const SLIDE = 0.6;

// Places between the eye and a set at which ground may hide it, and metres above the tips of its blades from which it counts
// as seen.
const LOOKS = 5u;
const SPARE = 0.1;

// Share of light that comes through a blade.
const THROUGH = 0.45;

struct Choice {
    rows: vec4<u32>,
    culled: u32,
    thinned: u32,
    hides: u32,
}

@group(2) @binding(1) var<uniform> choice: Choice;

// Where a set stands, on the ground.
fn grass_root(place: vec2<f32>) -> vec3<f32> {
    let point = vec3<f32>(place.x, -place.y, 0.0);
    return vec3<f32>(point.xy, spline_at(bed, place_of(point)));
}

// How high a set of a rank stands at a distance, as a share: 0 where it is left out. Here and below what hangs on `choice` alone
// is a condition: with `select` in their place software (lavapipe of Mesa 22.3) crashes in what chooses.
fn height_share(rank: f32, distance: f32) -> f32 {
    if choice.thinned == 0u {
        return 1.0;
    }
    return clamp((share(distance) * (1.0 + SINKING) - rank) / SINKING, 0.0, 1.0);
}

// How far every second row of a list's blades has slid onto the one before it, at a distance as it counts.
fn row_slide(list: u32, distance: f32) -> f32 {
    if choice.thinned == 0u || list > 1u {
        return 0.0;
    }
    let end = select(MIDDLE, NEAR, list == 0u);
    return clamp((distance - SLIDE * end) / ((1.0 - SLIDE) * end), 0.0, 1.0);
}

// The list of a distance: 0 for the finest blades.
fn list(distance: f32) -> u32 {
    if choice.thinned == 0u {
        return 0u;
    }
    return select(select(2u, 1u, distance < MIDDLE), 0u, distance < NEAR);
}

// Where the sets of a run and all of their blades are, and the least of their ranks.
struct RunBounds {
    middle: vec2<f32>,
    radius: f32,
    rank: f32,
}

// Whether what is around a place, and around whatever ground there is, may be in sight.
fn may_be_in_sight(place: vec2<f32>, radius: f32) -> bool {
    if choice.culled == 1u {
        let from_eye = vec2<f32>(place.x, -place.y) - frame.eye.xy;
        // Ground lies between 0 and the highest of all; a simulation that is followed may dig and heap up.
        let slack = 0.5 * scene.scale.z + 50.0;
        let heights = vec2<f32>(-slack, scene.scale.z + slack) - frame.eye.z;
        let ahead = frame.forward.z * heights;
        let depth = dot(from_eye, frame.forward.xy) + max(ahead.x, ahead.y);
        let tilted = abs(frame.right.z) * max(abs(heights.x), abs(heights.y));
        let aside = abs(dot(from_eye, frame.right.xy)) - tilted;
        let spread = sqrt(1.0 + frame.right.w * frame.right.w);
        return depth >= -radius && aside <= depth * frame.right.w + radius * spread;
    }
    return true;
}

fn distance_along_ground(place: vec2<f32>) -> f32 {
    return length(vec2<f32>(place.x, -place.y) - frame.moment.yz);
}

// Whether a set may be drawn, whatever the height of the ground there, which is not looked up for all others.
fn may_be_drawn(instance: Instance) -> bool {
    let stands = height_share(rank_of(instance.tuft), distance_along_ground(instance.place)) > 0.0;
    return stands && may_be_in_sight(instance.place, reach_of_blades(instance.species));
}

// Whether any set of a run may be.
fn may_any_be_drawn(run: RunBounds) -> bool {
    let nearest = max(distance_along_ground(run.middle) - run.radius, 0.0);
    return may_be_in_sight(run.middle, run.radius) && height_share(run.rank, nearest) > 0.0;
}

// Metres above its root that no blade of a species exceeds, nor lies aside of it.
fn tallest(species: u32) -> f32 {
    return row_of(species, 0u).w * max(row_of(species, 6u).w, 1.0) + row_of(species, 2u).z;
}

// Radius of a ball around the root of a set that holds its blades, wherever they sway.
fn reach_of_blades(species: u32) -> f32 {
    return tallest(species) + SPARE;
}

// At how many places on the way to a set of a list ground is looked at that may hide it.
fn looks_for_ground(list: u32) -> u32 {
    return select(0u, LOOKS, (choice.hides == 1u) & (list < LISTS));
}

// Whether ground is higher at one of them than the way from the eye to a point above the root.
fn is_below_ground(look: u32, species: u32, root: vec3<f32>) -> bool {
    let top_of_set = root + vec3<f32>(0.0, 0.0, tallest(species) + SPARE);
    let on_the_way = mix(frame.eye.xyz, top_of_set, (f32(look) + 0.5) / f32(LOOKS));
    let place = place_of(on_the_way);
    let is_within = all(place >= vec2<f32>(0.5)) & all(place <= scene.grid.xy + 0.5);
    return is_within & (spline_at(bed, place) > on_the_way.z);
}

// The list in which a set is drawn whose root is there; as many as there are where it is not.
fn list_of(instance: Instance, root: vec3<f32>) -> u32 {
    let distance = length(root - frame.moment.yzw);
    let stands = height_share(rank_of(instance.tuft), distance) > 0.0;
    let seen = choice.culled == 0u || is_in_sight(root - frame.eye.xyz, reach_of_blades(instance.species));
    return select(LISTS, list(counted(distance)), stands && seen);
}

// Where in `starts` what a run counts of a list stands, for so many sets.
fn place_of_run(list: u32, run: u32, count: u32) -> u32 {
    return list * ((count + RUN - 1u) / RUN) + run;
}
