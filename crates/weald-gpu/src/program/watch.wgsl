// Finds the first value of a buffer that is a NaN or an infinity, by its bits: a compiler may assume that
// comparisons never see one.

struct DispatchRange {
    first: u32,
    end: u32,
    // Invocations of the dispatch.
    width: u32,
}

const EXPONENT: u32 = 0x7f800000u;

@group(0) @binding(0) var<uniform> range: DispatchRange;
@group(0) @binding(1) var<storage, read> bits: array<u32>;
@group(0) @binding(2) var<storage, read_write> found: atomic<u32>;

@compute @workgroup_size(256)
fn watch(@builtin(global_invocation_id) invocation: vec3<u32>) {
    for (var at = range.first + invocation.x; at < range.end; at += range.width) {
        if ((bits[at] & EXPONENT) == EXPONENT) {
            atomicMin(&found, at);
            return;
        }
    }
}
