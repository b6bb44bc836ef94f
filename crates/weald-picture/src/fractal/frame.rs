//! What part of the drawing plane a picture shows, and where its points fall on the pixels.

use super::subject::Subject;
use weald_core::error::{Error, Limit, Quantity};
use weald_core::parameter::Sides;
use weald_plants::ifs::Game;

/// Length of a picture's longer side where nobody chooses, in pixels.
const DEFAULT_SIDE: f64 = 1024.0;

/// Narrowest picture that a shape chooses for itself, as a share of its longer side.
const NARROWEST: f64 = 0.25;

/// Most pixels of a picture.
const MAX_PIXELS: u64 = 1 << 27;

/// Points from which the extent of a shape is found that moves or is seen from aside.
const PROBES: u64 = 1 << 18;

/// Least and greatest coordinates of what is seen: right, up, nearer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Extent {
    /// Least.
    pub low: [f64; 3],
    /// Greatest.
    pub high: [f64; 3],
}

impl Extent {
    /// Of nothing.
    pub const NONE: Self = Self { low: [f64::INFINITY; 3], high: [f64::NEG_INFINITY; 3] };

    /// Of a shape as it is seen: of one that rests and is seen from in front to a billionth, else from a quarter of
    /// a million of its points.
    pub fn of(subject: &Subject<'_>) -> Self {
        if subject.motion.is_none() && subject.frontal {
            let [low, high] = subject.ifs.bounds();
            return Self::NONE.and(subject.camera.seen(low)).and(subject.camera.seen(high));
        }
        let (mut extent, mut packer) = (Self::NONE, subject.packer());
        Game::new(subject.ifs, 0).points(PROBES, |block| {
            if let Some(packer) = &mut packer {
                packer.pack(block);
            }
            for row in 0..block.rows().len() {
                extent = subject.seen(block, row, packer.as_ref()).fold(extent, Self::and);
            }
        });
        extent
    }

    /// With one more point; one that is not finite is left out.
    #[must_use]
    #[inline]
    pub fn and(mut self, point: [f64; 3]) -> Self {
        if point.iter().all(|x| x.is_finite()) {
            for ((low, high), x) in self.low.iter_mut().zip(&mut self.high).zip(point) {
                (*low, *high) = (low.min(x), high.max(x));
            }
        }
        self
    }

    /// With another extent.
    #[must_use]
    pub fn with(self, other: Self) -> Self {
        self.and(other.low).and(other.high)
    }
}

/// Pixels, and where the drawing plane lies under them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    /// Pixels from left to right.
    pub width: usize,
    /// Pixels from top to bottom.
    pub height: usize,
    /// Pixels a unit of the fractal.
    pub scale: f64,
    /// The middle of the picture in the drawing plane.
    pub middle: [f64; 2],
    /// How near the farthest and the nearest point are.
    pub depths: [f64; 2],
}

impl Frame {
    /// The frame that shows an extent whole with a margin, a share of the shorter side on each side. Without a
    /// size it takes the proportions of the extent.
    ///
    /// # Errors
    /// [`Error::Limit`] beyond 2^27 pixels.
    pub fn around(extent: &Extent, size: Option<Sides>, margin: f64) -> Result<Self, Error> {
        let side = |axis: usize| (extent.high[axis] - extent.low[axis]).max(0.0);
        let [wide, high] = [side(0), side(1)];
        let longest = wide.max(high).max(f64::MIN_POSITIVE);
        let (width, height) = match size {
            Some(sides) => checked(sides)?,
            None => [wide, high]
                .map(|side| (DEFAULT_SIDE * (side / longest).max(NARROWEST)).round() as usize)
                .into(),
        };
        let room = |pixels: usize| pixels as f64 - 2.0 * margin * width.min(height) as f64;
        let fit = |pixels: usize, side: f64| room(pixels) / side.max(1e-6 * longest);
        Ok(Self {
            width,
            height,
            scale: fit(width, wide).min(fit(height, high)),
            middle: [0, 1].map(|axis| 0.5 * (extent.low[axis] + extent.high[axis])),
            depths: [extent.low[2], extent.high[2]],
        })
    }

    /// Where a point of the drawing plane falls, in pixels from the top left corner.
    #[inline]
    pub fn place(&self, [right, up, _]: [f64; 3]) -> [f64; 2] {
        [
            (right - self.middle[0]) * self.scale + 0.5 * self.width as f64,
            0.5 * self.height as f64 - (up - self.middle[1]) * self.scale,
        ]
    }

    /// 0 for the farthest point, 1 for the nearest; 1 for all of a plane.
    #[inline]
    pub fn nearness(&self, nearer: f64) -> f64 {
        let [far, near] = self.depths;
        if near > far { ((nearer - far) / (near - far)).clamp(0.0, 1.0) } else { 1.0 }
    }

    /// Number of pixels.
    pub fn pixels(&self) -> u64 {
        self.width as u64 * self.height as u64
    }
}

fn checked(sides: Sides) -> Result<(usize, usize), Error> {
    let pixels = sides.columns.checked_mul(sides.rows);
    if pixels.is_none_or(|pixels| pixels > MAX_PIXELS) {
        let limit = Limit::new(Quantity::Pixels, pixels, 0..=MAX_PIXELS);
        let limit = limit.of(format!("a picture of {} × {} pixels", sides.columns, sides.rows));
        return Err(limit.remedy("choose a smaller `size`").into());
    }
    Ok((sides.columns as usize, sides.rows as usize))
}

#[cfg(test)]
mod tests {
    use super::*;

    const EXTENT: Extent = Extent { low: [-1.0, 0.0, 0.0], high: [1.0, 8.0, 0.0] };

    #[test]
    fn a_frame_takes_the_proportions_of_what_it_shows_and_leaves_the_margin() {
        let frame = Frame::around(&EXTENT, None, 0.1).expect("small");
        assert_eq!((frame.width, frame.height), (256, 1024));
        let [left, top] = frame.place([-1.0, 8.0, 0.0]);
        assert!(left >= 25.5 && (top >= 25.5), "{left} {top}");
        assert!((left - 25.6).abs() < 1e-9 || (top - 25.6).abs() < 1e-9, "one side touches the margin");
        assert_eq!(frame.place([0.0, 4.0, 0.0]), [128.0, 512.0]);
    }

    #[test]
    fn a_size_is_kept_and_too_large_a_one_refused() {
        let frame = Frame::around(&EXTENT, Some(Sides { columns: 300, rows: 100 }), 0.0).expect("small");
        assert_eq!((frame.width, frame.height, frame.scale), (300, 100, 12.5));
        let error =
            Frame::around(&EXTENT, Some(Sides { columns: 1 << 20, rows: 1 << 20 }), 0.0).expect_err("huge");
        assert_eq!(error.exit_code(), 5, "{error}");
    }

    #[test]
    fn points_that_are_not_finite_do_not_stretch_an_extent() {
        assert_eq!(EXTENT.and([f64::NAN, 0.0, 0.0]).and([f64::INFINITY; 3]), EXTENT);
    }
}
