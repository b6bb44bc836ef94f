// Twin of `scene.rs` and `facets.rs`: the light that starts at ground, cut sides and the plain, for the share of the sun that is seen.

fn lit(normal: vec3<f32>, seen: Seen, sun: f32) -> vec3<f32> {
    let facing = max(dot(normal, scene.sun.xyz), 0.0);
    return scene.sunlight.xyz * (facing * sun) + skylight_on(seen, normal);
}

// Whether a place lies under a lake, how deep, or so far above it in negative numbers.
fn lake_depth(place: vec2<f32>, ground: f32) -> f32 {
    if !is_above(scene.has.x, 0.0, place.x + FAR_AWAY) {
        return -1e9;
    }
    return spline_at(level, place) - ground;
}

// Dry ground on a surface of a height and a rise by the cell, as colour and roughness.
fn ground_skin(place: vec2<f32>, surface: vec3<f32>, footprint: f32, above: f32) -> SurfaceSample {
    return ground_skin_at(place, point_of(place, 0.0).xy, GroundHeights(surface, surface), footprint, above);
}

// Heights of ground, and their rise by the cell: those of a point, and of the place of the landscape that it is like.
struct GroundHeights {
    surface: vec3<f32>,
    own: vec3<f32>,
}

// The beds of ground of such a height and rise, as a point of a surface has them.
fn bed_of(own: vec3<f32>) -> vec3<f32> {
    return vec3<f32>(own.x / scene.scale.y, own.yz / max(length(own.yz), 1e-6));
}

// The same at a point that is like a place of the landscape.
fn ground_skin_at(
    place: vec2<f32>,
    at: vec2<f32>,
    heights: GroundHeights,
    footprint: f32,
    above: f32,
) -> SurfaceSample {
    let surface = heights.surface;
    let normal = normal_of(surface.yz);
    let stretch = scene.scale.y;
    let run = length(normal.xy);
    let point = vec3<f32>(at, surface.x / stretch);
    let slope = run / max(normal.z, 1e-3) / stretch;
    let fall = normal.xy / max(run, 1e-6);
    let beach = beach_height(surface.x - above);
    var skin = cover_at(SurfacePoint(place, point, slope, fall, footprint, above / stretch, beach, bed_of(heights.own)));
    let width = swash_width(surface.x - above);
    skin.albedo = wetted(skin.albedo, above, wet_reach(width, slope));
    return skin;
}

// The normal of a surface with the roughness of its skin.
fn roughened(normal: vec3<f32>, bump: vec2<f32>) -> vec3<f32> {
    return normalize(vec3<f32>(normal.xy - normal.z * bump * scene.scale.y, normal.z));
}

// Slopes from which on a surface is a wall, of facets without gaps between them, and by which it is for certain.
const WALLS = vec2<f32>(0.9, 1.8);

// How much a wall faces the sun where its facets are seen as such: one that the sun grazes is evenly lit.
const FACETS_SEEN = 0.4;

// How much a facet of a surface of such a slope faces the sun, on walls as far as others leave it to it: in all about as much falls on
// them as on the even wall.
fn facing_sun(even: vec3<f32>, facet: vec3<f32>, sun: vec3<f32>, slope: f32) -> f32 {
    let wall = max(dot(even, sun), 0.0);
    let facing = max(dot(facet, sun), 0.0);
    let seen = clamp(wall / max(facing * dot(even, facet), 1e-3), 0.0, 1.0);
    let left = facing * seen * (1.0 + seen * (1.0 - seen));
    let on_wall = mix(wall, left, ramp(wall, 0.0, FACETS_SEEN));
    return mix(facing, on_wall, ramp(slope, WALLS.x, WALLS.y));
}

// The light of the sun on a facet of a surface.
fn sunlight_on_facet(even: vec3<f32>, facet: vec3<f32>, sun: f32) -> vec3<f32> {
    let slope = length(even.xy) / max(even.z, 1e-3) / scene.scale.y;
    return scene.sunlight.xyz * (facing_sun(even, facet, scene.sun.xyz, slope) * sun);
}

// A cut side.
fn side_radiance(place: vec2<f32>, point: vec3<f32>, normal: vec3<f32>, sun: f32) -> vec3<f32> {
    let stretch = scene.scale.y;
    let surface = spline_at(bed, place);
    var albedo = scene.cut_water.xyz;
    if point.z <= surface {
        albedo = strata_albedo(place, point, point.z / stretch, surface / stretch);
    }
    let facing = max(dot(normal, scene.sun.xyz), 0.0);
    return albedo * (scene.sunlight.xyz * (facing * sun) + side_light(normal)) / PI;
}

// The light of the sky on a point of the plain.
fn plain_seen(point: vec3<f32>) -> Seen {
    let share = (share_of(place_of(point)) + 1.0) / 3.0;
    if all(share >= vec2<f32>(0.0)) && all(share <= vec2<f32>(1.0)) {
        return seen_at(plain_light, share);
    }
    return open_sky();
}

// The plain that the landscape stands on, which is lost in the haze of the horizon.
fn plain_radiance(eye: vec3<f32>, direction: vec3<f32>, ray_length: f32, sun: f32) -> vec3<f32> {
    let seen = plain_seen(eye + direction * ray_length);
    let radiance = scene.plain.xyz * lit(vec3<f32>(0.0, 0.0, 1.0), seen, sun) / PI;
    let near = veil(radiance, eye, direction, ray_length);
    let far = ray_length / scene.haze.z;
    return mix(near, sky_radiance(vec3<f32>(direction.xy, 0.0)), 1.0 - exp(-0.25 * far * far));
}
