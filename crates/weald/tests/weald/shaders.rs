//! Every shader is parsed, validated and compared with the host, without a GPU.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::{Arc, LazyLock, Mutex};

use naga::valid::{Capabilities, GlobalUse, ModuleInfo, ValidationFlags, Validator};
use naga::{AddressSpace, ArraySize, Module, Scalar, StructMember, TypeInner, VectorSize};
use weald::engine::device::{Device, Loaded};
use weald::engine::program::{GROUP, MAX_BUFFERS, Pass, Program, Uniforms};
use weald::engine::{Engine, Job, Unwatched};
use weald::error::{DeviceError, DeviceErrorKind};
use weald::grid::Mask;
use weald::grow::SHADERS;
use weald::grow::grass::{Bend, Grasses, SPECIES};
use weald::grow::ifs::device::{DispatchRange, Rules};
use weald::grow::ifs::shader::Shader;
use weald::grow::ifs::wind::{Plant, Pose};
use weald::grow::ifs::{Game, Sway, shapes};
use weald::picture::{LitScene, View};
use weald::{Domain, Error, Field, Landscape, Size};

/// Every program of the library.
fn programs() -> Vec<Program> {
    let mut programs = weald::erode::programs();
    programs.extend(weald::generate::programs());
    programs.extend(programs_of_steps());
    programs
}

/// A device that keeps the programs it is given and runs none.
#[derive(Clone, Debug, Default)]
struct Keeper(Arc<Mutex<Vec<Program>>>);

impl Device for Keeper {
    fn adapter(&self) -> String {
        "a device that runs nothing".to_owned()
    }

    fn memory(&self) -> u64 {
        1 << 30
    }

    fn largest_buffer(&self) -> u64 {
        1 << 28
    }

    fn load(&self, program: &Program, _: Size) -> Result<Box<dyn Loaded>, Error> {
        self.0.lock().expect("one thread").push(program.clone());
        Err(DeviceError::new(DeviceErrorKind::Failed, "it runs nothing").into())
    }
}

/// What the processes that run alone give a device, on ground with and without data everywhere.
fn programs_of_steps() -> Vec<Program> {
    let keeper = Keeper::default();
    let whole = crate::common::layered(crate::common::rough(8, 8, 5.0, 1));
    let mut masked = whole.clone();
    masked.domain.valid = Mask::new(masked.domain.size, (0..64).map(|at| at % 7 != 3).collect());
    for ground in [whole, masked] {
        for step in weald::erode::processes() {
            let engine = Engine::Device(Arc::new(keeper.clone()));
            let job = Job { seed: 1, engine, watcher: &Unwatched, resume: None };
            let refused = step.run(&mut ground.clone(), &job);
            assert!(matches!(refused, Err(Error::Device(_))), "{step:?}: {refused:?}");
        }
    }
    let programs = keeper.0.lock().expect("one thread");
    assert_eq!(programs.len(), 2 * weald::erode::processes().len());
    programs.clone()
}

/// A pass of a program, and what naga makes of its text.
struct Checked {
    program: Program,
    pass: Pass,
    module: Module,
    info: ModuleInfo,
}

/// Every different module by its text. They are parsed once for all tests, which takes seconds.
static MODULES: LazyLock<BTreeMap<String, Checked>> = LazyLock::new(|| {
    let passes = programs().into_iter().flat_map(|program| {
        let passes = program.passes.clone();
        passes.into_iter().map(move |pass| (program.module(&pass), (program.clone(), pass)))
    });
    let different: BTreeMap<_, _> = passes.collect();
    let checked = different.into_iter().map(|(text, (program, pass))| {
        let (module, info) = checked(&text, pass.name);
        (text, Checked { program, pass, module, info })
    });
    checked.collect()
});

fn checked(text: &str, name: &str) -> (Module, ModuleInfo) {
    let parsed = naga::front::wgsl::parse_str(text);
    let module = parsed.unwrap_or_else(|error| panic!("{name}: {}", error.emit_to_string(text)));
    let info = Validator::new(ValidationFlags::all(), Capabilities::empty()).validate(&module);
    let info = info.unwrap_or_else(|error| panic!("{name}: {}", error.emit_to_string(text)));
    (module, info)
}

#[test]
fn every_module_has_the_one_entry_point_of_its_pass() {
    assert!(MODULES.len() > 50, "{} modules", MODULES.len());
    for Checked { module, pass, .. } in MODULES.values() {
        let entries: Vec<_> = module.entry_points.iter().map(|entry| entry.name.as_str()).collect();
        assert_eq!(entries, [pass.name]);
        assert_eq!(module.entry_points[0].workgroup_size, [GROUP as u32, GROUP as u32, 1], "{}", pass.name);
    }
}

#[test]
fn every_pass_uses_what_it_declares_and_no_more_than_browsers_allow() {
    for Checked { program, pass, module, info } in MODULES.values() {
        let entry = info.get_entry_point(0);
        let storage = module
            .global_variables
            .iter()
            .filter(|(_, variable)| matches!(variable.space, AddressSpace::Storage { .. }));
        let mut count = 0;
        for (handle, variable) in storage {
            count += 1;
            let name = variable.name.as_deref().expect("buffers have names");
            let written = pass.writes.iter().any(|&buffer| program.buffers[buffer].name == name);
            let used = entry[handle];
            assert!(name == "mask" || !used.is_empty(), "{} {}: `{name}` is idle", program.name, pass.name);
            let writes = used.contains(GlobalUse::WRITE);
            assert_eq!(writes, written || name == "sums", "{} {}: `{name}`", program.name, pass.name);
        }
        assert!((1..=MAX_BUFFERS).contains(&count), "{} {}: {count}", program.name, pass.name);
    }
}

/// A hill, ready to be drawn.
fn scene() -> LitScene {
    let size = Size::square(8).expect("small");
    let mut landscape = Landscape::new(Domain::new(size, 10.0));
    landscape.insert("height", "m", Field::from_function(size, |x, y| (x * y) as f32));
    LitScene::new(&View::default(), &landscape).expect("it can be drawn")
}

#[test]
fn the_numbers_of_a_stage_are_as_many_as_its_shaders_read() {
    let scene = scene();
    let (module, _) = checked(&scene.shader(0), "scene");
    let read = module.global_variables.iter().find(|(_, variable)| variable.name.as_deref() == Some("scene"));
    let (_, variable) = read.expect("the numbers are declared");
    let TypeInner::Struct { span, .. } = module.types[variable.ty].inner else { panic!("no struct") };
    assert!(span > 1000);
    assert_eq!(scene.uniforms().len(), span as usize);
}

#[test]
fn every_shader_of_the_tree_is_part_of_a_module() {
    let crates = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let crates = std::fs::read_dir(crates).expect("the crates").map(|entry| entry.expect("a crate").path());
    // Shaders that draw and copy are tested where wgpu is, and those of the window in the window.
    let is_here = |folder: &PathBuf| !["weald-gpu", "weald-studio"].iter().any(|own| folder.ends_with(own));
    let sources = crates.filter(is_here).map(|folder| folder.join("src"));
    let shaders: Vec<_> =
        sources.filter(|source| source.is_dir()).flat_map(|source| shaders_below(&source)).collect();
    assert!(shaders.len() > 20, "{}", shaders.len());
    let scene = scene().shader(0);
    let whole = [scene.as_str(), LitScene::FOLLOW];
    for path in shaders {
        let text = std::fs::read_to_string(&path).expect("a readable shader");
        let part_of_a_module =
            MODULES.keys().map(String::as_str).chain(whole).any(|module| module.contains(&text));
        let of_plants = SHADERS.iter().any(|shader| shader.source().contains(&text));
        assert!(part_of_a_module || of_plants, "{} is in no module", path.display());
    }
}

fn shaders_below(folder: &Path) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).expect("a folder of sources");
    let paths = entries.map(|entry| entry.expect("a readable folder").path());
    paths
        .flat_map(|path| match path.extension() {
            _ if path.is_dir() => shaders_below(&path),
            Some(extension) if extension == "wgsl" => vec![path],
            _ => Vec::new(),
        })
        .collect()
}

#[test]
fn structs_of_the_host_lie_in_memory_as_their_twins_do() {
    let mut compared = 0;
    for Checked { program, module, .. } in MODULES.values() {
        for uniforms in [&program.constants, &program.weather] {
            if !uniforms.name.is_empty() {
                assert_same_layout(module, uniforms, program.name);
                compared += 1;
            }
        }
    }
    let (follow, _) = checked(LitScene::FOLLOW, "follow");
    assert_same_layout(&follow, &Uniforms::of(&scene().follow()), "follow");
    assert!(compared > 50, "{compared} structs");
}

fn assert_same_layout(module: &Module, uniforms: &Uniforms, process: &str) {
    let named = module.types.iter().find(|(_, kind)| kind.name.as_deref() == Some(uniforms.name));
    let Some((_, kind)) = named else { panic!("{process}: no struct `{}`", uniforms.name) };
    let TypeInner::Struct { members, span } = &kind.inner else { panic!("`{}`", uniforms.name) };
    let twin: Vec<_> = members.iter().map(|member| described(module, member)).collect();
    let mut offset = 0;
    let host: Vec<_> = uniforms
        .fields
        .iter()
        .map(|(name, kind)| {
            let here = offset;
            offset += bytes(kind);
            ((*name).to_owned(), (*kind).to_owned(), here)
        })
        .collect();
    assert_eq!(twin, host, "{process}: `{}`", uniforms.name);
    let whole = if uniforms.fields.iter().any(|(_, kind)| bytes(kind) > 4) { 16 } else { 4 };
    assert_eq!(
        *span as usize,
        (4 * uniforms.words.len()).next_multiple_of(whole),
        "{process}: `{}`",
        uniforms.name
    );
}

/// Bytes of a type, and of nothing between its members.
fn bytes(kind: &str) -> u32 {
    match kind {
        "f32" | "u32" => 4,
        "vec4<f32>" | "vec4<u32>" => 16,
        array => {
            let count = array.trim_start_matches("array<vec4<f32>, ").trim_end_matches('>').parse::<u32>();
            16 * count.unwrap_or_else(|_| panic!("a member of type {array}"))
        }
    }
}

/// Name, type and offset.
fn described(module: &Module, member: &StructMember) -> (String, String, u32) {
    let kind = match module.types[member.ty].inner {
        TypeInner::Array { base, size: ArraySize::Constant(count), stride: 16 } => {
            format!("array<{}, {count}>", number(&module.types[base].inner))
        }
        ref other => number(other).to_owned(),
    };
    (member.name.clone().expect("members have names"), kind, member.offset)
}

fn number(kind: &TypeInner) -> &'static str {
    match *kind {
        TypeInner::Scalar(Scalar::F32) => "f32",
        TypeInner::Scalar(Scalar::U32) => "u32",
        TypeInner::Vector { size: VectorSize::Quad, scalar: Scalar::F32 } => "vec4<f32>",
        TypeInner::Vector { size: VectorSize::Quad, scalar: Scalar::U32 } => "vec4<u32>",
        ref other => panic!("a member of type {other:?}"),
    }
}

#[test]
fn bindings_follow_the_order_that_the_program_states() {
    for Checked { program, pass, module, .. } in MODULES.values() {
        let binding = |name: &str| {
            let found =
                module.global_variables.iter().find(|(_, global)| global.name.as_deref() == Some(name));
            let (_, global) = found.unwrap_or_else(|| panic!("{}: no variable `{name}`", pass.name));
            global.binding.expect("buffers are bound").binding as usize
        };
        assert_eq!(binding("grid"), 0);
        for (at, (buffer, _)) in program.bound(pass).into_iter().enumerate() {
            assert_eq!(binding(program.buffers[buffer].name), 3 + at, "{}", pass.name);
        }
    }
}

#[test]
fn shaders_of_plants_are_valid_and_bound_in_the_order_of_their_lists() {
    for shader in SHADERS {
        let (module, info) = checked(&shader.source(), shader.name);
        let entries: Vec<_> = module.entry_points.iter().map(|entry| entry.name.as_str()).collect();
        assert_eq!(entries, [shader.name]);
        assert_eq!(module.entry_points[0].workgroup_size, [shader.group, 1, 1], "{}", shader.name);
        let used = |name: &str, binding: usize| {
            let named = |global: &naga::GlobalVariable| global.name.as_deref() == Some(name);
            let found = module.global_variables.iter().find(|(_, global)| named(global));
            let (handle, global) = found.unwrap_or_else(|| panic!("{}: no variable `{name}`", shader.name));
            assert_eq!(global.binding.map(|at| at.binding as usize), Some(binding), "{name}");
            info.get_entry_point(0)[handle]
        };
        let uniforms = shader.uniforms.len();
        for (binding, name) in shader.uniforms.iter().enumerate() {
            assert!(used(name, binding).contains(GlobalUse::READ), "{name} is idle");
        }
        for (place, &(name, written)) in shader.buffers.iter().enumerate() {
            let found = used(name, uniforms + place);
            assert!(!found.is_empty() && found.contains(GlobalUse::WRITE) == written, "{name}: {found:?}");
        }
        assert_eq!(module.global_variables.len(), uniforms + shader.buffers.len(), "{}", shader.name);
        assert!(shader.buffers.len() <= MAX_BUFFERS, "{}", shader.name);
    }
}

#[test]
fn structs_of_plants_lie_in_memory_as_their_twins_do() {
    let ifs = shapes::find("fern").expect("built in").ifs();
    let range = Uniforms::of(&DispatchRange { first: 0, points: 0 });
    let rules: Rules = Game::new(&ifs, 1).rules(true);
    let plant: Plant = Sway::of(&ifs).plant();
    let grasses = Grasses::new(&SPECIES, Bend::Total);
    let of_each: [&[Uniforms]; SHADERS.len()] = [
        &[Uniforms::of(&rules), range.clone()],
        &[Uniforms::of(&plant), Uniforms::of(&Pose::calm()), range.clone()],
        &[Uniforms::of(&grasses), range.clone()],
        &[range],
    ];
    for (shader, structs) in SHADERS.iter().zip(of_each) {
        let (module, _) = checked(&shader.source(), shader.name);
        assert_eq!(structs.len(), shader.uniforms.len());
        for uniforms in structs {
            assert_same_layout(&module, uniforms, shader.name);
        }
    }
}

#[test]
fn constants_of_plants_are_those_of_the_host() {
    use weald::grow::grass::{BLADES, curves, growth, species};
    use weald::grow::ifs::{game, lanes, wind};
    let host = [
        ("play", "LANES", lanes::LANES),
        ("play", "STEPS", game::STEPS),
        ("sway", "ORDERS", wind::ORDERS),
        ("sway", "PHASES", wind::PHASES),
        ("grow", "BLADES", BLADES as usize),
        ("grow", "ROWS", species::ROWS),
    ]
    .map(|(shader, name, value)| (shader, name, format!("u32 = {value}u")));
    let numbers =
        [("JOINT", curves::JOINT), ("MAX_BEND", growth::MAX_BEND), ("BEND_OF_GAMMA", growth::BEND_OF_GAMMA)]
            .map(|(name, value)| ("grow", name, format!("f32 = {value}")));
    for (shader, name, value) in host.into_iter().chain(numbers) {
        let of = |shader: &Shader| shader.source().contains(&format!("const {name}: {value};"));
        assert!(
            SHADERS.iter().any(|found| found.name == shader && of(found)),
            "{shader}: {name} is not {value}"
        );
    }
}
