//! Physics of a program does what that of the program's own tables does where both are the same.

#![allow(clippy::unwrap_used, clippy::panic)]

mod common;

use common::Run;
use signorini::setup::read_mesh_of;
use signorini::{
    Diagnostics, Finished, Listener, Model, News, Own, RunOptions, Source, build_with, solve,
};
use signorini_geometry::surface::{Patch, Shape, SurfaceError};
use signorini_geometry::tensor::{Sym3, Vec3};
use signorini_io::case::{read_case, resolved};
use signorini_mechanics::contact::friction::{FrictionLaw, Limit, Sliding};
use signorini_mechanics::contact::law::{ContactLaw, Eval, Scale, each};
use signorini_mechanics::material::{Material, MaterialError, Order, Response, Strain};
use signorini_mechanics::solve::Flow;
use std::fmt::Write as _;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

/// `p = p0 exp(−r g)`.
#[derive(Debug)]
struct Film {
    p0: f64,
    rate: f64,
}

impl ContactLaw for Film {
    fn name(&self) -> &str {
        "film"
    }

    fn pressures(&self, gaps: &[f64], lambdas: &[f64], _: &Scale, out: &mut [Eval]) {
        each(gaps, lambdas, out, |gap, _| {
            let value = self.p0 * (-self.rate * gap).exp();
            Eval {
                value,
                dgap: -self.rate * value,
                dlambda: 0.0,
            }
        });
    }

    fn energy(&self, gap: f64, _: f64, _: &Scale) -> Option<f64> {
        Some(self.p0 * (-self.rate * gap).exp() / self.rate)
    }
}

/// `|x − c| = R`.
#[derive(Debug)]
struct Ball {
    centre: Vec3,
    radius: f64,
}

impl Shape for Ball {
    fn closest(&self, point: Vec3) -> Result<Option<Vec3>, SurfaceError> {
        let away = point - self.centre;
        Ok(Some(self.centre + away * (self.radius / away.norm())))
    }

    fn patch(&self, on: Vec3) -> Result<Patch, SurfaceError> {
        let n = (on - self.centre) / self.radius;
        let bend = |i: usize, j: usize| (f64::from(i == j) - n[i] * n[j]) / self.radius;
        let [xx, yy, zz] = [bend(0, 0), bend(1, 1), bend(2, 2)];
        let gradient = Sym3::new(xx, yy, zz, bend(0, 1), bend(1, 2), bend(0, 2));
        Ok(Patch::smooth(n, gradient))
    }

    fn ball(&self) -> Option<(Vec3, f64)> {
        Some((self.centre, self.radius))
    }
}

/// `L = μ p`.
#[derive(Debug)]
struct Dry(f64);

impl FrictionLaw for Dry {
    fn limits(&self, at: &[Sliding], out: &mut [Limit]) {
        for (out, at) in out.iter_mut().zip(at) {
            *out = Limit {
                value: self.0 * at.pressure,
                dpressure: self.0,
            };
        }
    }
}

/// `S = K tr(E) I + 2 G (E − tr(E)/3 I)`.
struct Stiff {
    bulk: f64,
    shear: f64,
}

impl Stiff {
    fn new(e: f64, nu: f64) -> Self {
        Self {
            bulk: e / (3.0 * (1.0 - 2.0 * nu)),
            shear: e / (2.0 * (1.0 + nu)),
        }
    }
}

impl Material for Stiff {
    fn respond(
        &self,
        strain: &Strain,
        _: &[f64],
        _: &mut [f64],
        _: Order,
        out: &mut Response,
    ) -> Result<(), MaterialError> {
        let volume = strain.value.trace();
        let mean = (self.bulk - 2.0 / 3.0 * self.shear) * volume;
        out.stress = strain.value * (2.0 * self.shear) + Sym3::IDENTITY * mean;
        out.energy = 0.5 * out.stress.double_dot(strain.value);
        out.tangent = [[0.0; 6]; 6];
        for i in 0..3 {
            out.tangent[i][..3].fill(self.bulk - 2.0 / 3.0 * self.shear);
            out.tangent[i][i] += 2.0 * self.shear;
            out.tangent[i + 3][i + 3] = self.shear;
        }
        Ok(())
    }

    fn modulus(&self) -> f64 {
        self.bulk + 4.0 / 3.0 * self.shear
    }
}

/// What differs from case to case.
#[derive(Clone, Copy)]
struct Say<'a> {
    shape: &'a str,
    enforcement: &'a str,
    friction: &'a str,
    material: &'a str,
    amplitude: &'a str,
}

/// The case in the words of the program.
const SAY: Say<'static> = Say {
    shape: "{ sphere = { center = [0.4, 0.5, 3.0], radius = 2.0 } }",
    enforcement: "{ exponential = { p0 = 2.0, c0 = 0.1 } }",
    friction: "{ mu = 0.3, stiffness = 50.0 }",
    material: "model = 'saint-venant-kirchhoff'\nE = 100.0\nnu = 0.3",
    amplitude: "table = [[0.0, 0.0], [0.5, 1.0], [1.0, 0.25]]",
};

/// The same in those of this program.
const OWN: Say<'static> = Say {
    shape: "{ own = 'ball' }",
    enforcement: "{ own = 'film' }",
    friction: "{ own = 'dry', stiffness = 50.0 }",
    material: "model = 'own'\nown = 'stiff'",
    amplitude: "own = 'up and down'",
};

/// What this program brings.
fn own() -> Own {
    let mut own = Own::default();
    let ball = Ball {
        centre: Vec3::new(0.4, 0.5, 3.0),
        radius: 2.0,
    };
    own.surfaces.insert("ball".to_owned(), Arc::new(ball));
    let film = Film {
        p0: 2.0,
        rate: 100f64.ln() / 0.1,
    };
    own.laws.insert("film".to_owned(), Arc::new(film));
    own.frictions.insert("dry".to_owned(), Arc::new(Dry(0.3)));
    let stiff = Arc::new(Stiff::new(100.0, 0.3));
    own.materials.insert("stiff".to_owned(), stiff);
    let course = |time: f64| (2.0 * time).min(1.75 - 1.5 * time);
    own.courses
        .insert("up and down".to_owned(), Arc::new(course));
    own
}

/// A block of 2 × 2 × 2 elements under a ball that is pressed onto it and drawn aside.
fn text(say: Say<'_>) -> String {
    let mut text = "[mesh]\nnodes = [\n".to_owned();
    let number = |i: usize, j: usize, k: usize| 1 + i + 3 * j + 9 * k;
    for (k, z) in [0.0, 0.5, 1.0].into_iter().enumerate() {
        for (j, y) in [0.0, 0.45, 1.0].into_iter().enumerate() {
            for (i, x) in [0.0, 0.55, 1.0].into_iter().enumerate() {
                let _ = writeln!(text, "[{}, {x:?}, {y:?}, {z:?}],", number(i, j, k));
            }
        }
    }
    text += "]\nelements = [\n";
    for cell in 0..8 {
        let (i, j, k) = (cell % 2, cell / 2 % 2, cell / 4);
        let ring = |k| {
            [(0, 0), (1, 0), (1, 1), (0, 1)]
                .map(|(di, dj): (usize, usize)| number(i + di, j + dj, k))
        };
        let nodes = [ring(k), ring(k + 1)].concat();
        let _ = writeln!(
            text,
            "{{ id = {}, type = 'hex8', group = 'block', nodes = {nodes:?} }},",
            cell + 1
        );
    }
    let Say {
        shape,
        enforcement,
        friction,
        material,
        amplitude,
    } = say;
    text += &format!(
        "]
[sets]
base = {{ plane = 'z', at = 0, of = 'block' }}
top = {{ plane = 'z', at = 1, of = 'block' }}
[reference.hand]
at = [0.4, 0.5, 3.0]
[amplitude.course]
{amplitude}
[material.soft]
{material}
density = 1.0
[[body]]
group = 'block'
material = 'soft'
locking = 'none'
[[surface]]
name = 'tool'
shape = {shape}
reference = 'hand'
[[contact]]
name = 'press'
secondary = 'top'
primary = 'tool'
method = 'gauss-point'
enforcement = {enforcement}
friction = {friction}
[[step]]
name = 'press'
increments = {{ fixed = 4 }}
fix = [{{ on = 'base', u = 'all' }}, {{ on = 'hand', rot = 'all' }}]
move = [{{ on = 'hand', ux = 0.02, uy = 0.0, uz = {{ amplitude = 'course', value = -0.05 }} }}]
load = [{{ on = 'block', gravity = [0.5, 0.0, 0.0], amplitude = 'course' }}]
"
    );
    text
}

fn try_model(text: &str, own: &Own) -> Result<Model, Diagnostics> {
    let (case, _) = read_case("case.toml", text.as_bytes(), &[], signorini::vocabulary())?;
    let (mesh, _) = read_mesh_of(&case, Path::new("."))?;
    build_with(case, mesh, own)
}

#[track_caller]
fn model(text: &str) -> Model {
    try_model(text, &own()).unwrap_or_else(|found| panic!("{}", found.plain()))
}

/// The frames of a run that gets to its end.
#[track_caller]
fn run(say: Say<'_>) -> Run {
    let run = common::run(&mut model(&text(say)));
    assert!(run.error.is_none(), "{:?}", run.error);
    run
}

/// Displacements of nodes in each frame, forces of contact after each increment, and the largest of each.
fn numbers(run: &Run) -> ([f64; 2], Vec<[Vec3; 2]>) {
    let mut largest = [0.0f64; 2];
    let mut all = Vec::new();
    for frame in &run.frames {
        for contact in &frame.contacts {
            let force = contact.secondary.force;
            largest[1] = largest[1].max(force.max_abs());
            all.extend(frame.displacement.iter().map(|u| [*u, force]));
        }
        let sizes = frame.displacement.iter().map(|u| u.max_abs());
        largest[0] = sizes.fold(largest[0], f64::max);
    }
    (largest, all)
}

#[track_caller]
fn agree(own: &Run, plain: &Run, tolerance: f64) {
    let ((largest, own), (_, plain)) = (numbers(own), numbers(plain));
    assert_eq!(own.len(), plain.len());
    assert!(own.len() > 100 && largest.iter().all(|&size| size > 1e-3));
    for (own, plain) in own.iter().zip(&plain) {
        for k in 0..2 {
            let error = (own[k] - plain[k]).max_abs();
            assert!(error <= tolerance * largest[k], "{k}: {error:e}");
        }
    }
}

#[test]
fn an_own_friction_law_equal_to_coulombs_gives_the_same_bits() {
    let friction = OWN.friction;
    agree(&run(Say { friction, ..SAY }), &run(SAY), 0.0);
}

#[test]
fn an_own_law_equal_to_the_exponential_one_gives_its_results() {
    let enforcement = OWN.enforcement;
    agree(&run(Say { enforcement, ..SAY }), &run(SAY), 1e-12);
}

#[test]
fn an_own_shape_equal_to_the_sphere_gives_its_results() {
    let shape = OWN.shape;
    agree(&run(Say { shape, ..SAY }), &run(SAY), 1e-12);
}

#[test]
fn an_own_material_equal_to_that_of_saint_venant_and_kirchhoff_gives_its_results() {
    let material = OWN.material;
    agree(&run(Say { material, ..SAY }), &run(SAY), 1e-12);
}

#[test]
fn an_own_course_equal_to_a_table_gives_its_results() {
    for time in ["step", "total"] {
        let of_time = |amplitude: &str| format!("{amplitude}\ntime = '{time}'");
        let (own, plain) = (of_time(OWN.amplitude), of_time(SAY.amplitude));
        let say = |amplitude| Say { amplitude, ..SAY };
        agree(&run(say(&own)), &run(say(&plain)), 1e-12);
    }
}

#[test]
fn own_physics_of_every_kind_goes_together() {
    agree(&run(OWN), &run(SAY), 1e-12);
}

#[test]
fn a_resolved_case_names_what_the_program_brings() {
    let first = model(&text(OWN)).case;
    let written = resolved(&first, signorini::vocabulary());
    for said in [
        "{ own = \"ball\" }",
        "{ own = \"film\", per = \"area\" }",
        "own = \"dry\", ",
        "own = \"stiff\"",
        "own = \"up and down\"",
    ] {
        assert!(written.contains(said), "{said}\n{written}");
    }
    let again = model(&written).case;
    assert_eq!(resolved(&again, signorini::vocabulary()), written);
}

#[test]
fn what_the_program_lacks_is_refused_once_with_its_place() {
    let refused = |say| try_model(&text(say), &Own::default()).err().unwrap();
    for (say, name, kind) in [
        (
            Say {
                shape: OWN.shape,
                ..SAY
            },
            "ball",
            "surface",
        ),
        (
            Say {
                enforcement: OWN.enforcement,
                ..SAY
            },
            "film",
            "contact law",
        ),
        (
            Say {
                friction: OWN.friction,
                ..SAY
            },
            "dry",
            "friction law",
        ),
        (
            Say {
                material: OWN.material,
                ..SAY
            },
            "stiff",
            "material",
        ),
        (
            Say {
                amplitude: OWN.amplitude,
                ..SAY
            },
            "up and down",
            "function of time",
        ),
    ] {
        let found = refused(say);
        let text = found.plain();
        let codes: Vec<&str> = found.iter().map(|one| one.code.id).collect();
        assert_eq!(codes, ["S0122"], "{text}");
        assert_eq!(found.exit_code(), Some(3));
        assert!(
            text.contains(&format!("own physics \"{name}\", which only")),
            "{text}"
        );
        assert!(text.contains(&format!("a {kind} of the program")), "{text}");
        assert!(text.contains("case.toml:"), "{text}");
    }
    assert_eq!(refused(OWN).iter().count(), 5);
    let say = Say {
        material: "model = 'own'\nown = 'stif'",
        ..SAY
    };
    let found = try_model(&text(say), &own()).err().unwrap().plain();
    assert!(found.contains("this program has: stiff"), "{found}");
}

/// A law that counts the rows it is asked about: by themselves, and together with others.
#[derive(Debug)]
struct Counting(Film, [AtomicUsize; 2]);

impl ContactLaw for Counting {
    fn name(&self) -> &str {
        "counting"
    }

    fn pressures(&self, gaps: &[f64], lambdas: &[f64], scale: &Scale, out: &mut [Eval]) {
        let together = usize::from(gaps.len() > 1);
        self.1[together].fetch_add(gaps.len(), Ordering::Relaxed);
        self.0.pressures(gaps, lambdas, scale, out);
    }

    fn energy(&self, _: f64, _: f64, _: &Scale) -> Option<f64> {
        None
    }
}

#[test]
fn a_law_is_asked_about_the_rows_of_a_chunk_at_once() {
    let film = Film {
        p0: 2.0,
        rate: 100f64.ln() / 0.1,
    };
    let counting = Arc::new(Counting(film, Default::default()));
    let mut own = own();
    own.laws.insert("film".to_owned(), counting.clone());
    let mut model = try_model(&text(OWN), &own).unwrap_or_else(|all| panic!("{}", all.plain()));
    let run = common::run(&mut model);
    assert!(run.error.is_none());
    let [alone, together] = [0, 1].map(|k| counting.1[k].load(Ordering::Relaxed));
    // of so few rows most have a chunk to themselves
    assert!(together > 0 && alone > 0, "{together} and {alone}");
}

/// Something of the program that is asked so many times, and then answers with what is no number.
#[derive(Clone, Debug, Default)]
struct Patience {
    left: usize,
    asked: Arc<AtomicUsize>,
}

impl Patience {
    fn is_over(&self) -> bool {
        self.asked.fetch_add(1, Ordering::Relaxed) >= self.left
    }

    /// The number, while patience lasts.
    fn of(&self, number: f64) -> f64 {
        if self.is_over() { f64::NAN } else { number }
    }
}

/// Something that fails after some time.
#[derive(Debug)]
struct Failing<T>(T, Patience);

impl ContactLaw for Failing<Film> {
    fn name(&self) -> &str {
        "failing"
    }

    fn pressures(&self, gaps: &[f64], lambdas: &[f64], scale: &Scale, out: &mut [Eval]) {
        self.0.pressures(gaps, lambdas, scale, out);
        for at in out {
            at.value = self.1.of(at.value);
        }
    }

    fn energy(&self, _: f64, _: f64, _: &Scale) -> Option<f64> {
        None
    }
}

impl FrictionLaw for Failing<Dry> {
    fn limits(&self, at: &[Sliding], out: &mut [Limit]) {
        self.0.limits(at, out);
        for limit in out {
            limit.value = self.1.of(limit.value);
        }
    }
}

impl Shape for Failing<Ball> {
    fn closest(&self, point: Vec3) -> Result<Option<Vec3>, SurfaceError> {
        let closest = self.0.closest(point)?;
        Ok(closest.map(|on| on * self.1.of(1.0)))
    }

    fn patch(&self, on: Vec3) -> Result<Patch, SurfaceError> {
        self.0.patch(on)
    }

    fn ball(&self) -> Option<(Vec3, f64)> {
        self.0.ball()
    }
}

impl Material for Failing<Stiff> {
    fn respond(
        &self,
        strain: &Strain,
        old: &[f64],
        new: &mut [f64],
        order: Order,
        out: &mut Response,
    ) -> Result<(), MaterialError> {
        self.0.respond(strain, old, new, order, out)?;
        out.stress = out.stress * self.1.of(1.0);
        Ok(())
    }

    fn modulus(&self) -> f64 {
        self.0.modulus()
    }
}

/// What this program brings, of which one fails after it was asked so many times.
fn failing(kind: &str, asked: usize) -> (Own, Patience) {
    let mut own = own();
    let patience = Patience {
        left: asked,
        ..Patience::default()
    };
    let with = patience.clone();
    match kind {
        "surface" => {
            let ball = Ball {
                centre: Vec3::new(0.4, 0.5, 3.0),
                radius: 2.0,
            };
            let ball = Arc::new(Failing(ball, with));
            own.surfaces.insert("ball".to_owned(), ball);
        }
        "law" => {
            let film = Film {
                p0: 2.0,
                rate: 100f64.ln() / 0.1,
            };
            own.laws
                .insert("film".to_owned(), Arc::new(Failing(film, with)));
        }
        "friction" => {
            let dry = Arc::new(Failing(Dry(0.3), with));
            own.frictions.insert("dry".to_owned(), dry);
        }
        "material" => {
            let stiff = Arc::new(Failing(Stiff::new(100.0, 0.3), with));
            own.materials.insert("stiff".to_owned(), stiff);
        }
        _ => {
            let course = move |time: f64| with.of(2.0 * time);
            own.courses
                .insert("up and down".to_owned(), Arc::new(course));
        }
    }
    (own, patience)
}

/// What can fail.
const KINDS: [&str; 5] = ["surface", "law", "friction", "material", "course"];

/// How often it is asked until the middle of a run that comes to its end.
fn half(kind: &str, text: &str) -> usize {
    let (own, patience) = failing(kind, usize::MAX);
    let folder = tempfile::tempdir().unwrap();
    let finished = solved(text, &own, (folder.path(), false), &mut ());
    assert_eq!(finished.exit_code, 0, "{kind}");
    patience.asked.load(Ordering::Relaxed) / 2
}

fn options(folder: &Path, own: &Own, text: &str) -> RunOptions {
    let source = Source {
        name: "case".into(),
        path: "/nowhere/case.toml".into(),
        text: text.into(),
        ..Source::default()
    };
    RunOptions {
        own: own.clone(),
        folder: folder.to_path_buf(),
        ..RunOptions::new(source)
    }
}

/// Solves a case with what the program brings, into a folder.
fn solved(
    text: &str,
    own: &Own,
    (folder, resume): (&Path, bool),
    listener: &mut dyn Listener,
) -> Finished {
    let mut model = try_model(text, own).unwrap_or_else(|found| panic!("{}", found.plain()));
    model.name = "case".to_owned();
    let options = RunOptions {
        resume,
        ..options(folder, own, text)
    };
    solve(model, &options, listener)
}

#[test]
fn an_answer_that_is_no_number_ends_a_run_as_not_converged() {
    for kind in KINDS {
        for increments in ["{ fixed = 4 }", "4"] {
            let text = text(OWN).replace("{ fixed = 4 }", increments);
            let (own, patience) = failing(kind, half(kind, &text));
            let folder = tempfile::tempdir().unwrap();
            let finished = solved(&text, &own, (folder.path(), false), &mut ());
            assert!(patience.is_over(), "{kind}");
            let why = finished.diagnostics.plain();
            assert_eq!(finished.exit_code, 5, "{kind}: {why}");
            assert!(why.contains("error[S05"), "{kind}: {why}");
        }
    }
}

/// Stops a run at the first event after something of the program has failed.
struct Stopping(Patience);

impl Listener for Stopping {
    fn hear(&mut self, _: &News<'_>) -> Flow {
        let failed = self.0.asked.load(Ordering::Relaxed) > self.0.left;
        if failed { Flow::Stop } else { Flow::Continue }
    }
}

#[test]
fn a_run_that_is_stopped_after_a_failure_goes_on_from_before_it() {
    let text = format!("{}[checkpoint]\nevery = {{ increments = 1 }}\n", text(OWN));
    let whole = tempfile::tempdir().unwrap();
    let finished = solved(&text, &own(), (whole.path(), false), &mut ());
    assert_eq!(finished.exit_code, 0);
    let history = |folder: &Path| std::fs::read_to_string(folder.join("history.csv")).unwrap();
    for kind in KINDS {
        let (own, patience) = failing(kind, half(kind, &text));
        let folder = tempfile::tempdir().unwrap();
        let mut listener = Stopping(patience.clone());
        let stopped = solved(&text, &own, (folder.path(), false), &mut listener);
        let why = stopped.diagnostics.plain();
        assert_eq!(stopped.exit_code, 130, "{kind}: {why}");
        let so_far = history(folder.path()).lines().count();
        assert!(so_far < history(whole.path()).lines().count(), "{kind}");
        let resumed = solved(&text, &self::own(), (folder.path(), true), &mut ());
        assert_eq!(
            resumed.exit_code,
            0,
            "{kind}: {}",
            resumed.diagnostics.plain()
        );
        assert_eq!(history(folder.path()), history(whole.path()), "{kind}");
    }
}
