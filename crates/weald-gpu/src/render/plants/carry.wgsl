// How all limbs of the plants that have a seat are carried: limbs on the ground, then those on them, and so on.

@group(2) @binding(0) var<uniform> kind: Kind;
@group(2) @binding(1) var<storage, read> plants: array<PlacedPlant>;
@group(2) @binding(2) var<storage, read> kept: array<u32>;
@group(2) @binding(3) var<storage, read> starts: array<u32>;
@group(2) @binding(4) var<storage, read> limbs: array<Limb>;
// How many layers of limbs there are, where each starts, where the last ends, and all limbs in that order.
@group(2) @binding(5) var<storage, read> layers: array<u32>;
@group(2) @binding(6) var<storage, read_write> carried: array<Carried>;

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
        breeze = breeze_of(plants[kept[view * arrayLength(&plants) + group.x]]);
    }
    let base = (FIRST_SEATS[view] + group.x) * arrayLength(&limbs);
    let count = layers[0];
    for (var layer = 0u; layer < count; layer++) {
        for (var at = layers[1u + layer] + thread; at < layers[2u + layer]; at += THREADS) {
            let number = layers[2u + count + at];
            let limb = limbs[number];
            let parent = limb.tie & NO_PARENT;
            var here = Carried(vec4<f32>(0.0, 0.0, 0.0, 1.0), vec3<f32>(0.0));
            if parent != NO_PARENT {
                here = carried_by(turned_limb(limbs[parent], limb.along, breeze), carried[base + parent]);
            }
            carried[base + number] = here;
        }
        storageBarrier();
    }
}
