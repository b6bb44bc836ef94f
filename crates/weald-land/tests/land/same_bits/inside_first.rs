//! Ranks that compute their inside while rows of their neighbours are on their way end with the same bits.

use std::sync::Arc;
use std::time::Duration;

use weald_core::{Error, Landscape};
use weald_engine::ranks::{Counting, Overlap, Ranks, Swap, ranks_in_threads};
use weald_engine::step::Step;
use weald_engine::{Unwatched, Watcher};
use weald_land::erode::hydraulic::{Boundary, Hydraulic};

use super::draw::{Case, KINDS, case_of};
use super::drawn::{Looker, difference};
use super::ranks::{COUNTS, edited, on_one, over_these};
use crate::common::{hydraulic, layered, mei, rough, stava};

/// Ranks that count, and compute their inside first as is said.
fn counted(count: usize, overlap: Overlap) -> Vec<Arc<Counting>> {
    let ranks = ranks_in_threads(count).into_iter();
    ranks.map(|ranks| Arc::new(Counting::overlapping(ranks, overlap))).collect()
}

fn as_ranks(counted: &[Arc<Counting>]) -> Vec<Arc<dyn Ranks>> {
    counted.iter().map(|ranks| Arc::clone(ranks) as Arc<dyn Ranks>).collect()
}

/// Compares a run over so many ranks with one on a processor; gives in how many exchanges the inside came first.
fn compared(count: usize, (step, ground): (&dyn Step, &Landscape), watcher: &dyn Watcher) -> u64 {
    let (expected, outcome) = on_one(step, ground);
    let ranks = counted(count, Overlap::Always);
    let (got, sums) = over_these(as_ranks(&ranks), (step, ground), (watcher, None));
    assert_eq!(difference(&expected, &got), None, "{count} ranks: {step:?}");
    assert_eq!(sums.expect("it runs"), outcome.expect("it runs"), "{count} ranks: {step:?}");
    ranks.iter().map(|rank| rank.aside()).sum()
}

#[test]
fn every_model_ends_with_the_same_bits_where_the_inside_comes_first() {
    for model in [hydraulic(120), mei(120), stava(60)] {
        let step = Hydraulic { boundary: Boundary::Open, rain_period: 40, ..model };
        let ground = layered(rough(24, 290, 25.0, 5));
        for count in COUNTS {
            let aside = compared(count, (&step, &ground), &Unwatched);
            assert_eq!(aside > 0, count > 1, "{count} ranks: {step:?}");
        }
    }
}

#[test]
fn whatever_is_drawn_ends_with_the_same_bits_where_the_inside_comes_first() {
    let mut aside = 0;
    for number in 0..KINDS {
        let Case { step, ground, .. } = case_of(KINDS + number, 40);
        aside += compared(2, (&*step, &ground), &Unwatched);
    }
    assert!(aside > 1000, "the inside came first in {aside} exchanges");
}

#[test]
fn strokes_looks_and_keys_meet_whole_rows_where_the_inside_comes_first() {
    let (step, ground, _folder) = edited();
    for count in [2, 3] {
        let aside = compared(count, (&step, &ground), &Looker::new([95, 300], u64::MAX));
        assert!(aside > 0, "{count} ranks");
    }
}

/// Ranks whose neighbours' rows take their time.
#[derive(Debug)]
struct Late(Arc<dyn Ranks>);

const UNDER_WAY: Duration = Duration::from_millis(4);

impl Ranks for Late {
    fn rank(&self) -> usize {
        self.0.rank()
    }

    fn count(&self) -> usize {
        self.0.count()
    }

    fn tell(&self, message: Vec<u8>) -> Result<Vec<u8>, Error> {
        self.0.tell(message)
    }

    fn deal(&self, part: &mut dyn FnMut(usize) -> Vec<u8>) -> Result<Vec<u8>, Error> {
        self.0.deal(part)
    }

    fn collect(
        &self,
        own: Vec<u8>,
        take: &mut dyn FnMut(usize, Vec<u8>) -> Result<(), Error>,
    ) -> Result<(), Error> {
        self.0.collect(own, take)
    }

    fn swap(&self, swaps: &mut [Swap<'_>]) -> Result<(), Error> {
        std::thread::sleep(UNDER_WAY);
        self.0.swap(swaps)
    }

    fn trade(&self, given: Vec<(usize, Vec<u8>)>) -> Result<Vec<Vec<u8>>, Error> {
        self.0.trade(given)
    }
}

#[test]
fn ranks_whose_messages_are_late_find_out_and_change_their_order_with_the_same_bits() {
    let (step, ground) = (hydraulic(300), layered(rough(40, 200, 25.0, 8)));
    let (expected, outcome) = on_one(&step, &ground);
    let ranks: Vec<_> =
        ranks_in_threads(3).into_iter().map(|ranks| Arc::new(Counting::new(Arc::new(Late(ranks))))).collect();
    let (got, sums) = over_these(as_ranks(&ranks), (&step, &ground), (&Unwatched, None));
    assert_eq!(difference(&expected, &got), None);
    assert_eq!(sums.expect("it runs"), outcome.expect("it runs"));
    for rank in &ranks {
        let (aside, all) = (rank.aside(), rank.exchanges());
        assert!(aside > 0 && aside < all, "the inside came first in {aside} of {all} exchanges");
    }
}
