//! One grass of a landscape on a device: its species, and the sets that a picture chooses from.

use std::sync::mpsc::{Receiver, TryRecvError, channel};
use std::sync::{Arc, Weak};

use weald::Error;
use weald::error::{DeviceError, DeviceErrorKind};
use weald::grow::grass::choice::{Choice, LISTS};
use weald::grow::grass::{BLADES, Grasses, Meadow};
use weald::picture::Camera;
use wgpu::{BindGroup, BindGroupDescriptor, BindGroupEntry, BindGroupLayout, BindingResource, BufferUsages};

use super::blades;
use super::grass_look::GrassLook;
use super::records::Records;
use super::runs::{self, RUN};
use super::sowing::{self, GrassArea};
use crate::gpu::Gpu;
use crate::memory::Store;
use crate::transfer::uniform;

/// Bytes of a set, of its place in a list, and of the marks of a run.
const SET: u64 = 16;
const CHOSEN: u64 = 4;
const MARKS: u64 = 4;

/// Bytes of the bounds of a run.
const BOUNDS: u64 = 16;

/// Bytes of the corner of a triangle.
const CORNER: u64 = 2;

/// Bytes of what an indexed indirect draw wants.
pub(super) const DRAW: u64 = 20;

/// Threads of a workgroup, as `meadow.wgsl` has them.
const GROUP: u32 = 256;

/// One grass of a landscape.
#[derive(Debug)]
pub(super) struct GrassLayer {
    seeds: Seeds,
    /// What each view has, of which the current one is drawn.
    views: Vec<ViewerSets>,
    current: usize,
}

/// What sets are made of.
#[derive(Clone, Debug)]
struct Seeds {
    meadow: Arc<Meadow>,
    grasses: Arc<Store>,
    /// Whether some of the land has no data, so that no ground is drawn there.
    has_holes: bool,
}

/// From where grass is looked at.
#[derive(Clone, Copy, Debug)]
pub(super) struct Around<'a> {
    pub(super) from: [f32; 3],
    pub(super) camera: &'a Camera,
    pub(super) look: GrassLook,
    /// The view for which it is kept.
    pub(super) viewer: &'a Arc<()>,
    /// Whether it is waited for.
    pub(super) waits: bool,
}

/// What is shown, and of which ground; of all where there is none.
type Shown = (GrassLook, Option<GrassArea>);

/// What another thread sows.
type Sowing = (Shown, Receiver<Result<Option<LoadedSets>, Error>>);

/// What a view has.
#[derive(Debug, Default)]
struct ViewerSets {
    viewer: Weak<()>,
    shown: Option<Shown>,
    loaded: Option<LoadedSets>,
    coming: Option<Sowing>,
}

/// The sets that a picture chooses from.
#[derive(Debug)]
pub(super) struct LoadedSets {
    pub(super) count: u32,
    pub(super) sets: Store,
    pub(super) kept: Store,
    pub(super) starts: Store,
    pub(super) draws: Store,
    pub(super) cull: BindGroup,
    pub(super) light: BindGroup,
    pub(super) draw: BindGroup,
    /// Chosen sets and their blades as vertices read them.
    pub(super) lit: [Records; 2],
    /// Those of the triangles of an instance that is drawn.
    pub(super) corners: Store,
    _others: [Store; 3],
}

impl GrassLayer {
    pub(super) fn new(gpu: &Gpu, meadow: &Arc<Meadow>, has_holes: bool) -> Result<Self, Error> {
        let grasses = uniform(gpu, "the species of grass", &Grasses::new(&meadow.species, meadow.bend))?;
        let seeds = Seeds { meadow: Arc::clone(meadow), grasses: Arc::new(grasses), has_holes };
        Ok(Self { seeds, views: Vec::new(), current: 0 })
    }

    /// Most sets on a square metre.
    pub(super) fn densest(&self) -> f64 {
        self.seeds.meadow.densest
    }

    /// What the view has that was prepared last.
    pub(super) fn loaded(&self) -> Option<&LoadedSets> {
        self.views.get(self.current)?.loaded.as_ref()
    }

    /// Sows what is around a place, or all, where that is not there already. What views had that are gone is
    /// forgotten.
    pub(super) fn prepare(
        &mut self,
        gpu: &Gpu,
        around: &Around<'_>,
        layouts: &[BindGroupLayout; 3],
    ) -> Result<(), Error> {
        self.views.retain(|view| view.viewer.strong_count() > 0);
        let viewer = Arc::downgrade(around.viewer);
        let known = self.views.iter().position(|view| view.viewer.ptr_eq(&viewer));
        self.current = known.unwrap_or(self.views.len());
        if known.is_none() {
            self.views.push(ViewerSets { viewer, ..ViewerSets::default() });
        }
        let Around { from, look, camera, .. } = *around;
        let wanted = (look, look.thinned.then(|| GrassArea::around(from, look.reach, camera)));
        let view = &mut self.views[self.current];
        if around.waits {
            view.load(wanted, || self.seeds.load(gpu, wanted, layouts))
        } else {
            view.load_meanwhile(wanted, || {
                let (seeds, gpu, layouts) = (self.seeds.clone(), gpu.clone(), layouts.clone());
                move || seeds.load(&gpu, wanted, &layouts)
            })
        }
    }
}

impl ViewerSets {
    /// Sows what is wanted, unless that is there.
    fn load(
        &mut self,
        wanted: Shown,
        load: impl FnOnce() -> Result<Option<LoadedSets>, Error>,
    ) -> Result<(), Error> {
        if self.shown != Some(wanted) {
            (self.loaded, self.shown, self.coming) = (None, None, None);
            self.loaded = load()?;
            self.shown = Some(wanted);
        }
        Ok(())
    }

    /// Has another thread sow it, and shows what was there before as long as that takes.
    fn load_meanwhile<L>(&mut self, wanted: Shown, work: impl FnOnce() -> L) -> Result<(), Error>
    where
        L: FnOnce() -> Result<Option<LoadedSets>, Error> + Send + 'static,
    {
        if let Some((coming, receiver)) = &self.coming {
            match receiver.try_recv() {
                Err(TryRecvError::Empty) => return Ok(()),
                done => {
                    let (shown, done) = (*coming, done.map_err(unsown));
                    self.coming = None;
                    (self.loaded, self.shown) = (done??, Some(shown));
                }
            }
        }
        if self.shown != Some(wanted) {
            let (sender, receiver) = channel();
            let load = work();
            aside(move || drop(sender.send(load())));
            self.coming = Some((wanted, receiver));
        }
        Ok(())
    }
}

/// Does something on another thread, or at once where there is only one.
fn aside(work: impl FnOnce() + Send + 'static) {
    if cfg!(target_arch = "wasm32") {
        work();
    } else {
        std::thread::spawn(work);
    }
}

/// The thread that sowed is gone.
fn unsown(_: TryRecvError) -> Error {
    DeviceError::new(DeviceErrorKind::Failed, "grass around the camera could not grow".to_owned()).into()
}

impl Seeds {
    /// The sets that are wanted; `None` where there are none.
    fn load(
        &self,
        gpu: &Gpu,
        (look, area): Shown,
        layouts: &[BindGroupLayout; 3],
    ) -> Result<Option<LoadedSets>, Error> {
        let level = look.level.unwrap_or(self.meadow.level);
        let meadow = match look.level {
            Some(level) => &Arc::new(Meadow { level, ..(*self.meadow).clone() }),
            None => &self.meadow,
        };
        let sets = match area {
            Some(area) => area.sets(meadow)?,
            None => sowing::checked(meadow, &meadow.area())?,
        };
        if sets.is_empty() {
            return Ok(None);
        }
        let sets = runs::in_order(sets);
        let count = sets.len() as u32;
        let choice = Choice {
            culled: u32::from(look.culled),
            hides: u32::from(look.culled && !self.has_holes),
            ..if look.thinned { Choice::of_a_picture() } else { Choice::of_all(level) }
        };
        let corners = blades::corners([choice.rows[0], choice.rows[1], choice.rows[2]]);
        let stores = Stores::new(gpu, u64::from(count), &choice, corners.len())?;
        crate::transfer::write(gpu, &stores.corners.buffer, bytemuck::cast_slice(&corners))?;
        crate::transfer::write(gpu, &stores.sets.buffer, bytemuck::cast_slice(&sets))?;
        crate::transfer::write(
            gpu,
            &stores.runs.buffer,
            bytemuck::cast_slice(&runs::bounds(&sets, &meadow.species)),
        )?;
        Ok(Some(stores.bound(gpu, &self.grasses, count, layouts)?))
    }
}

impl LoadedSets {
    /// Workgroups that choose.
    pub(super) fn groups(&self) -> u32 {
        self.runs().div_ceil(GROUP)
    }

    /// Runs of sets.
    pub(super) fn runs(&self) -> u32 {
        self.count.div_ceil(RUN)
    }

    /// Where in `starts` the start of a list is, in bytes; after the last list its end.
    pub(super) fn start_of(&self, list: u64) -> u64 {
        4 * list * u64::from(self.runs())
    }
}

/// The buffers of sets.
struct Stores {
    choice: Store,
    sets: Store,
    kept: Store,
    starts: Store,
    draws: Store,
    marks: Store,
    runs: Store,
    lit: [Records; 2],
    corners: Store,
}

impl Stores {
    fn new(gpu: &Gpu, count: u64, choice: &Choice, corners: usize) -> Result<Self, Error> {
        let storage = BufferUsages::STORAGE | BufferUsages::COPY_DST | BufferUsages::COPY_SRC;
        let store = |what, bytes, usage| Store::new(gpu, what, bytes, usage);
        let lists = LISTS as u64;
        let runs = count.div_ceil(u64::from(RUN));
        let starts = 4 * (lists * runs + 1);
        Ok(Self {
            choice: uniform(gpu, "what is shown of grass", choice)?,
            sets: store("sets of grass", SET * count, storage)?,
            kept: store("grass in sight", CHOSEN * count, storage)?,
            starts: store("starts of the lists of grass", starts, storage | BufferUsages::VERTEX)?,
            draws: store("draws of grass", DRAW * (lists + 1), storage | BufferUsages::INDIRECT)?,
            marks: store("marks of grass", MARKS * runs, storage)?,
            runs: store("runs of grass", BOUNDS * runs, storage)?,
            lit: [
                Records::new(gpu, "lit grass", count)?,
                Records::new(gpu, "blades of grass", u64::from(BLADES) * count)?,
            ],
            corners: store(
                "corners of blades",
                CORNER * corners as u64,
                BufferUsages::INDEX | BufferUsages::COPY_DST,
            )?,
        })
    }

    fn bound(
        self,
        gpu: &Gpu,
        grasses: &Store,
        count: u32,
        [to_choose, to_light, to_draw]: &[BindGroupLayout; 3],
    ) -> Result<LoadedSets, Error> {
        let Self { choice, sets, kept, starts, draws, marks, runs, lit, corners } = self;
        let all = [grasses, &choice, &sets, &kept, &starts, &draws, &marks, &runs];
        let all = all.map(|store| store.buffer.as_entire_binding());
        let with_lit = |stores: usize| [&all[..stores], &lit.each_ref().map(Records::resource)].concat();
        let cull = bind(gpu, to_choose, &all)?;
        let light = bind(gpu, to_light, &with_lit(5))?;
        let draw = bind(gpu, to_draw, &with_lit(2))?;
        let others = [marks, runs, choice];
        Ok(LoadedSets { count, sets, kept, starts, draws, cull, light, draw, lit, corners, _others: others })
    }
}

fn bind(gpu: &Gpu, layout: &BindGroupLayout, bound: &[BindingResource<'_>]) -> Result<BindGroup, Error> {
    let entries = (0..).zip(bound);
    let entries: Vec<_> =
        entries.map(|(binding, resource)| BindGroupEntry { binding, resource: resource.clone() }).collect();
    let description = BindGroupDescriptor { label: Some("grass"), layout, entries: &entries };
    gpu.context.attempt("binding grass", || Ok(gpu.context.device.create_bind_group(&description)))
}
