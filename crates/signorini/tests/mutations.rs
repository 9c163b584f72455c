//! Damaged cases: read, built and looked at, never a panic and never much memory.

#![allow(clippy::unwrap_used)]

mod common;
#[allow(dead_code)]
#[path = "common/mutants.rs"]
mod mutants;

use common::text;
use mutants::many;
use signorini::preview::preview;
use signorini::setup::{build, read_mesh_of};
use signorini_io::case::mutate::{Generator, mutate};
use signorini_io::case::read_case;
use std::path::Path;

/// Bytes that reading, building and looking at one damaged case may allocate, all together, on the thread that does it: readers
/// refuse what comes to more than a quarter of that.
const MOST: u64 = 1 << 30;

/// Does what `signorini check` does; says how far it came.
fn check(bytes: &[u8]) -> usize {
    let Ok((case, _)) = read_case("case.toml", bytes, &[], signorini::vocabulary()) else {
        return 0;
    };
    let Ok((mesh, _)) = read_mesh_of(&case, Path::new("/nowhere")) else {
        return 1;
    };
    let Ok(mut model) = build(case, mesh) else {
        return 2;
    };
    if preview(&mut model).is_err() { 3 } else { 4 }
}

fn mutants(count: usize, seed: u64) {
    let originals = [
        "paper_wedge_3d",
        "paper_brick_symmetric_3d",
        "paper_brick_arbitrary_3d",
        "two_blocks_2d",
    ]
    .map(text);
    let mut generator = Generator::new(seed);
    let (mut reached, mut most) = ([0usize; 5], 0);
    for number in 0..count {
        let original = &originals[number % originals.len()];
        let mutant = mutate(original.as_bytes(), &mut generator);
        let mut stage = 0;
        let taken = allocation_counter::measure(|| stage = check(&mutant)).bytes_total;
        reached[stage] += 1;
        most = most.max(taken);
        assert!(
            taken < MOST,
            "mutant {number} of seed {seed} took {taken} bytes:\n{}",
            String::from_utf8_lossy(&mutant)
        );
    }
    println!("refused as text, mesh, model, state; accepted: {reached:?}; at most {most} bytes");
    // the mutants reach every stage: the test is not one of the text alone
    assert!(
        reached[0] > 0 && reached[2] > 0 && reached[4] > 0,
        "{reached:?}"
    );
}

#[test]
fn two_thousand_damaged_cases_are_refused_or_built_without_panic() {
    mutants(2_000, 20261121);
}

#[test]
#[ignore = "takes half a minute: run by .ci/run"]
fn many_more_damaged_cases_are_refused_or_built_without_panic() {
    let (count, seed) = many(7);
    mutants(count, seed);
}
