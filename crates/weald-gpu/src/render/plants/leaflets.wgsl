// Leaflets and needles of trees from close by. Leaves are drawn as blades of a few corners, each a spray or a compound leaf;
// the gaps between its leaflets or needles are cut out of it, pixel by pixel.

// How far leaflets reach forward, in shares of the blade's length.
const LEAFLETS_FORWARD = 0.3;

// Half the width of the twig, in half widths of the blade.
const TWIG = 0.05;

// Leaflets a pixel from which the gaps begin to close, and from which a blade is whole.
const CLOSING_LEAFLETS = vec2<f32>(0.3, 0.9);

// Whether a point of a blade lies in a gap; the blade has `count` leaflets on a side, which take a share of its edge.
fn is_between_leaflets(blade: vec2<f32>, count: f32, share: f32) -> bool {
    let out = abs(blade.y);
    let along = count * (blade.x - LEAFLETS_FORWARD * out);
    let closed = smoothstep(CLOSING_LEAFLETS.x, CLOSING_LEAFLETS.y, fwidth(along));
    let broad = mix(share * sqrt(clamp(2.5 * (out + 0.06), 0.0, 1.0)), 1.0, closed);
    return abs(fract(along) - 0.5) > 0.5 * broad && out > TWIG;
}
