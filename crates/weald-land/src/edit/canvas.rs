//! What a brush works on: the state of a simulation over a rectangle of cells, as plain fields.

use weald_core::grid::{Field, Mask, Size};
use weald_core::material::{BEDROCK, Material};

/// The layer of the mask that is painted by hand.
const PAINTED_MASK: &str = "painted_mask";

/// A rectangle of cells of a landscape.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Area {
    /// Column and row of its north-western cell.
    pub first: [usize; 2],
    /// Columns and rows.
    pub size: Size,
}

/// The state of a simulation over a rectangle of cells; heights, thicknesses and depths in metres.
#[derive(Clone, Debug, PartialEq)]
pub struct Canvas {
    /// Column and row of the north-western cell in the landscape.
    pub first: [usize; 2],
    /// Side of a cell in metres.
    pub cell: f64,
    /// Names of the materials, bedrock first.
    pub materials: Vec<String>,
    /// Cells that a brush may change; `None` where it may change all.
    pub valid: Option<Mask>,
    /// Height of the top of the bedrock.
    pub bedrock: Field,
    /// Thickness of each material above the bedrock, lowest first.
    pub thickness: Vec<Field>,
    /// Depth of the water.
    pub water: Field,
    /// Metres of water that rise in an iteration; a drain is negative.
    pub source: Field,
    /// Factor on the rain.
    pub rain: Field,
    /// 1 where the simulation stands still, else 0.
    pub frozen: Field,
    /// Share, 0 to 1, that strokes leave out: where it is 1, only those change anything that paint the mask itself.
    pub mask: Field,
}

impl Canvas {
    /// Level bedrock at height 0 under the usual rain, without water or any other material.
    pub fn level(area: Area, cell: f64, materials: &[Material]) -> Self {
        let zero = || Field::filled(area.size, 0.0);
        Self {
            first: area.first,
            cell,
            materials: materials.iter().map(|material| material.name.clone()).collect(),
            valid: None,
            bedrock: zero(),
            thickness: materials.iter().skip(1).map(|_| zero()).collect(),
            water: zero(),
            source: zero(),
            rain: Field::filled(area.size, 1.0),
            frozen: zero(),
            mask: zero(),
        }
    }

    /// Columns and rows.
    pub fn size(&self) -> Size {
        self.bedrock.size()
    }

    /// The rectangle of the landscape that it covers.
    pub fn area(&self) -> Area {
        Area { first: self.first, size: self.size() }
    }

    /// A part of the canvas as one of its own; `area` is in cells of the landscape and is cut to the canvas.
    /// `None` where the two do not meet.
    pub fn part(&self, area: Area) -> Option<Self> {
        let area = self.area().shared(area)?;
        let cut = |field: &Field| {
            Field::from_function(area.size, |x, y| field.at(self.x(area, x), self.y(area, y)))
        };
        let flag = |valid: &Mask| {
            let cells = (0..area.size.rows).flat_map(|y| (0..area.size.columns).map(move |x| (x, y)));
            Mask::new(
                area.size,
                cells.map(|(x, y)| valid.is_valid(self.x(area, x), self.y(area, y))).collect(),
            )
        };
        Some(Self {
            first: area.first,
            cell: self.cell,
            materials: self.materials.clone(),
            valid: self.valid.as_ref().and_then(flag),
            bedrock: cut(&self.bedrock),
            thickness: self.thickness.iter().map(cut).collect(),
            water: cut(&self.water),
            source: cut(&self.source),
            rain: cut(&self.rain),
            frozen: cut(&self.frozen),
            mask: cut(&self.mask),
        })
    }

    /// Takes the values of another canvas where the two meet.
    pub fn put(&mut self, part: &Self) {
        let Some(area) = self.area().shared(part.area()) else { return };
        let here = [area.first[0] - self.first[0], area.first[1] - self.first[1]];
        let there = [area.first[0] - part.first[0], area.first[1] - part.first[1]];
        for ((_, mine), (_, other)) in self.fields_mut().zip(part.fields()) {
            for y in 0..area.size.rows {
                let row = &other.row(there[1] + y)[there[0]..there[0] + area.size.columns];
                mine.row_mut(here[1] + y)[here[0]..here[0] + area.size.columns].copy_from_slice(row);
            }
        }
    }

    /// All fields by the names of their layers.
    pub fn fields(&self) -> impl Iterator<Item = (&str, &Field)> {
        let thickness = self.materials.iter().skip(1).map(String::as_str).zip(&self.thickness);
        let others = [
            ("water", &self.water),
            ("source", &self.source),
            ("rain", &self.rain),
            ("frozen", &self.frozen),
            (PAINTED_MASK, &self.mask),
        ];
        std::iter::once((BEDROCK, &self.bedrock)).chain(thickness).chain(others)
    }

    /// All fields by the names of their layers, to be changed.
    pub fn fields_mut(&mut self) -> impl Iterator<Item = (&str, &mut Field)> {
        let thickness = self.materials.iter().skip(1).map(String::as_str).zip(&mut self.thickness);
        let others = [
            ("water", &mut self.water),
            ("source", &mut self.source),
            ("rain", &mut self.rain),
            ("frozen", &mut self.frozen),
            (PAINTED_MASK, &mut self.mask),
        ];
        std::iter::once((BEDROCK, &mut self.bedrock)).chain(thickness).chain(others)
    }

    /// Height of the ground.
    pub fn surface(&self, cell: usize) -> f64 {
        let thickness: f64 = self.thickness.iter().map(|layer| f64::from(layer.values()[cell])).sum();
        f64::from(self.bedrock.values()[cell]) + thickness
    }

    /// Whether a brush may change the cell.
    pub fn is_open(&self, cell: usize) -> bool {
        self.valid.as_ref().is_none_or(|valid| valid.is_valid_at(cell))
    }

    fn x(&self, area: Area, x: usize) -> usize {
        area.first[0] - self.first[0] + x
    }

    fn y(&self, area: Area, y: usize) -> usize {
        area.first[1] - self.first[1] + y
    }
}

impl Area {
    /// The cells that lie in both.
    fn shared(self, other: Self) -> Option<Self> {
        let end = |area: Self| [area.first[0] + area.size.columns, area.first[1] + area.size.rows];
        let axis = |axis: usize| {
            let first = self.first[axis].max(other.first[axis]);
            let end = end(self)[axis].min(end(other)[axis]);
            (first < end).then(|| (first, end - first))
        };
        let ((column, columns), (row, rows)) = axis(0).zip(axis(1))?;
        Some(Self { first: [column, row], size: Size { columns, rows } })
    }
}
