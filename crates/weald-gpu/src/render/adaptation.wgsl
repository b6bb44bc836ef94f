// How much brighter a picture from under the crowns of a wood is exposed: a camera there looks at what stands in their shade,
// by which an eye and a light meter go. From above them, and where lone trees stand, it is exposed for open ground.

// Density of a wood from which crowns begin to close over the eye, and from which they are closed.
const CLOSING = vec2<f32>(0.25, 0.8);

// Metres above the ground at which an eye begins to rise out of the shade, and at which it is out of it.
const OUT_OF_SHADE = vec2<f32>(6.0, 16.0);

// Width in metres over which the density is averaged: an eye that walks from one tree to the next sees no change.
const AROUND_EYE = 15.0;

// Share of red, green and blue in brightness.
const LUMINANCE = vec3<f32>(0.2126, 0.7152, 0.0722);

// Exponent on what the crowns take of the light; less than 1, so that shade still looks like shade.
const ADAPTED = 0.8;

// The factor on the light of a picture.
fn adaptation() -> f32 {
    let ground = wooded_ground(frame.eye.xy, AROUND_EYE);
    let density = select(0.0, wood_at(ground).x, may_bear_trees(ground.place));
    let shaded = ramp(density, CLOSING.x, CLOSING.y);
    let above = frame.eye.z / scene.scale.y - ground.point.z;
    let share = shaded * (1.0 - ramp(above, OUT_OF_SHADE.x, OUT_OF_SHADE.y)) * drawn_as_trees(frame.eye.xyz);
    let sky = dot(LUMINANCE, skylight_on(seen_at(skylight, share_of(ground.place)), vec3<f32>(0.0, 0.0, 1.0)));
    let sun = dot(LUMINANCE, scene.sunlight.xyz) * scene.sun.z;
    return pow((sky + sun) / (sky + (1.0 - share) * sun), ADAPTED);
}
