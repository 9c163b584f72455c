use super::heat;
use super::{BodyKind, BodyPart, Context, LockingSummary, ModelError, Parts, Unheld};
use crate::connector::Damper;
use crate::material::Kinematics;
use crate::solid::{Solid, SolidParts, Truss, TrussParts};
use crate::solve::Step;
use crate::system::{Course, Directors, Dof, Idealisation, NO_DOF, NodalField, Term};
use signorini_geometry::mesh::{CellId, Mesh, NodeId};
use signorini_geometry::tensor::{Mat3, Sym3, Vec3};
use std::collections::{BTreeSet, HashMap};
use std::sync::Arc;

type Terms = Vec<Box<dyn Term>>;

/// The body of each cell.
pub(super) fn owners(
    mesh: &Mesh,
    bodies: &[BodyPart],
) -> Result<HashMap<CellId, usize>, ModelError> {
    let mut owner: HashMap<CellId, usize> = HashMap::new();
    for (number, body) in bodies.iter().enumerate() {
        if body.cells.is_empty() {
            return Err(ModelError::EmptyBody {
                body: body.name.clone(),
            });
        }
        for &cell in &body.cells {
            if let Some(before) = owner.insert(cell, number) {
                return Err(ModelError::TwoBodies {
                    label: mesh.cell_label(cell).unwrap_or(0),
                    first: bodies[before].name.clone(),
                    second: body.name.clone(),
                });
            }
        }
    }
    Ok(owner)
}

/// The body of each node, `u32::MAX` where there is none, and the directors of all.
pub(super) fn nodes_by_body(parts: &Parts<'_>) -> (Vec<u32>, Directors) {
    let (mesh, bodies) = (parts.mesh, &parts.bodies);
    let directors = Directors::new(parts.directors.clone(), mesh.nnode());
    let mut of = vec![u32::MAX; mesh.nnode()];
    for (number, body) in bodies.iter().enumerate() {
        for &cell in &body.cells {
            for &node in mesh.cell(cell) {
                of[node as usize] = number as u32;
            }
            for node in directors.behind(mesh.cell(cell)) {
                of[node as usize] = number as u32;
            }
        }
    }
    (of, directors)
}

/// The corners that each node of quadratic cells is halfway between, `u32::MAX` where it is a corner; empty where there is
/// none that is not.
pub(super) fn between(mesh: &Mesh, bodies: &[BodyPart]) -> Vec<[u32; 2]> {
    const CORNER: [u32; 2] = [u32::MAX; 2];
    let cells = || {
        let all = bodies.iter().flat_map(|body| &body.cells);
        all.filter_map(|&cell| Some((mesh.element(cell)?, mesh.cell(cell))))
    };
    if !cells().any(|(element, _)| element.mid_nodes().next().is_some()) {
        return Vec::new();
    }
    let mut between = vec![CORNER; mesh.nnode()];
    for (element, nodes) in cells() {
        for (mid, [a, b]) in element.mid_nodes() {
            between[nodes[mid] as usize] = [nodes[a], nodes[b]];
        }
    }
    // a corner of another cell is one
    for (element, nodes) in cells() {
        for &node in &nodes[..element.ncorner()] {
            between[node as usize] = CORNER;
        }
    }
    between
}

/// Stiffness of the viscous forces on a body that only contact holds, over its modulus times its size ...
const DAMPING: f64 = 1e-3;
/// ... and over that of its bending, where that is softer: a plate would otherwise rest on them, and contact would be found
/// again whenever they are renewed. Measured with two plates of 1:100: 74 iterations with 1000, 35 with 10, 24 with 1.
const OF_BENDING: f64 = 0.1;

/// The stiffness of a body at these points against bending, over its modulus times its largest extent: that of a beam, or of
/// a plate, which is held at one end, `a³ b/(4 c⁴)` with the extents `a ≤ b ≤ c`, and `a³/(4 c³)` in the plane. The extents
/// are those of a block with the same second moments, so that it does not matter how the body lies.
fn bending(points: &[Vec3], ndim: usize) -> f64 {
    let count = points.len().max(1) as f64;
    let mean = points.iter().copied().sum::<Vec3>() / count;
    let moment = |away: Vec3| Sym3::symmetric_part(Mat3::outer(away, away));
    let moments = points.iter().map(|&x| moment(x - mean));
    let moments = moments.fold(Sym3::ZERO, |sum, m| sum + m * count.recip());
    let [largest, middle, smallest] = moments.eigenvalues().map(|m| (12.0 * m.max(0.0)).sqrt());
    if largest == 0.0 {
        return 1.0;
    }
    if ndim == 2 {
        return 0.25 * (middle / largest).powi(3);
    }
    0.25 * (smallest / largest).powi(3) * (middle / largest)
}

/// The names of bodies that are free, those together that are tied to each other.
fn tied(free: &[Unheld]) -> Vec<BTreeSet<&str>> {
    let mut tied: Vec<(BTreeSet<usize>, BTreeSet<&str>)> = Vec::new();
    for one in free {
        let mut together = BTreeSet::from([one.together]);
        let mut names: BTreeSet<&str> = one.bodies.iter().map(String::as_str).collect();
        // a body of several parts ties what its parts are tied to
        tied.retain(|(numbers, others)| {
            let apart = numbers.is_disjoint(&together) && others.is_disjoint(&names);
            if !apart {
                together.extend(numbers);
                names.extend(others);
            }
            apart
        });
        tied.push((together, names));
    }
    tied.into_iter().map(|(_, names)| names).collect()
}

impl Context<'_> {
    /// What holds the bodies that nothing but contact stops.
    pub(super) fn holds(&self, bodies: &[BodyPart], free: &[Unheld]) -> Option<Damper> {
        let ndim = self.layout.ndim();
        let part = |points: &[Vec3]| DAMPING.min(OF_BENDING * bending(points, ndim));
        let courses = tied(free).into_iter().map(|names| {
            let (unknowns, size) = self.viscous(bodies, &|name| names.contains(name), &part);
            let names: Vec<String> = names.iter().map(|name| format!("\"{name}\"")).collect();
            Course::new(names.join(" and "), size, unknowns)
        });
        let courses: Vec<Course> = courses
            .filter(|course| course.damped().next().is_some())
            .collect();
        (!courses.is_empty()).then(|| Damper::until_held("free bodies", courses))
    }

    /// What slows all bodies where the solver asks for it.
    pub(super) fn brake(&self, bodies: &[BodyPart]) -> Damper {
        let (mut unknowns, _) = self.viscous(bodies, &|_| true, &|_| 1.0);
        unknowns.retain(|(_, stiffness)| *stiffness > 0.0);
        Damper::when_asked("stabilization", unknowns)
    }

    /// The unknowns of bodies and carriers, and the stiffness at each: a part of the modulus times the size of a body,
    /// the same on each of its nodes, 0 where an unknown follows from others. The part follows from where the nodes are.
    /// Besides, the largest of these sizes.
    fn viscous(
        &self,
        bodies: &[BodyPart],
        named: &dyn Fn(&str) -> bool,
        part: &dyn Fn(&[Vec3]) -> f64,
    ) -> (Vec<(Dof, f64)>, f64) {
        let at = |n: &NodeId| self.reference.get(*n as usize).copied().unwrap_or_default();
        let softest = self.modulus.iter().flatten().copied();
        let softest = softest.reduce(f64::min).unwrap_or(1.0);
        let mut dofs: Vec<(Dof, f64)> = Vec::new();
        let mut largest = 0.0_f64;
        for (number, (body, modulus)) in bodies.iter().zip(self.modulus).enumerate() {
            let (Some(modulus), true) = (modulus, named(&body.name)) else {
                continue;
            };
            // ends of directors follow, and contact acts there; viscous forces act in the middle
            let with_middle = |&node: &NodeId| {
                let director = self.elimination.directors().at_end(node);
                [Some(node), director.map(|director| director.middle)]
            };
            let cells = body.cells.iter();
            let nodes = cells.flat_map(|&c| self.mesh.cell(c).iter().flat_map(with_middle));
            let nodes: BTreeSet<NodeId> = nodes.flatten().collect();
            let points: Vec<Vec3> = nodes.iter().map(at).collect();
            let extent = self.extent(self.spaces.of_body(number), points.iter().copied());
            let stiffness = part(&points) * modulus * extent / nodes.len() as f64;
            let of_node = |&n: &NodeId| (0..self.layout.ndim()).map(move |axis| (n, axis));
            let of_nodes = nodes.iter().flat_map(of_node);
            let own = of_nodes.map(|(n, axis)| self.layout.node(n, axis));
            let follows = |dof: Dof| self.elimination.depends(dof, &self.layout);
            dofs.extend(own.map(|d| (d, if follows(d) { 0.0 } else { stiffness })));
            largest = largest.max(extent);
        }
        for (number, carrier) in (0..).zip(self.carriers) {
            if !named(&carrier.name) {
                continue;
            }
            let size = self.extent(self.space, self.reference.iter().copied());
            let stiffness = part(&[]) * softest * size;
            for axis in 0..3 {
                dofs.push((self.layout.translation(number, axis), stiffness));
                dofs.push((self.layout.rotation(number, axis), stiffness * size * size));
            }
            dofs.retain(|d| d.0 != NO_DOF);
            largest = largest.max(size);
        }
        (dofs, largest)
    }

    /// The size of a body: the diagonal of its box in space, the extent across it in the plane.
    fn extent(&self, space: Idealisation, points: impl Iterator<Item = Vec3> + Clone) -> f64 {
        if self.layout.ndim() == 3 {
            let low = points.clone().fold(Vec3::from([f64::MAX; 3]), Vec3::min);
            let high = points.fold(Vec3::from([f64::MIN; 3]), Vec3::max);
            return (high - low).norm();
        }
        points.map(|x| space.extent(x)).fold(0.0, f64::max)
    }

    /// The terms of the bodies, and what was chosen against locking for the sizes of strains in these steps.
    pub(super) fn bodies(
        &self,
        bodies: Vec<BodyPart>,
        temperature: Option<Arc<NodalField>>,
        steps: &[Step],
    ) -> Result<(Terms, Vec<LockingSummary>), ModelError> {
        let sizes = &sizes_of_strain(steps.iter());
        let conserve = |step: &&Step| step.scheme.is_some_and(|scheme| scheme.conserves);
        let conserving = &sizes_of_strain(steps.iter().filter(conserve));
        let mut terms = Terms::new();
        let mut summaries = Vec::new();
        let deforms = steps.iter().any(|step| step.physics.moves);
        for body in bodies {
            let (name, cells) = (&*body.name, &*body.cells);
            let (mesh, layout) = (self.mesh, self.layout);
            let space = body.kind.space(self.space);
            let (reference, temperature) = (self.reference.clone(), temperature.clone());
            match body.kind {
                BodyKind::Solid {
                    material,
                    later,
                    mass,
                    profile,
                    integration,
                    locking,
                    linear_temperatures,
                    at_nodes,
                    initial,
                    axes,
                    heat,
                    ..
                } => {
                    let site = heat::Site::new(name, cells, space, profile.clone(), integration);
                    terms.extend(self.heat(site, heat.as_deref())?);
                    if !deforms {
                        continue;
                    }
                    let mut solid = Solid::new(SolidParts {
                        name,
                        mesh,
                        reference,
                        cells,
                        layout,
                        space,
                        profile,
                        material,
                        integration,
                        locking,
                        temperature,
                        linear_temperatures,
                        at_nodes,
                        initial: &initial,
                        axes: axes.map(|axes| *axes),
                        directors: self.elimination.directors(),
                    })?;
                    solid.set_retardation(mass.retardation);
                    if self.ties.rubs {
                        solid.keep_stress();
                    }
                    solid.set_activity(self.activity.clone());
                    for (step, material) in later {
                        solid.change(step, material)?;
                    }
                    summaries.extend(remedies(name, &solid, sizes)?);
                    for &kinematics in conserving {
                        solid.conserves_energy(kinematics)?;
                    }
                    terms.push(Box::new(solid));
                }
                BodyKind::Truss {
                    material,
                    area,
                    small,
                    mass,
                    ..
                } => {
                    let mut truss = Truss::new(TrussParts {
                        name,
                        mesh,
                        reference,
                        cells,
                        layout,
                        space,
                        material,
                        area,
                        small,
                        temperature,
                    })?;
                    truss.set_retardation(mass.retardation);
                    truss.set_activity(self.activity.clone());
                    for &kinematics in conserving {
                        truss.conserves_energy(kinematics)?;
                    }
                    terms.push(Box::new(truss));
                }
                BodyKind::Rigid { .. } => {}
            }
        }
        Ok((terms, summaries))
    }
}

/// What was chosen against locking in a body, for these sizes of strains.
fn remedies(
    name: &str,
    solid: &Solid,
    sizes: &[Kinematics],
) -> Result<Vec<LockingSummary>, ModelError> {
    let mut summaries = Vec::new();
    for &kinematics in sizes {
        let chosen = solid.locking(kinematics)?.into_iter();
        summaries.extend(chosen.map(|(element, locking)| LockingSummary {
            body: name.to_string(),
            element,
            kinematics,
            locking,
        }));
    }
    Ok(summaries)
}

/// How large strains are in any of the steps.
fn sizes_of_strain<'a>(steps: impl Iterator<Item = &'a Step> + Clone) -> Vec<Kinematics> {
    let mut sizes = [Kinematics::Small, Kinematics::Finite].to_vec();
    sizes.retain(|k| {
        let nonlinear = *k == Kinematics::Finite;
        steps.clone().any(|s| s.nonlinear == nonlinear)
    });
    sizes
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::material::{Constants, by_name};
    use signorini_geometry::element;

    #[test]
    fn nodes_halfway_along_edges_are_between_their_corners() {
        let mut mesh = Mesh::default();
        let mut bodies = Vec::new();
        for name in ["hex20", "tet10", "hex8", "hex27"] {
            let element = element::by_name(name).unwrap();
            let first = mesh.nnode() as u32;
            mesh.points.extend(element.nodes());
            let labels = u64::from(first) + 1..;
            mesh.node_labels.extend(labels.take(element.nnode()));
            let nodes: Vec<u32> = (first..).take(element.nnode()).collect();
            let cell = mesh.push_cell(element, &nodes, 1);
            let make = by_name("linear-elastic").unwrap().make;
            bodies.push(BodyPart {
                name: name.into(),
                cells: vec![cell],
                kind: BodyKind::solid(make(&Constants::elastic(1.0, 0.3)).unwrap()),
            });
        }
        let found = between(&mesh, &bodies);
        let mut count = 0;
        for (x, ends) in mesh.points.iter().zip(&found) {
            if ends[0] != u32::MAX {
                let [a, b] = ends.map(|end| mesh.points[end as usize]);
                assert!((*x - (a + b) * 0.5).max_abs() < 1e-15);
                assert!(ends.iter().all(|&end| found[end as usize][0] == u32::MAX));
                count += 1;
            }
        }
        assert_eq!(count, 12 + 6 + 12);
        assert!(between(&mesh, &bodies[2..3]).is_empty());
    }

    /// Nodes of a block, turned by 0.7 about an axis that is none of its own.
    fn block(size: [f64; 3], n: [usize; 3]) -> Vec<Vec3> {
        let (s, c) = 0.7f64.sin_cos();
        let turned = |x: Vec3| {
            let y = Vec3::new(x.x, c * x.y - s * x.z, s * x.y + c * x.z);
            Vec3::new(c * y.x - s * y.y, s * y.x + c * y.y, y.z)
        };
        let place = |k: usize, a: usize| size[a] * (k as f64 / n[a] as f64 - 0.3);
        let mut all = Vec::new();
        for i in 0..=n[0] {
            for j in 0..=n[1] {
                let along = (0..=n[2]).map(|k| Vec3::new(place(i, 0), place(j, 1), place(k, 2)));
                all.extend(along.map(turned));
            }
        }
        all
    }

    #[test]
    fn bending_is_that_of_a_beam_held_at_one_end_however_it_lies() {
        for size in [[20.0, 1.0, 2.0], [3.0, 30.0, 30.0], [1.0, 1.0, 1.0]] {
            let mut extents = size;
            extents.sort_unstable_by(f64::total_cmp);
            let [a, b, c] = extents;
            // 3 E I/c³ with I = b a³/12, over E c
            let expected = b * a.powi(3) / (4.0 * c.powi(4));
            let found = bending(&block(size, [24; 3]), 3);
            // nodes at faces stand for half a cell beyond them
            assert!(
                (found / expected - 1.0).abs() < 0.2,
                "{size:?}: {found} {expected}"
            );
        }
        let flat = block([10.0, 1.0, 0.0], [40, 24, 1]);
        let expected = 0.25 * 0.1f64.powi(3);
        assert!((bending(&flat, 2) / expected - 1.0).abs() < 0.2);
        assert_eq!(bending(&[], 3), 1.0);
        assert_eq!(bending(&[Vec3::ZERO], 3), 1.0);
    }
}
