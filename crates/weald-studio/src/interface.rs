//! The interface as it is drawn where software acts as a graphics card.
//!
//! The shader of `egui_wgpu` can filter textures in two ways and decides for each pixel, by divisions of whole numbers.
//! A graphics card jumps over what it does not need; software (Mesa's llvmpipe) works out both sides for all pixels of the
//! window, which takes four fifths of the time of a frame. Here the same triangles are drawn by a shader that looks a texture
//! up and no more. Colours are not dithered.

mod painter;

use std::sync::Arc;

use eframe::egui::epaint::{ClippedShape, Mesh, Primitive};
use eframe::egui::{ClippedPrimitive, Context, FullOutput, PaintCallbackInfo, Plugin, Rect, Shape};
use eframe::egui_wgpu::{Callback, CallbackResources, CallbackTrait, RenderState, ScreenDescriptor};
use eframe::wgpu;

use painter::Painter;

/// Takes the shapes of a frame out of the hands of `egui_wgpu`, and draws them in one callback.
pub(crate) struct Interface {
    window: RenderState,
}

impl Interface {
    /// For the window that is drawn with this.
    pub(crate) fn new(window: &RenderState) -> Self {
        Self { window: window.clone() }
    }

    /// Textures of this frame go to the device now and not after this, so that those that are looked up here are of this frame.
    fn set_textures(&self, output: &mut FullOutput) {
        let mut renderer = self.window.renderer.write();
        for (id, deltas) in output.textures_delta.set.drain() {
            for delta in deltas {
                renderer.update_texture(&self.window.device, &self.window.queue, id, &delta);
            }
        }
    }

    fn piece(&self, primitive: ClippedPrimitive) -> Option<Piece> {
        // The studio paints nothing by callbacks of its own.
        let Primitive::Mesh(mesh) = primitive.primitive else { return None };
        let texture = self.window.renderer.read().texture(&mesh.texture_id)?.bind_group.clone();
        Some(Piece { clip: primitive.clip_rect, mesh, texture })
    }
}

impl Plugin for Interface {
    fn debug_name(&self) -> &'static str {
        "interface on software"
    }

    fn output_hook(&mut self, context: &Context, output: &mut FullOutput) {
        self.set_textures(output);
        let shapes = std::mem::take(&mut output.shapes);
        let pieces = context.tessellate(shapes, output.pixels_per_point);
        let pieces: Vec<_> = pieces.into_iter().filter_map(|primitive| self.piece(primitive)).collect();
        let whole = context.viewport_rect();
        let drawn = Drawn { pieces: Arc::new(pieces), format: self.window.target_format };
        let shape = Shape::Callback(Callback::new_paint_callback(whole, drawn));
        output.shapes.push(ClippedShape::new(whole, shape));
    }
}

/// Triangles with the texture that they show, and the part of the window that they are drawn in.
struct Piece {
    clip: Rect,
    mesh: Mesh,
    texture: wgpu::BindGroup,
}

/// All triangles of a frame.
struct Drawn {
    pieces: Arc<Vec<Piece>>,
    format: wgpu::TextureFormat,
}

impl CallbackTrait for Drawn {
    fn prepare(
        &self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        screen: &ScreenDescriptor,
        _: &mut wgpu::CommandEncoder,
        resources: &mut CallbackResources,
    ) -> Vec<wgpu::CommandBuffer> {
        let painter = resources.entry::<Painter>().or_insert_with(|| Painter::new(device, self.format));
        let points = screen.size_in_pixels.map(|side| side as f32 / screen.pixels_per_point);
        painter.write((device, queue), points, self.pieces.iter().map(|piece| &piece.mesh));
        Vec::new()
    }

    fn paint(
        &self,
        info: PaintCallbackInfo,
        pass: &mut wgpu::RenderPass<'static>,
        resources: &CallbackResources,
    ) {
        let Some(painter) = resources.get::<Painter>() else { return };
        let [width, height] = info.screen_size_px;
        pass.set_viewport(0.0, 0.0, width as f32, height as f32, 0.0, 1.0);
        painter.begin(pass);
        let mut place = Place::default();
        for piece in self.pieces.iter() {
            let next = place.after(&piece.mesh);
            let scissors = scissors(piece.clip, info.pixels_per_point, [width, height]);
            if let Some([left, top, across, down]) = scissors {
                pass.set_scissor_rect(left, top, across, down);
                pass.set_bind_group(1, &piece.texture, &[]);
                pass.draw_indexed(place.index..next.index, place.vertex, 0..1);
            }
            place = next;
        }
    }
}

/// Where the triangles of a piece begin among those of all pieces.
#[derive(Clone, Copy, Default)]
struct Place {
    index: u32,
    vertex: i32,
}

impl Place {
    /// Where those begin that come after this one.
    fn after(self, mesh: &Mesh) -> Self {
        Self {
            index: self.index + mesh.indices.len() as u32,
            vertex: self.vertex + mesh.vertices.len() as i32,
        }
    }
}

/// Left, top, width and height of a rectangle in pixels, as far as it lies in the window; `None` where nothing does.
fn scissors(clip: Rect, pixels_per_point: f32, size: [u32; 2]) -> Option<[u32; 4]> {
    let pixel = |points: f32, most: u32| ((points * pixels_per_point).round().max(0.0) as u32).min(most);
    let [left, right] = [clip.min.x, clip.max.x].map(|x| pixel(x, size[0]));
    let [top, bottom] = [clip.min.y, clip.max.y].map(|y| pixel(y, size[1]));
    (left < right && top < bottom).then(|| [left, top, right - left, bottom - top])
}

#[cfg(test)]
mod tests;
