//! Inner bands advance while the rows beyond the edges are on their way; the edges follow.

use super::cut::Cut;
use super::{Band, BandedGrid};
use crate::stencil::chain::Process;
use crate::sums::Means;
use weald_core::error::Error;

/// The edges of a grid, for what arrives there.
pub(crate) struct Edges<'a, P: Process> {
    north: Option<&'a mut Band<P>>,
    south: Option<&'a mut Band<P>>,
}

impl<P: Process> Edges<'_, P> {
    /// Row `y` of one plane, which lies in an edge.
    pub(crate) fn plane_mut(&mut self, y: usize, plane: usize) -> &mut [f32] {
        let bands = self.north.iter_mut().chain(&mut self.south);
        let band = bands.into_iter().find(|band| band.own.contains(&y)).expect("only rows of edges arrive");
        band.rows[y - band.own.start][plane].here_mut()
    }
}

impl<P: Process> BandedGrid<P> {
    /// How many times as long a passage of so many steps takes, by its rows, with edges of so many rows; `None` where rows
    /// do not suffice for them.
    pub(crate) fn cost_of_edges(&self, edges: [usize; 2], steps: usize) -> Option<f64> {
        let halo = self.process.reach() * steps;
        let threads = rayon::current_num_threads();
        let with = Cut::with_edges(self.rows, edges, halo, threads)?.rows_of_a_thread(halo, threads);
        Some(with / Cut::even(self.rows, self.even_count()).rows_of_a_thread(halo, threads))
    }

    /// Cuts the rows anew, with edges for passages of so many steps; stays as it is where rows do not suffice.
    pub(crate) fn cut_with_edges(&mut self, edges: [usize; 2], steps: usize) {
        let halo = self.process.reach() * steps;
        if let Some(cut) = Cut::with_edges(self.rows, edges, halo, rayon::current_num_threads()) {
            self.cut_anew(&cut, steps);
        }
    }

    /// Cuts the rows anew, without edges.
    pub(crate) fn cut_without_edges(&mut self) {
        let count = self.even_count();
        self.cut_anew(
            &Cut::even(self.rows, count),
            super::steps_per_time_block(&*self.process, self.rows / count),
        );
    }

    /// Whether there are edges.
    pub(crate) fn has_edges(&self) -> bool {
        self.edges.contains(&true)
    }

    /// One time block, of which the inner bands are computed while `arrive` waits for the rows beyond the edges and lays them
    /// there.
    pub(crate) fn advance_inside_first(
        &mut self,
        weather: &[P::Weather],
        (parts, means): (Means<'_>, &mut [Vec<f32>]),
        arrive: impl FnOnce(&mut Edges<'_, P>) -> Result<(), Error>,
    ) -> Result<(), Error> {
        self.exchange_halos(self.halo(weather.len(), parts));
        let [north, south] = self.edges;
        let (work, mut bands) = self.work(weather, parts, means);
        let work = &work;
        let south = south.then(|| bands.pop()).flatten();
        let inner = bands.split_off(usize::from(north));
        let (mut north, mut south) = (bands.pop(), south);
        rayon::in_place_scope(|scope| {
            for band in inner {
                scope.spawn(move |_| work.run(band));
            }
            let [first, last] =
                [&mut north, &mut south].map(|edge| edge.as_mut().map(|(band, _)| &mut **band));
            arrive(&mut Edges { north: first, south: last })?;
            for edge in north.into_iter().chain(south) {
                scope.spawn(move |_| work.run(edge));
            }
            Ok(())
        })
    }
}
