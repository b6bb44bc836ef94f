//! Meshes keep what they promise, whatever the ground.

use std::collections::BTreeSet;

use proptest::prelude::*;

use super::delaunay::{Point, turn};
use super::frame::Frame;
use super::greedy::follow;
use super::normal_map::normal_map;
use super::plane::Plane;
use super::sampling::Sampling;
use super::scan::for_each_row;
use super::skirt::Skirt;
use super::slopes::Slopes;
use super::surface::Surface;
use super::tin::Tin;
use super::vector::{Vector, add_scaled, cross, dot, unit};
use super::vertices::Vertices;
use super::water::Water;
use super::{LayerName, Mesh};
use weald_core::domain::Domain;
use weald_core::grid::{Field, Mask, Size};
use weald_core::landscape::Landscape;
use weald_core::random::{hash2, unit as share};

const CELL: f64 = 3.0;

fn smooth(size: Size) -> Field {
    let height = |x: f64, y: f64| 40.0 * libm::sin(x / 6.0) * libm::cos(y / 9.0) + 0.8 * x;
    Field::from_function(size, |x, y| height(x as f64, y as f64) as f32)
}

/// Waves with a share of noise, and patches without data.
fn any_ground() -> impl Strategy<Value = (Field, Option<Mask>)> {
    let sides = (2..40_usize, 2..40_usize);
    (sides, any::<u64>(), 0.0..8.0_f64, 0.0..0.6_f64, 1..7_usize).prop_map(
        |((columns, rows), seed, noise, void, patch)| {
            let size = Size::new(columns, rows).expect("small");
            let waves = smooth(size);
            let noise = |x: usize, y: usize| (noise * share(hash2(seed, x as i64, y as i64))) as f32;
            let height = Field::from_function(size, |x, y| waves.at(x, y) + noise(x, y));
            let is_valid = |cell: usize| {
                let [x, y] = [cell % columns / patch, cell / columns / patch].map(|at| at as i64);
                share(hash2(seed ^ 1, x, y)) >= void
            };
            (height, Mask::new(size, (0..size.cells()).map(is_valid).collect()))
        },
    )
}

/// Twice the area of the ground, in cells: the squares between four cells with data, and half of those of three.
fn twice_the_ground(surface: &Surface<'_>) -> i64 {
    let Size { columns, rows } = surface.size();
    let squares = (0..rows as u32 - 1).flat_map(|y| (0..columns as u32 - 1).map(move |x| [x, y]));
    let area = |[x, y]: Point| {
        let corners = [[x, y], [x + 1, y], [x, y + 1], [x + 1, y + 1]];
        corners.into_iter().filter(|&corner| surface.is_valid(corner)).count().saturating_sub(2) as i64
    };
    squares.map(area).sum()
}

fn directed_edges(mesh: &Tin) -> Vec<[u32; 2]> {
    mesh.triangles.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]).collect()
}

/// Whether an edge lies along the border of the grid, or is one step beside a cell without data.
fn is_border_or_shore(surface: &Surface<'_>, [a, b]: [Point; 2]) -> bool {
    let Size { columns, rows } = surface.size();
    let lies_along =
        |axis: usize, last: usize| a[axis] == b[axis] && (a[axis] == 0 || a[axis] as usize == last);
    let is_step = a[0].abs_diff(b[0]) <= 1 && a[1].abs_diff(b[1]) <= 1;
    let near_void = |[x, y]: Point| {
        let cell = surface.size().index(x as usize, y as usize);
        surface
            .size()
            .neighbours(cell)
            .any(|other| surface.valid.is_some_and(|valid| !valid.is_valid_at(other)))
    };
    lies_along(0, columns - 1) || lies_along(1, rows - 1) || is_step && near_void(a) && near_void(b)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]
    #[test]
    fn a_mesh_is_true_to_its_error_at_every_cell((height, land) in any_ground(), error in 0.01..20.0_f64) {
        let surface = Surface::new(&height, land.as_ref(), error);
        let mesh = follow(&surface, 1 << 20).expect("few vertices");
        let deviation = mesh.deviation(&surface);
        prop_assert!(deviation <= error, "{deviation} m, not {error} m");
    }

    #[test]
    fn every_inner_edge_has_two_triangles_and_the_others_lie_on_borders_and_shores(
        (height, land) in any_ground(), error in 0.01..20.0_f64,
    ) {
        let surface = Surface::new(&height, land.as_ref(), error);
        let mesh = follow(&surface, 1 << 20).expect("few vertices");
        let edges = directed_edges(&mesh);
        let distinct: BTreeSet<_> = edges.iter().copied().collect();
        prop_assert_eq!(distinct.len(), edges.len(), "two triangles lie on the same side of an edge");
        let open: Vec<_> = edges.iter().filter(|[a, b]| !distinct.contains(&[*b, *a])).copied().collect();
        for &edge in &open {
            let places = edge.map(|vertex| mesh.points[vertex as usize]);
            prop_assert!(is_border_or_shore(&surface, places), "{places:?} is open");
        }
        let outline: BTreeSet<_> = mesh.outline().into_iter().collect();
        prop_assert_eq!(outline, open.into_iter().collect());
    }

    #[test]
    fn triangles_cover_all_ground_once_and_no_cell_without_data(
        (height, land) in any_ground(), error in 0.01..20.0_f64,
    ) {
        let surface = Surface::new(&height, land.as_ref(), error);
        let mesh = follow(&surface, 1 << 20).expect("few vertices");
        let areas: Vec<_> = mesh.places().map(|[a, b, c]| turn(a, b, c)).collect();
        prop_assert!(areas.iter().all(|&area| area > 0), "a triangle is turned over or has no area");
        prop_assert_eq!(areas.iter().sum::<i64>(), twice_the_ground(&surface));
        for triangle in mesh.places() {
            for_each_row(triangle, |row, columns| {
                let is_valid = |column: usize| surface.is_valid([column as u32, row as u32]);
                assert!(columns.clone().all(is_valid), "{triangle:?} covers a cell without data in row {row}");
            });
        }
        let used: BTreeSet<_> = mesh.triangles.iter().flatten().copied().collect();
        prop_assert_eq!(used.len(), mesh.points.len(), "a vertex belongs to no triangle");
    }

    #[test]
    fn tangents_stand_across_normals_and_on_ground_below_45_degrees_look_eastward(
        (steep, land) in any_ground(), error in 0.01..3.0_f64,
    ) {
        let gentle = steep.values().iter().map(|height| 0.15 * height).collect();
        let height = Field::from_values(steep.size(), gentle);
        let (mesh, vertices) = meshed(&height, land.as_ref(), error);
        for (&normal, &tangent) in vertices.normals.iter().zip(&vertices.tangents) {
            prop_assert!((dot(normal, normal) - 1.0).abs() < 1e-12 && (dot(tangent, tangent) - 1.0).abs() < 1e-12);
            prop_assert!(dot(normal, tangent).abs() < 1e-12);
            let north = cross(normal, tangent);
            prop_assert!(tangent[0] > 0.0 && north[2] < 0.0, "the texture is mirrored: {tangent:?}, {north:?}");
        }
        prop_assert_eq!(vertices.positions.len(), mesh.points.len());
    }
}

fn meshed(height: &Field, land: Option<&Mask>, error: f64) -> (Tin, Vertices) {
    let mesh = follow(&Surface::new(height, land, error), 1 << 20).expect("few vertices");
    let frame = Frame { size: height.size(), cell: CELL };
    let vertices = Vertices::of(&mesh, height, &Slopes::of(height, land, CELL), &frame);
    (mesh, vertices)
}

#[test]
fn a_coarser_mesh_has_fewer_triangles() {
    let size = Size::new(120, 90).expect("small");
    let triangles = [0.3, 1.5, 7.5].map(|error| meshed(&smooth(size), None, error).0.triangles.len());
    assert!(triangles.windows(2).all(|pair| pair[1] < pair[0] / 2), "{triangles:?}");
    assert!(triangles[2] > 10, "{triangles:?}");
}

#[test]
fn vertices_reach_from_the_first_centre_of_a_cell_to_the_last_with_north_at_minus_z() {
    let size = Size::new(31, 12).expect("small");
    let (_, vertices) = meshed(&smooth(size), None, 0.5);
    let bound = |axis: usize, pick: fn(f64, f64) -> f64| {
        vertices.positions.iter().map(|place| place[axis]).reduce(pick).expect("vertices")
    };
    assert_eq!([bound(0, f64::min), bound(0, f64::max)], [-45.0, 45.0]);
    assert_eq!([bound(2, f64::min), bound(2, f64::max)], [-16.5, 16.5]);
    let (north_west, _) = vertices
        .positions
        .iter()
        .zip(&vertices.textures)
        .find(|(_, texture)| texture[0] < 0.03 && texture[1] < 0.05)
        .expect("a vertex on the first cell");
    assert_eq!([north_west[0], north_west[2]], [-45.0, -16.5]);
}

#[test]
fn the_triangles_of_a_plane_have_its_area_and_its_normal() {
    let size = Size::new(57, 23).expect("small");
    let (east, south) = (0.5, -0.25);
    let height = Field::from_function(size, |x, y| (CELL * (east * x as f64 + south * y as f64)) as f32);
    let (mesh, vertices) = meshed(&height, None, 0.001);
    let area = |triangle: &[u32; 3]| {
        let [a, b, c] = triangle.map(|vertex| vertices.positions[vertex as usize]);
        let normal = cross(add_scaled(b, a, -1.0), add_scaled(c, a, -1.0));
        assert!(normal[1] > 0.0, "the front is above");
        0.5 * dot(normal, normal).sqrt()
    };
    let steepness = (1.0 + east * east + south * south).sqrt();
    let expected = 56.0 * 22.0 * CELL * CELL * steepness;
    let found: f64 = mesh.triangles.iter().map(area).sum();
    assert!((found / expected - 1.0).abs() < 1e-12, "{found} instead of {expected}");
    let normal = [-east / steepness, 1.0 / steepness, -south / steepness];
    assert!(vertices.normals.iter().all(|&found| distance(found, normal) < 1e-6));
}

fn distance(a: Vector, b: Vector) -> f64 {
    let apart = add_scaled(a, b, -1.0);
    dot(apart, apart).sqrt()
}

#[test]
fn normals_are_those_of_the_ground_and_not_of_the_triangles() {
    let size = Size::new(80, 60).expect("small");
    let (mesh, vertices) = meshed(&smooth(size), None, 2.0);
    assert!(mesh.triangles.len() < 2000, "the mesh is coarse");
    for (&[x, y], &normal) in mesh.points.iter().zip(&vertices.normals) {
        let inner = (1..79).contains(&x) && (1..59).contains(&y);
        let (x, y) = (f64::from(x), f64::from(y));
        let east = (40.0 / 6.0 * libm::cos(x / 6.0) * libm::cos(y / 9.0) + 0.8) / CELL;
        let south = -40.0 / 9.0 * libm::sin(x / 6.0) * libm::sin(y / 9.0) / CELL;
        let expected = unit([-east, 1.0, -south]);
        // A one-sided difference at the border is off by half a cell's curvature.
        let tolerance = if inner { 0.01 } else { 0.25 };
        assert!(distance(normal, expected) < tolerance, "{normal:?} at {x}, {y} instead of {expected:?}");
    }
}

#[test]
fn under_the_normal_map_a_coarse_mesh_has_the_normals_of_every_cell() {
    let size = Size::new(70, 50).expect("small");
    let height = Field::from_values(size, smooth(size).values().iter().map(|height| 0.3 * height).collect());
    let is_valid = |cell: usize| (cell % 70).abs_diff(30).pow(2) + (cell / 70).abs_diff(20).pow(2) > 60;
    let land = Mask::new(size, (0..size.cells()).map(is_valid).collect());
    let (mesh, vertices) = meshed(&height, land.as_ref(), 4.5);
    assert!(mesh.triangles.len() < 400, "{} triangles are no coarse mesh", mesh.triangles.len());
    let slopes = Slopes::of(&height, land.as_ref(), CELL);
    let map = normal_map(&mesh, &vertices, &Sampling::new(&slopes, land.as_ref(), size));
    let (mut worst, mut bare): (f64, f64) = (0.0, 0.0);
    for triangle in &mesh.triangles {
        let corners = triangle.map(|vertex| mesh.points[vertex as usize]);
        for_each_row(corners, |y, columns| {
            for x in columns {
                let shares = shares(corners, [x as u32, y as u32]);
                let of = |vectors: &[Vector]| {
                    let corner = |sum: Vector, (&vertex, share): (&u32, f64)| {
                        add_scaled(sum, vectors[vertex as usize], share)
                    };
                    triangle.iter().zip(shares).fold([0.0; 3], corner)
                };
                let (normal, tangent) = (of(&vertices.normals), of(&vertices.tangents));
                let texel = [0, 1, 2].map(|at| f64::from(map[3 * size.index(x, y) + at]) / 127.5 - 1.0);
                let axes = [tangent, cross(normal, tangent), normal];
                let lit =
                    axes.iter().zip(texel).fold([0.0; 3], |sum, (&axis, part)| add_scaled(sum, axis, part));
                let wanted = slopes.normal([x as u32, y as u32]);
                worst = worst.max(distance(unit(lit), wanted));
                bare = bare.max(distance(unit(normal), wanted));
            }
        });
    }
    assert!(bare > 0.15, "without the map the mesh is off by {bare}");
    assert!(worst < 0.02, "with it by {worst}; eight bits allow some 0.01");
}

/// Shares of three corners in a point.
fn shares([a, b, c]: [Point; 3], point: Point) -> [f64; 3] {
    let whole = turn(a, b, c) as f64;
    [turn(b, c, point), turn(c, a, point), turn(a, b, point)].map(|part| part as f64 / whole)
}

/// A bowl with a lake up to 5 m, two puddles, and a sliver of no-data across.
fn lake() -> Landscape {
    let size = Size::new(60, 50).expect("small");
    let ground = Field::from_function(size, |x, y| {
        let (x, y) = (x as f32 - 28.3, y as f32 - 25.1);
        0.03 * (x * x + y * y) + 0.3 * (x * 0.7).sin() * (y * 0.9).cos()
    });
    let mut water = Field::from_function(size, |x, y| (5.0 - ground.at(x, y)).max(0.001));
    water.set(3, 3, 2.0);
    water.set(55, 44, 2.0);
    let land = Mask::new(size, (0..size.cells()).map(|cell| cell / 60 != 18 || cell % 60 < 20).collect());
    let mut landscape = Landscape::new(Domain { valid: land, ..Domain::new(size, CELL) });
    landscape.insert("height", "m", ground);
    landscape.insert("water", "m", water);
    landscape
}

/// Heights of a mesh above the cells that it covers.
fn heights(mesh: &Tin, field: &Field) -> Vec<Option<f64>> {
    let mut heights = vec![None; field.size().cells()];
    for triangle in mesh.places() {
        let plane = Plane::through(triangle.map(|[x, y]| ([x, y], field.at(x as usize, y as usize))));
        for_each_row(triangle, |row, columns| {
            for column in columns {
                heights[field.size().index(column, row)] = Some(plane.at(column, row));
            }
        });
    }
    heights
}

#[test]
fn a_lake_lies_level_over_its_bed_and_under_its_banks_however_coarse_the_mesh() {
    let landscape = lake();
    let (ground, water) =
        (landscape.field("height").expect("there"), landscape.field("water").expect("there"));
    let land = landscape.domain.valid.as_ref();
    let lake = Water::of(&landscape, ground, 0.5).expect("a lake");
    let bed = heights(&follow(&lake.spared(ground, land, 1.0), 1 << 20).expect("few"), ground);
    let sheet = follow(&Surface::new(&lake.level, Some(&lake.sheet), 0.5), 1 << 20).expect("few");
    let (mut wet, mut banks) = (0, 0);
    for (cell, level) in heights(&sheet, &lake.level).into_iter().enumerate() {
        let (Some(level), Some(bed)) = (level, bed[cell]) else { continue };
        assert!((level - 5.0).abs() < 0.5, "the lake stands at {level}");
        if water.values()[cell] >= 0.5 {
            wet += 1;
            assert!(bed < level, "cell {cell}: the bed at {bed} stands out of the water at {level}");
        } else if ground.values()[cell] > 5.25 {
            banks += 1;
            assert!(bed > level, "cell {cell}: the bank at {bed} is under water at {level}");
        }
    }
    assert!(wet > 400 && banks > 10, "{wet} wet cells, {banks} banks");
    assert!(!lake.sheet.is_valid(3, 3) && !lake.sheet.is_valid(55, 44), "puddles are left out");
}

#[test]
fn walls_hang_from_every_open_edge_and_face_outward() {
    let landscape = lake();
    let ground = landscape.field("height").expect("there");
    let (mesh, vertices) = meshed(ground, landscape.domain.valid.as_ref(), 1.0);
    let skirt = Skirt::of(&mesh, &vertices.positions, -10.0);
    assert_eq!(skirt.triangles.len(), 2 * mesh.outline().len());
    for triangle in &skirt.triangles {
        let [a, b, c] = triangle.map(|vertex| skirt.positions[vertex as usize]);
        let front = unit(cross(add_scaled(b, a, -1.0), add_scaled(c, a, -1.0)));
        assert!(distance(front, skirt.normals[triangle[0] as usize]) < 1e-9);
    }
    let northern =
        skirt.positions.iter().zip(&skirt.normals).filter(|(place, _)| place[2] == -0.5 * 49.0 * CELL);
    let outward = northern.filter(|(_, normal)| normal[2] == -1.0).count();
    assert!(outward >= 4, "the northern wall looks north");
}

#[test]
fn the_colours_are_those_of_the_layer_that_is_meshed_with_its_water_or_without() {
    let mut landscape = lake();
    let steeper =
        landscape.field("height").expect("there").values().iter().map(|height| 9.0 * height).collect();
    let size = landscape.domain.size;
    landscape.insert("steeper", "m", Field::from_values(size, steeper));
    let colours = |of: &str, water: bool| {
        let mesh = Mesh { of: LayerName::of(of), water, ..Mesh::default() };
        mesh.image(&landscape).expect("draws").expect("more than one colour")
    };
    let [wet, dry, steep] = [colours("height", true), colours("height", false), colours("steeper", false)];
    assert!(wet != dry, "the bed of the lake has another colour than a meadow");
    assert!(steep != dry, "so have slopes nine times as steep");
}
