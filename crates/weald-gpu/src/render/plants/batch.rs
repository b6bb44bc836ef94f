//! The plants of one kind on a device.

use weald::error::{Limit, Quantity};
use weald::grow::Vegetation;
use weald::grow::ifs::Ifs;
use weald::grow::ifs::foliage::{Colours, Habit};
use weald::grow::ifs::limbs::{Corner, LEVELS, Limb, Limbs};
use weald::picture::{LitScene, linear_of_srgb};
use weald::plants::{Plant, Plants};
use weald::random::{hash2, unit};
use weald::{Error, Landscape};
use wgpu::{BindGroup, BufferUsages};

use super::lists::{LISTS, SEATS, SHARED_SEATS, VIEWS};
use super::pipelines::Groups;
use crate::gpu::Gpu;
use crate::memory::Store;
use crate::pace::Pace;
use crate::transfer::{self, Transfer};

/// Bytes of an indexed indirect draw.
pub(super) const DRAW: u64 = 20;

/// Plants of a workgroup, as `choose.wgsl` has it.
const GROUP: u32 = 256;

/// Words of a plant, as `plants.wgsl` has them.
const WORDS: usize = 8;

/// Words of how a limb is carried, as `carried.wgsl` has it.
const CARRIED: u64 = 8;

/// Distance in metres by which roots reach into the ground, beside the height of the plant, as `stand.wgsl` has it.
const ROOTED: f32 = 0.01;

/// Plants of one kind.
#[derive(Debug)]
pub(super) struct Batch {
    pub(super) choose: BindGroup,
    pub(super) carry: BindGroup,
    pub(super) draw: BindGroup,
    pub(super) stand: BindGroup,
    pub(super) indices: Store,
    pub(super) draws: Store,
    /// Workgroups that look at all plants.
    pub(super) groups: u32,
    kept: Store,
    starts: Store,
    plants: Store,
    _stores: [Store; 6],
}

/// What the plants of one kind have in common.
pub(super) struct Kind<'a> {
    pub(super) ifs: &'a Ifs,
    pub(super) colours: Colours,
    /// How far trees of a wood are drawn, whether they are conifers, and how many squares of it are known along a side;
    /// nothing for other plants.
    pub(super) wood: [f32; 3],
}

impl Batch {
    pub(super) fn new(
        gpu: &Gpu,
        scene: &LitScene,
        (landscape, plants): (&Landscape, &Plants),
        groups: &Groups,
    ) -> Result<Self, Error> {
        let fractal = landscape.fractal(&plants.kind)?;
        let stood: Vec<_> =
            (0..).zip(&plants.plants).filter_map(|(n, plant)| stood(scene, n, plant)).collect();
        let kind = Kind { ifs: &fractal.ifs, colours: colours(&plants.kind), wood: [0.0; 3] };
        Self::of(gpu, &kind, &stood, groups)
    }

    /// So many places for trees of a wood, in none of which one stands yet.
    pub(super) fn wood(gpu: &Gpu, kind: &Kind<'_>, places: usize, groups: &Groups) -> Result<Self, Error> {
        Self::of(gpu, kind, &vec![[0; WORDS]; places], groups)
    }

    fn of(gpu: &Gpu, of: &Kind<'_>, stood: &[[u32; WORDS]], groups: &Groups) -> Result<Self, Error> {
        let limbs = Limbs::of(of.ifs, Habit::of(of.ifs, None));
        let count = stood.len().max(1) as u64;
        ensure_bound(gpu, count)?;
        let workgroups = count.div_ceil(u64::from(GROUP));
        let filled = |what: &str, words: &[u32], usage| filled(gpu, what, words, usage);
        let room = |what: &str, words: u64| {
            Store::new(gpu, what, 4 * words, BufferUsages::STORAGE | BufferUsages::COPY_SRC)
        };
        let table = BufferUsages::STORAGE;
        let kind = filled("a kind of plants", &kind(&limbs, of), BufferUsages::UNIFORM)?;
        let plants = filled("plants", stood.as_flattened(), table)?;
        let kept = room("plants in sight", count * VIEWS as u64)?;
        let starts = room("lists of plants", (VIEWS * (LISTS + 1)) as u64)?;
        let counts = room("counts of plants", workgroups * (VIEWS * LISTS) as u64)?;
        let (indices, templates) = lists(&limbs);
        let draws = filled("draws of plants", &templates, table | BufferUsages::INDIRECT)?;
        let indices = filled("corners of leaves", &indices, BufferUsages::INDEX)?;
        let corners: Vec<_> = limbs.corners.iter().map(Corner::packed).collect();
        let layers = filled("layers of limbs", &layers(&limbs.limbs), table)?;
        let carried = u64::from(SEATS.iter().sum::<u32>() + SHARED_SEATS) * limbs.limbs.len().max(1) as u64;
        let carried = room("limbs as they are carried", CARRIED * carried)?;
        let limbs: Vec<_> = limbs.limbs.iter().map(Limb::packed).collect();
        let limbs = filled("limbs of plants", limbs.as_flattened(), table)?;
        let corners = filled("leaves of plants", corners.as_flattened(), table)?;
        let choose = groups.choose(gpu, &[&kind, &plants, &kept, &starts, &draws, &counts])?;
        let carry = groups.carry(gpu, &[&kind, &plants, &kept, &starts, &limbs, &layers, &carried])?;
        let draw = groups.draw(gpu, &[&kind, &plants, &kept, &starts, &limbs, &corners, &carried])?;
        let stand = groups.stand(gpu, &[&kind, &plants])?;
        let stores = [kind, counts, limbs, corners, layers, carried];
        Ok(Self {
            choose,
            carry,
            draw,
            stand,
            indices,
            draws,
            groups: workgroups as u32,
            kept,
            starts,
            plants,
            _stores: stores,
        })
    }

    /// The list and number of each plant that was chosen for the camera.
    pub(super) fn chosen(&self, gpu: &Gpu) -> Result<Vec<[u32; 2]>, Error> {
        let [draws, starts, kept] = [&self.draws, &self.starts, &self.kept].map(|store| words(gpu, store));
        let (draws, starts, kept) = (draws?, starts?, kept?);
        let of_list = |list: usize| {
            let (first, count) = (starts[list] as usize, draws[DRAW as usize / 4 * list + 1] as usize);
            kept[first..first + count].iter().map(move |&number| [list as u32, number])
        };
        Ok((0..LISTS).flat_map(of_list).collect())
    }
}

impl Batch {
    /// Where the roots of all plants are, at the ground.
    pub(super) fn roots(&self, gpu: &Gpu) -> Result<Vec<[f32; 3]>, Error> {
        let words = words(gpu, &self.plants)?;
        let plants = words.chunks_exact(WORDS).map(|plant| [0, 1, 2, 3].map(|at| f32::from_bits(plant[at])));
        let plants = plants.filter(|[.., size]| *size > 0.0);
        Ok(plants.map(|[east, north, up, size]| [east, north, up + ROOTED * size]).collect())
    }
}

/// Refuses more plants than a shader can be given at once.
fn ensure_bound(gpu: &Gpu, count: u64) -> Result<(), Error> {
    let most = gpu.largest_binding() / (4 * WORDS as u64);
    if count <= most {
        return Ok(());
    }
    let limit = Limit::new(Quantity::Plants, count, 0..=most);
    let subject = format!("one set of plants, drawn by {}", gpu.context.adapter);
    Err(limit.of(subject).remedy("choose a smaller `count` or a wider `spacing` in `scatter`").into())
}

/// A buffer that holds these words.
fn filled(gpu: &Gpu, what: &str, words: &[u32], usage: BufferUsages) -> Result<Store, Error> {
    let bytes: &[u8] = bytemuck::cast_slice(words);
    let store =
        Store::new(gpu, what, bytes.len() as u64, usage | BufferUsages::COPY_DST | BufferUsages::COPY_SRC)?;
    transfer::write(gpu, &store.buffer, bytes)?;
    Ok(store)
}

/// All words of a buffer, after all that was submitted.
fn words(gpu: &Gpu, store: &Store) -> Result<Vec<u32>, Error> {
    let mut pace = Pace::new(gpu.most_moved);
    let values = Transfer::new(gpu)?.read(gpu, &mut pace, &store.buffer, store.buffer.size())?;
    Ok(values.into_iter().map(f32::to_bits).collect())
}

/// Colours in linear light, how far the plant reaches, and what there is to say of a wood.
fn kind(limbs: &Limbs, of: &Kind<'_>) -> [u32; 12] {
    let [a, b, c] = linear_of_srgb(of.colours.leaf);
    let [d, e, f] = linear_of_srgb(of.colours.stem);
    let [reach, is_conifer, side] = of.wood;
    [a, b, c, limbs.radius(), d, e, f, 0.0, reach, is_conifer, side, 0.0].map(f32::to_bits)
}

/// Colours of a kind of plants by its name: trees are darker than herbs.
pub(super) fn colours(kind: &str) -> Colours {
    let leaf = match kind {
        "spruce" | "conifer" => [0.38, 0.50, 0.27],
        "crown" | "tree" => [0.46, 0.58, 0.26],
        _ => return Colours::USUAL,
    };
    Colours { leaf, ..Colours::USUAL }
}

/// A plant on the ground that is drawn, as the device has it; none where there is no land.
fn stood(scene: &LitScene, number: i64, plant: &Plant) -> Option<[u32; WORDS]> {
    let [east, south, _] = plant.place;
    let up = scene.bed_at([east, south])? - ROOTED * plant.size;
    let [x, y, z, w] = plant.rotation().map(|part| u32::from(((32767.0 * part).round() as i16) as u16));
    let chance = unit(hash2(0x9e37, number, 3)) as f32;
    let [east, north, up, size] = [east as f32, -south as f32, up, plant.size].map(f32::to_bits);
    Some([east, north, up, size, x | y << 16, z | w << 16, plant.phase.to_bits(), chance.to_bits()])
}

/// The limbs in layers, those on the ground first, each layer on the one before: how many layers there are, where each
/// starts, where the last ends, and the limbs in that order.
fn layers(limbs: &[Limb]) -> Vec<u32> {
    let mut depths: Vec<usize> = Vec::with_capacity(limbs.len());
    for limb in limbs {
        depths.push(limb.parent.map_or(0, |parent| depths[parent as usize] + 1));
    }
    let mut order: Vec<u32> = (0..limbs.len() as u32).collect();
    order.sort_by_key(|&limb| depths[limb as usize]);
    let count = depths.iter().max().map_or(0, |deepest| deepest + 1);
    let start = |layer| order.partition_point(|&limb| depths[limb as usize] < layer) as u32;
    [count as u32].into_iter().chain((0..=count).map(start)).chain(order.iter().copied()).collect()
}

/// The corners of all lists, and what each draws of them in each view.
fn lists(limbs: &Limbs) -> (Vec<u32>, Vec<u32>) {
    let last = LEVELS as u32 - 1;
    let (mut indices, mut draws) = (Vec::new(), Vec::new());
    for list in 0..LISTS as u32 {
        let corners = limbs.triangles_of([list / 2, list.div_ceil(2).min(last)]);
        draws.extend([corners.len() as u32, 0, indices.len() as u32, 0, 0]);
        indices.extend(corners);
    }
    (indices, draws.repeat(VIEWS))
}

#[cfg(test)]
mod tests {
    use super::*;
    use weald::picture::View;
    use weald::recipe::{Overrides, Recipe};

    fn ferns() -> (LitScene, Landscape) {
        let text = "[landscape]\nsize = 60\ncell = 4.0\nseed = 5\n[[step]]\ndo = \"fbm\"\nrelief = 40.0\n\
                    [[step]]\ndo = \"scatter\"\nplant = \"fern\"\ncount = 2000\nspacing = 1.0\ninto = \"ferns\"\n\
                    [[output]]\nlayer = \"height\"\nfile = \"a.tif\"\n";
        let recipe = Recipe::parse("ferns.toml", text, &Overrides::default()).expect("a recipe");
        let landscape = recipe.landscape().expect("ground");
        (LitScene::new(&View::default(), &landscape).expect("a scene"), landscape)
    }

    #[test]
    fn plants_stand_on_the_ground_that_is_drawn_with_no_more_than_their_roots_in_it() {
        let (scene, landscape) = ferns();
        let plants = &landscape.plants("ferns").expect("scattered").plants;
        assert!(plants.len() > 1500, "{}", plants.len());
        let mut apart = 0.0_f32;
        for (number, plant) in (0..).zip(plants) {
            let [east, south, elevation] = plant.place;
            let words = stood(&scene, number, plant).expect("on land");
            let [x, north, up, size] = [0, 1, 2, 3].map(|word| f32::from_bits(words[word]));
            let top = scene.top_at([f64::from(x), f64::from(-north)]).expect("on land");
            assert!(top >= up && top - up <= 0.011 * size, "{number}: {up} under {top}");
            apart = apart.max((top - scene.drawn_height(elevation)).abs());
            assert!((f64::from(x) - east).abs() < 1e-3 && (f64::from(north) + south).abs() < 1e-3);
        }
        // The smooth surface that is drawn lies off the straight one that the step measured.
        assert!(apart > 1e-3, "else this would mean little");
    }

    #[test]
    fn layers_hold_every_limb_once_and_each_on_the_layer_before() {
        let ifs = weald::grow::ifs::shapes::find("fern").expect("built in").ifs();
        let limbs = Limbs::of(&ifs, Habit::of(&ifs, None)).limbs;
        let words = layers(&limbs);
        let count = words[0] as usize;
        let (ends, order) = words[1..].split_at(count + 1);
        let mut layer_of = vec![usize::MAX; limbs.len()];
        for layer in 0..count {
            for &limb in &order[ends[layer] as usize..ends[layer + 1] as usize] {
                let before = limbs[limb as usize].parent.map(|parent| layer_of[parent as usize]);
                assert_eq!(before, layer.checked_sub(1), "limb {limb}");
                layer_of[limb as usize] = layer;
            }
        }
        assert!(count > 2 && order.len() == limbs.len() && !layer_of.contains(&usize::MAX));
    }

    #[test]
    fn a_plant_takes_thirty_two_bytes_and_a_kind_of_it_a_few_megabytes() {
        let ifs = weald::grow::ifs::shapes::find("fern").expect("built in").ifs();
        let limbs = Limbs::of(&ifs, Habit::of(&ifs, None));
        let (indices, draws) = lists(&limbs);
        let bytes = 4 * (indices.len() + 12 * limbs.corners.len() + 8 * limbs.limbs.len());
        assert!((1 << 20..6 << 20).contains(&bytes), "{bytes}");
        assert_eq!((4 * WORDS, draws.len()), (32, VIEWS * LISTS * DRAW as usize / 4));
    }
}
