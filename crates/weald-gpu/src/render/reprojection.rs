//! Light of ground and clouds that a window's picture before has, taken for the next one: reverse reprojection (Nehab, Sander,
//! Lawrence, Tatarchuk and Isidoro 2007, "Accelerating Real-Time Shading with Reverse Reprojection Caching").
//!
//! The light of ground depends on the eye by haze, detail and gloss alone, which change slowly; the point of a pixel is known
//! from its depth, and so is where the picture before had it. From there its light is taken, between four pixels, unless the
//! depth of the ground there was another one or the light is older than some pictures; where something grew before it, from the
//! nearest ground beside it of that depth. One block of pixels in eight is lit anew by turns, of a camera at rest one in
//! four, so that little light is older than that, and a camera that has stood still for that long has the picture that is lit anew
//! as a whole ([`super::screen::Screen::is_settled`]). Clouds are taken from where their lower part was seen
//! (`clouds_before.wgsl`).
//!
//! What differs from the source: due pixels are blocks by turns, not random ones, because devices light blocks; ground that
//! something hid is not always lit anew, because among blades nearly all of it comes and goes; and water that is close by is
//! always, because it flows. Pictures that come back, and films, are lit anew as a whole: they are the
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
use super::targets::Targets;
use super::textures::{Canvas, Shape};
use crate::gpu::Gpu;

/// Bindings of the light, the depths and the clouds of the picture before.
const LIGHT_BEFORE: u32 = 6;
const DEPTHS_BEFORE: u32 = 7;
const CLOUDS_BEFORE: u32 = 9;

/// The kind of pixels that are lit by the picture before, which nothing lights anew.
const REPROJECTED: u32 = 20;

/// Turns in which all pixels are lit anew, as the shader has them, and fewer of them for a camera at rest.
const TURNS: u32 = 8;
const TURNS_AT_REST: u32 = TURNS / 2;

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
pub(super) struct ReprojectionPipelines {
    pub(super) ground: RenderPipeline,
    /// `None` where there are none.
    pub(super) clouds: Option<RenderPipeline>,
    pub(super) layouts: ReprojectionLayouts,
}

/// The layouts of the depths of a picture with what is kept of the one before: of its ground, and of its clouds.
#[derive(Clone, Debug)]
pub(super) struct ReprojectionLayouts {
    pub(super) ground: BindGroupLayout,
    pub(super) clouds: BindGroupLayout,
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
    clouds: Canvas,
    ground_group: BindGroup,
    clouds_group: BindGroup,
}

impl ReprojectionLayouts {
    /// For pictures of one sample: those of several take nothing.
    pub(super) fn new(gpu: &Gpu) -> Self {
        let depths = depths_entry(1, ShaderStages::FRAGMENT);
        let front = BindGroupLayoutEntry { binding: FRONT_BINDING, ..depths };
        let ty = BindingType::Texture {
            sample_type: TextureSampleType::Float { filterable: false },
            view_dimension: TextureViewDimension::D2,
            multisampled: false,
        };
        let light = BindGroupLayoutEntry { binding: LIGHT_BEFORE, ty, ..depths };
        let depths_before = BindGroupLayoutEntry { binding: DEPTHS_BEFORE, ..depths };
        let clouds = BindGroupLayoutEntry { binding: CLOUDS_BEFORE, ty, ..depths };
        let layout = |entries: &[_]| {
            let description = BindGroupLayoutDescriptor { label: Some("the picture before"), entries };
            gpu.context.device.create_bind_group_layout(&description)
        };
        Self {
            ground: layout(&[depths, front, light, depths_before]),
            clouds: layout(&[depths, front, clouds]),
        }
    }
}

impl Reprojection {
    /// The picture before, where the one of a moment may take light from it. Makes room for what is kept of that one.
    ///
    /// # Errors
    /// [`Error::Device`] where the device's memory does not suffice.
    pub(super) fn begin(
        &mut self,
        gpu: &Gpu,
        (layouts, targets): (&ReprojectionLayouts, &Targets),
        now: &Moment,
    ) -> Result<Option<PictureBefore>, Error> {
        if self.kept.is_none() {
            self.kept = Some(Kept::new(gpu, layouts, targets)?);
        }
        self.turn = (self.turn + 1) % TURNS;
        // Where this picture is not drawn to its end, the next one is lit anew.
        let before = self.before.take().filter(|before| before.lights(now));
        let rests = before.is_some_and(|before| before.camera == now.camera);
        let turns = if rests { TURNS_AT_REST } else { TURNS };
        self.unsettled = match before {
            None => 0,
            Some(_) if rests => self.unsettled.saturating_sub(1),
            Some(_) => TURNS_AT_REST,
        };
        let turn = self.turn % turns;
        Ok(before.map(|before| PictureBefore { camera: before.camera, turn, turns }))
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
        drawn: Option<&ReprojectionPipelines>,
    ) -> bool {
        let Self::Taken(Reprojection { kept: Some(kept), .. }) = self else { return false };
        let Some(drawn) = drawn else { return false };
        let mut pass = targets.reprojection_pass(encoder);
        pass.set_bind_group(0, frame, &[]);
        pass.set_bind_group(DEPTHS_GROUP, &kept.ground_group, &[]);
        pass.set_pipeline(&drawn.ground);
        pass.draw(0..3, REPROJECTED..REPROJECTED + 1);
        true
    }

    /// What draws clouds with those of the picture before, where it may have some.
    pub(super) fn clouds(
        self,
        drawn: Option<&'a ReprojectionPipelines>,
    ) -> Option<(&'a RenderPipeline, &'a BindGroup)> {
        let Self::Taken(Reprojection { kept: Some(kept), .. }) = self else { return None };
        Some((drawn?.clouds.as_ref()?, &kept.clouds_group))
    }

    /// Whether the picture keeps something for the next one.
    pub(super) fn is_kept(self) -> bool {
        !matches!(self, Self::None)
    }

    /// Keeps the light of the ground and its depths for the next picture, once they are drawn.
    pub(super) fn keep(self, encoder: &mut CommandEncoder, targets: &Targets) {
        if let Some(kept) = self.kept() {
            copy(encoder, &targets.light, &kept.light);
            copy(encoder, &targets.ground, &kept.depth);
        }
    }

    /// Keeps the light of clouds, once it is drawn.
    pub(super) fn keep_clouds(self, encoder: &mut CommandEncoder, targets: &Targets) {
        if let Some(kept) = self.kept() {
            copy(encoder, &targets.clouds, &kept.clouds);
        }
    }

    fn kept(self) -> Option<&'a Kept> {
        match self {
            Self::None => None,
            Self::Kept(view) | Self::Taken(view) => view.kept.as_ref(),
        }
    }
}

fn copy(encoder: &mut CommandEncoder, from: &Canvas, into: &Canvas) {
    let (from, into, size) = (&from.texture, &into.texture, from.texture.size());
    encoder.copy_texture_to_texture(from.as_image_copy(), into.as_image_copy(), size);
}

impl Moment {
    /// Whether a picture may take light from the one of this moment.
    fn lights(&self, after: &Self) -> bool {
        (after.seconds - self.seconds).abs() <= LONGEST && after.changes == self.changes
    }
}

impl Kept {
    fn new(gpu: &Gpu, layouts: &ReprojectionLayouts, targets: &Targets) -> Result<Self, Error> {
        let usage = TextureUsages::TEXTURE_BINDING | TextureUsages::COPY_DST;
        let like = |what, canvas: &Canvas| {
            let size = [canvas.texture.width(), canvas.texture.height()];
            Canvas::new(gpu, what, Shape::flat(size, canvas.texture.format(), usage))
        };
        let light = like("light of the picture before", &targets.light)?;
        let depth = like("depths of the ground in the picture before", &targets.ground)?;
        let clouds = like("clouds of the picture before", &targets.clouds)?;
        let group = |layout, before: &[(u32, &Canvas)]| {
            let now = [(DEPTHS_BINDING, &targets.ground), (FRONT_BINDING, &targets.depth)];
            let bound = now.iter().chain(before);
            let entries: Vec<_> = bound
                .map(|&(binding, canvas)| BindGroupEntry {
                    binding,
                    resource: BindingResource::TextureView(&canvas.view),
                })
                .collect();
            let description =
                BindGroupDescriptor { label: Some("the picture before"), layout, entries: &entries };
            gpu.context.device.create_bind_group(&description)
        };
        let ground_group = group(&layouts.ground, &[(LIGHT_BEFORE, &light), (DEPTHS_BEFORE, &depth)]);
        let clouds_group = group(&layouts.clouds, &[(CLOUDS_BEFORE, &clouds)]);
        Ok(Self { light, depth, clouds, ground_group, clouds_group })
    }
}
