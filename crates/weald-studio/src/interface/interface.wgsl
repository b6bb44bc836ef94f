// Triangles of the interface: the colour of each corner times a texture, both in the encoding of the window.

struct Corner {
    // Nothing here has a depth: shares along the window are shares along the triangle.
    @location(0) @interpolate(linear) place: vec2<f32>,
    @location(1) @interpolate(linear) colour: vec4<f32>,
    @builtin(position) position: vec4<f32>,
};

// Width and height of the window, in points.
@group(0) @binding(0) var<uniform> window: vec4<f32>;
@group(1) @binding(0) var image: texture_2d<f32>;
@group(1) @binding(1) var filtered: sampler;

@vertex
fn corner(
    @location(0) at: vec2<f32>,
    @location(1) place: vec2<f32>,
    @location(2) colour: vec4<f32>,
) -> Corner {
    let across = 2.0 * at / window.xy - 1.0;
    return Corner(place, colour, vec4(across.x, -across.y, 0.0, 1.0));
}

@fragment
fn pixel(corner: Corner) -> @location(0) vec4<f32> {
    return corner.colour * textureSampleLevel(image, filtered, corner.place, 0.0);
}
