// Which sets of grass are drawn, in three lists of the order of the sets, whatever the order in which threads run: each
// thread counts the sets of each list in a run of them (`mark`), a running sum over all runs and lists says where each begins
// (`sum`), and each set is put there (`gather`). The lists lie one behind the other. Only the sum has barriers, which are
// slow in software.
//
// Blelloch 1990, "Prefix sums and their applications"; within a workgroup by Hillis and Steele 1986.

// What an indexed indirect draw wants.
struct Draw {
    indices: u32,
    instances: u32,
    first_index: u32,
    base_vertex: u32,
    first_instance: u32,
}

@group(2) @binding(0) var<uniform> grasses: Grasses;
@group(2) @binding(2) var<storage, read> sets: array<vec4<u32>>;
@group(2) @binding(3) var<storage, read_write> kept: array<u32>;
// What each run counted of each list; then where that begins; one more with the end of all.
@group(2) @binding(4) var<storage, read_write> starts: array<u32>;
// The draws of all lists, and the dispatch of what lights the sets in them.
@group(2) @binding(5) var<storage, read_write> draws: array<Draw, LISTS + 1u>;
// For each run the lists of its sets, two bits each: of a run of which none is drawn, all bits.
@group(2) @binding(6) var<storage, read_write> marks: array<u32>;
@group(2) @binding(7) var<storage, read> runs: array<RunBounds>;

// Marks of a run of which no set is drawn.
const NONE_DRAWN = 0xffffffffu;

var<workgroup> sums: array<u32, GROUP>;

// The sum of the values of this thread and of all before it.
fn summed(thread: u32, value: u32) -> u32 {
    var sum = value;
    for (var step = 1u; step < GROUP; step *= 2u) {
        sums[thread] = sum;
        workgroupBarrier();
        if thread >= step {
            sum += sums[thread - step];
        }
        workgroupBarrier();
    }
    return sum;
}

// The list of a set that may be drawn, as `list_of` has it, unless ground hides it.
fn chosen_list(instance: Instance) -> u32 {
    let root = grass_root(instance.place);
    var chosen = list_of(instance, root);
    let searches = looks_for_ground(chosen);
    var look = 0u;
    loop {
        chosen = select(chosen, LISTS, searches > 0u && is_below_ground(look, instance.species, root));
        look++;
        if look >= searches || chosen == LISTS {
            break;
        }
    }
    return chosen;
}

@compute @workgroup_size(GROUP)
fn mark(@builtin(global_invocation_id) at: vec3<u32>) {
    let count = arrayLength(&sets);
    let first = at.x * RUN;
    if first >= count {
        return;
    }
    var lists = NONE_DRAWN;
    // Five bits for each list.
    var counts = 0u;
    let may_be = may_any_be_drawn(runs[at.x]);
    let end = min(first + RUN, count);
    var number = first;
    loop {
        var instance: Instance;
        var is_wanted = false;
        // On to the next set that may be drawn, whose ground is looked up then: software would look it up for all.
        loop {
            instance = unpack(sets[number]);
            is_wanted = may_be && may_be_drawn(instance);
            if is_wanted || !may_be || number + 1u >= end {
                break;
            }
            number++;
        }
        if is_wanted {
            let chosen = chosen_list(instance);
            // From the two bits of none to those of the list.
            lists ^= (LISTS ^ chosen) << (2u * (number - first));
            counts += select(0u, 1u << (5u * chosen), chosen < LISTS);
        }
        number++;
        if number >= end || !may_be {
            break;
        }
    }
    marks[at.x] = lists;
    for (var each = 0u; each < LISTS; each++) {
        starts[place_of_run(each, at.x, count)] = (counts >> (5u * each)) & 31u;
    }
}

// Corners of the triangles of an instance, as `blades.rs` has them.
fn corners_of(list: u32) -> u32 {
    return SETS_PER_INSTANCE * BLADES * 3u * (max(2u * choice.rows[list], 3u) - 3u);
}

// One workgroup, of which each thread sums a stretch.
@compute @workgroup_size(GROUP)
fn sum(@builtin(local_invocation_index) thread: u32) {
    let count = arrayLength(&sets);
    let all = place_of_run(LISTS, 0u, count);
    let stretch = (all + GROUP - 1u) / GROUP;
    let first = min(thread * stretch, all);
    let end = min(first + stretch, all);
    var own = 0u;
    for (var at = first; at < end; at++) {
        own += starts[at];
    }
    let upto = summed(thread, own);
    var begin = upto - own;
    for (var at = first; at < end; at++) {
        let counted = starts[at];
        starts[at] = begin;
        begin += counted;
    }
    if thread == GROUP - 1u {
        starts[all] = upto;
        draws[LISTS] = Draw((upto + GROUP - 1u) / GROUP, 1u, 1u, 0u, 0u);
    }
    storageBarrier();
    if thread < LISTS {
        let begin = starts[place_of_run(thread, 0u, count)];
        let end = starts[place_of_run(thread + 1u, 0u, count)];
        var first = 0u;
        for (var before = 0u; before < thread; before++) {
            first += corners_of(before);
        }
        draws[thread] = Draw(corners_of(thread), (end - begin + SETS_PER_INSTANCE - 1u) / SETS_PER_INSTANCE, first, 0u, 0u);
    }
}

@compute @workgroup_size(GROUP)
fn gather(@builtin(global_invocation_id) at: vec3<u32>) {
    let count = arrayLength(&sets);
    let first = at.x * RUN;
    if first >= count {
        return;
    }
    let lists = marks[at.x];
    var next = vec3<u32>(
        starts[place_of_run(0u, at.x, count)],
        starts[place_of_run(1u, at.x, count)],
        starts[place_of_run(2u, at.x, count)],
    );
    let end = select(min(first + RUN, count), first, lists == NONE_DRAWN);
    for (var number = first; number < end; number++) {
        let chosen = vec3<u32>((lists >> (2u * (number - first))) & 3u);
        let is_in = chosen == vec3<u32>(0u, 1u, 2u);
        if any(is_in) {
            kept[select(select(next.z, next.y, is_in.y), next.x, is_in.x)] = number;
        }
        next += select(vec3<u32>(0u), vec3<u32>(1u), is_in);
    }
}
