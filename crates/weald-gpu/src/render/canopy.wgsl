// Grass as a whole: what of its light gets through to blades and soil. Its leaf area index and the share of light that goes
// through are those of `canopy.rs`.

// For each cell the mean colour of leaves, and the leaf area index.
@group(0) @binding(3) var leaves: texture_2d<f32>;

// Least cosine at which leaves are looked through: no ground is so even that one looks through more.
const FLATTEST = 0.12;

fn leaves_at(place: vec2<f32>) -> vec4<f32> {
    return textureSampleLevel(leaves, between, share_of(place), 0.0);
}

// Share of light that goes through so many leaves at an angle whose cosine with the upright is so.
fn through_leaves(index: f32, cosine: f32) -> f32 {
    return exp(-0.5 * index / max(cosine, FLATTEST));
}

// Share of the light of the sky that goes through so many leaves.
fn sky_through_leaves(index: f32) -> f32 {
    return exp(-0.7 * index);
}

// Leaves that are drawn as blades at a distance, as a share of all.
fn drawn_as_blades(distance: f32) -> f32 {
    let standing = share(distance);
    return min(standing * broader(standing), 1.0);
}

// Least cosine of the sun to the ground's normal: tips catch it where the ground turns away.
const SUN_GRAZES = 0.12;

// Of the leaves that are seen along a direction the share that the sun reaches. Of leaves that stand in all directions as many are
// seen, and as many reached, as above, exp(-L / 2c) of either below a leaf area L, where c are v and s, the cosines of the eye and of the
// sun to the ground's normal:
//
//     ∫ exp(-L / 2v) exp(-L / 2s) dL / 2v = s / (s + v)
//
// This is the law of Lommel and Seeliger (Seeliger 1887, "Zur Theorie der Beleuchtung der großen Planeten"), by which slopes that are seen flatly are about as bright
// wherever they face.
fn sunlit_leaves(normal: vec3<f32>, direction: vec3<f32>) -> f32 {
    let sun = max(dot(normal, scene.sun.xyz), SUN_GRAZES);
    return sun / (sun + abs(dot(normal, direction)));
}
