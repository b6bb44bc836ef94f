//! Sets of blades as triangles, and figure 5: how a set grows.

use super::raster::{Air, Camera, Corner, Vector, cross, dot, minus, picture, plus};
use crate::figures::{Claim, Figure, FigureOutput, GalleryJob, Make, Measured, Plate, Verdict, texts};
use weald_picture::Image;
use weald_plants::grass::{BLADES, Bend, Blade, Growth, LEVELS, SPECIES, Set, Species, Spline};

pub(in crate::figures) const FIGURE_5: Figure = Figure {
    id: "grass-5",
    title: "Five stages of growth",
    source: "Kim and Cho 2009, fig. 5, eq. 1",
    shows: "A set of six blades from a sprout to the fourth level. In the source a blade jumps from level to level; here it \
        grows through all that is between, of which these are five moments.",
    seconds: 3,
    make: Make::Alone(|job| Ok(make(job))),
};

/// Least width of a blade in pixels: what is thinner would be seen in pieces.
const THINNEST: f32 = 0.8;

/// The stages that are shown.
const STAGES: [f32; 5] = [0.5, 1.0, 2.0, 3.0, 4.0];

/// How sets are drawn.
pub(super) struct Brush<'a> {
    pub(super) camera: &'a Camera,
    pub(super) bend: Bend,
    /// Rows of vertices of a blade.
    pub(super) rows: usize,
    /// Share of the sky that is seen at the root of a blade.
    pub(super) shade: f32,
}

impl Brush<'_> {
    /// Adds the triangles of a set.
    pub(super) fn tuft(&self, species: &Species, set: &Set, place: Vector, triangles: &mut Vec<[Corner; 3]>) {
        let tone = 0.82 + 0.36 * set.phase();
        for number in 0..BLADES {
            let blade = Blade::of(species, set, number, self.bend);
            let vertices: Vec<_> = blade.vertices(self.rows).collect();
            let middles: Vec<Vector> =
                vertices.chunks_exact(2).map(|row| middle(row[0].place, row[1].place)).collect();
            let mut corners = Vec::with_capacity(vertices.len());
            for (number, row) in vertices.chunks_exact(2).enumerate() {
                let (from, to) =
                    (middles[number.saturating_sub(1)], middles[(number + 1).min(middles.len() - 1)]);
                let sides = [row[0].place, row[1].place].map(|side| plus(side, place));
                let sides = self.widened(sides, minus(to, from));
                corners.extend(row.iter().zip(sides).map(|(vertex, place)| Corner {
                    place,
                    normal: vertex.normal,
                    colour: species.colour(vertex.blend, vertex.head).map(|channel| channel * tone),
                    open: self.shade + (1.0 - self.shade) * vertex.along.sqrt(),
                    through: 0.65,
                }));
            }
            for row in corners.windows(4).step_by(2) {
                triangles.push([row[0], row[1], row[2]]);
                triangles.push([row[2], row[1], row[3]]);
            }
        }
    }

    /// The two sides of a blade that goes that way, as far apart as can be seen from the camera.
    fn widened(&self, [left, right]: [Vector; 2], direction: Vector) -> [Vector; 2] {
        let middle = middle(left, right);
        let across = cross(minus(self.camera.eye, middle), direction);
        let length = dot(across, across).sqrt();
        let wanted = THINNEST * self.camera.pixel(middle);
        if length < 1e-12 {
            return [left, right];
        }
        let across = across.map(|part| part / length);
        let seen = dot(minus(right, left), across);
        if seen.abs() >= wanted {
            return [left, right];
        }
        let half = 0.5 * if seen < 0.0 { -wanted } else { wanted };
        [-half, half].map(|half| std::array::from_fn(|i| middle[i] + half * across[i]))
    }
}

fn middle(a: Vector, b: Vector) -> Vector {
    std::array::from_fn(|i| 0.5 * (a[i] + b[i]))
}

/// Sets on paper, in a picture `high` metres high.
pub(super) fn portrait(species: &Species, sets: &[(Vector, Set)], high: f32, size: [usize; 2]) -> Image {
    let away = 12.0 * high;
    let camera = Camera {
        eye: [0.0, 0.75 * high, away],
        target: [0.0, 0.44 * high, 0.0],
        view_deg: (2.0 * libm::atanf(0.5 * high / away)).to_degrees(),
        size,
    };
    let brush = Brush { camera: &camera, bend: Bend::Total, rows: 40, shade: 0.4 };
    let mut triangles = Vec::new();
    for (place, set) in sets {
        brush.tuft(species, set, *place, &mut triangles);
    }
    picture(&triangles, camera, &Air::PAPER)
}

fn make(job: GalleryJob) -> FigureOutput {
    let species = Species { variation: 0.2, width: 0.014, splay: 0.0, ..SPECIES[0].clone() };
    let set = |level| Set { soil: 0.95, light: 0.35, level, cut: 1.0, trodden: 0.0, seed: 12 };
    let size = job.choose([270, 250], [40, 40]);
    let images = STAGES.map(|level| {
        portrait(&species, &[([0.0; 3], set(level))], 0.8, size).titled(&format!("level {level}"))
    });
    let points = Growth::at(&species.curves, 0.95, 0.35).points(Bend::Total);
    let heights = points.map(|[up, _]| up);
    let smallest =
        (1..LEVELS).all(|level| heights[level + 1] - heights[level] < heights[level] - heights[level - 1]);
    let steps = 4000_u32;
    let tip = |step: u32| Spline::of(&points, 4.0 * step as f32 / steps as f32).at(1.0).0;
    let jump = (0..steps).map(|step| {
        let ([a, b], [c, d]) = (tip(step), tip(step + 1));
        (a - c).hypot(b - d)
    });
    let jump = jump.fold(0.0, f32::max);
    let row = |level: usize| vec![level.to_string(), format!("{:.3}", heights[level])];
    FigureOutput {
        plates: vec![Plate {
            name: "stages",
            caption: "A set of ryegrass, drawn twice as broad as it is, on good soil in weak light at five moments of its growth".to_owned(),
            image: Image::beside(&images, 4),
        }],
        measured: Measured {
            header: texts(["level", "height of the tip"]),
            rows: (0..=LEVELS).map(row).collect(),
            remarks: texts(["Heights are in those of the first level at its best."]),
        },
        claims: vec![
            Claim::new(
                "Each level adds less than the one before",
                Verdict::of(smallest),
                format!("{:.2}, {:.2}, {:.2} and {:.2}", heights[1], heights[2], heights[3], heights[4]),
            ),
            Claim::new(
                "A blade grows without a jump",
                Verdict::of(jump < 0.01),
                format!("in a thousandth of a level the tip moves by at most {jump:.4}"),
            ),
        ], ..FigureOutput::default() }
}
