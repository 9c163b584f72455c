//! A rod that closes a gap as it warms, of which staggered solutions do not converge.

use super::*;
use crate::common::reference;

fn rod(method: &str, enforcement: &str, [gap, h, n]: [f64; 3]) -> (Boxes, String) {
    let mut boxes = Boxes::new(2);
    boxes.add("rod", [0.0; 3], [1.0; 3], [1, 1, 1]);
    boxes.add("wall", [1.0 + gap, -0.5, 0.0], [2.0, 1.5, 1.0], [1, 1, 1]);
    let conductance = match n {
        1.0 => format!("over_pressure = [[0.0, 0.0], [1e6, {:?}]]", h * 1e6),
        n => format!("power = {{ h0 = {h:?}, hardness = 1.0, n = {n:?} }}"),
    };
    let rest = format!(
        "[material.m]\nmodel = \"linear-elastic\"\nE = 1000.0\nnu = 0.0\nexpansion = {{ alpha = 1e-3 }}\nconductivity = 10.0\n\
         [[body]]\ngroup = \"rod\"\nmaterial = \"m\"\n[[body]]\ngroup = \"wall\"\nrigid = true\n\
         [[contact]]\nname = \"c\"\nsecondary = \"rod_right\"\nprimary = \"wall_left\"\nmethod = \"{method}\"\n\
         enforcement = {{ {enforcement} }}\nreach = 0.5\nconductance = {{ {conductance} }}\n\
         [[step]]\nname = \"heat\"\nkind = \"coupled\"\ngeometry = \"linear\"\nincrements = {{ fixed = 1 }}\n\
         fix = [{{ on = \"rod_left\", u = [\"x\"] }}, {{ on = \"rod_all\", u = [\"y\"] }}]\n\
         temperature = [{{ on = \"rod_left\", value = 100.0 }}, {{ on = \"wall_all\", value = 0.0 }}]\n\
         [solver]\nnewton = {{ force_tol = 1e-10 }}\n"
    );
    let text = boxes.case(&rest);
    (boxes, text)
}

#[test]
fn rods_have_the_temperature_and_pressure_of_the_closed_form_in_a_few_iterations() {
    let Some(all) = reference("thermal/closing_rod.json") else {
        return;
    };
    for row in all["rows"].as_array().unwrap() {
        let value = |key: &str| row[key].as_f64().unwrap();
        let data = ["g0", "hc", "n"].map(value);
        for method in ["node-to-segment", "mortar"] {
            let (boxes, text) = rod(method, "lagrange = {}", data);
            let (run, _) = solved(&text);
            let frame = run.frames.last().unwrap();
            let what = format!("{method} {data:?}");
            for t in at(frame, &boxes, "rod_right") {
                assert!((t - value("T1")).abs() < 1e-8, "{what}: {t}");
            }
            let pressure = frame.contacts[0].pressure_max;
            assert!(
                (pressure / value("p") - 1.0).abs() < 1e-8,
                "{what}: {pressure}"
            );
            let most = if data[2] == 1.0 { 9 } else { 12 };
            let found = run.increments[0].iterations;
            assert!(found <= most, "{what}: {found} iterations");
        }
        // the exact one with the compliance of a penalty: p (1/E + 1/ε) is the overlap
        let (boxes, text) = rod("gauss-point", "penalty = 1e6", data);
        let (run, _) = solved(&text);
        let frame = run.frames.last().unwrap();
        let hot = at(frame, &boxes, "rod_right")[0];
        let pressure = frame.contacts[0].pressure_max;
        let [gap, h, n] = data;
        let overlap = 0.5e-3 * (100.0 + hot) - gap;
        assert!((pressure * (1e-3 + 1e-6) / overlap - 1.0).abs() < 1e-8);
        let flux = 10.0 * (100.0 - hot);
        assert!((h * pressure.powf(n) * hot / flux - 1.0).abs() < 1e-7);
    }
}

#[test]
fn a_rod_that_a_warm_wall_holds_stays_closed_or_open_by_where_it_comes_from() {
    // `closing_rod_multiple.json`: three states, of which the middle one is unstable
    let mut boxes = Boxes::new(2);
    boxes.add("rod", [0.0; 3], [1.0; 3], [1, 1, 1]);
    boxes.add("wall", [1.02, -0.5, 0.0], [2.0, 1.5, 1.0], [1, 1, 1]);
    let state = |first: f64| {
        let text = boxes.case(&format!(
            "[material.m]\nmodel = \"linear-elastic\"\nE = 1000.0\nnu = 0.0\nexpansion = {{ alpha = 1e-3 }}\nconductivity = 10.0\n\
             [[body]]\ngroup = \"rod\"\nmaterial = \"m\"\n[[body]]\ngroup = \"wall\"\nrigid = true\n\
             [[contact]]\nname = \"c\"\nsecondary = \"rod_right\"\nprimary = \"wall_left\"\nmethod = \"node-to-segment\"\n\
             enforcement = {{ lagrange = {{}} }}\nreach = 0.5\n\
             conductance = {{ over_gap = [[0.0, 1.0], [0.5, 1.0]], over_pressure = [[0.0, 0.0], [1e6, 1e6]] }}\n\
             [[step]]\nname = \"first\"\nkind = \"coupled\"\ngeometry = \"linear\"\nincrements = {{ fixed = 4 }}\n\
             fix = [{{ on = \"rod_left\", u = [\"x\"] }}, {{ on = \"rod_all\", u = [\"y\"] }}]\n\
             temperature = [{{ on = \"rod_left\", value = {first:?} }}, {{ on = \"wall_all\", value = 120.0 }}]\n\
             [[step]]\nname = \"then\"\nkind = \"coupled\"\ngeometry = \"linear\"\nincrements = {{ fixed = 8 }}\n\
             temperature = [{{ on = \"rod_left\", value = 0.0 }}]\n\
             [solver]\nnewton = {{ force_tol = 1e-10 }}\n"
        ));
        let (run, _) = solved(&text);
        at(run.frames.last().unwrap(), &boxes, "rod_right")[0]
    };
    for (first, expected) in [(0.0, 10.909_090_9), (100.0, 83.177_447)] {
        let found = state(first);
        assert!((found - expected).abs() < 1e-5, "{first}: {found}");
    }
}
