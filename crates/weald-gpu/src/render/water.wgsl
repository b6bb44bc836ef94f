// Water where the ground is looked at: how it ripples, flows and foams, what it mirrors, and what comes out of it.

// Seconds for which ripples are carried along before they are taken back: by Vlachos 2010, "Water flow in Portal 2",
// two of them half a turn apart, each unseen when it is taken back.
const CARRIED = 2.6;

// Metres of height lost in a second between which water foams.
const FOAMS = vec2<f32>(0.5, 4.0);

// Octaves of ripples below those that the ray-marched view has, for close by.
const FINER = 6u;

// Looks along a mirrored ray, and how much further each is.
const MARCH_STEPS = 44;
const FURTHER = 1.17;

// Radians by which ripples that are too small to be seen throw rays apart.
const MIRRORED_SPREAD = 0.08;

// The power of the length to which a slant look draws out a pixel on water that counts as its footprint, for ripples and foam: with
// a half, the mean of length and width, ripples of lakes at a distance are streaks one row of pixels high.
const LENGTHENED = 0.75;

// Metres over which ripples draw out what water mirrors, for each metre that it is away.
const DRAWN_OUT = 0.02;

// How far two sets of ripples are carried, and the share of the second.
struct Carried {
    phases: vec2<f32>,
    share: f32,
}

fn carried(point: vec2<f32>) -> Carried {
    // Places are not in step with each other, or all ripples would be taken back at once.
    let place = octaves_at(Octaves(60.0, 2u, 0.5, 0x53u), point, 0.0).value;
    let phase = frame.moment.x / CARRIED + 2.0 * place;
    let phases = fract(vec2<f32>(phase, phase + 0.5));
    return Carried(CARRIED * phases, abs(2.0 * phases.x - 1.0));
}

// Slopes of ripples at a point that came from upstream: of the broad ones, and of all.
fn ripple_slopes(point: vec2<f32>, wave: f32, footprint: f32, seed: u32) -> vec4<f32> {
    let broad = octaves_at(Octaves(wave, 3u, 0.55, 0x52u + seed), point, footprint).slope;
    let finer = octaves_at(Octaves(wave * 0.125, FINER, 0.43, 0x54u + seed), point, footprint).slope;
    return vec4<f32>(broad, broad + 0.09 * finer);
}

// Normals of water: without the finest ripples, which would tear the picture of a shore to shreds, and with them.
struct Ripples {
    broad: vec3<f32>,
    all: vec3<f32>,
}

// The normals of water whose surface is tilted and flows with a velocity.
fn flowing(point: vec2<f32>, tilt: vec3<f32>, footprint: f32, velocity: vec2<f32>) -> Ripples {
    let wave = min(0.25 * scene.scale.w, 6.0);
    let calm = octaves_at(Octaves(30.0 * wave, 2u, 0.5, 0x51u), point, 0.0).value;
    let along = carried(point);
    // Level water has ripples of the wind, which drift slowly.
    let drift = velocity + vec2<f32>(0.25, 0.12);
    let first = ripple_slopes(point - drift * along.phases.x, wave, footprint, 0u);
    let second = ripple_slopes(point - drift * along.phases.y, wave, footprint, 16u);
    let strength = 0.035 * wave * (1.0 + 0.9 * calm) * (1.0 + 0.35 * length(velocity));
    let evenness = inverseSqrt(along.share * along.share + (1.0 - along.share) * (1.0 - along.share));
    let slopes = strength * evenness * mix(first, second, along.share);
    let level = tilt.xy / tilt.z;
    return Ripples(
        normalize(vec3<f32>(level - 0.5 * slopes.xy, 1.0)), normalize(vec3<f32>(level - slopes.zw, 1.0)),
    );
}

// Share of foam on water of a velocity that loses so much height in a second.
fn foam_share(point: vec2<f32>, footprint: f32, velocity: vec2<f32>, lost: f32) -> f32 {
    let fast = clamp((lost - FOAMS.x) / (FOAMS.y - FOAMS.x), 0.0, 1.0);
    if fast <= 0.0 {
        return 0.0;
    }
    let along = carried(point);
    var bubbles = vec2<f32>(0.0);
    var turn = 0;
    loop {
        let here = point - velocity * along.phases[turn];
        let seed = u32(turn) * 16u;
        let clumps = octaves_at(Octaves(3.0, 6u, 0.62, 0x57u + seed), here, footprint).value;
        bubbles[turn] = clumps;
        turn++;
        if turn >= 2 {
            break;
        }
    }
    let texture = mix(bubbles.x, bubbles.y, along.share);
    return clamp((2.2 * texture + 1.1 * fast - 0.55) * 1.1, 0.0, 1.0) * (0.25 + 0.5 * fast);
}

// Height of the ground, or of the water on it, linear between control points: near enough for a look.
fn rough_height(place: vec2<f32>) -> f32 {
    let at = clamp(place, vec2<f32>(0.5), scene.grid.xy + 0.5) + 1.0;
    let corner = floor(at);
    let t = at - corner;
    let first = vec2<i32>(corner);
    let above = mix(textureLoad(top, first, 0).x, textureLoad(top, first + vec2<i32>(1, 0), 0).x, t.x);
    let below = mix(
        textureLoad(top, first + vec2<i32>(0, 1), 0).x, textureLoad(top, first + vec2<i32>(1, 1), 0).x, t.x,
    );
    return mix(above, below, t.y);
}

// How far along a ray the landscape begins, for a ray that starts beyond its border; 0 within.
fn length_to_border(start: vec3<f32>, direction: vec3<f32>) -> f32 {
    let place = place_of(start);
    let step = direction.xy * vec2<f32>(1.0, -1.0) / scene.grid.zw;
    let slow = select(step, vec2<f32>(1e-12), abs(step) < vec2<f32>(1e-12));
    let low = (vec2<f32>(0.5) - place) / slow;
    let high = (scene.grid.xy + 0.5 - place) / slow;
    let enter = min(low, high);
    return max(max(enter.x, enter.y), 0.0);
}

// The land that a ray meets or just misses: how far along it that lies, and the share of the rays around this one that meet it.
struct MirroredLand {
    ray_length: f32,
    share: f32,
}

// The share of rays around one at a point of it that meet the land below: all where that hides it, and those of them that
// ripples throw so low where it is nearly hidden. What is no higher than the water itself hides nothing.
fn share_below(start: vec3<f32>, point: vec3<f32>, ray_length: f32) -> f32 {
    let height = rough_height(place_of(point));
    let spread = MIRRORED_SPREAD * ray_length;
    let above_water = clamp((height - start.z) / spread, 0.0, 1.0);
    return clamp(1.0 - (point.z - height) / spread, 0.0, 1.0) * above_water;
}

// The land along a ray.
fn land_along(start: vec3<f32>, direction: vec3<f32>) -> MirroredLand {
    var before = 0.5 * scene.scale.w;
    if HORIZON {
        before = max(before, length_to_border(start, direction) + 0.01 * scene.scale.w);
    }
    var ray_length = before;
    var nearest = MirroredLand(before, 0.0);
    var is_met = false;
    var look = 0;
    loop {
        let point = start + direction * ray_length;
        let place = place_of(point);
        let is_outside = any(place < vec2<f32>(0.5)) || any(place > scene.grid.xy + 0.5);
        let is_past = is_outside || point.z > scene.scale.z + MIRRORED_SPREAD * ray_length;
        is_met = !is_past && point.z < rough_height(place);
        let goes_on = !is_past && !is_met;
        if goes_on {
            let share = share_below(start, point, ray_length);
            if share > nearest.share {
                nearest = MirroredLand(ray_length, share);
            }
            before = ray_length;
            ray_length = ray_length * FURTHER + 0.25 * scene.scale.w;
        }
        look++;
        if !goes_on || look >= MARCH_STEPS {
            break;
        }
    }
    if !is_met {
        return nearest;
    }
    var halving = 0;
    loop {
        let middle = 0.5 * (before + ray_length);
        let here = start + direction * middle;
        if here.z < rough_height(place_of(here)) {
            ray_length = middle;
        } else {
            before = middle;
        }
        halving++;
        if halving >= 5 {
            break;
        }
    }
    return MirroredLand(ray_length, 1.0);
}

// Shares of light that water mirrors between which land is looked for along the mirrored ray: below, as much of it is mirrored
// as hides the sky there.
const MARCHED = vec2<f32>(0.12, 0.24);

// The light that water mirrors where it mirrors such a share.
fn reflected_light(point: vec3<f32>, look: Look, ripples: Ripples, share: f32, seen: Seen) -> vec3<f32> {
    let upward = mirrored(look.direction, ripples.all, look.tilt);
    let open = clamp(seen.even.z / PI, 0.0, 1.0);
    let sky = mirrored_sky(point, upward);
    let rough = mix(scene.bounce.xyz, sky, open);
    let sharp = ramp(share, MARCHED.x, MARCHED.y);
    var light = rough;
    if sharp > 0.0 {
        let broad = mirrored(look.direction, ripples.broad, look.tilt);
        light = mix(rough, mirrored_light(point, broad, sky, look.ray_length), sharp);
    }
    return light;
}

// The sky that water mirrors, blurred by ripples that are too small to be seen.
fn mirrored_sky(start: vec3<f32>, upward: vec3<f32>) -> vec3<f32> {
    let sky = rippled_upward(upward);
    let clouds = clouds_mirrored(start, sky);
    return clouds.xyz + clouds.w * sky_radiance(sky);
}

// The light that water mirrors: land with its own colours in a direction, or the light of the sky.
fn mirrored_light(start: vec3<f32>, direction: vec3<f32>, sky: vec3<f32>, length_before: f32) -> vec3<f32> {
    let land = land_along(start, direction);
    if land.share <= 0.0 {
        return sky;
    }
    let point = start + direction * land.ray_length;
    let place = place_of(point);
    let surface = spline_with_slope(bed, place);
    let normal = normal_of(surface.yz);
    let sharp = max(0.25 * scene.scale.w, (land.ray_length + length_before) * frame.eye.w);
    let footprint = max(sharp, DRAWN_OUT * land.ray_length);
    sight = -direction / vec3<f32>(1.0, 1.0, scene.scale.y);
    let skin = ground_skin(place, surface, footprint, 1e9);
    let sun = sun_seen(point + normal * 0.1 * scene.scale.w, normal);
    let rough = roughened(normal, skin.bump);
    let radiance = skin.albedo * (sunlight_on_facet(normal, rough, sun) + skylight_on(seen_at(skylight, share_of(place)), rough)) / PI;
    return mix(sky, veil(radiance, start, direction, land.ray_length), land.share);
}

// Share of foam that waves leave at the edge of a lake or the sea.
fn shore_foam(point: vec3<f32>, look: Look) -> f32 {
    if look.above >= 0.0 {
        return 0.0;
    }
    let slope = length(look.normal.xy) / max(look.normal.z, 1e-3);
    let away = -look.above / max(slope, 0.02);
    return breaking(slope) * swash(point.xy, away, swash_width(look.surface.x - look.above), frame.moment.x, look.footprint);
}

// The direction in which water throws a ray: none into itself.
fn mirrored(direction: vec3<f32>, normal: vec3<f32>, tilt: vec3<f32>) -> vec3<f32> {
    let away = reflect(direction, normal);
    return normalize(away + tilt * max(0.02 - dot(away, tilt), 0.0));
}

// The light of water of a depth at a place.
fn water_radiance(point: vec3<f32>, depth: f32, look: Look) -> vec3<f32> {
    let direction = look.direction;
    let back = -direction;
    let sun = look.sun;
    let running = look.running;
    let footprint = look.ray_length * frame.eye.w / pow(max(back.z, 0.05), LENGTHENED);
    let tilt = look.tilt;
    let ripples = flowing(point.xy, tilt, footprint, running.xy);
    let normal = ripples.all;
    let seen = seen_at(skylight, share_of(look.place));
    let share = mirrored_share(dot(back, normal));
    let reflection = reflected_light(point, look, ripples, share, seen);
    let up = vec3<f32>(0.0, 0.0, 1.0);
    let light = scene.sunlight.xyz * (sun * scene.sun.z) + skylight_on(seen, up);
    let turbid = select(turbidity(1e30), turbidity(look.surface.x - look.above), look.above < 0.0);
    let below = water_body(bed_albedo(point.xy, depth, look.footprint), depth, turbid, light);
    let surface = mix(below, reflection, share) + scene.sunlight.xyz * (sun * glint(back, normal, scene.sun.xyz));
    let foam = max(foam_share(point.xy, footprint, running.xy, running.z), shore_foam(point, look));
    return mix(surface, scene.weed.w * light / PI, foam);
}
