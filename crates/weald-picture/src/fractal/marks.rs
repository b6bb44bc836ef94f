//! A fractal as sharp marks: all codes to a depth, or all parts down to a size, each a dot or the outline of a part.
//!
//! The outline of a part is the convex hull of the images of the fractal's own extreme points, each moved with its own
//! code: so an outline bends with its part, and neighbours that share a point share it still.

use super::colouring::Colouring;
use super::frame::Frame;
use super::palette::{self, PaletteIndex};
use super::subject::Subject;
use weald_core::error::{Error, Limit, Quantity};
use weald_plants::ifs::expansion::{Part, parts, parts_of_size};
use weald_plants::ifs::{Code, Game, Point};

/// Most marks of a picture.
const MAX_MARKS: u64 = 1 << 22;

/// Which parts are drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Opened {
    /// Those of so many digits.
    ToDepth(usize),
    /// The first on their way down to be no larger than so many pixels.
    ToPixels(f64),
}

/// What a part is drawn as.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Shape {
    /// A disc of that diameter in pixels.
    Dot(f64),
    /// Its outline.
    Outline,
}

/// A mark: a polygon, or a dot where it has one corner.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Mark {
    /// Corners in pixels, anticlockwise seen on the sheet.
    pub(super) corners: Vec<[f64; 2]>,
    pub(super) palette_index: PaletteIndex,
    nearer: f64,
}

/// All marks of a picture, from far to near, and of equally near ones in the order of their codes.
///
/// # Errors
/// [`Error::Limit`] beyond four million marks.
pub(super) fn marks(
    subject: &Subject<'_>,
    colouring: &Colouring,
    frame: &Frame,
    opened: Opened,
    shape: Shape,
) -> Result<Vec<Mark>, Error> {
    let extremes = match shape {
        Shape::Dot(_) => Vec::new(),
        Shape::Outline => extremes(subject),
    };
    let maker = Maker { subject, colouring, frame, extremes };
    check(subject, frame, opened)?;
    let mut marks = Vec::new();
    open(subject, frame, opened, |part| marks.push(maker.mark(part)))?;
    marks.sort_by(|a, b| a.nearer.total_cmp(&b.nearer));
    Ok(marks)
}

fn open(subject: &Subject<'_>, frame: &Frame, opened: Opened, look: impl FnMut(&Part)) -> Result<(), Error> {
    match opened {
        Opened::ToDepth(depth) => parts(subject.ifs, depth, look),
        Opened::ToPixels(pixels) => parts_of_size(subject.ifs, share(subject, frame, pixels), look),
    }
}

/// Pixels as a share of the fractal.
fn share(subject: &Subject<'_>, frame: &Frame, pixels: f64) -> f64 {
    pixels / (frame.scale * subject.ifs.diameter()).max(f64::MIN_POSITIVE)
}

/// Counts the marks before any is made.
fn check(subject: &Subject<'_>, frame: &Frame, opened: Opened) -> Result<(), Error> {
    let (count, subject, remedy) = match opened {
        Opened::ToDepth(depth) => {
            let maps = subject.ifs.maps().len() as u64;
            let count = |depth: u32| maps.checked_pow(depth);
            let fits = |depth: &u32| count(*depth).is_some_and(|count| count <= MAX_MARKS);
            let deepest = (0..depth as u32).rev().find(fits).unwrap_or(0);
            let made = format!("{}: all parts to a depth of {depth}", subject.ifs.name());
            (count(depth as u32), made, format!("choose a `depth` of {deepest} or less"))
        }
        Opened::ToPixels(pixels) => {
            let mut count = 0_u64;
            open(subject, frame, opened, |_| count += 1)?;
            let remedy = format!("choose a larger `finest` than {pixels} px");
            (Some(count), subject.ifs.name().to_owned(), remedy)
        }
    };
    if count.is_some_and(|count| count <= MAX_MARKS) {
        return Ok(());
    }
    Err(Limit::new(Quantity::Parts, count, 0..=MAX_MARKS).of(subject).remedy(remedy).into())
}

struct Maker<'a> {
    subject: &'a Subject<'a>,
    colouring: &'a Colouring,
    frame: &'a Frame,
    extremes: Vec<(Point, Code)>,
}

impl Maker<'_> {
    fn mark(&self, part: &Part) -> Mark {
        let middle = self.subject.seen_at(part.map.at(self.subject.ifs.root()), &part.code);
        let mut corners: Vec<[f64; 2]> =
            self.extremes.iter().map(|extreme| self.corner(part, extreme)).collect();
        if corners.is_empty() {
            corners.push(self.frame.place(middle));
        }
        let palette_index =
            palette::palette_index(self.colouring.of(&part.code), self.frame.nearness(middle[2]));
        Mark { corners: hull(corners), palette_index, nearer: middle[2] }
    }

    fn corner(&self, part: &Part, (at, code): &(Point, Code)) -> [f64; 2] {
        let at = part.map.at(*at);
        if self.subject.motion.is_none() {
            return self.frame.place(self.subject.camera.seen(at));
        }
        let code = code.digits().fold(part.code, Code::with);
        self.frame.place(self.subject.seen_at(at, &code))
    }
}

/// Directions in which a 2D fractal is measured; a 3D one is measured in as many around each axis.
const DIRECTIONS: usize = 16;

/// Points from which extremes are found.
const PROBES: u64 = 1 << 16;

/// The points of the fractal that reach furthest in some directions, with their codes.
fn extremes(subject: &Subject<'_>) -> Vec<(Point, Code)> {
    let directions = directions(subject.ifs.is_planar());
    let mut found: Vec<(f64, Point, Code)> = Vec::new();
    Game::new(subject.ifs, 0).points(PROBES, |block| {
        for number in 0..block.len() {
            let at = block.point(number).map(f64::from);
            let reach =
                |direction: &Point| direction[0] * at[0] + direction[1] * at[1] + direction[2] * at[2];
            if found.is_empty() {
                let code = block.code(number, subject.ifs);
                found = directions.iter().map(|direction| (reach(direction), at, code)).collect();
            }
            for (best, direction) in found.iter_mut().zip(&directions) {
                if reach(direction) > best.0 {
                    *best = (reach(direction), at, block.code(number, subject.ifs));
                }
            }
        }
    });
    let mut extremes: Vec<(Point, Code)> = found.into_iter().map(|(_, at, code)| (at, code)).collect();
    extremes.sort_by_key(|(_, code)| *code);
    extremes.dedup_by_key(|(_, code)| *code);
    extremes
}

fn directions(planar: bool) -> Vec<Point> {
    let round = |number: usize| libm::sincos(std::f64::consts::TAU * number as f64 / DIRECTIONS as f64);
    let turns = (0..DIRECTIONS).map(round);
    if planar {
        return turns.map(|(sine, cosine)| [cosine, sine, 0.0]).collect();
    }
    turns.flat_map(|(sine, cosine)| [[cosine, sine, 0.0], [0.0, cosine, sine], [sine, 0.0, cosine]]).collect()
}

/// The convex hull of points, by Andrew's monotone chain; fewer corners where they lie on a line.
fn hull(mut points: Vec<[f64; 2]>) -> Vec<[f64; 2]> {
    points.sort_by(|a, b| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
    points.dedup();
    if points.len() < 3 {
        return points;
    }
    let mut corners = half(points.iter().copied());
    let other = half(points.iter().rev().copied());
    corners.pop();
    corners.extend(&other[..other.len() - 1]);
    corners
}

/// One side of the hull, from the first point to the last.
fn half(points: impl Iterator<Item = [f64; 2]>) -> Vec<[f64; 2]> {
    let mut side: Vec<[f64; 2]> = Vec::new();
    for point in points {
        while let [.., a, b] = side[..] {
            let turn = (b[0] - a[0]) * (point[1] - a[1]) - (b[1] - a[1]) * (point[0] - a[0]);
            if turn > 0.0 {
                break;
            }
            side.pop();
        }
        side.push(point);
    }
    side
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_hull_keeps_corners_and_leaves_out_what_lies_within_or_on_a_side() {
        let square = vec![[0.0, 0.0], [1.0, 1.0], [0.5, 0.5], [1.0, 0.0], [0.0, 1.0], [0.5, 0.0]];
        assert_eq!(hull(square), [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]);
        assert_eq!(hull(vec![[0.0, 0.0], [2.0, 2.0], [1.0, 1.0]]).len(), 2, "a line");
    }
}
