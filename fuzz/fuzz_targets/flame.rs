//! Any bytes are flames or a fault; what was read is written and read again the same.
#![no_main]

use libfuzzer_sys::fuzz_target;
use weald::grow::ifs::flame::{Frame, parse, write};

fuzz_target!(|bytes: &[u8]| {
    let Ok(flames) = parse(bytes) else { return };
    let text = write(&flames, &Frame::default()).expect("flames lie in the plane");
    let again = parse(text.as_bytes()).expect("what was written can be read");
    assert_eq!(again.len(), flames.len());
    for (flame, again) in flames.iter().zip(&again) {
        let maps = |flame: &weald::grow::ifs::Ifs| flame.maps().iter().map(|map| map.map).collect::<Vec<_>>();
        assert_eq!(maps(flame), maps(again));
    }
});
