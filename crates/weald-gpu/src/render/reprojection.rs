//! Light of the ground that a window's picture before has, taken for the next one: reverse reprojection (Nehab, Sander,
//! Lawrence, Tatarchuk and Isidoro 2007, "Accelerating Real-Time Shading with Reverse Reprojection Caching").
//!
//! The light of ground depends on the eye by haze, detail and gloss alone, which change slowly; the point of a pixel is known
//! from its depth, and so is where the picture before had it. From there its light is taken, between four pixels, unless its
//! depth there was another one, something grew before it, or the light is older than some pictures. One block of pixels in
//! four is lit anew by turns, so that no light is older than that, and a camera that has stood still for that long has the
//! picture that is lit anew as a whole ([`super::screen::Screen::is_settled`]).
//!
//! What differs from the source: due pixels are blocks by turns, not random ones, because devices light blocks; and water that
//! is close by is always lit anew, because it flows. Pictures that come back, and films, are lit anew as a whole: they are the
//! same whatever was drawn before.

use weald::Error;
use weald::picture::Camera;
use wgpu::{
    BindGroup, BindGroupDescriptor, BindGroupEntry, BindGroupLayout, BindGroupLayoutDescriptor,
    BindGroupLayoutEntry, BindingResource, BindingType, CommandEncoder, RenderPipeline, ShaderStages,
    TextureSampleType, TextureUsages, TextureViewDimension,
};

use super::frame::PictureBefore;
use super::ground::{DEPTHS_BINDING, DEPTHS_GROUP, FRONT_BINDING, depths_entry};
use super::targets::{DEPTH, LIGHT, Targets};
use super::textures::{Canvas, Shape};
use crate::gpu::Gpu;

/// Bindings of the light and the depths of the picture before.
const LIGHT_BEFORE: u32 = 6;
const DEPTHS_BEFORE: u32 = 7;

/// Turns in which all pixels are lit anew.
const TURNS: u32 = 4;

/// Longest time in seconds between two pictures of which one takes light from the other: clouds' shadows move on meanwhile.
const LONGEST: f32 = 2.0;

/// What the light of a picture hangs on.
#[derive(Clone, Copy, Debug)]
pub(super) struct Moment {
    pub(super) camera: Camera,
    /// How often the scene had changed by then.
    pub(super) changes: u64,
    pub(super) seconds: f32,
}

/// What draws the light of the picture before.
#[derive(Debug)]
pub(super) struct ReprojectionPipeline {
    pub(super) pipeline: RenderPipeline,
    pub(super) layout: BindGroupLayout,
}

/// What a view keeps of its last picture.
#[derive(Debug, Default)]
pub(super) struct Reprojection {
    kept: Option<Kept>,
    before: Option<Moment>,
    turn: u32,
    /// How many pictures later all light is that of the camera of the last one, if it stands still.
    unsettled: u32,
}

#[derive(Debug)]
struct Kept {
    light: Canvas,
    depth: Canvas,
    group: BindGroup,
}

/// The layout of the depths of a picture and of what is kept of the one before.
pub(super) fn reprojection_layout(gpu: &Gpu) -> BindGroupLayout {
    let depths = depths_entry(1, ShaderStages::FRAGMENT);
    let ty = BindingType::Texture {
        sample_type: TextureSampleType::Float { filterable: false },
        view_dimension: TextureViewDimension::D2,
        multisampled: false,
    };
    let entries = [
        depths,
        BindGroupLayoutEntry { binding: FRONT_BINDING, ..depths },
        BindGroupLayoutEntry { binding: LIGHT_BEFORE, ty, ..depths },
        BindGroupLayoutEntry { binding: DEPTHS_BEFORE, ..depths },
    ];
    let description = BindGroupLayoutDescriptor { label: Some("the picture before"), entries: &entries };
    gpu.context.device.create_bind_group_layout(&description)
}

impl Reprojection {
    /// The picture before, where the one of a moment may take light from it. Makes room for what is kept of that one.
    ///
    /// # Errors
    /// [`Error::Device`] where the device's memory does not suffice.
    pub(super) fn begin(
        &mut self,
        gpu: &Gpu,
        (layout, targets): (&BindGroupLayout, &Targets),
        now: &Moment,
    ) -> Result<Option<PictureBefore>, Error> {
        if self.kept.is_none() {
            self.kept = Some(Kept::new(gpu, layout, targets)?);
        }
        self.turn = (self.turn + 1) % TURNS;
        // Where this picture is not drawn to its end, the next one is lit anew.
        let before = self.before.take().filter(|before| before.lights(now));
        self.unsettled = match &before {
            None => 0,
            Some(before) if before.camera == now.camera => self.unsettled.saturating_sub(1),
            Some(_) => TURNS,
        };
        Ok(before.map(|before| PictureBefore { camera: before.camera, turn: self.turn }))
    }

    /// Whether the last picture is as one that is lit anew as a whole.
    pub(super) fn is_settled(&self) -> bool {
        self.unsettled == 0
    }

    /// Says what was drawn: the next picture may take light from it.
    pub(super) fn end(&mut self, now: Moment) {
        self.before = Some(now);
    }
}

/// What a picture has to do with the light of others.
#[derive(Clone, Copy, Debug)]
pub(super) enum LightBefore<'a> {
    /// Nothing.
    None,
    /// It keeps its own for the next one.
    Kept(&'a Reprojection),
    /// It takes some from the one before, and keeps its own.
    Taken(&'a Reprojection),
}

impl<'a> LightBefore<'a> {
    /// Of a picture of a view, which is a window's or comes back, and may take some or not.
    pub(super) fn of(view: &'a Reprojection, is_of_window: bool, takes: bool) -> Self {
        match (is_of_window, takes) {
            (false, _) => Self::None,
            (true, false) => Self::Kept(view),
            (true, true) => Self::Taken(view),
        }
    }

    /// Draws what light the picture before has, into that of this one and the kinds of its pixels; whether it may have some.
    pub(super) fn take(
        self,
        encoder: &mut CommandEncoder,
        (targets, frame): (&Targets, &BindGroup),
        drawn: Option<&ReprojectionPipeline>,
    ) -> bool {
        let Self::Taken(Reprojection { kept: Some(kept), .. }) = self else { return false };
        let Some(drawn) = drawn else { return false };
        let mut pass = targets.reprojection_pass(encoder);
        pass.set_bind_group(0, frame, &[]);
        pass.set_bind_group(DEPTHS_GROUP, &kept.group, &[]);
        pass.set_pipeline(&drawn.pipeline);
        pass.draw(0..3, 0..1);
        true
    }

    /// Keeps the light of the ground and the depths for the next picture, once they are drawn.
    pub(super) fn keep(self, encoder: &mut CommandEncoder, targets: &Targets) {
        let (Self::Kept(Reprojection { kept: Some(kept), .. })
        | Self::Taken(Reprojection { kept: Some(kept), .. })) = self
        else {
            return;
        };
        for (from, into) in [(&targets.light, &kept.light), (&targets.depth, &kept.depth)] {
            let (from, into, size) = (&from.texture, &into.texture, from.texture.size());
            encoder.copy_texture_to_texture(from.as_image_copy(), into.as_image_copy(), size);
        }
    }
}

impl Moment {
    /// Whether a picture may take light from the one of this moment.
    fn lights(&self, after: &Self) -> bool {
        (after.seconds - self.seconds).abs() <= LONGEST && after.changes == self.changes
    }
}

impl Kept {
    fn new(gpu: &Gpu, layout: &BindGroupLayout, targets: &Targets) -> Result<Self, Error> {
        let size = [targets.light.texture.width(), targets.light.texture.height()];
        let usage = TextureUsages::TEXTURE_BINDING | TextureUsages::COPY_DST;
        let light = Canvas::new(gpu, "light of the picture before", Shape::flat(size, LIGHT, usage))?;
        let depth = Canvas::new(gpu, "depths of the picture before", Shape::flat(size, DEPTH, usage))?;
        let bound = [
            (DEPTHS_BINDING, &targets.ground),
            (FRONT_BINDING, &targets.depth),
            (LIGHT_BEFORE, &light),
            (DEPTHS_BEFORE, &depth),
        ];
        let entries = bound.map(|(binding, canvas)| BindGroupEntry {
            binding,
            resource: BindingResource::TextureView(&canvas.view),
        });
        let description =
            BindGroupDescriptor { label: Some("the picture before"), layout, entries: &entries };
        let group = gpu.context.device.create_bind_group(&description);
        Ok(Self { light, depth, group })
    }
}
