//! Damaged decks: refused, built or solved, never a panic, much memory, or a good end without a result.

use signorini::{Diagnostics, Listener, Model, News, RunOptions, Source, build};
use signorini_io::case::mutate::Generator;
use signorini_io::deck::Read;
use signorini_mechanics::solve::Flow;

/// Bytes that reading and building one damaged deck may allocate, all together, on the thread that does it: readers
/// refuse what comes to more than a quarter of that.
const MOST: u64 = 1 << 30;

/// Events of a run, such as iterations and increments, after which it is stopped.
const EVENTS: usize = 300;

/// Stops a run after this many events.
struct Limit(usize);

impl Listener for Limit {
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

/// How many mutants a long test tries, and from which seed: 25,000 from this one, or what `SIGNORINI_MUTANTS="200000 7"`
/// asks for.
pub fn many(seed: u64) -> (usize, u64) {
    let asked = std::env::var("SIGNORINI_MUTANTS").unwrap_or_else(|_| format!("25000 {seed}"));
    let (count, seed) = asked.split_once(' ').unwrap();
    (count.parse().unwrap(), seed.parse().unwrap())
}

/// How many mutants, from which seed, and of how many one that can be built is solved.
pub struct Mutants {
    pub count: usize,
    pub seed: u64,
    pub solved_of: usize,
}

impl Mutants {
    /// Reads and builds all of them, and solves some; returns how many runs ended badly, and how many well. Both
    /// functions get the number of the mutant.
    pub fn try_all(
        &self,
        mut damaged: impl FnMut(usize, &mut Generator) -> Vec<u8>,
        read: impl Fn(usize, &[u8]) -> Result<Read, Diagnostics>,
    ) -> [usize; 2] {
        let Self {
            count,
            seed,
            solved_of,
        } = *self;
        let mut generator = Generator::new(seed);
        let (mut reached, mut runs, mut most) = ([0usize; 3], [0usize; 2], 0);
        for number in 0..count {
            let mutant = damaged(number, &mut generator);
            let mut built = Err(0);
            let taken = allocation_counter::measure(|| {
                built = read(number, &mutant)
                    .map_err(|_| 0)
                    .and_then(|read| build(read.case, read.mesh).map_err(|_| 1));
            })
            .bytes_total;
            most = most.max(taken);
            reached[built.as_ref().err().copied().unwrap_or(2)] += 1;
            let of = format!("mutant {number} of seed {seed}");
            if let Ok(mut model) = built
                && runs.iter().sum::<usize>() <= number / solved_of
            {
                runs[usize::from(solve(&mut model, &of))] += 1;
            }
            assert!(taken < MOST, "{of}: {taken} bytes");
        }
        println!(
            "refused as deck, as model; accepted: {reached:?}; ended badly, well: {runs:?}; at most {most} bytes"
        );
        assert!(reached.iter().all(|n| *n > 0), "{reached:?}");
        assert!(
            runs.iter().sum::<usize>() + 1 >= count / solved_of,
            "{runs:?}"
        );
        runs
    }
}

/// Whether a run ends well; then the end of its last step is among its results.
fn solve(model: &mut Model, of: &str) -> bool {
    let scratch = tempfile::tempdir().unwrap();
    let mut options = RunOptions::new(Source::default());
    options.folder = scratch.path().join("out");
    let finished = signorini::run(model, &options, &mut Limit(EVENTS));
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
