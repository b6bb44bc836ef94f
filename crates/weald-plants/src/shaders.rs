//! The registry of shaders that plants and grass run on a device.

use crate::ifs::shader::Shader;
use crate::{grass, ifs};

/// All shaders of plants.
pub const SHADERS: [Shader; 4] = [ifs::device::PLAY, ifs::wind::SWAY, grass::device::GROW, ifs::limbs::BEND];
