//! Functions of the view on a device beside those of the CPU: the twins of [`twin_calls`], called with the same numbers.

use weald::picture::twin_calls::{INPUTS, OUTPUTS, Twin, twins};
use weald::picture::{LitScene, View};
use weald::random::{hash2, unit};
use weald::{Domain, Field, Landscape, Size};
use wgpu::{BufferBindingType, BufferUsages, ComputePassDescriptor};

use crate::compiled::{Pipeline, entry};
use crate::gpu::Gpu;
use crate::memory::Store;
use crate::pace::{Load, Pace, WorkKind};
use crate::transfer::{Transfer, write};

/// How far a device may be off, over one and the value.
const OFF: f32 = 1e-3;

/// Calls in a thousand that may be off by more: where a last digit decides which cell of a lattice, tree or joint is met.
const ELSEWHERE: usize = 4;

/// Invocations of a workgroup.
const GROUP: u32 = 64;

/// What a device gives.
fn given(gpu: &Gpu, shader: &str, twin: &Twin) -> Vec<f32> {
    let module = format!(
        "{shader}\n@group(0) @binding(0) var<storage, read> inputs: array<vec4<f32>>;\n\
         @group(0) @binding(1) var<storage, read_write> outputs: array<vec4<f32>>;\n\
         fn called(a: vec4<f32>, b: vec4<f32>, c: vec4<f32>) -> vec4<f32> {{\n{}\n}}\n\
         @compute @workgroup_size({GROUP}) fn call(@builtin(global_invocation_id) at: vec3<u32>) {{\n\
         let first = 3u * at.x;\n\
         outputs[at.x] = called(inputs[first], inputs[first + 1u], inputs[first + 2u]);\n}}\n",
        twin.body
    );
    let storage = |read_only| BufferBindingType::Storage { read_only };
    let entries = [entry(0, storage(true), false), entry(1, storage(false), false)];
    let pipeline = Pipeline::compile(gpu, "call", &module, &entries);
    let [inputs, outputs] = [INPUTS, OUTPUTS].map(|numbers| (4 * numbers * twin.inputs.len()) as u64);
    let usage = BufferUsages::STORAGE | BufferUsages::COPY_DST | BufferUsages::COPY_SRC;
    let store = |bytes| Store::new(gpu, "numbers of a call", bytes, usage).expect("small");
    let (from, into) = (store(inputs), store(outputs));
    write(gpu, &from.buffer, bytemuck::cast_slice(twin.inputs.as_flattened())).expect("written");
    let bindings = [(0, &from), (1, &into)].map(|(at, store)| (at, store.buffer.as_entire_binding()));
    let bound = pipeline.bind(gpu, bindings.into()).expect("bound");
    let mut pace = Pace::new(u64::MAX);
    let load = Load { sort: WorkKind::Passes, bytes: inputs + outputs, staged: None };
    pace.submit(gpu, load, |encoder| {
        let mut pass = encoder.begin_compute_pass(&ComputePassDescriptor::default());
        pass.set_pipeline(&pipeline.pipeline);
        pass.set_bind_group(0, &bound, &[]);
        pass.dispatch_workgroups((twin.inputs.len() as u32).div_ceil(GROUP), 1, 1);
    })
    .expect("submitted");
    let landing = Transfer::new(gpu).expect("small");
    landing.read(gpu, &mut pace, &into.buffer, outputs).expect("read")
}

/// A scene, whose shaders all scenes have.
fn scene() -> LitScene {
    let mut landscape = Landscape::new(Domain::new(Size::square(16).expect("small"), 10.0));
    let heights = Field::from_function(landscape.domain.size, |x, y| (x * y) as f32);
    landscape.insert("height", "m", heights);
    LitScene::new(&View::default(), &landscape).expect("a scene")
}

/// Asserts that a device gives what is expected.
fn assert_given(gpu: &Gpu, shader: &str, twin: &Twin) {
    let given = given(gpu, shader, twin);
    let is_off = |(given, expected): (&[f32], &[f32; OUTPUTS])| {
        let off = |(given, expected): (&f32, &f32)| (given - expected).abs() / (1.0 + expected.abs());
        !given.iter().zip(expected).all(|pair| off(pair) <= OFF)
    };
    let pairs = || given.chunks_exact(OUTPUTS).zip(&twin.outputs);
    let off = pairs().filter(|&pair| is_off(pair)).count();
    let first = pairs().zip(&twin.inputs).find(|&(pair, _)| is_off(pair));
    let most = ELSEWHERE * twin.inputs.len() / 1000;
    assert!(off <= most, "{}: {off} of {} are off, the first {first:?}", twin.name, twin.inputs.len());
    let varies = |at: usize| twin.outputs.iter().any(|outputs| outputs[at] != twin.outputs[0][at]);
    assert!(varies(0), "{}: all calls give the same", twin.name);
}

#[test]
fn a_device_gives_what_the_functions_of_the_view_give() {
    let gpu = Gpu::any().expect("an adapter");
    let shader = scene().shader(1);
    for twin in twins() {
        assert_given(&gpu, &shader, &twin);
    }
}

/// Twelve numbers from 0 to 1, and which of them shaders are to give back.
fn given_back(name: &'static str, body: &'static str, which: [usize; OUTPUTS]) -> Twin {
    let number = |call: i64, at: i64| unit(hash2(7, call, at)) as f32;
    let inputs: Vec<_> = (0..256).map(|call| std::array::from_fn(|at| number(call, at as i64))).collect();
    let outputs = inputs.iter().map(|inputs: &[f32; INPUTS]| which.map(|at| inputs[at])).collect();
    Twin { name, body, inputs, outputs }
}

/// A shader of grass.
const BLADES: [&str; 4] = [
    include_str!("records.wgsl"),
    weald::grow::grass::device::FUNCTIONS,
    include_str!("lit_sets.wgsl"),
    "@group(1) @binding(0) var<uniform> grasses: Grasses;
     fn set_of(a: vec4<f32>, b: vec4<f32>, c: vec4<f32>) -> LitSet {
         let head = vec3<f32>(a.w, b.x, c.w);
         return unpacked_set(packed_set(LitSet(a.xyz, b.xy, b.zw, c.xyz, head, c.w, a.w)));
     }
     fn blade(a: vec4<f32>, b: vec4<f32>, c: vec4<f32>) -> Blade {
         let stem = Spline(vec2<f32>(0.0), a.xy, a.zw, b.xy, b.zw);
         let packed = packed_blade(Blade(stem, c.xy, b.zw, c.z, c.w, 0.0, a.x, a.y, 0.0));
         return unpacked_blade(packed, set_of(a, b, c));
     }",
];

#[test]
fn what_blades_are_comes_back_from_records() {
    let gpu = Gpu::any().expect("an adapter");
    let shader = BLADES.join("\n");
    let twins = [
        ("let s = set_of(a, b, c); return vec4<f32>(s.root, s.tall);", [0, 1, 2, 3]),
        ("let s = set_of(a, b, c); return vec4<f32>(s.push, s.light);", [4, 5, 6, 7]),
        ("let s = set_of(a, b, c); return vec4<f32>(s.leaf, s.fold);", [8, 9, 10, 11]),
        ("let s = set_of(a, b, c); return vec4<f32>(s.head, a.x);", [3, 4, 11, 0]),
        ("let s = blade(a, b, c).stem; return vec4<f32>(s.b, s.c);", [0, 1, 2, 3]),
        ("let s = blade(a, b, c).stem; return vec4<f32>(s.d, s.e);", [4, 5, 6, 7]),
        ("let s = blade(a, b, c); return vec4<f32>(s.root, s.width, s.taper);", [8, 9, 10, 11]),
        ("let s = blade(a, b, c); return vec4<f32>(s.facing, s.head_length, s.head_width);", [6, 7, 0, 1]),
        ("let s = blade(a, b, c); return vec4<f32>(s.fold, s.stem.a + a.xy, a.x);", [11, 0, 1, 0]),
    ];
    for (body, which) in twins {
        assert_given(&gpu, &shader, &given_back("blades", body, which));
    }
}

/// A shader of plants. Numbers of few bits are rounded before, and what is lost after that added.
const PLANTS: [&str; 7] = [
    include_str!("frame.wgsl"),
    include_str!("records.wgsl"),
    include_str!("shadows.wgsl"),
    include_str!("plants/plants.wgsl"),
    weald::grow::wind::FUNCTIONS,
    weald::grow::ifs::limbs::FUNCTIONS,
    concat!(include_str!("plants/carried.wgsl"), include_str!("plants/seen.wgsl"), "
     @group(2) @binding(0) var<uniform> kind: Kind;
     fn limb(a: vec4<f32>, b: vec4<f32>) -> Carried { return unpacked_carried(packed_carried(Carried(a, b.xyz))); }
     fn rounded(steps: f32, share: f32) -> f32 { return round(steps * share) / steps; }
     fn plant(a: vec4<f32>, b: vec4<f32>, c: vec4<f32>) -> SeenPlant {
         let phase = rounded(PHASES, 0.99 * b.x);
         let shares = vec2<f32>(rounded(BREADTHS, a.x), rounded(AGES, a.y));
         let plant = SeenPlant(a.xyz, a.w, b, c.xy, phase, c.w, shares.x, shares.y, u32(7.99 * a.z));
         return unpacked_seen(packed_seen(plant));
     }"),
];

#[test]
fn what_plants_are_comes_back_from_records() {
    let gpu = Gpu::any().expect("an adapter");
    let shader = format!("{}\nconst SHADOW_TEXELS = 1u;\n{}", scene().shader_of_light(1), PLANTS.join("\n"));
    let few = "let s = plant(a, b, c);
               return a + vec4<f32>(s.breadth - rounded(BREADTHS, a.x), s.age - rounded(AGES, a.y),
                                    f32(s.side) - floor(7.99 * a.z), s.phase - rounded(PHASES, 0.99 * b.x));";
    let twins = [
        ("return limb(a, b).turn;", [0, 1, 2, 3]),
        ("return vec4<f32>(limb(a, b).shift, a.x);", [4, 5, 6, 0]),
        ("let s = plant(a, b, c); return vec4<f32>(s.place, s.size);", [0, 1, 2, 3]),
        ("return plant(a, b, c).turn;", [4, 5, 6, 7]),
        ("let s = plant(a, b, c); return vec4<f32>(s.push, c.z, s.detail);", [8, 9, 10, 11]),
        (few, [0, 1, 2, 3]),
    ];
    for (body, which) in twins {
        assert_given(&gpu, &shader, &given_back("plants", body, which));
    }
}
