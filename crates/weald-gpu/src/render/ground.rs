//! The ground: first the depths of its triangles, then of which kind each pixel is, then the light of each kind, pixel by
//! pixel (`ground.wgsl`).

use std::ops::Range;

use weald::Error;
use weald::picture::Camera;
use wgpu::{
    BindGroup, BindGroupDescriptor, BindGroupEntry, BindGroupLayout, BindGroupLayoutDescriptor,
    BindGroupLayoutEntry, BindingResource, BindingType, Color, Face, RenderPass, RenderPipeline,
    ShaderStages, TextureSampleType, TextureViewDimension,
};

use super::ground_pipelines::{Light, Over, Parts};
use super::targets::Targets;
use super::terrain::Terrain;
use crate::gpu::Gpu;

/// Group and binding of the depths.
pub(super) const DEPTHS_GROUP: u32 = 2;
pub(super) const DEPTHS_BINDING: u32 = 1;

/// Bindings of the depths of what is nearest, of the light of clouds, and of the light that is drawn by then.
pub(super) const FRONT_BINDING: u32 = 4;
const CLOUDS_BINDING: u32 = 5;
const LIGHT_BINDING: u32 = 8;

/// The groups of depths: alone, with the light of clouds, and with the light that is drawn by then.
const ALONE: usize = 0;
const WITH_CLOUDS: usize = 1;
const WITH_LIGHT: usize = 2;

/// Which bindings are in each: depths of the ground and of what is nearest, clouds, light.
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
    let ty = BindingType::Texture {
        sample_type: TextureSampleType::Float { filterable: true },
        view_dimension: TextureViewDimension::D2,
        multisampled: false,
    };
    let entries = [
        ground,
        BindGroupLayoutEntry { binding: FRONT_BINDING, ..ground },
        BindGroupLayoutEntry { binding: CLOUDS_BINDING, ty, ..ground },
        BindGroupLayoutEntry { binding: LIGHT_BINDING, ty, ..ground },
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
        (LIGHT_BINDING, &targets.light),
    ];
    let entries = bound.map(|(binding, canvas)| {
        let resource = BindingResource::TextureView(&canvas.view);
        BindGroupEntry { binding, resource }
    });
    [ALONE, WITH_CLOUDS, WITH_LIGHT].map(|which| {
        let entries = MEMBERS[which].iter().map(|&member| entries[member].clone()).collect::<Vec<_>>();
        let (layout, entries) = (&layouts[which], &entries[..]);
        let description = BindGroupDescriptor { label: Some("depths"), layout, entries };
        gpu.context.device.create_bind_group(&description)
    })
}

/// In the order in which they are drawn, with the kinds as `ground.wgsl` numbers them.
const LIGHTS: [Light; 3] = [
    Light { fragment: "far_fragment", kinds: [9..11, NONE], over: Over::Nothing },
    Light { fragment: "near_fragment", kinds: [NONE, 11..13], over: Over::Nothing },
    Light { fragment: "water_fragment", kinds: [10..11, 11..12], over: Over::Flowing },
];

/// The same of the ground beyond the border, and of what it fades into.
const LIGHTS_BEYOND: [Light; 4] = [
    Light { fragment: "far_beyond_fragment", kinds: [1..3, NONE], over: Over::Nothing },
    Light { fragment: "near_beyond_fragment", kinds: [NONE, 25..27], over: Over::Nothing },
    Light { fragment: "water_beyond_fragment", kinds: WET_BEYOND, over: Over::Flowing },
    Light { fragment: "farthest_fragment", kinds: [1..3, 25..27], over: Over::Still },
];

/// What lies behind the landscape.
const BACKDROP: [Light; 2] = [
    Light { fragment: "sky_fragment", kinds: [17..18, NONE], over: Over::Nothing },
    Light { fragment: "plain_fragment", kinds: [18..19, NONE], over: Over::Nothing },
];

/// No kinds, and those of water beyond the border.
const NONE: Range<u32> = 0..0;
const WET_BEYOND: [Range<u32>; 2] = [2..3, 25..26];

/// Triangles that are not drawn from above the ground, since others hide them: those that are seen from below.
const HIDDEN: [Option<Face>; 2] = [Some(Face::Back), None];

/// How much further the kinds behind edges are numbered, as the shader has it.
const BEHIND_EDGE: u32 = 4;

/// Footprint in metres of a pixel from which on no ground is seen from close by, as `detail.wgsl` has it.
const DETAIL_FROM: f32 = 0.30;

/// What becomes of the opacity of ground under water, which says whether the next picture takes its light.
const STAYS: Color = Color::WHITE;
const FORGOTTEN: Color = Color::TRANSPARENT;

/// The kinds that a light draws, far away and close by, behind edges or not.
fn kinds_of(light: &Light, is_behind: bool) -> [Range<u32>; 2] {
    let further = if is_behind { BEHIND_EDGE } else { 0 };
    light
        .kinds
        .clone()
        .map(|kinds| if kinds.is_empty() { kinds } else { kinds.start + further..kinds.end + further })
}

/// What a camera may see at all: what it does not see costs a look at each pixel.
#[derive(Clone, Copy, Debug)]
pub(super) struct InSight {
    /// Whether some ground is close by.
    is_near: bool,
    /// The sky, and what lies below the horizon behind all ground.
    backdrop: [bool; 2],
    /// Whether the camera is above the base of clouds.
    pub(super) is_over_clouds: bool,
}

impl InSight {
    /// Of a camera that is so high above all ground, for pixels of such an angle, where clouds begin at a height.
    pub(super) fn of(camera: &Camera, above: f32, pixel_angle: f32, cloud_base: Option<f32>) -> Self {
        let Camera { forward, right, up, half, .. } = camera;
        let aside = (half[0] * right[2]).abs() + (half[1] * up[2]).abs();
        // A hundredth for what a device rounds otherwise.
        Self {
            is_near: above * pixel_angle < 1.01 * DETAIL_FROM,
            backdrop: [forward[2] + aside > -0.01, forward[2] - aside < 0.01],
            is_over_clouds: cloud_base.is_some_and(|base| camera.eye[2] > base),
        }
    }
}

/// The pipelines of the ground.
#[derive(Debug)]
pub(super) struct Ground {
    /// From above the ground, and from anywhere.
    depth: [RenderPipeline; 2],
    beyond: Option<[RenderPipeline; 2]>,
    kind: RenderPipeline,
    /// The light of clouds, and what draws it before all else; `None` where there are none.
    clouds: Option<[RenderPipeline; 2]>,
    /// What finds water beyond the border, far away and close by; `None` where kinds tell it.
    wet_beyond: Option<[RenderPipeline; 2]>,
    /// With the kinds that each draws, far away and close by, and what becomes of the opacity below what is close by.
    lights: Vec<(RenderPipeline, [Range<u32>; 2], Color)>,
    backdrop: [RenderPipeline; 2],
}

impl Ground {
    /// Compiles all, that of light side by side: each takes seconds on some drivers.
    pub(super) fn new(parts: Parts<'_>) -> Result<Self, Error> {
        let behind: &[bool] = if parts.samples > 1 { &[false, true] } else { &[false] };
        let around: &[Light] = if parts.has.horizon { &LIGHTS_BEYOND } else { &[] };
        let lights: Vec<_> =
            LIGHTS.iter().chain(around).flat_map(|light| behind.iter().map(move |&is| (light, is))).collect();
        let mut works: Vec<Box<dyn Fn() -> RenderPipeline + Sync>> = vec![
            Box::new(move || parts.sky(&BACKDROP[0])),
            Box::new(move || parts.light(&BACKDROP[1], false)),
        ];
        works.extend(
            lights
                .iter()
                .map(|&(light, is)| Box::new(move || parts.light(light, is)) as Box<dyn Fn() -> _ + Sync>),
        );
        let mut made = parts.context.side_by_side("making the pipelines of light", &works)?.into_iter();
        let backdrop = [made.next(), made.next()].map(|made| made.expect("as many as were asked for"));
        let ages = |over| if over == Over::Flowing { FORGOTTEN } else { STAYS };
        let drawn = lights.iter().map(|&(light, is_behind)| (kinds_of(light, is_behind), ages(light.over)));
        Ok(Self {
            depth: HIDDEN.map(|hidden| parts.depth("ground_vertex", hidden)),
            beyond: parts.has.horizon.then(|| HIDDEN.map(|hidden| parts.depth("beyond_vertex", hidden))),
            kind: parts.kind(),
            wet_beyond: (parts.has.horizon && parts.samples == 1)
                .then(|| [true, false].map(|is_far| parts.wet_beyond(is_far))),
            clouds: parts.has.clouds.then(|| [parts.clouds(), parts.clouds_over()]),
            lights: made.zip(drawn).map(|(pipeline, (kinds, ages))| (pipeline, kinds, ages)).collect(),
            backdrop,
        })
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
        self.clouds.is_some() && (in_sight.backdrop[0] || in_sight.is_over_clouds)
    }

    /// Draws the kind of each pixel.
    pub(super) fn draw_kinds(&self, pass: &mut RenderPass<'_>, depths: &[BindGroup; 3], in_sight: InSight) {
        draw_whole(pass, &self.kind, &depths[WITH_LIGHT]);
        let wet = self.wet_beyond.iter().flatten().zip(WET_BEYOND).zip([true, in_sight.is_near]);
        for ((pipeline, kinds), _) in wet.filter(|(_, is_seen)| *is_seen) {
            pass.set_pipeline(pipeline);
            pass.draw(0..3, kinds);
        }
    }

    /// Draws the light of every pixel that has a depth.
    pub(super) fn draw_light(&self, pass: &mut RenderPass<'_>, depths: &BindGroup, in_sight: InSight) {
        pass.set_bind_group(DEPTHS_GROUP, depths, &[]);
        for (pipeline, [far, near], ages) in &self.lights {
            let near = if in_sight.is_near { near.clone() } else { NONE };
            // Water that is close by flows: its pixels are no longer light of ground that the next picture takes.
            for (kinds, ages) in [(far.clone(), STAYS), (near, *ages)] {
                if !kinds.is_empty() {
                    pass.set_pipeline(pipeline);
                    pass.set_blend_constant(ages);
                    pass.draw(0..3, kinds);
                }
            }
        }
    }

    /// Draws the light of every pixel that has none, from the depths with the light of clouds and without, and clouds that are
    /// before all.
    pub(super) fn draw_backdrop(
        &self,
        pass: &mut RenderPass<'_>,
        depths: &[BindGroup; 3],
        in_sight: InSight,
    ) {
        for (which, is_seen) in in_sight.backdrop.into_iter().enumerate() {
            if is_seen {
                pass.set_bind_group(DEPTHS_GROUP, &depths[1 - which], &[]);
                pass.set_pipeline(&self.backdrop[which]);
                pass.draw(0..3, BACKDROP[which].kinds[0].clone());
            }
        }
        if let Some([_, over]) = self.clouds.as_ref().filter(|_| in_sight.is_over_clouds) {
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

#[cfg(test)]
mod tests {
    use super::*;
    use weald::random::{splitmix64, unit};

    #[test]
    fn what_a_pixel_shows_is_in_sight() {
        let (mut with_sky, mut with_plain) = (0, 0);
        for number in 0..4000_u64 {
            let random = |purpose: u64| 2.0 * unit(splitmix64(number ^ splitmix64(purpose))) as f32 - 1.0;
            let camera = Camera::looking([0.0; 3], unit_of([0, 1, 2].map(random)), [0.6, 0.4]);
            let in_sight = InSight::of(&camera, 50.0, 1e-3, None);
            let rises = camera.ray([random(3), random(4)]).direction[2];
            let [sky, plain] = in_sight.backdrop;
            assert!(in_sight.is_near && (sky || rises < 0.0) && (plain || rises >= 0.0));
            with_sky += u32::from(sky);
            with_plain += u32::from(plain);
        }
        assert!((1500..3900).contains(&with_sky) && (1500..3900).contains(&with_plain));
        let camera = Camera::looking([0.0; 3], [1.0, 0.0, 0.0], [0.6, 0.4]);
        assert!(
            InSight::of(&camera, 299.0, 1e-3, None).is_near
                && !InSight::of(&camera, 304.0, 1e-3, None).is_near
        );
    }

    fn unit_of(v: [f32; 3]) -> [f32; 3] {
        let length = v.iter().map(|part| part * part).sum::<f32>().sqrt();
        v.map(|part| part / length)
    }
}
