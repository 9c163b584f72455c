//! A deck is the same model by every door: read as it is, with keys changed, as the case that it is converted to, in the
//! place of CalculiX.

use crate::{decks_in, of_others, own, suite};
use signorini::{Compat, Loaded, Reading, load};
use signorini_io::case::{MeshSource, resolved};
use std::path::{Path, PathBuf};

/// Larger decks are among the long tests.
const LARGE: u64 = 150_000;

/// The folders of decks outside the repository.
fn outside() -> Vec<PathBuf> {
    let Some(suite) = suite() else {
        return Vec::new();
    };
    let shared = suite.join("../..");
    let cases = ["cards", "right", "converges", "fast", "general"];
    let mut folders = vec![suite];
    for folder in cases.map(|name| shared.join("cases").join(name)) {
        let Ok(entries) = std::fs::read_dir(&folder) else {
            println!("SKIPPED: no {}", folder.display());
            continue;
        };
        let below = entries.filter_map(|entry| Some(entry.ok()?.path()));
        folders.extend(below.filter(|path| path.is_dir()));
        folders.push(folder);
    }
    folders.sort();
    folders
}

/// Reads a deck by all doors; returns whether all read it, or all refused it.
fn is_one_model(deck: &Path, compat: Compat) -> bool {
    let reading = |set: &[(&str, &str)]| Reading {
        set: set
            .iter()
            .map(|(k, v)| (k.to_string(), v.to_string()))
            .collect(),
        compat: Some(compat),
    };
    let name = format!("{} {compat:?}", deck.display());
    let plain = load(deck, &reading(&[]));
    let changed = load(deck, &reading(&[("output.format", "[\"frd\"]")]));
    let (plain, changed) = match (plain, changed) {
        (Ok(plain), Ok(changed)) => (plain, changed),
        (Err(_), Err(_)) => return false,
        (a, b) => {
            let found = [a.err(), b.err()].map(|found| found.map(|found| found.plain()));
            panic!("{name}: refused by one door alone: {found:?}");
        }
    };
    same(&name, &plain, changed);
    let scratch = tempfile::tempdir().unwrap();
    let path = scratch.path().join("case.toml");
    let mut case = plain.case.clone();
    case.mesh = MeshSource::File {
        path: deck.canonicalize().unwrap().display().to_string().into(),
    };
    std::fs::write(&path, resolved(&case, signorini::vocabulary())).unwrap();
    let converted = load(&path, &Reading::default());
    same(
        &name,
        &plain,
        converted.unwrap_or_else(|found| panic!("{name}: {}", found.plain())),
    );
    true
}

fn same(name: &str, plain: &Loaded, mut other: Loaded) {
    other.case.mesh = plain.case.mesh.clone();
    other.case.output = plain.case.output.clone();
    if other.case != plain.case {
        let text = [&plain.case, &other.case].map(|case| resolved(case, signorini::vocabulary()));
        let lines = text[0].lines().zip(text[1].lines());
        let apart: Vec<_> = lines.filter(|(a, b)| a != b).take(5).collect();
        panic!("{name}: {apart:#?}");
    }
    assert!(other.mesh == plain.mesh, "{name}: another mesh");
}

fn are_one_model(decks: impl Iterator<Item = PathBuf>) {
    let (mut nread, mut nrefused) = (0, 0);
    for deck in decks {
        for compat in [Compat::None, Compat::Ccx] {
            match is_one_model(&deck, compat) {
                true => nread += 1,
                false => nrefused += 1,
            }
        }
    }
    println!("{nread} decks are one model by all doors, {nrefused} are refused by all");
}

fn size(deck: &Path) -> u64 {
    std::fs::metadata(deck).map_or(0, |file| file.len())
}

#[test]
fn own_decks_are_one_model_by_every_door() {
    let folders = [own("."), of_others(".")];
    are_one_model(folders.iter().flat_map(|folder| decks_in(folder)));
}

#[test]
fn small_decks_outside_the_repository_are_one_model_by_every_door() {
    let decks = outside().into_iter().flat_map(|folder| decks_in(&folder));
    are_one_model(decks.filter(|deck| size(deck) <= LARGE));
}

#[test]
#[ignore = "takes minutes: run by .ci/run"]
fn large_decks_outside_the_repository_are_one_model_by_every_door() {
    let decks = outside().into_iter().flat_map(|folder| decks_in(&folder));
    are_one_model(decks.filter(|deck| size(deck) > LARGE));
}

/// Two cubes that are TIED across a gap or an overlap of 0.05 with nodes that are moved, and pairs with a clearance of
/// either sign.
#[test]
fn moved_nodes_and_negative_clearances_are_kept_by_every_door() {
    const TIED: &str = "PRESSURE-OVERCLOSURE=TIED\n1.e7\n*FRICTION\n1., 1.e7";
    const HARD: &str = "PRESSURE-OVERCLOSURE=LINEAR\n1.e7";
    let scratch = tempfile::tempdir().unwrap();
    let path = scratch.path().join("deck.inp");
    for (law, adjust, more) in [
        (TIED, ", ADJUST=0.1", ""),
        (TIED, ", ADJUST=LOWER", ""),
        (TIED, "", ""),
        (HARD, ", ADJUST=0.1", ""),
        (HARD, ", ADJUST=LOWER", ""),
        (HARD, "", "*CLEARANCE, SLAVE=SB, MASTER=SA, VALUE=0.01\n"),
        (HARD, "", "*CLEARANCE, SLAVE=SB, MASTER=SA, VALUE=-0.01\n"),
    ] {
        for kind in ["NODE TO SURFACE", "SURFACE TO SURFACE", "MORTAR"] {
            for gap in [0.05, -0.05] {
                let deck = two_cubes(law, &format!("TYPE={kind}{adjust}"), more, gap);
                std::fs::write(&path, &deck).unwrap();
                for compat in [Compat::None, Compat::Ccx] {
                    assert!(is_one_model(&path, compat), "{deck}");
                }
            }
        }
    }
}

fn two_cubes(law: &str, pair: &str, more: &str, gap: f64) -> String {
    let z = 1.0 + gap;
    let top = 2.0 + gap;
    format!(
        "*NODE\n1,0,0,0\n2,1,0,0\n3,1,1,0\n4,0,1,0\n5,0,0,1\n6,1,0,1\n7,1,1,1\n8,0,1,1\n\
         11,0,0,{z}\n12,1,0,{z}\n13,1,1,{z}\n14,0,1,{z}\n15,0,0,{top}\n16,1,0,{top}\n17,1,1,{top}\n18,0,1,{top}\n\
         *ELEMENT, TYPE=C3D8, ELSET=A\n1,1,2,3,4,5,6,7,8\n*ELEMENT, TYPE=C3D8, ELSET=B\n2,11,12,13,14,15,16,17,18\n\
         *NSET, NSET=LOWER\n11,12,13,14\n*NSET, NSET=FOOT\n1,2,3,4\n*NSET, NSET=HEAD\n15,16,17,18\n\
         *SURFACE, NAME=SA\n1,S2\n*SURFACE, NAME=SB\n2,S1\n*MATERIAL, NAME=M\n*ELASTIC\n210000,0.3\n\
         *SOLID SECTION, ELSET=A, MATERIAL=M\n*SOLID SECTION, ELSET=B, MATERIAL=M\n\
         *SURFACE INTERACTION, NAME=C\n*SURFACE BEHAVIOR, {law}\n*CONTACT PAIR, INTERACTION=C, {pair}\nSB, SA\n{more}\
         *BOUNDARY\nFOOT,1,3\nHEAD,1,2\n*STEP\n*STATIC\n1.,1.\n*BOUNDARY\nHEAD,3,3,-0.001\n*NODE PRINT, NSET=FOOT, TOTALS=ONLY\nRF\n*END STEP\n"
    )
}
