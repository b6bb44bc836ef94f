//! What pictures are drawn onto: light in 16-bit floats and depth, with samples, and light without.

use weald::Error;
use wgpu::{
    Color, CommandEncoder, LoadOp, Operations, RenderPass, RenderPassColorAttachment,
    RenderPassDepthStencilAttachment, RenderPassDescriptor, RenderPassTimestampWrites, StoreOp,
    TextureFormat, TextureUsages,
};

use super::options::Options;
use super::textures::{Canvas, Shape};
use super::timing::{Timer, Timestamp};
use crate::gpu::Gpu;

/// Format of light.
pub(super) const LIGHT: TextureFormat = TextureFormat::Rgba16Float;

/// Format of depth.
pub(super) const DEPTH: TextureFormat = TextureFormat::Depth32Float;

/// What kinds of ground are cleared to: that of what something else hides, as `ground.wgsl` has it.
pub(super) const HIDDEN: u32 = 19;

/// Depth between two kinds.
const KIND: f32 = 1.0 / 32.0;

/// Format of kinds by number.
pub(super) const NUMBERS: TextureFormat = TextureFormat::R8Uint;

/// What kinds are before they are drawn, as depths and by number.
const CLEARED_KINDS: LoadOp<f32> = LoadOp::Clear(HIDDEN as f32 * KIND);
const CLEARED_NUMBERS: Color = Color { r: HIDDEN as f64, g: 0.0, b: 0.0, a: 0.0 };

/// What nothing drew on: no light of a landscape.
const MAGENTA: Color = Color { r: 0.1, g: 0.0, b: 0.1, a: 0.0 };

/// What clouds are where none are drawn, as `clouds_before.wgsl` has it.
const NO_CLOUDS_DRAWN: Color = Color { r: 0.0, g: 0.0, b: 0.0, a: -1.0 };

/// The canvases of a picture.
#[derive(Debug)]
pub(super) struct Targets {
    /// Of what is nearest, and of the ground alone.
    pub(super) depth: Canvas,
    pub(super) ground: Canvas,
    /// Of which kind the ground of each sample is, as a depth, and of a pixel of one sample by number.
    kinds: Canvas,
    pub(super) numbers: Canvas,
    /// The light of clouds before the sky, in half as many columns and rows.
    pub(super) clouds: Canvas,
    /// With samples; `None` where a pixel has one.
    pub(super) sampled: Option<Canvas>,
    /// Without.
    pub(super) light: Canvas,
}

impl Targets {
    pub(super) fn new(gpu: &Gpu, options: Options) -> Result<Self, Error> {
        let Options { size, samples } = options;
        let attachment = TextureUsages::RENDER_ATTACHMENT;
        let seen = TextureUsages::TEXTURE_BINDING;
        let copied = TextureUsages::COPY_SRC;
        let depth = Shape { samples, ..Shape::flat(size, DEPTH, attachment | seen | copied) };
        // An attachment as well, as all textures with samples must be.
        let usage = attachment | seen | copied | TextureUsages::COPY_DST;
        let ground = Shape { samples, ..Shape::flat(size, DEPTH, usage) };
        let kinds = Shape { samples, ..Shape::flat(size, DEPTH, attachment) };
        // Pixels of several samples have none.
        let numbers = Shape::flat(if samples > 1 { [1; 2] } else { size }, NUMBERS, attachment | seen);
        let sampled = Shape { samples, ..Shape::flat(size, LIGHT, attachment) };
        let light = Shape::flat(size, LIGHT, attachment | seen | copied);
        let clouds = Shape::flat(size.map(|side| side.div_ceil(2)), LIGHT, attachment | seen | copied);
        Ok(Self {
            depth: Canvas::new(gpu, "depth", depth)?,
            ground: Canvas::new(gpu, "depth of the ground", ground)?,
            kinds: Canvas::new(gpu, "kinds of ground", kinds)?,
            numbers: Canvas::new(gpu, "kinds of ground by number", numbers)?,
            clouds: Canvas::new(gpu, "light of clouds", clouds)?,
            sampled: if samples > 1 { Some(Canvas::new(gpu, "light with samples", sampled)?) } else { None },
            light: Canvas::new(gpu, "light", light)?,
        })
    }

    /// The pass that draws the depths of the ground.
    pub(super) fn depth_pass<'a>(&self, encoder: &'a mut CommandEncoder) -> RenderPass<'a> {
        encoder.begin_render_pass(&RenderPassDescriptor {
            label: Some("depths"),
            depth_stencil_attachment: Some(depths(&self.depth, LoadOp::Clear(0.0), StoreOp::Store)),
            ..RenderPassDescriptor::default()
        })
    }

    /// Keeps the depths of the ground, before others hide them.
    pub(super) fn keep_ground(&self, encoder: &mut CommandEncoder) {
        let whole = self.depth.texture.size();
        encoder.copy_texture_to_texture(
            self.depth.texture.as_image_copy(),
            self.ground.texture.as_image_copy(),
            whole,
        );
    }

    /// The pass that draws light of the picture before, with the kind of pixels that have it.
    pub(super) fn reprojection_pass<'a>(&self, encoder: &'a mut CommandEncoder) -> RenderPass<'a> {
        let attachment = self.light(Operations { load: LoadOp::Load, store: StoreOp::Store }, false);
        encoder.begin_render_pass(&RenderPassDescriptor {
            depth_stencil_attachment: Some(depths(&self.kinds, CLEARED_KINDS, StoreOp::Store)),
            ..described("reprojection", &[Some(attachment)], None)
        })
    }

    /// The pass that draws of which kind the ground is by number, where it has none yet from the picture before.
    pub(super) fn number_pass<'a>(&self, encoder: &'a mut CommandEncoder, has_some: bool) -> RenderPass<'a> {
        let load = if has_some { LoadOp::Load } else { CLEARED_KINDS };
        let ops = Operations { load: LoadOp::Clear(CLEARED_NUMBERS), store: StoreOp::Store };
        let view = &self.numbers.view;
        let attachment = RenderPassColorAttachment { view, depth_slice: None, resolve_target: None, ops };
        encoder.begin_render_pass(&RenderPassDescriptor {
            depth_stencil_attachment: Some(depths(&self.kinds, load, StoreOp::Discard)),
            ..described("kinds by number", &[Some(attachment)], None)
        })
    }

    /// The pass that draws of which kind each sample is.
    pub(super) fn kind_pass<'a>(&self, encoder: &'a mut CommandEncoder) -> RenderPass<'a> {
        encoder.begin_render_pass(&RenderPassDescriptor {
            label: Some("kinds"),
            depth_stencil_attachment: Some(depths(&self.kinds, CLEARED_KINDS, StoreOp::Store)),
            ..RenderPassDescriptor::default()
        })
    }

    /// The pass that draws the light of the ground.
    pub(super) fn ground_pass<'a>(&self, encoder: &'a mut CommandEncoder) -> RenderPass<'a> {
        self.pass_by_kinds(encoder, "ground", false)
    }

    /// The pass that draws what lies behind it, the last.
    pub(super) fn backdrop_pass<'a>(&self, encoder: &'a mut CommandEncoder) -> RenderPass<'a> {
        self.pass_by_kinds(encoder, "backdrop", true)
    }

    /// A pass that draws the light of pixels of some kinds.
    fn pass_by_kinds<'a>(
        &self,
        encoder: &'a mut CommandEncoder,
        label: &'static str,
        is_last: bool,
    ) -> RenderPass<'a> {
        let attachment = self.light(Operations { load: LoadOp::Load, store: StoreOp::Store }, is_last);
        let store = if is_last { StoreOp::Discard } else { StoreOp::Store };
        encoder.begin_render_pass(&RenderPassDescriptor {
            depth_stencil_attachment: Some(depths(&self.kinds, LoadOp::Load, store)),
            ..described(label, &[Some(attachment)], None)
        })
    }

    /// The pass that draws the light of clouds.
    pub(super) fn cloud_pass<'a>(&self, encoder: &'a mut CommandEncoder) -> RenderPass<'a> {
        let ops = Operations { load: LoadOp::Clear(NO_CLOUDS_DRAWN), store: StoreOp::Store };
        let attachment = RenderPassColorAttachment {
            view: &self.clouds.view,
            depth_slice: None,
            resolve_target: None,
            ops,
        };
        encoder.begin_render_pass(&described("clouds", &[Some(attachment)], None))
    }

    /// The pass that draws the light of cut sides, the first of a picture.
    pub(super) fn walls_pass<'a>(&self, encoder: &'a mut CommandEncoder) -> RenderPass<'a> {
        let ops = Operations { load: LoadOp::Clear(MAGENTA), store: StoreOp::Store };
        let attachment = self.light(ops, false);
        encoder.begin_render_pass(&RenderPassDescriptor {
            depth_stencil_attachment: Some(depths(&self.depth, LoadOp::Load, StoreOp::Store)),
            ..described("walls", &[Some(attachment)], None)
        })
    }

    /// The pass that draws the light of what grows.
    pub(super) fn growth_pass<'a>(
        &self,
        encoder: &'a mut CommandEncoder,
        timer: Option<&Timer>,
    ) -> RenderPass<'a> {
        let attachment = self.light(Operations { load: LoadOp::Load, store: StoreOp::Store }, false);
        let writes = timer.map(|timer| timer.around(Timestamp::Plants, [true; 2]));
        encoder.begin_render_pass(&RenderPassDescriptor {
            depth_stencil_attachment: Some(depths(&self.depth, LoadOp::Load, StoreOp::Store)),
            ..described("what grows", &[Some(attachment)], writes)
        })
    }

    /// Where light is drawn, and the samples of a pixel are brought together or not yet.
    fn light(&self, ops: Operations<Color>, is_last: bool) -> RenderPassColorAttachment<'_> {
        let (view, resolve_target) = match &self.sampled {
            Some(sampled) => (&sampled.view, is_last.then_some(&self.light.view)),
            None => (&self.light.view, None),
        };
        RenderPassColorAttachment { view, depth_slice: None, resolve_target, ops }
    }
}

fn depths(canvas: &Canvas, load: LoadOp<f32>, store: StoreOp) -> RenderPassDepthStencilAttachment<'_> {
    let depth_ops = Some(Operations { load, store });
    RenderPassDepthStencilAttachment { view: &canvas.view, depth_ops, stencil_ops: None }
}

fn described<'a>(
    label: &'a str,
    color_attachments: &'a [Option<RenderPassColorAttachment<'a>>],
    timestamp_writes: Option<RenderPassTimestampWrites<'a>>,
) -> RenderPassDescriptor<'a> {
    RenderPassDescriptor {
        label: Some(label),
        color_attachments,
        timestamp_writes,
        ..RenderPassDescriptor::default()
    }
}
