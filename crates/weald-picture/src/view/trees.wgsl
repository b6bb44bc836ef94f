// Twin of `trees.rs`: the trees of the woods of a scene, one by one.

const TREE_FOOTPRINT = 3.0;
const LIFTED = 0.25;
const IN_RIVER = 0.1;

// A tree that stands or does not, the drawn height of its ground, and whether it is a conifer.
struct StandingTree {
    tree: Tree,
    ground: f32,
    stands: bool,
    is_conifer: bool,
}

// The ground at a place in metres eastward and northward, seen with so wide a pixel.
fn wooded_ground(east_north: vec2<f32>, footprint: f32) -> SurfacePoint {
    let place = place_of(vec3<f32>(east_north, 0.0));
    let surface = spline_with_slope(bed, place);
    let normal = normal_of(surface.yz);
    let run = length(normal.xy);
    let slope = run / max(normal.z, 1e-3) / scene.scale.y;
    let above = -lake_depth(place, surface.x) / scene.scale.y;
    let point = vec3<f32>(east_north, surface.x / scene.scale.y);
    let beach = beach_height(surface.x - above * scene.scale.y);
    return SurfacePoint(place, point, slope, normal.xy / max(run, 1e-6), footprint, above, beach, bed_of(surface));
}

// Trees stand within the border alone, and where there is land.
fn may_bear_trees(place: vec2<f32>) -> bool {
    return all(place >= vec2<f32>(0.5)) && all(place <= scene.grid.xy + 0.5) &&
        (scene.has.y == 0.0 || spline_at(land, place) >= 0.5);
}

fn tree_in(square: vec2<i32>) -> StandingTree {
    let tree = tree_of(square);
    let spot = wooded_ground(tree.place, TREE_FOOTPRINT);
    let place = spot.place;
    let ground = spot.point.z * scene.scale.y;
    let river = select(0.0, textureSampleLevel(rivers, between, share_of(place), 0.0).x, scene.has.w > 0.0);
    let lifted = spline_at(top, place) - ground;
    let wood = wood_at(spot);
    let stands = may_bear_trees(place) && river < IN_RIVER && lifted < LIFTED && tree.rank < wood.x;
    return StandingTree(tree, ground, stands, tree.chance < wood.y);
}
