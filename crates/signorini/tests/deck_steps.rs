//! Steps that decks ask for and cases do: elements that come and go, displacements of a global model.
//!
//! SOURCE      Written for the purpose.
//! GOAL        A deck and a case of the same model give the same numbers; displacements of another model are its own.
//! MESH        Two bars of one element; a submodel of one element in a global model of 2 × 2 × 2.
//! CONDITIONS  A load that both bars share; linear and quadratic fields of displacements.
//! EXPECTED    Closed forms; the fields themselves.
//! TOLERANCE   1e-9; 1e-5 from `.frd` files, whose numbers have six digits
#![allow(clippy::unwrap_used, clippy::panic)]

mod common;

use common::run;
use signorini::{Reading, build, load};
use signorini_geometry::element::by_name;
use signorini_geometry::tensor::Vec3;
use signorini_io::deck::Compat;
use signorini_io::vtk::cells::CellType;
use signorini_io::writers::vtu::{self, Fact, FactValue, Field, Grid, Values};
use std::collections::HashMap;
use std::fmt::Write as _;
use std::path::Path;

fn case_in(
    folder: &Path,
    name: &str,
    text: &str,
    compat: Compat,
) -> Result<signorini::Loaded, String> {
    std::fs::write(folder.join(name), text).unwrap();
    let reading = Reading {
        compat: Some(compat),
        ..Reading::default()
    };
    load(&folder.join(name), &reading).map_err(|found| found.plain())
}

/// Displacements of a node at the end of each increment.
fn course(folder: &Path, name: &str, text: &str, node: u64) -> Vec<Vec3> {
    let loaded = case_in(folder, name, text, Compat::None).unwrap_or_else(|e| panic!("{e}"));
    let mut model = build(loaded.case, loaded.mesh).unwrap_or_else(|e| panic!("{}", e.plain()));
    let node = model.node(node).unwrap() as usize;
    let run = run(&mut model);
    assert!(run.error.is_none(), "{:?}", run.error);
    run.frames
        .iter()
        .map(|frame| frame.displacement[node])
        .collect()
}

const BARS: [[f64; 3]; 16] = [
    [0., 0., 0.],
    [1., 0., 0.],
    [1., 1., 0.],
    [0., 1., 0.],
    [0., 0., 1.],
    [1., 0., 1.],
    [1., 1., 1.],
    [0., 1., 1.],
    [2., 0., 0.],
    [3., 0., 0.],
    [3., 1., 0.],
    [2., 1., 0.],
    [2., 0., 1.],
    [3., 0., 1.],
    [3., 1., 1.],
    [2., 1., 1.],
];

#[test]
fn elements_come_and_go_alike_in_a_deck_and_a_case() {
    let folder = tempfile::tempdir().unwrap();
    let nodes = |row: &dyn Fn(usize, &[f64; 3]) -> String| -> String {
        BARS.iter()
            .enumerate()
            .map(|(k, x)| row(k + 1, x))
            .collect()
    };
    for (nlgeom, geometry) in [("", "linear"), (", NLGEOM", "nonlinear")] {
        let mut deck = format!(
            "*NODE\n{}*ELEMENT, TYPE=C3D8, ELSET=A\n1,1,2,3,4,5,6,7,8\n*ELEMENT, TYPE=C3D8, ELSET=B\n2,9,10,11,12,13,14,15,16\n\
             *NSET, NSET=BASE\n1,2,3,4,9,10,11,12\n*NSET, NSET=TOP\n5,6,7,8,13,14,15,16\n*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.\n\
             *SOLID SECTION, ELSET=A, MATERIAL=M\n*SOLID SECTION, ELSET=B, MATERIAL=M\n*EQUATION\n",
            nodes(&|k, x| format!("{k}, {}, {}, {}\n", x[0], x[1], x[2]))
        );
        for node in [6, 7, 8, 13, 14, 15, 16] {
            write!(deck, "2\n{node},3,1.,5,3,-1.\n").unwrap();
        }
        deck.push_str("*BOUNDARY\nBASE, 1, 3\n");
        let mut toml = format!(
            "[mesh]\nnodes = [{}]\nelements = [{{ id = 1, type = \"hex8\", group = \"A\", nodes = [1,2,3,4,5,6,7,8] }}, \
             {{ id = 2, type = \"hex8\", group = \"B\", nodes = [9,10,11,12,13,14,15,16] }}]\n[sets]\n\
             base = {{ nodes = [1,2,3,4,9,10,11,12] }}\ntop = {{ nodes = [5,6,7,8,13,14,15,16] }}\nhead = {{ nodes = [5] }}\n\
             [material.m]\nmodel = \"linear-elastic\"\nE = 1000.0\nnu = 0.0\n[[body]]\ngroup = [\"A\", \"B\"]\nmaterial = \"m\"\n\
             [[constraint]]\nkind = \"equal\"\non = \"top\"\ndofs = [\"z\"]\n",
            nodes(&|k, x| format!("[{k}, {:?}, {:?}, {:?}],", x[0], x[1], x[2]))
        );
        let changes = [
            ("", "", 20.0),
            ("REMOVE", "deactivate = [{ group = \"B\" }]", 20.0),
            ("ADD", "activate = [{ group = \"B\" }]", 20.0),
            ("", "", 40.0),
            ("REMOVE", "deactivate = [{ group = \"B\" }]", 20.0),
            (
                "ADD=WITH STRAIN",
                "activate = [{ group = \"B\", strain = \"keep\" }]",
                20.0,
            ),
        ];
        for (k, (card, table, load)) in changes.iter().enumerate() {
            write!(
                deck,
                "*STEP{nlgeom}\n*STATIC, DIRECT\n0.5, 1.\n*CLOAD\n5, 3, {load}\n"
            )
            .unwrap();
            if !card.is_empty() {
                write!(deck, "*MODEL CHANGE, TYPE=ELEMENT, {card}\nB\n").unwrap();
            }
            deck.push_str("*END STEP\n");
            let fix = if k == 0 {
                "fix = [{ on = \"base\", u = \"all\" }]"
            } else {
                ""
            };
            write!(
                toml,
                "[[step]]\nname = \"s{k}\"\ngeometry = \"{geometry}\"\nincrements = {{ fixed = 2 }}\n{fix}\n{table}\n\
                 load = [{{ name = \"pull\", on = \"head\", per_node = [0, 0, {load:?}] }}]\n"
            )
            .unwrap();
        }
        let of_deck = course(folder.path(), "bars.inp", &deck, 5);
        let of_case = course(folder.path(), "bars.toml", &toml, 5);
        assert_eq!(of_deck.len(), 12);
        for (a, b) in of_deck.iter().zip(&of_case) {
            assert!((*a - *b).max_abs() < 1e-9, "{a:?} {b:?}");
        }
        if geometry == "linear" {
            // the second bar was added at 0.02, and keeps that
            for (step, wanted) in [0.01, 0.02, 0.02, 0.03, 0.02, 0.02].iter().enumerate() {
                assert!(
                    (of_case[2 * step + 1].z - wanted).abs() < 1e-9,
                    "{step} {:?}",
                    of_case
                );
            }
        }
    }
}

/// A global model: the frame of a field over a block of 2 × 2 × 2 elements.
fn frame(element: &str, step: i64, field: impl Fn(Vec3) -> Vec3) -> Vec<u8> {
    let element = by_name(element).unwrap();
    let kind = CellType::of_element(element).unwrap();
    let (mut points, mut known): (Vec<[f64; 3]>, HashMap<[i64; 3], u32>) = Default::default();
    let (mut types, mut offsets, mut connectivity) = (Vec::new(), vec![0], Vec::new());
    for k in 0..8 {
        let at = Vec3::new(f64::from(k % 2), f64::from(k / 2 % 2), f64::from(k / 4));
        let nodes: Vec<u32> = element
            .nodes()
            .iter()
            .map(|xi| {
                let x = at + (*xi + Vec3::new(1.0, 1.0, 1.0)) * 0.5;
                let key = x.to_array().map(|c| (c * 1e6).round() as i64);
                *known.entry(key).or_insert_with(|| {
                    points.push(x.to_array());
                    points.len() as u32 - 1
                })
            })
            .collect();
        connectivity.extend(kind.places().map(|place| nodes[place]));
        types.push(kind.number);
        offsets.push(connectivity.len());
    }
    let u: Vec<[f64; 3]> = points.iter().map(|&x| field(x.into()).to_array()).collect();
    let grid = Grid {
        points: &points,
        types: &types,
        offsets: &offsets,
        connectivity: &connectivity,
        point_data: &[Field::new("displacement", Values::Vector(&u))],
        facts: &[Fact {
            name: "step",
            value: FactValue::Whole(&[step]),
        }],
        ..Grid::default()
    };
    vtu::encode(&grid, &vtu::Options::default()).unwrap()
}

/// A submodel of one element from `low` to `high`, all of whose nodes move as this says.
fn submodel(low: f64, high: f64, from: &str) -> String {
    let mut rows = String::new();
    for (k, x) in BARS[..8].iter().enumerate() {
        let [x, y, z] = x.map(|c| if c > 0.0 { high } else { low });
        write!(rows, "[{}, {x:?}, {y:?}, {z:?}],", k + 1).unwrap();
    }
    format!(
        "[mesh]\nnodes = [{rows}]\nelements = [{{ id = 1, type = \"hex8\", group = \"A\", nodes = [1,2,3,4,5,6,7,8] }}]\n[sets]\n\
         cut = {{ nodes = [1,2,3,4,5,6,7,8] }}\n[material.m]\nmodel = \"linear-elastic\"\nE = 1000.0\nnu = 0.3\n[[body]]\n\
         group = \"A\"\nmaterial = \"m\"\n[[step]]\nname = \"follow\"\ngeometry = \"linear\"\nmove = [{{ on = \"cut\", from = {{ {from} }} }}]\n"
    )
}

type Displacement = fn(Vec3) -> Vec3;

fn quadratic(x: Vec3) -> Vec3 {
    Vec3::new(
        x.x * x.x - x.y * x.z,
        2.0 * x.x * x.y + 0.3 * x.z,
        x.z * x.z + 0.1,
    ) * 1e-3
}

fn linear(x: Vec3) -> Vec3 {
    Vec3::new(
        0.01 * x.x + 0.02 * x.y,
        -0.005 * x.y,
        0.003 * x.z - 0.001 * x.x,
    )
}

fn values(loaded: &signorini::Loaded) -> Vec<(Vec3, Vec3)> {
    let from = loaded.case.steps[0].moves[0].from.as_ref().unwrap();
    let values = from.values.as_ref().unwrap().iter();
    values
        .map(|&(node, u)| (loaded.mesh.points[node as usize], Vec3::from(u)))
        .collect()
}

#[test]
fn displacements_of_a_global_model_are_its_own_fields() {
    let folder = tempfile::tempdir().unwrap();
    let fields: [(&str, Displacement); 4] = [
        ("hex8", linear),
        ("hex20", linear),
        ("hex20", quadratic),
        ("hex27", quadratic),
    ];
    for (element, field) in fields {
        std::fs::write(folder.path().join("g.vtu"), frame(element, 1, field)).unwrap();
        let text = submodel(0.37, 1.61, "file = \"g.vtu\", step = 1");
        let loaded = case_in(folder.path(), "sub.toml", &text, Compat::None)
            .unwrap_or_else(|e| panic!("{e}"));
        let found = values(&loaded);
        assert_eq!(found.len(), 8);
        for (x, u) in found {
            assert!((u - field(x)).max_abs() < 1e-12, "{element} {x:?} {u:?}");
        }
        // and that is where they go
        let ends = course(folder.path(), "sub.toml", &text, 7);
        assert!((*ends.last().unwrap() - field(Vec3::from([1.61; 3]))).max_abs() < 1e-12);
    }
}

#[test]
fn the_last_frame_of_a_step_counts_in_a_list_and_a_folder_of_results() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("global.out");
    std::fs::create_dir(&out).unwrap();
    let mut list = String::from(
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\">\n<Collection>\n",
    );
    for (k, (step, factor)) in [(1, 1.0), (1, 2.0), (2, 3.0)].iter().enumerate() {
        let name = format!("f{k}.vtu");
        std::fs::write(
            out.join(&name),
            frame("hex8", *step, |x| linear(x) * *factor),
        )
        .unwrap();
        writeln!(
            list,
            "<DataSet timestep=\"{k}\" part=\"0\" file=\"{name}\"/>"
        )
        .unwrap();
    }
    list.push_str("</Collection>\n</VTKFile>\n");
    std::fs::write(out.join("results.pvd"), list).unwrap();
    for file in ["global.out", "global.out/results.pvd"] {
        for (at, factor) in [("step = 1", 2.0), ("step = 2", 3.0), ("data_set = 1", 1.0)] {
            let text = submodel(0.5, 1.5, &format!("file = \"{file}\", {at}"));
            let loaded = case_in(folder.path(), "sub.toml", &text, Compat::None)
                .unwrap_or_else(|e| panic!("{e}"));
            for (x, u) in values(&loaded) {
                assert!((u - linear(x) * factor).max_abs() < 1e-12, "{file} {at}");
            }
        }
        let text = submodel(0.5, 1.5, &format!("file = \"{file}\", step = 3"));
        let error = case_in(folder.path(), "sub.toml", &text, Compat::None).unwrap_err();
        assert!(
            error.contains("no displacements of step 3") && error.contains("steps 1, 2"),
            "{error}"
        );
    }
}

/// A `.frd` file as CalculiX writes it: one element from 0 to 2, with a linear field, in steps 1 and 2.
fn frd() -> String {
    let mut text = String::from(
        "    1C\n    2C                             8                                     1\n",
    );
    let at = |k: usize| Vec3::from(BARS[k]) * 2.0;
    for k in 0..8 {
        let x = at(k);
        writeln!(text, " -1{:10}{}{}{}", k + 1, sci(x.x), sci(x.y), sci(x.z)).unwrap();
    }
    text.push_str(
        " -3\n    3C                             1                                     1\n",
    );
    text.push_str(" -1         1    1    0    1\n -2         1         2         3         4         5         6         7         8\n -3\n");
    for step in 1..3 {
        writeln!(text, "    1PSTEP{:26}{:12}{:12}", step, 1, step).unwrap();
        writeln!(
            text,
            "  100CL{:5}{}{:12}{:21}{:5}{:10}{:2}",
            100 + step,
            sci(f64::from(step)),
            8,
            0,
            step,
            "",
            1
        )
        .unwrap();
        text.push_str(" -4  DISP        4    1\n -5  D1          1    2    1    0\n -5  D2          1    2    2    0\n -5  D3          1    2    3    0\n -5  ALL         1    2    0    0    1ALL\n");
        for k in 0..8 {
            let u = linear(at(k)) * f64::from(step);
            writeln!(text, " -1{:10}{}{}{}", k + 1, sci(u.x), sci(u.y), sci(u.z)).unwrap();
        }
        text.push_str(" -3\n");
    }
    text.push_str(" 9999\n");
    text
}

/// Twelve columns, `1.00000E+00`.
fn sci(value: f64) -> String {
    let text = format!("{value:.5E}");
    let (digits, exponent) = text.split_once('E').unwrap();
    let exponent: i32 = exponent.parse().unwrap();
    let sign = if exponent < 0 { '-' } else { '+' };
    format!("{:>12}", format!("{digits}E{sign}{:02}", exponent.abs()))
}

#[test]
fn a_deck_takes_displacements_from_a_file_of_calculix() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("g.frd"), frd()).unwrap();
    let mut deck = String::from("*NODE, NSET=CUT\n");
    for (k, x) in BARS[..8].iter().enumerate() {
        let [x, y, z] = x.map(|c| 0.4 + c);
        writeln!(deck, "{}, {x}, {y}, {z}", k + 1).unwrap();
    }
    deck.push_str("*ELEMENT, TYPE=C3D8, ELSET=A\n1,1,2,3,4,5,6,7,8\n*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.3\n*SOLID SECTION, ELSET=A, MATERIAL=M\n*SUBMODEL, TYPE=NODE, INPUT=g.frd\nCUT\n");
    deck.push_str("*STEP\n*STATIC\n*BOUNDARY, SUBMODEL, STEP=1\nCUT, 1, 3\n*END STEP\n*STEP\n*STATIC, DIRECT\n.5, 1.\n*BOUNDARY, SUBMODEL, STEP=2\nCUT, 1, 3\n*END STEP\n");
    let far = Vec3::from([1.4; 3]);
    let found = course(folder.path(), "sub.inp", &deck, 7);
    for (u, factor) in found.iter().zip([1.0, 1.5, 2.0]) {
        assert!((*u - linear(far) * factor).max_abs() < 1e-5 * 0.04, "{u:?}");
    }
    // a case says the same
    let text = submodel(0.4, 1.4, "file = \"g.frd\", step = 2");
    let ends = course(folder.path(), "sub.toml", &text, 7);
    assert!((*ends.last().unwrap() - found[2]).max_abs() < 1e-12);
}

#[test]
fn what_is_no_global_model_is_refused_with_what_is_wrong() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("g.vtu"), frame("hex8", 1, linear)).unwrap();
    std::fs::write(folder.path().join("g.frd"), frd()).unwrap();
    std::fs::write(folder.path().join("g.inp"), "*NODE\n").unwrap();
    std::fs::write(folder.path().join("torn.frd"), &frd()[..400]).unwrap();
    let refused = |low: f64, high: f64, from: &str| {
        let text = submodel(low, high, from);
        case_in(folder.path(), "sub.toml", &text, Compat::None)
            .err()
            .unwrap_or_default()
    };
    for (from, expected) in [
        ("file = \"none.frd\", step = 1", "cannot be read"),
        (
            "file = \"g.inp\", step = 1",
            "holds no results of a global model",
        ),
        ("file = \"torn.frd\", step = 1", "torn.frd"),
        (
            "file = \"g.vtu\", step = 2",
            "has no displacements of step 2",
        ),
        ("file = \"g.frd\", step = 7", "it has those of steps 1, 2"),
        (
            "file = \"g.frd\", data_set = 3",
            "has 2 displacement fields, not 3",
        ),
        (
            "file = \"g.frd\", step = 1, elements = [99]",
            "has none of these elements",
        ),
    ] {
        let found = refused(0.5, 1.5, from);
        assert!(found.contains(expected), "{from}: {found}");
    }
    // 1 % of a face of size 1
    assert_eq!(refused(0.5, 2.005, "file = \"g.vtu\", step = 1"), "");
    let outside = refused(0.5, 2.05, "file = \"g.vtu\", step = 1");
    assert!(
        outside.contains("lie outside of the global model") && outside.contains("8.660e-2"),
        "{outside}"
    );
}
