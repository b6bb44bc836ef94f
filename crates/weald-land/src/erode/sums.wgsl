
// What a simulation counts; the twin of sums.rs.

const RAINED: u32 = 0u;
const EVAPORATED: u32 = 1u;
const SHRUNK: u32 = 2u;
const WATER_OUT: u32 = 3u;
const SEDIMENT_OUT: u32 = 4u;
