// Which sets of grass are drawn, in three lists of the order of the sets, whatever the order in which threads run: each
// workgroup counts its sets of each list (`mark`), a running sum over all groups and lists says where each begins (`sum`),
// and each set is put there (`gather`). The lists lie one behind the other.
//
// Blelloch 1990, "Prefix sums and their applications"; within a workgroup by Hillis and Steele 1986.

// What an indirect draw wants.
struct Draw {
    vertices: u32,
    instances: u32,
    first_vertex: u32,
    first_instance: u32,
}

@group(2) @binding(0) var<uniform> grasses: Grasses;
@group(2) @binding(2) var<storage, read> sets: array<vec4<u32>>;
@group(2) @binding(3) var<storage, read_write> kept: array<u32>;
// What each group counted of each list; then where that begins; one more with the end of all.
@group(2) @binding(4) var<storage, read_write> starts: array<u32>;
// The draws of all lists, and the dispatch of what lights the sets in them.
@group(2) @binding(5) var<storage, read_write> draws: array<Draw, LISTS + 1u>;
// For each set its list, times the sets of a workgroup, and its place among those of its workgroup and list.
@group(2) @binding(6) var<storage, read_write> marks: array<u32>;

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

@compute @workgroup_size(GROUP)
fn mark(@builtin(workgroup_id) group: vec3<u32>, @builtin(local_invocation_index) thread: u32) {
    let count = arrayLength(&sets);
    let number = group.x * GROUP + thread;
    var chosen = LISTS;
    if number < count {
        let instance = unpack(sets[number]);
        // A loop of one turn or none: software would look up all heights in a condition.
        let looks = select(0u, 1u, may_be_drawn(instance.tuft, instance.place));
        for (var look = 0u; look < looks; look++) {
            chosen = list_of(instance.tuft, grass_root(instance.place));
        }
    }
    // The counts of three lists at once, ten bits each: none exceeds the 256 sets of a workgroup.
    let one = select(0u, 1u << (10u * chosen), chosen < LISTS);
    let upto = summed(thread, one);
    if number < count {
        let before = ((upto - one) >> (10u * min(chosen, 2u))) & 1023u;
        marks[number] = chosen * GROUP + min(before, GROUP - 1u);
    }
    if thread == GROUP - 1u {
        for (var each = 0u; each < LISTS; each++) {
            starts[place_of_count(each, group.x, count)] = (upto >> (10u * each)) & 1023u;
        }
    }
}

// One workgroup, of which each thread sums a stretch.
@compute @workgroup_size(GROUP)
fn sum(@builtin(local_invocation_index) thread: u32) {
    let count = arrayLength(&sets);
    let all = place_of_count(LISTS, 0u, count);
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
        draws[LISTS] = Draw((upto + GROUP - 1u) / GROUP, 1u, 1u, 0u);
    }
    storageBarrier();
    if thread < LISTS {
        let begin = starts[place_of_count(thread, 0u, count)];
        let end = starts[place_of_count(thread + 1u, 0u, count)];
        draws[thread] = Draw(2u * choice.rows[thread], (end - begin) * BLADES, 0u, 0u);
    }
}

@compute @workgroup_size(GROUP)
fn gather(@builtin(global_invocation_id) at: vec3<u32>) {
    let count = arrayLength(&sets);
    if at.x >= count {
        return;
    }
    let chosen = marks[at.x] / GROUP;
    if chosen < LISTS {
        let begin = starts[place_of_count(chosen, at.x / GROUP, count)];
        kept[begin + marks[at.x] % GROUP] = at.x;
    }
}
