//! Which parts of the landscape the sun's depths are kept of, for a camera.
//!
//! Each cascade is a square across the sun's rays around the sphere that holds what the camera sees up to a distance, so
//! that it neither turns nor grows with the camera; its middle moves by whole texels, so that the edges of shadows stay
//! where they are (Valient 2008, "Stable rendering of cascaded shadow maps", Shader X6). What differs: it moves by an eighth
//! of its side at once, and what is drawn into it is chosen from a point that moves by steps as well, so that a cascade is
//! drawn once for many pictures of a camera that moves. What the camera sees begins at the nearest ground in sight: steps are a
//! share of that distance, and a cascade that ends far before it is nowhere. The last holds all.

use weald::picture::Camera;

use super::frustum::{Box3, Frustum};

/// Cascades, of which the last holds the whole landscape.
pub(super) const CASCADES: usize = 4;

/// Texels along the side of a cascade.
pub(super) const TEXELS: u32 = 2048;

/// Distances from the camera, in metres, up to which all but the last reach.
const REACHES: [f32; CASCADES - 1] = [36.0, 300.0, 2400.0];

/// How many times the middle of a cascade moves along its side.
const STRIDES: f32 = 8.0;

/// Metres by which the point moves at least from which is chosen what all but the last hold, and how finely; and the share of the
/// distance to the nearest ground in sight.
const EYE_STRIDES: [f32; CASCADES - 1] = [2.0, 8.0, 32.0];
const EYE_STRIDE: f32 = 1.0 / 8.0;

/// Metres that trees of woods are high at most. Where they are drawn one by one their shadows would leap: the point moves by so
/// little that none is seen higher or lower by more than so many pixels, and where that is less than so many metres, it is the
/// camera's.
pub(super) const TREE: f32 = 25.0;
const TREE_PIXELS: f32 = 1.0;
const LEAST_STRIDE: f32 = 0.25;

/// A cascade comes in where the nearest ground in sight lies between so many times its reach: first not at all, then wholly.
const COMES_IN: [f32; 2] = [1.25, 1.0];

/// The square of a cascade that is not there: nowhere.
pub(super) const NOWHERE: [f32; 4] = [1e9, 1e9, 1.0, 1.0];

/// Share by which the last is wider than the landscape.
const MARGIN: f32 = 1.02;

/// The cascades of a camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Cascades {
    /// Directions across the sun's rays.
    pub(super) right: [f32; 3],
    pub(super) up: [f32; 3],
    /// Height along the rays from which depths count, and how far they count.
    pub(super) depths: [f32; 2],
    /// Middle and half the sides of each.
    pub(super) squares: [[f32; 4]; CASCADES],
    /// From where is chosen what all but the last hold; with how far the eye is from there at most.
    pub(super) detail_points: [[f32; 4]; CASCADES - 1],
    /// How much of each counts: nothing of those that end far before the nearest ground in sight, all of the last.
    pub(super) shares: [f32; CASCADES],
}

/// What cascades are chosen for.
#[derive(Clone, Copy, Debug)]
pub(super) struct ViewedFrom<'a> {
    pub(super) camera: &'a Camera,
    /// The point from which detail is chosen.
    pub(super) detail_from: [f32; 3],
    /// Metres from there to the nearest ground in sight, with trees.
    pub(super) nearest: f32,
    /// The angle of a pixel where trees are drawn one by one.
    pub(super) trees: Option<f32>,
}

fn dot(a: [f32; 3], b: [f32; 3]) -> f32 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Directions across the rays of a sun.
fn across(sun: [f32; 3]) -> [[f32; 3]; 2] {
    let run = sun[0].hypot(sun[1]);
    let right = if run > 1e-6 { [sun[1] / run, -sun[0] / run, 0.0] } else { [1.0, 0.0, 0.0] };
    let up = [
        right[1] * sun[2] - right[2] * sun[1],
        right[2] * sun[0] - right[0] * sun[2],
        right[0] * sun[1] - right[1] * sun[0],
    ];
    [right, up]
}

/// Least and greatest of a direction over the corners of a box.
fn extent(of: &Box3, along: [f32; 3]) -> [f32; 2] {
    let corner = |bits: usize| std::array::from_fn(|axis| of[bits >> axis & 1][axis]);
    let heights = (0..8).map(|bits| dot(corner(bits), along));
    heights.fold([f32::INFINITY, f32::NEG_INFINITY], |[low, high], at| [low.min(at), high.max(at)])
}

impl Cascades {
    /// For a sun in a direction and a landscape within a box, around which ground goes on or not.
    pub(super) fn new(sun: [f32; 3], view: &ViewedFrom<'_>, landscape: &Box3, has_horizon: bool) -> Self {
        let [right, up] = across(sun);
        let around = if has_horizon { REACHES[CASCADES - 2] } else { 0.0 };
        let [low, high] = extent(landscape, sun);
        let [low, high] = [low - around, high + around];
        let whole = [extent(landscape, right), extent(landscape, up)];
        let [middle_x, middle_y] = whole.map(|[low, high]| 0.5 * (low + high));
        let [half_x, half_y] = whole.map(|[low, high]| 0.5 * MARGIN * (high - low).max(1e-3));
        let shares = std::array::from_fn(|cascade| {
            let Some(reach) = REACHES.get(cascade) else { return 1.0 };
            let [none, whole] = COMES_IN.map(|times| times * reach);
            ((none - view.nearest) / (none - whole)).clamp(0.0, 1.0)
        });
        let squares = std::array::from_fn(|cascade| match REACHES.get(cascade) {
            None => [middle_x, middle_y, half_x, half_y],
            Some(_) if shares[cascade] <= 0.0 => NOWHERE,
            Some(&reach) => square(view.camera, [right, up], reach),
        });
        let detail_points = std::array::from_fn(|cascade| view.detail_point(cascade));
        Self { right, up, depths: [high, (high - low).max(1e-3)], squares, detail_points, shares }
    }

    /// Metres of a texel of the last, which holds all.
    pub(super) fn last_texel(&self) -> f32 {
        let [_, _, half_x, half_y] = self.squares[CASCADES - 1];
        2.0 * half_x.max(half_y) / TEXELS as f32
    }

    /// What lies in the column of a cascade.
    pub(super) fn column(&self, cascade: usize) -> Frustum {
        let [x, y, half_x, half_y] = self.squares[cascade];
        Frustum::between([self.right, self.up], [[x - half_x, x + half_x], [y - half_y, y + half_y]])
    }
}

impl ViewedFrom<'_> {
    /// From where is chosen what a cascade holds, and how far that is from where it is looked at, at most.
    fn detail_point(&self, cascade: usize) -> [f32; 4] {
        let stride = self.stride(cascade);
        if stride < LEAST_STRIDE {
            let [x, y, z] = self.detail_from;
            return [x, y, z, 0.0];
        }
        let [x, y, z] = self.detail_from.map(|at| (at / stride).round() * stride);
        [x, y, z, 0.5 * stride * 3.0_f32.sqrt()]
    }

    /// Metres by which that point moves: a power of two, so that it rests while the nearest ground comes nearer.
    fn stride(&self, cascade: usize) -> f32 {
        let stride = (EYE_STRIDE * self.nearest).max(EYE_STRIDES[cascade]);
        let among_trees = |angle: f32| TREE_PIXELS * angle * self.nearest * self.nearest / TREE;
        let stride = self.trees.map_or(stride, |angle| among_trees(angle).min(stride));
        stride.clamp(0.5 * LEAST_STRIDE, EYE_STRIDE * REACHES[CASCADES - 2]).log2().floor().exp2()
    }
}

/// The square around what a camera sees up to a distance.
fn square(camera: &Camera, axes: [[f32; 3]; 2], reach: f32) -> [f32; 4] {
    let spread = camera.half[0].hypot(camera.half[1]);
    let (ahead, radius) = if spread < 1.0 {
        (0.5 * reach * (1.0 + spread * spread), 0.5 * reach * (1.0 + spread * spread))
    } else {
        (reach, reach * spread)
    };
    let middle: [f32; 3] = std::array::from_fn(|axis| camera.eye[axis] + ahead * camera.forward[axis]);
    // As much wider as its middle may lie off.
    let half = radius / (1.0 - 1.0 / STRIDES);
    let stride = 2.0 * half / STRIDES;
    let [x, y] = axes.map(|axis| (dot(middle, axis) / stride).round() * stride);
    [x, y, half, half]
}

#[cfg(test)]
mod tests {
    use super::*;
    use weald::picture::{LitScene, View};
    use weald::{Domain, Field, Landscape, Size};

    fn scene() -> LitScene {
        let size = Size::square(20).expect("small");
        let mut landscape = Landscape::new(Domain::new(size, 10.0));
        landscape.insert("height", "m", Field::from_function(size, |x, y| (x * y) as f32));
        LitScene::new(&View::default(), &landscape).expect("a scene")
    }

    /// What a camera sees that stands on the ground.
    fn viewed(camera: &Camera) -> ViewedFrom<'_> {
        ViewedFrom { camera, detail_from: camera.eye, nearest: 1.0, trees: None }
    }

    #[test]
    fn a_moving_and_turning_camera_moves_cascades_by_whole_texels_and_leaves_their_size() {
        let scene = scene();
        let landscape = [[0.0, -200.0, -10.0], [200.0, 0.0, 400.0]];
        let camera = Camera::looking([50.0, -90.0, 30.0], [0.6, 0.8, 0.0], [0.5, 0.3]);
        let first = Cascades::new(scene.sun(), &viewed(&camera), &landscape, false);
        let mut moved = 0;
        for step in 1..40_u16 {
            let step = f32::from(step);
            let turn = 0.01 * step;
            let camera = Camera::looking(
                [50.0 + 0.013 * step, -90.0, 30.0],
                [turn.cos(), turn.sin(), 0.0],
                [0.5, 0.3],
            );
            let next = Cascades::new(scene.sun(), &viewed(&camera), &landscape, false);
            assert_eq!(next.squares[CASCADES - 1], first.squares[CASCADES - 1], "the last holds all, always");
            for (a, b) in first.squares.iter().zip(&next.squares).take(CASCADES - 1) {
                assert_eq!(a[2], b[2]);
                let texels = (b[0] - a[0]) / (2.0 * a[2] / TEXELS as f32);
                assert!((texels - texels.round()).abs() < 2e-2, "{texels}");
                moved += usize::from(texels.round() != 0.0);
            }
        }
        assert!(moved > 30);
    }

    #[test]
    fn cascades_come_in_with_the_ground_in_sight_and_trees_move_them_by_pixels() {
        let scene = scene();
        let landscape = [[0.0, -200.0, -10.0], [200.0, 0.0, 400.0]];
        let camera = Camera::looking([50.3, -90.1, 730.7], [0.6, 0.8, 0.0], [0.5, 0.3]);
        let of = |nearest: f32, trees: Option<f32>| {
            let view = ViewedFrom { nearest, trees, ..viewed(&camera) };
            Cascades::new(scene.sun(), &view, &landscape, false)
        };
        for (cascade, reach) in REACHES.into_iter().enumerate() {
            let shares = [0.5, 1.0, 1.125, 1.25, 40.0].map(|times| of(times * reach, None).shares[cascade]);
            assert_eq!(shares, [1.0, 1.0, 0.5, 0.0, 0.0]);
            let square = |nearest: f32| of(nearest, None).squares[cascade];
            assert!(square(reach) != NOWHERE && square(1.3 * reach) == NOWHERE);
        }
        let off = |nearest: f32, trees: Option<f32>| of(nearest, trees).detail_points.map(|point| point[3]);
        // Among trees the point is the camera's; 700 m from them they may be seen a pixel of 1 mrad higher or lower.
        assert_eq!(off(50.0, Some(1e-3)), [0.0; 3]);
        assert_eq!(off(700.0, Some(1e-3))[2], 8.0 * 3.0_f32.sqrt());
        assert!(off(700.0, Some(1e-5)).iter().all(|&off| off == 0.0), "through a telescope");
        assert_eq!(off(1.0, None), [1.0, 4.0, 16.0].map(|half| half * 3.0_f32.sqrt()));
        for nearest in [30.0, 400.0, 1500.0, 9000.0] {
            for [point, off] in
                of(nearest, Some(1e-3)).detail_points.map(|[x, y, z, off]| [[x, y, z, 0.0], [off; 4]])
            {
                let away =
                    [0, 1, 2].map(|axis| (point[axis] - camera.eye[axis]).powi(2)).iter().sum::<f32>().sqrt();
                assert!(away <= off[0] + 1e-3, "{away} m off, at most {}", off[0]);
            }
        }
    }

    #[test]
    fn the_last_cascade_holds_every_corner_and_depths_begin_at_the_sun() {
        let scene = scene();
        let landscape = [[0.0, -200.0, -10.0], [200.0, 0.0, 400.0]];
        let cascades = Cascades::new(scene.sun(), &viewed(&scene.camera()), &landscape, false);
        let [x, y, half_x, half_y] = cascades.squares[CASCADES - 1];
        for bits in 0..8_usize {
            let corner: [f32; 3] = std::array::from_fn(|axis| landscape[bits >> axis & 1][axis]);
            assert!((dot(corner, cascades.right) - x).abs() < half_x);
            assert!((dot(corner, cascades.up) - y).abs() < half_y);
            let depth = (cascades.depths[0] - dot(corner, scene.sun())) / cascades.depths[1];
            assert!((-1e-5..=1.0 + 1e-5).contains(&depth), "{depth}");
        }
        assert!(dot(cascades.right, cascades.up).abs() < 1e-6 && dot(cascades.up, scene.sun()).abs() < 1e-6);
    }
}
