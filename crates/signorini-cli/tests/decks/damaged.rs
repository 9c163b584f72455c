//! Damaged decks of Abaqus and CalculiX.

use crate::mutants::{Mutants, many};
use crate::{of_others, own};
use signorini::Compat;
use signorini_io::case::mutate::mutate;
use signorini_io::deck;
use signorini_io::fs::RealFs;

/// Reads and builds so many; of each hundred, one that can be built is solved.
fn mutants(count: usize, seed: u64) {
    let originals = [
        own("block.inp"),
        own("pair.inp"),
        own("cards.inp"),
        of_others("prepomax.inp"),
    ];
    let originals = originals.map(|path| std::fs::read(path).unwrap());
    let name = own("mutant.inp").display().to_string();
    let all = Mutants {
        count,
        seed,
        solved_of: 100,
    };
    let runs = all.try_all(
        |number, generator| mutate(&originals[number % originals.len()], generator),
        |number, mutant| {
            let compat = [Compat::None, Compat::Ccx][number / 4 % 2];
            deck::read(&RealFs, &name, mutant, compat)
        },
    );
    assert!(runs.iter().all(|n| *n > 0), "{runs:?}");
}

#[test]
fn of_two_thousand_damaged_decks_none_ends_badly() {
    mutants(2_000, 20261122);
}

#[test]
#[ignore = "takes a minute: run by .ci/run"]
fn of_many_more_damaged_decks_none_ends_badly() {
    let (count, seed) = many(6);
    mutants(count, seed);
}
