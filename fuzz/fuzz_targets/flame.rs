//! Any bytes are flames or a fault; what was read is written and read again the same.
//!
//! What maps of slow contraction fill takes milliseconds to find, thousands of times as long as to read them: of such, one
//! input in 1024 goes on.
#![no_main]

use libfuzzer_sys::fuzz_target;
use weald::grow::ifs::flame::{Frame, drafts, parse, write};
use weald::grow::ifs::{Draft, Ifs};

/// Ratio of maps up to which the box of a fractal is found soon.
const QUICK: f64 = 0.6;

/// Most maps of fractals that are all looked at.
const FEW: usize = 4;

fuzz_target!(|bytes: &[u8]| {
    let Ok(drafts) = drafts(bytes) else { return };
    let is_chosen = u16::from_le_bytes(*blake3::hash(bytes).as_bytes().first_chunk().expect("32 bytes")) < 64;
    if !drafts.iter().all(is_quick) && !is_chosen {
        return;
    }
    let Ok(flames) = parse(bytes) else { return };
    let text = write(&flames, &Frame::default()).expect("flames lie in the plane");
    let again = parse(text.as_bytes()).expect("what was written can be read");
    assert_eq!(again.len(), flames.len());
    for (flame, again) in flames.iter().zip(&again) {
        let maps = |flame: &Ifs| flame.maps().iter().map(|map| map.map).collect::<Vec<_>>();
        assert_eq!(maps(flame), maps(again));
    }
});

fn is_quick(draft: &Draft) -> bool {
    draft.maps.len() <= FEW && draft.maps.iter().all(|weighted| weighted.map.ratio() <= QUICK)
}
