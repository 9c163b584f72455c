//! Natural frequencies.
//!
//! SOURCE      closed forms: chains of linear elements, beams, Navier's plate, strings; the free cube: an independent program
//!             (spectral elements), with Lamé's modes `π√2` among its values
//! GOAL        frequencies are right, none is missing, and states with contact and stresses vibrate as they are
//! MESH        bars of quad4, beams of quad8 and hex20, a plate and a cube of hex20
//! CONDITIONS  free, held, preloaded, joined by contact
//! EXPECTED    see each test
//! TOLERANCE   see each test
#![allow(clippy::unwrap_used, clippy::panic, clippy::indexing_slicing)]

mod beams;
mod joints;
mod mesh;
mod steps;

use mesh::{Block, Mesh};
use signorini::{Finished, Reading, RunOptions, build, open_text, run};
use signorini_io::fs::{Fs, MemoryFs};
use signorini_io::writers::json::FrequencySummary;
use std::f64::consts::PI;
use std::path::PathBuf;
use std::sync::Arc;

/// A case that was run, with its files.
struct Done {
    finished: Finished,
    fs: Arc<dyn Fs>,
    folder: PathBuf,
}

impl Done {
    #[track_caller]
    fn modes(&self) -> &FrequencySummary {
        let summary = &self.finished.summary;
        assert_eq!(
            self.finished.exit_code,
            0,
            "{}",
            self.finished.diagnostics.plain()
        );
        let found = summary.frequencies.last().unwrap();
        assert!(found.counted && found.modes.iter().all(|mode| mode.converged));
        found
    }

    #[track_caller]
    fn omegas(&self) -> Vec<f64> {
        self.modes().modes.iter().map(|mode| mode.omega).collect()
    }

    fn text(&self, file: &str) -> String {
        let bytes = self.fs.read(&self.folder.join(file)).unwrap();
        String::from_utf8(bytes).unwrap()
    }
}

fn solve(text: &str) -> Done {
    let opened = open_text("case.toml".as_ref(), text.into(), &Reading::default());
    let loaded = opened.and_then(|opened| opened.with_mesh());
    let loaded = loaded.unwrap_or_else(|found| panic!("{}", found.plain()));
    let fs: Arc<dyn Fs> = Arc::new(MemoryFs::default());
    let mut options = RunOptions::new(loaded.source);
    options.fs = Arc::clone(&fs);
    let folder = options.folder.clone();
    let mut model =
        build(loaded.case, loaded.mesh).unwrap_or_else(|found| panic!("{}", found.plain()));
    let finished = run(&mut model, &options, &mut ());
    Done {
        finished,
        fs,
        folder,
    }
}

/// Why a case is refused.
fn refusal(text: &str) -> String {
    let opened = open_text("case.toml".as_ref(), text.into(), &Reading::default());
    let built = opened
        .and_then(|opened| opened.with_mesh())
        .and_then(|loaded| build(loaded.case, loaded.mesh).map(drop));
    built.err().map_or_else(String::new, |found| found.plain())
}

/// The largest error of these values over the wanted ones.
#[track_caller]
fn agree(what: &str, got: &[f64], wanted: &[f64], tolerance: f64) {
    assert_eq!(got.len(), wanted.len(), "{what}: {got:?}");
    let errors = got
        .iter()
        .zip(wanted)
        .map(|(got, wanted)| (got / wanted - 1.0).abs());
    let worst = errors.fold(0.0, f64::max);
    eprintln!("{what}: {worst:.2e}");
    assert!(worst <= tolerance, "{what}: {worst:e}\n{got:?}\n{wanted:?}");
}

/// Material and body of groups.
fn elastic(e: f64, nu: f64, groups: &str, more: &str) -> String {
    format!(
        "[material.m]\nmodel = \"linear-elastic\"\nE = {e:?}\nnu = {nu:?}\ndensity = 1.0\n\
         [[body]]\ngroup = {groups}\nmaterial = \"m\"\n{more}\n"
    )
}

/// A bar of quad4 along x, fixed at x = 0: E = 900, ρ = 1, 10 long.
fn bar(elements: usize, more: &str, step: &str) -> String {
    let mesh = Mesh::of(&[Block {
        group: "bar",
        element: "quad4",
        cells: [elements, 1, 0],
        origin: [0.0; 3],
        // so thin that shear across it is faster than all that the chain can do
        size: [10.0, 0.02, 0.0],
    }]);
    format!(
        "{}[model]\nspace = \"plane-strain\"\n{}[sets]\n{}{}\n\
         [[step]]\nname = \"modes\"\nkind = \"frequency\"\n{step}\n\
         fix = [{{ on = \"bar\", u = [\"y\"] }}, {{ on = \"base\", u = \"all\" }}]\n",
        mesh.text(),
        elastic(900.0, 0.0, "\"bar\"", more),
        mesh.set("base", |x| x[0] == 0.0),
        mesh.set("tip", |x| x[0] == 10.0),
    )
}

/// ω of a chain of linear elements, fixed at one end.
fn chain(elements: usize, mode: usize, is_lumped: bool) -> f64 {
    let (c, h) = (30.0, 10.0 / elements as f64);
    let x = (2 * mode - 1) as f64 * PI / 20.0 * h;
    match is_lumped {
        true => 2.0 * c / h * (0.5 * x).sin(),
        false => c / h * (6.0 * (1.0 - x.cos()) / (2.0 + x.cos())).sqrt(),
    }
}

/// To the digits of the closed form: consistent and lumped, one element and many.
#[test]
fn bars_have_the_frequencies_of_their_closed_form() {
    for (elements, count) in [(1, 1), (2, 2), (7, 7), (100, 10), (100, 40)] {
        for is_lumped in [false, true] {
            let mass = if is_lumped {
                "mass_matrix = \"lumped\""
            } else {
                ""
            };
            let done = solve(&bar(
                elements,
                mass,
                &format!("frequency = {{ modes = {count} }}"),
            ));
            let wanted: Vec<f64> = (1..=count).map(|k| chain(elements, k, is_lumped)).collect();
            agree(
                &format!("bar of {elements}"),
                &done.omegas(),
                &wanted,
                1e-10,
            );
        }
    }
}

/// The effective masses of all modes add up to the mass of what moves; the first mode of a bar has 8/π² of all.
#[test]
fn effective_masses_add_up() {
    let done = solve(&bar(8, "", "frequency = { modes = 8 }"));
    let found = done.modes();
    let sum: f64 = found.modes.iter().map(|mode| mode.effective_mass[0]).sum();
    // nothing at the support moves: half an element of the consistent mass there, M_ff⁻¹ and all
    assert!(
        (found.mass[0] - 0.2).abs() < 1e-12 && sum < 0.2 && sum > 0.18,
        "{sum}"
    );
    let fine = solve(&bar(200, "", "frequency = { modes = 1 }"));
    let first = fine.modes().modes[0].effective_mass[0];
    assert!((first / 0.2 - 8.0 / (PI * PI)).abs() < 1e-4, "{first}");
}

#[test]
fn a_range_holds_the_modes_that_are_in_it() {
    let wanted: Vec<f64> = (1..=40).map(|k| chain(100, k, false)).collect();
    let middle = |k: usize| 0.5 * (wanted[k - 1] + wanted[k]) / (2.0 * PI);
    let range = format!(
        "frequency = {{ modes = 20, lower = {:?}, upper = {:?} }}",
        middle(5),
        middle(12)
    );
    let done = solve(&bar(100, "", &range));
    agree(
        "from the sixth to the twelfth",
        &done.omegas(),
        &wanted[5..12],
        1e-10,
    );
    let above = solve(&bar(
        100,
        "",
        &format!("frequency = {{ modes = 4, lower = {:?} }}", middle(20)),
    ));
    agree(
        "from the twenty-first",
        &above.omegas(),
        &wanted[20..24],
        1e-10,
    );
}

#[test]
fn the_number_of_threads_changes_no_bit() {
    let text = beams::cube(3, 0.3, 14);
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        pool.unwrap().install(|| {
            let done = solve(&text);
            (
                done.text("frequencies.csv"),
                done.fs
                    .read(&done.folder.join("frames/mode_0009.vtu"))
                    .unwrap(),
            )
        })
    };
    assert!(on(1) == on(2));
}

#[test]
fn bodies_without_density_are_refused() {
    let text = bar(4, "", "").replace("density = 1.0\n", "");
    let said = refusal(&text);
    assert!(said.contains("density"), "{said}");
}

#[test]
fn what_means_nothing_in_such_a_step_is_refused() {
    for (key, said) in [
        ("duration = 2.0", "`duration` means nothing"),
        ("increments = 5", "`increments` means nothing"),
        (
            "load = [{ on = \"tip\", force = [1.0, 0.0] }]",
            "`load` means nothing",
        ),
        ("dynamics = { rho_inf = 0.5 }", "belongs to dynamic steps"),
        ("frequency = { lower = 5.0, upper = 2.0 }", "is not above"),
    ] {
        let found = refusal(&bar(4, "", key));
        assert!(found.contains(said), "{found}");
    }
    let is_static =
        bar(4, "", "frequency = { modes = 3 }").replace("\"frequency\"\n", "\"static\"\n");
    assert!(refusal(&is_static).contains("belongs to frequency steps"));
}

/// A mass on a reference that leads the end of a bar without mass: `√(k/m)`.
#[test]
fn a_mass_on_a_reference_vibrates() {
    let text = "[mesh]\nnodes = [[1, 0, 0], [2, 1, 0], [3, 1, 1], [4, 0, 1]]\n\
         elements = [{ id = 1, type = \"quad4\", group = \"e\", nodes = [1, 2, 3, 4] }]\n\
         [model]\nspace = \"plane-strain\"\n[reference.end]\nat = [1.5, 0.5]\n\
         [material.m]\nmodel = \"linear-elastic\"\nE = 900.0\nnu = 0.0\ndensity = 1e-9\n\
         [[body]]\ngroup = \"e\"\nmaterial = \"m\"\n\
         [sets]\nbase = { nodes = [1, 4] }\ntip = { nodes = [2, 3] }\n\
         [[constraint]]\nkind = \"kinematic\"\non = \"tip\"\nreference = \"end\"\n\
         [[mass]]\non = \"end\"\nvalue = 2.0\ninertia = 0.5\n\
         [[step]]\nname = \"modes\"\nkind = \"frequency\"\nfrequency = { modes = 3 }\n\
         fix = [{ on = \"base\", u = \"all\" }, { on = \"end\", u = [\"y\"], rot = [\"z\"] }]\n";
    let done = solve(text);
    let [only] = done.omegas()[..] else {
        panic!("{:?}", done.omegas());
    };
    assert!((only - 450f64.sqrt()).abs() < 1e-8 * only, "{only}");
    let mass = done.modes().modes[0].effective_mass[0];
    assert!((mass - 2.0).abs() < 1e-8, "{mass}");
}
