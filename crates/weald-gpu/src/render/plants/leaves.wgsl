// Leaves and stems of plants: bent by the wind, lit from both sides, and as the sun sees them.

struct DrawIndex {
    view: u32,
    list: u32,
}

struct Corner {
    rest: vec3<f32>,
    along: f32,
    // The point of the leaf's axis to which it goes as the leaf becomes narrower.
    axis: vec3<f32>,
    limb: u32,
    normal: vec3<f32>,
    // Tone and openness in 8 bits each, first and last level in 3 each, whether it is of a stem.
    look: u32,
}

@group(2) @binding(0) var<uniform> kind: Kind;
@group(2) @binding(1) var<storage, read> plants: array<PlacedPlant>;
@group(2) @binding(2) var<storage, read> kept: array<u32>;
@group(2) @binding(3) var<storage, read> starts: array<u32>;
@group(2) @binding(4) var<storage, read> limbs: array<Limb>;
@group(2) @binding(5) var<storage, read> corners: array<Corner>;
@group(2) @binding(6) var<storage, read> carried: array<Carried>;
@group(3) @binding(0) var<uniform> which: DrawIndex;

// Share of light that comes through a leaf.
const THROUGH_LEAF = 0.42;

// Where in the lists of its view a plant is.
fn place_of_plant(instance: u32) -> u32 {
    return starts[which.view * LISTS + which.list] + instance;
}

fn plant_of(place: u32) -> PlacedPlant {
    return plants[kept[which.view * arrayLength(&plants) + place]];
}

// From the axes east, up, south to east, north, up.
fn of_the_land(v: vec3<f32>) -> vec3<f32> {
    return vec3<f32>(v.x, -v.z, v.y);
}

// Where a corner of a plant goes in the wind, with a seat of its own or between two that are shared.
fn swayed(place: u32, corner: Corner, rest: vec3<f32>, breeze: LocalWind) -> Bent {
    if corner.limb == NO_PARENT {
        return Bent(rest, corner.normal);
    }
    let has_seat = place < seats_of(which.view, starts[which.view * LISTS + SEATED_LISTS]);
    let seats = select(shared_seat(breeze), vec2<f32>(f32(FIRST_SEATS[which.view] + place), 0.0), has_seat);
    let own = turned_limb(limbs[corner.limb], corner.along, breeze);
    let count = arrayLength(&limbs);
    let seat = u32(seats.x);
    let first = carried_by(own, carried[seat * count + corner.limb]);
    let second = carried_by(own, carried[select(seat + 1u, seat, has_seat) * count + corner.limb]);
    let point = mix(rotated(first.turn, rest) + first.shift, rotated(second.turn, rest) + second.shift, seats.y);
    return Bent(point, rotated(first.turn, corner.normal));
}

// Where a corner of a plant is, and its normal.
fn corner_of(plant: PlacedPlant, place: u32, corner: Corner) -> Bent {
    let first = f32((corner.look >> 16u) & 7u);
    let last = f32((corner.look >> 19u) & 7u);
    let share = giving_way(which.view, plant) * share_of_levels(detail_of(pixels_of(which.view, plant)), first, last);
    let turn = turn_of(plant);
    let rest = corner.axis + share * (corner.rest - corner.axis);
    let found = swayed(place, corner, rest, breeze_of(plant));
    let point = plant.place + of_the_land(rotated(turn, found.point * plant.size));
    return Bent(point, of_the_land(rotated(turn, found.normal)));
}

fn colour_of_corner(plant: PlacedPlant, look: u32) -> vec3<f32> {
    if ((look >> 22u) & 1u) == 1u {
        return kind.stem.xyz;
    }
    let tone = f32(look & 255u) / 255.0;
    // Some plants are older and yellower than others.
    let aged = mix(vec3<f32>(1.0), vec3<f32>(1.5, 1.1, 0.8), 0.5 * plant.chance * plant.chance);
    return kind.leaf.xyz * mix(0.5, 0.82, tone) * aged;
}

// The share of the sun that is seen from a leaf: one look, since the corners of leaves lie closer than the edge of a shadow
// is wide.
fn sun_on_leaf(point: vec3<f32>) -> f32 {
    var passed = 1.0;
    var seen = 0.0;
    for (var cascade = first_cascade(point); cascade < CASCADES; cascade++) {
        // Off the leaf itself.
        let at = in_cascade(point + 1.5 * texel_of(cascade) * scene.sun.xyz, cascade);
        let inside = 1.0 - max(abs(at.x), abs(at.y));
        if inside <= 0.0 {
            continue;
        }
        let share = select(clamp(inside / PASSING, 0.0, 1.0), 1.0, cascade == CASCADES - 1);
        let place = at.xy * vec2<f32>(0.5, -0.5) + 0.5;
        let depth = clamp(at.z, 0.0, 1.0);
        let open = textureSampleCompareLevel(shadow_depths, shadow_between, place, cascade, depth);
        seen += passed * share * open;
        passed *= 1.0 - share;
        if passed <= 0.0 {
            break;
        }
    }
    return seen + passed;
}

@vertex
fn leaf_vertex(@builtin(vertex_index) vertex: u32, @builtin(instance_index) instance: u32) -> Leaf {
    let place = place_of_plant(instance);
    let plant = plant_of(place);
    let corner = corners[vertex];
    let found = corner_of(plant, place, corner);
    let sun = sun_on_leaf(found.point);
    let open = f32((corner.look >> 8u) & 255u) / 255.0;
    return Leaf(
        projected(found.point),
        found.point,
        found.normal,
        colour_of_corner(plant, corner.look),
        vec2<f32>(sun, open),
    );
}

@fragment
fn leaf_fragment(in: Leaf) -> @location(0) vec4<f32> {
    let light = vec2<f32>(in.light.x * in.light.y, in.light.y);
    return leaf_light(in.colour, in.point, in.normal, light, THROUGH_LEAF, 1.0);
}

// As the sun sees them. What stands higher than all ground is not cut off.
@vertex
fn leaf_caster(
    @builtin(vertex_index) vertex: u32,
    @builtin(instance_index) instance: u32,
) -> @builtin(position) vec4<f32> {
    let place = place_of_plant(instance);
    let found = corner_of(plant_of(place), place, corners[vertex]);
    let at = in_cascade(found.point, i32(which.view) - 1);
    return vec4<f32>(at.xy, max(at.z, 0.0), 1.0);
}
