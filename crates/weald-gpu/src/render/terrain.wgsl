// The ground: patches whose vertices slide onto the next level of detail, shaded as in the ray-marched view.

const QUADS = 16u;

// Whether some of the landscape has no data. Where it has not, no fragment can be discarded, so that depth is known early.
override HOLES: bool = true;

struct Ground {
    @builtin(position) @invariant position: vec4<f32>,
    @location(0) point: vec3<f32>,
}

// Heights of the vertices of all patches that are drawn, and half of their ways onto their even neighbours.
@group(3) @binding(0) var<storage, read> patch_heights: array<vec2<f32>>;

fn heights_of_vertex(slot: u32, at: vec2<f32>) -> vec2<f32> {
    return patch_heights[slot * PATCH_VERTICES + u32(at.y) * (QUADS + 1u) + u32(at.x)];
}

// A vertex of a patch, which is its corner, spacing and level, drawn back to what is farthest; odd ones slide onto their even
// neighbours before the next level begins.
fn sliding_point(patch_of: vec4<f32>, slot: u32, at: vec2<f32>, farthest: vec2<f32>) -> vec3<f32> {
    let start = patch_of.xy + at * patch_of.z;
    let slide = frame.slides[u32(patch_of.w)];
    let away = (start - frame.stand.xy) * scene.grid.zw;
    let distance = length(vec3<f32>(away, frame.stand.z));
    let share = clamp((distance - slide.x) / (slide.y - slide.x), 0.0, 1.0);
    let onto = onto_neighbour(at);
    let place = mix(min(start, farthest), min(start + onto * patch_of.z, farthest), share);
    let heights = heights_of_vertex(slot, at);
    let neighbour = heights_of_vertex(slot, at + onto).x;
    // The parabola through the ground at the beginning of the slide, half-way and at its end.
    let left = 1.0 - share;
    let height = 4.0 * share * left * heights.y + (left - share) * (left * heights.x - share * neighbour);
    // No higher and no lower than those, by which it is known what hides what.
    let least = min(min(heights.x, heights.y), neighbour);
    return point_of(place, clamp(height, least, max(max(heights.x, heights.y), neighbour)));
}

// A point of a patch that lies within the border, or is drawn back onto it.
fn point_within(patch_of: vec4<f32>, slot: u32, at: vec2<f32>) -> vec3<f32> {
    return sliding_point(patch_of, slot, at, scene.grid.xy + 0.5);
}

fn ground_at_vertex(index: u32, patch_of: vec4<f32>, slot: u32) -> vec3<f32> {
    return point_within(patch_of, slot, vertex_of_patch(index));
}

@vertex
fn ground_vertex(
    @builtin(vertex_index) index: u32,
    @location(0) patch_of: vec4<f32>,
    @location(1) slot: u32,
) -> Ground {
    let point = ground_at_vertex(index, patch_of, slot);
    return Ground(projected(point), point);
}

// The same of a patch that lies in part beyond the border, where ground goes on.
fn beyond_at_vertex(index: u32, patch_of: vec4<f32>, slot: u32) -> vec3<f32> {
    return sliding_point(patch_of, slot, vertex_of_patch(index), vec2<f32>(FAR_AWAY));
}

@vertex
fn beyond_vertex(
    @builtin(vertex_index) index: u32,
    @location(0) patch_of: vec4<f32>,
    @location(1) slot: u32,
) -> Ground {
    let point = beyond_at_vertex(index, patch_of, slot);
    return Ground(projected(point), point);
}

// A wall below one edge of a patch: x along it, y 0 on the ground and 1 on the base. `edge` is 0 to 3 for north, east,
// south, west.
fn side_at_vertex(index: u32, patch_of: vec4<f32>, slot: u32, edge: u32) -> vec3<f32> {
    let along = f32(index % (QUADS + 1u));
    // The end of the landscape may lie within a patch; vertices beyond it are drawn back onto it.
    let far = f32(QUADS);
    let ats = array<vec2<f32>, 4>(
        vec2<f32>(along, 0.0), vec2<f32>(far, along), vec2<f32>(along, far), vec2<f32>(0.0, along),
    );
    let point = point_within(patch_of, slot, ats[edge]);
    return select(point, vec3<f32>(point.xy, scene.plain.w), index > QUADS);
}

@vertex
fn side_vertex(
    @builtin(vertex_index) index: u32,
    @location(0) patch_of: vec4<f32>,
    @location(1) slot: u32,
    @location(2) edge: u32,
) -> Ground {
    let point = side_at_vertex(index, patch_of, slot, edge);
    return Ground(projected(point), point);
}

fn is_valid(place: vec2<f32>) -> bool {
    return !HOLES || spline_at(land, place) >= 0.5;
}

// Where there is no land nothing is seen.
@fragment
fn hole_fragment(in: Ground) {
    if !is_valid(place_of(in.point)) {
        discard;
    }
}

fn side_colour(point: vec3<f32>, normal: vec3<f32>) -> vec4<f32> {
    let relative = point - frame.eye.xyz;
    let ray_length = length(relative);
    let place = clamp(place_of(point), vec2<f32>(0.5), scene.grid.xy + 0.5);
    let outside = point + normal * 1.5 * scene.scale.w;
    let radiance = side_radiance(place, point, normal, sun_seen(outside, normal));
    return vec4<f32>(limited(veil(radiance, frame.eye.xyz, relative / ray_length, ray_length)), OTHER_LIGHT);
}

struct Wall {
    @builtin(position) position: vec4<f32>,
    @location(0) point: vec3<f32>,
    @location(1) normal: vec2<f32>,
}

// Two triangles: above first, above last, below first; above last, below last, below first.
fn is_rim_end(index: u32) -> bool {
    return index == 1u || index == 3u || index == 4u;
}

fn rim_at_vertex(index: u32, ends: vec4<f32>) -> vec3<f32> {
    let place = select(ends.xy, ends.zw, is_rim_end(index));
    let point = point_of(place, spline_at(top, place));
    let is_below = index == 2u || index == 4u || index == 5u;
    return select(point, vec3<f32>(point.xy, scene.plain.w), is_below);
}

// A wall along the rim of what has no data, from one place to another.
@vertex
fn rim_vertex(
    @builtin(vertex_index) index: u32,
    @location(0) ends: vec4<f32>,
    @location(1) normals: vec4<f32>,
) -> Wall {
    let point = rim_at_vertex(index, ends);
    return Wall(projected(point), point, select(normals.xy, normals.zw, is_rim_end(index)));
}

@fragment
fn rim_fragment(in: Wall) -> @location(0) vec4<f32> {
    return side_colour(in.point, normalize(vec3<f32>(in.normal, 0.0)));
}

@fragment
fn side_fragment(in: Ground) -> @location(0) vec4<f32> {
    let place = place_of(in.point);
    if !is_valid(clamp(place, vec2<f32>(0.5), scene.grid.xy + 0.5)) {
        discard;
    }
    let from_low = place - 0.5;
    let from_high = scene.grid.xy + 0.5 - place;
    let nearest = min(min(from_low.x, from_low.y), min(from_high.x, from_high.y));
    var normal = vec3<f32>(0.0, -1.0, 0.0);
    if from_low.x == nearest {
        normal = vec3<f32>(-1.0, 0.0, 0.0);
    } else if from_high.x == nearest {
        normal = vec3<f32>(1.0, 0.0, 0.0);
    } else if from_low.y == nearest {
        normal = vec3<f32>(0.0, 1.0, 0.0);
    }
    return side_colour(in.point, normal);
}
