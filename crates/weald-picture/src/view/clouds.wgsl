// Twin of `clouds.rs`: heaps of cloud over one level, and their shadows. Where there are none, `CLOUDS` leaves all of it out.

const CLOUDS_APART = 2600.0;
const CLOUDS_SLICES = 16;
const CLOUDS_SLICE = 32.0;
const CLOUDS_NARROWER = 0.36;
const CLOUDS_COARSE = 1.8;
const CLOUDS_EDGE = 0.2;
const CLOUDS_SOFTER = 5.0;
const CLOUDS_SIDE = 0.12;
const CLOUDS_LIT = 420.0;
const CLOUDS_LOST = 28000.0;
const CLOUDS_SHADOW = 0.78;
const CLOUDS_SOFT = 160.0;

// How far a place is within a heap, as noise above what makes cloud there; for a share of its height.
fn within_cloud(at: vec2<f32>, share: f32, footprint: f32) -> Grain {
    var noise = octaves_at(Octaves(CLOUDS_APART, 7u, 0.56, 0x71u), at, footprint);
    noise.value -= 0.44 - 0.95 * scene.clouds.w + CLOUDS_NARROWER * share * share;
    return noise;
}

// Where a ray meets a heap: the slice, how far it is within there, and how much of it lies along the ray.
struct MetCloud {
    slice: f32,
    within: f32,
    passed: f32,
}

fn met_cloud(start: vec3<f32>, direction: vec3<f32>) -> MetCloud {
    var met = MetCloud(0.0, 0.0, 0.0);
    var before = -1.0;
    let spacing = CLOUDS_SLICE * scene.scale.y / direction.z;
    let first = (scene.cloud_height.x - start.z) / direction.z;
    for (var slice = 0; slice < CLOUDS_SLICES; slice++) {
        let reach = first + f32(slice) * spacing;
        let at = start.xy + direction.xy * reach;
        let here = within_cloud(at, f32(slice) / f32(CLOUDS_SLICES - 1), CLOUDS_COARSE * spacing);
        let side = max(here.value + CLOUDS_SIDE, 0.0);
        if met.passed == 0.0 && side > 0.0 {
            let back = select(side / (here.value - before), 0.0, slice == 0);
            met = MetCloud(f32(slice) - back, select(-CLOUDS_SIDE, here.value, slice == 0), 0.0);
        }
        met.passed += side * side;
        before = here.value;
    }
    return met;
}

// The radiance of the sky in a direction, with the clouds before it; `blur` is the angle in radians that is seen as one.
fn with_clouds(start: vec3<f32>, direction: vec3<f32>, radiance: vec3<f32>, blur: f32) -> vec3<f32> {
    if !CLOUDS || direction.z < 0.01 || start.z >= scene.cloud_height.x {
        return radiance;
    }
    let met = met_cloud(start, direction);
    if met.passed == 0.0 {
        return radiance;
    }
    let share = met.slice / f32(CLOUDS_SLICES - 1);
    let spacing = CLOUDS_SLICE * scene.scale.y / direction.z;
    let reach = (scene.cloud_height.x - start.z) / direction.z + met.slice * spacing;
    let footprint = blur * reach * inverseSqrt(direction.z);
    let at = start.xy + direction.xy * reach;
    let fine = within_cloud(at, share, footprint).value - met.within;
    let slope = within_cloud(at, share, CLOUDS_COARSE * spacing).slope;
    let edge = CLOUDS_EDGE + CLOUDS_SOFTER * blur;
    let density = smoothstep(0.0, edge, sqrt(met.passed) - CLOUDS_SIDE + 0.4 * fine);
    let sunward = CLOUDS_LIT * scene.sun.xy / max(scene.sun.z, 0.3);
    let through = exp(-3.4 * max(met.within + 0.3 + dot(slope, sunward) - 0.7 * fine - 0.25 * share, 0.0));
    let glow = 0.3 * (1.0 - density) * pow(max(dot(direction, scene.sun.xyz), 0.0), 12.0);
    let lit = scene.sunlight.xyz * (0.03 + 0.24 * through + glow)
        + scene.clouds.xyz * ((0.45 + 0.5 * share) / PI);
    return mix(radiance, lit, density * exp(-reach / CLOUDS_LOST));
}

// Share of the sunlight that comes through them to a point.
fn through_clouds(point: vec3<f32>) -> f32 {
    if !CLOUDS {
        return 1.0;
    }
    let reach = max(scene.cloud_height.x - point.z, 0.0) / max(scene.sun.z, 0.05);
    let within = within_cloud(point.xy + scene.sun.xy * reach, 0.0, CLOUDS_SOFT).value;
    let density = smoothstep(0.0, 0.34, within);
    return select(1.0, 1.0 - CLOUDS_SHADOW * density, scene.clouds.w > 0.0);
}
