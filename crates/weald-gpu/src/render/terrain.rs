//! The patches of ground that a camera sees, on the device.

use weald::Error;
use weald::picture::{Camera, LitScene, Rim, SceneTexture};
use wgpu::{CommandEncoderDescriptor, RenderPass};

use super::cascades::{CASCADES, Cascades, TREE, ViewedFrom};
use super::frame::Drawn;
use super::frustum::{Box3, Frustum, Heights};
use super::instances::{Indices, Instances};
use super::lattice::{Lattice, Patch, QUADS, Viewpoint};
use super::nearest::nearest_ground;
use super::patch_heights::{HEIGHTS_GROUP, PatchHeights};
use super::skyline::seen_patches;
use super::spacing::{Ranges, errors};
use super::upload::Upload;
use crate::gpu::Gpu;

/// Pixels that the error of the ground may take on the screen where a level ends, at one place in a hundred. Software takes as
/// long for a triangle as for a pixel, and draws half as many of them as by one pixel's error; with two, levels are seen to leap.
const ERROR: f32 = 1.5;

/// Vertices of a wall.
const WALL: u32 = 6;

/// The ground of a scene, and the patches of its last picture.
#[derive(Debug)]
pub(super) struct Terrain {
    lattice: Lattice,
    heights: Heights,
    errors: Vec<f32>,
    is_empty: bool,
    /// Whether some of it has no data, and hides nothing.
    has_holes: bool,
    /// Direction of the sun.
    sun: [f32; 3],
    grid: Indices,
    wall: Indices,
    /// What the camera sees, and each cascade of the sun.
    seen: Vec<Seen>,
    rims: Instances<[f32; 8]>,
    pub(super) patch_heights: PatchHeights,
    /// Whether ground goes on beyond the border: there are no sides then.
    has_horizon: bool,
}

/// From where and how a camera's ground is selected.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Shown {
    /// The point from which detail is chosen.
    pub(super) detail_from: [f32; 3],
    /// Metres from there to the nearest ground in sight.
    pub(super) nearest: f32,
    /// How far trees of woods are drawn one by one, in metres.
    pub(super) woods: f32,
    /// Whether the ground on the device is the one whose heights are known here, which says what it hides.
    pub(super) heights_are_known: bool,
}

/// A patch with the slot of its heights.
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
struct Slotted {
    patch: Patch,
    slot: u32,
}

/// The same with the edge of it that has a wall: 0 to 3 for north, east, south, west.
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
struct Side {
    patch: Slotted,
    edge: u32,
}

/// The patches and sides in one view.
#[derive(Debug)]
struct Seen {
    patches: Instances<Slotted>,
    /// Those that lie in part beyond the border, where ground goes on.
    beyond: Instances<Slotted>,
    sides: Instances<Side>,
    /// Whether what looks at them is above the ground for certain, and sees none of it from below.
    from_above: bool,
}

impl Seen {
    fn new(gpu: &Gpu) -> Result<Self, Error> {
        Ok(Self {
            patches: Instances::new(gpu, "patches")?,
            beyond: Instances::new(gpu, "patches beyond the border")?,
            sides: Instances::new(gpu, "sides")?,
            from_above: false,
        })
    }

    fn write(
        &mut self,
        into: &mut Upload<'_>,
        lattice: &Lattice,
        patches: Vec<Slotted>,
        sides: &[Side],
    ) -> Result<(), Error> {
        let (beyond, within): (Vec<_>, Vec<_>) =
            patches.into_iter().partition(|slotted| lattice.is_beyond(&slotted.patch));
        self.patches.write(into, &within)?;
        self.beyond.write(into, &beyond)?;
        self.sides.write(into, sides)
    }
}

/// Bytes between two instances.
pub(super) const PATCH_BYTES: u64 = size_of::<Slotted>() as u64;
pub(super) const RIM_BYTES: u64 = size_of::<[f32; 8]>() as u64;
pub(super) const SIDE_BYTES: u64 = size_of::<Side>() as u64;

impl Terrain {
    pub(super) fn new(gpu: &Gpu, scene: &LitScene, maps: &[SceneTexture]) -> Result<Self, Error> {
        let top = maps.iter().find(|map| map.name == "top").expect("every scene has a ground");
        let (cells, metres) = (scene.cells().map(|cells| cells as f32), scene.spacing());
        let beyond = scene.beyond();
        let lattice = Lattice::new(cells, metres).with_horizon(beyond.is_some());
        Ok(Self {
            heights: Heights::new(top, metres, scene.base()).with_beyond(beyond, cells),
            errors: errors(top, lattice.all_levels()),
            is_empty: scene.is_empty(),
            has_holes: scene.has_holes(),
            sun: scene.sun(),
            grid: Indices::new(gpu, "indices of a patch", &grid(QUADS, QUADS))?,
            wall: Indices::new(gpu, "indices of a wall", &grid(QUADS, 1))?,
            seen: (0..=CASCADES).map(|_| Seen::new(gpu)).collect::<Result<_, _>>()?,
            rims: rims(gpu, scene)?,
            patch_heights: PatchHeights::new(gpu)?,
            has_horizon: beyond.is_some(),
            lattice,
        })
    }

    /// Selects what a camera sees for a picture of such a size.
    pub(super) fn prepare(
        &mut self,
        into: &mut Upload<'_>,
        camera: &Camera,
        size: [u32; 2],
        Shown { detail_from, nearest, woods, heights_are_known }: Shown,
    ) -> Result<Drawn, Error> {
        let stand = self.viewpoint(detail_from);
        let ranges = self.ranges(camera, size);
        let pixel_angle = camera.pixel_angle(size[0] as usize);
        let trees = (woods > 0.0).then_some(pixel_angle);
        self.patch_heights.begin();
        let mut patches = self.patches_in(&Frustum::of(camera), stand, &ranges);
        let from_above = self.is_above_ground(camera.eye);
        self.seen[0].from_above = from_above;
        if heights_are_known && from_above && !self.has_holes {
            patches = seen_patches(camera, (&self.lattice, &self.heights), patches);
        }
        self.take_patches(into, 0, patches)?;
        Ok(Drawn {
            stand,
            slides: ranges.slides(),
            detail_from,
            seconds: 0.0,
            is_dry: false,
            cascades: Cascades::new(
                self.sun,
                &ViewedFrom { camera, detail_from, nearest, trees },
                &self.bounds(),
                self.has_horizon,
            ),
            woods,
            grass: [1.0; 2],
            stale: [true; CASCADES],
            before: None,
        })
    }

    /// Selects what a cascade of a picture holds that a camera changes, and says from where.
    pub(super) fn prepare_cascade(
        &mut self,
        into: &mut Upload<'_>,
        number: usize,
        (camera, size): (&Camera, [u32; 2]),
        cascades: &Cascades,
    ) -> Result<Viewpoint, Error> {
        let [x, y, z, _] = cascades.detail_points[number];
        let (stand, ranges) = (self.viewpoint([x, y, z]), self.ranges(camera, size));
        self.select(into, (number + 1, &cascades.column(number)), stand, &ranges)?;
        Ok(stand)
    }

    /// The distances up to which levels of detail reach in a picture.
    fn ranges(&self, camera: &Camera, size: [u32; 2]) -> Ranges {
        let cell = self.lattice.metres[0].max(self.lattice.metres[1]);
        let reach = 1.0 / (ERROR * camera.pixel_angle(size[0] as usize));
        Ranges::new(&self.errors, reach, cell)
    }

    /// A point from which detail is chosen.
    fn viewpoint(&self, [east, north, up]: [f32; 3]) -> Viewpoint {
        let [width, height] = self.lattice.metres;
        let place = [0.5 + east / width, 0.5 - north / height];
        // Without what it may have risen since: ground that is followed has the levels of the same ground that is not.
        let highest = self.heights.highest() - self.heights.slack();
        Viewpoint { place, above: (up - highest).max(0.0) }
    }

    /// Metres from a point to the nearest ground that a camera sees, with plants so high on it, or to the plain below a block.
    pub(super) fn nearest_in_sight(&self, camera: &Camera, from: [f32; 3], tallest: f32) -> f32 {
        let plain = if self.has_horizon { f32::INFINITY } else { (from[2] - self.heights.base()).abs() };
        if self.is_empty {
            return plain;
        }
        let view = Frustum::of(camera);
        plain.min(nearest_ground(from, &self.lattice, (&self.heights, &view), TREE.max(tallest)))
    }

    /// Whether a point is for certain above the ground, not only beside it.
    fn is_above_ground(&self, point: [f32; 3]) -> bool {
        let corner = self.viewpoint(point).place.map(|at| at - 1.0);
        let is_beside = !self.has_horizon && !self.lattice.holds(corner.map(|at| at + 1.0));
        let lowest = if is_beside { self.heights.base() } else { self.heights.bounds(corner, 2.0)[1] };
        point[2] > lowest
    }

    /// Height in metres of a camera above all ground, that beyond the border too.
    pub(super) fn above_all(&self, camera: &Camera) -> f32 {
        (camera.eye[2] - self.heights.highest_around()).max(0.0)
    }

    /// Selects what is seen in a view.
    fn select(
        &mut self,
        into: &mut Upload<'_>,
        (number, view): (usize, &Frustum),
        stand: Viewpoint,
        ranges: &Ranges,
    ) -> Result<(), Error> {
        let patches = self.patches_in(view, stand, ranges);
        self.take_patches(into, number, patches)
    }

    /// The patches of a view; none where there is no ground.
    fn patches_in(&self, view: &Frustum, stand: Viewpoint, ranges: &Ranges) -> Vec<Patch> {
        if self.is_empty { Vec::new() } else { self.lattice.select(stand, ranges, &self.heights, view) }
    }

    /// Selects all ground for the sun's last cascade, whatever a camera sees: so finely that texels of so many metres do
    /// not show how finely.
    pub(super) fn prepare_whole(&mut self, into: &mut Upload<'_>, texel: f32) -> Result<(), Error> {
        let is_fine = |&level: &usize| self.errors[level] <= 0.5 * texel;
        let level = (0..self.lattice.levels).rev().find(is_fine).unwrap_or(0);
        let patches = if self.is_empty { Vec::new() } else { self.lattice.whole(level) };
        self.take_patches(into, CASCADES, patches)
    }

    /// Has a view draw such patches, with walls where the landscape ends.
    fn take_patches(
        &mut self,
        into: &mut Upload<'_>,
        number: usize,
        patches: Vec<Patch>,
    ) -> Result<(), Error> {
        let heights = &mut self.patch_heights;
        let slotted = |patch: Patch| Slotted { patch, slot: heights.slot(&patch) };
        let patches: Vec<_> = patches.into_iter().map(slotted).collect();
        let sides: Vec<_> = patches.iter().flat_map(|patch| self.sides_of(*patch)).collect();
        self.seen[number].write(into, &self.lattice, patches, &sides)
    }

    /// Whether ground goes on beyond the border.
    pub(super) fn has_horizon(&self) -> bool {
        self.has_horizon
    }

    /// Lets heights rise and sink by a share of the relief.
    pub(super) fn widen(&mut self, share: f32) {
        self.heights.widen(share * (self.heights.highest() - self.heights.lowest()));
    }

    /// How many squares have bounds of their heights.
    pub(super) fn squares(&self) -> usize {
        self.heights.squares()
    }

    /// Takes the bounds of heights as they were lately.
    pub(super) fn renew(&mut self, bounds: Vec<[f32; 2]>, share: f32) {
        self.heights.renew(bounds, share);
    }

    /// Takes another ground of the same size: its heights, and the errors of its levels.
    pub(super) fn take(&mut self, heights: Heights, errors: Vec<f32>) {
        (self.heights, self.errors) = (heights, errors);
    }

    /// Whether the camera of the last picture is above the ground.
    pub(super) fn is_seen_from_above(&self) -> bool {
        self.seen[0].from_above
    }

    /// The box around all of it.
    fn bounds(&self) -> Box3 {
        let side = self.lattice.cells[0].max(self.lattice.cells[1]);
        let [low, mut high] = self.heights.box_of([0.5; 2], side);
        high[0] = low[0] + self.lattice.cells[0] * self.lattice.metres[0];
        [[low[0], high[1] - self.lattice.cells[1] * self.lattice.metres[1], low[2]], high]
    }

    /// The edges of a patch at which the landscape ends.
    fn sides_of(&self, patch: Slotted) -> impl Iterator<Item = Side> {
        let Patch { corner, spacing, .. } = patch.patch;
        let side = QUADS as f32 * spacing;
        let [west, north] = corner.map(|at| at == 0.5);
        let [east, south] = [0, 1].map(|axis| corner[axis] + side >= self.lattice.cells[axis] + 0.5);
        let edges = [north, east, south, west].into_iter().zip(0..);
        edges.filter(|(is_end, _)| *is_end && !self.has_horizon).map(move |(_, edge)| Side { patch, edge })
    }

    /// Whether a cascade holds no ground, and so nothing that throws shadows.
    pub(super) fn is_nothing_in(&self, cascade: usize) -> bool {
        let Seen { patches, beyond, sides, .. } = &self.seen[cascade + 1];
        patches.count + beyond.count + sides.count == 0
    }

    /// Triangles of the last picture.
    pub(super) fn triangles(&self) -> u64 {
        let Seen { patches, beyond, sides, .. } = &self.seen[0];
        let quads = u64::from(QUADS) * u64::from((patches.count + beyond.count) * QUADS + sides.count);
        2 * quads
    }

    /// Draws the ground that the camera sees, 0, or a cascade, from 1 on, by the pipeline that is set.
    pub(super) fn draw_ground(&self, pass: &mut RenderPass<'_>, view: usize) {
        self.draw(pass, &self.grid, &self.seen[view].patches);
    }

    /// Draws the patches of the same that lie in part beyond the border by the pipeline that is set.
    pub(super) fn draw_beyond(&self, pass: &mut RenderPass<'_>, view: usize) {
        self.draw(pass, &self.grid, &self.seen[view].beyond);
    }

    /// Draws the walls around what has no data by the pipeline that is set.
    pub(super) fn draw_rims(&self, pass: &mut RenderPass<'_>) {
        if self.rims.count > 0 {
            pass.set_vertex_buffer(0, self.rims.buffer().slice(..));
            pass.draw(0..WALL, 0..self.rims.count);
        }
    }

    /// Draws the sides of such a view by the pipeline that is set.
    pub(super) fn draw_sides(&self, pass: &mut RenderPass<'_>, view: usize) {
        self.draw(pass, &self.wall, &self.seen[view].sides);
    }

    /// Draws instances with the heights of their patches.
    fn draw<T: bytemuck::Pod>(&self, pass: &mut RenderPass<'_>, indices: &Indices, instances: &Instances<T>) {
        pass.set_bind_group(HEIGHTS_GROUP, &self.patch_heights.group, &[]);
        indices.draw(pass, instances);
    }
}

/// The walls around what has no data: the ends of each, and the normals there.
fn rims(gpu: &Gpu, scene: &LitScene) -> Result<Instances<[f32; 8]>, Error> {
    let of = |rim: Rim| {
        let [[a, b], [c, d]] = rim.ends;
        let [[e, f], [g, h]] = rim.normals;
        [a, b, c, d, e, f, g, h]
    };
    let rims: Vec<_> = scene.rims().into_iter().map(of).collect();
    let mut instances = Instances::new(gpu, "walls around what has no data")?;
    let mut encoder = gpu.context.device.create_command_encoder(&CommandEncoderDescriptor::default());
    instances.write(&mut Upload { gpu, encoder: &mut encoder }, &rims)?;
    gpu.context.queue.submit([encoder.finish()]);
    Ok(instances)
}

/// Triangles of so many quads, whose vertices are counted row by row. The diagonals run as those of the next level do,
/// so that a patch whose odd vertices have slid away is a patch of that level.
fn grid(across: u32, down: u32) -> Vec<u16> {
    let vertex = |x: u32, y: u32| (y * (across + 1) + x) as u16;
    let quads = (0..down).flat_map(|y| (0..across).map(move |x| [x, y]));
    let triangles = quads.flat_map(|[x, y]| {
        let [a, b, c, d] = [vertex(x, y), vertex(x + 1, y), vertex(x, y + 1), vertex(x + 1, y + 1)];
        [a, c, b, b, c, d]
    });
    triangles.collect()
}
