//! What ranks that run the same program say to each other between its parts: whether all went well, and sums over all.
//!
//! All functions are collective, and give the same on every rank.

use super::bytes::{Reader, Writer};
use super::messages::Ranks;
use crate::sums::RowSums;
use weald_core::error::Error;

/// What this rank did, if all ranks have done theirs; else the error of the first that has not, on every rank, so that none
/// waits for one that has ended. A rank's own error stays as it is.
///
/// # Errors
/// These.
pub fn agreed<T>(ranks: &dyn Ranks, done: Result<T, Error>) -> Result<T, Error> {
    let mut first = None;
    ranks.collect(said(&done), &mut |rank, message| {
        if first.is_none() && !message.is_empty() {
            first = Some((rank, message));
        }
        Ok(())
    })?;
    let told = first.map_or_else(Vec::new, |(rank, message)| {
        let mut writer = Writer::default();
        writer.count(rank);
        writer.0.extend(message);
        writer.0
    });
    let told = ranks.tell(told)?;
    let done = done?;
    if told.is_empty() {
        return Ok(done);
    }
    let mut reader = Reader(&told);
    let rank = reader.count()?;
    let (is_interrupted, text) = (reader.0.first() == Some(&INTERRUPTED), reader.0.get(1..));
    let text = String::from_utf8_lossy(text.unwrap_or_default()).into_owned();
    Err(if is_interrupted { Error::Interrupted(text) } else { Error::Run(format!("rank {rank}: {text}")) })
}

const INTERRUPTED: u8 = 1;
const FAILED: u8 = 2;

/// A result as a message: nothing where all is well.
fn said<T>(done: &Result<T, Error>) -> Vec<u8> {
    let Err(error) = done else { return Vec::new() };
    let kind = if matches!(error, Error::Interrupted(_)) { INTERRUPTED } else { FAILED };
    [vec![kind], error.to_string().into_bytes()].concat()
}

/// Folds what each rank has, from the first to the last.
fn folded<T>(
    ranks: &dyn Ranks,
    own: Vec<u8>,
    start: T,
    take: impl Fn(T, &mut Reader<'_>) -> Result<T, Error>,
    write: impl Fn(&mut Writer, &T),
    read: impl Fn(&mut Reader<'_>) -> Result<T, Error>,
) -> Result<T, Error> {
    let mut all = Some(start);
    ranks.collect(own, &mut |_, message| {
        all = all.take().map(|so_far| take(so_far, &mut Reader(&message))).transpose()?;
        Ok(())
    })?;
    let mut writer = Writer::default();
    if ranks.leads()
        && let Some(all) = &all
    {
        write(&mut writer, all);
    }
    read(&mut Reader(&ranks.tell(writer.0)?))
}

/// Sums of the rows of all ranks, added from north to south as on one processor. Each hands in those of its own rows.
///
/// # Errors
/// [`Error::Run`] where another rank can no longer be reached, as all of these.
pub fn total(ranks: &dyn Ranks, rows: &[RowSums]) -> Result<RowSums, Error> {
    let mut own = Writer::default();
    for row in rows {
        own.doubles(row);
    }
    let read = |reader: &mut Reader<'_>| {
        let mut row = RowSums::default();
        reader.doubles(&mut row).map(|()| row)
    };
    let take = |mut sums: RowSums, reader: &mut Reader<'_>| {
        while !reader.is_empty() {
            sums.iter_mut().zip(read(reader)?).for_each(|(total, sum)| *total += sum);
        }
        Ok(sums)
    };
    folded(ranks, own.0, RowSums::default(), take, |writer, sums| writer.doubles(sums), read)
}

/// The least of the numbers of all ranks.
///
/// # Errors
/// As [`total`].
pub fn least(ranks: &dyn Ranks, own: u64) -> Result<u64, Error> {
    let read = |reader: &mut Reader<'_>| reader.count().map(|count| count as u64);
    let take = |least: u64, reader: &mut Reader<'_>| read(reader).map(|own| least.min(own));
    let message = own.to_le_bytes().to_vec();
    folded(ranks, message, u64::MAX, take, |writer, least| writer.count(*least as usize), read)
}

/// The greatest of the numbers of all ranks.
///
/// # Errors
/// As [`total`].
pub fn greatest(ranks: &dyn Ranks, own: u64) -> Result<u64, Error> {
    least(ranks, u64::MAX - own).map(|least| u64::MAX - least)
}

/// Whether something is so on any rank.
///
/// # Errors
/// As [`total`].
pub fn any(ranks: &dyn Ranks, own: bool) -> Result<bool, Error> {
    greatest(ranks, own.into()).map(|greatest| greatest > 0)
}

/// Puts what each rank has together, from the first rank to the last; `None` stands for a rank that has nothing.
///
/// # Errors
/// As [`total`].
pub fn joined<const N: usize>(
    ranks: &dyn Ranks,
    own: Option<[f64; N]>,
    join: impl Fn([f64; N], [f64; N]) -> [f64; N],
) -> Result<Option<[f64; N]>, Error> {
    let mut message = Writer::default();
    if let Some(own) = &own {
        message.doubles(own);
    }
    let read = |reader: &mut Reader<'_>| {
        let mut own = [0.0; N];
        let is_empty = reader.is_empty();
        Ok(if is_empty { None } else { reader.doubles(&mut own).map(|()| Some(own))? })
    };
    let take = |all: Option<[f64; N]>, reader: &mut Reader<'_>| {
        Ok(match (all, read(reader)?) {
            (Some(all), Some(own)) => Some(join(all, own)),
            (all, own) => all.or(own),
        })
    };
    let write = |writer: &mut Writer, all: &Option<[f64; N]>| all.iter().for_each(|all| writer.doubles(all));
    folded(ranks, message.0, None, take, write, read)
}

#[cfg(test)]
mod tests {
    use super::super::threads::ranks_in_threads;
    use super::*;

    fn each<T: Send>(count: usize, work: impl Fn(&dyn Ranks) -> T + Sync) -> Vec<T> {
        let work = &work;
        std::thread::scope(|scope| {
            let ranks = ranks_in_threads(count).into_iter();
            let running: Vec<_> = ranks.map(|rank| scope.spawn(move || work(&*rank))).collect();
            running.into_iter().map(|rank| rank.join().expect("no panic")).collect()
        })
    }

    #[test]
    fn a_fault_of_one_rank_ends_all_and_names_it() {
        let of = |rank: usize| if rank < 2 { Ok(rank) } else { Err(Error::Run(format!("no room {rank}"))) };
        let said = each(4, |ranks| agreed(ranks, of(ranks.rank())).map_err(|error| error.to_string()));
        let told = Err("rank 2: no room 2".to_owned());
        assert_eq!(said, [told.clone(), told, Err("no room 2".to_owned()), Err("no room 3".to_owned())]);
        assert!(each(3, |ranks| agreed(ranks, Ok(()))).into_iter().all(|done| done.is_ok()));
        let stop = |rank: usize| if rank == 0 { Err(Error::Interrupted("here".to_owned())) } else { Ok(()) };
        let stopped = each(2, |ranks| agreed(ranks, stop(ranks.rank())));
        assert!(stopped.iter().all(|done| matches!(done, Err(Error::Interrupted(what)) if what == "here")));
    }

    #[test]
    fn all_ranks_get_sums_added_from_north_to_south() {
        // Sums that depend on their order.
        let row = |y: usize| [1.0e8, 1.0, 0.1, -1.0e8, 3.0].map(|first| first / (y as f64 + 0.7));
        let rows: Vec<RowSums> = (0..13).map(row).collect();
        let mut expected = RowSums::default();
        for row in &rows {
            expected.iter_mut().zip(row).for_each(|(total, sum)| *total += sum);
        }
        for cuts in [vec![0, 13], vec![0, 5, 5, 13], vec![0, 1, 2, 12, 13]] {
            let own = |rank: usize| &rows[cuts[rank]..cuts[rank + 1]];
            let sums = each(cuts.len() - 1, |ranks| total(ranks, own(ranks.rank())).expect("all are there"));
            assert!(sums.iter().all(|sums| sums == &expected), "{cuts:?}");
        }
    }

    #[test]
    fn all_ranks_know_what_any_has() {
        let known = each(3, |ranks| {
            let rank = ranks.rank() as u64;
            let own = (rank > 0).then_some([rank as f64]);
            let joined = joined(ranks, own, |[all], [own]| [10.0 * all + own]);
            let ends = (least(ranks, rank + 4), greatest(ranks, rank + 4));
            (any(ranks, rank == 1).ok(), any(ranks, false).ok(), joined.ok(), (ends.0.ok(), ends.1.ok()))
        });
        let expected = (Some(true), Some(false), Some(Some([12.0])), (Some(4), Some(6)));
        assert!(known.iter().all(|known| known == &expected), "{known:?}");
    }
}
