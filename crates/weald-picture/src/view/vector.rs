//! Vectors of three: east, north, up in metres; or red, green, blue in linear light.

/// Three numbers.
pub(super) type Vector = [f32; 3];

#[inline(always)]
pub(super) fn add(a: Vector, b: Vector) -> Vector {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

#[inline(always)]
pub(super) fn subtract(a: Vector, b: Vector) -> Vector {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

#[inline(always)]
pub(super) fn scale(a: Vector, factor: f32) -> Vector {
    [a[0] * factor, a[1] * factor, a[2] * factor]
}

/// Number by number, as light is filtered.
#[inline(always)]
pub(super) fn filter(a: Vector, b: Vector) -> Vector {
    [a[0] * b[0], a[1] * b[1], a[2] * b[2]]
}

#[inline(always)]
pub(super) fn dot(a: Vector, b: Vector) -> f32 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(super) fn cross(a: Vector, b: Vector) -> Vector {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// The vector at length 1; it must not be zero.
#[inline(always)]
pub(super) fn unit(a: Vector) -> Vector {
    scale(a, 1.0 / dot(a, a).sqrt())
}

/// The direction in which a mirror of normal `normal` throws a ray of direction `ray`.
#[inline(always)]
pub(super) fn mirrored(ray: Vector, normal: Vector) -> Vector {
    subtract(ray, scale(normal, 2.0 * dot(ray, normal)))
}

/// The direction of an azimuth, clockwise from north, and an altitude above the horizon.
pub(super) fn towards(azimuth_deg: f64, altitude_deg: f64) -> Vector {
    let (azimuth, altitude) = (azimuth_deg.to_radians(), altitude_deg.to_radians());
    let across = libm::cos(altitude);
    [across * libm::sin(azimuth), across * libm::cos(azimuth), libm::sin(altitude)].map(|c| c as f32)
}

/// Luminance of a colour in linear light.
#[inline(always)]
pub(super) fn luminance(colour: Vector) -> f32 {
    dot(colour, [0.2126, 0.7152, 0.0722])
}

/// 0 below `low`, 1 above `high`, smooth between.
#[inline(always)]
pub(super) fn ramp(value: f32, low: f32, high: f32) -> f32 {
    let share = ((value - low) / (high - low)).clamp(0.0, 1.0);
    share * share * (3.0 - 2.0 * share)
}
