//! Decks on the command line.

use super::support::{read, run};
use std::path::Path;
use tempfile::TempDir;

/// A folder with the decks of the tests.
fn decks() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    let data = Path::new(env!("CARGO_MANIFEST_DIR")).join("../signorini/tests/data");
    for name in ["block.inp", "pair.inp", "pair_nodes.inc"] {
        std::fs::copy(data.join(name), folder.path().join(name)).unwrap();
    }
    folder
}

#[test]
fn a_deck_is_run_checked_and_printed() {
    let folder = decks();
    run(folder.path(), &["check", "pair.inp"]).says(0, &["nothing wrong was found"]);
    run(folder.path(), &["run", "pair.inp"]).says(0, &["solved"]);
    let printed = read(&folder.path().join("pair.out/pair.dat"));
    assert!(
        printed.contains(" total force (fx,fy,fz) for set HEAD and time"),
        "{printed}"
    );
    let resolved = read(&folder.path().join("pair.out/case.resolved.toml"));
    assert!(resolved.contains("method = \"mortar\""), "{resolved}");
    run(
        folder.path(),
        &["run", "pair.inp", "--compat", "ccx", "--fresh"],
    )
    .says(0, &["solved"]);
    let resolved = read(&folder.path().join("pair.out/case.resolved.toml"));
    assert!(
        resolved.contains("method = \"gauss-point\"") && resolved.contains("penalty = 1000000")
    );
}

#[test]
fn a_deck_can_be_changed_and_converted() {
    let folder = decks();
    run(folder.path(), &["convert", "block.inp", "block.toml"]).says(0, &["→ block.toml"]);
    run(folder.path(), &["run", "block.toml", "-o", "toml.out"]).says(0, &["solved"]);
    run(folder.path(), &["run", "block.inp", "-o", "inp.out"]).says(0, &["solved"]);
    run(
        folder.path(),
        &[
            "diff",
            "toml.out/block.dat",
            "inp.out/block.dat",
            "--rel",
            "1e-12",
        ],
    )
    .says(0, &["the same"]);
    run(
        folder.path(),
        &[
            "run",
            "block.inp",
            "--set",
            "material.SOFT.nu=0.3",
            "-o",
            "other.out",
        ],
    )
    .says(0, &["solved"]);
    run(folder.path(), &["convert", "block.toml", "block.inp"])
        .says(2, &["a deck, .inp or .in, as a case, .toml"]);
}

#[test]
fn a_stand_in_leaves_the_files_that_programs_look_for() {
    let folder = decks();
    run(folder.path(), &["ccx-compat", "-v"]).says(0, &["This is Signorini"]);
    run(folder.path(), &["ccx-compat", "-i", "pair"]).says(0, &["solved"]);
    for (name, word) in [
        ("pair.dat", "total force"),
        ("pair.frd", "DISP"),
        ("pair.sta", "STEP"),
    ] {
        assert!(read(&folder.path().join(name)).contains(word), "{name}");
    }
    let text = read(&folder.path().join("pair.inp")).replace("*Static", "*Statik");
    std::fs::write(folder.path().join("pair.inp"), text).unwrap();
    run(folder.path(), &["ccx-compat", "-i", "pair"]).says(201, &["pair.inp:"]);
    assert!(!folder.path().join("pair.dat").exists());
}

#[test]
fn keywords_are_listed_and_faults_shown_where_they_are() {
    let folder = decks();
    run(folder.path(), &["keywords"])
        .says(0, &["*CONTACT PAIR", "refused, with their line:", "*MPC"]);
    let text = read(&folder.path().join("block.inp")).replace("6, 3, 100.", "66, 3, 100.");
    std::fs::write(folder.path().join("bad.inp"), text).unwrap();
    run(folder.path(), &["run", "bad.inp"])
        .says(3, &["there is no node 66", "bad.inp:31:1", "66, 3, 100."]);
}

/// A cube of edge one whose material has these cards, held so that it may stretch freely, and more cards.
fn free_cube(material: &str, more: &str) -> String {
    format!(
        "*NODE, NSET=ALL\n1,0,0,0\n2,1,0,0\n3,1,1,0\n4,0,1,0\n5,0,0,1\n6,1,0,1\n7,1,1,1\n8,0,1,1\n\
         *ELEMENT, TYPE=C3D8, ELSET=CUBE\n1,1,2,3,4,5,6,7,8\n*NSET, NSET=FAR\n7\n*NSET, NSET=TOP\n5,6,7,8\n\
         *BOUNDARY\n1,1,3\n2,2,3\n3,3\n4,1\n4,3\n5,1,2\n6,2\n8,1\n*MATERIAL, NAME=M\n{material}\n\
         *SOLID SECTION, ELSET=CUBE, MATERIAL=M\n{more}\n*NODE PRINT, NSET=FAR\nU\n*EL PRINT, ELSET=CUBE\nS\n*END STEP\n"
    )
}

/// The numbers of the first row below this heading in the printed tables of a deck.
fn printed(deck: &str, heading: &str) -> Vec<f64> {
    all_printed(deck, heading, "none").swap_remove(0)
}

/// The numbers of all rows below this heading in the printed tables of a deck, at all times.
fn all_printed(deck: &str, heading: &str, compat: &str) -> Vec<Vec<f64>> {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("job.inp"), deck).unwrap();
    let command = ["run", "job.inp", "--compat", compat];
    run(folder.path(), &command).says(0, &["solved"]);
    let text = read(&folder.path().join("job.out/job.dat"));
    let mut rows = Vec::new();
    let mut lines = text.lines();
    while lines.by_ref().any(|line| line.contains(heading)) {
        let table = lines.by_ref().skip(1).take_while(|line| !line.is_empty());
        rows.extend(table.map(|row| {
            let numbers = row.split_whitespace();
            numbers.map(|n| n.parse().unwrap()).collect()
        }));
    }
    rows
}

#[test]
fn a_bar_whose_constants_depend_on_temperature_has_those_of_its_end() {
    let material =
        "*ELASTIC\n200., 0.25, 0.\n100., 0.25, 1000.\n*EXPANSION, ZERO=20.\n1e-5, 0.\n3e-5, 1000.";
    let step = "*INITIAL CONDITIONS, TYPE=TEMPERATURE\nALL, 100.\n*STEP\n*STATIC\n*TEMPERATURE\nALL, 600.\n*CLOAD\nTOP, 3, 0.25";
    let row = printed(&free_cube(material, step), "displacements");
    // E(600) = 140; α is a secant from 20 on
    let alpha = |t: f64| (1e-5 + 2e-8 * t) * (t - 20.0);
    let thermal = alpha(600.0) - alpha(100.0);
    for (at, wanted) in [(1, -0.25 / 140.0 + thermal), (3, 1.0 / 140.0 + thermal)] {
        assert!((row[at] - wanted).abs() < 1e-8, "{row:?} {wanted}");
    }
}

#[test]
fn a_strain_at_the_start_stretches_what_is_free_and_stresses_what_is_held() {
    let elastic = "*ELASTIC\n200., 0.25";
    let points: Vec<String> = (1..=8)
        .map(|k| format!("1, {k}, 0.01, 0., -0.02, 0., 0., 0."))
        .collect();
    let start = |kind: &str| format!("*INITIAL CONDITIONS, TYPE={kind}\n{}\n", points.join("\n"));
    let step = "*STEP\n*STATIC";
    let free = free_cube(elastic, &format!("{}{step}", start("PLASTIC STRAIN")));
    let row = printed(&free, "displacements");
    for (at, wanted) in [(1, 0.01), (2, 0.0), (3, -0.02)] {
        assert!((row[at] - wanted).abs() < 1e-9, "{row:?}");
    }
    let held = free_cube(
        elastic,
        &format!("*BOUNDARY\nALL, 1, 3\n{}{step}", start("STRESS")),
    );
    let row = printed(&held, "stresses");
    for (at, wanted) in [(2, 0.01), (3, 0.0), (4, -0.02)] {
        assert!((row[at] - wanted).abs() < 1e-12, "{row:?}");
    }
}

#[test]
fn foams_and_anisotropic_bars_stretch_as_their_laws_say() {
    // nu = 0: τ = 2μ/α (l^α − 1) = σ l, no lateral strain
    let foam = "*HYPERFOAM, N=1\n50., 2., 0.";
    let step = "*STEP, NLGEOM\n*STATIC\n*BOUNDARY\nTOP, 3, 3, 0.2";
    let row = printed(&free_cube(foam, step), "stresses");
    let wanted = 50.0 * (1.2f64.powi(2) - 1.0);
    assert!(
        (row[4] * 1.0 - wanted / 1.2).abs() < 1e-4,
        "{row:?} {wanted}"
    );
    let d = "*ELASTIC, TYPE=ANISO\n300., 110., 320., 130., 140., 350., 0., 0.\n0., 190., 0., 0., 0., 0., 240., 0.\n0., 0., 0., 0., 200.";
    let step = "*BOUNDARY\nALL, 1, 2\n*STEP\n*STATIC\n*BOUNDARY\nTOP, 3, 3, 0.001";
    let row = printed(&free_cube(d, step), "stresses");
    for (at, wanted) in [(2, 0.13), (3, 0.14), (4, 0.35)] {
        assert!((row[at] - wanted).abs() < 1e-9, "{row:?}");
    }
}

#[test]
fn sections_of_different_thickness_share_a_force_by_it() {
    // two sheets side by side, stretched alike: forces go by thickness
    let deck = "*NODE, NSET=ALL\n1,0,0\n2,1,0\n3,1,1\n4,0,1\n5,0,2\n6,1,2\n*ELEMENT, TYPE=CPS4, ELSET=A\n1,1,2,3,4\n\
                *ELEMENT, TYPE=CPS4, ELSET=B\n2,4,3,6,5\n*NSET, NSET=RIGHT\n2,3,6\n*NSET, NSET=LEFT\n1,4,5\n*MATERIAL, NAME=M\n*ELASTIC\n100., 0.\n\
                *SOLID SECTION, ELSET=A, MATERIAL=M\n0.5\n*SOLID SECTION, ELSET=B, MATERIAL=M\n2.\n\
                *BOUNDARY\n1,1,2\n4,1\n5,1\n*STEP\n*STATIC\n*DLOAD\n1, P2, -0.3\n2, P2, -0.3\n*NODE PRINT, NSET=RIGHT\nU\n\
                *EL PRINT, ELSET=B\nS\n*NODE PRINT, NSET=LEFT, TOTALS=ONLY\nRF\n*END STEP\n";
    let row = printed(deck, "displacements");
    assert!((row[1] - 0.003).abs() < 1e-9, "{row:?}");
    let row = printed(deck, "total force");
    assert!((row[0] + 0.3 * 2.5).abs() < 1e-6, "{row:?}");
}

/// A ring of the radii 1 and 2 under a sheet as thick as the circumference at their mean, ν = 0: what presses the sheet
/// arrives below the ring, and the mean stress of the sheet is that pressure.
#[test]
fn a_ring_bears_a_sheet_that_stands_for_what_is_around_the_circumference() {
    let around = 3.0 * std::f64::consts::PI;
    let deck = |contact: &str| {
        format!(
            "*NODE, NSET=ALL\n1,1,0\n2,2,0\n3,2,1\n4,1,1\n5,1,1\n6,2,1\n7,2,2\n8,1,2\n\
             *ELEMENT, TYPE=CAX4, ELSET=RING\n1,1,2,3,4\n*ELEMENT, TYPE=CPS4, ELSET=SHEET\n2,5,6,7,8\n\
             *NSET, NSET=BASE\n1,2\n*SURFACE, NAME=FOOT\nSHEET, S1\n*SURFACE, NAME=SEAT\nRING, S3\n\
             *SURFACE, NAME=FEET, TYPE=NODE\n5,\n6,\n{contact}*SURFACE INTERACTION, NAME=I\n\
             *SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR\n1e6\n*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.\n\
             *SOLID SECTION, ELSET=RING, MATERIAL=M\n0.1\n*SOLID SECTION, ELSET=SHEET, MATERIAL=M\n{around}\n\
             *BOUNDARY\nBASE, 2\nALL, 1\n*STEP\n*STATIC\n*DLOAD\n2, P3, 10.\n*NODE PRINT, NSET=BASE, TOTALS=ONLY\nRF\n\
             *EL PRINT, ELSET=SHEET\nS,EVOL\n*END STEP\n"
        )
    };
    // forces and volumes are printed as those of two degrees
    let share = around / 180.0;
    for contact in [
        "*CONTACT PAIR, INTERACTION=I, TYPE=SURFACE TO SURFACE\nFOOT, SEAT\n",
        "*CONTACT PAIR, INTERACTION=I, TYPE=NODE TO SURFACE\nFEET, SEAT\n",
    ] {
        let deck = deck(contact);
        for compat in ["none", "ccx"] {
            let first = |heading| all_printed(&deck, heading, compat).swap_remove(0);
            let force = first("total force");
            assert!((force[1] - 10.0 * share).abs() < 1e-6, "{force:?}");
            let volume = first("volume (");
            assert!((volume[1] - share).abs() < 1e-6, "{volume:?}");
            let stresses = all_printed(&deck, "stresses", compat);
            let mean = stresses.iter().map(|row| row[3]).sum::<f64>() / stresses.len() as f64;
            assert!((mean + 10.0).abs() < 1e-5, "{stresses:?}");
        }
    }
    let folder = tempfile::tempdir().unwrap();
    let strain = deck("").replace("CPS4", "CPE4");
    std::fs::write(folder.path().join("job.inp"), strain).unwrap();
    run(folder.path(), &["run", "job.inp"]).says(3, &["no part of a ring"]);
}

/// The lower nodes begin at 100 degrees, the others at 20: at 100 everywhere, ε = 1e-3 (100 − T₀), whose mean is 0.04.
#[test]
fn thermal_strain_counts_from_what_each_place_is_at_at_the_start() {
    let start =
        "*NSET, NSET=BASE\n1,2,3,4\n*INITIAL CONDITIONS, TYPE=TEMPERATURE\nALL, 20.\nBASE, 100.\n";
    let step = "*BOUNDARY\nALL, 1, 2\n*STEP\n*STATIC\n*TEMPERATURE\nALL, 100.";
    let law = "*ELASTIC\n1000., 0.\n*EXPANSION, ZERO=7.\n1e-3";
    let deck = free_cube(law, &format!("{start}{step}"));
    let row = printed(&deck, "displacements");
    assert!((row[3] - 0.04).abs() < 1e-9, "{row:?}");
}

/// In the second step the first load is replaced, and the second element turns, too.
#[test]
fn squared_speeds_of_centrifugal_loads_are_printed_by_element() {
    let nodes = "*NODE, NSET=ALL\n1,1,0\n2,2,0\n3,2,1\n4,1,1\n5,3,0\n6,3,1\n*ELEMENT, TYPE=CPS4, ELSET=ALL\n1,1,2,3,4\n2,2,5,6,3\n";
    let deck = format!(
        "{nodes}*ELSET, ELSET=ONE\n1\n*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.\n*DENSITY\n1e-3\n\
         *SOLID SECTION, ELSET=ALL, MATERIAL=M\n1.\n*BOUNDARY\n1,1,2\n4,1\n\
         *STEP\n*STATIC, DIRECT\n0.5, 1.\n*DLOAD\nONE, CENTRIF, 4., 0., 0., 0., 0., 0., 1.\n*EL PRINT, ELSET=ALL\nCENT\n*END STEP\n\
         *STEP\n*STATIC\n1., 1.\n*DLOAD\nALL, CENTRIF, 6., 0., 0., 0., 0., 0., 1.\n*END STEP\n"
    );
    let heading = "centrifugal force(element,omega square)";
    let rows = all_printed(&deck, heading, "none");
    let wanted = [
        [1.0, 2.0],
        [2.0, 0.0],
        [1.0, 4.0],
        [2.0, 0.0],
        [1.0, 6.0],
        [2.0, 6.0],
    ];
    assert_eq!(rows, wanted);
}
