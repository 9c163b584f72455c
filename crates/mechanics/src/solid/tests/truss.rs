//! Bars.

use super::*;
use crate::solid::{Truss, TrussParts};

fn bars(points: &[Vec3], element: &str, ndim: usize) -> (Truss, Layout, Arc<[Vec3]>) {
    let mut mesh = Mesh::default();
    for x in points {
        mesh.points.push(*x);
        mesh.node_labels.push(mesh.points.len() as u64);
    }
    let nodes: Vec<u32> = (0..points.len() as u32).collect();
    let cell = mesh.push_cell(element::by_name(element).unwrap(), &nodes, 4);
    let layout = Layout::new(ndim, points.len(), 0);
    let reference: Arc<[Vec3]> = points.into();
    let truss = Truss::new(TrussParts {
        name: "bars",
        mesh: &mesh,
        reference: reference.clone(),
        cells: &[cell],
        layout,
        space: match ndim {
            2 => Idealisation::PlaneStrain { thickness: 1.0 },
            _ => Idealisation::Space,
        },
        material: elastic("neo-hookean", 0.3),
        area: 0.4,
        small: false,
        temperature: None,
    });
    (truss.unwrap(), layout, reference)
}

fn step(nonlinear: bool) -> StepContext {
    StepContext {
        nonlinear,
        ..StepContext::default()
    }
}

#[test]
fn forces_of_bars_are_the_gradient_of_energy_and_stiffness_that_of_forces() {
    let ends = [Vec3::new(0.1, -0.2, 0.3), Vec3::new(1.2, 0.7, -0.4)];
    let curved = [ends[0], ends[1], Vec3::new(0.6, 0.35, 0.1)];
    for (element, points) in [("line2", &ends[..]), ("line3", &curved[..])] {
        for ndim in [2, 3] {
            for nonlinear in [false, true] {
                let flat: Vec<Vec3> = points
                    .iter()
                    .map(|x| {
                        if ndim == 2 {
                            Vec3::new(x.x, x.y, 0.0)
                        } else {
                            *x
                        }
                    })
                    .collect();
                let (mut truss, layout, reference) = bars(&flat, element, ndim);
                let zero = state(&layout, &reference, &vec![0.0; layout.ndof()]);
                truss
                    .begin(&Phase::of_step(step(nonlinear)), &zero)
                    .unwrap();
                let n = layout.ndof();
                let u: Vec<f64> = (0..n).map(|k| 0.1 * noise(k)).collect();
                let mut work = Work::default();
                let mut at = |u: &[f64]| {
                    let mut dense = Dense {
                        force: vec![0.0; n],
                        stiffness: vec![0.0; n * n],
                    };
                    let state = state(&layout, &reference, u);
                    truss
                        .evaluate(0, &state, Order::Tangent, &mut work, &mut dense)
                        .unwrap();
                    let energy = truss.energy(0, &state, &mut work).unwrap().unwrap();
                    (dense, energy)
                };
                let (here, _) = at(&u);
                let scale = here.scale();
                let h = 1e-4;
                for j in 0..n {
                    let mut moved = u.clone();
                    let mut value = |d: f64| {
                        moved[j] = u[j] + d;
                        at(&moved)
                    };
                    let [a, b, c, d] = [h, -h, 2.0 * h, -2.0 * h].map(&mut value);
                    let slope =
                        |a: f64, b: f64, c: f64, d: f64| (8.0 * (a - b) - (c - d)) / (12.0 * h);
                    assert!((slope(a.1, b.1, c.1, d.1) - here.force[j]).abs() < 1e-8 * scale);
                    for i in 0..n {
                        let k = slope(a.0.force[i], b.0.force[i], c.0.force[i], d.0.force[i]);
                        let error = (k - here.stiffness[i * n + j]).abs();
                        assert!(
                            error < 1e-7 * scale,
                            "{element} {ndim} {nonlinear}: {error:e}"
                        );
                    }
                }
            }
        }
    }
}

#[test]
fn a_turned_and_stretched_bar_reports_force_over_present_area_along_itself() {
    // length 2 along x, turned to y and stretched by 1.1
    let (mut truss, layout, reference) = bars(&[Vec3::ZERO, Vec3::new(2.0, 0.0, 0.0)], "line2", 3);
    let u = [0.0, 0.0, 0.0, -2.0, 2.2, 0.0];
    let at = state(&layout, &reference, &u);
    truss.begin(&Phase::of_step(step(true)), &at).unwrap();
    let mut frame = Frame::new(2, &[1]);
    truss.report(&at, &mut frame).unwrap();
    let mut dense = Dense {
        force: vec![0.0; 6],
        stiffness: vec![0.0; 36],
    };
    let order = Order::Residual;
    truss
        .evaluate(0, &at, order, &mut Work::default(), &mut dense)
        .unwrap();
    let force = dense.force[4];
    // neo-Hookean under uniaxial stress: μ (b² − 1) + λ ln J = 0 across, σ J = μ (l² − 1) + λ ln J along
    let (mu, lambda) = (500.0 / 2.6, 500.0 * 0.3 / (1.3 * 0.4));
    let mut b2 = 1.0f64;
    for _ in 0..100 {
        let log = (1.1 * b2).ln();
        b2 -= (mu * (b2 - 1.0) + lambda * log) / (mu + lambda / b2);
    }
    let cauchy = (mu * (1.21 - 1.0) + lambda * (1.1 * b2).ln()) / (1.1 * b2);
    let stress = frame.cell_stress[0][0];
    assert!(
        (stress.yy() - cauchy).abs() < 1e-9 * cauchy,
        "{stress:?} {cauchy}"
    );
    assert!((force - cauchy * 0.4 * b2).abs() < 1e-9 * force);
    assert!(stress.xx().abs() < 1e-12 && dense.force[3].abs() < 1e-12);
    // E A / L along x, as it lay at first
    truss
        .add_initial(0, &mut Work::default(), &mut dense)
        .unwrap();
    assert!((dense.stiffness[0] - 500.0 * 0.4 / 2.0).abs() < 1e-9);
    assert!(dense.stiffness[7] == 0.0);
    assert!((frame.cell_strain[0][0].yy() - 1.1f64.ln()).abs() < 1e-14);
    let mut samples = Samples::default();
    let cell = CellId { block: 0, index: 0 };
    truss.sample(&at, &[cell], &mut samples).unwrap();
    let (rule, points) = samples.of(cell).unwrap();
    assert_eq!(points.len(), rule.npoint());
    let volume: f64 = points.iter().map(|p| p.volume).sum();
    assert!((volume - 0.8).abs() < 1e-15);
    for point in points {
        // of Green and Lagrange, in the axes of the start
        let across = 0.5 * (b2 - 1.0);
        let wanted = Sym3::diagonal(0.105, across, across);
        let off = (point.strain - wanted).to_pairs();
        assert!(off.iter().all(|d| d.abs() < 1e-9), "{:?}", point.strain);
        assert_eq!(point.mechanical_strain, point.strain);
        let off = (point.stress - stress).to_pairs();
        assert!(off.iter().all(|d| d.abs() < 1e-12 * cauchy));
    }
}
