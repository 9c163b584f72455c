//! Damaged decks: refused, built or solved, never a panic, much memory, or a good end without a result.

use crate::{of_others, own};
use signorini::{Compat, Listener, Model, News, RunOptions, Source, build};
use signorini_io::case::mutate::{Generator, mutate};
use signorini_io::deck;
use signorini_io::fs::RealFs;
use signorini_mechanics::solve::Flow;

/// Bytes that reading and building one damaged deck may allocate, all together, on the thread that does it: readers
/// refuse what comes to more than a quarter of that.
const MOST: u64 = 1 << 30;

/// Events of a run, such as iterations and increments, after which it is stopped.
const EVENTS: usize = 300;

/// Stops a run after some events.
struct Patience(usize);

impl Listener for Patience {
    fn hear(&mut self, _: &News<'_>) -> Flow {
        self.0 = self.0.saturating_sub(1);
        if self.0 > 0 {
            Flow::Continue
        } else {
            Flow::Stop
        }
    }

    fn opens_files(&self) -> bool {
        false
    }
}

/// Reads and builds so many; of each hundred, one that can be built is solved.
fn mutants(count: usize, seed: u64) {
    let originals = [own("block.inp"), own("pair.inp"), of_others("prepomax.inp")];
    let originals = originals.map(|path| std::fs::read(path).unwrap());
    let mut generator = Generator::new(seed);
    let mut reached = [0usize; 3];
    let (mut ends, mut most) = ([0usize; 2], 0);
    for number in 0..count {
        let mutant = mutate(&originals[number % originals.len()], &mut generator);
        let name = own("mutant.inp").display().to_string();
        let compat = [Compat::None, Compat::Ccx][number / 3 % 2];
        let mut built = Err(0);
        let taken = allocation_counter::measure(|| {
            built = deck::read(&RealFs, &name, &mutant, compat)
                .map_err(|_| 0)
                .and_then(|read| build(read.case, read.mesh).map_err(|_| 1));
        })
        .bytes_total;
        most = most.max(taken);
        reached[built.as_ref().err().copied().unwrap_or(2)] += 1;
        let of = format!("mutant {number} of seed {seed}");
        if let Ok(mut model) = built
            && ends.iter().sum::<usize>() <= number / 100
        {
            ends[usize::from(solve(&mut model, &of))] += 1;
        }
        assert!(taken < MOST, "{of}: {taken} bytes");
    }
    println!(
        "refused as deck, as model; accepted: {reached:?}; ended badly, well: {ends:?}; at most {most} bytes"
    );
    assert!(reached.iter().chain(&ends).all(|n| *n > 0), "{reached:?}");
    assert!(ends.iter().sum::<usize>() + 1 >= count / 100, "{ends:?}");
}

/// Whether a run ends well; then the end of its last step is among its results, all of numbers.
fn solve(model: &mut Model, of: &str) -> bool {
    let scratch = tempfile::tempdir().unwrap();
    let mut options = RunOptions::new(Source::default());
    options.folder = scratch.path().join("out");
    let finished = signorini::run(model, &options, &mut Patience(EVENTS));
    if finished.exit_code > 1 {
        return false;
    }
    let steps = &finished.summary.steps;
    assert_eq!(steps.len(), model.steps.len(), "{of}");
    assert!(steps.iter().all(|step| step.increments > 0), "{of}");
    let series = std::fs::read_to_string(options.folder.join("results.pvd"));
    assert!(series.is_ok_and(|text| text.contains("<DataSet")), "{of}");
    true
}

#[test]
fn of_two_thousand_damaged_decks_none_ends_badly() {
    mutants(2_000, 20261122);
}

/// How many and from which seed is asked for by `SIGNORINI_MUTANTS="1000000 7"`.
#[test]
#[ignore = "takes minutes: run by .ci/run"]
fn of_a_hundred_thousand_damaged_decks_none_ends_badly() {
    let asked = std::env::var("SIGNORINI_MUTANTS").unwrap_or_else(|_| "100000 6".into());
    let (count, seed) = asked.split_once(' ').unwrap();
    mutants(count.parse().unwrap(), seed.parse().unwrap());
}
