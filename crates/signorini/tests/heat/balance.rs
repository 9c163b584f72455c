//! Where heat comes from and goes to: balances, their audit, and the files that have them.

use super::*;
use signorini::setup::build;
use signorini::{Finished, News, Reading, RunOptions, open_text};
use signorini_io::fs::{Fs, MemoryFs};
use signorini_mechanics::solve::Flow;
use std::path::PathBuf;
use std::sync::Arc;

/// A bar of k = 10 and length 1 with its left end at 100, and these keys of its right end.
fn bar(ndim: usize, capacity: &str, keys: &str, rest: &str) -> (Boxes, String) {
    let mut boxes = Boxes::new(ndim);
    boxes.add("bar", [0.0; 3], [1.0; 3], [3, 1, 1]);
    let text = boxes.case(&format!(
        "[constants]\nstefan_boltzmann = 5.669e-8\nabsolute_zero = -273.15\n\
         [material.m]\nconductivity = [[0.0, 10.0], [1e3, 10.0]]\nspecific_heat = 2.0\ndensity = 0.5\n\
         [[body]]\ngroup = \"bar\"\nmaterial = \"m\"\n{capacity}\
         [[step]]\nname = \"heat\"\nkind = \"heat\"\nincrements = {{ fixed = 4 }}\n{rest}\
         temperature = [{{ on = \"bar_left\", value = 100.0 }}]\n\
         load = [{{ {keys} }}]\n"
    ));
    (boxes, text)
}

/// Small residuals.
const FINE: &str = "[solver]\nnewton = { force_tol = 1e-11 }\n";

/// What is lost or made over the largest flow, in all increments.
#[track_caller]
fn lost(run: &Run) -> f64 {
    let heats = run.frames.iter().filter_map(|frame| frame.heat);
    let heats = heats.filter(|heat| heat.turnover > 0.0);
    heats.map(|heat| heat.imbalance().abs()).fold(0.0, f64::max)
}

#[test]
fn what_loads_bring_in_leaves_at_the_support() {
    for ndim in [2, 3] {
        for (keys, out) in [
            (
                "on = \"bar_right\", film = { h = 20.0, sink = 10.0 }",
                600.0,
            ),
            ("on = \"bar_right\", heat_flux = -200.0", 200.0),
            ("on = \"bar_right\", heat_power = 50.0", -50.0),
            ("on = \"bar\", heat_source = 30.0", -30.0),
        ] {
            let (_, text) = bar(ndim, "", keys, "");
            let (run, _) = solved(&text);
            let heat = run.frames.last().unwrap().heat.unwrap();
            let what = format!("{ndim} {keys}: {heat:?}");
            assert!((heat.rate.supports - out).abs() < 1e-8, "{what}");
            assert!((heat.rate.loads + out).abs() < 1e-8, "{what}");
            assert_eq!((heat.rate.stored, heat.total.stored), (0.0, 0.0));
            assert!((heat.turnover / out.abs() - 1.0).abs() < 1e-8, "{what}");
            assert!(lost(&run) < 1e-10, "{what}");
        }
    }
}

#[test]
fn what_comes_in_over_time_is_stored() {
    for ndim in [2, 3] {
        for capacity in ["", "capacity = \"lumped\"\n"] {
            for keys in [
                "on = \"bar_right\", film = { h = 20.0, sink = 10.0 }",
                "on = \"bar_right\", radiation = { emissivity = 0.9, sink = 500.0 }",
                "on = \"bar\", heat_source = 300.0",
            ] {
                let (_, text) = bar(ndim, capacity, keys, "thermal = \"transient\"\n");
                let (run, _) = solved(&(text + FINE));
                let off = lost(&run);
                assert!(off < 1e-10, "{ndim} {keys}: {off:e}");
                let mut sum = [0.0; 3];
                for frame in &run.frames {
                    let HeatBalance { rate, total, .. } = frame.heat.unwrap();
                    for (sum, rate) in sum.iter_mut().zip([rate.loads, rate.supports, rate.stored])
                    {
                        *sum += 0.25 * rate;
                    }
                    let totals = [total.loads, total.supports, total.stored];
                    for (sum, total) in sum.iter().zip(totals) {
                        assert!((sum - total).abs() < 1e-12 * sum.abs(), "{ndim} {keys}");
                    }
                }
                assert!(sum[2] > 1.0 && (sum[0] + sum[1] - sum[2]).abs() < 1e-9 * sum[2]);
            }
        }
    }
}

/// A block that rubs on a base, deformable or rigid, in the plane.
fn rubbing(base: &str, contact: &str) -> (Boxes, String) {
    rubbing_in(2, base, contact)
}

/// The same in the plane or in space.
pub fn rubbing_in(ndim: usize, base: &str, contact: &str) -> (Boxes, String) {
    let mut boxes = Boxes::new(ndim);
    boxes.add("base", [0.0; 3], [3.0, 1.0, 1.0], [6, 1, 2]);
    boxes.add("block", [0.5, 1.0, 0.0], [1.5, 2.0, 1.0], [2, 1, 1]);
    let across = if ndim == 3 { ", uz = 0.0" } else { "" };
    let fix = match base.contains("rigid") {
        true => "",
        false => "fix = [{ on = \"base_bottom\", u = \"all\" }]\n",
    };
    let text = boxes.case(&format!(
        "[material.m]\nmodel = \"linear-elastic\"\nE = 1e4\nnu = 0.0\nconductivity = 3.0\nspecific_heat = 2.0\ndensity = 0.5\n\
         [[body]]\ngroup = \"base\"\n{base}\n[[body]]\ngroup = \"block\"\nmaterial = \"m\"\n\
         [[contact]]\nname = \"rub\"\nsecondary = \"block_bottom\"\nprimary = \"base_top\"\n\
         friction = 0.2\nconductance = 5.0\n{contact}\n\
         [[step]]\nname = \"press\"\nincrements = 1\n{fix}\
         move = [{{ on = \"block_top\", ux = 0.0, uy = -1e-2{across} }}]\n\
         [[step]]\nname = \"rub\"\nkind = \"coupled\"\nthermal = \"transient\"\nduration = 0.5\nincrements = {{ fixed = 4 }}\n\
         move = [{{ on = \"block_top\", ux = {{ table = [[0.0, 0.0], [0.5, 0.8]] }} }}]\n"
    ));
    (boxes, text)
}

#[test]
fn the_heat_of_friction_goes_into_bodies_and_surfaces_and_is_counted_in_every_pass() {
    let penalty = "enforcement = { penalty = 1e5 }";
    for (base, contact) in [
        (
            "material = \"m\"",
            "method = \"mortar\"\nenforcement = { penalty = 1e5 }",
        ),
        (
            "material = \"m\"",
            "method = \"node-to-segment\"\nenforcement = { penalty = 1e5 }\npasses = 2",
        ),
        (
            "material = \"m\"",
            "method = \"gauss-point\"\nenforcement = { penalty = 1e5 }\npasses = 2",
        ),
        (
            "rigid = true",
            "method = \"gauss-point\"\nenforcement = { penalty = 1e5 }\ntemperature = 40.0",
        ),
    ] {
        assert!(contact.contains(penalty));
        let (_, text) = rubbing(base, contact);
        let (run, _) = solved(&(text + FINE));
        let what = format!("{base} {contact}");
        // nothing is found in the first step
        let first = run.frames[0].heat.unwrap_or_default();
        assert_eq!(first.turnover, 0.0, "{what}");
        let last = run.frames.last().unwrap();
        let heat = last.heat.unwrap();
        let work = last.contacts[0].work_friction - run.frames[0].contacts[0].work_friction;
        let total = heat.total;
        assert!(
            (total.friction / work - 1.0).abs() < 1e-6,
            "{what}: {total:?} {work}"
        );
        let off = lost(&run);
        assert!(off < 1e-10, "{what}: {off:e} {total:?}");
        let warmth = last.contacts[0].warmth.as_ref().unwrap();
        assert!(
            (warmth.rubbed / heat.rate.friction - 1.0).abs() < 1e-12,
            "{what}"
        );
        if base.contains("rigid") {
            // nodes of the rigid body are at 0, or the surface at the temperature of its contact
            let given = total.surfaces + total.supports;
            assert!(given.abs() > 1e-3 * work, "{what}: {total:?}");
        }
    }
}

#[test]
fn contacts_have_the_flux_and_the_conductance_of_the_closed_form() {
    for ndim in [2, 3] {
        for (method, passes) in [
            ("mortar", 1),
            ("gauss-point", 1),
            ("gauss-point", 2),
            ("node-to-segment", 1),
        ] {
            let mut boxes = Boxes::new(ndim);
            boxes.add("hot", [0.0; 3], [1.0; 3], [2, 2, 2]);
            boxes.add("cold", [1.0, 0.0, 0.0], [2.0, 1.0, 1.0], [2, 2, 2]);
            let text = boxes.case(&format!(
                "[material.a]\nconductivity = 10.0\n[material.b]\nconductivity = 5.0\n\
                 [[body]]\ngroup = \"hot\"\nmaterial = \"a\"\n[[body]]\ngroup = \"cold\"\nmaterial = \"b\"\n\
                 [[contact]]\nname = \"touch\"\nsecondary = \"hot_right\"\nprimary = \"cold_left\"\nmethod = \"{method}\"\n\
                 passes = {passes}\nenforcement = {{ penalty = 1e6 }}\nreach = 0.1\nconductance = {{ over_gap = [[0.0, 20.0], [0.1, 20.0]] }}\n\
                 [[step]]\nname = \"heat\"\nkind = \"heat\"\nincrements = 1\n\
                 temperature = [{{ on = \"hot_left\", value = 100.0 }}, {{ on = \"cold_right\", value = 0.0 }}]\n"
            ));
            let (run, _) = solved(&text);
            let frame = run.frames.last().unwrap();
            let warmth = frame.contacts[0].warmth.as_ref().unwrap();
            let what = format!("{ndim} {method} {passes}: {warmth:?}");
            let expected = 2000.0 / 7.0;
            assert!((warmth.through - expected).abs() < 1e-8, "{what}");
            for (flux, h) in warmth.flux.iter().zip(&warmth.conductance) {
                assert!((flux - expected).abs() < 1e-8, "{what}");
                assert!((h - 20.0).abs() < 1e-10, "{what}");
            }
            assert!(warmth.friction.iter().all(|of| *of == 0.0));
            assert!(lost(&run) < 1e-10, "{what}");
        }
    }
}

/// Runs a case to its end, with what these keys change, and the text of a file of its folder.
fn files(text: &str, strict: bool) -> (Finished, impl Fn(&str) -> String + use<>) {
    let fs: Arc<dyn Fs> = Arc::new(MemoryFs::default());
    let opened = open_text("case.toml".as_ref(), text.into(), &Reading::default());
    let opened = opened.unwrap_or_else(|found| panic!("{}", found.plain()));
    let loaded = opened.with_mesh().unwrap();
    let mut options = RunOptions::new(loaded.source);
    (options.fs, options.strict) = (Arc::clone(&fs), strict);
    let folder: PathBuf = options.folder.clone();
    let mut model = build(loaded.case, loaded.mesh).unwrap_or_else(|e| panic!("{}", e.plain()));
    let finished = signorini::run(&mut model, &options, &mut |_: &News<'_>| Flow::Continue);
    let text = move |name: &str| {
        let bytes = fs.read(&folder.join(name)).unwrap();
        String::from_utf8_lossy(&bytes).into_owned()
    };
    (finished, text)
}

#[test]
fn histories_summaries_fields_and_expectations_have_heat_where_it_is_found_alone() {
    let (_, text) = rubbing(
        "material = \"m\"",
        "method = \"mortar\"\nenforcement = { penalty = 1e5 }",
    );
    let asks = "[[output.history]]\nname = \"ask\"\ncontact = \"rub\"\nquantity = [\"heat\", \"heat_friction\"]\n\
                [[output.history]]\nname = \"top\"\nset = \"block_top\"\nquantity = [\"reaction_heat\", \"heat_flux.y\"]\n\
                [[output.history]]\nname = \"face\"\nset = \"block_bottom\"\nquantity = [\"contact_heat_flux\", \"contact_conductance\", \"contact_friction_heat\"]\n\
                [[expect]]\nwhat = \"heat.supports\"\nvalue = 0.0\ntol = { abs = 1e-12 }\n\
                [[expect]]\nwhat = \"heat.imbalance\"\nvalue = 0.0\ntol = { abs = 1e-6 }\n\
                [[expect]]\nwhat = \"contact_conductance @ set block_bottom\"\nvalue = 5.0\ntol = { rel = 1e-9 }\n\
                [[expect]]\nwhat = \"reaction_heat @ set block_top\"\nvalue = 0.0\ntol = { abs = 1e-12 }\n";
    let (finished, file) = files(&format!("{text}{asks}"), true);
    assert_eq!(finished.exit_code, 0, "{}", finished.diagnostics.plain());
    let history = file("history.csv");
    let head: Vec<&str> = history.lines().next().unwrap().split(',').collect();
    let last: Vec<&str> = history.lines().last().unwrap().split(',').collect();
    let value = |name: &str| -> f64 {
        let at = head.iter().position(|column| *column == name);
        last[at.unwrap_or_else(|| panic!("no {name} in {head:?}"))]
            .parse()
            .unwrap()
    };
    assert!(value("heat.stored") > 1.0);
    assert_eq!(value("rub.heat"), value("ask.heat"));
    assert!((value("heat_rate.friction") / value("ask.heat_friction") - 1.0).abs() < 1e-12);
    // the mean of the nodes of a facet of length 1
    assert!(value("face.contact_friction_heat") > 0.0);
    let summary = finished.summary;
    assert_eq!(summary.heat.unwrap().total.stored, value("heat.stored"));
    assert_eq!(summary.contacts["rub"].heat, Some(value("rub.heat")));
    assert!(summary.audit.heat.unwrap().passed);
    for (name, field) in [
        ("frames/contact_0002.vtu", "contact_heat_flux"),
        ("frames/volume_0002.vtu", "reaction_heat"),
        ("frames/volume_0002.vtu", "heat_flux"),
    ] {
        assert!(file(name).contains(&format!("Name=\"{field}\"")), "{name}");
    }
    // without steps that find temperatures there is none of it
    let cold = text.replace("kind = \"coupled\"\nthermal = \"transient\"\n", "");
    let (finished, file) = files(&cold, true);
    assert_eq!(finished.exit_code, 0, "{}", finished.diagnostics.plain());
    for name in ["history.csv", "summary.json"] {
        assert!(!file(name).contains("heat"), "{}", file(name));
    }
}

#[test]
fn states_that_are_not_in_balance_are_doubted() {
    let keys = "on = \"bar_right\", radiation = { emissivity = 0.9, sink = 500.0 }";
    let (_, text) = bar(2, "", keys, "thermal = \"transient\"\n");
    let coarse = text + "[solver]\nnewton = { force_tol = 0.3 }\n";
    let (finished, file) = files(&coarse, true);
    assert_eq!(finished.exit_code, 1, "{}", finished.diagnostics.plain());
    let said = finished.diagnostics.plain();
    assert!(
        said.contains("[S0437]") && said.contains("heat is lost or made"),
        "{said}"
    );
    assert!(file("summary.json").contains("\"status\": \"audit failed\""));
    let audit = finished.summary.audit;
    assert!(!audit.passed && audit.heat.unwrap().part > 1e-8);
    let (finished, _) = files(&format!("allow = [\"S0437\"]\n{coarse}"), true);
    assert_eq!(finished.exit_code, 0);
}
