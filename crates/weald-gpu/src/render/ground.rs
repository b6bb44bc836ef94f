//! The ground: first the depths of its triangles, then of which kind each pixel is, then the light of each kind, pixel by
//! pixel (`ground.wgsl`).

use weald::Error;
use wgpu::{
    BindGroup, BindGroupDescriptor, BindGroupEntry, BindGroupLayout, BindGroupLayoutDescriptor,
    BindGroupLayoutEntry, BindingResource, BindingType, CommandEncoder, CompareFunction, Face, RenderPass,
    RenderPipeline, ShaderStages, TextureSampleType, TextureViewDimension,
};

use super::ground_pipelines::Parts;
use super::in_sight::{InSight, Rows};
use super::kinds::{BACKDROP, KindsLight, KindsOf, LIGHTS, LIGHTS_BEYOND, Light, WET_BEYOND};
use super::targets::{HIDDEN, Targets};
use super::terrain::Terrain;
use crate::gpu::Gpu;

/// Group and binding of the depths.
pub(super) const DEPTHS_GROUP: u32 = 2;
pub(super) const DEPTHS_BINDING: u32 = 1;

/// Bindings of the depths of what is nearest, of the light of clouds, and of kinds by number.
pub(super) const FRONT_BINDING: u32 = 4;
const CLOUDS_BINDING: u32 = 5;
const NUMBERS_BINDING: u32 = 8;

/// The groups of depths: alone, with the light of clouds, and with kinds by number.
const ALONE: usize = 0;
const WITH_CLOUDS: usize = 1;
const WITH_NUMBERS: usize = 2;

/// Which bindings are in each: depths of the ground and of what is nearest, clouds, numbers.
const MEMBERS: [&[usize]; 3] = [&[0, 1], &[0, 1, 2], &[0, 1, 3]];

/// How the depths are declared in a shader, for pictures of so many samples.
pub(super) fn declaration(samples: u32) -> String {
    let kind = if samples > 1 { "texture_depth_multisampled_2d" } else { "texture_depth_2d" };
    let declared = |binding, name| format!("@group({DEPTHS_GROUP}) @binding({binding}) var {name}: {kind};");
    declared(DEPTHS_BINDING, "ground_depths") + "\n" + &declared(FRONT_BINDING, "front_depths")
}

/// The binding of depths of so many samples.
pub(super) fn depths_entry(samples: u32, visibility: ShaderStages) -> BindGroupLayoutEntry {
    let ty = BindingType::Texture {
        sample_type: TextureSampleType::Depth,
        view_dimension: TextureViewDimension::D2,
        multisampled: samples > 1,
    };
    BindGroupLayoutEntry { binding: DEPTHS_BINDING, visibility, ty, count: None }
}

/// The layouts of the groups of depths.
pub(super) fn depths_layouts(gpu: &Gpu, samples: u32) -> [BindGroupLayout; 3] {
    let ground = depths_entry(samples, ShaderStages::FRAGMENT);
    let [ty, numbers] =
        [TextureSampleType::Float { filterable: true }, TextureSampleType::Uint].map(|sample_type| {
            BindingType::Texture {
                sample_type,
                view_dimension: TextureViewDimension::D2,
                multisampled: false,
            }
        });
    let entries = [
        ground,
        BindGroupLayoutEntry { binding: FRONT_BINDING, ..ground },
        BindGroupLayoutEntry { binding: CLOUDS_BINDING, ty, ..ground },
        BindGroupLayoutEntry { binding: NUMBERS_BINDING, ty: numbers, ..ground },
    ];
    MEMBERS.map(|members| {
        let entries: Vec<_> = members.iter().map(|&member| entries[member]).collect();
        let description = BindGroupLayoutDescriptor { label: Some("depths"), entries: &entries[..] };
        gpu.context.device.create_bind_group_layout(&description)
    })
}

/// The groups of depths of a picture.
pub(super) fn depths_groups(gpu: &Gpu, layouts: &[BindGroupLayout; 3], targets: &Targets) -> [BindGroup; 3] {
    let bound = [
        (DEPTHS_BINDING, &targets.ground),
        (FRONT_BINDING, &targets.depth),
        (CLOUDS_BINDING, &targets.clouds),
        (NUMBERS_BINDING, &targets.numbers),
    ];
    let entries = bound.map(|(binding, canvas)| {
        let resource = BindingResource::TextureView(&canvas.view);
        BindGroupEntry { binding, resource }
    });
    [ALONE, WITH_CLOUDS, WITH_NUMBERS].map(|which| {
        let entries = MEMBERS[which].iter().map(|&member| entries[member].clone()).collect::<Vec<_>>();
        let (layout, entries) = (&layouts[which], &entries[..]);
        let description = BindGroupDescriptor { label: Some("depths"), layout, entries };
        gpu.context.device.create_bind_group(&description)
    })
}

/// Triangles that are not drawn from above the ground, since others hide them: those that are seen from below.
const HIDDEN_FACES: [Option<Face>; 2] = [Some(Face::Back), None];

/// The pipelines of the ground.
#[derive(Debug)]
pub(super) struct Ground {
    /// From above the ground, and from anywhere.
    depth: [RenderPipeline; 2],
    beyond: Option<[RenderPipeline; 2]>,
    /// What draws kinds by number; `None` where pixels have several samples.
    number: Option<RenderPipeline>,
    kind: RenderPipeline,
    /// The light of clouds, and what draws it before all else; `None` where there are none.
    clouds: Option<[RenderPipeline; 2]>,
    /// What finds water beyond the border, far away and close by; `None` where kinds tell it.
    wet_beyond: Option<[RenderPipeline; 2]>,
    lights: Vec<KindsLight>,
    backdrop: [RenderPipeline; 2],
}

impl Ground {
    /// Compiles all, that of light side by side: each takes seconds on some drivers.
    pub(super) fn new(parts: Parts<'_>) -> Result<Self, Error> {
        let (backdrop, lights) = Self::lights(parts)?;
        Ok(Self {
            depth: HIDDEN_FACES.map(|hidden| parts.depth("ground_vertex", hidden)),
            beyond: parts
                .has
                .horizon
                .then(|| HIDDEN_FACES.map(|hidden| parts.depth("beyond_vertex", hidden))),
            number: (parts.samples == 1).then(|| parts.number()),
            kind: parts.kind(),
            wet_beyond: (parts.has.horizon && parts.samples == 1)
                .then(|| [true, false].map(|is_far| parts.wet_beyond(is_far))),
            clouds: parts.has.clouds.then(|| [parts.clouds(), parts.clouds_over()]),
            lights,
            backdrop,
        })
    }

    /// The light of what lies behind the landscape, and that of each kind of ground.
    fn lights(parts: Parts<'_>) -> Result<([RenderPipeline; 2], Vec<KindsLight>), Error> {
        let around: &'static [Light] = if parts.has.horizon { &LIGHTS_BEYOND } else { &[] };
        let samples = parts.samples;
        let lights: Vec<_> = KindsOf::all(&LIGHTS, samples).chain(KindsOf::all(around, samples)).collect();
        // What is seen from close by may be drawn as what is far away: one pipeline, compiled once.
        let wanted = |of: &KindsOf<'_>| (of.light.fragment, of.is_behind, of.drawn(samples).0);
        let is_first = |at: usize| lights[..at].iter().all(|of| wanted(of) != wanted(&lights[at]));
        let distinct: Vec<_> = (0..lights.len()).filter(|&at| is_first(at)).map(|at| lights[at]).collect();
        let mut works: Vec<Box<dyn Fn() -> RenderPipeline + Sync>> = vec![
            Box::new(move || parts.sky(&BACKDROP[0])),
            Box::new(move || parts.light(&BACKDROP[1], false, CompareFunction::Equal)),
        ];
        works.extend(distinct.iter().map(|of| {
            let make = move || parts.light(of.light, of.is_behind, of.drawn(samples).0);
            Box::new(make) as Box<dyn Fn() -> _ + Sync>
        }));
        let mut made = parts.context.side_by_side("making the pipelines of light", &works)?.into_iter();
        let backdrop = [made.next(), made.next()].map(|made| made.expect("as many as were asked for"));
        let made: Vec<_> = distinct.iter().map(wanted).zip(made).collect();
        let pipeline_of = |of: &KindsOf<'_>| {
            let (_, pipeline) = made.iter().find(|(drawn, _)| *drawn == wanted(of)).expect("all were made");
            pipeline.clone()
        };
        let lights = lights.iter().map(|of| of.with(pipeline_of(of), samples)).collect();
        Ok((backdrop, lights))
    }

    /// Draws the depths of all triangles.
    pub(super) fn draw_depths(&self, pass: &mut RenderPass<'_>, terrain: &Terrain) {
        let which = usize::from(!terrain.is_seen_from_above());
        pass.set_pipeline(&self.depth[which]);
        terrain.draw_ground(pass, 0);
        if let Some(beyond) = &self.beyond {
            pass.set_pipeline(&beyond[which]);
            terrain.draw_beyond(pass, 0);
        }
    }

    /// Draws the light of clouds where they are in sight; nothing where there are none.
    pub(super) fn draw_clouds(&self, pass: &mut RenderPass<'_>, depths: &BindGroup) {
        if let Some([clouds, _]) = &self.clouds {
            draw_whole(pass, clouds, depths);
        }
    }

    /// Whether a picture has clouds.
    pub(super) fn has_clouds(&self, in_sight: InSight) -> bool {
        self.clouds.is_some() && (in_sight.backdrop[0].are_some() || in_sight.is_over_clouds)
    }

    /// Draws the kind of each sample; of pixels of one sample first the number of those that are not lit, where the picture before
    /// has lit some.
    pub(super) fn draw_kinds(
        &self,
        encoder: &mut CommandEncoder,
        (targets, depths, has_some): (&Targets, &[BindGroup; 3], bool),
        groups: [&BindGroup; 2],
        in_sight: InSight,
    ) {
        if let Some(number) = &self.number {
            let mut pass = targets.number_pass(encoder, has_some);
            bind(&mut pass, groups);
            pass.set_bind_group(DEPTHS_GROUP, &depths[ALONE], &[]);
            pass.set_pipeline(number);
            pass.draw(0..3, HIDDEN..HIDDEN + 1);
        }
        let mut pass = targets.kind_pass(encoder);
        bind(&mut pass, groups);
        draw_whole(&mut pass, &self.kind, &depths[WITH_NUMBERS]);
        let wet = self.wet_beyond.iter().flatten().zip(WET_BEYOND).zip([true, in_sight.is_near]);
        for ((pipeline, kinds), _) in wet.filter(|(_, is_seen)| *is_seen) {
            pass.set_pipeline(pipeline);
            pass.draw(0..3, kinds);
        }
    }

    /// Draws the light of every pixel that has a depth.
    pub(super) fn draw_light(&self, pass: &mut RenderPass<'_>, depths: &BindGroup, in_sight: InSight) {
        pass.set_bind_group(DEPTHS_GROUP, depths, &[]);
        for light in self.lights.iter().filter(|light| in_sight.is_near || !light.is_near) {
            pass.set_pipeline(&light.pipeline);
            pass.set_blend_constant(light.ages);
            pass.draw(0..3, light.kinds.clone());
        }
    }

    /// Draws the light of every pixel that has none, from the depths with the light of clouds and without, and clouds that are
    /// before all.
    pub(super) fn draw_backdrop(
        &self,
        pass: &mut RenderPass<'_>,
        (depths, size): (&[BindGroup; 3], [u32; 2]),
        in_sight: InSight,
    ) {
        for (which, rows) in in_sight.backdrop.into_iter().enumerate() {
            if rows.are_some() {
                pass.set_bind_group(DEPTHS_GROUP, &depths[1 - which], &[]);
                pass.set_pipeline(&self.backdrop[which]);
                rows.limit(pass, size);
                pass.draw(0..3, BACKDROP[which].kinds[0].clone());
            }
        }
        if let Some([_, over]) = self.clouds.as_ref().filter(|_| in_sight.is_over_clouds) {
            Rows::ALL.limit(pass, size);
            pass.set_bind_group(DEPTHS_GROUP, &depths[1], &[]);
            pass.set_pipeline(over);
            pass.draw(0..3, 0..1);
        }
    }
}

/// Draws all of a picture by a pipeline and what it has of the picture.
pub(super) fn draw_whole(pass: &mut RenderPass<'_>, pipeline: &RenderPipeline, group: &BindGroup) {
    pass.set_bind_group(DEPTHS_GROUP, group, &[]);
    pass.set_pipeline(pipeline);
    pass.draw(0..3, 0..1);
}

/// Binds what all that is drawn has in common.
pub(super) fn bind(pass: &mut RenderPass<'_>, groups: [&BindGroup; 2]) {
    for (at, group) in (0..).zip(groups) {
        pass.set_bind_group(at, group, &[]);
    }
}
