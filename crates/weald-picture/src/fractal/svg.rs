//! Marks as vectors: an `.svg` whose dots and outlines stay sharp at any size.

use std::fmt::Write;

use super::super::colour::{Linear, encode};
use super::frame::Frame;
use super::marks::{Mark, Shape};
use super::palette::Table;

/// Longest file: what browsers and editors still open.
pub(super) const MAX_BYTES: usize = 64 << 20;

/// Tinges that share a colour in the file, so that one path holds many marks: 32 places on the palette, all steps.
const PLACES_PER_COLOUR: u16 = 8;

/// The file, with `background` behind the marks if there is one.
///
/// # Errors
/// How many times too long the file would be, more or less.
pub(super) fn svg(
    marks: &[Mark],
    shape: Shape,
    frame: &Frame,
    table: &Table,
    background: Option<Linear>,
) -> Result<String, f64> {
    let [width, height] = [frame.width, frame.height];
    let mut text = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" viewBox=\"0 0 {width} {height}\">\n"
    );
    if let Some(colour) = background {
        let _ = writeln!(text, "<rect width=\"100%\" height=\"100%\" fill=\"{}\"/>", hex(colour));
    }
    let mut written = 0;
    for run in marks.chunk_by(|a, b| shared(a.palette_index) == shared(b.palette_index)) {
        write_run(&mut text, run, shape, &hex(table.colour(shared(run[0].palette_index))));
        written += run.len();
        if text.len() > MAX_BYTES {
            return Err(text.len() as f64 * (marks.len() as f64 / written as f64) / MAX_BYTES as f64);
        }
    }
    text.push_str("</svg>\n");
    Ok(text)
}

/// The tinge whose colour a group of them has.
fn shared(palette_index: u16) -> u16 {
    let steps = super::palette::STEPS as u16;
    let (place, step) = (palette_index / steps, palette_index % steps);
    (place / PLACES_PER_COLOUR * PLACES_PER_COLOUR + PLACES_PER_COLOUR / 2) * steps + step
}

fn hex(colour: Linear) -> String {
    let [red, green, blue] = encode(colour);
    format!("#{red:02x}{green:02x}{blue:02x}")
}

/// One path for marks of one colour. A dot is a line of no length with round ends.
fn write_run(text: &mut String, run: &[Mark], shape: Shape, colour: &str) {
    let _ = match shape {
        Shape::Dot(diameter) => write!(
            text,
            "<path stroke=\"{colour}\" stroke-width=\"{diameter}\" stroke-linecap=\"round\" fill=\"none\" d=\""
        ),
        Shape::Outline => write!(text, "<path fill=\"{colour}\" d=\""),
    };
    for mark in run.iter().filter(|mark| mark.corners.iter().flatten().all(|x| x.is_finite())) {
        let Some((&[x, y], others)) = mark.corners.split_first() else { continue };
        let _ = write!(text, "M{x:.2} {y:.2}");
        for [x, y] in others {
            let _ = write!(text, "L{x:.2} {y:.2}");
        }
        text.push_str(if others.is_empty() { "h0" } else { "z" });
    }
    text.push_str("\"/>\n");
}
