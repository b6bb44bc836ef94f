//! Moving pictures in one file: animated PNG, which browsers play and everything else shows as its first frame.

use std::io::{BufWriter, Write};
use std::path::Path;

use png::{BitDepth, Encoder, EncodingError, SrgbRenderingIntent, Writer};

use super::Cutout;
use weald_core::error::Error;
use weald_core::files::File;
use weald_io::write_through;

/// Thousandths of a frame a second, by which delays are exact to the rates that people write.
const THOUSANDTHS: f64 = 1000.0;

/// Writes frames one after the other, to be shown for ever. They must be equally large.
///
/// # Errors
/// [`Error::Run`] for a file that cannot be written, and those of `frame`.
pub fn write_apng(
    path: &Path,
    (frames, frames_per_second): (u64, f64),
    mut frame: impl FnMut(u64) -> Result<Cutout, Error>,
) -> Result<(), Error> {
    write_through(path, |temporary| {
        let unwritten = |cause: &std::io::Error| Error::write(path, cause);
        let file = File::create(temporary).map_err(|cause| unwritten(&cause))?;
        let mut file = BufWriter::new(file);
        let first = frame(0)?;
        let mut writer =
            begin(&mut file, &first, (frames, frames_per_second)).map_err(|cause| not_made(path, cause))?;
        add(&mut writer, &first).map_err(|cause| not_made(path, cause))?;
        for number in 1..frames {
            let next = frame(number)?;
            add(&mut writer, &next).map_err(|cause| not_made(path, cause))?;
        }
        writer.finish().map_err(|cause| not_made(path, cause))?;
        file.flush().and_then(|()| file.get_ref().sync_all()).map_err(|cause| unwritten(&cause))
    })
}

fn begin<W: Write>(
    file: W,
    first: &Cutout,
    (frames, frames_per_second): (u64, f64),
) -> Result<Writer<W>, EncodingError> {
    let [width, height] = [first.image.width, first.image.height].map(|side| side as u32);
    let mut encoder = Encoder::new(file, width, height);
    encoder.set_color(first.colours());
    encoder.set_depth(BitDepth::Eight);
    encoder.set_source_srgb(SrgbRenderingIntent::Perceptual);
    encoder.set_animated(u32::try_from(frames).unwrap_or(u32::MAX), 0)?;
    let [over, under] = delay(frames_per_second);
    encoder.set_frame_delay(over, under)?;
    encoder.write_header()
}

/// Seconds of a frame as a fraction of 16-bit numbers.
fn delay(frames_per_second: f64) -> [u16; 2] {
    let whole = frames_per_second.round();
    if whole == frames_per_second {
        return [1, whole as u16];
    }
    let over = (THOUSANDTHS.min(65535.0 / frames_per_second)).floor();
    [over as u16, (over * frames_per_second).round() as u16]
}

fn add<W: Write>(writer: &mut Writer<W>, frame: &Cutout) -> Result<(), EncodingError> {
    writer.write_image_data(&frame.bytes())
}

fn not_made(path: &Path, cause: EncodingError) -> Error {
    match cause {
        EncodingError::IoError(cause) => Error::write(path, &cause),
        other => Error::Run(format!("{} could not be made: {other}", path.display())),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Image;

    #[test]
    fn a_rate_becomes_a_delay_that_is_exact_to_a_thousandth() {
        assert_eq!(delay(24.0), [1, 24]);
        for rate in [1.5, 23.976, 29.97, 239.5] {
            let [over, under] = delay(rate);
            assert!(
                (f64::from(under) / f64::from(over) - rate).abs() < 1e-3 * rate,
                "{rate}: {over}/{under}"
            );
        }
    }

    #[test]
    fn frames_come_back_in_their_order_and_an_error_leaves_no_file() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("a.apng");
        let frame = |number: u64| Cutout::from(Image { width: 2, height: 1, rgb: vec![number as u8; 6] });
        write_apng(&path, (3, 24.0), |number| Ok(frame(number))).expect("written");
        let file = std::io::BufReader::new(File::open(&path).expect("there"));
        let mut reader = png::Decoder::new(file).read_info().expect("a PNG");
        let control = *reader.info().animation_control().expect("animated");
        assert_eq!((control.num_frames, control.num_plays), (3, 0), "it loops");
        for number in 0..3 {
            let mut pixels = [9; 6];
            reader.next_frame(&mut pixels).expect("a frame");
            assert_eq!(pixels, [number; 6]);
        }
        let broken = folder.path().join("b.apng");
        let stop =
            |number| if number < 2 { Ok(frame(number)) } else { Err(Error::Interrupted(String::new())) };
        assert_eq!(write_apng(&broken, (3, 24.0), stop).expect_err("stopped").exit_code(), 130);
        assert_eq!(std::fs::read_dir(folder.path()).expect("there").count(), 1, "only the first film");
    }
}
