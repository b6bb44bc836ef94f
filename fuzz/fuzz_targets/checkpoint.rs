//! Any checkpoint with a right hash is a state to go on from or a fault.
//!
//! An input is a length of two bytes, a header of that length, and the body; what frames them is put around them here, since
//! no mutation would find a hash.
#![no_main]

use std::path::PathBuf;
use std::sync::LazyLock;

use libfuzzer_sys::fuzz_target;
use weald::recipe::{Options, Overrides, Recipe, Run, Silent};

const RECIPE: &str = "[landscape]\nsize = 8\ncell = 10.0\n[[step]]\ndo = \"cone\"\n[[step]]\ndo = \"thermal\"\n\
                      iterations = 3\n[[output]]\nlayer = \"height\"\nfile = \"h.npy\"\n";

static GROUND: LazyLock<(Recipe, PathBuf)> = LazyLock::new(|| {
    let recipe = Recipe::parse("r.toml", RECIPE, &Overrides::default()).expect("good");
    let folder = std::env::temp_dir().join(format!("weald-fuzz-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a folder");
    (recipe, folder)
});

fuzz_target!(|bytes: &[u8]| {
    let Some((length, rest)) = bytes.split_first_chunk::<2>() else { return };
    let Some((header, body)) = rest.split_at_checked(u16::from_le_bytes(*length).into()) else { return };
    // The recipe of a header is long and must be this one: mutations leave it out.
    let header = String::from_utf8_lossy(header).replace("RECIPE", &GROUND.0.effective().escape_debug().to_string());
    let mut file = b"WEALDCP1".to_vec();
    file.extend((header.len() as u64).to_le_bytes());
    file.extend(header.as_bytes());
    file.extend(body);
    let hash = blake3::hash(&file);
    file.extend(hash.as_bytes());
    let (recipe, folder) = &*GROUND;
    std::fs::write(folder.join("checkpoint.weald"), file).expect("room for it");
    let options = Options { resume: true, ..Options::into_folder(folder) };
    drop(Run { recipe, options }.landscape(&Silent));
});
