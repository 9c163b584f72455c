//! Damaged decks of OOFEM.

use crate::mutants::{Mutants, many};
use crate::{decks_in, own};
use signorini::Compat;
use signorini_io::case::mutate::{Generator, mutate};
use signorini_io::deck::oofem;
use signorini_io::fs::RealFs;

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
    let name = own("mutant.in").display().to_string();
    let all = Mutants {
        count,
        seed,
        solved_of: 1000,
    };
    all.try_all(
        |number, generator| {
            let original = &originals[number % originals.len()];
            if number % 2 == 0 {
                mutate(original, generator)
            } else {
                mutate_records(original, generator)
            }
        },
        |_, mutant| oofem::read(&RealFs, &name, mutant, Compat::Oofem),
    );
}

#[test]
fn of_two_thousand_damaged_decks_none_ends_badly() {
    mutants(2_000, 20261123);
}

#[test]
#[ignore = "takes half a minute: run by .ci/run"]
fn of_many_more_damaged_decks_none_ends_badly() {
    let (count, seed) = many(7);
    mutants(count, seed);
}
