//! Any checkpoint with a right hash is a state to go on from or a fault.
//!
//! An input is a length of two bytes, a header of that length, and the body; what frames them is put around them here, since
//! no mutation would find a hash. Each is read in memory, as a landscape that is kept; one in 256, which goes through a folder
//! and costs a hundred times as much, is gone on from by a run.
#![no_main]

use std::path::PathBuf;
use std::sync::LazyLock;

use libfuzzer_sys::fuzz_target;
use weald::recipe::{Options, Overrides, Recipe, Run, Silent, unpack_landscape};

const RECIPE: &str = "[landscape]\nsize = 8\ncell = 10.0\n[[step]]\ndo = \"cone\"\n[[step]]\ndo = \"thermal\"\n\
                      iterations = 3\n[[output]]\nlayer = \"height\"\nfile = \"h.npy\"\n";

/// A recipe, its text as it stands in a header, and a folder.
struct Ground {
    recipe: Recipe,
    text: String,
    folder: PathBuf,
}

static GROUND: LazyLock<Ground> = LazyLock::new(|| {
    let recipe = Recipe::parse("r.toml", RECIPE, &Overrides::default()).expect("good");
    let folder = std::env::temp_dir().join(format!("weald-fuzz-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a folder");
    Ground { text: recipe.effective().escape_debug().to_string(), recipe, folder }
});

fuzz_target!(|bytes: &[u8]| {
    let Some((length, rest)) = bytes.split_first_chunk::<2>() else { return };
    let Some((header, body)) = rest.split_at_checked(u16::from_le_bytes(*length).into()) else { return };
    let header = String::from_utf8_lossy(header);
    // The recipe of a header is long and must be the one of the run: mutations leave it out. A kept landscape has none.
    let kept = unpack_landscape(&framed(&header.replace("RECIPE", ""), body));
    let Ground { recipe, text, folder } = &*GROUND;
    if kept.is_err() || blake3::hash(bytes).as_bytes()[0] > 0 {
        return;
    }
    let file = framed(&header.replace("RECIPE", text), body);
    std::fs::write(folder.join("checkpoint.weald"), file).expect("room for it");
    let options = Options { resume: true, ..Options::into_folder(folder) };
    drop(Run { recipe, options }.landscape(&Silent));
});

/// The bytes of a checkpoint.
fn framed(header: &str, body: &[u8]) -> Vec<u8> {
    let mut file = b"WEALDCP1".to_vec();
    file.extend((header.len() as u64).to_le_bytes());
    file.extend(header.as_bytes());
    file.extend(body);
    let hash = blake3::hash(&file);
    file.extend(hash.as_bytes());
    file
}
