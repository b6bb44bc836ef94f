
fn standing(at: u32) -> f32 {
    return water[at];
}
