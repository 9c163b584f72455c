//! Damaged, hostile and large texts.

use super::options::WRONG_OPTIONS;
use super::*;
use crate::case::mutate::{Generator, mutate};
use std::fmt::Write as _;

#[test]
fn a_megabyte_in_one_line_reads_and_errs_quickly() {
    let ids: Vec<String> = (0..150_000).map(|n| n.to_string()).collect();
    let text = brick("[1, 2, 3, 4] }", &format!("[{}] }}", ids.join(", ")));
    assert!(text.len() > 1_000_000);
    assert!(
        matches!(&read(&text).unwrap().0.sets[0].content, SetContent::Nodes(ids) if ids.len() == 150_000)
    );
    let wrong = read(&text.replace(", 149999]", ", -1]"))
        .unwrap_err()
        .plain();
    assert!(
        wrong.contains("`nodes` = -1 is out of range") && wrong.len() < 2000,
        "{wrong}"
    );
}

/// Reads damaged copies of all cases, one for each seed; returns how many still read and how many are refused.
fn read_damaged(seeds: std::ops::Range<u64>) -> (usize, usize) {
    let (mut nread, mut nrefused) = (0, 0);
    for seed in seeds {
        let mut generator = Generator::new(seed);
        let text = [PAPER_BRICK, HERTZ, SLIDING, EVERYTHING, PLANE][generator.below(5)];
        let bytes = mutate(text.as_bytes(), &mut generator);
        match read_case("case.toml", &bytes, &[], vocabulary()) {
            Ok((case, warnings)) => {
                let written = resolved(&case, vocabulary());
                let (again, _) =
                    read(&written).unwrap_or_else(|all| panic!("seed {seed}: {all}\n{written}"));
                assert_eq!(again, case, "seed {seed}");
                assert!(!warnings.has_errors());
                nread += 1;
            }
            Err(all) => {
                assert!(
                    all.exit_code() == Some(3) && !all.coloured().is_empty(),
                    "seed {seed}"
                );
                nrefused += 1;
            }
        }
    }
    (nread, nrefused)
}

#[test]
fn damaged_texts_never_panic_and_what_reads_round_trips() {
    let (nread, nrefused) = read_damaged(0..2_000);
    assert!(
        nread > 50 && nrefused > 1_000,
        "{nread} read, {nrefused} refused"
    );
}

#[test]
#[ignore = "takes a minute"]
fn a_hundred_thousand_damaged_texts_never_panic() {
    let (nread, nrefused) = read_damaged(2_000..102_000);
    assert!(
        nread > 2_500 && nrefused > 50_000,
        "{nread} read, {nrefused} refused"
    );
}

#[test]
fn damaged_options_never_panic() {
    for seed in 0..2000 {
        let mut generator = Generator::new(seed);
        let (path, value) = WRONG_OPTIONS[generator.below(WRONG_OPTIONS.len())];
        let damaged = |text: &str, generator: &mut Generator| {
            String::from_utf8_lossy(&mutate(text.as_bytes(), generator)).into_owned()
        };
        let set = [(
            damaged(path, &mut generator),
            damaged(value, &mut generator),
        )];
        if let Err(all) = read_case("case.toml", PAPER_BRICK.as_bytes(), &set, vocabulary()) {
            assert!(
                all.exit_code() == Some(3) && all.plain().contains("--set"),
                "{all}"
            );
        }
    }
}

/// Texts made to take long: many of something, or deep; `n` of it, or in proportion.
fn hostile(n: usize) -> Vec<(&'static str, String)> {
    let lines = |line: &dyn Fn(usize) -> String| (0..n).map(line).collect::<String>();
    vec![
        ("blank lines", "\n".repeat(300 * n)),
        ("unknown keys", lines(&|n| format!("key{n} = {n}\n"))),
        ("one key many times", lines(&|_| "title = 1\n".to_owned())),
        ("decimal commas", lines(&|n| format!("key{n} = 0,{n}\n"))),
        (
            "undefined materials",
            lines(&|n| {
                format!("[[body]]\ngroup = \"g{n}\"\nmaterial = \"m{n}\"\n[material.n{n}]\n")
            }),
        ),
        (
            "sets and bodies",
            lines(&|n| {
                format!("[[body]]\ngroup = \"g{n}\"\nmaterial = \"m\"\n[sets.s{n}]\nnodes = [1]\n")
            }),
        ),
        ("dots", format!("{}a = 1", "a.".repeat(15 * n))),
        ("headings", format!("[{}a]\n", "a.".repeat(15 * n))),
        ("braces", format!("a = {}", "{a=".repeat(10 * n))),
        ("a long key", format!("{} = 1", "a".repeat(30 * n))),
        (
            "a long text",
            format!("title = \"{}\"\nx = 1", "a".repeat(300 * n)),
        ),
    ]
}

/// Work is counted in allocations and their bytes: with the square of the size it would grow sixteenfold.
#[test]
fn texts_made_to_take_long_take_what_their_size_takes() {
    for ((name, few), (_, many)) in hostile(7_500).iter().zip(&hostile(30_000)) {
        let [few, many] = [few, many].map(|text| {
            let mut message = String::new();
            let taken = allocation_counter::measure(|| message = read(text).unwrap_err().plain());
            assert!(message.len() < 50_000, "{name}");
            taken
        });
        println!("{name}: {few:?}, {many:?}");
        let bytes = 6 * few.bytes_total + (1 << 16);
        assert!(many.bytes_total < bytes, "{name}: {few:?}, {many:?}");
        let count = 6 * few.count_total + (1 << 10);
        assert!(many.count_total < count, "{name}: {few:?}, {many:?}");
    }
}

#[test]
fn ten_times_as_many_nodes_take_ten_times_the_memory() {
    let [few, many] = [10_000, 100_000].map(|nnode| {
        let mut text = String::from("[mesh]\nnodes = [\n");
        for n in 0..nnode {
            let x = f64::from(n) * 0.001;
            let _ = writeln!(text, "  [{n}, {}, {x:.6}, -1.5e-3],", n % 100);
        }
        text.push_str(
            "]\nelements = [{ id = 1, type = \"tet4\", group = \"a\", nodes = [0, 1, 2, 3] }]\n",
        );
        text.push_str("[[body]]\ngroup = \"a\"\nrigid = true\n[[step]]\nname = \"s\"\n");
        let mut result = None;
        let taken = allocation_counter::measure(|| result = Some(read(&text)));
        let (case, _) = result.unwrap().unwrap();
        let nread = match &case.mesh {
            MeshSource::Inline { nodes, .. } => nodes.len(),
            _ => 0,
        };
        assert_eq!(nread, nnode as usize);
        taken.bytes_total as f64 / text.len() as f64
    });
    // lists double when they are full
    assert!(many < 2.0 * few, "{few}, {many} bytes per byte of the text");
}
