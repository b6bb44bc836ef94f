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

fn tree_in(square: vec2<i32>) -> StandingTree {
    let tree = tree_of(square);
    let place = place_of(vec3<f32>(tree.place, 0.0));
    let surface = spline_with_slope(bed, place);
    let normal = normal_of(surface.yz);
    let run = length(normal.xy);
    let height = surface.x / scene.scale.y;
    let slope = run / max(normal.z, 1e-3) / scene.scale.y;
    let above = -lake_depth(place, surface.x) / scene.scale.y;
    let point = vec3<f32>(tree.place, height);
    let beach = beach_height(surface.x - above * scene.scale.y);
    let spot = SurfacePoint(place, point, slope, normal.xy / max(run, 1e-6), TREE_FOOTPRINT, above, beach);
    let is_inside = all(place >= vec2<f32>(0.5)) && all(place <= scene.grid.xy + 0.5) &&
        (scene.has.y == 0.0 || spline_at(land, place) >= 0.5);
    let river = select(0.0, textureSampleLevel(rivers, between, share_of(place), 0.0).x, scene.has.w > 0.0);
    let lifted = spline_at(top, place) - surface.x;
    let wood = wood_at(spot);
    let stands = is_inside && river < IN_RIVER && lifted < LIFTED && tree.rank < wood.x;
    return StandingTree(tree, surface.x, stands, tree.chance < wood.y);
}
