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
use super::{SolidError, report};
use crate::material::{Kinematics, Material, Order as MaterialOrder, Reduced, Response, Strain};
use crate::system::{
    Archive, ArchiveError, Capabilities, Dof, Frame, Idealisation, InitialStiffness, Layout,
    NodalField, Order, Part, PatternSink, Phase, PointSample, Properties, Sampled, Samples, Sink,
    State, StepContext, Stored, Symmetry, Term, TermError, Work,
};
use signorini_geometry::element::Element;
use signorini_geometry::mesh::{CellId, Mesh, NodeId};
use signorini_geometry::tensor::{Sym3, Vec3};
use std::sync::Arc;

/// Bars evaluated together.
const CHUNK: usize = 64;
/// The most unknowns of a bar: three nodes in space.
const MOST: usize = 9;

/// Bars of one material and cross-section.
pub struct Truss {
    name: String,
    layout: Layout,
    reference: Arc<[Vec3]>,
    material: Box<dyn Material>,
    area: f64,
    small: bool,
    kinematics: Kinematics,
    temperature: Option<Arc<NodalField>>,
    step: StepContext,
    bars: Vec<Bar>,
    // history of a point of the undeformed material
    undeformed: Vec<f64>,
    // accepted history of all points, bar by bar
    history: Vec<f64>,
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

struct Bar {
    element: Element,
    nodes: Vec<NodeId>,
    label: u64,
    id: CellId,
    // where its history begins
    history: usize,
}

/// A point of a bar.
struct Point {
    /// Derivatives of the shape functions along the bar.
    slope: [f64; 3],
    /// Length that belongs to it.
    weight: f64,
    /// t.
    unit: Vec3,
    /// t + h; t at small strain.
    along: Vec3,
    strain: f64,
}

#[derive(Default)]
struct Scratch {
    dofs: Vec<Dof>,
    new: Vec<f64>,
}

/// Forces and stiffness of a bar.
struct Local {
    force: [f64; MOST],
    stiffness: [f64; MOST * MOST],
    energy: f64,
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
            };
            let npoint = element.full_rule().npoint();
            let long = (0..npoint).all(|p| truss.tangent(&bar, p).is_some());
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
    fn tangent(&self, bar: &Bar, point: usize) -> Option<([f64; 3], Vec3, f64)> {
        let mut dn = [Vec3::ZERO; 3];
        let n = bar.nodes.len();
        bar.element
            .dshape(&bar.element.full_rule().points[point], &mut dn[..n]);
        let at = |(&node, dn): (&NodeId, &Vec3)| self.reference[node as usize] * dn.x;
        let along: Vec3 = bar.nodes.iter().zip(&dn).map(at).sum();
        let unit = along.normalized()?;
        Some((dn.map(|d| d.x), unit, along.norm()))
    }

    /// (E14).
    fn point(&self, bar: &Bar, point: usize, at: At<'_>) -> Option<Point> {
        let (dn, unit, length) = self.tangent(bar, point)?;
        let slope = dn.map(|d| d / length);
        let mut h = Vec3::ZERO;
        for (&node, slope) in bar.nodes.iter().zip(slope) {
            for axis in 0..self.layout.ndim() {
                h[axis] += slope * at.displacement(self.layout.node(node, axis));
            }
        }
        let finite = self.kinematics == Kinematics::Finite;
        Some(Point {
            slope,
            weight: bar.element.full_rule().weights[point] * length,
            unit,
            along: if finite { unit + h } else { unit },
            strain: unit.dot(h) + if finite { 0.5 * h.norm_squared() } else { 0.0 },
        })
    }

    /// The temperatures at a point: that of the present, and that at the start.
    fn temperature(&self, bar: &Bar, point: usize, at: At<'_>) -> [f64; 2] {
        let Some(field) = &self.temperature else {
            return [0.0; 2];
        };
        let mut shape = [0.0; 3];
        let n = bar.nodes.len();
        bar.element
            .shape(&bar.element.full_rule().points[point], &mut shape[..n]);
        let now = |(&node, n): (&NodeId, f64)| n * at.temperature(field, &self.step, node);
        let start = |(&node, n): (&NodeId, f64)| n * field.at_start(node);
        let nodes = || bar.nodes.iter().zip(shape);
        [nodes().map(now).sum(), nodes().map(start).sum()]
    }

    /// Hands every point of a bar with the material's answer to `take`; `new` becomes the bar's history.
    fn points(
        &self,
        bar: &Bar,
        at: At<'_>,
        order: MaterialOrder,
        new: &mut Vec<f64>,
        mut take: impl FnMut(&Point, &Response, &[f64]),
    ) -> Result<(), TermError> {
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
            let point = self.point(bar, p, at).ok_or_else(inverted)?;
            let [temperature, temperature_at_start] = self.temperature(bar, p, at);
            let strain = Strain {
                kinematics: self.kinematics,
                value: Sym3::diagonal(point.strain, 0.0, 0.0),
                temperature,
                temperature_at_start,
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
    fn local(
        &self,
        bar: &Bar,
        at: At<'_>,
        order: MaterialOrder,
        new: &mut Vec<f64>,
    ) -> Result<Local, TermError> {
        let ndim = self.layout.ndim();
        let n = bar.nodes.len() * ndim;
        let finite = self.kinematics == Kinematics::Finite;
        let mut out = Local {
            force: [0.0; MOST],
            stiffness: [0.0; MOST * MOST],
            energy: 0.0,
        };
        self.points(bar, at, order, new, |point, response, _| {
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
        for bar in self.chunk(chunk) {
            let local = self.local(bar, at, order, &mut scratch.new)?;
            let layout = &self.layout;
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
        }
    }

    fn chunk(&self, chunk: usize) -> &[Bar] {
        let end = (chunk + 1) * CHUNK;
        self.bars
            .get(chunk * CHUNK..end.min(self.bars.len()))
            .unwrap_or(&[])
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
        Properties::new(Symmetry::Definite, Part::Bulk)
    }

    fn pattern(&self, out: &mut dyn PatternSink) {
        self.bars.iter().for_each(|bar| out.bulk(&bar.nodes));
    }

    fn begin(&mut self, phase: &Phase, _: &State) -> Result<(), TermError> {
        self.kinematics = if phase.step.nonlinear && !self.small {
            Kinematics::Finite
        } else {
            Kinematics::Small
        };
        self.step = phase.step;
        Ok(())
    }

    fn nchunk(&self) -> usize {
        self.bars.len().div_ceil(CHUNK)
    }

    fn evaluate(
        &self,
        chunk: usize,
        trial: &State,
        order: Order,
        work: &mut Work,
        out: &mut dyn Sink,
    ) -> Result<(), TermError> {
        self.add(chunk, At::Trial(trial), order, work, out)
    }

    fn energy(
        &self,
        chunk: usize,
        trial: &State,
        work: &mut Work,
    ) -> Result<Option<f64>, TermError> {
        let scratch = work.of::<Scratch>();
        let (at, mut total) = (At::Trial(trial), 0.0);
        for bar in self.chunk(chunk) {
            let order = MaterialOrder::Stress;
            total += self.local(bar, at, order, &mut scratch.new)?.energy;
        }
        Ok(Some(total))
    }

    /// The axial stress and strain as tensors `σ t tᵀ`, cell by cell; nodes have none, for bars meet at angles.
    fn report(&self, state: &State, frame: &mut Frame) -> Result<(), TermError> {
        let finite = self.kinematics == Kinematics::Finite;
        let (at, mut new) = (At::Trial(state), Vec::new());
        for bar in &self.bars {
            let mut mean = report::CellMeans::default();
            let order = MaterialOrder::Stress;
            self.points(bar, at, order, &mut new, |point, response, history| {
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
    /// Undeformed bars have the same stiffness in all steps.
    fn id(&self) -> u64 {
        0
    }

    fn add_initial(
        &self,
        chunk: usize,
        work: &mut Work,
        out: &mut dyn Sink,
    ) -> Result<(), TermError> {
        self.add(chunk, At::Start, Order::Tangent, work, out)
    }

    fn is_initial(&self, _: &State) -> bool {
        false
    }
}

impl Stored for Truss {
    fn accept(&mut self, state: &State) -> Result<(), TermError> {
        let mut next = Vec::with_capacity(self.history.len());
        let (at, mut new) = (At::Trial(state), Vec::new());
        for bar in &self.bars {
            self.points(bar, at, MaterialOrder::Stress, &mut new, |_, _, _| {})?;
            next.extend_from_slice(&new);
        }
        self.history = next;
        Ok(())
    }

    fn save(&self, out: &mut Archive) {
        out.put(self.archived(), &self.history);
    }

    fn load(&mut self, from: &Archive) -> Result<(), ArchiveError> {
        from.get(&self.archived(), &mut self.history)
    }
}

impl Sampled for Truss {
    fn sample(&self, state: &State, cells: &[CellId], out: &mut Samples) -> Result<(), TermError> {
        let at = At::Trial(state);
        let (mut new, mut samples) = (Vec::new(), Vec::new());
        let wanted = |bar: &&Bar| cells.binary_search(&bar.id).is_ok();
        for bar in self.bars.iter().filter(wanted) {
            let order = MaterialOrder::Stress;
            self.points(bar, at, order, &mut new, |point, response, history| {
                let number = samples.len();
                let temperature = self.temperature(bar, number, at);
                samples.push(self.point_sample(point, response, history, temperature));
            })?;
            out.push(bar.id, bar.element.full_rule(), samples.drain(..));
        }
        Ok(())
    }
}
