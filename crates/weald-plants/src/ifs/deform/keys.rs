//! Deformations as a recipe or the command line writes them.

use super::{Deform, Displacement, Field, Frame, Insertion, Interval, Part, Permutation, Polynomial};
use super::{Replacement, Reversal, Swap};
use crate::ifs::code::Code;
use crate::ifs::system::Ifs;

weald_core::choices! {
    /// Kinds of deformations.
    pub enum By {
        /// Every digit becomes the next one.
        Permutation = "permutation",
        /// Two digits take each other's places.
        Swap = "swap",
        /// A digit comes between any two.
        Insertion = "insertion",
        /// A digit becomes another.
        Replacement = "replacement",
        /// Digits stand in the opposite order.
        Reversal = "reversal",
        /// A continuous field.
        Field = "field",
        /// A vector for each digit.
        Displacement = "displacement",
        /// A turn and a scale of one part about its joint.
        Part = "part",
    }
}

weald_core::choices! {
    /// Units of fields and displacement vectors.
    pub enum Units {
        /// A square as wide as the longest side of the fractal, which stands on the middle of its floor.
        Square = "square",
        /// Those of the fractal.
        Own = "own",
    }
}

weald_core::parameters! {
    /// A deformation. What is absent is as in Han and Kim 2007.
    pub struct DeformKeys {
        /// Kind of the deformation: `permutation` makes every digit of the code the next one, `swap` exchanges two
        /// digits, `insertion` puts a digit between any two, `replacement` makes one digit another, `reversal` turns
        /// the order of the digits round; `field` moves points by a polynomial, `displacement` by a vector for each
        /// digit, `part` turns and scales one part about its joint.
        by: Option<By> = None;
        /// First digit of the code that is changed, `k_b`: 1 is the coarsest, that of the largest part.
        from: Option<u64> = None, range 1..=256,
            when by = "permutation" | "swap" | "insertion" | "replacement" | "reversal" | "displacement";
        /// Last digit that is changed, `k_e`.
        to: Option<u64> = None, range 1..=256,
            when by = "permutation" | "swap" | "insertion" | "replacement" | "reversal" | "displacement";
        /// Digits are numbers of maps, from 0. Of a swap the two digits, by default 1 and 2; of an insertion the new
        /// digit, by default 0; of a replacement the old digit and the new one, by default 2 and 0.
        digits: Vec<f64> = Vec::new(), range 0..=255, when by = "swap" | "insertion" | "replacement";
        /// Factor of displacement vectors from a digit to the next finer one.
        delta: f64 = 0.65, range 0.0..=1.0, when by = "displacement";
        /// Displacement vectors: x and y, or x, y and z, for each map in turn. By default those of the source, for up
        /// to four maps.
        vectors: Vec<f64> = Vec::new(), when by = "displacement";
        /// Factor A of the field of the source.
        amplitude: f64 = 0.4, range -100.0..=100.0, when by = "field";
        /// In place of that field, a polynomial for the x component, as a flat list of terms c, i, j, k for
        /// c·xⁱ·yʲ·zᵏ: [0.5, 1, 0, 0, -1, 0, 2, 0] is 0.5 x - y².
        along_x: Vec<f64> = Vec::new(), when by = "field";
        /// The same for the y component.
        along_y: Vec<f64> = Vec::new(), when by = "field";
        /// The same for the z component.
        along_z: Vec<f64> = Vec::new(), when by = "field";
        /// Units of fields and vectors: `square` is the fractal scaled to the width of the unit square, `own` the
        /// fractal's own units.
        units: Units = Units::Square, when by = "field" | "displacement";
        /// Code of the part that moves, as 113 or 1,1,3: digits are numbers of maps, from 0, the largest part first. Of
        /// the built-in fern 0 is the stem, 1 goes on upward, 2 and 3 are the lowest fronds, and 12 is the frond above 2.
        part: String = String::new(), when by = "part";
        /// Turn of the part in its x-y plane, counter-clockwise.
        angle_deg: f64 = 0.0, range -360.0..=360.0, unit "deg", when by = "part";
        /// Scale of the part.
        factor: f64 = 1.0, range -100.0..=100.0, when by = "part";
        /// Any linear map of the part in place of turn and scale, row by row: four numbers in 2D, nine in 3D.
        linear: Vec<f64> = Vec::new(), range -100.0..=100.0, when by = "part";
    }
}

impl DeformKeys {
    /// The deformation of a fractal.
    ///
    /// # Errors
    /// A sentence for the user.
    pub fn of(&self, ifs: &Ifs) -> Result<Deform, String> {
        let by = self.by.ok_or("`by` is needed: the kind of the deformation, as \"permutation\"")?;
        match by {
            By::Field => self.field(ifs).map(Deform::Field),
            By::Part => self.part(ifs).map(Deform::Part),
            By::Displacement => self.displacement(ifs).map(Deform::Displacement),
            _ => self.code_change(by),
        }
    }

    fn interval(&self) -> Result<Interval, String> {
        let place = |place: Option<u64>, key| {
            place
                .map(|place| place as usize)
                .ok_or(format!("`{key}` is needed: a place of the codes, 1 or more"))
        };
        Ok(Interval { from: place(self.from, "from")?, to: place(self.to, "to")? })
    }

    fn code_change(&self, by: By) -> Result<Deform, String> {
        let interval = self.interval()?;
        Ok(Deform::Codes(match by {
            By::Swap => Box::new(Swap { interval, between: self.digits([1, 2])? }),
            By::Insertion => Box::new(Insertion { interval, digit: self.digits([0])?[0] }),
            By::Replacement => {
                let [digit, with] = self.digits([2, 0])?;
                Box::new(Replacement { interval, digit, with })
            }
            By::Reversal => Box::new(Reversal(interval)),
            _ => Box::new(Permutation(interval)),
        }))
    }

    /// So many digits, or those of the source.
    fn digits<const N: usize>(&self, usual: [u8; N]) -> Result<[u8; N], String> {
        if self.digits.is_empty() {
            return Ok(usual);
        }
        if self.digits.iter().any(|digit| digit.fract() != 0.0) {
            return Err(format!("`digits` is {:?}, but digits are whole numbers", self.digits));
        }
        let digits: Vec<u8> = self.digits.iter().map(|&digit| digit as u8).collect();
        let wrong = |digits: Vec<u8>| format!("`digits` has {} digits, but must have {N}", digits.len());
        digits.try_into().map_err(wrong)
    }

    fn frame(&self, ifs: &Ifs) -> Frame {
        match self.units {
            Units::Square => Frame::of(ifs),
            Units::Own => Frame::UNIT,
        }
    }

    fn field(&self, ifs: &Ifs) -> Result<Field, String> {
        let frame = self.frame(ifs);
        let along = [("along_x", &self.along_x), ("along_y", &self.along_y), ("along_z", &self.along_z)];
        if along.iter().all(|(_, numbers)| numbers.is_empty()) {
            return Ok(Field::of_the_source(self.amplitude, frame));
        }
        let polynomial = |(key, numbers): (&str, &Vec<f64>)| {
            Polynomial::of(numbers).map_err(|fault| format!("`{key}`: {fault}"))
        };
        let [x, y, z] = along;
        Ok(Field { along: [polynomial(x)?, polynomial(y)?, polynomial(z)?], frame })
    }

    fn displacement(&self, ifs: &Ifs) -> Result<Displacement, String> {
        let vectors = self.displacement_vectors(ifs.maps().len())?;
        Ok(Displacement { interval: self.interval()?, delta: self.delta, vectors, frame: self.frame(ifs) })
    }

    fn displacement_vectors(&self, maps: usize) -> Result<Vec<[f64; 3]>, String> {
        let numbers = self.vectors.len();
        if numbers == 0 {
            return Ok(Displacement::OF_THE_SOURCE.to_vec());
        }
        if numbers == 2 * maps {
            return Ok(self.vectors.chunks_exact(2).map(|pair| [pair[0], pair[1], 0.0]).collect());
        }
        if numbers == 3 * maps {
            return Ok(self.vectors.chunks_exact(3).map(|three| [three[0], three[1], three[2]]).collect());
        }
        Err(format!(
            "`vectors` has {numbers} numbers; {maps} maps need {} (x and y each) or {} (x, y and z)",
            2 * maps,
            3 * maps
        ))
    }

    fn part(&self, ifs: &Ifs) -> Result<Part, String> {
        if self.part.is_empty() {
            return Err("`part` is needed: the code of the part that moves, as 113".to_owned());
        }
        let prefix = Code::parse(ifs.digits(), &self.part).map_err(|fault| format!("`part`: {fault}"))?;
        let turned = Part::turned(prefix, self.angle_deg.to_radians(), self.factor);
        let rows = |side: usize| {
            let mut linear = [[0.0, 0.0, 0.0], [0.0, 0.0, 0.0], [0.0, 0.0, 1.0]];
            for (row, numbers) in linear.iter_mut().zip(self.linear.chunks_exact(side)) {
                row[..side].copy_from_slice(numbers);
            }
            Part { prefix, linear }
        };
        match self.linear.len() {
            0 => Ok(turned),
            4 => Ok(rows(2)),
            9 => Ok(rows(3)),
            count => Err(format!("`linear` has {count} numbers; a linear map has 4 in 2D and 9 in 3D")),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ifs::{Deformation, shapes};

    #[test]
    fn what_is_absent_is_as_in_the_source() {
        let ifs = shapes::find("gasket").expect("built in").ifs();
        let code = Code::parse(ifs.digits(), "012012").expect("digits");
        let keys = |by| DeformKeys { by: Some(by), from: Some(2), to: Some(3), ..DeformKeys::default() };
        let changed = |by| {
            let deform = keys(by).of(&ifs).expect("complete");
            Deformation::new(&ifs, vec![deform]).expect("fits").code(&code).to_string()
        };
        assert_eq!(changed(By::Permutation), "020012");
        assert_eq!(changed(By::Swap), "021012");
        assert_eq!(changed(By::Insertion), "0102012");
        assert_eq!(changed(By::Replacement), "010012");
        assert_eq!(changed(By::Reversal), "021012");
    }

    #[test]
    fn what_does_not_fit_is_told() {
        let ifs = shapes::find("gasket").expect("built in").ifs();
        let fault = |keys: DeformKeys| keys.of(&ifs).expect_err("a fault");
        let swap = DeformKeys { by: Some(By::Swap), from: Some(1), to: Some(2), ..DeformKeys::default() };
        assert!(fault(DeformKeys::default()).starts_with("`by` is needed"));
        assert!(fault(DeformKeys { to: None, ..swap.clone() }).starts_with("`to` is needed"));
        assert!(
            fault(DeformKeys { digits: vec![1.0], ..swap.clone() }).contains("1 digits, but must have 2")
        );
        assert!(fault(DeformKeys { digits: vec![1.0, 0.5], ..swap }).contains("whole numbers"));
        let part = DeformKeys { by: Some(By::Part), part: "03".to_owned(), ..DeformKeys::default() };
        assert!(fault(part).starts_with("`part`: 3 is no digit"));
    }
}
