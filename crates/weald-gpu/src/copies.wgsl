// Copies one buffer over another, as passes move what they read and write.

@group(0) @binding(0) var<storage, read> values: array<vec4<u32>>;
@group(0) @binding(1) var<storage, read_write> copied: array<vec4<u32>>;

@compute @workgroup_size(256)
fn copies(@builtin(global_invocation_id) invocation: vec3<u32>, @builtin(num_workgroups) groups: vec3<u32>) {
    for (var at = invocation.x; at < arrayLength(&values); at += groups.x * 256u) {
        copied[at] = values[at];
    }
}
