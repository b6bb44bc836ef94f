use eframe::egui::{self, Color32, ColorImage, TextureHandle, TextureOptions, Ui};
use eframe::egui_wgpu::RendererOptions;
use egui_kittest::Harness;
use egui_kittest::wgpu::{WgpuTestRenderer, create_render_state};

use super::Interface;
use crate::viewport::device_setup;

/// Text, frames, lines, transparent and textured parts, and something that is cut off.
fn contents(ui: &mut Ui, texture: &mut Option<TextureHandle>) {
    let image = || ColorImage::new([4, 2], (0..8).map(|step| Color32::from_gray(30 * step)).collect());
    let texture =
        texture.get_or_insert_with(|| ui.ctx().load_texture("steps", image(), TextureOptions::LINEAR));
    ui.heading("Recipe");
    let _ = ui.button("Undo");
    let _ = ui.checkbox(&mut true, "Draw water");
    ui.add(egui::Slider::new(&mut 0.25, 0.0..=1.0).text("Strength"));
    ui.image((texture.id(), egui::vec2(90.0, 50.0)));
    ui.colored_label(Color32::from_rgba_unmultiplied(200, 40, 10, 90), "not quite there");
    egui::ScrollArea::vertical().max_height(30.0).show(ui, |ui| {
        for line in 0..20 {
            ui.label(format!("line {line} of a list that is cut off"));
        }
    });
}

/// A picture of the contents by `egui_wgpu`, or by what is tested.
fn picture(is_ours: bool) -> Vec<u8> {
    let options = RendererOptions { dithering: false, ..RendererOptions::default() };
    let state = create_render_state(device_setup(), options);
    let interface = Interface::new(&state);
    let mut texture = None;
    let mut harness = Harness::builder()
        .with_size([320.0, 240.0])
        .with_pixels_per_point(1.25)
        .renderer(WgpuTestRenderer::from_render_state(state))
        .build_ui(move |ui| contents(ui, &mut texture));
    if is_ours {
        harness.ctx.add_plugin(interface);
    }
    harness.run_steps(4);
    harness.render().expect("a picture").into_raw()
}

#[test]
fn the_interface_looks_as_egui_draws_it() {
    let [theirs, ours] = [false, true].map(picture);
    assert_eq!(theirs.len(), ours.len());
    let most = theirs.iter().zip(&ours).map(|(one, other)| one.abs_diff(*other)).max();
    assert!(most <= Some(2), "a colour differs by {most:?} of 255");
    let flat = theirs.chunks(4).filter(|pixel| *pixel == &theirs[..4]).count();
    assert!(flat < theirs.len() / 4 * 95 / 100, "there is something to be seen");
}
