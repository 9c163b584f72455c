//! Chains of springs and masses, whose eigenvalues are known in closed form.
#![allow(clippy::unwrap_used)]

use signorini_linear::sparsity::{BlockPattern, NONE, Pattern};
use signorini_linear::{Mode, Modes, Problem, Symmetry, Values, Wanted, apply, lowest_modes};
use std::f64::consts::PI;

/// Chains of `n` springs each of stiffness and mass 1, next to one another; the first node of each may be held.
struct Chains {
    n: usize,
    chains: usize,
    is_held: bool,
    /// Multipliers that join the last node of each chain with the first of the next.
    joints: bool,
}

struct Assembled {
    bulk: BlockPattern,
    interface: Pattern,
    stiffness: [Vec<f64>; 2],
    mass: [Vec<f64>; 2],
    equation: Vec<u32>,
    sign: Vec<i8>,
    coordinates: Vec<[f64; 3]>,
}

impl Chains {
    fn assemble(&self) -> Assembled {
        let per = self.n + 1;
        let nnode = per * self.chains;
        let njoint = if self.joints { self.chains - 1 } else { 0 };
        let springs = (0..self.chains).flat_map(|c| (0..self.n).map(move |i| (c * per + i) as u32));
        let nodes: Vec<u32> = springs.clone().flat_map(|i| [i, i + 1]).collect();
        let offsets: Vec<usize> = (0..=nodes.len() / 2).map(|k| 2 * k).collect();
        let bulk = BlockPattern::from_cliques(nnode, 1, &nodes, &offsets);
        let joint = |j: usize| {
            let end = ((j + 1) * per - 1) as u32;
            [end, end + 1, (nnode + j) as u32]
        };
        let dofs: Vec<u32> = (0..njoint).flat_map(joint).collect();
        let offsets: Vec<usize> = (0..=njoint).map(|k| 3 * k).collect();
        let interface = Pattern::from_cliques(nnode + njoint, &dofs, &offsets);
        let [mut k, mut m] = [0; 2].map(|_| vec![0.0; bulk.nvalue()]);
        for i in springs {
            for (row, column, of_k, of_m) in [
                (0, 0, 1.0, 2.0),
                (0, 1, -1.0, 1.0),
                (1, 0, -1.0, 1.0),
                (1, 1, 1.0, 2.0),
            ] {
                let at = bulk.position(i + row, i + column).unwrap();
                k[at] += of_k;
                m[at] += of_m / 6.0;
            }
        }
        let mut coupling = vec![0.0; interface.nentry()];
        for j in 0..njoint {
            let [a, b, l] = joint(j);
            for (row, column, value) in [(a, l, 1.0), (l, a, 1.0), (b, l, -1.0), (l, b, -1.0)] {
                coupling[interface.position(row, column).unwrap()] = value;
            }
        }
        let held = |dof: usize| self.is_held && dof < nnode && dof.is_multiple_of(per);
        let mut equation = Vec::new();
        let mut sign = Vec::new();
        for dof in 0..nnode + njoint {
            if held(dof) {
                equation.push(NONE);
            } else {
                equation.push(sign.len() as u32);
                sign.push(if dof < nnode { 1 } else { -1 });
            }
        }
        Assembled {
            stiffness: [k, coupling],
            mass: [m, vec![0.0; interface.nentry()]],
            coordinates: (0..nnode).map(|i| [i as f64, 0.0, 0.0]).collect(),
            bulk,
            interface,
            equation,
            sign,
        }
    }
}

impl Assembled {
    fn modes(&self, wanted: Wanted) -> Modes {
        let problem = Problem {
            ndof: self.equation.len(),
            bulk: &self.bulk,
            interface: &self.interface,
            fields: &[],
            equation: &self.equation,
            nequation: self.sign.len(),
            symmetry: match self.interface.nentry() {
                0 => Symmetry::Definite,
                _ => Symmetry::Symmetric,
            },
            sign: &self.sign,
            coordinates: &self.coordinates,
            between: &[],
        };
        let [stiffness, mass] =
            [&self.stiffness, &self.mass].map(|[bulk, interface]| Values { bulk, interface });
        lowest_modes(&problem, [stiffness, mass], wanted).unwrap()
    }
}

/// Of a chain with the wave number `x` per spring.
fn eigenvalue(x: f64) -> f64 {
    6.0 * (1.0 - x.cos()) / (2.0 + x.cos())
}

fn lowest(count: usize) -> Wanted {
    Wanted { count, from: None }
}

fn agrees(found: &Modes, wanted: &[f64], tolerance: f64) {
    assert_eq!(found.modes.len(), wanted.len());
    assert!(found.is_counted);
    for (mode, wanted) in found.modes.iter().zip(wanted) {
        let off = (mode.eigenvalue - wanted).abs();
        assert!(
            off <= tolerance * wanted.abs().max(1e-4),
            "{} {wanted}",
            mode.eigenvalue
        );
        assert!(mode.has_converged(), "{} {}", mode.residual, mode.rounding);
    }
}

#[test]
fn a_held_chain_has_the_frequencies_of_its_closed_form() {
    for n in [1, 2, 5, 100, 1000] {
        let chain = Chains {
            n,
            chains: 1,
            is_held: true,
            joints: false,
        };
        let count = n.min(10);
        let wave = |k: usize| (2 * k + 1) as f64 * PI / (2 * n) as f64;
        let wanted: Vec<f64> = (0..count).map(|k| eigenvalue(wave(k))).collect();
        agrees(&chain.assemble().modes(lowest(count)), &wanted, 1e-9);
    }
}

/// Seven equal chains: more than a block has vectors.
#[test]
fn eigenvalues_that_occur_often_are_all_found() {
    let chains = Chains {
        n: 60,
        chains: 7,
        is_held: true,
        joints: false,
    };
    let wave = |k: usize| (2 * (k / 7) + 1) as f64 * PI / 120.0;
    let wanted: Vec<f64> = (0..16).map(|k| eigenvalue(wave(k))).collect();
    agrees(&chains.assemble().modes(lowest(16)), &wanted, 1e-9);
}

#[test]
fn free_chains_have_rigid_motions_first() {
    for chains in [1, 4] {
        let free = Chains {
            n: 80,
            chains,
            is_held: false,
            joints: false,
        };
        let wave = |k: usize| (k / chains) as f64 * PI / 80.0;
        let wanted: Vec<f64> = (0..10).map(|k| eigenvalue(wave(k))).collect();
        agrees(&free.assemble().modes(lowest(10)), &wanted, 1e-8);
    }
}

#[test]
fn chains_that_multipliers_join_are_one() {
    for is_held in [true, false] {
        let joined = Chains {
            n: 40,
            chains: 3,
            is_held: false,
            joints: true,
        };
        let mut assembled = joined.assemble();
        if is_held {
            assembled.equation[0] = NONE;
            assembled.equation.iter_mut().skip(1).for_each(|e| *e -= 1);
            assembled.sign.remove(0);
        }
        let wave = |k: usize| match is_held {
            true => (2 * k + 1) as f64 * PI / 240.0,
            false => k as f64 * PI / 120.0,
        };
        let wanted: Vec<f64> = (0..8).map(|k| eigenvalue(wave(k))).collect();
        agrees(&assembled.modes(lowest(8)), &wanted, 1e-8);
    }
}

#[test]
fn modes_may_begin_above_an_eigenvalue() {
    let chain = Chains {
        n: 200,
        chains: 2,
        is_held: true,
        joints: false,
    };
    let wave = |k: usize| (2 * (k / 2) + 1) as f64 * PI / 400.0;
    let all: Vec<f64> = (0..40).map(|k| eigenvalue(wave(k))).collect();
    let from = 0.5 * (all[19] + all[20]);
    let wanted = Wanted {
        count: 12,
        from: Some(from),
    };
    agrees(&chain.assemble().modes(wanted), &all[20..32], 1e-9);
}

/// An unstable spring lowers one eigenvalue below zero.
#[test]
fn eigenvalues_below_zero_come_first() {
    let chain = Chains {
        n: 50,
        chains: 1,
        is_held: true,
        joints: false,
    };
    let mut assembled = chain.assemble();
    let end = assembled.bulk.position(50, 50).unwrap();
    assembled.stiffness[0][end] -= 0.5;
    let found = assembled.modes(lowest(5));
    assert!(found.is_counted && found.modes[0].eigenvalue < -0.1);
    assert!(found.modes[1].eigenvalue > 0.0);
    assert!(found.modes.iter().all(Mode::has_converged));
}

#[test]
fn modes_are_orthonormal_in_the_mass() {
    let chains = Chains {
        n: 60,
        chains: 5,
        is_held: true,
        joints: false,
    };
    let assembled = chains.assemble();
    let found = assembled.modes(lowest(12));
    let full = |shape: &[f64]| -> Vec<f64> {
        let value = |e: &u32| shape.get(*e as usize).copied().unwrap_or_default();
        assembled.equation.iter().map(value).collect()
    };
    let mass = Values {
        bulk: &assembled.mass[0],
        interface: &[],
    };
    for (i, a) in found.modes.iter().enumerate() {
        let a = full(&a.shape);
        let mut of_m = vec![0.0; a.len()];
        apply(&assembled.bulk, &assembled.interface, &mass, &a, &mut of_m);
        for (j, b) in found.modes.iter().enumerate() {
            let product: f64 = full(&b.shape).iter().zip(&of_m).map(|(b, m)| b * m).sum();
            let wanted = f64::from(u8::from(i == j));
            assert!((product - wanted).abs() < 1e-12, "{i} {j} {product}");
        }
    }
}
