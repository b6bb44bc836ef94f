//! The material that settles.

use weald_core::material::Material;
use weald_core::parameter::{LayerName, nearest};

/// Number of the material that settles: the one named, or the last; else a sentence for the user.
pub(in crate::erode) fn deposit_of(
    name: Option<&LayerName>,
    materials: &[Material],
) -> Result<usize, String> {
    let Some(last) = materials.len().checked_sub(1) else {
        return Err("the landscape has no materials; it needs a bedrock at least".to_owned());
    };
    let Some(LayerName(name)) = name else { return Ok(last) };
    materials.iter().position(|material| material.name == *name).ok_or_else(|| {
        let known: Vec<_> = materials.iter().map(|material| material.name.as_str()).collect();
        let near = nearest(name, &known).map(|near| format!("; did you mean `{near}`?"));
        let near = near.unwrap_or_default();
        format!("`deposit` is {name:?}, but must be a material of the landscape: {}{near}", known.join(", "))
    })
}
