//! Heat that bodies store, and what flows through their surfaces.

use super::*;
use signorini::{News, Reading, RunOptions, build, open_text};
use signorini_io::fs::{Fs, MemoryFs};
use signorini_mechanics::solve::Flow;
use std::sync::Arc;

/// A slab of length 1, κ = k = 1, at 0; its left end is at 1 from the start on, its right end insulated.
fn slab(ndim: usize, increments: usize, capacity: &str) -> (Boxes, String) {
    let mut boxes = Boxes::new(ndim);
    boxes.add("slab", [0.0; 3], [1.0, 0.1, 0.1], [40, 1, 1]);
    let rest = format!(
        "[material.m]\nconductivity = 1.0\nspecific_heat = 0.5\ndensity = 2.0\n\
         [[body]]\ngroup = \"slab\"\nmaterial = \"m\"\ncapacity = \"{capacity}\"\n\
         [[step]]\nname = \"heat\"\nkind = \"heat\"\nthermal = \"transient\"\nduration = 0.1\nincrements = {{ fixed = {increments} }}\n\
         temperature = [{{ on = \"slab_left\", value = 1.0 }}]\n"
    );
    let text = boxes.case(&rest);
    (boxes, text)
}

#[test]
fn a_slab_warms_as_the_series_says_to_first_order_in_time() {
    // at t = 0.1
    let exact = [
        (0.25, 0.576_240_746_1),
        (0.5, 0.264_348_684_8),
        (1.0, 0.050_694_637_3),
    ];
    for ndim in [2, 3] {
        for capacity in ["consistent", "lumped"] {
            let errors = [20, 40].map(|increments| {
                let (_, text) = slab(ndim, increments, capacity);
                let (run, places) = solved(&text);
                let frame = run.frames.last().unwrap();
                let off = exact.iter().map(|(x, expected)| {
                    let node = places.iter().position(|at| (at[0] - x).abs() < 1e-9);
                    (frame.temperature[node.unwrap()] - expected).abs()
                });
                off.fold(0.0, f64::max)
            });
            assert!(errors[0] < 7.5e-3, "{ndim} {capacity} {errors:?}");
            let order = (errors[0] / errors[1]).log2();
            assert!((order - 1.0).abs() < 0.2, "{ndim} {capacity} {errors:?}");
        }
    }
}

#[test]
fn what_is_stored_came_in_at_the_support() {
    let (_, text) = slab(2, 10, "consistent");
    let (run, _) = solved(&text);
    let mut came = 0.0;
    for frame in &run.frames {
        came += heat_in(frame)[0] * 0.01;
        assert!((frame.heat.unwrap().total.stored - came).abs() < 1e-12 * came.abs().max(1e-3));
    }
    assert!(came > 0.03);
}

#[test]
fn histories_have_what_is_stored_and_what_supports_bring_in() {
    let (_, text) = slab(2, 5, "consistent");
    let columns =
        "{ name = \"end\", set = \"slab_left\", quantity = [\"reaction_heat\", \"heat_flux.x\"] }";
    let expected = "[[expect]]\nwhat = \"heat.stored\"\nvalue = 0.0357\ntol = { rel = 0.03 }\n";
    let text = format!("{text}[output]\nhistory = [{columns}]\n{expected}");
    let fs: Arc<dyn Fs> = Arc::new(MemoryFs::default());
    let opened = open_text("case.toml".as_ref(), text.into(), &Reading::default()).unwrap();
    let loaded = opened.with_mesh().unwrap();
    let mut options = RunOptions::new(loaded.source);
    options.fs = Arc::clone(&fs);
    let mut model = build(loaded.case, loaded.mesh).unwrap();
    let done = signorini::run(&mut model, &options, &mut |_: &News<'_>| Flow::Continue);
    let said = done.diagnostics.plain();
    let table = String::from_utf8(fs.read(&options.folder.join("history.csv")).unwrap()).unwrap();
    assert_eq!(done.exit_code, 0, "{said}\n{table}");
    let mut lines = table
        .lines()
        .map(|line| line.split(',').collect::<Vec<_>>());
    let names = lines.next().unwrap();
    let at = ["heat.stored", "end.reaction_heat", "end.heat_flux.x"]
        .map(|name| names.iter().position(|other| *other == name).unwrap());
    let mut came = 0.0;
    for line in lines {
        let [stored, heat, flux] = at.map(|at| line[at].parse::<f64>().unwrap());
        came += heat * 0.02;
        assert!((stored - came).abs() < 1e-9 * came, "{stored} {came}");
        assert!(flux > 0.0);
    }
}

#[test]
fn what_is_stored_goes_with_temperatures_in_steps_of_all_kinds() {
    let mut boxes = Boxes::new(2);
    boxes.add("bar", [0.0; 3], [2.0, 1.0, 1.0], [4, 1, 1]);
    let rest = "[material.m]\nmodel = \"linear-elastic\"\nE = 1.0\nnu = 0.0\nexpansion = { alpha = 1e-3 }\nconductivity = 1.0\n\
         specific_heat = 3.0\ndensity = 0.5\n[[body]]\ngroup = \"bar\"\nmaterial = \"m\"\n\
         [[step]]\nname = \"given\"\ngeometry = \"linear\"\nincrements = 2\nfix = [{ on = \"bar_left\", u = \"all\" }]\n\
         temperature = [{ on = \"all\", value = 5.0 }]\n\
         [[step]]\nname = \"steady\"\nkind = \"coupled\"\nincrements = 2\nfree = [{ on = \"bar\", temperature = true }]\n\
         temperature = [{ on = \"bar_left\", value = 20.0 }, { on = \"bar_right\", value = 40.0 }]\n\
         [[step]]\nname = \"cool\"\nkind = \"heat\"\nthermal = \"transient\"\nincrements = 1\ntemperature = [{ on = \"all\", value = 0.0 }]\n";
    let (run, _) = solved(&boxes.case(rest));
    // a heat of 3 per temperature
    for (frame, mean) in [(1, 5.0), (3, 30.0), (4, 0.0)] {
        let off = run.frames[frame].heat_stored - 3.0 * mean;
        assert!(off.abs() < 1e-9, "{frame}: {off:e}");
    }
}

#[test]
fn phases_that_change_take_their_latent_heat_whatever_the_increments() {
    // an insulated body that a source warms through its melting
    let mut boxes = Boxes::new(2);
    boxes.add("ice", [0.0; 3], [1.0; 3], [2, 1, 1]);
    for increments in [1, 7] {
        let rest = format!(
            "[initial]\ntemperature = -10.0\n\
             [material.m]\nconductivity = 1.0\nspecific_heat = [[-20.0, 2.0], [0.0, 2.0], [1.0, 4.0]]\ndensity = 1.5\n\
             latent_heat = [[30.0, 0.0, 1.0]]\n\
             [[body]]\ngroup = \"ice\"\nmaterial = \"m\"\n\
             [[step]]\nname = \"melt\"\nkind = \"heat\"\nthermal = \"transient\"\nincrements = {{ fixed = {increments} }}\n\
             load = [{{ on = \"ice\", heat_source = 120.0 }}]\n\
             [solver]\nnewton = {{ force_tol = 1e-11, max_iterations = 60 }}\n"
        );
        let (run, _) = solved(&boxes.case(&rest));
        let frame = run.frames.last().unwrap();
        // 1.5 (20 + 3 + 30 + 4 (T − 1)) = 120
        let expected = 1.0 + (120.0 / 1.5 - 53.0) / 4.0;
        for t in at(frame, &boxes, "ice_all") {
            assert!((t - expected).abs() < 1e-6, "{increments}: {t} {expected}");
        }
        assert!((frame.heat.unwrap().total.stored - 120.0).abs() < 1e-9 * 120.0);
    }
}

#[test]
fn surfaces_radiate_and_convect_as_the_closed_forms_say() {
    // a bar whose end radiates; `radiating_bar.json`, and CalculiX' cube, `radiating_cube_ccx.json`
    for ndim in [2, 3] {
        for (k, far, keys, expected) in [
            (
                1.0,
                1000.0,
                "radiation = { emissivity = 0.9, sink = 0.0 }",
                115.841_702_3,
            ),
            (
                50.0,
                0.0,
                "radiation = { emissivity = 1.0, sink = -12.0 }",
                -0.950_738_6,
            ),
            (10.0, 100.0, "film = { h = 20.0, sink = 10.0 }", 40.0),
            (10.0, 100.0, "heat_flux = -200.0", 80.0),
            (10.0, 100.0, "heat_power = 50.0", 105.0),
        ] {
            let mut boxes = Boxes::new(ndim);
            boxes.add("bar", [0.0; 3], [1.0; 3], [2, 1, 1]);
            let rest = format!(
                "[constants]\nstefan_boltzmann = 5.669e-8\nabsolute_zero = -273.15\n\
                 [material.m]\nconductivity = {k:?}\n[[body]]\ngroup = \"bar\"\nmaterial = \"m\"\n\
                 [[step]]\nname = \"heat\"\nkind = \"heat\"\nincrements = 1\n\
                 temperature = [{{ on = \"bar_left\", value = {far:?} }}]\n\
                 load = [{{ on = \"bar_right\", {keys} }}]\n\
                 [solver]\nnewton = {{ force_tol = 1e-10 }}\n"
            );
            let (run, _) = solved(&boxes.case(&rest));
            for t in at(run.frames.last().unwrap(), &boxes, "bar_right") {
                assert!((t - expected).abs() < 1e-6, "{ndim} {keys}: {t}");
            }
        }
    }
}

/// Two bars in line, the short one hot, with a conductance that jumps where they touch.
fn jumping(ndim: usize, method: &str, increments: usize) -> String {
    let mut boxes = Boxes::new(ndim);
    boxes.add("cold", [0.0; 3], [1.0; 3], [2, 1, 1]);
    boxes.add("hot", [1.009, 0.4, 0.4], [1.209, 0.6, 0.6], [1, 1, 1]);
    boxes.case(&format!(
        "[material.m]\nmodel = \"linear-elastic\"\nE = 2e5\nnu = 0.0\nexpansion = {{ alpha = 6e-5, reference = 0.0 }}\n\
         conductivity = 1.0\nspecific_heat = 1e-4\ndensity = 1.0\n\
         [material.rigid]\nmodel = \"linear-elastic\"\nE = 2e5\nnu = 0.0\n\
         conductivity = 1.0\nspecific_heat = 1e-4\ndensity = 1.0\n[initial]\ntemperature = 0.0\n\
         [[body]]\ngroup = \"cold\"\nmaterial = \"rigid\"\n[[body]]\ngroup = \"hot\"\nmaterial = \"m\"\n\
         [[contact]]\nname = \"gap\"\nsecondary = \"hot_left\"\nprimary = \"cold_right\"\nmethod = \"{method}\"\n\
         enforcement = {{ penalty = 1e7 }}\nconductance = 100.0\n\
         [[step]]\nname = \"heat\"\nkind = \"coupled\"\nthermal = \"transient\"\ngeometry = \"linear\"\nduration = 1e-4\n\
         increments = {{ fixed = {increments} }}\n\
         fix = [{{ on = \"cold_left\", u = [\"x\"] }}, {{ on = \"hot_right\", u = [\"x\"] }},\n\
         {{ on = \"cold_all\", u = [\"y\"] }}, {{ on = \"hot_all\", u = [\"y\"] }}{}]\n\
         temperature = [{{ on = \"hot_right\", value = 1000.0 }}, {{ on = \"cold_left\", value = 0.0 }}]\n\
         [solver]\non_trouble = [\"cut\", \"stabilize\", \"points\"]\n",
        match ndim {
            3 => ", { on = \"cold_all\", u = [\"z\"] }, { on = \"hot_all\", u = [\"z\"] }",
            _ => "",
        }
    ))
}

#[test]
fn no_trouble_makes_bodies_store_less_than_they_take_in() {
    // such a gap may close and open for ever; where that ends the run, nothing before may have been taken for solved that is not
    let mut nframe = 0;
    for (ndim, method) in [
        (2, "node-to-segment"),
        (2, "gauss-point"),
        (2, "mortar"),
        (3, "node-to-segment"),
    ] {
        for increments in [10, 40] {
            let mut model = common::model("heat", &jumping(ndim, method, increments), &[]);
            let run = common::run(&mut model);
            let (mut came, mut time) = (0.0, 0.0);
            for frame in &run.frames {
                came += heat_in(frame)[0] * (frame.time - time);
                time = frame.time;
                let off = (frame.heat_stored - came).abs();
                let what = format!("{ndim} {method} {increments}: {off:e} of {came:e} at {time:e}");
                assert!(off < 1e-6 * came, "{what}");
                nframe += 1;
            }
        }
    }
    assert!(nframe > 0);
}

/// What building a case finds, and the lowest temperature of its run.
fn found_and_lowest(text: &str) -> (String, f64) {
    let found = common::model("heat", text, &[]).warnings.plain();
    let (run, _) = solved(text);
    let frames = run.frames.iter();
    let all = frames.flat_map(|frame| frame.temperature.iter().copied());
    (found, all.fold(0.0, f64::min))
}

#[test]
fn increments_in_which_temperatures_overshoot_are_warned_of_and_no_others() {
    // an edge of 1/40, and κ = 1: 1.04e-4 is the least
    for ndim in [2, 3] {
        for (increments, capacity, overshoots) in [
            (20, "consistent", true),
            (11, "consistent", true),
            (9, "consistent", false),
            (20, "lumped", false),
        ] {
            let (_, text) = slab(ndim, increments, capacity);
            let text = text.replace("duration = 0.1", "duration = 1e-3");
            let (found, lowest) = found_and_lowest(&text);
            let what = format!("{ndim} {increments} {capacity}: {lowest:e} {found}");
            assert_eq!(found.contains("[S0438]"), overshoots, "{what}");
            assert_eq!(lowest < -1e-9, overshoots, "{what}");
            if overshoots {
                for says in ["body \"slab\"", "1.04e-4", "capacity = \"lumped\"", "0.025"] {
                    assert!(found.contains(says), "{says}: {what}");
                }
            }
        }
    }
}

#[test]
fn heat_that_goes_a_thousandth_of_an_element_far_hints_at_units() {
    for (density, odd) in [("2.0", false), ("2e9", true), ("2e-11", true)] {
        let (_, text) = slab(2, 20, "lumped");
        let text = text.replace("density = 2.0", &format!("density = {density}"));
        let found = common::model("heat", &text, &[]).warnings.plain();
        assert_eq!(found.contains("note[S0439]"), odd, "{density}: {found}");
    }
}
