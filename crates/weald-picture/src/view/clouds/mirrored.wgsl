// Twin of `mirrored.rs`: clouds as rippled water mirrors them.

const CLOUDS_MIRRORED_BLUR = 0.12;
const CLOUDS_MIRRORED_SOFT = 0.25;
const CLOUDS_MIRRORED_DENSE = 0.02;
const CLOUDS_MIRRORED_SHARE = 0.165;
const CLOUDS_MIRRORED_TAKEN = 5.0;

// The light of clouds along a ray that rippled water mirrors, and the share of what is behind them that is seen: heaps without puffs, that are as high as their noise is above that of their
// sides.
fn clouds_mirrored(start: vec3<f32>, direction: vec3<f32>) -> vec4<f32> {
    let rise = direction.z;
    if !CLOUDS || rise < CLOUDS_FLATTEST.x || start.z >= scene.cloud_height.x {
        return vec4<f32>(0.0, 0.0, 0.0, 1.0);
    }
    let reach = (scene.cloud_height.x + CLOUDS_BROADEST * CLOUDS_THICK * scene.scale.y - start.z) / rise;
    let at = start + direction * reach;
    let heap = heap_of_cloud(at.xy, CLOUDS_BROADEST, CLOUDS_MIRRORED_BLUR * reach);
    let soft = max(heap + CLOUDS_MIRRORED_SOFT, 0.0);
    let within = max(heap, 0.25 / CLOUDS_MIRRORED_SOFT * soft * min(soft, 2.0 * CLOUDS_MIRRORED_SOFT));
    let top = min(sqrt(within / CLOUDS_NARROWER), 1.0);
    let noise = top * (within - CLOUDS_NARROWER * top * top / 3.0);
    let hidden = 1.0 - exp(-CLOUDS_MIRRORED_DENSE * CLOUDS_THICK * scene.scale.y / rise * noise);
    let through = exp(-CLOUDS_MIRRORED_TAKEN * within);
    let glow = CLOUDS_GLOW * pow(max(dot(direction, scene.sun.xyz), 0.0), 12.0);
    let light = scene.sunlight.xyz * (CLOUDS_THROUGH + CLOUDS_SUNNY * through + glow) + scene.clouds.xyz * (0.7 / PI);
    let shown = hidden * CLOUDS_MIRRORED_SHARE * exp(-reach / CLOUDS_LOST);
    return vec4<f32>(light * shown, 1.0 - shown);
}
