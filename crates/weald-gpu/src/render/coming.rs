//! What has become of a scene goes to the device, a few rows with each picture, into the textures that are there.

use std::collections::VecDeque;

use weald::Error;
use weald::edit::Area;
use weald::error::{DeviceError, DeviceErrorKind};
use weald::picture::{LitScene, SceneTexture, TextureKind};

use super::frustum::Heights;
use super::lattice::Lattice;
use super::maps::{Maps, Texels};
use super::spacing::errors;
use crate::gpu::Gpu;

/// Bytes that go over with one picture, as numbers of 32 bits.
const BYTES_A_PICTURE: usize = 4 << 20;

/// Rows beyond an area that its changes reach: shores, slopes and what is mixed between cells.
const MARGIN: usize = 16;

/// What a scene has become, made by any thread.
#[derive(Debug)]
pub struct SceneUpdate {
    uniforms: Vec<u8>,
    maps: Vec<SceneTexture>,
    /// Rows of the landscape that have changed, of how many; all where there are none.
    rows: Option<[usize; 2]>,
    of_rows: usize,
    heights: Heights,
    errors: Vec<f32>,
    has_horizon: bool,
    cloud_base: Option<f32>,
}

/// Some rows of a layer of a map.
#[derive(Clone, Copy, Debug)]
struct Piece {
    map: usize,
    layer: usize,
    rows: [usize; 2],
}

/// What is still to go over.
#[derive(Debug)]
pub(super) struct Coming {
    update: SceneUpdate,
    pieces: VecDeque<Piece>,
}

impl SceneUpdate {
    /// All of a scene: of [`LitScene::changed`], so that heights count from where they did.
    pub fn of(scene: &LitScene) -> Self {
        let (maps, metres) = (scene.textures(), scene.spacing());
        let top = maps.iter().find(|map| map.name == "top").expect("every scene has a ground");
        let (cells, beyond) = (scene.cells().map(|cells| cells as f32), scene.beyond());
        let lattice = Lattice::new(cells, metres).with_horizon(beyond.is_some());
        Self {
            uniforms: scene.uniforms(),
            heights: Heights::new(top, metres, scene.base()).with_beyond(beyond, cells),
            errors: errors(top, lattice.all_levels()),
            has_horizon: beyond.is_some(),
            cloud_base: scene.cloud_base(),
            rows: None,
            of_rows: scene.cells()[1],
            maps,
        }
    }

    /// Where no more than an area of cells and what is seen from there has changed: no other rows go over.
    #[must_use]
    pub fn within(self, area: Area) -> Self {
        let first = area.first[1];
        Self { rows: Some([first, first + area.size.rows]), ..self }
    }

    /// The rows of a map that have changed.
    fn rows_of(&self, map: &SceneTexture) -> [usize; 2] {
        let [_, rows] = map.size;
        let Some([first, end]) = self.rows else { return [0, rows] };
        let place = |row: usize| row * rows / self.of_rows.max(1);
        [place(first).saturating_sub(MARGIN), (place(end) + MARGIN).min(rows)]
    }

    /// All that goes over, in pieces; without the surfaces where those follow a simulation.
    fn pieces(&self, is_followed: bool) -> VecDeque<Piece> {
        let surface = |map: &SceneTexture| map.kind == TextureKind::Exact && map.name != "land";
        let maps = self.maps.iter().enumerate().filter(|(_, map)| !(is_followed && surface(map)));
        let layers = maps.flat_map(|(at, map)| (0..map.layers).map(move |layer| (at, map, layer)));
        let pieces = layers.flat_map(|(at, map, layer)| {
            let [first, end] = self.rows_of(map);
            let step = (BYTES_A_PICTURE / (4 * map.size[0] * map.kind.channels())).max(1);
            let piece = move |row: usize| Piece { map: at, layer, rows: [row, (row + step).min(end)] };
            (first..end).step_by(step).map(piece)
        });
        pieces.collect()
    }
}

impl Piece {
    fn values<'a>(&self, map: &'a SceneTexture) -> &'a [f32] {
        let row = map.size[0] * map.kind.channels();
        let layer = self.layer * map.size[1];
        &map.values[(layer + self.rows[0]) * row..(layer + self.rows[1]) * row]
    }
}

impl Coming {
    /// Makes room for maps of other sizes, as of water that there was not before; a ground of another size is refused, and
    /// a horizon where the renderer has none, or the other way round.
    pub(super) fn new(
        update: SceneUpdate,
        (gpu, maps): (&Gpu, &mut Maps),
        (is_followed, has_horizon): (bool, bool),
    ) -> Result<Self, Error> {
        if update.has_horizon != has_horizon {
            let around = |has_horizon| if has_horizon { "a horizon" } else { "a block" };
            let (asked, had) = (around(update.has_horizon), around(has_horizon));
            let message = format!("{asked} cannot take the place of {had}; make another renderer");
            return Err(DeviceError::new(DeviceErrorKind::Misused, message).into());
        }
        for map in &update.maps {
            let ([columns, rows], [had, of]) = (map.size, maps.size(map.name));
            if map.name == "top" && [columns, rows] != [had, of] {
                let message = format!(
                    "a ground of {columns} × {rows} control points cannot take the place of one of {had} × {of}; make \
                     another renderer"
                );
                return Err(DeviceError::new(DeviceErrorKind::Misused, message).into());
            }
            maps.make_room(gpu, map)?;
        }
        let pieces = update.pieces(is_followed);
        Ok(Self { update, pieces })
    }

    /// Sends all, or what goes over with one picture; whether that was the last of it.
    pub(super) fn send(&mut self, gpu: &Gpu, maps: &Maps, waits: bool) -> bool {
        let mut sent = 0;
        while let Some(piece) = self.pieces.front() {
            let map = &self.update.maps[piece.map];
            let values = piece.values(map);
            if sent > 0 && sent + 4 * values.len() > BYTES_A_PICTURE && !waits {
                return false;
            }
            sent += 4 * values.len();
            let texels = Texels { kind: map.kind, columns: map.size[0], values };
            maps.send(gpu, map.name, [piece.layer, piece.rows[0]], texels);
            self.pieces.pop_front();
        }
        maps.send_numbers(gpu, &self.update.uniforms);
        true
    }

    /// The height at which clouds begin.
    pub(super) fn cloud_base(&self) -> Option<f32> {
        self.update.cloud_base
    }

    /// The heights of the ground, and the errors of its levels.
    pub(super) fn shape(self) -> (Heights, Vec<f32>) {
        (self.update.heights, self.update.errors)
    }
}
