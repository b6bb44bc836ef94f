//! What every PNG file of ours is made by.

use png::{BitDepth, ColorType, Encoder, EncodingError};

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
            writer.write_image_data(self.bytes)?;
            writer.finish()
        });
        written.map_err(|cause| Error::Run(format!("the PNG could not be made: {cause}")))?;
        Ok(file)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

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
