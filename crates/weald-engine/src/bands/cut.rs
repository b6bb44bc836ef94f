//! How rows are cut into bands.

use std::ops::Range;

/// Rows of an inner band by those around it, at least: narrower ones compute more rows twice than threads gain.
const LEAST_BY_HALO: usize = 4;

/// Bands from north to south.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Cut {
    pub(super) bands: Vec<Range<usize>>,
    /// Whether the first and the last band are edges, which advance when the others may be done.
    pub(super) edges: [bool; 2],
}

impl Cut {
    /// So many bands of as many rows each, all inner ones.
    pub(super) fn even(rows: usize, count: usize) -> Self {
        let bands = (0..count).map(|band| rows * band / count..rows * (band + 1) / count).collect();
        Self { bands, edges: [false; 2] }
    }

    /// Edges of so many rows at the northern and the southern end, none where that is 0, and inner bands between them, one a
    /// thread at most. Those beside an edge have fewer rows, as many as an edge costs the thread that is done with them.
    /// `None` where there are no rows between the edges, or fewer than `halo`.
    pub(super) fn with_edges(rows: usize, edges: [usize; 2], halo: usize, threads: usize) -> Option<Self> {
        let [north, south] = edges;
        let inside = rows.checked_sub(north + south).filter(|inside| *inside >= halo.max(1))?;
        let count = threads.clamp(1, (inside / (LEAST_BY_HALO * halo)).max(1));
        let costs = edges.map(|edge| if edge > 0 { edge + halo } else { 0 });
        let share = (inside + costs[0] + costs[1]) / count;
        let is_balanced = count > 1 && costs.iter().all(|cost| share >= cost + halo);
        let [before, all] = if is_balanced { [costs[0], inside + costs[0] + costs[1]] } else { [0, inside] };
        let start = |band: usize| match band {
            0 => north,
            band if band == count => north + inside,
            band => north + all * band / count - before,
        };
        let inner = (0..count).map(|band| start(band)..start(band + 1));
        let [first, last] =
            [0..north, north + inside..rows].map(|edge| Some(edge).filter(|edge| !edge.is_empty()));
        let bands = first.into_iter().chain(inner).chain(last).collect();
        Some(Self { bands, edges: edges.map(|edge| edge > 0) })
    }

    /// Rows that so many threads compute one after the other, those around the bands among them.
    pub(super) fn rows_of_a_thread(&self, halo: usize, threads: usize) -> f64 {
        let rows = self.bands.last().map_or(0, |band| band.end);
        let span = |band: &Range<usize>| band.len() + band.start.min(halo) + (rows - band.end).min(halo);
        let all: usize = self.bands.iter().map(span).sum();
        all as f64 / threads.clamp(1, self.bands.len().max(1)) as f64
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bands_have_all_rows_once() {
        for rows in [1, 7, 60, 290, 1000] {
            for threads in [1, 2, 3, 8] {
                for edges in [[0, 0], [10, 0], [0, 10], [10, 10], [34, 34]] {
                    let cut = Cut::with_edges(rows, edges, 5, threads);
                    let inside = rows.saturating_sub(edges[0] + edges[1]);
                    assert_eq!(cut.is_some(), inside >= 5, "{rows} {edges:?}");
                    for cut in cut.into_iter().chain([Cut::even(rows, threads.min(rows))]) {
                        assert!(cut.bands.iter().all(|band| !band.is_empty()), "{cut:?}");
                        assert_eq!(
                            cut.bands.iter().flat_map(Clone::clone).collect::<Vec<_>>(),
                            (0..rows).collect::<Vec<_>>()
                        );
                    }
                }
            }
        }
    }

    #[test]
    fn threads_that_take_an_edge_have_fewer_rows_before() {
        let cut = Cut::with_edges(1000, [20, 20], 10, 4).expect("there is room");
        let lengths: Vec<_> = cut.bands.iter().map(Range::len).collect();
        assert_eq!(lengths, [20, 225, 255, 255, 225, 20]);
        assert_eq!(cut.rows_of_a_thread(10, 4), (1000.0 + 10.0 * 10.0) / 4.0);
        assert_eq!(Cut::even(1000, 4).rows_of_a_thread(10, 4), (1000.0 + 6.0 * 10.0) / 4.0);
    }
}
