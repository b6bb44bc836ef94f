// How all limbs of the plants that have a seat are carried: limbs on the ground, then those on them, and so on.

@group(2) @binding(0) var<uniform> kind: Kind;
@group(2) @binding(1) var<storage, read> plants: array<PlacedPlant>;
@group(2) @binding(2) var<storage, read> kept: array<u32>;
@group(2) @binding(3) var<storage, read> starts: array<u32>;
// How many layers of limbs there are, where each starts, where the last ends, and all limbs in that order.
@group(2) @binding(4) var<storage, read> layers: array<u32>;
// For limbs on them, and for leaves, which read a texel faster.
@group(2) @binding(5) var<storage, read_write> carried: array<vec4<u32>>;
@group(2) @binding(6) var limbs: texture_2d<u32>;
@group(2) @binding(7) var carried_texels: texture_storage_2d<rgba32uint, write>;

const THREADS = 64u;

// Whether some view has more plants than seats.
fn some_share() -> bool {
    for (var view = 0u; view < VIEWS; view++) {
        if is_drawn(view) && starts[VIEWS * LISTS + view] > seats_of(view, starts[view * LISTS + SEATED_LISTS]) {
            return true;
        }
    }
    return false;
}

fn limb_at(number: u32) -> Limb {
    let record = record_at(limbs, number);
    let joint = bitcast<vec4<f32>>(record.first);
    return Limb(joint.xyz, joint.w, bitcast<vec3<f32>>(record.second.xyz), record.second.w);
}

@compute @workgroup_size(THREADS)
fn carry_limbs(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) thread: u32) {
    let view = group.y;
    let is_shared = view == SHARED_VIEW;
    let seats = select(seats_of(view, starts[view * LISTS + SEATED_LISTS]), SIDES * STRENGTHS, is_shared);
    if group.x >= seats || select(!is_drawn(view), !some_share(), is_shared) {
        return;
    }
    var breeze: LocalWind;
    if is_shared {
        breeze = shared_breeze(group.x);
    } else {
        breeze = breeze_of(view, plants[kept[view * arrayLength(&plants) + group.x]]);
    }
    let base = (FIRST_SEATS[view] + group.x) * u32(kind.leaflets.z);
    let count = layers[0];
    for (var layer = 0u; layer < count; layer++) {
        for (var at = layers[1u + layer] + thread; at < layers[2u + layer]; at += THREADS) {
            let number = layers[2u + count + at];
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
        storageBarrier();
    }
}
