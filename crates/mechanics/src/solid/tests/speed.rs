//! How fast stiffness is assembled.

use super::*;
use std::time::Instant;

/// A block of `n × n × n` hexahedra, slightly distorted.
fn block(n: usize) -> Mesh {
    let mut mesh = Mesh::default();
    let side = n + 1;
    for k in 0..side * side * side {
        let at = Vec3::new(
            (k % side) as f64,
            (k / side % side) as f64,
            (k / side / side) as f64,
        );
        let jitter = Vec3::new(noise(3 * k), noise(3 * k + 1), noise(3 * k + 2));
        mesh.points.push(at + jitter * 0.1);
        mesh.node_labels.push(k as u64 + 1);
    }
    let hex = element::by_name("hex8").unwrap();
    for cell in 0..n * n * n {
        let corner = cell % n + (cell / n % n) * side + cell / n / n * side * side;
        let ring = [0, 1, side + 1, side];
        let nodes: Vec<u32> = ring
            .iter()
            .chain(&ring.map(|o| o + side * side))
            .map(|o| (corner + o) as u32)
            .collect();
        mesh.push_cell(hex, &nodes, cell as u64 + 1);
    }
    mesh
}

#[test]
#[ignore = "a measurement: prints hexahedra per second on this thread"]
fn measure_hexahedra_per_second() {
    let mesh = block(24);
    let cells: Vec<_> = mesh.cells(3).collect();
    let layout = Layout::new(3, mesh.nnode(), 0);
    let reference: Arc<[Vec3]> = mesh.points.clone().into();
    let measured = [
        (false, Locking::None),
        (true, Locking::None),
        (false, Locking::Auto),
    ];
    for (nonlinear, locking) in measured {
        let solid = Solid::new(SolidParts {
            name: "block",
            mesh: &mesh,
            reference: reference.clone(),
            cells: &cells,
            layout,
            space: Idealisation::Space,
            profile: None,
            material: (TABLE[1].make)(&Constants::elastic(500.0, 0.3)).unwrap(),
            integration: Integration::Full,
            locking,
            temperature: None,
            linear_temperatures: false,
            at_nodes: Default::default(),
            initial: &[],
            axes: None,
            directors: &crate::system::Directors::default(),
        });
        let mut solid = solid.unwrap();
        solid.set_kinematics(if nonlinear {
            Kinematics::Finite
        } else {
            Kinematics::Small
        });
        let u: Vec<f64> = (0..layout.ndof()).map(|k| 0.02 * noise(k)).collect();
        let state = state(&layout, &reference, &u);
        struct Nothing;
        impl Sink for Nothing {
            fn add(&mut self, _: &[Dof], _: &[f64], _: &[f64]) {}

            fn add_symmetric(&mut self, _: &[Dof], _: &[f64], _: &[f64], _: usize) {}

            fn couple(&mut self, _: &[Dof], _: &[Dof], _: &[f64]) {}

            fn uncertain(&mut self, _: &[Dof], _: f64) {}
        }
        let mut work = Work::default();
        let alone = best_of(40, || {
            for chunk in 0..solid.nchunk() {
                let order = Order::Tangent;
                solid
                    .evaluate(chunk, &state, order, &mut work, &mut Nothing)
                    .unwrap();
            }
        });
        let terms: Vec<Box<dyn Term>> = vec![Box::new(solid)];
        let elimination = Elimination::default();
        let mut assembler = Assembler::new(&layout, &elimination, &terms);
        let mut out = Assembly::default();
        let whole = best_of(40, || {
            let order = Order::Tangent;
            assembler
                .assemble(&layout, &elimination, &terms, &state, order, &mut out)
                .unwrap();
        });
        let n = cells.len() as f64;
        println!(
            "nonlinear {nonlinear}, locking {locking}: {:.0} hex8/s assembled, {:.0} hex8/s evaluated",
            n / whole,
            n / alone
        );
    }
}

/// The shortest of several times, in seconds.
fn best_of(count: usize, mut run: impl FnMut()) -> f64 {
    let timed = (0..count).map(|_| {
        let begin = Instant::now();
        run();
        begin.elapsed().as_secs_f64()
    });
    timed.fold(f64::MAX, f64::min)
}
