//! What a camera may see at all of the kinds that a picture has, and in which rows.

use weald::picture::Camera;
use wgpu::RenderPass;

/// Footprint in metres of a pixel from which on no ground is seen from close by, as `detail.wgsl` has it.
const DETAIL_FROM: f32 = 0.30;

/// What a camera may see at all: what it does not see costs a look at each pixel.
#[derive(Clone, Copy, Debug)]
pub(super) struct InSight {
    /// Whether some ground is close by.
    pub(super) is_near: bool,
    /// The sky, and what lies below the horizon behind all ground: in which rows.
    pub(super) backdrop: [Rows; 2],
    /// Whether the camera is above the base of clouds.
    pub(super) is_over_clouds: bool,
}

impl InSight {
    /// Of a camera that is so high above all ground, for pixels of such an angle, where clouds begin at a height.
    pub(super) fn of(camera: &Camera, above: f32, pixel_angle: f32, cloud_base: Option<f32>) -> Self {
        Self {
            // A hundredth for what a device rounds otherwise.
            is_near: above * pixel_angle < 1.01 * DETAIL_FROM,
            backdrop: [1.0, -1.0].map(|sign| Rows::that_rise(camera, sign)),
            is_over_clouds: cloud_base.is_some_and(|base| camera.eye[2] > base),
        }
    }

    /// The rows of a canvas of so many in which clouds are drawn: those of the sky, and those beside them, between which light is
    /// interpolated.
    pub(super) fn rows_of_clouds(&self, height: u32) -> Rows {
        if self.is_over_clouds { Rows::ALL } else { self.backdrop[0].with_beside(2.0 / height as f32) }
    }
}

/// Rows of a picture between two shares of its height from above.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Rows {
    start: f32,
    end: f32,
}

impl Rows {
    pub(super) const ALL: Self = Self { start: 0.0, end: 1.0 };

    /// Those in which some ray of a camera rises, or sinks by the other sign.
    fn that_rise(Camera { forward, right, up, half, .. }: &Camera, sign: f32) -> Self {
        // The greatest rise of a row's rays is `greatest + y · by_row`, with y from 1 above to -1 below; a hundredth for what a
        // device rounds otherwise.
        let greatest = sign * forward[2] + (half[0] * right[2]).abs() + 0.01;
        let by_row = sign * half[1] * up[2];
        if greatest.abs() >= by_row.abs() {
            return Self { end: if greatest > 0.0 { 1.0 } else { 0.0 }, ..Self::ALL };
        }
        let level = 0.5 + 0.5 * greatest / by_row;
        if by_row > 0.0 { Self { end: level, ..Self::ALL } } else { Self { start: level, ..Self::ALL } }
    }

    /// Whether there are any.
    pub(super) fn are_some(self) -> bool {
        self.start < self.end
    }

    /// With those beside them up to such a share of the height.
    fn with_beside(self, share: f32) -> Self {
        Self { start: (self.start - share).max(0.0), end: (self.end + share).min(1.0) }
    }

    /// Has a pass draw no others of a canvas of such a size.
    pub(super) fn limit(self, pass: &mut RenderPass<'_>, [width, height]: [u32; 2]) {
        let first = (self.start * height as f32).floor() as u32;
        let end = (self.end * height as f32).ceil() as u32;
        pass.set_scissor_rect(0, first, width, end - first);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use weald::random::{splitmix64, unit};

    #[test]
    fn what_a_pixel_shows_is_in_sight() {
        let (mut with_sky, mut with_plain, mut left_out) = (0, 0, 0.0);
        for number in 0..4000_u64 {
            let random = |purpose: u64| 2.0 * unit(splitmix64(number ^ splitmix64(purpose))) as f32 - 1.0;
            let camera = Camera::looking([0.0; 3], unit_of([0, 1, 2].map(random)), [0.6, 0.4]);
            let in_sight = InSight::of(&camera, 50.0, 1e-3, None);
            let rises = camera.ray([random(3), random(4)]).direction[2];
            let [sky, plain] = in_sight.backdrop;
            let row = 0.5 - 0.5 * random(4);
            let is_within = |rows: Rows| (rows.start..=rows.end).contains(&row);
            assert!(
                in_sight.is_near && (is_within(sky) || rises < 0.0) && (is_within(plain) || rises >= 0.0)
            );
            with_sky += u32::from(sky.are_some());
            with_plain += u32::from(plain.are_some());
            left_out += sky.start + 1.0 - sky.end;
        }
        assert!((1500..3900).contains(&with_sky) && (1500..3900).contains(&with_plain));
        assert!(left_out > 1000.0, "{left_out} of 4000 pictures");
        let camera = Camera::looking([0.0; 3], [1.0, 0.0, 0.0], [0.6, 0.4]);
        assert!(
            InSight::of(&camera, 299.0, 1e-3, None).is_near
                && !InSight::of(&camera, 304.0, 1e-3, None).is_near
        );
    }

    fn unit_of(v: [f32; 3]) -> [f32; 3] {
        let length = v.iter().map(|part| part * part).sum::<f32>().sqrt();
        v.map(|part| part / length)
    }
}
