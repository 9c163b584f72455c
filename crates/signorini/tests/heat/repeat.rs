//! The same bits: in a run that was stopped and resumed, and on any number of threads.

use super::balance::rubbing_in;
use super::*;
use signorini::{News, Reading, RunOptions, build, open_text};
use signorini_io::fs::{Fs, MemoryFs};
use signorini_mechanics::solve::Flow;
use std::path::PathBuf;
use std::sync::Arc;

const CONTACTS: [(usize, &str); 5] = [
    (2, "method = \"mortar\"\nenforcement = { lagrange = {} }"),
    (2, "method = \"mortar\"\nenforcement = { penalty = 1e5 }"),
    (
        2,
        "method = \"node-to-segment\"\nenforcement = { penalty = 1e5 }\npasses = 2",
    ),
    (
        2,
        "method = \"gauss-point\"\nenforcement = { penalty = 1e5 }",
    ),
    (3, "method = \"mortar\"\nenforcement = { penalty = 1e5 }"),
];

/// The files of a run that was stopped after so many pieces of news, again and again, and resumed.
fn stopped_after(text: &str, stops: &[usize]) -> Vec<(String, Vec<u8>)> {
    let fs: Arc<dyn Fs> = Arc::new(MemoryFs::default());
    let mut folder = PathBuf::new();
    for (part, stop) in stops.iter().map(Some).chain([None]).enumerate() {
        let opened = open_text("case.toml".as_ref(), text.into(), &Reading::default()).unwrap();
        let loaded = opened.with_mesh().unwrap();
        let mut options = RunOptions::new(loaded.source);
        (options.fs, options.resume) = (Arc::clone(&fs), part > 0);
        folder = options.folder.clone();
        let mut model = build(loaded.case, loaded.mesh).unwrap();
        let mut count = 0;
        let finished = signorini::run(&mut model, &options, &mut |_: &News<'_>| {
            count += 1;
            match stop {
                Some(&stop) if count >= stop => Flow::Stop,
                _ => Flow::Continue,
            }
        });
        let wanted = if stop.is_some() { 130 } else { 0 };
        let said = finished.diagnostics.plain();
        assert_eq!(finished.exit_code, wanted, "{said}");
    }
    let names = ["history.csv".to_owned()].into_iter();
    let frames =
        (0..3).flat_map(|n| ["volume", "contact"].map(|kind| format!("frames/{kind}_{n:04}.vtu")));
    let read = |name: String| {
        let bytes = fs.read(&folder.join(&name)).unwrap();
        (name, bytes)
    };
    names.chain(frames).map(read).collect()
}

#[test]
fn a_resumed_run_with_heat_of_friction_and_conductance_has_the_same_bits() {
    for (ndim, contact) in CONTACTS {
        let (_, text) = rubbing_in(ndim, "material = \"m\"", contact);
        let whole = stopped_after(&text, &[]);
        for stops in [&[25][..], &[15, 12]] {
            let parts = stopped_after(&text, stops);
            for ((name, whole), (_, parts)) in whole.iter().zip(&parts) {
                assert!(whole == parts, "{ndim} {contact} {stops:?}: {name}");
            }
        }
    }
}

#[test]
fn the_number_of_threads_does_not_change_a_bit_of_heat() {
    for (ndim, contact) in CONTACTS {
        let (_, text) = rubbing_in(ndim, "material = \"m\"", contact);
        let runs = [1, 2, 3].map(|n| {
            let threads = rayon::ThreadPoolBuilder::new().num_threads(n);
            threads.build().unwrap().install(|| solved(&text).0)
        });
        for other in &runs[1..] {
            for (one, other) in runs[0].frames.iter().zip(&other.frames) {
                let what = format!("{ndim} {contact} at {}", one.time);
                assert_eq!(one.displacement, other.displacement, "{what}");
                assert_eq!(one.temperature, other.temperature, "{what}");
                assert_eq!(one.heat, other.heat, "{what}");
                let warmth = |frame: &Frame| frame.contacts[0].warmth.clone();
                assert_eq!(warmth(one), warmth(other), "{what}");
            }
        }
    }
}
