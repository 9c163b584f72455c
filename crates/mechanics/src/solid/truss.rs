//! Bars that carry normal force only.
//!
//! With the unit tangent `t` at the start, the length `s` along it and `h = du/ds`,
//!
//! ```text
//! E = t·h + ½ h·h,  l² = 1 + 2E                     Green's strain along the bar; `t·h` alone at small strain  (E14)
//! f_I  = Σ w A S N_I,s (t + h)                                                                              (E15)
//! K_IJ = Σ w A N_I,s N_J,s (C (t + h)(t + h)ᵀ + S I)  `t` for `t + h` and no `S` at small strain             (E16)
//! ```
//!
//! The law answers uniaxial stress. Source: Crisfield 1991, section 3.3.

use super::at::At;
use super::damping::{Damping, Since};
use super::plan::{Part, Plan, is_linear};
use super::{SolidError, report};
use crate::material::{Kinematics, Material, Order as MaterialOrder, Reduced, Response, Strain};
use crate::system::{
    Archive, ArchiveError, Capabilities, Dof, Frame, Idealisation, InitialStiffness, Layout,
    NodalField, Order, Part as Share, PatternSink, Phase, PointSample, Properties, Sampled,
    Samples, Sink, State, StepContext, Stored, Symmetry, Term, TermError, Work,
};
use signorini_geometry::element::Element;
use signorini_geometry::mesh::{CellId, Mesh, NodeId};
use signorini_geometry::tensor::{Sym3, Vec3};
use std::sync::Arc;

/// Bars evaluated together.
const CHUNK: usize = 64;
/// The most unknowns of a bar: three nodes in space.
pub(super) const MOST: usize = 9;

/// Bars of one material and cross-section.
pub struct Truss {
    pub(super) name: String,
    pub(super) layout: Layout,
    reference: Arc<[Vec3]>,
    pub(super) material: Box<dyn Material>,
    pub(super) area: f64,
    pub(super) small: bool,
    pub(super) kinematics: Kinematics,
    temperature: Option<Arc<NodalField>>,
    step: StepContext,
    pub(super) bars: Vec<Bar>,
    // history of a point of the undeformed material
    pub(super) undeformed: Vec<f64>,
    // accepted history of all points, bar by bar
    pub(super) history: Vec<f64>,
    // whether the law is linear in the strain
    linear: bool,
    // which bars take part
    pub(super) part: Part,
    // none where all always do
    pub(super) plan: Option<Plan>,
    pub(super) damping: Damping,
}

/// What bars are made from.
pub struct TrussParts<'a> {
    /// Their name.
    pub name: &'a str,
    /// The mesh.
    pub mesh: &'a Mesh,
    /// Positions of the nodes at the start.
    pub reference: Arc<[Vec3]>,
    /// Their cells, line2 or line3.
    pub cells: &'a [CellId],
    /// Which unknown is which.
    pub layout: Layout,
    /// Space or plane; a bar of revolution does not exist.
    pub space: Idealisation,
    /// What they are made of: the law for three dimensions. It is taken to be isotropic where the cross-section shrinks.
    pub material: Box<dyn Material>,
    /// Cross-section at the start (area); bars of none carry no force.
    pub area: f64,
    /// Whether strains are small in all steps.
    pub small: bool,
    /// Temperatures, where there are any.
    pub temperature: Option<Arc<NodalField>>,
}

pub(super) struct Bar {
    pub element: Element,
    pub nodes: Vec<NodeId>,
    pub label: u64,
    pub id: CellId,
    // where its history begins
    pub history: usize,
    // of every unknown where the increment began, where velocities damp
    pub since: Vec<Since>,
}

/// A point of a bar.
pub(super) struct Point {
    /// Derivatives of the shape functions along the bar.
    pub slope: [f64; 3],
    /// Length that belongs to it.
    pub weight: f64,
    /// t.
    unit: Vec3,
    /// t + h; t at small strain.
    pub along: Vec3,
    strain: f64,
}

#[derive(Default)]
struct Scratch {
    dofs: Vec<Dof>,
    new: Vec<f64>,
}

/// Forces and stiffness of a bar.
pub(super) struct Local {
    pub force: [f64; MOST],
    pub stiffness: [f64; MOST * MOST],
    energy: f64,
}

impl Default for Local {
    fn default() -> Self {
        Self {
            force: [0.0; MOST],
            stiffness: [0.0; MOST * MOST],
            energy: 0.0,
        }
    }
}

impl Truss {
    /// The bars made of these parts.
    ///
    /// # Errors
    /// A cell that is no line, or has no length; a negative cross-section; a body of revolution.
    pub fn new(parts: TrussParts<'_>) -> Result<Self, SolidError> {
        let TrussParts {
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
        } = parts;
        let body = name.to_string();
        if space == Idealisation::Axisymmetric {
            return Err(SolidError::BarOfRevolution { body });
        }
        let linear = is_linear(material.as_ref());
        let material = Reduced::uniaxial(material);
        let mut truss = Self {
            name: body.clone(),
            layout,
            reference,
            area,
            small,
            kinematics: Kinematics::Finite,
            temperature,
            step: StepContext::default(),
            bars: Vec::new(),
            undeformed: vec![0.0; material.nhistory()],
            history: Vec::new(),
            material: Box::new(material),
            linear,
            part: Part::default(),
            plan: None,
            damping: Damping::default(),
        };
        truss.material.start(&mut truss.undeformed);
        for &id in cells {
            let (Some(element), Some(label)) = (mesh.element(id), mesh.cell_label(id)) else {
                continue;
            };
            if element.dim() != 1 || element.order() > 2 {
                return Err(SolidError::NotBar {
                    body,
                    label,
                    element: element.name(),
                });
            }
            let bar = Bar {
                element,
                nodes: mesh.cell(id).to_vec(),
                label,
                id,
                history: truss.history.len(),
                since: Vec::new(),
            };
            let npoint = element.full_rule().npoint();
            let long = (0..npoint).all(|p| truss.tangent(&bar, None, p).is_some());
            let what = if area.is_nan() || area < 0.0 {
                "cross-section"
            } else {
                "length"
            };
            if !long || what == "cross-section" {
                return Err(SolidError::NoSize { body, label, what });
            }
            truss.bars.push(bar);
            for _ in 0..npoint {
                truss.history.extend_from_slice(&truss.undeformed);
            }
        }
        Ok(truss)
    }

    /// Derivatives of the shape functions by the reference coordinate at a point, and `dX/dξ` as unit vector and length;
    /// `None` where there is no length.
    pub(super) fn tangent(
        &self,
        bar: &Bar,
        number: Option<usize>,
        point: usize,
    ) -> Option<([f64; 3], Vec3, f64)> {
        let mut dn = [Vec3::ZERO; 3];
        let n = bar.nodes.len();
        bar.element
            .dshape(&bar.element.full_rule().points[point], &mut dn[..n]);
        let origin = number.map(|number| self.origin(number)).unwrap_or_default();
        let moves = self.kinematics == Kinematics::Finite && !self.subtracts();
        let ndim = self.layout.ndim();
        let along = bar
            .nodes
            .iter()
            .zip(&dn)
            .enumerate()
            .map(|(k, (&node, dn))| {
                let mut place = self.reference[node as usize];
                for (axis, u) in origin.iter().skip(k * ndim).take(ndim).enumerate() {
                    place[axis] += if moves { *u } else { 0.0 };
                }
                place * dn.x
            });
        let along: Vec3 = along.sum();
        let unit = along.normalized()?;
        Some((dn.map(|d| d.x), unit, along.norm()))
    }

    /// Whether the strain at which bars were added is taken off, (E19).
    fn subtracts(&self) -> bool {
        self.kinematics == Kinematics::Finite && self.linear
    }

    /// u_0 of a bar; nothing where it is zero.
    pub(super) fn origin(&self, number: usize) -> &[f64] {
        self.part.origin(number, self.width())
    }

    /// The most unknowns of a bar here: those of shorter ones are followed by zeros.
    pub(super) fn width(&self) -> usize {
        3 * self.layout.ndim()
    }

    /// (E14), and the strain that is taken off.
    pub(super) fn point(&self, number: usize, point: usize, at: At<'_>) -> Option<(Point, f64)> {
        let bar = self.bars.get(number)?;
        let (dn, unit, length) = self.tangent(bar, Some(number), point)?;
        let slope = dn.map(|d| d / length);
        let (origin, subtracts) = (self.origin(number), self.subtracts());
        let ndim = self.layout.ndim();
        let (mut h, mut h_0) = (Vec3::ZERO, Vec3::ZERO);
        for (k, (&node, slope)) in bar.nodes.iter().zip(slope).enumerate() {
            for axis in 0..ndim {
                let origin = origin.get(k * ndim + axis).copied().unwrap_or_default();
                let moved = match (at, subtracts) {
                    (At::Trial(_), true) => at.displacement(self.layout.node(node, axis)),
                    (At::Trial(_), false) => at.displacement(self.layout.node(node, axis)) - origin,
                    (At::Start, true) => origin,
                    (At::Start, false) => 0.0,
                };
                h[axis] += slope * moved;
                h_0[axis] += slope * origin;
            }
        }
        let finite = self.kinematics == Kinematics::Finite;
        let strain = |h: Vec3| unit.dot(h) + if finite { 0.5 * h.norm_squared() } else { 0.0 };
        let of_point = Point {
            slope,
            weight: bar.element.full_rule().weights[point] * length,
            unit,
            along: if finite { unit + h } else { unit },
            strain: strain(h),
        };
        Some((of_point, if subtracts { strain(h_0) } else { 0.0 }))
    }

    /// The temperatures at a point: that of the present, and that at the start.
    pub(super) fn temperature(&self, number: usize, point: usize, at: At<'_>) -> [f64; 2] {
        let (Some(field), Some(bar)) = (&self.temperature, self.bars.get(number)) else {
            return [0.0; 2];
        };
        let mut shape = [0.0; 3];
        let n = bar.nodes.len();
        let since = self.part.since(number).unwrap_or(0);
        bar.element
            .shape(&bar.element.full_rule().points[point], &mut shape[..n]);
        let start = |(&node, n): (&NodeId, f64)| n * field.at_begin(since, node);
        let now = |(&node, n): (&NodeId, f64)| match at {
            At::Trial(_) => n * at.temperature(&self.layout, field, &self.step, node),
            At::Start => start((&node, n)),
        };
        let nodes = || bar.nodes.iter().zip(shape);
        [nodes().map(now).sum(), nodes().map(start).sum()]
    }

    /// Hands every point of a bar with the material's answer to `take`; `new` becomes the bar's history.
    fn points(
        &self,
        number: usize,
        at: At<'_>,
        order: MaterialOrder,
        new: &mut Vec<f64>,
        mut take: impl FnMut(&Point, &Response, &[f64]),
    ) -> Result<(), TermError> {
        let Some(bar) = self.bars.get(number) else {
            return Ok(());
        };
        let nhistory = self.material.nhistory();
        let npoint = bar.element.full_rule().npoint();
        new.resize(npoint * nhistory, 0.0);
        let mut response = Response::default();
        for p in 0..npoint {
            let inverted = || TermError::Inverted {
                body: self.name.clone(),
                element: bar.label,
                ratio: 0.0,
            };
            let (point, taken_off) = self.point(number, p, at).ok_or_else(inverted)?;
            let [temperature, temperature_at_start] = self.temperature(number, p, at);
            let strain = Strain {
                kinematics: self.kinematics,
                value: Sym3::diagonal(point.strain - taken_off, 0.0, 0.0),
                temperature,
                temperature_at_start,
                axes: None,
            };
            let old = match at {
                At::Trial(_) => &self.history[bar.history + p * nhistory..][..nhistory],
                At::Start => &self.undeformed,
            };
            let new = &mut new[p * nhistory..][..nhistory];
            let answer = self
                .material
                .respond(&strain, old, new, order, &mut response);
            answer.map_err(|error| TermError::Material {
                body: self.name.clone(),
                element: bar.label,
                message: error.to_string(),
            })?;
            take(&point, &response, new);
        }
        Ok(())
    }

    /// (E15), (E16).
    pub(super) fn local(
        &self,
        number: usize,
        at: At<'_>,
        order: MaterialOrder,
        new: &mut Vec<f64>,
    ) -> Result<Local, TermError> {
        let bar = &self.bars[number];
        let ndim = self.layout.ndim();
        let n = bar.nodes.len() * ndim;
        let finite = self.kinematics == Kinematics::Finite;
        let mut out = Local::default();
        self.points(number, at, order, new, |point, response, _| {
            let volume = point.weight * self.area;
            let stress = response.stress.xx();
            let modulus = response.tangent[0][0];
            out.energy += volume * response.energy;
            for i in 0..n {
                let (node, axis) = (i / ndim, i % ndim);
                let slope = volume * point.slope[node];
                out.force[i] += slope * stress * point.along[axis];
                if order == MaterialOrder::Stress {
                    continue;
                }
                for j in 0..n {
                    let mut value = modulus * point.along[axis] * point.along[j % ndim];
                    if finite && axis == j % ndim {
                        value += stress;
                    }
                    out.stiffness[i * n + j] += slope * point.slope[j / ndim] * value;
                }
            }
        })?;
        if !out.energy.is_finite() || !out.force.iter().all(|f| f.is_finite()) {
            return Err(TermError::NotFinite {
                what: format!("the force of bar {} of truss \"{}\"", bar.label, self.name),
            });
        }
        Ok(out)
    }

    /// Adds forces of one chunk, and stiffness where it is wanted.
    fn add(
        &self,
        chunk: usize,
        at: At<'_>,
        order: Order,
        work: &mut Work,
        out: &mut dyn Sink,
    ) -> Result<(), TermError> {
        let scratch = work.of::<Scratch>();
        let (order, stiff) = match order {
            Order::Residual => (MaterialOrder::Stress, 0),
            Order::Tangent => (MaterialOrder::Tangent, 1),
        };
        for number in self.chunk(chunk) {
            let (bar, layout) = (&self.bars[number], &self.layout);
            let mut local = self.local(number, at, order, &mut scratch.new)?;
            if let Some(flow) = self.damping.at(at, stiff == 1) {
                self.damp(number, (at, flow), order, &mut scratch.new, &mut local)?;
            }
            let of_node = |&node: &NodeId| (0..layout.ndim()).map(move |c| layout.node(node, c));
            scratch.dofs.clear();
            scratch.dofs.extend(bar.nodes.iter().flat_map(of_node));
            let n = scratch.dofs.len();
            out.add(
                &scratch.dofs,
                &local.force[..n],
                &local.stiffness[..stiff * n * n],
            );
        }
        Ok(())
    }

    /// `σ t tᵀ`.
    fn stress(&self, point: &Point, response: &Response) -> Sym3 {
        let mut stress = response.stress.xx();
        if self.kinematics == Kinematics::Finite {
            // force over the cross-section that is left
            stress *= point.along.norm() / (1.0 + 2.0 * response.across);
        }
        dyad(point.along) * stress
    }

    /// What is known at a point; strains with what the material found across.
    fn point_sample(
        &self,
        point: &Point,
        response: &Response,
        history: &[f64],
        [temperature, temperature_at_start]: [f64; 2],
    ) -> PointSample {
        let strain = Sym3::diagonal(point.strain, response.across, response.across);
        let mechanical = self.material.mechanical_strain(&Strain {
            kinematics: self.kinematics,
            value: strain,
            temperature,
            temperature_at_start,
            axes: None,
        });
        let turned = |of: Sym3| {
            let along = dyad(point.unit);
            along * of.xx() + (Sym3::IDENTITY - along) * of.yy()
        };
        PointSample {
            stress: self.stress(point, response),
            strain: turned(strain),
            mechanical_strain: turned(mechanical),
            plastic_strain: self.material.plastic_strain(history).unwrap_or(0.0),
            energy: response.energy,
            volume: point.weight * self.area,
            axes: None,
        }
    }

    /// The bars of a chunk that take part.
    pub(super) fn chunk(&self, chunk: usize) -> impl Iterator<Item = usize> + '_ {
        let end = ((chunk + 1) * CHUNK).min(self.bars.len());
        (chunk * CHUNK..end).filter(|&number| self.part.is_active(number))
    }

    /// Chunks of bars, without that of forces that fall to zero.
    fn nchunk_of_bars(&self) -> usize {
        self.bars.len().div_ceil(CHUNK)
    }

    fn stored_plan(&self) -> String {
        format!("truss.{}.activity", self.name)
    }

    fn archived(&self) -> String {
        format!("truss.{}.history", self.name)
    }
}

/// `t tᵀ` of the unit vector along `v`.
fn dyad(v: Vec3) -> Sym3 {
    let t = v.normalized().unwrap_or_default();
    Sym3::new(
        t.x * t.x,
        t.y * t.y,
        t.z * t.z,
        t.x * t.y,
        t.y * t.z,
        t.x * t.z,
    )
}

impl Term for Truss {
    fn name(&self) -> &str {
        &self.name
    }

    fn properties(&self) -> Properties {
        let is_viscous = self.damping.stiff().is_some();
        let symmetry = match is_viscous && self.kinematics == Kinematics::Finite {
            true => Symmetry::Unsymmetric,
            false => Symmetry::Definite,
        };
        Properties {
            retardation: self.damping.retardation,
            elements: self.plan.as_ref().map_or(0, Plan::epoch),
            ..Properties::new(symmetry, Share::Bulk)
        }
    }

    fn pattern(&self, out: &mut dyn PatternSink) {
        let bars = self.bars.iter().enumerate();
        let active = bars.filter(|(number, _)| self.part.is_active(*number));
        active.for_each(|(_, bar)| out.bulk(&bar.nodes));
    }

    fn begin(&mut self, phase: &Phase, from: &State) -> Result<(), TermError> {
        let begins = phase.increment.is_none();
        if begins {
            // forces of what is removed are those of the step before
            self.change_bars(phase.step.number, from)?;
        }
        self.kinematics = if phase.step.nonlinear && !self.small {
            Kinematics::Finite
        } else {
            Kinematics::Small
        };
        self.step = phase.step;
        self.begin_damping(phase, from);
        if self.step.conserves() {
            let outcome = self.conserves_energy(self.kinematics);
            outcome.map_err(|e| TermError::Refused {
                message: e.to_string(),
            })?;
        }
        if begins {
            self.set_active();
            self.judge_added(phase.step.number)?;
        }
        Ok(())
    }

    fn nchunk(&self) -> usize {
        self.nchunk_of_bars() + self.plan.as_ref().map_or(0, Plan::nchunk)
    }

    fn evaluate(
        &self,
        chunk: usize,
        trial: &State,
        order: Order,
        work: &mut Work,
        out: &mut dyn Sink,
    ) -> Result<(), TermError> {
        if let Some(plan) = self
            .plan
            .as_ref()
            .filter(|_| chunk >= self.nchunk_of_bars())
        {
            plan.exert(&self.layout, &self.step, trial.time, out);
            return Ok(());
        }
        self.add(chunk, At::Trial(trial), order, work, out)
    }

    fn energy(
        &self,
        chunk: usize,
        trial: &State,
        work: &mut Work,
    ) -> Result<Option<f64>, TermError> {
        if let Some(plan) = self
            .plan
            .as_ref()
            .filter(|_| chunk >= self.nchunk_of_bars())
        {
            return Ok(Some(plan.energy(&self.step, trial)));
        }
        // without a potential there is none
        if !self.material.is_symmetric() {
            return Ok(None);
        }
        let scratch = work.of::<Scratch>();
        let (at, mut total) = (At::Trial(trial), 0.0);
        for number in self.chunk(chunk) {
            let order = MaterialOrder::Stress;
            total += self.local(number, at, order, &mut scratch.new)?.energy;
        }
        Ok(Some(total))
    }

    /// The axial stress and strain as tensors `σ t tᵀ`, cell by cell; nodes have none, for bars meet at angles.
    fn report(&self, state: &State, frame: &mut Frame) -> Result<(), TermError> {
        let finite = self.kinematics == Kinematics::Finite;
        if state.rates.is_some() && self.damping.retardation > 0.0 {
            frame.energies.get_or_insert_default().damping += self.damping.spent;
        }
        let (at, mut new) = (At::Trial(state), Vec::new());
        for (number, bar) in self.bars.iter().enumerate() {
            if self.plan.is_some() {
                frame.set_active(bar.id, self.part.is_active(number));
            }
            if !self.part.is_active(number) {
                continue;
            }
            let mut mean = report::CellMeans::default();
            let order = MaterialOrder::Stress;
            self.points(number, at, order, &mut new, |point, response, history| {
                let strain = match finite {
                    true => dyad(point.along) * (0.5 * (2.0 * point.strain).ln_1p()),
                    false => dyad(point.along) * point.strain,
                };
                let plastic = self.material.plastic_strain(history);
                mean.add(point.weight, self.stress(point, response), strain, plastic);
            })?;
            mean.put(frame, bar.id);
        }
        Ok(())
    }

    fn capabilities(&self) -> Capabilities<'_> {
        Capabilities {
            initial_stiffness: Some(self),
            stored: Some(self),
            sampled: Some(self),
            ..Capabilities::default()
        }
    }

    fn stored(&mut self) -> Option<&mut dyn Stored> {
        Some(self)
    }
}

impl InitialStiffness for Truss {
    /// Undeformed bars have the same stiffness in all steps with the same bars.
    fn id(&self) -> u64 {
        let epoch = self.plan.as_ref().map_or(0, Plan::epoch);
        // bars that were added have it at another strain
        2 * epoch + u64::from(epoch > 0 && self.kinematics == Kinematics::Finite)
    }

    fn add_initial(
        &self,
        chunk: usize,
        work: &mut Work,
        out: &mut dyn Sink,
    ) -> Result<(), TermError> {
        match chunk < self.nchunk_of_bars() {
            true => self.add(chunk, At::Start, Order::Tangent, work, out),
            false => Ok(()),
        }
    }

    fn is_initial(&self, _: &State) -> bool {
        false
    }
}

impl Stored for Truss {
    fn accept(&mut self, state: &State) -> Result<(), TermError> {
        self.damping.spent += self.dissipation(state)?;
        let mut next = Vec::with_capacity(self.history.len());
        let (at, mut new) = (At::Trial(state), Vec::new());
        for (number, bar) in self.bars.iter().enumerate() {
            if self.part.is_active(number) {
                self.points(number, at, MaterialOrder::Stress, &mut new, |_, _, _| {})?;
                next.extend_from_slice(&new);
            } else {
                let n = bar.element.full_rule().npoint() * self.undeformed.len();
                next.extend_from_slice(&self.history[bar.history..bar.history + n]);
            }
        }
        self.history = next;
        Ok(())
    }

    fn save(&self, out: &mut Archive) {
        out.put(self.archived(), &self.history);
        self.damping.save(&self.name, out);
        if let Some(plan) = &self.plan {
            plan.save(&self.stored_plan(), out);
            self.part.save(&self.stored_plan(), out);
        }
    }

    fn load(&mut self, from: &Archive) -> Result<(), ArchiveError> {
        from.get(&self.archived(), &mut self.history)?;
        self.damping.load(&self.name, from)?;
        let (name, nbar) = (self.stored_plan(), self.bars.len());
        let width = self.width();
        if let Some(plan) = &mut self.plan {
            plan.load(&name, from)?;
            self.part.load(&name, from, nbar, nbar * width)?;
        }
        self.set_active();
        Ok(())
    }
}

impl Sampled for Truss {
    fn sample(&self, state: &State, cells: &[CellId], out: &mut Samples) -> Result<(), TermError> {
        let at = At::Trial(state);
        let (mut new, mut samples) = (Vec::new(), Vec::new());
        let wanted = |(number, bar): &(usize, &Bar)| {
            cells.binary_search(&bar.id).is_ok() && self.part.is_active(*number)
        };
        for (number, bar) in self.bars.iter().enumerate().filter(wanted) {
            let order = MaterialOrder::Stress;
            self.points(number, at, order, &mut new, |point, response, history| {
                let temperature = self.temperature(number, samples.len(), at);
                samples.push(self.point_sample(point, response, history, temperature));
            })?;
            out.push(bar.id, bar.element.full_rule(), samples.drain(..));
        }
        Ok(())
    }
}
