//! What draws the landscape in the window, whatever it draws with.

use std::time::Duration;

use eframe::egui::{Context, TextureId};
use weald::Error;
use weald::engine::Engine;
use weald::picture::{Camera, Image, View};

use crate::work::{Shown, Surface};

/// Seconds that a click may take on software, where what a hand does is seen only after a picture.
const LONGEST_CLICK: f64 = 5.0;

/// Has a click be one however long the picture takes that is drawn between its beginning and its end.
pub(crate) fn allow_slow_clicks(context: &Context) {
    context.options_mut(|options| options.input_options.max_click_duration = LONGEST_CLICK);
}

/// Draws the landscape of the window. Nothing waits for a picture.
pub(crate) trait Drawing {
    /// Where simulations run: on a graphics card where there is one.
    fn engine(&self) -> Engine;

    /// Whether software draws, which is slow.
    fn is_software(&self) -> bool;

    /// Name of what draws.
    fn device(&self) -> String;

    /// Seconds that the last picture took.
    fn seconds(&self) -> f64;

    /// What stands against drawing.
    fn error(&self) -> Option<String>;

    /// Notes what stands against it.
    fn fail(&mut self, error: &Error);

    /// Waits until all that was submitted is drawn, which only a measurement does.
    #[cfg(not(target_arch = "wasm32"))]
    fn wait(&self) {}

    /// Orders the scene of a landscape with looks of this number, unless it is the one that was ordered last.
    fn order(&mut self, shown: &Shown, looks: (&View, u64), is_live: bool);

    /// Keeps a landscape in these looks, to compare what is shown with; `None` lets it go.
    fn pin(&mut self, kept: Option<(&Shown, View)>);

    /// Takes a scene that was made meanwhile.
    fn take_built(&mut self);

    /// The camera that shows the landscape whole.
    fn whole(&self) -> Option<Camera>;

    /// The point in the middle of the landscape.
    fn middle(&self) -> Option<[f32; 3]>;

    /// Height at which an elevation is drawn.
    fn drawn_height(&self, elevation: f64) -> Option<f32>;

    /// Shows ground and water as a simulation has left them.
    fn follow(&mut self, surface: &Surface) -> Result<(), Error>;

    /// Draws what the camera sees, for a place of so many pixels, where that is not yet drawn. Gives how long until it
    /// should be asked again.
    fn draw(&mut self, camera: &Camera, full: [u32; 2]) -> Result<Option<Duration>, Error>;

    /// Whether the scene of this number is drawn, as finely as it will be.
    fn is_drawn(&self, number: Option<(u64, u64)>) -> bool;

    /// The last picture; `None` before the first.
    fn texture(&self) -> Option<TextureId>;

    /// The last picture of what was pinned, where something is.
    fn pinned_texture(&self) -> Option<TextureId>;

    /// Whether something is kept to compare with.
    fn has_pinned(&self) -> bool;

    /// A picture of its own size, for a file.
    fn picture(&mut self, camera: &Camera, size: [u32; 2]) -> Result<Option<Image>, Error>;
}
