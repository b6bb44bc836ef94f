//! The page's half: the studio on a canvas, and what the page does for it.

use std::cell::RefCell;
use std::path::{Path, PathBuf};
use std::rc::Rc;

use eframe::egui::Context;
use eframe::{CreationContext, WebRunner};
use js_sys::{Array, Float32Array, Function, Uint8Array};
use wasm_bindgen::prelude::{Closure, wasm_bindgen};
use wasm_bindgen::{JsCast, JsValue};
use weald::files;
use weald_studio::host::Host;
use weald_studio::work::Remote;
use weald_studio::{Options, Studio, page_options};
use web_sys::{HtmlCanvasElement, MessageEvent, Worker};

use crate::labels::Labels;
use crate::parcels::{message_of, parcel_of};

#[wasm_bindgen]
extern "C" {
    /// What the page's own script does.
    #[wasm_bindgen(js_namespace = weald, js_name = keep)]
    fn keep_file(path: &str, bytes: Option<Uint8Array>);
    #[wasm_bindgen(js_namespace = weald, js_name = choose)]
    fn choose_file();
    #[wasm_bindgen(js_namespace = weald, js_name = handOut)]
    fn hand_out_file(name: &str, bytes: &Uint8Array);
    #[wasm_bindgen(js_namespace = weald, js_name = share)]
    fn share_link(recipe: &str, script: &str);
}

/// Files that have arrived and that the studio has not taken yet.
type Arrived = Rc<RefCell<Vec<Result<PathBuf, String>>>>;

struct AroundStudio {
    arrived: Arrived,
}

impl Host for AroundStudio {
    fn arrived(&self) -> Vec<Result<PathBuf, String>> {
        self.arrived.take()
    }

    fn choose(&self) {
        choose_file();
    }

    fn hand_out(&self, name: &str, bytes: &[u8]) {
        hand_out_file(name, &Uint8Array::from(bytes));
    }

    fn share(&self, recipe: &str, script: &str) {
        share_link(recipe, script);
    }
}

/// A studio on a canvas.
#[wasm_bindgen]
pub struct Page {
    runner: WebRunner,
    context: Rc<RefCell<Option<Context>>>,
    arrived: Arrived,
    remote: Rc<Remote>,
    labels: Labels,
    /// Called for each message of the worker, as long as there is a page.
    _messages: Closure<dyn FnMut(MessageEvent)>,
}

#[wasm_bindgen]
impl Page {
    /// Shows a studio. `worker` takes its tasks; `what` is the path of what it begins with, where something is; who `plays`
    /// sees a simulation that runs, and no question.
    ///
    /// # Errors
    /// A sentence where the browser can draw neither on a device nor by WebGL.
    pub async fn open(
        canvas: HtmlCanvasElement,
        worker: Worker,
        with_device: bool,
        what: Option<String>,
        plays: bool,
    ) -> Result<Page, JsValue> {
        console_error_panic_hook::set_once();
        let context: Rc<RefCell<Option<Context>>> = Rc::default();
        let (arrived, labels) = (Arrived::default(), Labels::default());
        let sent_to = worker.clone();
        let post = move |parcel| {
            let (message, memory) = message_of(parcel);
            // A worker that has failed says so by itself.
            let _ = sent_to.post_message_with_transfer(&message, &memory);
        };
        let remote = Rc::new(Remote::new(post, Box::new(keep)));
        let messages = listening(&worker, Rc::clone(&remote), Rc::clone(&context));
        let runner = WebRunner::new();
        let what = match what {
            Some(path) => Some(PathBuf::from(path)),
            None if plays => Some(welcome()?),
            None => None,
        };
        let options = Options {
            what,
            remote: Some(Rc::clone(&remote)),
            host: Some(Rc::new(AroundStudio { arrived: Rc::clone(&arrived) })),
            plays,
            ..Options::default()
        };
        let (shown_in, read_by) = (Rc::clone(&context), labels.clone());
        let make = Box::new(move |creation: &CreationContext<'_>| {
            *shown_in.borrow_mut() = Some(creation.egui_ctx.clone());
            creation.egui_ctx.add_plugin(read_by);
            Ok(Box::new(Studio::of(creation, options)?) as Box<dyn eframe::App>)
        });
        runner.start(canvas, page_options(with_device), make).await?;
        Ok(Self { runner, context, arrived, remote, labels, _messages: messages })
    }

    /// Takes a file that was dropped on the page or chosen, and opens it.
    pub fn arrive(&self, name: &str, bytes: &Uint8Array) {
        let name = name.rsplit(['/', '\\']).next().unwrap_or(name);
        let path = files::current_dir().join("arrived").join(name);
        let put = files::create_dir_all(path.parent().unwrap_or(Path::new("/")));
        let put = put.and_then(|()| files::write(&path, bytes.to_vec()));
        self.hand_in(put.map(|()| path).map_err(|cause| format!("{name}: {cause}")));
    }

    /// Says something to the user, at the foot of the studio.
    pub fn tell(&self, sentence: String) {
        self.hand_in(Err(sentence));
    }

    /// Shows the controls, after a landscape alone was shown.
    pub fn begin(&self) {
        if let Some(mut studio) = self.runner.app_mut::<Studio>() {
            studio.show_controls();
        }
        self.repaint();
    }

    /// Notes that the worker has ended.
    pub fn fail(&self, sentence: String) {
        self.remote.fail(sentence);
        self.repaint();
    }

    /// What is going on, as JSON: for scripts, and for pages around this one.
    pub fn state(&self) -> String {
        let Some(studio) = self.runner.app_mut::<Studio>() else { return "null".to_owned() };
        let status = studio.status();
        let state = serde_json::json!({
            "idle": studio.is_settled() && self.arrived.borrow().is_empty(),
            "kept": studio.is_kept(),
            "frames": self.context.borrow().as_ref().map(Context::cumulative_frame_nr),
            "plays": status.plays,
            "steps": status.steps,
            "engine": status.engine,
            "pace": status.pace,
            "changes": status.changes,
            "moments": status.moments.iter().filter(|moment| moment.is_past).count(),
            "shown": status.shown.as_ref().map(|shown| shown.number),
            "columns": status.shown.as_ref().map(|shown| shown.landscape.domain.size.columns),
            "whole": studio.heights().is_some_and(|(_, is_of_now)| is_of_now),
            "drawn": studio.is_drawn(),
            "error": status.error.clone().or_else(|| studio.drawing_error()),
            "message": studio.message(),
            "text": studio.text(),
        });
        state.to_string()
    }

    /// Elevations of the last whole landscape, from north-west to south-east by rows; empty where there is none.
    pub fn heights(&self) -> Float32Array {
        let studio = self.runner.app_mut::<Studio>();
        let heights = studio.as_ref().and_then(|studio| studio.heights());
        heights.map_or_else(
            || Float32Array::new_with_length(0),
            |(heights, _)| Float32Array::from(heights.values()),
        )
    }

    /// West, north, east and south of everything of that label, in points of the canvas.
    pub fn find(&self, label: &str) -> Array {
        let places = self.labels.places(label);
        places.into_iter().map(|place| place.into_iter().map(JsValue::from).collect::<Array>()).collect()
    }

    /// Ends the studio.
    pub fn close(&self) {
        self.runner.destroy();
    }

    fn hand_in(&self, what: Result<PathBuf, String>) {
        self.arrived.borrow_mut().push(what);
        self.repaint();
    }

    fn repaint(&self) {
        if let Some(context) = &*self.context.borrow() {
            context.request_repaint();
        }
    }
}

/// Puts a file that the browser has kept among those of the studio, before that begins.
#[wasm_bindgen]
pub fn restore(path: &str, bytes: &Uint8Array) {
    files::take_over(vec![(PathBuf::from(path), Some(bytes.to_vec()))]);
}

/// Sends the worker all files that there are already.
#[wasm_bindgen]
pub fn all_changed() {
    files::mark_all_changed();
}

/// The recipe that is shown to who comes for the first time.
fn welcome() -> Result<PathBuf, JsValue> {
    let path = PathBuf::from("/welcome/valley.toml");
    let put =
        files::create_dir_all("/welcome").and_then(|()| files::write(&path, include_str!("valley.toml")));
    put.map(|()| path).map_err(|cause| cause.to_string().into())
}

/// Files of the user are kept; what is on its way between page and worker is not.
fn keep(path: &Path, bytes: Option<&[u8]>) {
    if path.starts_with(files::current_dir()) {
        keep_file(&path.to_string_lossy(), bytes.map(Uint8Array::from));
    }
}

fn listening(
    worker: &Worker,
    remote: Rc<Remote>,
    context: Rc<RefCell<Option<Context>>>,
) -> Closure<dyn FnMut(MessageEvent)> {
    let take = move |event: MessageEvent| {
        let data = event.data();
        let part = |name: &str| js_sys::Reflect::get(&data, &name.into()).unwrap_or(JsValue::UNDEFINED);
        let (Some(text), Ok(arrays)) = (part("text").as_string(), part("arrays").dyn_into::<Array>()) else {
            return;
        };
        remote.take(parcel_of(text, &arrays));
        if let Some(context) = &*context.borrow() {
            context.request_repaint();
        }
    };
    let messages = Closure::<dyn FnMut(MessageEvent)>::new(take);
    let function: &Function = messages.as_ref().unchecked_ref();
    worker.set_onmessage(Some(function));
    messages
}
