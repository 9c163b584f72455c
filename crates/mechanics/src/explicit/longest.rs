//! The longest short increment that is stable.
//!
//! ```text
//! h < 2/ω        ω² ≤ max_e λ(K_e, D_e) + max_i Σ_j |K_ij|/m_i        D_e,i = m_i K_e,ii/Σ_e K_e,ii   (E1)
//! ```
//!
//! with the stiffness `K_e` of elements, each with a part of the mass of its nodes that goes by its part of their stiffness, and
//! the rows of contacts and springs, node by node. Elements whose stiffness damps by the time `b` count as those without damping that
//! ask for the same increment,
//!
//! ```text
//! 4 = h² λ + 2 h b λ        by λ (√(1 + ξ²) + ξ)², ξ = ½ b √λ                                       (E2)
//! ```
//!
//! Nothing is assembled. Both parts are bounds: the Rayleigh quotient of a sum is at
//! most the sum of the largest, whatever parts the mass is taken in, and unknowns that follow others, or are held, only lower it.
//! Elements whose material has yielded are as stiff as at the start when they are unloaded: of both, and what they are shortened by
//! counts. Rows that are open count as closed as soon as they can close before the next look.
//!
//! Sources: Hughes, The Finite Element Method, 1987, section 9.1; Fried, J. Sound Vib. 22, 1972 (elements bound the whole).

use super::bodies::Bodies;
use crate::system::{
    Acts, Dof, Layout, NearRow, NodeId, Order, Part, Role, Sink, State, System, Term, TermError,
    Work,
};
use rayon::prelude::*;

/// Iterations of the power method, at most, and the change of an eigenvalue at which it ends.
const POWERS: usize = 60;
const SETTLED: f64 = 1e-3;

/// `(v + a ω)² ≤ 2 v² + 2 a² ω²`: what a body's translation and rotation have of a force are bounded apart.
const APART: f64 = 2.0;

/// Columns of a participant of a row that are directions.
const DIRECTIONS: usize = 3;

/// What there is to a bound.
pub struct Bound<'a> {
    pub system: &'a System,
    /// The mass of each node.
    pub of_nodes: &'a [f64],
    pub bodies: &'a Bodies,
    pub prescribed: &'a [bool],
}

/// Contributions of a chunk.
#[derive(Default)]
struct Elements {
    /// Dofs and full stiffness of each.
    dofs: Vec<Dof>,
    stiffness: Vec<f64>,
    ends: Vec<usize>,
}

impl Sink for Elements {
    fn add(&mut self, dofs: &[Dof], _: &[f64], stiffness: &[f64]) {
        self.dofs.extend_from_slice(dofs);
        self.stiffness.extend_from_slice(stiffness);
        self.ends.push(self.dofs.len());
    }

    fn couple(&mut self, _: &[Dof], _: &[Dof], _: &[f64]) {}

    fn uncertain(&mut self, _: &[Dof], _: f64) {}
}

impl Elements {
    /// The elements: their dofs, and stiffness row by row.
    fn each(&self, mut take: impl FnMut(&[Dof], &[f64])) {
        let (mut first, mut at) = (0, 0);
        for &end in &self.ends {
            let n = end - first;
            let dofs = self.dofs.get(first..end);
            let stiffness = self.stiffness.get(at..at + n * n);
            if let Some((dofs, stiffness)) = dofs.zip(stiffness) {
                take(dofs, stiffness);
                at += n * n;
            }
            first = end;
        }
    }

    fn clear(&mut self) {
        self.dofs.clear();
        self.stiffness.clear();
        self.ends.clear();
    }
}

/// The largest eigenvalues of elements at the start, chunk by chunk.
#[derive(Default)]
pub struct Initial(Vec<Vec<f64>>);

/// Adds the elements of a chunk of a term.
type Evaluate<'a> =
    dyn Fn(&dyn Term, usize, &mut Work, &mut Elements) -> Result<(), TermError> + Sync + 'a;

/// Adds their stiffness at a state.
fn tangent(
    state: &State,
) -> impl Fn(&dyn Term, usize, &mut Work, &mut Elements) -> Result<(), TermError> + Sync {
    |term, chunk, work, out| term.evaluate(chunk, state, Order::Tangent, work, out)
}

/// What one thread needs.
#[derive(Default)]
struct Scratch {
    work: Work,
    elements: Elements,
    vectors: [Vec<f64>; 3],
}

/// The eigenvalue without damping that asks for the same increment as this one with it (E2).
fn damped(eigenvalue: f64, retardation: f64) -> f64 {
    let part = 0.5 * retardation * eigenvalue.sqrt();
    let factor = part.hypot(1.0) + part;
    eigenvalue * factor * factor
}

/// The inverse of [`damped`].
fn undamped(eigenvalue: f64, retardation: f64) -> f64 {
    eigenvalue / (1.0 + retardation * eigenvalue.sqrt())
}

impl Bound<'_> {
    /// The mass that each node lacks so that no element has a frequency above this, squared: of an element, masses in the
    /// proportion of `Σ_j |K_ij|` are those that its largest eigenvalue asks for.
    pub fn lacking(&self, state: &State, most: f64) -> Result<Vec<f64>, TermError> {
        let masses = self.masses();
        let diagonal = self.diagonal(&tangent(state))?;
        let layout = &self.system.layout;
        let mut lacking = vec![0.0; layout.nnode()];
        let mut scratch = Scratch::default();
        let (mut sums, mut wholes) = (vec![0.0; masses.len()], vec![0.0; masses.len()]);
        let mut of_nodes: Vec<(NodeId, f64)> = Vec::new();
        for (term, chunk) in self.chunks(Part::Bulk) {
            let Scratch {
                work,
                elements,
                vectors,
            } = &mut scratch;
            elements.clear();
            term.evaluate(chunk, state, Order::Tangent, work, elements)?;
            let most = undamped(most, term.properties().retardation);
            elements.each(|dofs, stiffness| {
                let of_element = (dofs, stiffness);
                if self.eigenvalue(of_element, [&masses, &diagonal], vectors) <= most {
                    return;
                }
                let n = dofs.len();
                let lines = || dofs.iter().zip(stiffness.chunks_exact(n)).enumerate();
                for (k, (&dof, row)) in lines() {
                    let own = row.get(k).copied().unwrap_or_default();
                    let is_held = self.prescribed.get(dof as usize) == Some(&true);
                    let sum = row.iter().map(|k| k.abs()).sum();
                    // all of its mass, and all of its stiffness
                    put(&mut sums, dof, if is_held { f64::INFINITY } else { sum });
                    put(&mut wholes, dof, own);
                }
                let wanted = self.eigenvalue(of_element, [&sums, &wholes], vectors) / most;
                of_nodes.clear();
                for (k, (&dof, row)) in lines() {
                    let name = layout.name(dof).and_then(|name| name.displacement());
                    let at = |values: &[f64]| values.get(dof as usize).copied().unwrap_or_default();
                    let (mass, whole, sum) = (at(&masses), at(&diagonal), at(&sums));
                    let own = row.get(k).copied().unwrap_or_default();
                    let Some((node, _)) = name.filter(|_| sum.is_finite() && whole > 0.0) else {
                        continue;
                    };
                    let lacks = wanted * sum - mass * own / whole;
                    match of_nodes.iter_mut().find(|of| of.0 == node) {
                        // a mass has no direction
                        Some((_, most)) => *most = most.max(lacks),
                        None => of_nodes.push((node, lacks)),
                    }
                }
                for &(node, lacks) in of_nodes.iter().filter(|of| of.1 > 0.0) {
                    if let Some(to) = lacking.get_mut(node as usize) {
                        *to += lacks;
                    }
                }
            });
        }
        Ok(lacking)
    }

    /// The mass of each unknown, whatever follows what; infinite where it is prescribed.
    fn masses(&self) -> Vec<f64> {
        let layout = &self.system.layout;
        let mut masses = vec![0.0; layout.nmotion()];
        for (node, &mass) in (0..).zip(self.of_nodes) {
            for axis in 0..layout.ndim() {
                put(&mut masses, layout.node(node, axis), mass);
            }
        }
        for body in &self.bodies.of {
            let about = body.mass().inertia;
            let own = body.mass().mass;
            let values = [own, own, own, about.xx(), about.yy(), about.zz()];
            for (&dof, value) in body.dofs.iter().zip(values) {
                put(&mut masses, dof, value);
            }
        }
        for (mass, prescribed) in masses.iter_mut().zip(self.prescribed) {
            if *prescribed {
                *mass = f64::INFINITY;
            }
        }
        masses
    }

    /// The chunks of all terms that resist, contacts that are not joined excepted, whose stiffness belongs to a part.
    fn chunks(&self, part: Part) -> impl Iterator<Item = (&dyn Term, usize)> {
        let terms = self.system.terms.iter().map(AsRef::as_ref);
        let resists = move |term: &&dyn Term| {
            let of = term.properties();
            let is_contact = term.capabilities().impulsive.is_some();
            of.role == Role::Internal && of.part == part && !is_contact
        };
        terms
            .filter(resists)
            .flat_map(|term| (0..term.nchunk()).map(move |chunk| (term, chunk)))
    }

    /// Σ_e K_e,ii of elements.
    fn diagonal(&self, evaluate: &Evaluate<'_>) -> Result<Vec<f64>, TermError> {
        let mut diagonal = vec![0.0; self.system.layout.nmotion()];
        let mut scratch = Scratch::default();
        for (term, chunk) in self.chunks(Part::Bulk) {
            let Scratch { work, elements, .. } = &mut scratch;
            elements.clear();
            evaluate(term, chunk, work, elements)?;
            elements.each(|dofs, stiffness| {
                for (dof, k) in dofs.iter().zip(stiffness.iter().step_by(dofs.len() + 1)) {
                    if let Some(to) = diagonal.get_mut(*dof as usize) {
                        *to += k.abs();
                    }
                }
            });
        }
        Ok(diagonal)
    }

    /// The initial stiffness of all elements: materials with a history may be softer now than when they are unloaded.
    pub fn initial(&self) -> Result<Initial, TermError> {
        let masses = self.masses();
        let evaluate = |term: &dyn Term, chunk, work: &mut Work, out: &mut Elements| {
            let initial = term.capabilities().initial_stiffness;
            initial.map_or(Ok(()), |of| of.add_initial(chunk, work, out))
        };
        let diagonal = self.diagonal(&evaluate)?;
        Ok(Initial(self.each_chunk(
            &evaluate,
            |_, _, elements, vectors| {
                let mut all = Vec::new();
                elements.each(|dofs, stiffness| {
                    all.push(self.eigenvalue((dofs, stiffness), [&masses, &diagonal], vectors));
                });
                all
            },
        )?))
    }

    /// The part of elements in the square of a frequency (radian per time) that none exceeds in a state.
    pub fn of_elements(&self, state: &State, initial: &Initial) -> Result<f64, TermError> {
        let masses = self.masses();
        let diagonal = self.diagonal(&tangent(state))?;
        let ndim = self.system.layout.ndim();
        let all = self.each_chunk(&tangent(state), |number, term, elements, vectors| {
            let retardation = term.properties().retardation;
            let mut unloaded = initial.0.get(number).into_iter().flatten();
            let mut nodes: Vec<NodeId> = Vec::new();
            let mut largest = 0.0_f64;
            elements.each(|dofs, stiffness| {
                let own = self.eigenvalue((dofs, stiffness), [&masses, &diagonal], vectors);
                let before = unloaded.next().copied().unwrap_or_default();
                let node = |dof: &Dof| Some(self.system.layout.name(*dof)?.displacement()?.0);
                nodes.clear();
                nodes.extend(dofs.iter().step_by(ndim.max(1)).filter_map(node));
                let own = own.max(before * self.shortened(&nodes, state));
                largest = largest.max(damped(own, retardation));
            });
            largest
        })?;
        Ok(all.into_iter().fold(0.0, f64::max))
    }

    /// What comes of each chunk of elements, in their order.
    fn each_chunk<T: Send>(
        &self,
        evaluate: &Evaluate<'_>,
        make: impl Fn(usize, &dyn Term, &Elements, &mut [Vec<f64>; 3]) -> T + Sync,
    ) -> Result<Vec<T>, TermError> {
        let chunks: Vec<(&dyn Term, usize)> = self.chunks(Part::Bulk).collect();
        let of_chunk =
            |scratch: &mut Scratch, (number, (term, chunk)): (usize, (&dyn Term, usize))| {
                let Scratch {
                    work,
                    elements,
                    vectors,
                } = scratch;
                elements.clear();
                evaluate(term, chunk, work, elements)?;
                Ok(make(number, term, elements, vectors))
            };
        let all = chunks.into_par_iter().enumerate();
        all.map_init(Scratch::default, of_chunk).collect()
    }

    /// The square of the most that the distance of two nodes of an element was longer at the start.
    fn shortened(&self, nodes: &[NodeId], state: &State) -> f64 {
        if state.is_small {
            return 1.0;
        }
        let place = |node: NodeId| {
            let node = node as usize;
            Some((*self.system.reference.get(node)?, *state.x.get(node)?))
        };
        let mut most = 1.0_f64;
        for (k, &node) in nodes.iter().enumerate() {
            for &other in nodes.iter().take(k) {
                if let (Some((a, x)), Some((b, y))) = (place(node), place(other)) {
                    let now = (x - y).norm_squared();
                    if now > 0.0 {
                        most = most.max((a - b).norm_squared() / now);
                    }
                }
            }
        }
        most
    }

    /// The square of the highest frequency of elements that are unloaded from a state: what changes fast of what is stable, without
    /// any stiffness of that state.
    pub fn unloaded(&self, state: &State, initial: &Initial) -> f64 {
        let chunks: Vec<(&dyn Term, usize)> = self.chunks(Part::Bulk).collect();
        let of_chunk = |(number, (term, chunk)): (usize, (&dyn Term, usize))| {
            let mut all = initial.0.get(number).into_iter().flatten();
            let (mut largest, retardation) = (0.0_f64, term.properties().retardation);
            if let Some(elementwise) = term.capabilities().elementwise {
                elementwise.elements(chunk, &mut |nodes| {
                    let own = all.next().copied().unwrap_or_default();
                    let own = own * self.shortened(nodes, state);
                    largest = largest.max(damped(own, retardation));
                });
            }
            largest
        };
        let all = chunks.into_par_iter().enumerate().map(of_chunk);
        all.reduce(|| 0.0, f64::max)
    }

    /// The largest |λ| of an element with its part of the masses, by the power method.
    fn eigenvalue(
        &self,
        (dofs, stiffness): (&[Dof], &[f64]),
        [masses, diagonal]: [&[f64]; 2],
        [scale, x, y]: &mut [Vec<f64>; 3],
    ) -> f64 {
        let n = dofs.len();
        scale.clear();
        scale.extend(dofs.iter().enumerate().map(|(k, &dof)| {
            let at = |values: &[f64]| values.get(dof as usize).copied().unwrap_or_default();
            let (whole, mass) = (at(diagonal), at(masses));
            let part = stiffness.get(k * (n + 1)).map_or(0.0, |k| k.abs());
            match mass.is_finite() && part > 0.0 {
                true => (whole / (mass * part)).sqrt(),
                false => 0.0,
            }
        }));
        x.clear();
        // no eigenvector of an element that is as even as its shape
        x.extend(scale.iter().enumerate().map(|(k, s)| match *s {
            0.0 => 0.0,
            _ => 1.0 + 0.37 * ((k * k + 3 * k) % 7) as f64,
        }));
        y.resize(n, 0.0);
        let mut found = 0.0;
        for _ in 0..POWERS {
            let length = x.iter().map(|x| x * x).sum::<f64>().sqrt();
            if length == 0.0 {
                return found;
            }
            x.iter_mut().for_each(|x| *x /= length);
            for ((row, y), s) in stiffness.chunks_exact(n.max(1)).zip(&mut *y).zip(&*scale) {
                let sum: f64 = row
                    .iter()
                    .zip(&*x)
                    .zip(&*scale)
                    .map(|((k, x), s)| k * x * s)
                    .sum();
                *y = s * sum;
            }
            std::mem::swap(x, y);
            let before = found;
            found = x.iter().map(|x| x * x).sum::<f64>().sqrt();
            if !found.is_finite() || (found - before).abs() <= SETTLED * found {
                break;
            }
        }
        found
    }

    /// The part of springs and of rows of contacts up to `reach`: the largest sum of a row over its mass.
    pub fn of_rows(&self, state: &State, reach: f64) -> Result<f64, TermError> {
        let masses = self.masses();
        let layout = &self.system.layout;
        let mut sums = vec![0.0; layout.nmotion()];
        let mut scratch = Scratch::default();
        for (term, chunk) in self.chunks(Part::Interface) {
            let Scratch { work, elements, .. } = &mut scratch;
            elements.clear();
            term.evaluate(chunk, state, Order::Tangent, work, elements)?;
            elements.each(|dofs, stiffness| {
                for (dof, row) in dofs.iter().zip(stiffness.chunks_exact(dofs.len().max(1))) {
                    if let Some(to) = sums.get_mut(*dof as usize) {
                        *to += row.iter().map(|k| k.abs()).sum::<f64>();
                    }
                }
            });
        }
        for term in &self.system.terms {
            if let Some(contact) = term.capabilities().impulsive {
                contact.near_rows(state, reach, &mut |row| add_row(row, layout, &mut sums))?;
            }
        }
        let (elimination, mut shared) = (&self.system.elimination, vec![0.0; sums.len()]);
        // what acts on a node that follows others acts on these
        for (dof, &sum) in (0..).zip(&sums).filter(|(_, sum)| **sum > 0.0) {
            let is_own = !elimination.depends(dof, layout);
            elimination.terms(dof, state, layout, &mut |to, c| {
                if let Some(shared) = shared.get_mut(to as usize) {
                    *shared += sum * if is_own { 1.0 } else { APART * c * c };
                }
            });
        }
        let over = shared.iter().zip(&masses).zip(self.prescribed);
        let over = over.filter(|((sum, mass), fixed)| **sum > 0.0 && **mass > 0.0 && !**fixed);
        Ok(over.fold(0.0, |most: f64, ((sum, mass), _)| most.max(sum / mass)))
    }
}

/// Adds |K_i| of a row, by directions of the participants.
fn add_row(row: &NearRow<'_>, layout: &Layout, sums: &mut [f64]) {
    let Acts::Stiff(stiffness) = row.acts else {
        return;
    };
    let size = |weights: &[f64]| weights.iter().map(|b| b * b).sum::<f64>().sqrt();
    let turns = |dofs: &[Dof]| {
        let mut names = dofs.iter().filter_map(|&dof| layout.name(dof));
        names.any(|name| name.rotation().is_some())
    };
    let columns = || {
        row.dofs
            .chunks(DIRECTIONS)
            .zip(row.weights.chunks(DIRECTIONS))
    };
    let moved = columns().filter(|(dofs, _)| !turns(dofs));
    let whole: f64 = moved.map(|(_, weights)| size(weights)).sum();
    for (dofs, weights) in columns() {
        let own = match turns(dofs) {
            true => APART * size(weights) * size(weights),
            false => size(weights) * whole,
        };
        for &dof in dofs {
            if let Some(to) = sums.get_mut(dof as usize) {
                *to += own * stiffness * row.measure;
            }
        }
    }
}

fn put(values: &mut [f64], dof: Dof, value: f64) {
    if let Some(to) = values.get_mut(dof as usize) {
        *to = value;
    }
}
