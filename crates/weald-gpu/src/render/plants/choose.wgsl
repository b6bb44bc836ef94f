// Which plants are drawn in each view, and how finely: in lists, one behind the other, in the order of the plants. Each is in
// one list of a view at most.

// What an indexed indirect draw wants.
struct Draw {
    indices: u32,
    instances: u32,
    first_index: u32,
    base_vertex: i32,
    first_instance: u32,
}

@group(2) @binding(0) var<uniform> kind: Kind;
@group(2) @binding(1) var<storage, read> plants: array<PlacedPlant>;
@group(2) @binding(2) var<storage, read_write> kept: array<u32>;
// Where each list of each view starts; then how many plants each view has.
@group(2) @binding(3) var<storage, read_write> starts: array<u32>;
@group(2) @binding(4) var<storage, read_write> draws: array<Draw>;
// Plants of each list in each workgroup of each view, then how many are before them.
@group(2) @binding(5) var<storage, read_write> counts: array<u32>;
@group(2) @binding(6) var seen: texture_storage_2d<rgba32uint, write>;

const GROUP = 256u;

var<workgroup> tally: array<atomic<u32>, LISTS>;
var<workgroup> lists: array<u32, GROUP>;
var<workgroup> totals: array<u32, LISTS>;

// The list of a plant in a view.
fn list_of(view: u32, number: u32) -> u32 {
    if number >= arrayLength(&plants) {
        return NO_LIST;
    }
    let plant = plants[number];
    // In a square of a wood there may be no tree, and the sun's last cascade does not know where the camera is.
    if plant.size <= 0.0 || giving_way(view, plant) <= 0.0 || (kind.wood.x > 0.0 && view == VIEWS - 1u) {
        return NO_LIST;
    }
    let radius = plant.size * kind.leaf.w;
    if view == 0u {
        if !is_in_sight(plant.place - frame.eye.xyz, radius) {
            return NO_LIST;
        }
    } else {
        let cascade = i32(view) - 1;
        let square = frame.cascades[cascade];
        let aside = abs(in_cascade(plant.place, cascade).xy) * square.zw;
        if any(aside > square.zw + radius) || plant.size < texel_of(cascade) {
            return NO_LIST;
        }
    }
    let detail = detail_of(pixels_of(view, plant));
    if detail >= f32(PLANT_LEVELS) {
        return NO_LIST;
    }
    return 2u * u32(detail) + select(0u, 1u, fract(detail) > 0.0);
}

@compute @workgroup_size(256)
fn count_plants(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) all: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let view = drawn_view(group.y);
    let list = list_of(view, group.x * GROUP + local);
    if list < LISTS {
        atomicAdd(&tally[list], 1u);
    }
    workgroupBarrier();
    if local < LISTS {
        counts[(view * all.x + group.x) * LISTS + local] = atomicLoad(&tally[local]);
    }
}

@compute @workgroup_size(16)
fn line_up(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) list: u32) {
    let view = drawn_view(group.x);
    let groups = arrayLength(&counts) / (VIEWS * LISTS);
    if list < LISTS {
        var sum = 0u;
        for (var before = 0u; before < groups; before++) {
            let at = (view * groups + before) * LISTS + list;
            let here = counts[at];
            counts[at] = sum;
            sum += here;
        }
        totals[list] = sum;
        draws[view * LISTS + list].instances = sum;
    }
    workgroupBarrier();
    if list == 0u {
        var all = 0u;
        for (var each = 0u; each < LISTS; each++) {
            all += totals[each];
        }
        starts[VIEWS * LISTS + view] = all;
    }
    if list < LISTS {
        var start = 0u;
        for (var before = 0u; before < list; before++) {
            start += totals[before];
        }
        starts[view * LISTS + list] = start;
    }
}

@compute @workgroup_size(256)
fn place_plants(
    @builtin(workgroup_id) group: vec3<u32>,
    @builtin(num_workgroups) all: vec3<u32>,
    @builtin(local_invocation_index) local: u32,
) {
    let view = drawn_view(group.y);
    let number = group.x * GROUP + local;
    let list = list_of(view, number);
    lists[local] = list;
    workgroupBarrier();
    if list == NO_LIST {
        return;
    }
    var rank = 0u;
    for (var before = 0u; before < local; before++) {
        rank += select(0u, 1u, lists[before] == list);
    }
    let first = starts[view * LISTS + list] + counts[(view * all.x + group.x) * LISTS + list];
    let place = view * arrayLength(&plants) + first + rank;
    kept[place] = number;
    let record = packed_seen(seen_plant(view, plants[number]));
    let texel = texel_of_record(place);
    textureStore(seen, texel, record.first);
    textureStore(seen, texel + vec2<u32>(1u, 0u), record.second);
}
