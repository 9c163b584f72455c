//! Contact that conducts and rubs.

use super::*;

const METHODS: [&str; 3] = ["node-to-segment", "gauss-point", "mortar"];

/// Two bars in line, of k = 10 and 5, with ends at 100 and 0, and 20 across what they touch with.
fn bars(
    ndim: usize,
    kind: &str,
    method: &str,
    swapped: bool,
    cells: [usize; 2],
) -> (Boxes, String) {
    let mut boxes = Boxes::new(ndim);
    boxes.add("hot", [0.0; 3], [1.0; 3], [3, cells[0], cells[0]]);
    boxes.add(
        "cold",
        [1.0, 0.0, 0.0],
        [2.0, 1.0, 1.0],
        [2, cells[1], cells[1]],
    );
    let sides = match swapped {
        false => ["hot_right", "cold_left"],
        true => ["cold_left", "hot_right"],
    };
    // without strain across, pressing changes nothing but that they touch
    let press = match kind {
        "coupled" if ndim == 3 => {
            "move = [{ on = \"cold_right\", ux = -1e-3, uy = 0.0, uz = 0.0 }]\n"
        }
        "coupled" => "move = [{ on = \"cold_right\", ux = -1e-3, uy = 0.0 }]\n",
        _ => "",
    };
    let law =
        |k: f64| format!("model = \"linear-elastic\"\nE = 1000.0\nnu = 0.0\nconductivity = {k}");
    let rest = format!(
        "[material.a]\n{}\n[material.b]\n{}\n[[body]]\ngroup = \"hot\"\nmaterial = \"a\"\n\
         [[body]]\ngroup = \"cold\"\nmaterial = \"b\"\n\
         [[contact]]\nname = \"touch\"\nsecondary = \"{}\"\nprimary = \"{}\"\nmethod = \"{method}\"\n\
         enforcement = {{ penalty = 1e6 }}\nconductance = 20.0\n\
         [[step]]\nname = \"heat\"\nkind = \"{kind}\"\nincrements = 1\n\
         geometry = \"linear\"\nfix = [{{ on = \"hot_left\", u = \"all\" }}]\n{press}\
         temperature = [{{ on = \"hot_left\", value = 100.0 }}, {{ on = \"cold_right\", value = 0.0 }}]\n\
         [solver]\nnewton = {{ force_tol = 1e-12 }}\n",
        law(10.0),
        law(5.0),
        sides[0],
        sides[1]
    );
    let text = boxes.case(&rest);
    (boxes, text)
}

/// The largest distance of the faces that touch from what they are at, over the whole difference.
fn off(boxes: &Boxes, frame: &Frame) -> f64 {
    let sides = [("hot_right", 500.0 / 7.0), ("cold_left", 400.0 / 7.0)];
    let all = sides.iter().flat_map(|(side, expected)| {
        let values = at(frame, boxes, side).into_iter();
        values.map(move |t| (t - expected).abs() / 100.0)
    });
    all.fold(0.0, f64::max)
}

#[test]
fn uniform_flux_goes_through_contact_as_the_closed_form_says_and_exactly_by_mortar() {
    for ndim in [2, 3] {
        for kind in ["heat", "coupled"] {
            for method in METHODS {
                for swapped in [false, true] {
                    for (cells, matching) in [([2, 3], false), ([2, 2], true)] {
                        let (boxes, text) = bars(ndim, kind, method, swapped, cells);
                        let (run, _) = solved(&text);
                        let frame = run.frames.last().unwrap();
                        let most = match (method, matching) {
                            ("mortar", _) | (_, true) => 1e-12,
                            ("gauss-point", _) => 1e-2,
                            _ => 0.2,
                        };
                        let found = off(&boxes, frame);
                        let what = format!("{ndim} {kind} {method} {swapped} {cells:?}");
                        assert!(found < most, "{what}: {found:e}");
                        let [sum, size] = heat_in(frame);
                        assert!(sum.abs() < 1e-12 * size, "{what}: {sum:e} of {size}");
                    }
                }
            }
        }
    }
}

#[test]
fn a_pressure_sets_the_conductance() {
    // MOOSE, closed_gap_prescribed_pressure: harmonic means of conductivities and hardnesses
    let harmonic = |a: f64, b: f64| 2.0 * a * b / (a + b);
    let [k, hardness] = [harmonic(16.2, 210.0), harmonic(129.0, 15.0)];
    let (pressure, flux) = (100.0, 7_292.018_326_501_085);
    for method in METHODS {
        let mut boxes = Boxes::new(2);
        boxes.add("a", [0.0; 3], [1.0; 3], [2, 1, 1]);
        boxes.add("b", [1.0, 0.0, 0.0], [2.0, 1.0, 1.0], [2, 1, 1]);
        let slope = k / hardness;
        let rest = format!(
            "[material.a]\nmodel = \"linear-elastic\"\nE = 1e7\nnu = 0.0\nconductivity = 16.2\n\
             [material.b]\nmodel = \"linear-elastic\"\nE = 1e7\nnu = 0.0\nconductivity = 210.0\n\
             [[body]]\ngroup = \"a\"\nmaterial = \"a\"\n[[body]]\ngroup = \"b\"\nmaterial = \"b\"\n\
             [[contact]]\nname = \"touch\"\nsecondary = \"a_right\"\nprimary = \"b_left\"\nmethod = \"{method}\"\n\
             enforcement = {{ penalty = 1e9 }}\nconductance = {{ over_pressure = [[0.0, 0.0], [1e4, {:?}]] }}\n\
             [[step]]\nname = \"press\"\nkind = \"coupled\"\ngeometry = \"linear\"\nincrements = 2\n\
             fix = [{{ on = \"b_right\", u = \"all\" }}, {{ on = \"a_all\", u = [\"y\"] }}]\n\
             load = [{{ on = \"a_left\", pressure = {pressure:?} }}]\n\
             temperature = [{{ on = \"a_left\", value = 800.0 }}, {{ on = \"b_right\", value = 250.0 }}]\n\
             [solver]\nnewton = {{ force_tol = 1e-11 }}\n",
            slope * 1e4
        );
        let (run, _) = solved(&boxes.case(&rest));
        let frame = run.frames.last().unwrap();
        let [_, size] = heat_in(frame);
        assert!((0.5 * size / flux - 1.0).abs() < 1e-6, "{method}: {size}");
        for (side, expected) in [("a_right", 349.875_411_9), ("b_left", 284.723_896_8)] {
            for t in at(frame, &boxes, side) {
                assert!((t - expected).abs() < 1e-5, "{method}: {t} {expected}");
            }
        }
    }
}

#[test]
fn the_heat_of_friction_is_its_work_and_stays_in_the_bodies() {
    for ndim in [2, 3] {
        for method in METHODS {
            for (enforcement, loss) in [("penalty = 1e5", 1e-12), ("lagrange = {}", 1e-9)] {
                if method == "gauss-point" && loss > 1e-10 {
                    continue;
                }
                let mut boxes = Boxes::new(ndim);
                boxes.add("base", [0.0; 3], [3.0, 1.0, 1.0], [6, 1, 2]);
                boxes.add("block", [0.5, 1.0, 0.0], [1.5, 2.0, 1.0], [2, 1, 1]);
                let rest = format!(
                    "[material.m]\nmodel = \"linear-elastic\"\nE = 1e4\nnu = 0.0\nconductivity = 3.0\nspecific_heat = 2.0\ndensity = 0.5\n\
                     [[body]]\ngroup = \"base\"\nmaterial = \"m\"\n[[body]]\ngroup = \"block\"\nmaterial = \"m\"\n\
                     [[contact]]\nname = \"rub\"\nsecondary = \"block_bottom\"\nprimary = \"base_top\"\nmethod = \"{method}\"\n\
                     enforcement = {{ {enforcement} }}\nfriction = 0.2\nconductance = 5.0\n\
                     friction_heat = {{ fraction = 0.9, to_secondary = 0.3 }}\n\
                     [[step]]\nname = \"press\"\nincrements = 1\n\
                     fix = [{{ on = \"base_bottom\", u = \"all\" }}]\nmove = [{{ on = \"block_top\", ux = 0.0, uy = -1e-2{} }}]\n\
                     [[step]]\nname = \"rub\"\nkind = \"coupled\"\nthermal = \"transient\"\nduration = 0.5\nincrements = {{ fixed = 5 }}\n\
                     move = [{{ on = \"block_top\", ux = {{ table = [[0.0, 0.0], [0.5, 1.0]] }} }}]\n\
                     [solver]\nnewton = {{ force_tol = 1e-10 }}\n",
                    if ndim == 3 { ", uz = 0.0" } else { "" }
                );
                let (run, _) = solved(&boxes.case(&rest));
                let frame = run.frames.last().unwrap();
                let before = &run.frames[0];
                let work = frame.contacts[0].work_friction - before.contacts[0].work_friction;
                let heat = frame.heat.unwrap();
                let stored = heat.total.stored;
                let what = format!("{ndim} {method} {enforcement}");
                assert!(work > 1.0, "{what}: {work}");
                let off = (stored - 0.9 * work).abs() / stored;
                assert!(off < 1e-6 + loss, "{what}: {stored} {work} {off:e}");
                let freed = heat.total.friction;
                assert!((stored - freed).abs() < 1e-10 * freed, "{what}: {heat:?}");
            }
        }
    }
}

#[test]
fn gaps_conduct_by_gas_and_radiation() {
    for method in METHODS {
        for (keys, expected) in [
            ("gas = { k = 0.02, jump = 0.05 }", 0.02 / 0.15),
            ("over_gap = [[0.0, 3.0], [0.2, 1.0]]", 2.0),
            ("radiation = [0.5, 0.25]", 0.0),
        ] {
            let mut boxes = Boxes::new(2);
            boxes.add("a", [0.0; 3], [1.0; 3], [1, 1, 1]);
            boxes.add("b", [1.1, 0.0, 0.0], [2.1, 1.0, 1.0], [1, 1, 1]);
            let rest = format!(
                "[constants]\nstefan_boltzmann = 5.67e-8\nabsolute_zero = -273.15\n\
                 [material.m]\nconductivity = 10.0\n[[body]]\ngroup = [\"a\", \"b\"]\nmaterial = \"m\"\n\
                 [[contact]]\nname = \"touch\"\nsecondary = \"a_right\"\nprimary = \"b_left\"\nmethod = \"{method}\"\n\
                 reach = 0.5\nenforcement = {{ penalty = 1.0 }}\nconductance = {{ {keys} }}\n\
                 [[step]]\nname = \"heat\"\nkind = \"heat\"\nincrements = 1\n\
                 temperature = [{{ on = \"a_left\", value = 400.0 }}, {{ on = \"b_right\", value = 20.0 }}]\n\
                 [solver]\nnewton = {{ force_tol = 1e-12 }}\n"
            );
            let (run, _) = solved(&boxes.case(&rest));
            let frame = run.frames.last().unwrap();
            let [hot, cold] = ["a_right", "b_left"].map(|side| at(frame, &boxes, side)[0]);
            let flux = 10.0 * (400.0 - hot);
            let through = match expected {
                0.0 => {
                    let [a, b]: [f64; 2] = [hot, cold].map(|t| t + 273.15);
                    5.67e-8 / (2.0 + 4.0 - 1.0) * (a.powi(4) - b.powi(4))
                }
                h => h * (hot - cold),
            };
            assert!(
                (flux - through).abs() < 1e-9 * flux,
                "{method} {keys}: {flux} {through}"
            );
        }
    }
}
