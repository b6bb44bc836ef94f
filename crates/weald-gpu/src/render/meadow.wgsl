// Which sets of grass are drawn where it is looked at, and how finely: the twin of choice.rs, with the same names.

// Distances in metres up to which blades have their finest and middle shapes.
const NEAR = 9.0;
const MIDDLE = 28.0;

// Lists by distance.
const LISTS = 3u;

// Sets of a workgroup that chooses.
const GROUP = 256u;

// Share of ranks over which a set that is left out sinks away, so that none vanishes at once.
const SINKING = 0.25;

// Share of a list's farthest distance at which its rows begin to slide.
const SLIDE = 0.6;

// A ball around a set's root that holds its blades.
const AROUND = 2.0;

// Share of light that comes through a blade.
const THROUGH = 0.45;

struct Choice {
    rows: vec4<u32>,
    culled: u32,
    thinned: u32,
}

@group(2) @binding(1) var<uniform> choice: Choice;

// A chosen set: its root, the share of the sun that it sees, the push of the wind, and the leaves around it.
struct LitSet {
    root: vec3<f32>,
    sun: f32,
    push: vec2<f32>,
    leaves: f32,
    unused: f32,
}

// Where a set stands, on the ground.
fn grass_root(place: vec2<f32>) -> vec3<f32> {
    let point = vec3<f32>(place.x, -place.y, 0.0);
    return vec3<f32>(point.xy, spline_at(bed, place_of(point)));
}

// How high a set of a rank stands at a distance, as a share: 0 where it is left out.
fn height_share(rank: f32, distance: f32) -> f32 {
    if choice.thinned == 0u {
        return 1.0;
    }
    return clamp((share(distance) * (1.0 + SINKING) - rank) / SINKING, 0.0, 1.0);
}

// How far every second row of a list's blades has slid onto the one before it.
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

// The list in which a set is drawn whose root is there; as many as there are where it is not.
fn list_of(tuft: Set, root: vec3<f32>) -> u32 {
    let distance = length(root - frame.moment.yzw);
    let stands = height_share(rank_of(tuft), distance) > 0.0;
    let seen = choice.culled == 0u || is_in_sight(root - frame.eye.xyz, AROUND);
    return select(LISTS, list(distance), stands && seen);
}

// Where in `starts` what a workgroup counts of a list stands, for so many sets.
fn place_of_count(list: u32, group: u32, count: u32) -> u32 {
    return list * ((count + GROUP - 1u) / GROUP) + group;
}

// Sets whose blades are worked out once for all of their vertices; those of the others are for each.
const KEPT_SETS = 131072u;

// A blade as it is seen: its stem, of which the first point is the root; then in 16 bits each its root and facing, how wide it
// and its head are, how it tapers and folds, how long its head is and how high it stands, and its two colours.
struct KeptBlade {
    low: vec4<f32>,
    high: vec4<f32>,
    form: vec4<u32>,
    look: vec4<u32>,
}

// Blades of a set that are drawn where its blades are coarsest: the others have sunk into the ground there, beginning at this
// share of the distance, and those that are left are so much broader.
const FAR_BLADES = 3u;
const FROM_SHARE = 0.5;
const FAR_BROADER = 1.4;

// How high a blade stands beside its set's others, by its number.
fn blade_share(number: u32, distance: f32) -> f32 {
    if choice.thinned == 0u || number < FAR_BLADES {
        return 1.0;
    }
    return clamp((MIDDLE - distance) / ((1.0 - FROM_SHARE) * MIDDLE), 0.0, 1.0);
}

// How many blades of a set a list draws.
fn blades_of(list: u32) -> u32 {
    return select(BLADES, FAR_BLADES, list == LISTS - 1u);
}

// A blade of a set that is so far away. Fewer blades are broader, so that a meadow stays as thick; none is thinner than it can
// be seen.
fn seen_blade(species: u32, tuft: Set, number: u32, distance: f32) -> KeptBlade {
    let blade = blade_of(species, tuft, number);
    let standing = select(1.0, share(distance), choice.thinned == 1u);
    let fewer = mix(FAR_BROADER, 1.0, blade_share(BLADES - 1u, distance));
    let width = fewer * max(blade.width * broader(standing), min(0.8 * distance * frame.eye.w, 0.03));
    let tall = height_share(rank_of(tuft), distance) * blade_share(number, distance);
    let leaf = colour_of(species, blade.blend, 0.0);
    let head = colour_of(species, blade.blend, 1.0);
    return KeptBlade(
        vec4<f32>(blade.stem.b, blade.stem.c),
        vec4<f32>(blade.stem.d, blade.stem.e),
        vec4<u32>(
            pack2x16float(blade.root), pack2x16float(blade.facing), pack2x16float(vec2<f32>(width, blade.head_width)),
            pack2x16float(vec2<f32>(blade.taper, blade.fold)),
        ),
        vec4<u32>(
            pack2x16float(vec2<f32>(blade.head_length, tall)), pack2x16float(leaf.xy),
            pack2x16float(vec2<f32>(leaf.z, head.z)), pack2x16float(head.xy),
        ),
    );
}

// The blade that was kept.
fn blade_kept(kept: KeptBlade) -> Blade {
    let widths = unpack2x16float(kept.form.z);
    let folds = unpack2x16float(kept.form.w);
    return Blade(
        Spline(vec2<f32>(0.0), kept.low.xy, kept.low.zw, kept.high.xy, kept.high.zw),
        unpack2x16float(kept.form.x), unpack2x16float(kept.form.y), widths.x, folds.x, folds.y,
        unpack2x16float(kept.look.x).x, widths.y, 0.0,
    );
}
