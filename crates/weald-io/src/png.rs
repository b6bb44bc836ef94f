//! What every PNG file of ours is made by.

use png::{BitDepth, ColorType, Encoder, EncodingError};
use rayon::prelude::*;

use super::deflate::zlib;
use weald_core::vectors::widest;

use weald_core::error::Error;

/// Pixels of a PNG file.
#[derive(Clone, Copy, Debug)]
pub struct Pixels<'a> {
    /// Pixels from left to right and from top to bottom, at least 1 each.
    pub sides: [usize; 2],
    /// Channels of a pixel.
    pub channels: ColorType,
    /// Bits of a channel.
    pub depth: BitDepth,
    /// Rows from the top; the highest byte of a channel first.
    pub bytes: &'a [u8],
}

impl Pixels<'_> {
    /// The bytes of a file of plain numbers: without the mark of a colour space.
    ///
    /// # Errors
    /// As [`Pixels::marked`].
    pub fn file(&self) -> Result<Vec<u8>, Error> {
        self.marked(|_| Ok(()))
    }

    /// The bytes of a file whose header says more, by `mark`.
    ///
    /// # Errors
    /// [`Error::Run`] where a mark does not fit, or where the bytes are not as many as the pixels need.
    pub fn marked(
        &self,
        mark: impl FnOnce(&mut Encoder<'_, &mut Vec<u8>>) -> Result<(), EncodingError>,
    ) -> Result<Vec<u8>, Error> {
        let mut file = Vec::new();
        let [width, height] = self.sides.map(|side| side as u32);
        let mut encoder = Encoder::new(&mut file, width, height);
        encoder.set_color(self.channels);
        encoder.set_depth(self.depth);
        let written = mark(&mut encoder).and_then(|()| {
            let mut writer = encoder.write_header()?;
            for chunk in zlib(&self.filtered()?).chunks(LONGEST_CHUNK) {
                writer.write_chunk(png::chunk::IDAT, chunk)?;
            }
            writer.finish()
        });
        written.map_err(|cause| Error::Run(format!("the PNG could not be made: {cause}")))?;
        Ok(file)
    }
}

/// Most bytes of a chunk.
const LONGEST_CHUNK: usize = 1 << 30;

/// Rows that a task filters; no result depends on it.
const ROWS_PER_TASK: usize = 32;

impl Pixels<'_> {
    /// Rows as they are packed: each after the number of its filter, the one of the least sum of differences (PNG
    /// specification, 12.7).
    fn filtered(&self) -> Result<Vec<u8>, EncodingError> {
        let [width, height] = self.sides;
        let pixel = (self.channels.samples() * self.depth as usize / 8).max(1);
        let length = (width * self.channels.samples() * self.depth as usize).div_ceil(8);
        if self.bytes.len() != length * height {
            let (found, needed) = (self.bytes.len(), length * height);
            return Err(std::io::Error::other(format!("{found} bytes, where there must be {needed}")).into());
        }
        let mut filtered = vec![0; (length + 1) * height];
        let rows = filtered.par_chunks_mut(length + 1).with_min_len(ROWS_PER_TASK).enumerate();
        let none = vec![0; length];
        rows.for_each_init(
            || vec![0; length],
            |room, (y, to)| {
                let bytes = &self.bytes[y * length..][..length];
                let above = if y == 0 { &none[..] } else { &self.bytes[(y - 1) * length..][..length] };
                filter(&Row { bytes, above, pixel }, room, to);
            },
        );
        Ok(filtered)
    }
}

/// A row, the one above it, and the bytes of a pixel.
struct Row<'a> {
    bytes: &'a [u8],
    above: &'a [u8],
    pixel: usize,
}

/// Filters a row in each way, and keeps the best with its number.
fn filter(row: &Row<'_>, room: &mut [u8], to: &mut [u8]) {
    let mut least = u64::MAX;
    for kind in 0..5 {
        widest(
            #[inline(always)]
            || row.filter(kind, room),
        );
        let sum = room.iter().map(|byte| u64::from((*byte as i8).unsigned_abs())).sum();
        if sum < least {
            least = sum;
            to[0] = kind;
            to[1..].copy_from_slice(room);
        }
    }
}

impl Row<'_> {
    /// The differences of a row by a filter: none, left, above, mean of both, Paeth's.
    #[inline(always)]
    fn filter(&self, kind: u8, to: &mut [u8]) {
        match kind {
            0 => to.copy_from_slice(self.bytes),
            1 => self.less(to, |left, _, _| left),
            2 => self.less(to, |_, up, _| up),
            3 => self.less(to, |left, up, _| u16::midpoint(left.into(), up.into()) as u8),
            _ => self.less(to, |left, up, corner| paeth(left.into(), up.into(), corner.into())),
        }
    }

    /// The row less what is predicted from the bytes to the left, above, and above the left.
    #[inline(always)]
    fn less(&self, to: &mut [u8], predicted: impl Fn(u8, u8, u8) -> u8) {
        let Self { bytes, above, pixel } = *self;
        // The first pixel has nothing to its left.
        for ((to, &here), &up) in to.iter_mut().zip(bytes).zip(above).take(pixel) {
            *to = here.wrapping_sub(predicted(0, up, 0));
        }
        let left = bytes.iter().zip(above);
        let rest = to[pixel..].iter_mut().zip(&bytes[pixel..]).zip(&above[pixel..]);
        for (((to, &here), &up), (&left, &corner)) in rest.zip(left) {
            *to = here.wrapping_sub(predicted(left, up, corner));
        }
    }
}

/// The one of three that is nearest to `left + up - corner`.
#[inline(always)]
fn paeth(left: i16, up: i16, corner: i16) -> u8 {
    let [by_left, by_up, by_corner] =
        [(up - corner).abs(), (left - corner).abs(), (left + up - 2 * corner).abs()];
    let of_two = if by_up <= by_corner { up } else { corner };
    (if by_left <= by_up && by_left <= by_corner { left } else { of_two }) as u8
}

#[cfg(test)]
mod tests {
    use super::*;
    use weald_core::random::splitmix64;

    #[test]
    fn pictures_of_every_kind_come_back_from_their_filters() {
        for (channels, depth) in [
            (ColorType::Grayscale, BitDepth::Sixteen),
            (ColorType::Grayscale, BitDepth::Eight),
            (ColorType::Rgb, BitDepth::Eight),
            (ColorType::Rgba, BitDepth::Eight),
        ] {
            let [width, height] = [301, 97];
            let length = width * channels.samples() * depth as usize / 8;
            // Slopes, steps and noise, so that every filter is the best of some row.
            let byte = |at: usize| {
                let (x, y) = (at % length, at / length);
                match y / 16 {
                    0 => (x / 2 + 3 * y) as u8,
                    1 => splitmix64(at as u64) as u8,
                    2 => (y * y) as u8,
                    3 => (x * x / 64) as u8,
                    _ => (splitmix64((x / 8) as u64) as u8) / 8 + (x / 4 + y) as u8 / 2,
                }
            };
            let bytes: Vec<u8> = (0..length * height).map(byte).collect();
            let file =
                Pixels { sides: [width, height], channels, depth, bytes: &bytes }.file().expect("whole");
            let mut reader = png::Decoder::new(std::io::Cursor::new(file)).read_info().expect("a PNG");
            let mut found = vec![0; bytes.len()];
            reader.next_frame(&mut found).expect("one frame");
            reader.finish().expect("whole");
            assert!(found == bytes, "{channels:?} of {depth:?}");
        }
    }

    #[test]
    fn too_few_bytes_are_refused_and_enough_come_back() {
        let pixels =
            |bytes| Pixels { sides: [3, 2], channels: ColorType::Grayscale, depth: BitDepth::Eight, bytes };
        let fault = pixels(&[7; 5]).file().expect_err("one too few").to_string();
        assert!(fault.starts_with("the PNG could not be made: "), "{fault}");
        let file = pixels(&[1, 2, 3, 4, 5, 6]).file().expect("six");
        let mut reader = png::Decoder::new(std::io::Cursor::new(file)).read_info().expect("a PNG");
        let mut found = [0; 6];
        reader.next_frame(&mut found).expect("one frame");
        assert_eq!(found, [1, 2, 3, 4, 5, 6]);
    }
}
