//! Damaged decks: refused, built or solved, never a panic, much memory, or a good end without a result.

use crate::{decks_in, own};
use signorini::{Compat, Listener, Model, News, RunOptions, Source, build};
use signorini_io::case::mutate::{Generator, mutate};
use signorini_io::deck::oofem;
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

/// A deck with whole fields changed: a count, a number or a keyword is taken from elsewhere in it, lines are lost,
/// doubled or change places.
fn mutate_records(text: &[u8], generator: &mut Generator) -> Vec<u8> {
    let text = String::from_utf8_lossy(text);
    let mut lines: Vec<Vec<&str>> = text.lines().map(|l| l.split(' ').collect()).collect();
    let words: Vec<&str> = text.split_whitespace().collect();
    let is_number = |word: &&str| word.parse::<f64>().is_ok();
    let numbers: Vec<&str> = words.iter().copied().filter(is_number).collect();
    const ODD: [&str; 8] = [
        "0",
        "-1",
        "2",
        "1e300",
        "nan",
        "99999999999999999999",
        "{(1 9)}",
        "$t$",
    ];
    for _ in 0..=generator.below(2) {
        let (at, other) = (generator.below(lines.len()), generator.below(lines.len()));
        match generator.below(16) {
            0 => drop(lines.remove(at)),
            1 => lines.insert(at, lines[other].clone()),
            2 => lines.swap(at, other),
            kind => {
                let line = &mut lines[at];
                let chosen = generator.below(line.len());
                if let Some(word) = line.get_mut(chosen) {
                    *word = match kind {
                        3 => words[generator.below(words.len())],
                        4 | 5 => ODD[generator.below(ODD.len())],
                        _ if is_number(&&**word) => numbers[generator.below(numbers.len())],
                        _ => *word,
                    };
                }
            }
        }
        if lines.is_empty() {
            break;
        }
    }
    let lines: Vec<String> = lines.iter().map(|words| words.join(" ")).collect();
    lines.join("\n").into_bytes()
}

/// Reads and builds so many; of each thousand, one that can be built is solved.
fn mutants(count: usize, seed: u64) {
    let originals: Vec<Vec<u8>> = (decks_in(&own(".")).iter())
        .map(|path| std::fs::read(path).unwrap())
        .collect();
    let mut generator = Generator::new(seed);
    let mut reached = [0usize; 3];
    let (mut ends, mut most) = ([0usize; 2], 0);
    for number in 0..count {
        let original = &originals[number % originals.len()];
        let mutant = if number % 2 == 0 {
            mutate(original, &mut generator)
        } else {
            mutate_records(original, &mut generator)
        };
        let name = own("mutant.in").display().to_string();
        let mut built = Err(0);
        let taken = allocation_counter::measure(|| {
            built = oofem::read(&RealFs, &name, &mutant, Compat::Oofem)
                .map_err(|_| 0)
                .and_then(|read| build(read.case, read.mesh).map_err(|_| 1));
        })
        .bytes_total;
        most = most.max(taken);
        reached[built.as_ref().err().copied().unwrap_or(2)] += 1;
        let of = format!("mutant {number} of seed {seed}");
        if let Ok(mut model) = built
            && ends.iter().sum::<usize>() <= number / 1000
        {
            ends[usize::from(solve(&mut model, &of))] += 1;
        }
        assert!(taken < MOST, "{of}: {taken} bytes");
    }
    println!(
        "refused as deck, as model; accepted: {reached:?}; ended badly, well: {ends:?}; at most {most} bytes"
    );
    assert!(reached.iter().all(|n| *n > 0), "{reached:?}");
    assert!(ends.iter().sum::<usize>() + 1 >= count / 1000, "{ends:?}");
}

/// Whether a run ends well; then the end of its last step is among its results.
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
    true
}

#[test]
fn of_two_thousand_damaged_decks_none_ends_badly() {
    mutants(2_000, 20261123);
}

#[test]
#[ignore = "takes minutes: run by .ci/run"]
fn of_two_hundred_thousand_damaged_decks_none_ends_badly() {
    mutants(200_000, 7);
}
