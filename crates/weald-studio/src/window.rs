//! The window of the system.

use eframe::egui::ViewportBuilder;
use eframe::{CreationContext, NativeOptions};
use weald::Error;

use crate::options::Options as StudioOptions;
use crate::studio::Studio;
use crate::viewport;

/// Opens the studio, and returns when it is closed.
///
/// # Errors
/// [`Error::Run`] where the system has no window or no driver that draws, with what to install; those of opening what it
/// begins with.
pub fn open(what: StudioOptions) -> Result<(), Error> {
    show(move |context| Studio::of(context, what.clone()))
}

/// Shows what is made in a window of the system, and returns when it is closed.
pub(crate) fn show<A: eframe::App + 'static>(
    made: impl FnOnce(&CreationContext<'_>) -> Result<A, Error>,
) -> Result<(), Error> {
    let options = NativeOptions {
        viewport: ViewportBuilder::default()
            .with_title("Weald")
            .with_app_id("weald")
            .with_inner_size([1280.0, 800.0])
            .with_min_inner_size([640.0, 420.0])
            .with_drag_and_drop(true),
        ..viewport::options()
    };
    let made = |context: &CreationContext<'_>| Ok(Box::new(made(context)?) as Box<dyn eframe::App>);
    eframe::run_native("weald", options, Box::new(made)).map_err(|cause| {
        let remedy = "the studio needs a desktop (X11 or Wayland) and a Vulkan, Metal or Direct3D 12 driver; on Debian or \
                      Ubuntu `sudo apt-get install mesa-vulkan-drivers libvulkan1` brings one that runs anywhere";
        Error::Run(format!("the window cannot be opened: {cause}; {remedy}"))
    })
}
