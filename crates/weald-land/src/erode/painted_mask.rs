//! The mask that is painted on a simulation by hand: no engine knows it, so that it has the same bits on all of them.

use std::sync::Arc;

use crate::edit::{Area, Brush, Canvas};
use weald_core::error::Error;
use weald_core::grid::{Field, Mask, Size};

/// What strokes leave as it is, over the whole landscape; nothing as long as none is painted.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct PaintedMask(Option<Arc<Field>>);

/// What was there before a stroke of the mask.
#[derive(Clone, Debug)]
pub(crate) struct MaskBefore {
    area: Area,
    values: Field,
}

impl MaskBefore {
    pub(crate) fn bytes(&self) -> u64 {
        self.values.values().len() as u64 * size_of::<f32>() as u64
    }
}

impl PaintedMask {
    /// The part of it over a rectangle.
    pub(crate) fn part(&self, area: Area) -> Field {
        let Some(whole) = &self.0 else { return Field::filled(area.size, 0.0) };
        Field::from_function(area.size, |x, y| whole.at(area.first[0] + x, area.first[1] + y))
    }

    /// Paints a stroke of the mask on a landscape of this size; gives what was there before.
    pub(crate) fn stroke(
        &mut self,
        brush: &Brush,
        (size, cell): (Size, f64),
        (area, open): (Area, Option<Mask>),
    ) -> Result<MaskBefore, Error> {
        let values = self.part(area);
        let mut canvas = Canvas { valid: open, mask: values.clone(), ..Canvas::level(area, cell, &[]) };
        brush.paint(&mut canvas)?;
        self.lay(size, area, &canvas.mask);
        Ok(MaskBefore { area, values })
    }

    /// Takes a stroke back.
    pub(crate) fn take_back(&mut self, before: &MaskBefore) {
        if let Some(size) = self.0.as_ref().map(|whole| whole.size()) {
            self.lay(size, before.area, &before.values);
        }
    }

    fn lay(&mut self, size: Size, area: Area, values: &Field) {
        let whole = Arc::make_mut(self.0.get_or_insert_with(|| Arc::new(Field::filled(size, 0.0))));
        for y in 0..area.size.rows {
            let row = &mut whole.row_mut(area.first[1] + y)[area.first[0]..][..area.size.columns];
            row.copy_from_slice(values.row(y));
        }
    }
}
