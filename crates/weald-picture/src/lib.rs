//! Pictures of a landscape, one file a kind; [`PICTURES`] is the registry.

mod apng;
mod automatic;
mod colour;
mod colour_scale;
mod contours;
mod courses;
mod cut;
mod cutout;
mod digits;
mod drainage;
mod flow_field;
mod font;
pub mod fractal;
mod ground;
mod growth;
mod image;
mod lakes;
mod legend;
mod light;
mod map;
mod materials;
mod paint;
mod perspective;
mod picture;
mod ramp;
mod registry;
mod relief;
mod render;
mod rivers;
mod scene;
mod section;
mod sheet;
mod spline;
mod strokes;
mod texture;
mod ticks;
mod view;

pub use apng::write_apng;
pub use colour::{Linear, Oklab, PAPER, encode, linear_of_hex, linear_of_srgb};
pub use colour_scale::{ColourScale, Drape};
pub use cutout::Cutout;
pub use font::{Pen, blend};
pub use growth::{Growth, GrowthKeys};
pub use image::Image;
pub use map::Map;
pub use materials::Materials;
pub use picture::{Picture, PictureEntry, Watch};
pub use ramp::{Ramp, Scale, Tint};
pub use registry::{PICTURES, find};
pub use relief::{Relief, tinted};
pub use render::{
    CameraPath, Frame, FrameSequence, GrassRate, RayMarched, Render, RenderDevice, RenderKeys, RenderRequest,
    Rendering,
};
pub use section::{Along, Section};
pub use sheet::fits_on_sheet;
pub use strokes::{Point as StrokePoint, Strokes};
pub use view::albedo;
#[doc(hidden)]
pub use view::twin_calls;
pub use view::{
    Around, Camera, Follow, GroundColour, HeightsBeyond, LitScene, Ray, RayMarcher, Rim, SPACING_OF_TREES,
    SceneTexture, TextureKind, Tree, View,
};
