//! The plants of one kind on a device.

use weald::error::{Limit, Quantity};
use weald::grow::Vegetation;
use weald::grow::ifs::Ifs;
use weald::grow::ifs::foliage::{Colours, Habit};
use weald::grow::ifs::limbs::Limbs;
use weald::picture::{LitScene, linear_of_srgb};
use weald::plants::{Plant, Plants};
use weald::random::{hash2, unit};
use weald::{Error, Landscape};
use wgpu::{BindGroup, BufferUsages};

use super::lists::{LISTS, VIEWS};
use super::mesh::{CarriedLimbs, DRAW, Mesh, filled};
use super::pipelines::Groups;
use crate::gpu::Gpu;
use crate::memory::Store;
use crate::pace::Pace;
use crate::render::records::{Records, WORDS};
use crate::transfer::Transfer;

/// Plants of a workgroup, as `choose.wgsl` has it.
const GROUP: u32 = 256;

/// Distance in metres by which roots reach into the ground, beside the height of the plant, as `stand.wgsl` has it.
const ROOTED: f32 = 0.01;

/// Plants of one kind.
#[derive(Debug)]
pub(super) struct Batch {
    pub(super) choose: BindGroup,
    pub(super) carry: BindGroup,
    pub(super) draw: BindGroup,
    pub(super) stand: BindGroup,
    pub(super) mesh: Mesh,
    /// Workgroups that look at all plants.
    pub(super) groups: u32,
    /// Whether leaves are divided into leaflets where they are seen from close by.
    pub(super) is_divided: bool,
    /// Where lists start.
    pub(super) starts: Store,
    kept: Store,
    plants: Store,
    _limbs: CarriedLimbs,
    _seen: Records,
    _stores: [Store; 2],
}

/// What the plants of one kind have in common.
pub(super) struct Kind<'a> {
    pub(super) limbs: &'a Limbs,
    pub(super) colours: Colours,
    /// Leaflets or needles on a side of a leaf from close by, and the share of its edge that they take; none where leaves are
    /// whole.
    pub(super) leaflets: [f32; 2],
    /// How far trees of a wood are drawn, whether they are conifers, and how many squares of it are known along a side;
    /// nothing for other plants.
    pub(super) wood: [f32; 3],
}

/// The limbs of a plant in the habit that its fractal has by itself.
pub(super) fn limbs_of(ifs: &Ifs) -> Limbs {
    Limbs::of(ifs, Habit::of(ifs, None))
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
        let kind = Kind {
            limbs: &limbs_of(&fractal.ifs),
            colours: colours(&plants.kind),
            leaflets: leaflets(&plants.kind),
            wood: [0.0; 3],
        };
        Self::of(gpu, &kind, &stood, groups)
    }

    /// So many places for trees of a wood, in none of which one stands yet.
    pub(super) fn wood(gpu: &Gpu, kind: &Kind<'_>, places: usize, groups: &Groups) -> Result<Self, Error> {
        Self::of(gpu, kind, &vec![[0; WORDS]; places], groups)
    }

    fn of(gpu: &Gpu, of: &Kind<'_>, stood: &[[u32; WORDS]], groups: &Groups) -> Result<Self, Error> {
        let count = stood.len().max(1) as u64;
        ensure_bound(gpu, count)?;
        let workgroups = count.div_ceil(u64::from(GROUP));
        let room = |what: &str, words: u64, usage| {
            Store::new(gpu, what, 4 * words, BufferUsages::STORAGE | BufferUsages::COPY_SRC | usage)
        };
        let none = BufferUsages::empty();
        let kind = filled(gpu, "a kind of plants", &kind(of, count), BufferUsages::UNIFORM)?;
        let plants = filled(gpu, "plants", stood.as_flattened(), BufferUsages::STORAGE)?;
        let kept = room("plants in sight", count * VIEWS as u64, none)?;
        let starts = room("lists of plants", (VIEWS * (LISTS + 1)) as u64, BufferUsages::VERTEX)?;
        let counts = room("counts of plants", workgroups * (VIEWS * LISTS) as u64, none)?;
        let seen = Records::new(gpu, "plants as they are seen", VIEWS as u64 * count)?;
        let (mesh, limbs) = (Mesh::new(gpu, of.limbs)?, CarriedLimbs::new(gpu, of.limbs)?);
        let to_choose = [&kind, &plants, &kept, &starts, &mesh.draws, &counts];
        let to_carry = [&kind, &plants, &kept, &starts, &limbs.layers, &limbs.carried];
        Ok(Self {
            choose: groups.choose(gpu, &to_choose, &seen)?,
            carry: groups.carry(gpu, &to_carry, &limbs.textures())?,
            draw: groups.draw(gpu, &kind, &[limbs.for_leaves(), seen.resource()])?,
            stand: groups.stand(gpu, &[&kind, &plants])?,
            mesh,
            groups: workgroups as u32,
            is_divided: of.leaflets[0] > 0.0,
            kept,
            starts,
            plants,
            _limbs: limbs,
            _seen: seen,
            _stores: [kind, counts],
        })
    }

    /// The list and number of each plant that was chosen for the camera.
    pub(super) fn chosen(&self, gpu: &Gpu) -> Result<Vec<[u32; 2]>, Error> {
        let [draws, starts, kept] =
            [&self.mesh.draws, &self.starts, &self.kept].map(|store| words(gpu, store));
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
    let most = (gpu.largest_binding() / (4 * WORDS as u64)).min(Records::most(gpu) / VIEWS as u64);
    if count <= most {
        return Ok(());
    }
    let limit = Limit::new(Quantity::Plants, count, 0..=most);
    let subject = format!("one set of plants, drawn by {}", gpu.context.adapter);
    Err(limit.of(subject).remedy("choose a smaller `count` or a wider `spacing` in `scatter`").into())
}

/// All words of a buffer, after all that was submitted.
fn words(gpu: &Gpu, store: &Store) -> Result<Vec<u32>, Error> {
    let mut pace = Pace::new(gpu.most_moved);
    let values = Transfer::new(gpu)?.read(gpu, &mut pace, &store.buffer, store.buffer.size())?;
    Ok(values.into_iter().map(f32::to_bits).collect())
}

/// Colours in linear light, how far the plant reaches, what there is to say of a wood, its leaflets, how many limbs it has, and how
/// many plants there are.
fn kind(of: &Kind<'_>, plants: u64) -> [u32; 16] {
    let limbs = of.limbs;
    let [a, b, c] = linear_of_srgb(of.colours.leaf);
    let [d, e, f] = linear_of_srgb(of.colours.stem);
    let [reach, is_conifer, side] = of.wood;
    let [count, share] = of.leaflets;
    let leaf = [a, b, c, limbs.radius()];
    let leaflets = [count, share, limbs.limbs.len() as f32, plants as f32];
    let rows = [leaf, [d, e, f, 0.0], [reach, is_conifer, side, 0.0], leaflets];
    std::array::from_fn(|word| rows[word / 4][word % 4].to_bits())
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

/// Leaflets on a side of the leaves of a kind of plants by its name, or needles, where each is a spray of them, and the share of
/// its edge that they take.
pub(super) fn leaflets(kind: &str) -> [f32; 2] {
    match kind {
        "spruce" => [6.0, 0.55],
        "crown" => [4.0, 0.8],
        _ => [0.0; 2],
    }
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
}
