// Plants stand on the ground as it is now.

@group(2) @binding(0) var<uniform> kind: Kind;
@group(2) @binding(1) var<storage, read_write> plants: array<PlacedPlant>;

// Distance in metres by which roots reach into the ground, beside the height of the plant, as `batch.rs` has it.
const ROOTED = 0.01;

@compute @workgroup_size(256)
fn stand(@builtin(global_invocation_id) at: vec3<u32>) {
    if at.x >= arrayLength(&plants) {
        return;
    }
    let plant = plants[at.x];
    plants[at.x].place.z = spline_at(bed, place_of(plant.place)) - ROOTED * plant.size;
}
