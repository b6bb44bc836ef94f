// Twin of `veils.rs`: veils of ice high above heaps of cloud.

const VEILS_ABOVE = 6000.0;
const VEILS = 3200.0;
const VEILS_LONG = 6.0;
const VEIL_OCTAVES = 7u;
const VEIL_GAIN = 0.68;
const VEILED = vec2<f32>(0.02, 0.75);
const VEILS_HIDE = 0.26;
const VEILS_SEND = 0.2;
const VEILS_LOST = 60000.0;
const VEIL_WIND = vec2<f32>(0.8, 0.6);
const VEILS_BENT = 0.4;

// The light of veils of ice in a direction above the horizon, and the share of the sky that is seen through them.
fn veils_before(start: vec3<f32>, direction: vec3<f32>, blur: f32) -> vec4<f32> {
    let reach = (scene.cloud_height.x + VEILS_ABOVE - start.z) / direction.z;
    let at = start.xy + direction.xy * reach;
    let along = dot(VEIL_WIND, at) / VEILS_LONG;
    let straight = VEIL_WIND.y * at.x - VEIL_WIND.x * at.y;
    let footprint = blur * reach / direction.z;
    let bent = octaves_at(Octaves(4.0 * VEILS, 2u, 0.5, 0x73u), vec2<f32>(along, straight), footprint).value;
    let across = straight + VEILS_BENT * VEILS * bent;
    let noise = octaves_at(Octaves(VEILS, VEIL_OCTAVES, VEIL_GAIN, 0x74u), vec2<f32>(along, across), footprint).value;
    let hidden = VEILS_HIDE * smoothstep(VEILED.x, VEILED.y, noise) * exp(-reach / VEILS_LOST);
    return vec4<f32>(hidden * (scene.sunlight.xyz * VEILS_SEND + scene.clouds.xyz / PI), 1.0 - hidden);
}
