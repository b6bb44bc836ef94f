// The light of the ground, pixel by pixel, when all of its triangles are drawn: those are smaller than pixels, and each
// would be shaded in blocks of pixels. The depth of a pixel says where its point lies.
//
// What a pixel shows is one of a few kinds, which are written as depths of a canvas of their own (of pixels of one sample first as
// numbers); each kind of light is then drawn where a comparison of depths finds its kinds. A shader that branched would on software run all of its branches for all pixels.

// Kinds of ground, and of what is behind it, in the order in which ranges of them are drawn: each times `KIND` is a depth. Dry
// ground beyond the border has the first kind and the last: what is wet of each is found by one comparison of depths.
const FAR_BEYOND_DRY = 1u;
const FAR_BEYOND_WET = 2u;
const FAR_DRY = 9u;
const FAR_WET = 10u;
const NEAR_WET = 11u;
const NEAR_DRY = 12u;
const OPEN_SKY = 17u;
const PLAIN = 18u;
const NEAR_BEYOND_WET = 25u;
const NEAR_BEYOND_DRY = 26u;
const KIND = 0.03125;

// How much further the kinds are of samples that are not of the first surface of their pixel: those behind an edge.
const BEHIND_EDGE = 4u;

// Whether a pixel has several samples; the depths of the ground are bound as `ground_depths`.
override SAMPLED: bool = false;

// Whether what is drawn lies behind edges.
override IS_BEHIND: bool = false;

// Whether ground goes on beyond the border.
override HORIZON: bool = false;

// Whether grass grows somewhere.
override LAWN: bool = true;

// Samples of a pixel that lie so near to each other, as a share of their distance, are one surface.
const SAME_SURFACE = 0.02;

// Metres of water in which no bed is seen.
const OPEN_SEA = 1000.0;

// All of the picture, where its kind compares to that of the instance as the pipeline says.
@vertex
fn whole_vertex(
    @builtin(vertex_index) index: u32,
    @builtin(instance_index) kind: u32,
) -> @builtin(position) vec4<f32> {
    return vec4<f32>(vec2<f32>(f32(index & 1u), f32(index >> 1u)) * 4.0 - 1.0, f32(kind) * KIND, 1.0);
}

// What something else hides, and what canvases of kinds are cleared to.
const HIDDEN = 19u;

// Whether something hides a sample of the ground, or of what lies behind it.
fn is_hidden(position: vec2<f32>, sample: i32) -> bool {
    let pixel = vec2<i32>(position);
    return textureLoad(front_depths, pixel, sample) > textureLoad(ground_depths, pixel, sample);
}

// The kind of what is behind the ground at a place of the picture.
fn backdrop_at(position: vec2<f32>) -> u32 {
    return select(PLAIN, OPEN_SKY, along_at(position).z >= 0.0);
}

// What is seen through a pixel: the samples of its first surface or of those behind it, and the point in their middle.
struct SeenSurface {
    samples: u32,
    point: vec3<f32>,
}

fn surface_of(position: vec2<f32>, is_behind: bool) -> SeenSurface {
    let pixel = vec2<i32>(position);
    let count = select(1, 4, SAMPLED);
    var first = 0.0;
    var samples = 0u;
    var sum = 0.0;
    for (var sample = 0; sample < count; sample++) {
        let depth = textureLoad(ground_depths, pixel, sample);
        first = select(first, depth, first == 0.0);
        let is_first = abs(depth - first) <= SAME_SURFACE * first;
        if depth > 0.0 && is_first != is_behind {
            samples |= 1u << u32(sample);
            sum += depth;
        }
    }
    let mean = sum / max(f32(countOneBits(samples)), 1.0);
    return SeenSurface(samples, point_at(position, max(mean, 1e-20)));
}

// The kind of ground of a surface. Where a pixel has one sample, water beyond the border is found later (`wet_beyond_fragment`).
fn kind_of(surface: SeenSurface) -> u32 {
    let place = place_of(surface.point);
    let is_far = length(surface.point - frame.eye.xyz) * frame.eye.w >= DETAIL_FROM;
    let goes_on = HORIZON && is_beyond(place);
    var is_wet = !goes_on & (wet_share(place, spline_at(bed, place)) > 0.0);
    if SAMPLED && goes_on {
        is_wet = wet_share_beyond(place, ground_beyond(place)) > 0.0;
    }
    if goes_on {
        return select(select(NEAR_BEYOND_DRY, FAR_BEYOND_DRY, is_far), select(NEAR_BEYOND_WET, FAR_BEYOND_WET, is_far), is_wet);
    }
    return select(select(NEAR_DRY, FAR_DRY, is_far), select(NEAR_WET, FAR_WET, is_far), is_wet);
}

// The kind of what is seen at a place of the picture: of a surface, or of what is behind the ground where it has no samples.
fn kind_seen(position: vec2<f32>, surface: SeenSurface) -> u32 {
    var kind = backdrop_at(position);
    if surface.samples != 0u {
        kind = kind_of(surface);
    }
    return kind;
}

// The kind of a pixel of one sample, as a number of a canvas of colours: pixels that are lit are left by the test of depths before the
// shader runs; that of a shader which writes depths comes after it.
@fragment
fn kind_fragment(@builtin(position) position: vec4<f32>) -> @location(0) u32 {
    return select(kind_seen(position.xy, surface_of(position.xy, false)), HIDDEN, is_hidden(position.xy, 0));
}

@group(2) @binding(8) var kinds_by_number: texture_2d<u32>;

// The same as a depth.
@fragment
fn kind_depth_fragment(@builtin(position) position: vec4<f32>) -> @builtin(frag_depth) f32 {
    return f32(textureLoad(kinds_by_number, vec2<i32>(position.xy), 0).x) * KIND;
}

// Leaves of dry ground beyond the border, for which comparing depths selects, what is wet: of ground that lies there the height
// is dear, and software works it out for all pixels of a shader that has a branch for it.
@fragment
fn wet_beyond_fragment(@builtin(position) position: vec4<f32>) {
    let place = place_of(seen_point(position));
    if wet_share_beyond(place, ground_beyond(place)) <= 0.0 {
        discard;
    }
}

@fragment
fn kind_sampled_fragment(
    @builtin(position) position: vec4<f32>,
    @builtin(sample_index) sample: u32,
) -> @builtin(frag_depth) f32 {
    let middle = floor(position.xy) + 0.5;
    let first = surface_of(middle, false);
    let behind = surface_of(middle, true);
    let bit = 1u << sample;
    let is_behind = (behind.samples & bit) != 0u;
    var surface = first;
    if is_behind {
        surface = behind;
    }
    let kind = kind_of(surface) + select(0u, BEHIND_EDGE, is_behind);
    let seen = select(backdrop_at(middle), kind, (surface.samples & bit) != 0u);
    return f32(select(seen, HIDDEN, is_hidden(middle, i32(sample)))) * KIND;
}

// The share of water at a place whose ground is so high: all in lakes, less in rivers that are thinner than cells.
fn wet_share(place: vec2<f32>, height: f32) -> f32 {
    if is_above(frame.stand.w, 0.0, place.x + FAR_AWAY) {
        return 0.0;
    }
    let river = select(0.0, textureSampleLevel(rivers, between, share_of(place), 0.0).x, scene.has.w > 0.0);
    return select(river, 1.0, lake_depth(place, height) > 0.0);
}

// The same beyond the border.
fn wet_share_beyond(place: vec2<f32>, beyond: Beyond) -> f32 {
    if is_above(frame.stand.w, 0.0, place.x + FAR_AWAY) {
        return 0.0;
    }
    let drawn = textureSampleLevel(rivers, between, share_of(beyond.river), 0.0).x * river_share_beyond(beyond);
    let river = select(0.0, drawn, scene.has.w > 0.0);
    return select(river, 1.0, level_beyond(place, beyond) > beyond.surface.x);
}

// A point of the ground, and how it is looked at.
struct Look {
    // The place of the landscape that it is, or is like.
    place: vec2<f32>,
    direction: vec3<f32>,
    ray_length: f32,
    footprint: f32,
    surface: vec3<f32>,
    // Height and rise of the ground of that place.
    own: vec3<f32>,
    // Height above the water, and below it in negative numbers.
    above: f32,
    normal: vec3<f32>,
    sun: f32,
    // The share of water, the depth of a river, how it runs, and the normal of its level.
    wet: f32,
    river_depth: f32,
    running: vec3<f32>,
    tilt: vec3<f32>,
}

fn look_at_ground(point: vec3<f32>) -> Look {
    var look: Look;
    look.place = place_of(point);
    look.surface = spline_with_slope(bed, look.place);
    look.own = look.surface;
    look.above = -lake_depth(look.place, look.surface.x);
    look.wet = wet_share(look.place, look.surface.x);
    look.running = smooth_at(flow, look.place).xyz;
    look.tilt = normal_of(spline_with_slope(top, look.place).yz);
    return looked_at(point, look);
}

fn look_beyond(point: vec3<f32>) -> Look {
    let place = place_of(point);
    let beyond = ground_beyond(place);
    var look: Look;
    look.place = beyond.place;
    look.surface = beyond.surface;
    look.own = beyond.own;
    look.above = beyond.surface.x - level_beyond(place, beyond);
    look.wet = wet_share_beyond(place, beyond);
    look.tilt = vec3<f32>(0.0, 0.0, 1.0);
    return looked_at(point, look);
}

// The look with what follows from its place and surface.
fn looked_at(point: vec3<f32>, ground: Look) -> Look {
    let relative = point - frame.eye.xyz;
    var look = ground;
    look.ray_length = length(relative);
    look.direction = relative / look.ray_length;
    look.footprint = look.ray_length * frame.eye.w;
    look.above = select(look.above, 1e9, frame.stand.w > 0.0);
    look.normal = normal_of(look.surface.yz);
    look = with_edge(point.xy, look);
    let smooth_point = vec3<f32>(point.xy, look.surface.x - min(look.above, 0.0));
    look.sun = sun_seen_on(point, smooth_point, look.normal);
    trees_drawn = drawn_as_trees(point);
    sight = -look.direction / vec3<f32>(1.0, 1.0, scene.scale.y);
    return look;
}

// The look with the edge of its water, as sharp as the pixel: of a lake, or of a river that the map has.
fn with_edge(point: vec2<f32>, ground: Look) -> Look {
    var look = ground;
    if look.above < 0.0 {
        let slope = length(look.normal.xy) / max(look.normal.z, 1e-3);
        let width = swash_width(look.surface.x - look.above);
        look.wet = shore(point, -look.above / scene.scale.y, slope, width, look.footprint);
        return look;
    }
    let pixel = scene.grid.x * scene.grid.z / f32(textureDimensions(rivers).x);
    let footprint = look.footprint * inverseSqrt(max(-look.direction.z, 0.05));
    let river = with_banks(look.wet, point, pixel, footprint);
    look.wet = river.share;
    look.river_depth = river.depth;
    // No tree stands in a river, and its banks are wet.
    look.above = min(look.above, river.above * scene.scale.y);
    return look;
}

fn seen_through_air(radiance: vec3<f32>, look: Look) -> vec3<f32> {
    return limited(veil(radiance, frame.eye.xyz, look.direction, look.ray_length));
}

fn ray_of(look: Look) -> ViewRay {
    return ViewRay(look.direction, look.ray_length, look.footprint);
}

fn grass_at(point: vec3<f32>, look: Look) -> GrassSeen {
    return grass_seen(point.xy, look.place, look.normal, ray_of(look));
}

// The light of dry ground of such a skin, and of the grass on it.
fn skin_light(grass: GrassSeen, look: Look, skin: SurfaceSample) -> vec4<f32> {
    // Grass is rounder than what it grows on.
    let normal = roughened(look.normal, skin.bump * through_leaves(grass.lawn.w, 0.3));
    let seen = seen_at(skylight, share_of(look.place));
    let in_sun = skin.albedo * sunlight_on_facet(look.normal, normal, look.sun) / PI;
    let under_sky = skin.albedo * skylight_on(seen, normal) / PI;
    var radiance = in_sun + under_sky;
    if LAWN && grass.lawn.w > NO_LEAVES {
        radiance = with_canopy(SoilLight(in_sun, under_sky), grass, look.normal, ray_of(look), seen, look.sun);
    }
    return vec4<f32>(seen_through_air(radiance, look), GROUND_LIGHT);
}

// The skin of dry ground between grass, from afar.
fn skin_in_grass(grass: GrassSeen, look: Look) -> SurfaceSample {
    return ground_skin_at(look.place, grass.at, GroundHeights(look.surface, look.own), look.footprint, look.above);
}

// Dry ground from afar.
fn far_light(point: vec3<f32>, look: Look) -> vec4<f32> {
    let grass = grass_at(point, look);
    return skin_light(grass, look, skin_in_grass(grass, look));
}

// Dry ground from close by.
fn near_light(point: vec3<f32>, look: Look) -> vec4<f32> {
    let grass = grass_at(point, look);
    let height = point.z - dot(look.normal.xy, grass.at - point.xy) / max(look.normal.z, 0.05);
    let skin = with_detail(skin_in_grass(grass, look), vec3<f32>(grass.at, height), look.normal, look.footprint);
    return skin_light(grass, look, skin);
}

// Water, and its share.
fn water_light(point: vec3<f32>, look: Look) -> vec4<f32> {
    let depth = select(look.river_depth, -look.above / scene.scale.y, look.above < 0.0);
    let radiance = water_radiance(point, depth, look);
    return vec4<f32>(seen_through_air(radiance, look), look.wet);
}

// The light along a direction below the horizon that meets nothing of what is drawn: of the open sea, or of even land.
fn farthest_radiance(direction: vec3<f32>) -> vec3<f32> {
    let reach = scene.bend.w * max(scene.grid.x, scene.grid.y) * scene.scale.w;
    let far = place_of(frame.eye.xyz + direction * reach);
    let height = far_at(far).ground.x;
    let is_sea = height < scene.around.y;
    let ray_length = max((select(height, scene.around.y, is_sea) - frame.eye.z) / min(direction.z, -1e-6), 0.0);
    var radiance = scene.plain.xyz * lit(vec3<f32>(0.0, 0.0, 1.0), open_sky(), 1.0) / PI;
    if is_sea {
        let point = frame.eye.xyz + direction * ray_length;
        var look: Look;
        look.place = nearest_within(far);
        look.direction = direction;
        look.ray_length = ray_length;
        look.footprint = ray_length * frame.eye.w;
        look.surface = vec3<f32>(scene.around.y - OPEN_SEA, 0.0, 0.0);
        look.above = -OPEN_SEA;
        look.tilt = vec3<f32>(0.0, 0.0, 1.0);
        look.sun = sun_seen(point, look.tilt);
        radiance = water_radiance(point, OPEN_SEA, look);
    }
    return limited(veil(radiance, frame.eye.xyz, direction, ray_length));
}

fn seen_point(position: vec4<f32>) -> vec3<f32> {
    return surface_of(floor(position.xy) + 0.5, IS_BEHIND).point;
}

@fragment
fn far_fragment(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
    let point = seen_point(position);
    return far_light(point, look_at_ground(point));
}

@fragment
fn near_fragment(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
    let point = seen_point(position);
    return near_light(point, look_at_ground(point));
}

@fragment
fn water_fragment(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
    let point = seen_point(position);
    return water_light(point, look_at_ground(point));
}

@fragment
fn far_beyond_fragment(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
    let point = seen_point(position);
    return far_light(point, look_beyond(point));
}

@fragment
fn near_beyond_fragment(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
    let point = seen_point(position);
    return near_light(point, look_beyond(point));
}

@fragment
fn water_beyond_fragment(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
    let point = seen_point(position);
    return water_light(point, look_beyond(point));
}

// What lies farthest, into which all beyond the border fades; the sea goes on to the horizon.
@fragment
fn farthest_fragment(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
    let point = seen_point(position);
    if is_at_sea(point.z) {
        discard;
    }
    return vec4<f32>(farthest_radiance(backdrop_direction(position.xy)), lost_share(place_of(point)));
}
