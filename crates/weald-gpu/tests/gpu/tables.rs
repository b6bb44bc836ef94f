//! What is measured of drawn grass, and that it ends where its listener says so.

use crate::programs::gpu;
use weald::Error;
use weald_gpu::bench::{GrassRow, Measuring, frame_budget, grass_tables};

const SMALL: Measuring = Measuring { size: [64, 36], times: 1, most_drawn: 1200 };

#[test]
fn tables_have_the_rows_of_the_source_that_draw_no_more_than_allowed() {
    let Some(gpu) = gpu() else { return };
    let mut rows_seen = Vec::new();
    let rows = grass_tables(&gpu, SMALL, &mut |row| {
        rows_seen.push(row.clone());
        Ok(())
    })
    .expect("measured");
    assert_eq!(rows, rows_seen);
    let first: Vec<_> = rows.iter().filter(|row| row.table == 1).collect();
    assert_eq!(first.iter().map(|row| row.wanted).collect::<Vec<_>>(), [1, 100, 1000]);
    assert_eq!(first[2].source, Some(481.10));
    for GrassRow { sets: [all, drawn], wanted, .. } in first {
        assert!(all == drawn && (all.abs_diff(u64::from(*wanted)) as f64) < 1.0 + 0.01 * f64::from(*wanted));
    }
    assert!(rows.iter().all(|row| row.sets[1] <= 1200 && row.frames_per_second() > 0.0));
    assert!(rows.iter().all(|row| row.timings.water.is_zero()), "there is no pond");
}

#[test]
fn a_measurement_ends_with_the_error_of_its_listener() {
    let Some(gpu) = gpu() else { return };
    let mut count = 0;
    let stopped = frame_budget(&gpu, Measuring { most_drawn: 6000, ..SMALL }, &mut |row| {
        count += 1;
        assert!(row.look.culled && row.look.thinned && row.sets[1] < row.sets[0]);
        Err(Error::Interrupted("enough".to_owned()))
    });
    assert!(matches!(stopped, Err(Error::Interrupted(_))) && count == 1);
}
