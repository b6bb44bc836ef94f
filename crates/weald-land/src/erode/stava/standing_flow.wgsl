
fn standing(at: u32) -> f32 {
    return carried[at].x;
}
