//! `.flame` files, in which flam3, Apophysis and their relatives keep iterated function systems: their affine part.
//!
//! An `xform` of flam3 is `x → P(Σ w_v V_v(C x))`, with a map `C` (`coefs`), variations `V_v` with weights, and a map `P`
//! (`post`). Where the only variation is `linear`, it is the affine map `P (w C)`. Six numbers a d b e c f of `coefs` mean
//! `(a x + b y + c, d x + e y + f)`. Sources: Draves and Reckase 2003, "The fractal flame algorithm"; flam3 3.1.1,
//! `parser.c` and `flam3.c`, for what files hold and mean.
//!
//! In a flame `y` grows downwards, here upwards: reading and writing turn it round, so that a picture stays upright.
//! `weight`s are divided by their sum. A `finalxform`, which moves points where they are drawn, is a change of units of
//! all maps. Symmetries do not contract, but what they draw does: see `symmetry.rs`.
//!
//! What differs: colours, camera, motion and filters of a file are not read, and those that are written are our own.
//! What no affine map can say (other variations, `chaos`, hidden xforms) is refused.

mod element;
mod symmetry;
#[cfg(test)]
mod tests;
mod write;
mod xform;

use std::path::Path;

use roxmltree::{Document, Node, ParsingOptions};

use self::element::Element;
use self::symmetry::Share;
use self::xform::Xform;
use super::code::MAX_MAPS;
use super::map::Map;
use super::system::{Draft, Ifs, IfsFault, Role, Weighted};
use weald_core::error::{Error, Limit, Quantity};
use weald_io::{Fault, read_at_most};

pub use self::write::{Frame, write};

/// Longest file that is read, in bytes.
pub const MAX_BYTES: u64 = 16 << 20;

/// Most elements, texts and comments of a file.
const MAX_NODES: u32 = 1 << 18;

/// Most flames of a file.
pub const MAX_FLAMES: usize = 4096;

/// Reads all flames of a file, in its order. Maps have no [`Role`] but the usual one, for a file has no place for it.
///
/// # Errors
/// [`Error::Input`] for a file that is missing, damaged, or says what affine maps cannot; [`Error::Limit`] for one
/// that is too large.
pub fn read(path: &Path) -> Result<Vec<Ifs>, Error> {
    read_at_most(path, MAX_BYTES).and_then(|bytes| parse(&bytes)).map_err(|fault| fault.of(path))
}

/// The flames of a file's bytes, in UTF-8.
///
/// # Errors
/// A [`Fault`] that names line, element and attribute, and what is legal.
pub fn parse(bytes: &[u8]) -> Result<Vec<Ifs>, Fault> {
    each_flame(bytes, |flame, number| {
        let (draft, parts) = drafted(flame, number)?;
        Ifs::new(draft).map_err(|fault| parts.located(flame, &fault))
    })
}

/// The same, as fractals that are not yet checked: whether their maps contract, and how far they reach, may take much longer
/// to find than reading them does.
///
/// # Errors
/// As [`parse`], but for what a check finds.
pub fn drafts(bytes: &[u8]) -> Result<Vec<Draft>, Fault> {
    each_flame(bytes, |flame, number| drafted(flame, number).map(|(draft, _)| draft))
}

/// What becomes of each flame with its number from 1.
fn each_flame<T>(
    bytes: &[u8],
    mut read: impl FnMut(Element<'_>, usize) -> Result<T, Fault>,
) -> Result<Vec<T>, Fault> {
    if bytes.len() as u64 > MAX_BYTES {
        return Err(Limit::new(Quantity::FileBytes, bytes.len() as u64, 0..=MAX_BYTES).into());
    }
    let text = std::str::from_utf8(bytes)
        .map_err(|cause| Fault::damaged(format!("is not UTF-8 text: {cause}; save it as UTF-8")))?;
    // Without a document type there are no entities that could unfold into gigabytes.
    let options = ParsingOptions { allow_dtd: false, nodes_limit: MAX_NODES, ..ParsingOptions::default() };
    let document = Document::parse_with_options(text, options).map_err(|cause| unreadable(&cause))?;
    let flames = flames(&document)?;
    flames.iter().enumerate().map(|(number, &flame)| read(Element::of(flame), number + 1)).collect()
}

fn unreadable(cause: &roxmltree::Error) -> Fault {
    match cause {
        roxmltree::Error::NodesLimitReached => {
            Limit::new(Quantity::Elements, None, 0..=MAX_NODES.into()).into()
        }
        roxmltree::Error::DtdDetected => {
            Fault::damaged("has a document type (`<!DOCTYPE …>`), which no flame needs; take it out")
        }
        cause => Fault::damaged(format!("is not well-formed XML: {cause}")),
    }
}

/// All outermost `flame` elements, at whatever depth.
fn flames<'a>(document: &'a Document<'_>) -> Result<Vec<Node<'a, 'a>>, Fault> {
    let is_flame = |node: &Node<'_, '_>| node.has_tag_name("flame");
    let outermost = |node: &Node<'_, '_>| !node.ancestors().skip(1).any(|above| is_flame(&above));
    let flames: Vec<_> =
        document.descendants().filter(is_flame).filter(outermost).take(MAX_FLAMES + 1).collect();
    match flames.len() {
        0 => Err(Fault::damaged("has no `<flame>` element; a flame file holds at least one")),
        1..=MAX_FLAMES => Ok(flames),
        _ => Err(Limit::new(Quantity::Flames, None, 0..=MAX_FLAMES as u64).into()),
    }
}

/// One flame as a fractal that is to be checked, and what it is made of.
fn drafted(flame: Element<'_>, number: usize) -> Result<(Draft, Parts<'_>), Fault> {
    if flame.number("soloxform")?.is_some_and(|xform| xform >= 0.0) {
        return Err(flame.fault("`soloxform` hides all xforms but one; take it out"));
    }
    let mut parts = Parts::default();
    for element in flame.children() {
        parts.add(element)?;
    }
    let name = match flame.text("name").map(str::trim) {
        Some(name) if !name.is_empty() => name.to_owned(),
        _ => format!("flame-{number}"),
    };
    let shares = symmetry::expanded(&parts.shares()).map_err(|what| flame.fault(&what))?;
    let maps = parts.seen(shares)?;
    Ok((Draft { name, maps, code_digits: None }, parts))
}

/// What a flame is made of.
#[derive(Debug, Default)]
struct Parts<'a> {
    /// Xforms that are taken, those of symmetries among them, each with its element.
    xforms: Vec<(Element<'a>, Xform)>,
    last: Option<(Element<'a>, Xform)>,
}

impl<'a> Parts<'a> {
    fn add(&mut self, element: Element<'a>) -> Result<(), Fault> {
        match element.name() {
            "xform" => self.take(element)?,
            "finalxform" => self.finish(element)?,
            "symmetry" => {
                let maps = symmetry::of_kind(element)?;
                self.xforms.extend(maps.into_iter().map(|map| (element, Xform { map, weight: 1.0 })));
            }
            _ => {}
        }
        if self.xforms.len() > MAX_MAPS {
            return Err(
                element.fault(&format!("the flame has more than {MAX_MAPS} xforms, and no more fit a code"))
            );
        }
        Ok(())
    }

    fn take(&mut self, element: Element<'a>) -> Result<(), Fault> {
        let weight = element.number("weight")?;
        let weight =
            weight.ok_or_else(|| element.fault("it has no `weight`; each xform needs one, of 0 or more"))?;
        if weight < 0.0 {
            return Err(element.fault(&format!("`weight` is {weight}; it must be 0 or more")));
        }
        // What is never taken draws nothing, whatever it is.
        if weight > 0.0 {
            self.xforms.push((element, Xform { map: xform::map(element)?, weight }));
        }
        Ok(())
    }

    fn finish(&mut self, element: Element<'a>) -> Result<(), Fault> {
        if self.last.is_some() {
            return Err(element.fault("it is the second; a flame has at most one"));
        }
        if element.number("opacity")?.is_some_and(|opacity| opacity != 1.0) {
            return Err(element.fault("its `opacity` moves only some of the points; it must be 1"));
        }
        self.last = Some((element, Xform { map: xform::map(element)?, weight: 1.0 }));
        Ok(())
    }

    fn shares(&self) -> Vec<Share> {
        let total: f64 = self.xforms.iter().map(|(_, xform)| xform.weight).sum();
        self.xforms.iter().map(|(_, xform)| Share { map: xform.map, share: xform.weight / total }).collect()
    }

    /// The maps after the final one, if there is one: a point `F x` goes where `F` takes the image of `x`.
    fn seen(&self, shares: Vec<Share>) -> Result<Vec<Weighted>, Fault> {
        let seen = |map: Map| -> Result<Map, Fault> {
            let Some((element, last)) = &self.last else { return Ok(map) };
            let back = xform::inverse(&last.map);
            let back = back.ok_or_else(|| element.fault("it presses the plane flat, and has no inverse"))?;
            Ok(last.map.after(&map).after(&back))
        };
        let weighted = |share: Share| {
            Ok(Weighted { map: seen(share.map)?, probability: share.share, role: Role::default() })
        };
        shares.into_iter().map(weighted).collect()
    }

    /// A fault of the fractal, at the xform that it is about.
    fn located(&self, flame: Element<'a>, fault: &IfsFault) -> Fault {
        let contracting: Vec<_> =
            self.xforms.iter().filter(|(_, xform)| !symmetry::is_isometry(&xform.map)).collect();
        let place = fault.map().filter(|_| !contracting.is_empty());
        let element = place.map_or(flame, |map| contracting[map % contracting.len()].0);
        let sheared = self.last.is_some() && matches!(fault, IfsFault::NotContracting { .. });
        let cause = if sheared { "; a `finalxform` that stretches the shape less may help" } else { "" };
        element.fault(&format!("{fault}{cause}"))
    }
}
