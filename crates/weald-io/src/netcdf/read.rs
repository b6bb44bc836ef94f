//! Numbers out of a file whose header is known to be within it.

use super::super::cf::{self, Attributes, Described, Source};
use super::super::{Fault, Limits, Raster};
use super::header::{Header, Variable};
use super::kind::CHARACTER;

/// Reads the layer of a file; see [`NetCDF`](super).
///
/// # Errors
/// [`Fault`] for a file that is damaged, of a kind that is not read, or over the limits.
pub fn decode(bytes: &[u8], limits: Limits) -> Result<Raster, Fault> {
    let header = Header::of(bytes)?;
    let described = header.variables.iter().map(|variable| describe(&header, variable)).collect();
    cf::read(&File { bytes, header, described }, limits)
}

/// A file and its header.
struct File<'a> {
    bytes: &'a [u8],
    header: Header,
    described: Vec<Described>,
}

fn describe(header: &Header, variable: &Variable) -> Described {
    let dimensions = || variable.dimensions.iter().map(|axis| &header.dimensions[*axis]);
    Described {
        name: variable.name.clone(),
        dimensions: dimensions().map(|dimension| dimension.name.clone()).collect(),
        shape: dimensions().map(|dimension| dimension.length).collect(),
        attributes: variable.attributes.clone(),
        stored: variable.kind.number.name,
        is_number: variable.kind.code != CHARACTER,
        default_fill: variable.kind.fill,
    }
}

impl Source for File<'_> {
    fn attributes(&self) -> &Attributes {
        &self.header.attributes
    }

    fn variables(&self) -> &[Described] {
        &self.described
    }

    fn each(&self, described: &Described, take: &mut dyn FnMut(usize, f64)) -> Result<(), Fault> {
        let found = self.header.variables.iter().find(|variable| variable.name == described.name);
        let variable = found.expect("descriptions are made from the header");
        let length = variable.record * variable.kind.number.bytes;
        for record in 0..variable.records {
            let begin = (variable.begin + variable.stride * record as u64) as usize;
            let numbers = self.bytes[begin..][..length].chunks_exact(variable.kind.number.bytes);
            for (index, bytes) in numbers.enumerate() {
                take(record * variable.record + index, variable.kind.value(bytes));
            }
        }
        Ok(())
    }
}
