//! Meshes and results in other formats, and pictures of results by ParaView.

use crate::support::{BRICK, folder_with, run};
use serde_json::Value;
use std::path::Path;
use std::process::Command;

/// What `info` says of a file, for machines.
fn info(folder: &Path, file: &str) -> Value {
    let ended = run(folder, &["info", file, "--json"]);
    ended.says(0, &[]);
    serde_json::from_str(&ended.out).unwrap()
}

/// The ranges of a field.
fn ranges(info: &Value, name: &str) -> Vec<[f64; 2]> {
    let fields = info["fields"].as_array().unwrap();
    let field = fields.iter().find(|one| one["name"] == name).unwrap();
    let components = field["components"].as_array().unwrap();
    let range = |one: &Value| [0, 1].map(|k| one["range"][k].as_f64().unwrap());
    components.iter().map(range).collect()
}

#[test]
fn a_mesh_keeps_its_cells_and_groups_in_other_formats() {
    let folder = folder_with(BRICK);
    let at = folder.path();
    run(at, &["init", "patch-test", "."]).says(0, &[]);
    run(at, &["convert", "patch_test.inp", "again.inp"]).says(0, &["→ again.inp"]);
    let (first, again) = (info(at, "patch_test.inp"), info(at, "again.inp"));
    for member in ["nodes", "cells", "bounds"] {
        assert_eq!(first["mesh"][member], again["mesh"][member], "{member}");
    }
    let groups = |info: &Value| info["mesh"]["groups"].as_array().unwrap().clone();
    for group in groups(&first) {
        assert!(groups(&again).contains(&group), "{group}");
    }
    // the case is solved on the mesh that was written
    std::fs::rename(at.join("again.inp"), at.join("patch_test.inp")).unwrap();
    run(at, &["run", "patch_test.toml", "-q"]).says(0, &["✓ solved"]);
    let left = run(at, &["convert", "patch_test.inp", "mesh.vtu"]);
    left.says(0, &["sets of nodes or faces are left out"]);
    let grid = info(at, "mesh.vtu");
    assert_eq!(grid["mesh"]["nodes"], first["mesh"]["nodes"]);
    let names: Vec<Value> = groups(&grid).iter().map(|g| g["name"].clone()).collect();
    assert!(
        names.contains(&"LOWER_1".into()) || names.contains(&"lower_1".into()),
        "{names:?}"
    );
}

#[test]
fn results_go_to_calculix_and_back() {
    let folder = folder_with(BRICK);
    let at = folder.path();
    run(at, &["run", "case.toml", "-q"]).says(0, &[]);
    run(at, &["convert", "case.out", "job.frd"]).says(0, &["→ job.frd"]);
    run(at, &["info", "job.frd"]).says(0, &["results at time 1", "DISP (12 nodes", "SXX"]);
    run(at, &["convert", "job.frd", "back.pvd"]).says(0, &[]);
    run(at, &["convert", "job.frd", "last.vtu"]).says(0, &[]);
    let wanted = info(at, "case.out/frames/volume_0004.vtu");
    for file in ["back_0003.vtu", "last.vtu"] {
        let found = info(at, file);
        for name in ["displacement", "stress"] {
            for (a, b) in ranges(&wanted, name).iter().zip(ranges(&found, name)) {
                for (a, b) in a.iter().zip(b) {
                    assert!(
                        (a - b).abs() <= 1e-5 * a.abs() + 1e-12,
                        "{file} {name} {a} {b}"
                    );
                }
            }
        }
    }
    assert!(at.join("back.pvd").exists());
}

#[test]
fn what_cannot_be_converted_is_refused() {
    let folder = folder_with(BRICK);
    let at = folder.path();
    run(at, &["convert", "case.toml", "case.msh"]).says(2, &["convert writes"]);
    run(at, &["convert", "nothing.msh", "mesh.vtu"]).says(3, &["nothing.msh"]);
    run(at, &["convert", ".", "job.frd"]).says(3, &["results.pvd"]);
    std::fs::write(at.join("bad.frd"), "nothing").unwrap();
    run(at, &["convert", "bad.frd", "x.pvd"]).says(3, &["bad.frd"]);
}

#[test]
fn paraview_draws_the_results_by_the_script_next_to_them() {
    let folder = folder_with(BRICK);
    run(folder.path(), &["run", "case.toml", "-q"]).says(0, &[]);
    let results = folder.path().join("case.out");
    let script = results.join("view.py");
    assert!(script.exists());
    let by = |program: &str| {
        let mut found = Command::new("sh");
        found.args(["-c", &format!("command -v {program}")]);
        found.output().is_ok_and(|out| out.status.success())
    };
    if !(by("pvpython") && by("xvfb-run")) {
        println!("skipped: pvpython and xvfb-run are not installed");
        return;
    }
    let draw = || {
        let mut command = Command::new("xvfb-run");
        command.args(["-a", "pvpython", script.to_str().unwrap()]);
        command.output().unwrap()
    };
    // on a busy machine the X server may not be ready in time
    let mut tries = (0..3).map(|_| draw());
    let drawn = tries.find(|drawn| drawn.status.success());
    let drawn = drawn.expect("ParaView failed three times");
    let said = String::from_utf8_lossy(&drawn.stdout);
    assert!(said.contains("view.png: "), "{said}");
    assert!(
        said.contains("contact.png: contact_pressure, 0 to "),
        "{said}"
    );
    for name in ["view.png", "contact.png", "results.pvsm"] {
        let size = std::fs::metadata(results.join(name)).unwrap().len();
        assert!(size > 1000, "{name}: {size} bytes");
    }
}
