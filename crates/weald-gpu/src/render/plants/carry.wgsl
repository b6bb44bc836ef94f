// How the limbs of the plants that have a seat are carried: limbs on the ground, then those on them, and so on; of a plant that
// is seen small those alone on which its few large leaves hang.

@group(2) @binding(0) var<uniform> kind: Kind;
@group(2) @binding(1) var<storage, read> plants: array<PlacedPlant>;
@group(2) @binding(2) var<storage, read> kept: array<u32>;
@group(2) @binding(3) var<storage, read> starts: array<u32>;
// How many layers of limbs there are; where each ends, of limbs that each level of detail has; and all limbs in that order.
@group(2) @binding(4) var<storage, read> layers: array<u32>;
// For limbs on them, and for leaves, which read a texel faster.
@group(2) @binding(5) var<storage, read_write> carried: array<vec4<u32>>;
@group(2) @binding(6) var limbs: texture_2d<u32>;
@group(2) @binding(7) var carried_texels: texture_storage_2d<rgba32uint, write>;

const THREADS = 64u;

// How many plants of a view have a seat.
fn seated_in(view: u32) -> u32 {
    return seats_of(view, starts[view * LISTS + SEATED_LISTS]);
}

// The level of detail of the plant at a place in the lists of a view, the finer one where it passes into the next.
fn level_at(view: u32, place: u32) -> u32 {
    var list = 0u;
    for (var next = 1u; next < LISTS; next++) {
        list = select(list, next, starts[view * LISTS + next] <= place);
    }
    return list / 2u;
}

// The finest level of plants without a seat; as many as there are where all have one. Lists begin with the finest.
fn shared_level() -> u32 {
    var level = PLANT_LEVELS;
    for (var view = 0u; view < VIEWS; view++) {
        let seated = seated_in(view);
        if is_drawn(view) && starts[VIEWS * LISTS + view] > seated {
            level = min(level, level_at(view, seated));
        }
    }
    return level;
}

// The level of detail that is drawn from a seat; as many as there are where none is.
fn level_of_seat(view: u32, seat: u32) -> u32 {
    if view == SHARED_VIEW {
        return select(PLANT_LEVELS, shared_level(), seat < SIDES * STRENGTHS);
    }
    return select(PLANT_LEVELS, level_at(view, seat), is_drawn(view) && seat < seated_in(view));
}

fn limb_at(number: u32) -> Limb {
    let record = record_at(limbs, number);
    let joint = bitcast<vec4<f32>>(record.first);
    return Limb(joint.xyz, joint.w, bitcast<vec3<f32>>(record.second.xyz), record.second.w);
}

// Of which view the seats are: the camera's, those that plants share, then those of cascades that are drawn.
fn carried_view(number: u32) -> u32 {
    return select(drawn_view(max(number, 1u) - 1u), SHARED_VIEW, number == 1u);
}

@compute @workgroup_size(THREADS)
fn carry_limbs(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) thread: u32) {
    let view = carried_view(group.y);
    let level = level_of_seat(view, group.x);
    if level >= PLANT_LEVELS {
        return;
    }
    var breeze: LocalWind;
    if view == SHARED_VIEW {
        breeze = shared_breeze(group.x);
    } else {
        breeze = breeze_of(view, plants[kept[view * arrayLength(&plants) + group.x]]);
    }
    let base = (FIRST_SEATS[view] + group.x) * u32(kind.leaflets.z);
    let count = layers[0];
    let order = 1u + PLANT_LEVELS * count;
    var start = 0u;
    for (var layer = 0u; layer < count; layer++) {
        let end = layers[1u + level * count + layer];
        for (var at = start + thread; at < end; at += THREADS) {
            let number = layers[order + at];
            let limb = limb_at(number);
            let parent = limb.tie & NO_PARENT;
            var here = Carried(vec4<f32>(0.0, 0.0, 0.0, 1.0), vec3<f32>(0.0));
            if parent != NO_PARENT {
                let below = unpacked_carried(carried[base + parent]);
                here = carried_by(turned_limb(limb_at(parent), limb.along, breeze), below);
            }
            let packed = packed_carried(here);
            carried[base + number] = packed;
            textureStore(carried_texels, texel_of_carried(base + number), packed);
        }
        // All limbs of a layer are those of the finest level.
        start = layers[1u + layer];
        storageBarrier();
    }
}
