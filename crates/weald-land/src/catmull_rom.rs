//! Weights of Catmull and Rom's spline (1974; Keys 1981 with a = -1/2, doi 10.1109/TASSP.1981.1163711), which goes through
//! its points.

/// Weights of four points in a row for a place `t` of the way from the second to the third.
pub(crate) fn weights(t: f64) -> [f64; 4] {
    [
        0.5 * t * (-1.0 + t * (2.0 - t)),
        1.0 + 0.5 * t * t * (-5.0 + 3.0 * t),
        0.5 * t * (1.0 + t * (4.0 - 3.0 * t)),
        0.5 * t * t * (t - 1.0),
    ]
}
