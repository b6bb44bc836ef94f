//! What a step must have done when it is finished, and what the landscape does after it.

use weald_core::error::{Error, NotFinite};
use weald_core::landscape::Landscape;
use weald_core::material::layer_names;
use weald_core::sea;
use weald_engine::step::{Layered, Step};
use weald_plants::Vegetation;

/// [Checks](check) what a step has written, and lets the sea stand over the ground as it has become.
pub(crate) fn finish(step: &dyn Step, landscape: &mut Landscape) -> Result<(), Error> {
    check(step, landscape)?;
    let changes = step.writes().iter().any(|(name, _)| name == "height" || name == "water");
    if changes { sea::stand(landscape) } else { Ok(()) }
}

/// All layers that a step declares must be there and hold numbers, and all plants and grass must be there.
fn check(step: &dyn Step, landscape: &Landscape) -> Result<(), Error> {
    let valid = landscape.domain.valid.as_ref();
    let mut written: Vec<_> = step.writes().into_iter().map(|(name, _)| name).collect();
    if step.layered() == Layered::Changes {
        written.extend(layer_names(&landscape.materials).map(str::to_owned));
    }
    for name in written {
        let field = landscape.field(&name)?;
        if let Some((x, y)) = field.first_not_finite(valid) {
            let value = field.at(x, y);
            let message =
                format!("layer `{name}` became {value} at column {x}, row {y}; gentler parameters may help");
            let (step, iteration) = (None, None);
            return Err(NotFinite { step, iteration, layer: name, cell: [x, y], message }.into());
        }
    }
    step.plants().iter().try_for_each(|name| landscape.plants(name).map(drop))?;
    step.meadows().iter().try_for_each(|name| landscape.meadow(name).map(drop))
}
