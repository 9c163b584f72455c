//! Several cells at once against one cell after the other.

use super::derivatives::Viscous;
use super::*;

/// A law that is asked for what another answers, and hides of it what lets cells be worked on together.
pub(super) struct Hidden {
    pub law: Box<dyn Material>,
    pub is_symmetric: bool,
}

impl Material for Hidden {
    fn nhistory(&self) -> usize {
        self.law.nhistory()
    }

    fn start(&self, history: &mut [f64]) {
        self.law.start(history);
    }

    fn respond(
        &self,
        strain: &Strain,
        old: &[f64],
        new: &mut [f64],
        order: MaterialOrder,
        out: &mut Response,
    ) -> Result<(), MaterialError> {
        self.law.respond(strain, old, new, order, out)
    }

    fn modulus(&self) -> f64 {
        self.law.modulus()
    }

    fn is_symmetric(&self) -> bool {
        self.is_symmetric
    }
}

/// Distorted cells of one type, which share no node.
pub(super) fn cells(element: Element, count: usize) -> Mesh {
    let mut mesh = Mesh::default();
    let size = if element.nnode() > 8 { 0.05 } else { 0.1 };
    for cell in 0..count {
        let first = mesh.points.len();
        for (i, xi) in element.nodes().iter().enumerate() {
            let seed = 3 * (first + i);
            let moved = Vec3::new(noise(seed), noise(seed + 1), noise(seed + 2));
            mesh.points.push(*xi + moved * size);
            mesh.node_labels.push((first + i) as u64 + 1);
        }
        let nodes: Vec<u32> = (first as u32..mesh.points.len() as u32).collect();
        mesh.push_cell(element, &nodes, cell as u64 + 1);
    }
    mesh
}

fn largest_difference(a: &[f64], b: &[f64]) -> f64 {
    assert_eq!(a.len(), b.len());
    let pairs = a.iter().zip(b);
    pairs.fold(0.0, |most, (a, b)| (a - b).abs().max(most))
}

/// The energy of a body from its samples, one cell after the other.
fn sampled_energy(body: &Body, u: &[f64], mesh: &Mesh) -> f64 {
    let cells: Vec<_> = mesh.cells(3).collect();
    let mut samples = crate::system::Samples::default();
    let state = body.state(u);
    body.solid.sample(&state, &cells, &mut samples).unwrap();
    let of_cell = |cell: &CellId| samples.of(*cell).unwrap().1.iter();
    let points = cells.iter().flat_map(of_cell);
    points.map(|s| s.energy * s.volume).sum()
}

#[test]
fn cells_in_lanes_have_the_forces_stiffness_and_energy_of_cells_alone() {
    type Make = fn() -> Box<dyn Material>;
    let laws: [(&str, Make); 4] = [
        ("linear", || elastic("linear-elastic", 0.3)),
        ("hyperelastic", || elastic("neo-hookean", 0.4)),
        ("plastic", derivatives::plastic),
        ("with history", || Box::new(Viscous)),
    ];
    for element in of_dimension(3) {
        // more than one register holds, and lanes that stay empty
        let mesh = cells(element, 11);
        for kinematics in [Kinematics::Small, Kinematics::Finite] {
            for (law, make) in &laws {
                let what = format!("{} {kinematics:?} {law}", element.name());
                let wish = Wish::plain(Idealisation::Space, kinematics);
                let of = |law| body(&mesh, law, &wish).unwrap();
                let hide = |is_symmetric| {
                    let law = make();
                    of(Box::new(Hidden { law, is_symmetric }))
                };
                let alone = hide(false);
                let u: Vec<f64> = (0..alone.layout.ndof()).map(|k| 0.02 * noise(k)).collect();
                let mut work = Work::default();
                let right = alone.assemble(&u, Order::Tangent, &mut work);
                let energy = sampled_energy(&alone, &u, &mesh);
                let force = right.force.iter().fold(0.0f64, |most, f| most.max(f.abs()));
                // as it is, and without constants of a linear law
                for together in [of(make()), hide(true)] {
                    let mut work = Work::default();
                    let found = together.assemble(&u, Order::Tangent, &mut work);
                    let off = largest_difference(&found.stiffness, &right.stiffness);
                    assert!(
                        off < 1e-13 * right.scale(),
                        "{what}: stiffness off by {off:e}"
                    );
                    let off = largest_difference(&found.force, &right.force);
                    assert!(off < 1e-12 * force, "{what}: force off by {off:e}");
                    let residual = together.assemble(&u, Order::Residual, &mut work);
                    assert_eq!(residual.force, found.force, "{what}");
                    let off = (together.energy(&u, &mut work) - energy).abs();
                    assert!(off < 1e-12 * energy, "{what}: energy off by {off:e}");
                }
            }
        }
    }
}

#[test]
fn every_lane_has_the_history_temperature_and_start_of_its_cell() {
    let hex8 = element::by_name("hex8").unwrap();
    let mesh = cells(hex8, 7);
    let space = Idealisation::Space;
    let all: Vec<_> = mesh.cells(3).collect();
    // each cell its own stress at the start, at one of its points
    let initial = all.iter().zip(1..).map(|(&cell, k)| {
        let stress = Sym3::new(0.3, -0.2, 0.1, 0.05, 0.0, -0.1) * f64::from(k);
        AtStart {
            cell,
            point: 3,
            stress,
            strain: Sym3::ZERO,
        }
    });
    let initial: Vec<AtStart> = initial.collect();
    for kinematics in [Kinematics::Small, Kinematics::Finite] {
        let of = |is_symmetric| {
            let law: Box<dyn Material> = Box::new(Expanding::new(Box::new(Viscous), 1e-3, 0.0));
            let wish = Wish::plain(space, kinematics);
            let plain = body(&mesh, elastic("linear-elastic", 0.3), &wish).unwrap();
            let warm = |by: f64| (0..mesh.nnode()).map(|k| by * noise(900 + k)).collect();
            let field = NodalField {
                ends: vec![warm(2.0), warm(15.0)],
            };
            let mut solid = Solid::new(SolidParts {
                name: "body",
                mesh: &mesh,
                reference: plain.reference.clone(),
                cells: &all,
                layout: plain.layout,
                space,
                profile: None,
                material: Box::new(Hidden { law, is_symmetric }),
                integration: Integration::Full,
                locking: Locking::None,
                temperature: Some(Arc::new(field)),
                linear_temperatures: false,
                at_nodes: Default::default(),
                initial: &initial,
                axes: None,
                directors: &crate::system::Directors::default(),
            });
            if let Ok(solid) = &mut solid {
                solid.set_kinematics(kinematics);
            }
            let mut body = Body {
                solid: solid.unwrap(),
                ..plain
            };
            let n = body.layout.ndof();
            let u: Vec<f64> = (0..n).map(|k| 0.02 * noise(k)).collect();
            let before = body.state(&u);
            body.solid.accept(&before).unwrap();
            body
        };
        let [together, alone] = [true, false].map(of);
        let n = alone.layout.ndof();
        let u: Vec<f64> = (0..n).map(|k| 0.02 * noise(300 + k)).collect();
        let mut work = Work::default();
        let right = alone.assemble(&u, Order::Tangent, &mut work);
        let found = together.assemble(&u, Order::Tangent, &mut work);
        let off = largest_difference(&found.stiffness, &right.stiffness);
        assert!(off < 1e-13 * right.scale(), "stiffness off by {off:e}");
        let off = largest_difference(&found.force, &right.force);
        assert!(off < 1e-12 * right.scale(), "force off by {off:e}");
        // undeformed, at the first temperature and without history: the initial state stays
        let zero = vec![0.0; n];
        let [found, right] = [&together, &alone].map(|body| {
            let mut dense = Dense {
                force: zero.clone(),
                stiffness: vec![0.0; n * n],
            };
            for chunk in 0..body.solid.nchunk() {
                let outcome = body.solid.add_initial(chunk, &mut work, &mut dense);
                outcome.unwrap();
            }
            dense
        });
        let off = largest_difference(&found.stiffness, &right.stiffness);
        assert!(off < 1e-13 * right.scale(), "at the start off by {off:e}");
    }
}

#[test]
fn of_several_cells_the_one_that_is_turned_inside_out_is_named() {
    let mesh = cells(element::by_name("hex8").unwrap(), 6);
    let wish = Wish::plain(Idealisation::Space, Kinematics::Finite);
    let body = body(&mesh, elastic("linear-elastic", 0.3), &wish).unwrap();
    let mut u = vec![0.0; body.layout.ndof()];
    for (node, x) in mesh.points.iter().enumerate().skip(4 * 8).take(8) {
        u[3 * node + 2] = -2.0 * x.z;
    }
    let outcome = body.solid.energy(0, &body.state(&u), &mut Work::default());
    assert!(matches!(
        outcome,
        Err(TermError::Inverted { element: 5, .. })
    ));
}
