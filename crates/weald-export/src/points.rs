//! The points of a fractal with their codes: as text (.csv), as a point cloud (.ply) or as arrays (.npy).

use std::fmt::Write;
use std::path::Path;

use super::{Export, Finished};
use weald_core::error::{Error, Limit, Quantity};
use weald_core::parameter::LayerName;
use weald_io::{Part, PartName, npy};
use weald_plants::Fractal;
use weald_plants::Vegetation;
use weald_plants::ifs::{Code, Coded, Game, Ifs, expansion};

/// Extensions of the files.
pub(super) const EXTENSIONS: &[&str] = &["csv", "ply", "npy"];

/// Most points of a file.
const MAX_POINTS: u64 = 1 << 25;

/// Longest file.
const MAX_BYTES: u64 = 4 << 30;

/// What the name of the file of codes has more than that of the places, without its extension.
const CODES: &str = "_codes.npy";

weald_core::parameters! {
    /// The points of a fractal, after its deformations.
    pub struct Points {
        /// Name of a `[[fractal]]` or of a built-in one.
        fractal: LayerName = LayerName::needed();
        /// Number of points by random iteration.
        count: u64 = 100_000, range 1..=33_554_432, without depth;
        /// Digits of all the codes whose points are written, in place of random ones.
        depth: Option<u32> = None, range 0..=26;
        /// Whether codes stand beside the points: as text in .csv, as eight words of 32 bits in .ply, as an array of
        /// digits `…_codes.npy` beside .npy.
        codes: bool = true;
        /// Seed of the points.
        seed: u64 = 1, range 0..=9_007_199_254_740_991_u64, without depth;
    }
}

impl Export for Points {
    fn reads(&self) -> Vec<String> {
        Vec::new()
    }

    fn fractals(&self) -> Vec<String> {
        vec![self.fractal.0.clone()]
    }

    fn names(&self, file: &Path) -> Vec<PartName> {
        let is_table = ["csv", "ply"].contains(&extension(file).as_str());
        let codes = (self.codes && !is_table).then(|| PartName::Sibling(CODES.to_owned()));
        std::iter::once(PartName::Own).chain(codes).collect()
    }

    fn parts(&self, finished: &Finished<'_>, file: &Path) -> Result<Vec<Part>, Error> {
        let name = &self.fractal.0;
        let fractal = finished.landscape.fractal(name)?;
        let extension = extension(file);
        self.check(&fractal.ifs, &extension)?;
        let points = self.points(&fractal)?;
        Ok(match extension.as_str() {
            "csv" => vec![Part::own(self.csv(&points).into_bytes())],
            "ply" => vec![Part::own(self.ply(&points))],
            _ => self.arrays(&points, &fractal.ifs),
        })
    }
}

fn extension(file: &Path) -> String {
    file.extension().and_then(|extension| extension.to_str()).unwrap_or_default().to_ascii_lowercase()
}

impl Points {
    /// Refuses files that would be too long, before any point is made.
    fn check(&self, ifs: &Ifs, extension: &str) -> Result<(), Error> {
        let digits = if self.codes { ifs.code_digits() as u64 } else { 0 };
        let a_point = match extension {
            "csv" => 3 * 16 + 4 * digits,
            "ply" => 12 + if self.codes { 32 } else { 0 },
            _ => 12 + digits,
        };
        let count = match self.depth {
            None => Some(self.count),
            Some(depth) => (ifs.maps().len() as u64).checked_pow(depth),
        };
        let limit = match count {
            Some(count) if count <= MAX_POINTS && count * a_point <= MAX_BYTES => return Ok(()),
            Some(count) if count <= MAX_POINTS => {
                Limit::new(Quantity::FileBytes, count * a_point, 0..=MAX_BYTES)
            }
            count => Limit::new(Quantity::Points, count, 0..=MAX_POINTS),
        };
        let remedy = "choose a smaller `count` or `depth`, or `codes = false`";
        Err(limit.of(format!("points of {a_point} bytes each")).remedy(remedy).into())
    }

    fn points(&self, fractal: &Fractal) -> Result<Vec<Coded>, Error> {
        let deformation = fractal.deformation().map_err(|faults| Error::Run(faults.join("; ")))?;
        let ifs = &fractal.ifs;
        let mut points = match self.depth {
            Some(depth) => expansion::points(ifs, depth as usize)?,
            None => played(ifs, (self.count, self.seed)),
        };
        if !deformation.is_nothing() {
            for point in &mut points {
                point.at = deformation.apply(point.at, &point.code);
            }
        }
        Ok(points)
    }

    fn csv(&self, points: &[Coded]) -> String {
        let mut text = String::from(if self.codes { "x,y,z,code\n" } else { "x,y,z\n" });
        for Coded { at: [x, y, z], code } in points {
            let _ = write!(text, "{},{},{}", *x as f32, *y as f32, *z as f32);
            if self.codes {
                // Codes of many maps have commas of their own.
                let _ = write!(text, ",\"{code}\"");
            }
            text.push('\n');
        }
        text
    }

    fn ply(&self, points: &[Coded]) -> Vec<u8> {
        let mut header = format!("ply\nformat binary_little_endian 1.0\nelement vertex {}\n", points.len());
        for axis in ["x", "y", "z"] {
            let _ = writeln!(header, "property float {axis}");
        }
        for word in 0..if self.codes { 8 } else { 0 } {
            let _ = writeln!(header, "property uint code{word}");
        }
        header.push_str("end_header\n");
        let mut file = header.into_bytes();
        for Coded { at, code } in points {
            file.extend(at.iter().flat_map(|&x| (x as f32).to_le_bytes()));
            if self.codes {
                file.extend(halves(code).flat_map(u32::to_le_bytes));
            }
        }
        file
    }

    fn arrays(&self, points: &[Coded], ifs: &Ifs) -> Vec<Part> {
        let mut places = npy::header("<f4", [points.len(), 3]);
        places.extend(points.iter().flat_map(|point| point.at).flat_map(|x| (x as f32).to_le_bytes()));
        let mut parts = vec![Part::own(places)];
        if self.codes {
            let digits = self.depth.map_or(ifs.code_digits(), |depth| depth as usize);
            let mut codes = npy::header("|u1", [points.len(), digits]);
            codes.extend(points.iter().flat_map(|point| (0..digits).map(|place| point.code.digit(place))));
            parts.push(Part::sibling(CODES, codes));
        }
        parts
    }
}

/// The words of a code in halves, coarsest first.
fn halves(code: &Code) -> impl Iterator<Item = u32> {
    code.words().into_iter().flat_map(|word| [(word >> 32) as u32, word as u32])
}

/// Points of random iteration.
fn played(ifs: &Ifs, (count, seed): (u64, u64)) -> Vec<Coded> {
    let mut points = Vec::with_capacity(count as usize);
    Game::new(ifs, seed).points(count, |block| {
        points.extend(
            (0..block.len()).map(|number| Coded {
                at: block.point(number).map(f64::from),
                code: block.code(number, ifs),
            }),
        );
    });
    points
}

#[cfg(test)]
mod tests {
    use super::*;
    use weald_core::domain::Domain;
    use weald_core::grid::Size;
    use weald_core::landscape::Landscape;
    use weald_plants::ifs::Digits;

    fn files(points: &Points, file: &str) -> Result<Vec<Part>, Error> {
        let landscape = Landscape::new(Domain::new(Size { columns: 1, rows: 1 }, 1.0));
        let finished = Finished { landscape: &landscape, steps: &[], recipe: "r", hash: "", seed: 0 };
        points.parts(&finished, Path::new(file))
    }

    fn gasket() -> Points {
        Points { fractal: LayerName::of("gasket"), depth: Some(2), ..Points::default() }
    }

    #[test]
    fn an_expansion_is_written_in_the_order_of_its_codes() {
        let text = String::from_utf8(files(&gasket(), "a.csv").expect("few").remove(0).bytes).expect("text");
        let lines: Vec<_> = text.lines().collect();
        assert_eq!(lines.len(), 10);
        assert_eq!(lines[..3], ["x,y,z,code", "0,0,0,\"00\"", "0.25,0,0,\"01\""]);
        assert_eq!(lines[9], "0,0.75,0,\"22\"");
    }

    #[test]
    fn a_cloud_holds_points_and_the_codes_that_lead_to_them() {
        let points = Points { depth: None, count: 500, ..gasket() };
        let ply = files(&points, "a.ply").expect("few").remove(0).bytes;
        let end = ply.windows(11).position(|text| text == b"end_header\n").expect("a header") + 11;
        assert!(ply.starts_with(b"ply\nformat binary_little_endian 1.0\nelement vertex 500\n"));
        assert_eq!(ply.len() - end, 500 * 44);
        let ifs = Fractal::built_in("gasket").expect("built in").ifs.clone();
        for vertex in ply[end..].chunks(44) {
            let number = |at: usize| vertex[4 * at..4 * at + 4].try_into().expect("four bytes");
            let word = u32::from_le_bytes(number(3));
            let digits: Vec<u8> = (0..16).map(|place| (word >> (30 - 2 * place) & 3) as u8).collect();
            let code = Code::of(Digits::of(3).expect("three"), &digits).expect("digits");
            let [x, y] = [0, 1].map(|axis| f64::from(f32::from_le_bytes(number(axis))));
            let at = ifs.point(&code);
            assert!((at[0] - x).abs() < 2e-5 && (at[1] - y).abs() < 2e-5, "{at:?} {x} {y}");
        }
    }

    #[test]
    fn arrays_lie_beside_each_other_and_too_many_points_are_refused() {
        let parts = files(&gasket(), "a.npy").expect("few");
        assert_eq!((parts[0].bytes.len() % 64, parts[1].bytes.len() % 64), (9 * 12 % 64, 18));
        let error = files(&Points { depth: Some(26), ..gasket() }, "a.csv").expect_err("3^26 points");
        assert!(error.exit_code() == 5 && error.to_string().contains("2541865828329 points"), "{error}");
        let ifs = Fractal::built_in("gasket").expect("built in").ifs.clone();
        let of = format!("points of {} bytes", 48 + 4 * ifs.code_digits());
        assert!(error.to_string().contains(&of), "three numbers, and each digit with its comma: {error}");
    }
}
