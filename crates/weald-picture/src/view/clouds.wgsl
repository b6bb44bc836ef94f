// Twin of `clouds.rs`: heaps of cloud above the land, and their shadows. Where there are none, `CLOUDS` leaves all of it out.

const CLOUDS_APART = 2200.0;
const CLOUDS_BROAD = 2u;
const CLOUDS_GAIN = 0.55;
const CLOUDS_GROUPS = 9000.0;
const CLOUDS_GROUPED = 0.6;
const CLOUDS_THICK = 700.0;
const CLOUDS_SLICES = vec2<f32>(24.0, 72.0);
const CLOUDS_STEP = 55.0;
const CLOUDS_BLURRED = 0.02;
const CLOUDS_FINER = 4.0;
const CLOUDS_SIDE = vec2<f32>(0.1, 0.0008);
const CLOUDS_STEEPEST = 0.0019;
const CLOUDS_UNSEEN = 0.02;
const CLOUDS_NARROWER = 0.42;
const CLOUDS_ROUND = 0.24;
const CLOUDS_BROADEST = 0.14;
const CLOUDS_PUFFS = 800.0;
const CLOUDS_PUFF_OCTAVES = 7u;
const CLOUDS_PUFF_GAIN = 0.72;
const CLOUDS_PUFF_MEAN = 0.2;
const CLOUDS_NEAR = 0.45;
const CLOUDS_HELD = vec2<f32>(-0.16, 0.1);
const CLOUDS_PUFF_SEED = 0x77u;
const CLOUDS_FLATTER = vec2<f32>(-0.15, 0.25);
const CLOUDS_DENSE = 0.12;
const CLOUDS_GLOW = 0.05;
const CLOUDS_FLATTEST = vec2<f32>(0.01, 0.001);
const CLOUDS_SUNWARD = vec2<f32>(70.0, 260.0);
const CLOUDS_TAKEN = vec2<f32>(3.6, 3.2);
const CLOUDS_BASE = vec2<f32>(2.2, 0.4);
const CLOUDS_UNDER = 0.24;
const CLOUDS_SUNNY = 0.3;
const CLOUDS_THROUGH = 0.035;
const CLOUDS_LOST = 22000.0;
const CLOUDS_SHADOW = 0.78;
const CLOUDS_SOFT = 160.0;

// The noise by which heaps are narrower at a share of their height.
fn narrower_cloud(share: f32) -> f32 {
    let below = max(1.0 - share / CLOUDS_BROADEST, 0.0);
    return CLOUDS_NARROWER * share * share + CLOUDS_ROUND * below * below;
}

// How far a place is within a heap without its puffs, as noise above what makes cloud there, at a share of its height.
fn heap_of_cloud(at: vec2<f32>, share: f32, footprint: f32) -> f32 {
    let noise = octaves_at(Octaves(CLOUDS_APART, CLOUDS_BROAD, CLOUDS_GAIN, 0x71u), at, footprint);
    let groups = octaves_at(Octaves(CLOUDS_GROUPS, 1u, 1.0, 0x72u), at, footprint);
    return noise.value + CLOUDS_GROUPED * groups.value - (0.44 - 0.95 * scene.clouds.w + narrower_cloud(share));
}

// Puffs at a point, round outward and sharp inward: folded noise about its mean.
fn cloud_puff(point: vec3<f32>, footprint: f32) -> f32 {
    var sum = 0.0;
    var strength = 1.0;
    var wavelength = CLOUDS_PUFFS;
    var place = point;
    var seen = grain_visible(footprint, wavelength);
    if seen <= 0.0 {
        return sum;
    }
    var octave = 0u;
    loop {
        let here = solid_grain(place / wavelength, CLOUDS_PUFF_SEED + octave * 0x9e3779b9u);
        sum += seen * (abs(here.value) - CLOUDS_PUFF_MEAN);
        place = vec3<f32>(0.8 * place.x + 0.6 * place.y, 0.8 * place.y - 0.6 * place.x, place.z);
        strength *= CLOUDS_PUFF_GAIN;
        wavelength *= 0.5;
        seen = strength * grain_visible(footprint, wavelength);
        octave++;
        if octave >= CLOUDS_PUFF_OCTAVES || seen <= 0.0 {
            break;
        }
    }
    return sum;
}

// How far a point is within a heap, with its puffs.
fn within_cloud(point: vec3<f32>, footprint: f32) -> f32 {
    let up = (point.z - scene.cloud_height.x) / scene.scale.y;
    let share = up / CLOUDS_THICK;
    let heap = heap_of_cloud(point.xy, max(share, 0.0), footprint);
    let aside = abs(heap);
    if aside > CLOUDS_NEAR {
        return heap;
    }
    // Bases are flatter, and sides fade where they end.
    let puffs = smoothstep(CLOUDS_FLATTER.x, CLOUDS_FLATTER.y, share) * (1.0 - smoothstep(0.5 * CLOUDS_NEAR, CLOUDS_NEAR, aside));
    let puff = cloud_puff(vec3<f32>(point.xy, up), footprint);
    // Far outside a heap they would be crumbs that float alone.
    let held = select(1.0, smoothstep(CLOUDS_HELD.x, CLOUDS_HELD.y, heap), puff > 0.0);
    return heap + puffs * held * puff;
}

// Metres along a ray from which on it is in the layer, and for how many: none where it does not come there.
fn cloud_stretch(start: vec3<f32>, rising: f32) -> vec2<f32> {
    let bottom = scene.cloud_height.x - start.z;
    let top = bottom + CLOUDS_THICK * scene.scale.y;
    let flattest = select(CLOUDS_FLATTEST.y, CLOUDS_FLATTEST.x, bottom >= 0.0);
    // Without short circuits: a branch on numbers that all pixels share has software copy the shader, as `is_above` says.
    let is_inside = (bottom < 0.0) & (top > 0.0);
    let rise = select(max(rising, CLOUDS_FLATTEST.y), min(rising, -CLOUDS_FLATTEST.y), rising < 0.0);
    let ends = select(vec2<f32>(bottom, top), vec2<f32>(top, bottom), rise < 0.0) / rise;
    let first = max(ends.x, 0.0);
    let length = min(ends.y - first, CLOUDS_THICK * scene.scale.y / CLOUDS_FLATTEST.x);
    return vec2<f32>(first, select(0.0, length, is_inside | (abs(rising) >= flattest)));
}

// How many levels a ray is looked at that is in the layer from so many metres on, for so many, and metres from one to the next,
// where such an angle is seen as one.
fn cloud_levels(stretch: vec2<f32>, blur: f32) -> vec2<f32> {
    let most = CLOUDS_SLICES.x + CLOUDS_SLICES.y * max(1.0 - blur / CLOUDS_BLURRED, 0.0) * exp(-stretch.x / CLOUDS_LOST);
    let count = clamp(stretch.y / CLOUDS_STEP, CLOUDS_SLICES.x, most);
    return vec2<f32>(count, stretch.y / (count - 1.0));
}

// What so many metres of the way to the sun take of its light.
fn cloud_taken(at: vec3<f32>, footprint: f32, sunward: f32, taken: f32) -> f32 {
    let there = at + scene.sun.xyz * sunward;
    return taken * max(within_cloud(there, max(footprint, 0.3 * sunward)), 0.0);
}

// For a value that changes evenly from one level to the next: the mean of what it has above 0, and how far before the second level
// the middle of that part lies, as a share of their distance.
fn inside_cloud(before: f32, here: f32) -> vec2<f32> {
    if before > 0.0 && here > 0.0 {
        return vec2<f32>(0.5 * (before + here), 0.5);
    }
    let most = max(max(before, here), 0.0);
    let share = most / max(abs(before - here), 1e-6);
    return vec2<f32>(0.5 * share * most, select(1.0 - 0.5 * share, 0.5 * share, here > 0.0));
}

// The light that a point of a heap sends along a direction.
fn lit_cloud(at: vec3<f32>, direction: vec3<f32>, footprint: f32) -> vec3<f32> {
    let level = clamp((at.z - scene.cloud_height.x) / (CLOUDS_THICK * scene.scale.y), 0.0, 1.0);
    let under = smoothstep(0.0, CLOUDS_UNDER, heap_of_cloud(at.xy, CLOUDS_BROADEST, footprint));
    let taken = cloud_taken(at, footprint, CLOUDS_SUNWARD.x, CLOUDS_TAKEN.x)
        + cloud_taken(at, footprint, CLOUDS_SUNWARD.y, CLOUDS_TAKEN.y)
        + CLOUDS_BASE.x * under * (1.0 - smoothstep(0.0, CLOUDS_BASE.y, level));
    let glow = CLOUDS_GLOW * pow(max(dot(direction, scene.sun.xyz), 0.0), 12.0);
    return scene.sunlight.xyz * (CLOUDS_THROUGH + CLOUDS_SUNNY * exp(-taken) + glow)
        + scene.clouds.xyz * ((0.45 + 0.5 * level) / PI);
}

// The light of a point of a heap as it arrives at the start of a ray, and how much of it is seen there.
fn pale_cloud(light: vec3<f32>, start: vec3<f32>, direction: vec3<f32>, reach: f32) -> vec4<f32> {
    let above = clamp((start.z - scene.cloud_height.x) / (CLOUDS_THICK * scene.scale.y), 0.0, 1.0);
    var veiled = light;
    if is_above(above, 0.0, reach) {
        veiled = mix(light, veil(light, start, direction, reach), above);
    }
    return vec4<f32>(veiled, exp((above - 1.0) * reach / CLOUDS_LOST));
}

// The light that clouds send along a ray, and the share of what is behind them that is seen; `blur` is the angle in radians that
// is seen as one.
fn clouds_before(start: vec3<f32>, direction: vec3<f32>, blur: f32) -> vec4<f32> {
    var clouds = vec4<f32>(0.0, 0.0, 0.0, 1.0);
    let stretch = cloud_stretch(start, direction.z);
    if !CLOUDS || stretch.y <= 0.0 {
        return clouds;
    }
    var left = 1.0;
    let levels = cloud_levels(stretch, blur);
    if levels.x < 1.0 {
        return clouds;
    }
    let side = min(max(CLOUDS_SIDE.x, CLOUDS_SIDE.y * levels.y), CLOUDS_NEAR);
    var slice = 0.0;
    var before = 0.0;
    var finer = 1.0;
    loop {
        var reach = 0.0;
        var footprint = 0.0;
        var middle = 0.0;
        var hidden = 0.0;
        // On to the next level at which something is hidden, which is lit then: software would light all levels.
        loop {
            reach = stretch.x + slice * levels.y;
            let apart = levels.y / finer;
            footprint = max(apart, blur * reach);
            let here = within_cloud(start + direction * reach, footprint);
            if here > -side && finer < CLOUDS_FINER {
                // The side is looked for from the level before, in small steps.
                finer = CLOUDS_FINER;
                slice = max(slice - 1.0 + 1.0 / CLOUDS_FINER, 0.0);
            } else {
                // Of the metres since the level before, those within a heap: were all of them or none, levels would show as lines.
                let part = select(vec2<f32>(0.0), inside_cloud(before, here), slice > 0.0);
                hidden = left * (1.0 - exp(-CLOUDS_DENSE * apart * part.x));
                middle = part.y * apart;
                before = here;
                if here > -side || fract(slice) > 0.0 {
                    slice += 1.0 / finer;
                } else {
                    // Nothing is met over so many levels, whatever lies between.
                    finer = 1.0;
                    slice += 1.0 + floor(max(-CLOUDS_NEAR - here, 0.0) / (CLOUDS_STEEPEST * levels.y));
                }
            }
            if hidden > CLOUDS_UNSEEN / CLOUDS_FINER || slice > levels.x - 1.0 {
                break;
            }
        }
        if hidden > CLOUDS_UNSEEN / CLOUDS_FINER {
            let at = start + direction * (reach - middle);
            let light = pale_cloud(lit_cloud(at, direction, footprint), start, direction, reach);
            clouds += hidden * light.w * vec4<f32>(light.xyz, -1.0);
            left -= hidden;
        }
        if slice > levels.x - 1.0 || left <= CLOUDS_UNSEEN {
            break;
        }
    }
    return clouds;
}

// Share of the sunlight that comes through them to a point.
fn through_clouds(point: vec3<f32>) -> f32 {
    if !CLOUDS {
        return 1.0;
    }
    let reach = max(scene.cloud_height.x - point.z, 0.0) / max(scene.sun.z, 0.05);
    let within = heap_of_cloud(point.xy + scene.sun.xy * reach, CLOUDS_BROADEST, CLOUDS_SOFT);
    let density = smoothstep(0.0, 0.34, within);
    return select(1.0, 1.0 - CLOUDS_SHADOW * density, scene.clouds.w > 0.0);
}
