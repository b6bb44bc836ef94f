// Records of two texels each. Each shader writes them by itself: a function can be given no texture that is written.

// Records beside each other in a row of the texture.
const RECORDS_ACROSS = 4096u;

struct Record {
    first: vec4<u32>,
    second: vec4<u32>,
}

// Where the first texel of a record is; the second is beside it.
fn texel_of_record(number: u32) -> vec2<u32> {
    return vec2<u32>(2u * (number % RECORDS_ACROSS), number / RECORDS_ACROSS);
}

fn record_at(records: texture_2d<u32>, number: u32) -> Record {
    let texel = texel_of_record(number);
    return Record(textureLoad(records, texel, 0), textureLoad(records, texel + vec2<u32>(1u, 0u), 0));
}
