//! A studio without a window of the system, drawn on software that acts as a graphics card.

use std::path::Path;
use std::rc::Rc;
use std::sync::OnceLock;
use std::sync::mpsc::channel;
use std::time::{Duration, Instant};

use eframe::egui;
use eframe::egui_wgpu::{RenderState, RendererOptions, WgpuSetup, WgpuSetupExisting};
use eframe::wgpu::{Instance, InstanceDescriptor};
use egui_kittest::kittest::Queryable;
use egui_kittest::wgpu::create_render_state;
use egui_kittest::{Harness, HarnessBuilder};
use weald_gpu::Gpu;
use weald_studio::work::{Phase, Status};
use weald_studio::{Chooser, Options, Studio};

/// How long anything may take before a test says that it does not happen.
const TIMEOUT: Duration = Duration::from_mins(3);

/// The device of all windows: compiling for one of its own took most of the time of each.
fn device() -> (WgpuSetupExisting, Gpu) {
    static DEVICE: OnceLock<(WgpuSetupExisting, Gpu)> = OnceLock::new();
    let open = || {
        let opened = create_render_state(weald_studio::device_setup(), RendererOptions::PREDICTABLE);
        let gpu = Gpu::shared(&opened.adapter, &opened.device, &opened.queue).expect("it has what is needed");
        let instance = Instance::new(InstanceDescriptor::new_without_display_handle());
        let RenderState { adapter, device, queue, .. } = opened;
        (WgpuSetupExisting { instance, adapter, device, queue }, gpu)
    };
    DEVICE.get_or_init(open).clone()
}

pub(crate) struct Window {
    pub(crate) harness: Harness<'static, Studio>,
    /// Goes with the window.
    _own: Option<tempfile::TempDir>,
}

impl Window {
    /// Opens a recipe or a project, or begins as without a file, on a machine that was never used.
    pub(crate) fn open(what: Option<&Path>) -> Self {
        let own = tempfile::tempdir().expect("a folder");
        let window = Self::on_machine(what, own.path());
        Self { _own: Some(own), ..window }
    }

    /// The same where this folder has what was kept on the machine.
    pub(crate) fn on_machine(what: Option<&Path>, own: &Path) -> Self {
        // The dialogs of a desktop are no part of a test: nobody answers them.
        let chooser: Chooser = Rc::new(|_| channel().1);
        let (what, own_files) = (what.map(Path::to_owned), Some(own.to_owned()));
        Self::with(Options { what, own_files, chooser: Some(chooser), ..Options::default() })
    }

    /// The same with all options.
    pub(crate) fn with(options: Options) -> Self {
        let (device, gpu) = device();
        // How fine a picture is must not hang on how busy the machine is.
        let options = Options { finest: true, gpu: Some(gpu), ..options };
        let builder: HarnessBuilder<Studio> =
            Harness::builder().with_size([1200.0, 760.0]).wgpu_setup(WgpuSetup::Existing(device));
        let harness = builder.build_eframe(move |context| {
            Studio::of(context, options).unwrap_or_else(|error| panic!("{error}"))
        });
        Self { harness, _own: None }
    }

    pub(crate) fn status(&mut self) -> Status {
        self.harness.step();
        self.harness.state().status().clone()
    }

    /// Steps until something holds.
    pub(crate) fn until(&mut self, what: &str, mut holds: impl FnMut(&Status) -> bool) -> Status {
        let begun = Instant::now();
        loop {
            let status = self.status();
            if holds(&status) {
                return status;
            }
            let Status { phase, error, steps, plays, moments, .. } = &status;
            assert!(
                begun.elapsed() < TIMEOUT,
                "{what} does not come: {phase:?} {error:?} {steps} {plays} {moments:?}"
            );
            std::thread::sleep(Duration::from_millis(5));
        }
    }

    /// Steps until there is a landscape and nothing more to do.
    pub(crate) fn settle(&mut self) -> Status {
        self.until("rest", |status| status.shown.is_some() && status.phase == Phase::Idle)
    }

    /// Steps until the landscape is drawn as finely as it will be.
    pub(crate) fn drawn(&mut self) {
        let begun = Instant::now();
        while !self.harness.state().is_drawn() {
            self.harness.step();
            assert!(begun.elapsed() < TIMEOUT, "no picture: {:?}", self.harness.state().drawing_error());
            std::thread::sleep(Duration::from_millis(5));
        }
    }

    /// Keeps what the window shows, to be looked at.
    pub(crate) fn picture(&mut self, name: &str) {
        let image = self.harness.render().expect("a picture");
        let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("studio");
        std::fs::create_dir_all(&folder).expect("a folder");
        image.save(folder.join(name).with_extension("png")).expect("written");
    }

    /// The pixels of a part of the window.
    pub(crate) fn pixels(&mut self, part: egui::Rect) -> Pixels {
        let image = self.harness.render().expect("a picture");
        let [left, top] = [part.left(), part.top()].map(|side| side.ceil() as u32);
        let [right, bottom] = [(part.right(), image.width()), (part.bottom(), image.height())]
            .map(|(side, most)| (side as u32).min(most));
        let colours = (top..bottom).flat_map(|y| (left..right).map(move |x| (x, y)));
        let colours = colours.map(|(x, y)| image.get_pixel(x, y).0).collect();
        Pixels { width: (right - left) as usize, colours }
    }

    /// Steps until what was pinned is drawn.
    pub(crate) fn until_pinned(&mut self) {
        let begun = Instant::now();
        while !self.harness.state().is_compared() {
            self.harness.step();
            assert!(begun.elapsed() < TIMEOUT, "nothing is pinned");
            std::thread::sleep(Duration::from_millis(5));
        }
    }

    /// Draws a stroke with the pointer, from and to shares of the viewport.
    pub(crate) fn stroke(&mut self, from: [f32; 2], to: [f32; 2]) {
        let rect = self.harness.get_by_label("Viewport").rect();
        let at = |share: [f32; 2]| rect.min + egui::vec2(share[0] * rect.width(), share[1] * rect.height());
        self.harness.hover_at(at(from));
        self.harness.step();
        self.harness.drag_at(at(from));
        self.harness.step();
        for step in 1..=10 {
            let part = step as f32 / 10.0;
            self.harness.hover_at(at([0, 1].map(|axis| from[axis] + part * (to[axis] - from[axis]))));
            self.harness.step();
        }
        self.harness.drop_at(at(to));
        self.harness.step();
    }

    /// Holds the pointer still over the viewport.
    pub(crate) fn hover(&mut self, share: [f32; 2]) {
        let rect = self.harness.get_by_label("Viewport").rect();
        self.harness.hover_at(rect.min + egui::vec2(share[0] * rect.width(), share[1] * rect.height()));
        self.harness.step();
    }

    pub(crate) fn type_over(&mut self, label: &str, text: &str) {
        self.type_in((egui::accesskit::Role::TextInput, label), text);
    }

    /// Types over all that stands in a field.
    pub(crate) fn type_in(&mut self, (role, label): (egui::accesskit::Role, &str), text: &str) {
        self.harness.get_by_role_and_label(role, label).focus();
        self.harness.step();
        self.harness.key_press_modifiers(egui::Modifiers::COMMAND, egui::Key::A);
        self.harness.step();
        self.harness.get_by_role_and_label(role, label).type_text(text);
        self.harness.step();
        self.harness.step();
    }

    /// Clicks the last control of this label: that of a question lies over the others.
    pub(crate) fn click_last(&mut self, label: &str) {
        // As of any click.
        self.harness.step();
        self.harness.step();
        self.harness.get_all_by_label(label).last().expect("there").click();
        self.harness.step();
        self.harness.step();
    }

    /// Clicks what may lie further down in a list.
    pub(crate) fn reach(&mut self, label: &str) {
        self.harness.get_by_label(label).scroll_to_me();
        // The list takes some frames to get there.
        self.harness.run_steps(30);
        self.click(label);
    }

    pub(crate) fn click(&mut self, label: &str) {
        // What has just come or gone moves what stands beside it, one frame later.
        self.harness.step();
        self.harness.step();
        self.harness.get_by_label(label).click();
        self.harness.step();
        self.harness.step();
    }
}

/// A picture, row by row.
pub(crate) struct Pixels {
    pub(crate) width: usize,
    colours: Vec<[u8; 4]>,
}

impl Pixels {
    /// How many of the pixels have another colour than in a picture of the same size.
    pub(crate) fn share_that_differs(&self, other: &Self) -> f64 {
        assert_eq!(self.colours.len(), other.colours.len());
        let differ = self.colours.iter().zip(&other.colours).filter(|(one, other)| one != other).count();
        differ as f64 / self.colours.len() as f64
    }

    /// The part between two columns.
    pub(crate) fn columns(&self, part: std::ops::Range<usize>) -> Self {
        let rows = self.colours.chunks(self.width).flat_map(|row| row[part.clone()].to_vec());
        Self { width: part.len(), colours: rows.collect() }
    }
}
