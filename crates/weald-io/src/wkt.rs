//! Well-known text of a coordinate reference system: what it says of units, angles and the ellipsoid.
//!
//! Read are WKT 1 (OGC 01-009), ESRI's dialect of it, and WKT 2 (OGC 18-010r7, ISO 19162). Definitions of EPSG codes come
//! from the crate `crs-definitions`; a build without the feature `wkt` has none.

use std::collections::BTreeMap;
use std::sync::{Mutex, PoisonError};

/// Brackets within brackets; a CRS has some ten.
const MAX_DEPTH: usize = 32;

/// Radians in a degree, within what texts round it to.
const DEGREE: f64 = std::f64::consts::PI / 180.0;

/// The text of an EPSG code, in WKT 1.
#[cfg(feature = "wkt")]
pub(super) fn wkt_of(epsg: u32) -> Option<&'static str> {
    let definition = crs_definitions::from_code(u16::try_from(epsg).ok()?)?;
    (!definition.wkt.is_empty()).then_some(definition.wkt)
}

/// None of any code.
#[cfg(not(feature = "wkt"))]
pub(super) fn wkt_of(_: u32) -> Option<&'static str> {
    None
}

/// The first definition of any code that has a node like `SPHEROID` with that code of its own. All of some thousand texts are
/// looked through once for each code that is asked for.
pub(super) fn definition_with(keyword: &'static str, code: u16) -> Option<Definition> {
    type Found = BTreeMap<(&'static str, u16), Option<Definition>>;
    static FOUND: Mutex<Found> = Mutex::new(Found::new());
    let mut found = FOUND.lock().unwrap_or_else(PoisonError::into_inner);
    found.entry((keyword, code)).or_insert_with(|| first_definition_with(keyword, code)).clone()
}

fn first_definition_with(keyword: &str, code: u16) -> Option<Definition> {
    let (opening, mark) = (format!("{keyword}["), format!("AUTHORITY[\"EPSG\",\"{code}\"]"));
    let candidates = (1..=u32::from(u16::MAX)).filter_map(wkt_of);
    let texts = candidates.filter(|text| text.contains(&opening) && text.contains(&mark));
    texts.filter_map(|text| Some((Node::parse(text)?, text))).find_map(|(node, text)| {
        let found = node.find(&|node| node.keyword == keyword)?;
        (found.code()? == u32::from(code)).then(|| Definition::of(text))?
    })
}

/// The figure of a planet.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Ellipsoid {
    /// In metres.
    pub(super) semi_major: f64,
    /// 0 for a sphere.
    pub(super) inverse_flattening: f64,
}

impl Ellipsoid {
    /// `None` for numbers of no ellipsoid.
    pub(super) fn of(semi_major: f64, inverse_flattening: f64) -> Option<Self> {
        let is_length = semi_major > 0.0 && semi_major.is_finite();
        let is_flattening = inverse_flattening == 0.0 || inverse_flattening > 1.0;
        (is_length && is_flattening).then_some(Self { semi_major, inverse_flattening })
    }
}

/// What the coordinates of a CRS are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    Geographic,
    Projected,
    /// From the centre of the Earth.
    Geocentric,
    /// A grid of its own, or what is not known.
    Other,
}

/// What a text says.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Definition {
    pub(super) kind: Kind,
    /// That of the horizontal part, where heights have a CRS of their own.
    pub(super) epsg: Option<u32>,
    /// Metres in the unit of a projected CRS.
    pub(super) metres: Option<f64>,
    /// Whether angles are in degrees, for a geographic CRS.
    pub(super) is_in_degrees: bool,
    pub(super) ellipsoid: Option<Ellipsoid>,
    /// Metres in the unit of the heights, where the CRS has some.
    pub(super) vertical: Option<f64>,
}

impl Definition {
    /// `None` for what is no WKT of a CRS. A code that the text gives and whose CRS counts otherwise than the text says is not
    /// its own.
    pub(super) fn of(text: &str) -> Option<Self> {
        let said = Self::parse(text)?;
        let epsg = said.epsg.filter(|&code| said.counts_as(code));
        Some(Self { epsg, ..said })
    }

    /// Whether the coordinates are in the unit of those of a code, as far as both tell.
    fn counts_as(&self, epsg: u32) -> bool {
        let Some(known) = wkt_of(epsg).and_then(Self::parse) else { return true };
        let is_same = |one: f64, other: f64| (one / other - 1.0).abs() < 1e-6;
        known.kind == self.kind
            && self.metres.zip(known.metres).is_none_or(|(one, other)| is_same(one, other))
    }

    fn parse(text: &str) -> Option<Self> {
        let root = Node::parse(text)?;
        let crs = root.find(&|node| node.kind().is_some())?;
        let kind = crs.kind()?;
        let geographic = crs.find(&|node| {
            node.kind() == Some(Kind::Geographic)
                || ["BASEGEOGCRS", "BASEGEODCRS"].contains(&node.keyword.as_str())
        });
        let angle = geographic.and_then(|node| node.unit(&["UNIT", "ANGLEUNIT"]));
        let heights =
            root.find(&|node| ["VERT_CS", "VERTCRS", "VERTICALCRS"].contains(&node.keyword.as_str()));
        Some(Self {
            kind,
            epsg: crs.code(),
            metres: crs.unit(&["UNIT", "LENGTHUNIT"]).filter(|_| kind == Kind::Projected),
            is_in_degrees: angle.is_none_or(|radians| (radians / DEGREE - 1.0).abs() < 1e-8),
            ellipsoid: crs.ellipsoid(),
            vertical: heights.and_then(|node| node.unit(&["UNIT", "LENGTHUNIT"])),
        })
    }
}

/// A keyword with what stands in its brackets.
#[derive(Debug)]
struct Node<'a> {
    /// In capitals.
    keyword: String,
    /// Names, numbers and words, without quotation marks.
    values: Vec<&'a str>,
    children: Vec<Self>,
}

impl<'a> Node<'a> {
    fn parse(text: &'a str) -> Option<Self> {
        let (node, _) = Self::parse_at(text.trim_start(), 0)?;
        Some(node)
    }

    /// A node at the beginning of a text, and what follows it.
    fn parse_at(text: &'a str, depth: usize) -> Option<(Self, &'a str)> {
        let (keyword, mut rest) = text.split_at(text.find(['[', '('])?);
        let keyword = keyword.trim().to_ascii_uppercase();
        let is_word = !keyword.is_empty() && keyword.bytes().all(|b| b.is_ascii_alphanumeric() || b == b'_');
        if depth > MAX_DEPTH || !is_word {
            return None;
        }
        let mut node = Self { keyword, values: Vec::new(), children: Vec::new() };
        loop {
            // An opening bracket or a comma.
            rest = rest[1..].trim_start();
            rest = node.take(rest, depth)?.trim_start();
            match rest.bytes().next()? {
                b',' => {}
                b']' | b')' => return Some((node, &rest[1..])),
                _ => return None,
            }
        }
    }

    /// Takes one value or child; gives what follows it.
    fn take(&mut self, text: &'a str, depth: usize) -> Option<&'a str> {
        if let Some(quoted) = text.strip_prefix('"') {
            let (value, rest) = quoted.split_once('"')?;
            self.values.push(value);
            return Some(rest);
        }
        let end = text.find([',', '[', ']', '(', ')'])?;
        if ["[", "("].iter().any(|opening| text[end..].starts_with(opening)) {
            let (child, rest) = Self::parse_at(text, depth + 1)?;
            self.children.push(child);
            return Some(rest);
        }
        self.values.push(text[..end].trim());
        Some(&text[end..])
    }

    /// The first node in the order of the text that is so.
    fn find(&self, is_so: &dyn Fn(&Self) -> bool) -> Option<&Self> {
        if is_so(self) {
            return Some(self);
        }
        self.children.iter().find_map(|child| child.find(is_so))
    }

    fn child(&self, keywords: &[&str]) -> Option<&Self> {
        self.children.iter().find(|child| keywords.contains(&child.keyword.as_str()))
    }

    fn number(&self, position: usize) -> Option<f64> {
        self.values.get(position)?.parse().ok()
    }

    /// The code of EPSG: `AUTHORITY["EPSG","32616"]` or `ID["EPSG",32616]`.
    fn code(&self) -> Option<u32> {
        let authority = self.child(&["AUTHORITY", "ID"])?;
        (*authority.values.first()? == "EPSG").then(|| authority.values.get(1)?.parse().ok())?
    }

    /// What kind of CRS a node is; `None` for one that is none or only holds others.
    fn kind(&self) -> Option<Kind> {
        let is_cartesian = || {
            let system = self.child(&["CS"]).and_then(|node| node.values.first());
            system.is_some_and(|kind| kind.eq_ignore_ascii_case("cartesian"))
        };
        match self.keyword.as_str() {
            "PROJCS" | "PROJCRS" | "PROJECTEDCRS" => Some(Kind::Projected),
            "GEODCRS" | "GEODETICCRS" if is_cartesian() => Some(Kind::Geocentric),
            "GEOGCS" | "GEOGCRS" | "GEOGRAPHICCRS" | "GEODCRS" | "GEODETICCRS" => Some(Kind::Geographic),
            "GEOCCS" => Some(Kind::Geocentric),
            "LOCAL_CS" | "ENGCRS" | "ENGINEERINGCRS" => Some(Kind::Other),
            _ => None,
        }
    }

    /// The size of the unit: of the CRS as a whole, or of its first axis that has one.
    fn unit(&self, keywords: &[&str]) -> Option<f64> {
        let of_axis = || self.children.iter().filter(|child| child.keyword == "AXIS");
        let unit = self.child(keywords).or_else(|| of_axis().find_map(|axis| axis.child(keywords)));
        unit?.number(1).filter(|size| *size > 0.0 && size.is_finite())
    }

    fn ellipsoid(&self) -> Option<Ellipsoid> {
        let node = self.find(&|node| ["SPHEROID", "ELLIPSOID"].contains(&node.keyword.as_str()))?;
        let metres = node.child(&["LENGTHUNIT"]).and_then(|unit| unit.number(1)).unwrap_or(1.0);
        Ellipsoid::of(node.number(1)? * metres, node.number(2)?)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(text: &str) -> Definition {
        Definition::of(text).unwrap_or_else(|| panic!("{text} is WKT"))
    }

    #[test]
    fn old_and_new_texts_say_the_same_of_a_projected_crs() {
        let old = "PROJCS[\"x\",GEOGCS[\"y\",DATUM[\"z\",SPHEROID[\"GRS 1980\",6378137,298.257222101]],\
                   UNIT[\"degree\",0.0174532925199433]],UNIT[\"US survey foot\",0.304800609601219],\
                   AUTHORITY[\"EPSG\",\"2264\"]]";
        let new = "PROJCRS[\"x\",BASEGEOGCRS[\"y\",DATUM[\"z\",ELLIPSOID[\"GRS 1980\",6378137,298.257222101,\
                   LENGTHUNIT[\"metre\",1]]]], CONVERSION[\"c\",METHOD[\"m\"]], CS[Cartesian,2],\
                   AXIS[\"easting (X)\",east,LENGTHUNIT[\"US survey foot\",0.304800609601219]],ID[\"EPSG\",2264]]";
        assert_eq!(of(old), of(new));
        assert_eq!((of(old).kind, of(old).epsg), (Kind::Projected, Some(2264)));
        assert_eq!(of(old).metres, Some(0.304_800_609_601_219));
        assert_eq!(of(old).ellipsoid, Ellipsoid::of(6_378_137.0, 298.257_222_101));
    }

    #[test]
    fn degrees_are_told_from_grads_and_from_the_centre_of_the_earth() {
        let degrees = of("GEOGCS[\"a\",UNIT[\"Degree\",0.017453292519943295]]");
        assert!(degrees.kind == Kind::Geographic && degrees.is_in_degrees);
        let grads = of("GEOGCRS[\"NTF (Paris)\",CS[ellipsoidal,2],AXIS[\"lat\",north],ANGLEUNIT[\"grad\",\
                        0.015707963267949],ID[\"EPSG\",4807]]");
        assert!(grads.kind == Kind::Geographic && !grads.is_in_degrees);
        assert_eq!(of("GEODCRS[\"c\",CS[Cartesian,3],LENGTHUNIT[\"metre\",1]]").kind, Kind::Geocentric);
        assert_eq!(of("GEOCCS[\"c\",UNIT[\"metre\",1]]").kind, Kind::Geocentric);
        assert_eq!(of("LOCAL_CS[\"c\",UNIT[\"metre\",1]]").kind, Kind::Other);
    }

    #[test]
    fn a_compound_says_both_of_its_parts() {
        let compound =
            of("COMPD_CS[\"both\",GEOGCS[\"a\",UNIT[\"degree\",0.0174532925199433],AUTHORITY[\"EPSG\",\
                           \"4269\"]],VERT_CS[\"NAVD88\",VERT_DATUM[\"d\",2005],UNIT[\"foot\",0.3048]]]");
        assert_eq!((compound.kind, compound.vertical), (Kind::Geographic, Some(0.3048)));
        assert_eq!(compound.epsg, Some(4269));
    }

    #[test]
    fn what_is_no_text_of_a_crs_is_none_and_brackets_do_not_pile_up() {
        for text in [
            "",
            "hello",
            "PROJCS",
            "PROJCS[",
            "PROJCS[\"a",
            "GEOGCS[\"a\"",
            "1[2]",
            "UNIT[\"m\",1]",
            "GEOGCS[é]é[",
        ] {
            assert_eq!(
                Definition::of(text).map(|it| it.kind).filter(|_| !text.contains('é')),
                None,
                "{text}"
            );
        }
        assert_eq!(Definition::of(&"A[".repeat(100_000)), None);
    }

    #[test]
    #[cfg(feature = "wkt")]
    fn every_definition_of_a_code_is_understood() {
        let mut kinds = [0; 4];
        for code in 1..=u32::from(u16::MAX) {
            let Some(text) = wkt_of(code) else { continue };
            let Some(definition) = Definition::of(text) else {
                assert!(text.starts_with("VERT_CS") || text.starts_with("FITTED_CS"), "{code}: {text}");
                continue;
            };
            assert!(definition.epsg.is_some() || text.starts_with("BOUNDCRS"), "{code}: {text}");
            kinds[definition.kind as usize] += 1;
        }
        assert!(kinds[0] > 400 && kinds[1] > 4000, "{kinds:?}");
        assert!(
            definition_with("SPHEROID", 7022).expect("Hayford").ellipsoid
                == Ellipsoid::of(6_378_388.0, 297.0)
        );
        assert_eq!(definition_with("VERT_CS", 6360).expect("in feet").vertical, Some(0.304_800_609_601_219));
    }
}
