//! Directions of the streams of ground in files, for figures of runs that are too long for a test.

use weald::analyse::stream_azimuths::StreamAzimuths;
use weald::{Landscape, LandscapeExt};

#[test]
#[ignore = "prints figures of the files that WEALD_GROUND names"]
fn directions_of_streams_in_files() {
    let files = std::env::var("WEALD_GROUND").expect("WEALD_GROUND names files, with commas between");
    for file in files.split(',') {
        let land = Landscape::open(file).unwrap_or_else(|error| panic!("{error}"));
        let height = land.field("height").expect("there is ground");
        // A model with ground below 0 m may have a sea.
        let has_sea = height.range(None).is_some_and(|(low, _)| low < 0.0);
        let domain = weald::Domain { sea_level: has_sea.then_some(0.0), ..land.domain.clone() };
        let azimuths = StreamAzimuths::of(&domain, height).unwrap_or_else(|error| panic!("{error}"));
        let share = 100.0 * azimuths.along_the_grid();
        println!("{file}: {share:.1} % of {} streams", azimuths.degrees.len());
    }
}
