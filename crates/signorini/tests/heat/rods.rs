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

/// A rod of 20 elements that touches a warm wall and leaves its equilibrium, in increments of 0.01: the temperature of its end.
fn leaving(method: &str, enforcement: &str, delta: f64, increments: usize) -> Vec<f64> {
    let (hot, alpha, modulus, k) = (100.0, 1e-3, 1000.0, 10.0);
    // 4 δ = T₁ E α/p, and p = E (α T₁/2 − g); h = k where the pressure is p
    let pressure = hot * modulus * alpha / (4.0 * delta);
    let gap = 0.5 * alpha * hot - pressure / modulus;
    let mut boxes = Boxes::new(2);
    boxes.add("rod", [0.0; 3], [1.0; 3], [20, 1, 1]);
    boxes.add("wall", [1.0 + gap, -0.5, 0.0], [2.0, 1.5, 1.0], [1, 1, 1]);
    let text = boxes.case(&format!(
        "[material.m]\nmodel = \"linear-elastic\"\nE = {modulus:?}\nnu = 0.0\nexpansion = {{ alpha = {alpha:?} }}\n\
         conductivity = {k:?}\nspecific_heat = 10.0\ndensity = 1.0\n\
         [[body]]\ngroup = \"rod\"\nmaterial = \"m\"\n[[body]]\ngroup = \"wall\"\nrigid = true\n\
         [[contact]]\nname = \"c\"\nsecondary = \"rod_right\"\nprimary = \"wall_left\"\nmethod = \"{method}\"\n\
         enforcement = {{ {enforcement} }}\nreach = 0.5\nconductance = {{ over_pressure = [[0.0, 0.0], [1e6, {:?}]] }}\n\
         [[step]]\nname = \"hold\"\nkind = \"coupled\"\ngeometry = \"linear\"\nincrements = {{ fixed = 1 }}\n\
         fix = [{{ on = \"rod_left\", u = [\"x\"] }}, {{ on = \"rod_all\", u = [\"y\"] }}]\n\
         temperature = [{{ on = \"rod_left\", value = 0.0 }}, {{ on = \"rod_right\", value = {hot:?} }}, \
         {{ on = \"wall_all\", value = {:?} }}]\n\
         [[step]]\nname = \"leave\"\nkind = \"coupled\"\nthermal = \"transient\"\nincrements = {{ fixed = {increments} }}\n\
         duration = {:?}\nfree = [{{ on = \"rod_right\", temperature = true }}]\n\
         temperature = [{{ on = \"wall_all\", value = {:?} }}]\n\
         [solver]\nnewton = {{ force_tol = 1e-12 }}\n",
        1e6 * k / pressure,
        2.0 * hot,
        increments as f64 * 0.01,
        2.0 * hot * (1.0 + 1e-5),
    ));
    let (run, _) = solved(&text);
    let end = |frame: &Frame| at(frame, &boxes, "rod_right")[0];
    run.frames.iter().map(end).collect()
}

/// `barber_growth.json`, to 1 %. Backward Euler grows by 1/(1 − b Δt) in an increment, from which b is taken.
#[test]
#[cfg_attr(debug_assertions, ignore = "takes its time without optimization")]
fn a_rod_leaves_or_returns_at_the_rate_of_barber() {
    let Some(all) = reference("thermal/barber_growth.json") else {
        return;
    };
    for (delta, rate) in all["growth"].as_object().unwrap() {
        let rate = rate.as_f64().unwrap();
        for (method, enforcement) in [
            ("node-to-segment", "lagrange = {}"),
            ("mortar", "lagrange = {}"),
            ("gauss-point", "penalty = 1e8"),
        ] {
            let hot = leaving(method, enforcement, delta.parse().unwrap(), 60);
            let n = hot.len();
            let change = |k: usize| hot[n - k] - hot[n - k - 1];
            let growth = (change(1) / change(11)).powf(0.1);
            let found = (1.0 - growth.recip()) / 0.01;
            assert!(
                (found / rate - 1.0).abs() < 1e-2,
                "{method} {delta}: {found} {rate}"
            );
        }
    }
}
