//! The guide of the window: its table of keys is that of the program, and its picture is drawn here.

use std::path::Path;

use super::harness::Window;

const BEGIN: &str = "studio --test studio guide -->\n";
const END: &str = "<!-- End of the keys. -->";

#[test]
fn the_guide_has_the_keys_of_the_program() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/studio.md");
    let text = std::fs::read_to_string(&path).expect("the guide");
    let begin = text.find(BEGIN).expect("where the keys begin") + BEGIN.len();
    let end = text.find(END).expect("where they end");
    let wanted = format!("{}{}{}", &text[..begin], weald_studio::commands::table(), &text[end..]);
    if std::env::var_os("UPDATE_KEYS").is_some() {
        std::fs::write(&path, &wanted).expect("written");
    } else {
        assert!(text == wanted, "docs/studio.md has other keys: UPDATE_KEYS=1 writes them");
    }
}

const VALLEY: &str = "[landscape]\nsize = 256\ncell = 10.0\nseed = 12\n\n[[step]]\ndo = \"diamond-square\"\nrelief = 420.0\n\n\
    [[step]]\ndo = \"hydraulic\"\nmodel = \"stava\"\niterations = 400\n\n[[step]]\ndo = \"slope\"\n\n\
    [[output]]\nlayer = \"height\"\nfile = \"height.tif\"\n";

/// Draws the picture of the guide into the folder of test files: `weald-dev picture` makes docs/studio.webp of it.
#[test]
fn the_picture_of_the_guide_can_be_drawn() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("valley.toml");
    std::fs::write(&file, VALLEY).expect("written");
    let mut window = Window::open(Some(&file));
    window.settle();
    let steps = if std::env::var_os("STUDIO_PICTURE").is_some() { 400 } else { 20 };
    window.click("Play or pause");
    window.until("some steps", |status| status.steps >= steps);
    window.click("Play or pause");
    window.until("rest", |status| !status.plays);
    window.click("Water");
    window.drawn();
    window.stroke([0.4, 0.55], [0.5, 0.52]);
    // More may have been done than were waited for.
    let before = window.status().steps;
    window.click("Play or pause");
    window.until("some steps more", |status| status.steps >= before + 20);
    window.click("Play or pause");
    window.until("rest", |status| !status.plays);
    window.hover([0.45, 0.5]);
    window.drawn();
    window.picture("guide");
}
