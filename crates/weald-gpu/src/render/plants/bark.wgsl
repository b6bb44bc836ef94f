// The bark of stems from close by: furrows along them, and moss, more of it on the northern side.

// Radius in metres of a usual trunk, by which angles around any stem become lengths. The bark of one half mirrors that of the
// other, so that there is no seam; and angles do not change as a stem sways, so that the bark does not slide on it.
const BARK_RADIUS = 0.22;

// Longest wavelength of furrows in metres, how much longer they are than broad, how dark and how steep.
const FURROWS = 0.15;
const FURROWS_LONG = 5.0;
const FURROWS_DARK = 0.75;
const FURROWS_STEEP = 0.07;

// How dark the cracks between ribs are, and how narrow: a crack is where the noise of furrows is within 1 / this of its middle. Where
// pixels are too large for furrows, a crack is as dark as all of them are in the mean.
const CRACKS_DARK = 0.45;
const CRACKS_WIDE = 6.0;
const CRACKS_MEAN = 0.225;

// Longest wavelength of patches of moss in metres, their colour, and how much of a stem they hide at most.
const MOSS = 1.1;
const MOSS_COLOUR = vec3<f32>(0.045, 0.062, 0.018);
const MOSS_MOST = 0.55;

// What is seen of a stem.
struct Bark {
    colour: vec3<f32>,
    normal: vec3<f32>,
}

// The bark of a stem at a point; `turned` is how much the normal turns over a pixel.
fn bark_of(colour: vec3<f32>, point: vec3<f32>, side: vec3<f32>, turned: f32) -> Bark {
    let relative = point - frame.eye.xyz;
    let direction = normalize(relative);
    // On a slender stem a pixel spans more of the way around.
    let footprint = max(length(relative) * frame.eye.w, BARK_RADIUS * turned);
    let around = atan2(side.x, side.y);
    let place = vec2<f32>(BARK_RADIUS * abs(around), point.z);
    let furrows = octaves_at(Octaves(FURROWS, 5u, 0.64, 0x51u), vec2<f32>(place.x, place.y / FURROWS_LONG), footprint);
    let patches = octaves_at(Octaves(MOSS, 5u, 0.6, 0x52u), place, footprint).value;
    let mossy = MOSS_MOST * smoothstep(0.0, 0.55, patches + 0.3 * side.y - 0.5 * furrows.value);
    let sharp = 1.0 - clamp(CRACKS_WIDE * abs(furrows.value + 0.05), 0.0, 1.0);
    let crack = mix(CRACKS_MEAN, sharp, grain_visible(footprint, FURROWS));
    let tone = max(1.0 + FURROWS_DARK * furrows.value + 0.3 * patches - CRACKS_DARK * crack, 0.25);
    let across = normalize(vec3<f32>(side.y, -side.x, 1e-4)) * sign(around);
    let rough = normalize(side) - FURROWS_STEEP * furrows.slope.x * across;
    // Normals are interpolated over flat sides, so that at the edges of a stem they point away from the eye by a little.
    let normal = rough - max(dot(rough, direction), 0.0) * direction;
    return Bark(tone * mix(colour, MOSS_COLOUR, mossy), normalize(normal));
}
