// Leaves and stems of plants: bent by the wind, lit from both sides, and as the sun sees them.

struct DrawnView {
    view: u32,
}

// A corner with the limb on which it is, which software that acts as a device reads ten times as fast from here as from a
// buffer of all limbs.
struct Corner {
    // With how far along its limb it is.
    @location(0) rest: vec4<f32>,
    // The point of the leaf's axis to which it goes as the leaf becomes narrower.
    @location(1) axis: vec3<f32>,
    @location(2) limb: u32,
    @location(3) normal: vec3<f32>,
    // Tone and openness in 8 bits each, first and last level in 3 each, whether it is of a stem, how far up its leaf in 5,
    // its edge in 2.
    @location(4) look: u32,
    // The limb: `Limb`.
    @location(5) joint: vec4<f32>,
    @location(6) direction: vec3<f32>,
    @location(7) tie: u32,
}

// Where the list that is drawn starts among those of its view, and the first of them that has no seats.
struct ListStarts {
    @location(8) own: u32,
    @location(9) seated: u32,
}

@group(2) @binding(0) var<uniform> kind: Kind;
@group(2) @binding(1) var carried: texture_2d<u32>;
// The plants of all views, each as many as there are in all.
@group(2) @binding(2) var seen: texture_2d<u32>;
@group(3) @binding(0) var<uniform> which: DrawnView;

// A corner of a leaf or stem, in few numbers: what draws triangles works on each, and the point follows from where a pixel is.
struct PlantCorner {
    @builtin(position) position: vec4<f32>,
    // The normal, and the share of the sun that is seen among others.
    @location(0) normal: vec4<f32>,
    // How far up its leaf, and from the left edge at -1 to the right one at 1; its tone; the share of the sky that is seen, with a
    // whole number of `APART`, which all of the leaf has: its age, and whether it is of a stem.
    @location(1) look: vec4<f32>,
}

// How far whole numbers are apart. Shares lie between 0 and 1 on a leaf, but a pixel may have a sample on it and its middle, for
// which they are worked out, beside it.
const APART = 16.0;

// What the corners of a leaf have in common, and its openness.
struct OfLeaf {
    is_stem: bool,
    age: f32,
    open: f32,
}

fn packed_leaf(leaf: OfLeaf) -> f32 {
    let whole = select(0.0, 1.0, leaf.is_stem) + 2.0 * round(AGES * leaf.age);
    return leaf.open + APART * whole;
}

fn leaf_of(packed: f32) -> OfLeaf {
    let whole = floor(packed / APART + 0.46875);
    return OfLeaf(fract(0.5 * whole) > 0.25, floor(0.5 * whole) / AGES, clamp(packed - APART * whole, 0.0, 1.0));
}

// Share of light that comes through a leaf.
const THROUGH_LEAF = 0.42;

// The plant at a place in the lists of its view.
fn plant_of(place: u32) -> SeenPlant {
    return unpacked_seen(record_at(seen, which.view * u32(kind.leaflets.w) + place));
}

// From the axes east, up, south to east, north, up.
fn of_the_land(v: vec3<f32>) -> vec3<f32> {
    return vec3<f32>(v.x, -v.z, v.y);
}

// Where in the lists of its view a plant is, and how many of these have seats of their own.
struct Seating {
    place: u32,
    seats: u32,
}

fn seating_of(starts: ListStarts, instance: u32) -> Seating {
    return Seating(starts.own + instance, seats_of(which.view, starts.seated));
}

// How a limb on a seat is carried.
fn carried_at(place: u32) -> Carried {
    return unpacked_carried(textureLoad(carried, texel_of_carried(place), 0));
}

// Where a corner of a plant goes in the wind, with a seat of its own or between two that are shared.
fn swayed(plant: SeenPlant, seating: Seating, corner: Corner, rest: vec3<f32>) -> Bent {
    if corner.limb == NO_PARENT {
        return Bent(rest, corner.normal);
    }
    let breeze = wind_on(plant.push, frame.moment.x, plant.phase);
    let has_seat = seating.place < seating.seats;
    let own_seat = f32(FIRST_SEATS[which.view] + seating.place);
    let seats = select(shared_seat(plant.side, breeze.push), vec2<f32>(own_seat, 0.0), has_seat);
    let limb = Limb(corner.joint.xyz, corner.joint.w, corner.direction, corner.tie);
    let own = turned_limb(limb, corner.rest.w, breeze);
    let count = u32(kind.leaflets.z);
    let seat = u32(seats.x);
    let first = carried_by(own, carried_at(seat * count + corner.limb));
    var second = first;
    if !has_seat {
        second = carried_by(own, carried_at((seat + 1u) * count + corner.limb));
    }
    let point = mix(rotated(first.turn, rest) + first.shift, rotated(second.turn, rest) + second.shift, seats.y);
    return Bent(point, rotated(first.turn, corner.normal));
}

// Where a corner of a plant is, and its normal.
fn corner_of(plant: SeenPlant, seating: Seating, corner: Corner) -> Bent {
    let first = f32((corner.look >> 16u) & 7u);
    let last = f32((corner.look >> 19u) & 7u);
    let share = plant.breadth * share_of_levels(plant.detail, first, last);
    let rest = corner.axis + share * (corner.rest.xyz - corner.axis);
    let found = swayed(plant, seating, corner, rest);
    let point = plant.place + of_the_land(rotated(plant.turn, found.point * plant.size));
    return Bent(point, of_the_land(rotated(plant.turn, found.normal)));
}

fn leaf_colour(tone: f32, age: f32) -> vec3<f32> {
    let aged = mix(vec3<f32>(1.0), vec3<f32>(1.5, 1.1, 0.8), 0.5 * age);
    return kind.leaf.xyz * mix(0.5, 0.82, tone) * aged;
}

// The share of the sun that is seen from a leaf: one look, since the corners of leaves lie closer than the edge of a shadow
// is wide.
fn sun_on_leaf(point: vec3<f32>) -> f32 {
    var passed = 1.0;
    var seen = 0.0;
    let first = first_cascade(point);
    var cascade = min(first, CASCADES - 1);
    loop {
        // Off the leaf itself.
        let at = in_cascade(point + 1.5 * texel_of(cascade) * scene.sun.xyz, cascade);
        let inside = 1.0 - max(abs(at.x), abs(at.y));
        let share = select(0.0, share_of_cascade(cascade, inside), first < CASCADES);
        let place = at.xy * vec2<f32>(0.5, -0.5) + 0.5;
        let depth = clamp(at.z, 0.0, 1.0);
        let open = textureSampleCompareLevel(shadow_depths, shadow_between, place, cascade, depth);
        seen += passed * share * open;
        passed *= 1.0 - share;
        cascade++;
        if cascade >= CASCADES || passed <= 0.0 {
            break;
        }
    }
    return seen + passed;
}

@vertex
fn leaf_vertex(corner: Corner, starts: ListStarts, @builtin(instance_index) instance: u32) -> PlantCorner {
    let seating = seating_of(starts, instance);
    let plant = plant_of(seating.place);
    let found = corner_of(plant, seating, corner);
    let sun = sun_on_leaf(found.point);
    let open = f32((corner.look >> 8u) & 255u) / 255.0;
    let leaf = OfLeaf(((corner.look >> 22u) & 1u) == 1u, plant.age, open);
    let up = f32((corner.look >> 23u) & 31u) / 31.0;
    let edge = f32((corner.look >> 28u) & 3u) - 1.0;
    let tone = f32(corner.look & 255u) / 255.0;
    return PlantCorner(
        projected(found.point),
        vec4<f32>(found.normal, sun),
        vec4<f32>(up, edge, tone, packed_leaf(leaf)),
    );
}

fn plant_light(in: PlantCorner, leaf: OfLeaf) -> vec4<f32> {
    // The middle of a pixel may lie beside what it has samples of, where a depth is none.
    let point = point_at(in.position.xy, max(in.position.z, 1e-9));
    let normal = in.normal.xyz;
    let turned = length(fwidth(normal));
    var seen = Bark(leaf_colour(clamp(in.look.z, 0.0, 1.0), leaf.age), normal);
    if leaf.is_stem {
        seen = bark_of(kind.stem.xyz, point, normal, turned);
    }
    let through = select(THROUGH_LEAF, 0.0, leaf.is_stem);
    let light = vec2<f32>(clamp(in.normal.w, 0.0, 1.0) * leaf.open, leaf.open);
    return leaf_light(seen.colour, point, seen.normal, light, through, 1.0);
}

@fragment
fn leaf_fragment(in: PlantCorner) -> @location(0) vec4<f32> {
    return plant_light(in, leaf_of(in.look.w));
}

// The same of leaves that are divided into leaflets or needles.
@fragment
fn divided_fragment(in: PlantCorner) -> @location(0) vec4<f32> {
    let leaf = leaf_of(in.look.w);
    let light = plant_light(in, leaf);
    if is_between_leaflets(in.look.xy, kind.leaflets.x, kind.leaflets.y) && !leaf.is_stem {
        discard;
    }
    return light;
}

// As the sun sees them. What stands higher than all ground is not cut off.
@vertex
fn leaf_caster(
    corner: Corner,
    starts: ListStarts,
    @builtin(instance_index) instance: u32,
) -> @builtin(position) vec4<f32> {
    let seating = seating_of(starts, instance);
    let found = corner_of(plant_of(seating.place), seating, corner);
    let at = in_cascade(found.point, i32(which.view) - 1);
    return vec4<f32>(at.xy, max(at.z, 0.0), 1.0);
}
