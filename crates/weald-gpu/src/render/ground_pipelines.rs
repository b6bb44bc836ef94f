//! How the pipelines of the ground and of what lies behind it are made.

use weald::picture::LitScene;
use wgpu::{
    BlendComponent, BlendFactor, BlendOperation, BlendState, ColorTargetState, ColorWrites, CompareFunction,
    Face, FragmentState, MultisampleState, PipelineCompilationOptions, PipelineLayout, PrimitiveState,
    RenderPipeline, RenderPipelineDescriptor, ShaderModule, VertexBufferLayout, VertexState,
};

use super::kinds::{Light, Over};
use super::layouts::depth_state;
use super::targets::{LIGHT, NUMBERS};
use crate::gpu::context::Context;

/// What a scene has, without which shaders leave out what draws it.
#[derive(Clone, Copy, Debug)]
pub(super) struct SceneParts {
    /// Cells without data.
    pub(super) holes: bool,
    pub(super) clouds: bool,
    /// Ground that goes on beyond the border.
    pub(super) horizon: bool,
}

impl SceneParts {
    /// What a scene has.
    pub(super) fn of(scene: &LitScene) -> Self {
        Self {
            holes: scene.has_holes(),
            clouds: scene.cloud_base().is_some(),
            horizon: scene.beyond().is_some(),
        }
    }
}

/// What the pipelines of the ground are made of.
#[derive(Clone, Copy, Debug)]
pub(super) struct Parts<'a> {
    pub(super) context: &'a Context,
    pub(super) module: &'a ShaderModule,
    /// With the depths, without, with the light of clouds as well, and with kinds by number.
    pub(super) layouts: [&'a PipelineLayout; 4],
    pub(super) patches: &'a [Option<VertexBufferLayout<'a>>],
    pub(super) samples: u32,
    pub(super) has: SceneParts,
    pub(super) has_lawn: bool,
}

/// What tells the pipelines of the ground from each other.
struct Drawn<'a> {
    key: String,
    layout: &'a PipelineLayout,
    samples: u32,
    vertex: (&'a str, &'a [Option<VertexBufferLayout<'a>>]),
    fragment: Option<&'a str>,
    constants: &'a [(&'a str, f64)],
    target: Option<ColorTargetState>,
    /// Whether it is kept, and how it is compared; `None` without depth.
    depth: Option<(bool, CompareFunction)>,
    /// Faces that are not drawn.
    hidden: Option<Face>,
}

/// What is laid over what is there, by its own share; the opacity below is kept as the pass says.
const LAID_OVER: BlendState = BlendState {
    color: BlendComponent {
        src_factor: BlendFactor::SrcAlpha,
        dst_factor: BlendFactor::OneMinusSrcAlpha,
        operation: BlendOperation::Add,
    },
    alpha: BlendComponent {
        src_factor: BlendFactor::Zero,
        dst_factor: BlendFactor::Constant,
        operation: BlendOperation::Add,
    },
};

/// What lets through a share of what is there.
const BEFORE_ALL: BlendState = BlendState {
    color: BlendComponent {
        src_factor: BlendFactor::One,
        dst_factor: BlendFactor::SrcAlpha,
        operation: BlendOperation::Add,
    },
    alpha: BlendComponent {
        src_factor: BlendFactor::Zero,
        dst_factor: BlendFactor::One,
        operation: BlendOperation::Add,
    },
};

impl Parts<'_> {
    /// The depths of triangles of the ground, but for those that are seen from below, which others hide, or of all.
    pub(super) fn depth(&self, vertex: &str, hidden: Option<Face>) -> RenderPipeline {
        self.pipeline(&Drawn {
            key: format!("depths of {vertex} {} {hidden:?}", self.has.holes),
            layout: self.layouts[1],
            samples: self.samples,
            vertex: (vertex, self.patches),
            fragment: self.has.holes.then_some("hole_fragment"),
            constants: &[],
            target: None,
            depth: Some((true, CompareFunction::Greater)),
            hidden,
        })
    }

    /// The kind of each pixel of one sample by number, where its depth is that of no kind yet.
    pub(super) fn number(&self) -> RenderPipeline {
        self.pipeline(&Drawn {
            key: format!("numbers {}", self.has.horizon),
            layout: self.layouts[0],
            samples: 1,
            vertex: ("whole_vertex", &[]),
            fragment: Some("kind_fragment"),
            constants: &[("SAMPLED", 0.0), ("HORIZON", f64::from(self.has.horizon))],
            target: Some(ColorTargetState { format: NUMBERS, blend: None, write_mask: ColorWrites::ALL }),
            depth: Some((false, CompareFunction::Equal)),
            hidden: None,
        })
    }

    /// The kind of each sample, by the number of its pixel where it has one.
    pub(super) fn kind(&self) -> RenderPipeline {
        let fragment = if self.samples > 1 { "kind_sampled_fragment" } else { "kind_depth_fragment" };
        self.pipeline(&Drawn {
            key: format!("{fragment} {}", self.has.horizon),
            layout: self.layouts[3],
            samples: self.samples,
            vertex: ("whole_vertex", &[]),
            fragment: Some(fragment),
            constants: &[("SAMPLED", f64::from(self.samples > 1)), ("HORIZON", f64::from(self.has.horizon))],
            target: None,
            depth: Some((true, CompareFunction::Always)),
            hidden: None,
        })
    }

    /// Which dry ground beyond the border is wet: that of the first kind, or of the last.
    pub(super) fn wet_beyond(&self, is_far: bool) -> RenderPipeline {
        let compare = if is_far { CompareFunction::Greater } else { CompareFunction::Less };
        self.pipeline(&Drawn {
            key: format!("wet beyond {is_far}"),
            layout: self.layouts[3],
            samples: self.samples,
            vertex: ("whole_vertex", &[]),
            fragment: Some("wet_beyond_fragment"),
            constants: &[("HORIZON", 1.0)],
            target: None,
            depth: Some((true, compare)),
            hidden: None,
        })
    }

    /// The light of the picture before, and the kind of pixels that have it.
    pub(super) fn reprojected(&self, layout: &PipelineLayout) -> RenderPipeline {
        self.pipeline(&Drawn {
            key: "reprojected".to_owned(),
            layout,
            samples: 1,
            vertex: ("whole_vertex", &[]),
            fragment: Some("reprojected_fragment"),
            constants: &[],
            target: Some(ColorTargetState { format: LIGHT, blend: None, write_mask: ColorWrites::ALL }),
            depth: Some((true, CompareFunction::Always)),
            hidden: None,
        })
    }

    /// The light of the kinds of ground that have it.
    pub(super) fn light(&self, light: &Light, is_behind: bool, compare: CompareFunction) -> RenderPipeline {
        self.light_from(self.layouts[0], light, is_behind, compare)
    }

    /// The light of the sky, with that of its clouds.
    pub(super) fn sky(&self, light: &Light) -> RenderPipeline {
        self.light_from(self.layouts[2], light, false, CompareFunction::Equal)
    }

    fn light_from(
        &self,
        layout: &PipelineLayout,
        light: &Light,
        is_behind: bool,
        compare: CompareFunction,
    ) -> RenderPipeline {
        let blend = (light.over != Over::Nothing).then_some(LAID_OVER);
        self.pipeline(&Drawn {
            key: format!("{} {is_behind} {compare:?} {} {}", light.fragment, self.has_lawn, self.has.horizon),
            layout,
            samples: self.samples,
            vertex: ("whole_vertex", &[]),
            fragment: Some(light.fragment),
            constants: &[
                ("SAMPLED", f64::from(self.samples > 1)),
                ("IS_BEHIND", f64::from(is_behind)),
                ("LAWN", f64::from(self.has_lawn)),
                ("HORIZON", f64::from(self.has.horizon)),
            ],
            target: Some(ColorTargetState { format: LIGHT, blend, write_mask: ColorWrites::ALL }),
            depth: Some((false, compare)),
            hidden: None,
        })
    }

    /// The light of clouds before all that is drawn.
    pub(super) fn clouds_over(&self) -> RenderPipeline {
        self.pipeline(&Drawn {
            key: "clouds over".to_owned(),
            layout: self.layouts[2],
            samples: self.samples,
            vertex: ("whole_vertex", &[]),
            fragment: Some("clouds_over_fragment"),
            constants: &[],
            target: Some(ColorTargetState {
                format: LIGHT,
                blend: Some(BEFORE_ALL),
                write_mask: ColorWrites::ALL,
            }),
            depth: Some((false, CompareFunction::Always)),
            hidden: None,
        })
    }

    /// The light of clouds, that of the picture before where it is known.
    pub(super) fn clouds_before(&self, layout: &PipelineLayout) -> RenderPipeline {
        self.clouds_by("clouds_before_fragment", layout)
    }

    /// The light of clouds, of one sample.
    pub(super) fn clouds(&self) -> RenderPipeline {
        self.clouds_by("clouds_fragment", self.layouts[0])
    }

    fn clouds_by(&self, fragment: &str, layout: &PipelineLayout) -> RenderPipeline {
        self.pipeline(&Drawn {
            key: format!("{fragment} {}", self.samples),
            layout,
            samples: 1,
            vertex: ("whole_vertex", &[]),
            fragment: Some(fragment),
            constants: &[("SAMPLED", f64::from(self.samples > 1))],
            target: Some(ColorTargetState { format: LIGHT, blend: None, write_mask: ColorWrites::ALL }),
            depth: None,
            hidden: None,
        })
    }

    fn pipeline(&self, drawn: &Drawn<'_>) -> RenderPipeline {
        let targets = drawn.target.clone().map(|target| [Some(target)]);
        let fragment = drawn.fragment.map(|name| FragmentState {
            module: self.module,
            entry_point: Some(name),
            compilation_options: PipelineCompilationOptions {
                constants: drawn.constants,
                ..PipelineCompilationOptions::default()
            },
            targets: targets.as_ref().map_or(&[], |targets| targets.as_slice()),
        });
        let make = || {
            self.context.device.create_render_pipeline(&RenderPipelineDescriptor {
                label: Some(&drawn.key),
                layout: Some(drawn.layout),
                vertex: VertexState {
                    module: self.module,
                    entry_point: Some(drawn.vertex.0),
                    compilation_options: PipelineCompilationOptions::default(),
                    buffers: drawn.vertex.1,
                },
                primitive: PrimitiveState { cull_mode: drawn.hidden, ..PrimitiveState::default() },
                depth_stencil: drawn.depth.map(|(depth_write, compare)| depth_state(depth_write, compare)),
                multisample: MultisampleState { count: drawn.samples, ..MultisampleState::default() },
                fragment,
                multiview_mask: None,
                cache: None,
            })
        };
        let key = format!("{} {}", drawn.key, drawn.samples);
        self.context.known.drawing((self.module.clone(), key), make)
    }
}
