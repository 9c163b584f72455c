//! The solid-shell: derivatives, rigid motions, patches.

use super::*;
use crate::material::dense;

/// A sheet: middles with half the thickness vectors, and quadrilaterals of them.
struct Sheet {
    middles: Vec<Vec3>,
    halves: Vec<Vec3>,
    quads: Vec<[u32; 4]>,
}

/// The mesh of a sheet, with its directors: four nodes for each, those of its faces, its middle, its half.
fn expanded(sheet: &Sheet) -> (Mesh, Directors) {
    let mut mesh = Mesh::default();
    for (x, d) in sheet.middles.iter().zip(&sheet.halves) {
        mesh.points.extend([*x - *d, *x + *d, *x, *x]);
    }
    mesh.node_labels = (1..=mesh.points.len() as u64).collect();
    let director = |k: u32| Director {
        ends: [4 * k, 4 * k + 1],
        middle: 4 * k + 2,
        half: 4 * k + 3,
    };
    let hex8 = element::by_name("hex8").unwrap();
    for (quad, label) in sheet.quads.iter().zip(1..) {
        let ends = [0, 1].map(|side| quad.map(|k| director(k).ends[side]));
        mesh.push_cell(hex8, ends.as_flattened(), label);
    }
    let all = (0..sheet.middles.len() as u32).map(director).collect();
    let directors = Directors::new(all, mesh.nnode());
    (mesh, directors)
}

fn shell(sheet: &Sheet, material: Box<dyn Material>, kinematics: Kinematics) -> Body {
    let (mesh, directors) = expanded(sheet);
    let wish = Wish {
        locking: Locking::Shell,
        integration: Integration::Through(2),
        ..Wish::plain(Idealisation::Space, kinematics)
    };
    let layout = Layout::new(3, mesh.nnode(), 0);
    body_in(layout, &mesh, material, &wish, None, &directors).unwrap()
}

/// One distorted quadrilateral of a curved sheet whose thickness varies.
fn bent() -> Sheet {
    let corners = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
    let middle = |(k, [x, y]): (usize, [f64; 2])| {
        let off = Vec3::new(noise(3 * k), noise(3 * k + 1), noise(3 * k + 2)) * 0.15;
        Vec3::new(x, y, 0.2 * x * y + 0.1 * x * x) + off
    };
    let half = |k: usize| {
        Vec3::new(
            0.1 * noise(50 + k),
            0.1 * noise(60 + k),
            0.2 + 0.04 * noise(70 + k),
        )
    };
    Sheet {
        middles: corners.into_iter().enumerate().map(middle).collect(),
        halves: (0..4).map(half).collect(),
        quads: vec![[0, 1, 2, 3]],
    }
}

/// Displacements of the unknowns as a function of the director: of its middle, of its half.
fn of_directors(sheet: &Sheet, of: impl Fn(Vec3, Vec3) -> [Vec3; 2]) -> Vec<f64> {
    let pairs = sheet.middles.iter().zip(&sheet.halves);
    let unknowns = pairs.flat_map(|(x, d)| {
        let [v, half] = of(*x, *d);
        [Vec3::ZERO, Vec3::ZERO, v, half]
    });
    unknowns.flat_map(Vec3::to_array).collect()
}

#[test]
fn forces_of_shells_are_the_gradient_of_energy_and_stiffness_that_of_forces() {
    let mut checked = 0;
    for (law, make) in super::derivatives::laws() {
        for kinematics in [Kinematics::Small, Kinematics::Finite] {
            let body = shell(&bent(), make(), kinematics);
            let potential = make().is_symmetric();
            super::derivatives::check(&body, potential, &format!("shell {kinematics:?} {law}"));
            checked += 1;
        }
    }
    assert!(checked >= 8, "{checked}");
}

#[test]
fn rigid_motions_of_shells_have_no_energy_and_no_force() {
    let sheet = bent();
    let mut work = Work::default();
    for (kinematics, angle) in [(Kinematics::Small, 1e-3), (Kinematics::Finite, 2.0)] {
        let body = shell(&sheet, elastic("linear-elastic", 0.3), kinematics);
        let spin = Vec3::new(0.3, -0.6, 0.4) * angle;
        let turn = |x: Vec3| match kinematics {
            Kinematics::Small => spin.cross(x),
            Kinematics::Finite => Mat3::rotation(spin) * x - x,
        };
        let shift = Vec3::new(0.4, 0.1, -0.7);
        let u = of_directors(&sheet, |x, d| [turn(x) + shift, turn(d)]);
        let at = body.assemble(&u, Order::Residual, &mut work);
        let largest = at.force.iter().fold(0.0f64, |m, f| m.max(f.abs()));
        assert!(largest < 1e-11, "{kinematics:?}: {largest:e}");
        assert!(body.energy(&u, &mut work).abs() < 1e-12);
    }
}

/// The patch of MacNeal and Harder, 0.24 × 0.12 and 0.001 thick: its middles; four outside, four inside.
fn patch() -> Sheet {
    let at = |x: f64, y: f64| Vec3::new(x, y, 0.0);
    let middles = vec![
        at(0.0, 0.0),
        at(0.24, 0.0),
        at(0.24, 0.12),
        at(0.0, 0.12),
        at(0.04, 0.02),
        at(0.18, 0.03),
        at(0.16, 0.08),
        at(0.08, 0.08),
    ];
    Sheet {
        halves: vec![Vec3::new(0.0, 0.0, 0.0005); middles.len()],
        middles,
        quads: vec![
            [0, 1, 5, 4],
            [1, 2, 6, 5],
            [2, 3, 7, 6],
            [3, 0, 4, 7],
            [4, 5, 6, 7],
        ],
    }
}

/// The largest error of the unknowns inside the patch, relative to the largest one of the field, where those outside are those of
/// the field; of middles and of halves.
fn error_of_patch(field: impl Fn(Vec3, Vec3) -> [Vec3; 2]) -> [f64; 2] {
    let sheet = patch();
    let law = TABLE.iter().find(|l| l.name == "linear-elastic").unwrap();
    let material = (law.make)(&Constants::elastic(1e6, 0.25)).unwrap();
    let body = shell(&sheet, material, Kinematics::Small);
    let exact = of_directors(&sheet, field);
    let mut work = Work::default();
    let n = body.layout.ndof();
    let at = body.assemble(&vec![0.0; n], Order::Tangent, &mut work);
    let inside = |dof: &usize| dof / 12 >= 4 && dof % 12 >= 6;
    let free: Vec<usize> = (0..n).filter(inside).collect();
    let outside: Vec<usize> = (0..4 * 12).filter(|dof| dof % 12 >= 6).collect();
    let mut matrix = Vec::new();
    let mut right = Vec::new();
    // middles and halves differ in size by the thickness: rows and columns are scaled
    let scale = |dof: usize| at.stiffness[dof * n + dof].sqrt();
    for &i in &free {
        matrix.extend(
            free.iter()
                .map(|&j| at.stiffness[i * n + j] / (scale(i) * scale(j))),
        );
        let known = outside.iter().map(|&j| at.stiffness[i * n + j] * exact[j]);
        right.push(-known.sum::<f64>() / scale(i));
    }
    dense::solve(&mut matrix, free.len(), &mut right, 1).unwrap();
    let of = |kind: usize| {
        let is_of = |dof: usize| (dof % 12) / 3 == 2 + kind;
        let size = (0..n)
            .filter(|&d| is_of(d))
            .map(|d| exact[d].abs())
            .fold(0.0, f64::max);
        let pairs = free.iter().zip(&right).filter(|(dof, _)| is_of(**dof));
        let errors = pairs.map(|(&dof, x)| (x / scale(dof) - exact[dof]).abs());
        errors.fold(0.0, f64::max) / size
    };
    [of(0), of(1)]
}

#[test]
fn a_patch_of_shells_reproduces_constant_strain_of_its_middle() {
    let [middle, _] = error_of_patch(|x, d| {
        let v = Vec3::new(x.x + 0.5 * x.y, x.y + 0.5 * x.x, 0.0) * 1e-3;
        // E_33 = −ν/(1 − ν) (E_11 + E_22) without stress across
        let across = -0.25 / 0.75 * 2e-3;
        [v, d * across]
    });
    assert!(middle < 1e-11, "{middle:e}");
}

#[test]
fn a_patch_of_shells_reproduces_constant_curvature() {
    let [middle, half] = error_of_patch(|x, d| {
        let w = 0.5e-3 * (x.x * x.x + x.x * x.y + x.y * x.y);
        let slope = Vec3::new(x.x + 0.5 * x.y, x.y + 0.5 * x.x, 0.0) * 1e-3;
        [Vec3::unit(2) * w, slope * -d.z]
    });
    assert!(middle < 1e-9 && half < 1e-9, "{middle:e} {half:e}");
}
