//! Ranks that are threads of one process.

use crate::Ranks;
use crate::error::RanksError;
use std::sync::atomic::{AtomicU8, Ordering};
use std::sync::{Arc, Condvar, Mutex, PoisonError};
use std::time::Duration;

/// How long a thread waits for the others: longer, and they do not come.
const PATIENCE: Duration = Duration::from_secs(60);

/// Where threads meet.
#[derive(Debug, Default)]
struct Table {
    state: Mutex<State>,
    all_are_there: Condvar,
    /// With what exit code all were ended; 0 before.
    aborted: AtomicU8,
}

#[derive(Debug, Default)]
struct State {
    round: u64,
    said: Vec<Option<Vec<u8>>>,
    heard: Arc<Vec<Vec<u8>>>,
}

/// One of some threads.
#[derive(Debug)]
struct Thread {
    rank: usize,
    size: usize,
    table: Arc<Table>,
}

const SILENCE: RanksError = RanksError::Library {
    call: "a meeting of threads",
    code: 1,
};

impl Thread {
    /// What all say; an error where some do not come.
    fn exchange(&self, own: Vec<u8>) -> Result<Arc<Vec<Vec<u8>>>, RanksError> {
        let state = self.table.state.lock();
        let mut state = state.unwrap_or_else(PoisonError::into_inner);
        let round = state.round;
        state.said.resize(self.size, None);
        if let Some(place) = state.said.get_mut(self.rank) {
            *place = Some(own);
        }
        if state.said.iter().all(Option::is_some) {
            state.heard = Arc::new(state.said.drain(..).flatten().collect());
            state.round += 1;
            self.table.all_are_there.notify_all();
        } else {
            let waits = |state: &mut State| state.round == round;
            let waited = (self.table.all_are_there).wait_timeout_while(state, PATIENCE, waits);
            state = waited.unwrap_or_else(PoisonError::into_inner).0;
            if state.round == round {
                return Err(SILENCE);
            }
        }
        Ok(Arc::clone(&state.heard))
    }

    /// The same where all say as much.
    fn exchange_alike(&self, own: Vec<u8>) -> Result<Arc<Vec<Vec<u8>>>, RanksError> {
        let length = own.len();
        let heard = self.exchange(own)?;
        match heard.iter().all(|said| said.len() == length) {
            true => Ok(heard),
            false => Err(SILENCE),
        }
    }
}

impl Ranks for Thread {
    fn rank(&self) -> usize {
        self.rank
    }

    fn size(&self) -> usize {
        self.size
    }

    fn all_gather(&self, own: &[f64], counts: &[usize], all: &mut [f64]) -> Result<(), RanksError> {
        let heard = self.exchange(own.iter().flat_map(|x| x.to_le_bytes()).collect())?;
        let lengths = heard.iter().map(|said| said.len() / size_of::<f64>());
        if !lengths.eq(counts.iter().copied()) {
            return Err(SILENCE);
        }
        let bytes: Vec<u8> = heard.iter().flatten().copied().collect();
        for (x, bytes) in all.iter_mut().zip(bytes.as_chunks().0) {
            *x = f64::from_le_bytes(*bytes);
        }
        Ok(())
    }

    fn broadcast(&self, bytes: &mut [u8]) -> Result<(), RanksError> {
        let heard = self.exchange_alike(bytes.to_vec())?;
        bytes.copy_from_slice(&heard[0]);
        Ok(())
    }

    fn least(&self, numbers: &mut [u64]) -> Result<(), RanksError> {
        let own = numbers.iter().flat_map(|n| n.to_le_bytes()).collect();
        for said in self.exchange_alike(own)?.iter() {
            for (n, bytes) in numbers.iter_mut().zip(said.as_chunks().0) {
                *n = u64::from_le_bytes(*bytes).min(*n);
            }
        }
        Ok(())
    }

    fn abort(&self, code: u8) {
        self.table.aborted.store(code, Ordering::SeqCst);
    }
}

/// Runs this many threads as the ranks of each other, for tests of what ranks do together: what each comes to, and the exit
/// code with which one has ended all, or 0. Of each thread a few bytes stay until the process ends.
///
/// A thread that waits a minute for the others gets an error.
///
/// # Panics
/// Where `act` does.
///
/// # Example
/// ```
/// use signorini_ranks::on_threads;
///
/// let (sums, ended) = on_threads(3, |ranks| {
///     let mut all = [0.0; 3];
///     ranks.all_gather(&[ranks.rank() as f64], &[1; 3], &mut all)?;
///     Ok::<f64, signorini_ranks::RanksError>(all.iter().sum())
/// });
/// assert!(sums.into_iter().all(|sum| sum == Ok(3.0)) && ended == 0);
/// ```
pub fn on_threads<T: Send>(
    size: usize,
    act: impl Fn(&'static dyn Ranks) -> T + Sync,
) -> (Vec<T>, u8) {
    let table = Arc::new(Table::default());
    let done = std::thread::scope(|scope| {
        let start = |rank| {
            let table = Arc::clone(&table);
            let ranks: &'static Thread = Box::leak(Box::new(Thread { rank, size, table }));
            let act = &act;
            scope.spawn(move || act(ranks))
        };
        let threads: Vec<_> = (0..size).map(start).collect();
        let done = threads.into_iter().map(|thread| match thread.join() {
            Ok(done) => done,
            Err(panic) => std::panic::resume_unwind(panic),
        });
        done.collect()
    });
    (done, table.aborted.load(Ordering::SeqCst))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::agree;

    #[test]
    fn threads_hear_one_another_in_their_order() {
        let (done, _) = on_threads(4, |ranks| {
            let own = vec![ranks.rank() as f64; ranks.rank()];
            let mut all = [0.0; 6];
            ranks.all_gather(&own, &[0, 1, 2, 3], &mut all).unwrap();
            let mut byte = [ranks.rank() as u8 + 7];
            ranks.broadcast(&mut byte).unwrap();
            let same = agree(ranks, 5).unwrap() && !agree(ranks, ranks.rank() as u64).unwrap();
            (all, byte, same)
        });
        for (all, byte, same) in done {
            assert_eq!(all, [1.0, 2.0, 2.0, 3.0, 3.0, 3.0]);
            assert!(byte == [7] && same);
        }
    }

    #[test]
    fn lists_of_other_lengths_are_errors() {
        let (done, ended) = on_threads(2, |ranks| {
            let mut all = [0.0; 3];
            let gathered = ranks.all_gather(&[1.0], &[1, 2], &mut all);
            let least = ranks.least(&mut vec![1; ranks.rank() + 1]);
            if ranks.rank() == 1 {
                ranks.abort(9);
            }
            gathered.is_err() && least.is_err()
        });
        assert_eq!((done, ended), (vec![true, true], 9));
    }
}
