//! Heat in bodies: conduction, and what they store.
//!
//! | symbol | name in code | |
//! |---|---|---|
//! | θ | `temperature` | at a point, from those of the nodes |
//! | k, e, ρ | [`Conductor`] | conductivity, heat per mass, density |
//! | D = J F⁻¹ k F⁻ᵀ | `conductivity` | against gradients at the start; k where strains are small |
//! | Δt | `dt` | the time of an increment |
//!
//! Residuals are heat that leaves a node, per time:
//!
//! ```text
//! R_k  = ∫ N_k ρ (e(θ) − e(θ_n))/Δt dV + ∫ ∇N_k·D ∇θ dV                                          (E32)
//! K_θθ = ∫ N_k ρ c(θ)/Δt N_l dV + ∫ ∇N_k·D ∇N_l dV + ∫ (∇N_k·D' ∇θ) N_l dV                       (E33)
//! K_θu = ∫ ∇N_k·(tr(H) D − H D − D Hᵀ) ∇θ dV,    H = F⁻¹ dF                                      (E34)
//! ```
//!
//! by backward Euler; the first part of (E32) is there in transient steps alone. Heat that is stored is a difference of heats, so
//! that a body gets back what it gave, whatever the increments; volumes are those of the start, as mass stays what it is. The
//! conductivity of a material with directions turns with the body, by the rotation of the polar decomposition of F, whose
//! derivative (E34) leaves out: Newton's method then converges linearly where such a body is sheared far.
//!
//! Heat has no locking, and no remedy: conduction is integrated by the full rule of an element, or by the reduced one where its
//! stresses are, and what is stored by the rule of its mass, or at the nodes ([`Storage::Lumped`], in the shares of (E8) of
//! [`crate::load`]).
//!
//! In plane stress at finite strain the thickness is that of the start. Sources: Lewis, Morgan, Thomas and Seetharamu, The Finite
//! Element Method in Heat Transfer Analysis, 1996, chapter 3; (E34): Belytschko, Liu, Moran, Nonlinear Finite Elements, 2000, 4.9.

mod cells;

use super::error::SolidError;
use crate::material::{Conductor, pulled_back};
use crate::system::{
    Activity, Archive, ArchiveError, Capabilities, Conducting, Dof, Frame, Heat, HeatFlows,
    Idealisation, Layout, LocalHeat, Order, Part, PatternSink, Phase, Properties, SampledHeat,
    Samples, Sink, SizedFlows, State, StepContext, Stored, Symmetry, Term, TermError, Work,
};
use cells::{Block, Place};
use signorini_geometry::mesh::{CellId, Mesh, NodeId};
use signorini_geometry::tensor::{Mat3, Vec3};
use std::sync::Arc;

/// Where a body stores heat.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Storage {
    /// Between the nodes, as shape functions have it.
    #[default]
    Consistent,
    /// At the nodes.
    Lumped,
}

/// What heat in a body is made from.
pub struct HeatParts<'a> {
    /// The name of the body.
    pub name: &'a str,
    /// The mesh.
    pub mesh: &'a Mesh,
    /// Positions of the nodes at the start.
    pub reference: Arc<[Vec3]>,
    /// Its cells.
    pub cells: &'a [CellId],
    /// Which unknown is which; temperatures are among them.
    pub layout: Layout,
    /// Space, plane or axisymmetry.
    pub space: Idealisation,
    /// What the thickness is multiplied by at every node of the mesh; none: 1.
    pub profile: Option<Arc<[f64]>>,
    /// What conducts.
    pub conductor: Conductor,
    /// Axes of a material with directions, as columns; those of the frame where they are the identity.
    pub axes: Mat3,
    /// Whether it is integrated by the reduced rule.
    pub reduced: bool,
    /// Where it stores heat.
    pub storage: Storage,
}

/// Heat in the cells of one material.
pub struct HeatInBody {
    body: String,
    name: String,
    layout: Layout,
    reference: Arc<[Vec3]>,
    space: Idealisation,
    profile: Option<Arc<[f64]>>,
    conductor: Conductor,
    axes: Mat3,
    storage: Storage,
    blocks: Vec<Block>,
    /// Block, first and last cell.
    chunks: Vec<(usize, usize, usize)>,
    activity: Option<Arc<Activity>>,
    step: StepContext,
    dt: f64,
    /// Temperatures where the increment began.
    before: Vec<f64>,
    /// What it took up per time in the last accepted increment.
    taken: SizedFlows,
    /// Heat that went in since the start.
    stored: f64,
}

/// Scratch of one thread.
#[derive(Default)]
struct Scratch {
    x: Vec<Vec3>,
    u: Vec<f64>,
    profile: Vec<f64>,
    now: Vec<f64>,
    before: Vec<f64>,
    gradient: Vec<Vec3>,
    heat: LocalHeat,
    shares: Vec<f64>,
}

impl Scratch {
    /// The gradient of the temperature at the start, at the point that was placed last.
    fn steepness(&self) -> Vec3 {
        let nodes = self.gradient.iter().zip(&self.now);
        nodes.fold(Vec3::ZERO, |sum, (g, t)| sum + *g * *t)
    }
}

impl HeatInBody {
    /// The heat of these parts.
    ///
    /// # Errors
    /// A cell that is no solid of this space.
    pub fn new(parts: HeatParts<'_>) -> Result<Self, SolidError> {
        let HeatParts {
            name,
            mesh,
            reference,
            cells,
            layout,
            space,
            profile,
            conductor,
            axes,
            reduced,
            storage,
        } = parts;
        let blocks = cells::blocks(name, mesh, cells, layout.ndim(), reduced)?;
        Ok(Self {
            body: name.to_owned(),
            name: format!("heat in {name}"),
            layout,
            reference,
            space,
            profile,
            conductor,
            axes,
            storage,
            chunks: cells::chunks(&blocks),
            blocks,
            activity: None,
            step: StepContext::default(),
            dt: 0.0,
            before: Vec::new(),
            taken: SizedFlows::default(),
            stored: 0.0,
        })
    }

    /// Says which cells take part in which step.
    pub fn set_activity(&mut self, activity: Arc<Activity>) {
        self.activity = Some(activity);
    }

    /// Whether bodies deform while they conduct.
    fn deforms(&self) -> bool {
        self.step.physics.moves && self.step.nonlinear
    }

    fn is_active(&self, cell: CellId) -> bool {
        let number = self.step.number;
        let activity = self.activity.as_ref();
        activity.is_none_or(|activity| activity.is_active(cell, number))
    }

    /// Hands every cell of a chunk that takes part to `take`, with its nodes in the scratch.
    fn each(
        &self,
        chunk: usize,
        trial: &State,
        s: &mut Scratch,
        mut take: impl FnMut(&Block, usize, &mut Scratch) -> Result<(), TermError>,
    ) -> Result<(), TermError> {
        let Some(&(block, first, last)) = self.chunks.get(chunk) else {
            return Ok(());
        };
        let Some(block) = self.blocks.get(block) else {
            return Ok(());
        };
        for cell in
            (first..last).filter(|&cell| block.id(cell).is_some_and(|id| self.is_active(id)))
        {
            self.gather(block.nodes_of(cell), trial, s);
            take(block, cell, s)?;
        }
        Ok(())
    }

    /// Takes what the nodes of a cell have.
    fn gather(&self, nodes: &[NodeId], trial: &State, s: &mut Scratch) {
        let at = |values: &[f64], dof: Dof| values.get(dof as usize).copied().unwrap_or_default();
        s.heat.begin(&self.layout, nodes);
        for list in [&mut s.u, &mut s.profile, &mut s.now, &mut s.before] {
            list.clear();
        }
        s.x.clear();
        s.now
            .extend(s.heat.dofs.iter().map(|&dof| at(&trial.u, dof)));
        s.u.extend(s.heat.motions.iter().map(|&dof| at(&trial.u, dof)));
        for &node in nodes {
            s.before.push(at(&self.before, node));
            let x = self.reference.get(node as usize).copied();
            s.x.push(x.unwrap_or_default());
            if let Some(profile) = &self.profile {
                s.profile
                    .push(profile.get(node as usize).copied().unwrap_or(1.0));
            }
        }
    }

    /// The place of a point of a cell, with the gradients in the scratch.
    fn place(
        &self,
        block: &Block,
        cell: usize,
        point: usize,
        s: &mut Scratch,
    ) -> Result<Place, TermError> {
        let place = block.place(point, &s.x, (self.space, &s.profile), &mut s.gradient);
        place.map_err(|ratio| TermError::Inverted {
            body: self.body.clone(),
            element: block.label(cell),
            ratio,
        })
    }

    /// F⁻¹, F and its determinant at a point; the identity where nothing deforms.
    fn deformation(
        &self,
        block: &Block,
        cell: usize,
        s: &Scratch,
        place: &Place,
    ) -> Result<(Mat3, Mat3, f64), TermError> {
        if !self.deforms() {
            return Ok((Mat3::IDENTITY, Mat3::IDENTITY, 1.0));
        }
        let mut f = Mat3::IDENTITY;
        let ndim = self.layout.ndim();
        for ((u, g), n) in
            s.u.chunks_exact(ndim)
                .zip(&s.gradient)
                .zip(place.shape(block))
        {
            for (row, u) in f.rows.iter_mut().zip(u) {
                *row += *g * *u;
            }
            if let (Some(radius), Some(u)) = (place.radius, u.first()) {
                f.rows[2].z += u * n / radius;
            }
        }
        let inverse = f.inverse().filter(|(_, ratio)| *ratio > 0.0);
        let (inverse, ratio) = inverse.ok_or_else(|| TermError::Inverted {
            body: self.body.clone(),
            element: block.label(cell),
            ratio: f.determinant(),
        })?;
        Ok((inverse, f, ratio))
    }

    /// The conductivity against the gradient at the start, and its derivative with respect to the temperature.
    fn conductivity(&self, temperature: f64, (inverse, f, ratio): (Mat3, Mat3, f64)) -> [Mat3; 2] {
        let turns = !self.conductor.is_isotropic();
        self.conductor.conductivity(temperature).map(|k| {
            let k = if turns { k.congruence(self.axes) } else { k };
            pulled_back(k, turns && self.deforms(), f, inverse, ratio).to_mat3()
        })
    }

    /// Adds what a cell conducts, (E32) to (E34).
    fn conduct(
        &self,
        block: &Block,
        cell: usize,
        order: Order,
        s: &mut Scratch,
    ) -> Result<(), TermError> {
        let n = s.heat.dofs.len();
        for point in 0..block.npoint() {
            let place = self.place(block, cell, point, s)?;
            let deformed = self.deformation(block, cell, s, &place)?;
            let shape = place.shape(block);
            let [d, slope] = self.conductivity(dot(shape, &s.now), deformed);
            let (inverse, steep) = (deformed.0, s.steepness());
            let (flow, change) = (d * steep, slope * steep);
            for (to, g) in s.heat.flow.iter_mut().zip(&s.gradient) {
                *to += place.weight * g.dot(flow);
            }
            if order == Order::Residual {
                continue;
            }
            for (row, g) in s.heat.stiffness.chunks_exact_mut(n).zip(&s.gradient) {
                let (through, changes) = (d * *g * place.weight, place.weight * g.dot(change));
                for ((to, other), shape) in row.iter_mut().zip(&s.gradient).zip(shape) {
                    *to += through.dot(*other) + changes * shape;
                }
            }
            if self.deforms() {
                self.couple(block, &place, (inverse, d), (steep, flow), s);
            }
        }
        Ok(())
    }

    /// Adds (E34) at a point: with `a` a column of F⁻¹ and `g` a gradient, H = a ⊗ g for a displacement, and the hoop's part.
    fn couple(
        &self,
        block: &Block,
        place: &Place,
        (inverse, d): (Mat3, Mat3),
        (steep, flow): (Vec3, Vec3),
        s: &mut Scratch,
    ) {
        let ndim = self.layout.ndim();
        let columns = inverse.transpose().rows;
        let rows = s
            .heat
            .coupling
            .chunks_exact_mut((s.gradient.len() * ndim).max(1));
        for (row, own) in rows.zip(&s.gradient) {
            let of_nodes = row.chunks_exact_mut(ndim.max(1)).zip(&s.gradient);
            for ((to, g), shape) in of_nodes.zip(place.shape(block)) {
                for (axis, (to, a)) in to.iter_mut().zip(columns).enumerate() {
                    let mut of = flow * a.dot(*g) - a * g.dot(flow) - (d * *g) * a.dot(steep);
                    if let (Some(radius), 0) = (place.radius, axis) {
                        of += flow * (shape / radius * inverse.rows[2].z);
                    }
                    *to += place.weight * own.dot(of);
                }
            }
        }
    }

    /// Adds what a cell takes up per time, the first parts of (E32) and (E33).
    fn store(
        &self,
        block: &Block,
        cell: usize,
        order: Order,
        s: &mut Scratch,
    ) -> Result<(), TermError> {
        let n = s.heat.dofs.len();
        if self.storage == Storage::Lumped {
            self.shares(block, cell, s)?;
            for (k, share) in s.shares.iter().enumerate() {
                let [heat, slope] = self.conductor.stored([s.before[k], s.now[k]]);
                s.heat.flow[k] += share * heat / self.dt;
                if order == Order::Tangent {
                    s.heat.stiffness[k * n + k] += share * slope / self.dt;
                }
            }
            return Ok(());
        }
        for point in 0..block.nmass() {
            let (weight, shape) = self.mass_point(block, cell, point, s)?;
            let ends = [dot(shape, &s.before), dot(shape, &s.now)];
            let [heat, slope] = self.conductor.stored(ends);
            let (heat, slope) = (weight * heat / self.dt, weight * slope / self.dt);
            for (to, own) in s.heat.flow.iter_mut().zip(shape) {
                *to += own * heat;
            }
            if order == Order::Residual {
                continue;
            }
            for (row, own) in s.heat.stiffness.chunks_exact_mut(n).zip(shape) {
                let own = own * slope;
                row.iter_mut().zip(shape).for_each(|(to, n)| *to += own * n);
            }
        }
        Ok(())
    }

    /// Volume and shape functions of a point of the rule of the mass.
    fn mass_point<'b>(
        &self,
        block: &'b Block,
        cell: usize,
        point: usize,
        s: &Scratch,
    ) -> Result<(f64, &'b [f64]), TermError> {
        let place = block.mass_point(point, &s.x, (self.space, &s.profile));
        place.map_err(|ratio| TermError::Inverted {
            body: self.body.clone(),
            element: block.label(cell),
            ratio,
        })
    }

    /// The volume of a cell that belongs to each of its nodes, in the proportions of `∫ N_k² dV`.
    fn shares(&self, block: &Block, cell: usize, s: &mut Scratch) -> Result<(), TermError> {
        s.shares.clear();
        s.shares.resize(s.heat.dofs.len(), 0.0);
        let mut volume = 0.0;
        for point in 0..block.nmass() {
            let (weight, shape) = self.mass_point(block, cell, point, s)?;
            volume += weight;
            for (to, n) in s.shares.iter_mut().zip(shape) {
                *to += weight * n * n;
            }
        }
        let sum: f64 = s.shares.iter().sum();
        if sum > 0.0 {
            s.shares.iter_mut().for_each(|share| *share *= volume / sum);
        }
        Ok(())
    }

    /// The flux of heat at the points of a cell: `q = F Q/J`, through present areas.
    fn flux(
        &self,
        block: &Block,
        cell: usize,
        s: &mut Scratch,
        flux: &mut Vec<Vec3>,
    ) -> Result<(), TermError> {
        flux.clear();
        for point in 0..block.npoint() {
            let place = self.place(block, cell, point, s)?;
            let deformed = self.deformation(block, cell, s, &place)?;
            let [d, _] = self.conductivity(dot(place.shape(block), &s.now), deformed);
            let (_, f, ratio) = deformed;
            flux.push(f * (d * s.steepness()) * (-ratio.recip()));
        }
        Ok(())
    }

    /// The heat per time that the body took up in the increment that ends at a state.
    fn taken_up(&self, state: &State) -> Result<SizedFlows, TermError> {
        let (mut total, mut scratch) = (SizedFlows::default(), Scratch::default());
        for chunk in 0..self.chunks.len() {
            self.each(chunk, state, &mut scratch, |block, cell, s| {
                s.heat.clear(Order::Residual, false);
                self.store(block, cell, Order::Residual, s)?;
                total.add(HeatFlows {
                    stored: s.heat.flow.iter().sum(),
                    ..HeatFlows::default()
                });
                Ok(())
            })?;
        }
        Ok(total)
    }

    /// Whether the body stores heat in the present step.
    fn is_transient(&self) -> bool {
        self.step.physics.heat == Heat::Transient && self.dt > 0.0
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

impl Term for HeatInBody {
    fn name(&self) -> &str {
        &self.name
    }

    fn properties(&self) -> Properties {
        let symmetry = if self.conductor.is_constant() && !self.deforms() {
            Symmetry::Definite
        } else {
            Symmetry::Unsymmetric
        };
        Properties {
            elements: self.step.physics.id(),
            ..Properties::new(symmetry, Part::Interface)
        }
    }

    fn pattern(&self, out: &mut dyn PatternSink) {
        if !self.step.physics.has_heat() {
            return;
        }
        let mut heat = LocalHeat::default();
        for block in &self.blocks {
            for (_, nodes) in block.cells().filter(|(id, _)| self.is_active(*id)) {
                heat.begin(&self.layout, nodes);
                heat.announce(self.deforms(), out);
            }
        }
    }

    fn begin(&mut self, phase: &Phase, from: &State) -> Result<(), TermError> {
        (self.step, self.dt) = (phase.step, phase.dt());
        if self.step.physics.heat == Heat::Transient && !self.conductor.stores() {
            return Err(TermError::Refused {
                message: format!(
                    "body \"{}\" stores no heat, but the step is transient: its material needs a specific heat and a density",
                    self.body
                ),
            });
        }
        let of_node = |node| {
            let dof = self.layout.temperature(node) as usize;
            from.u.get(dof).copied().unwrap_or_default()
        };
        self.before.clear();
        self.before
            .extend((0..self.layout.nnode() as NodeId).map(of_node));
        Ok(())
    }

    fn nchunk(&self) -> usize {
        match self.step.physics.has_heat() {
            true => self.chunks.len(),
            false => 0,
        }
    }

    fn evaluate(
        &self,
        chunk: usize,
        trial: &State,
        order: Order,
        work: &mut Work,
        out: &mut dyn Sink,
    ) -> Result<(), TermError> {
        let scratch = work.of::<Scratch>();
        self.each(chunk, trial, scratch, |block, cell, s| {
            let n = s.heat.dofs.len();
            s.heat.clear(order, self.deforms());
            self.conduct(block, cell, order, s)?;
            if self.is_transient() {
                self.store(block, cell, order, s)?;
            }
            if !s.heat.flow.iter().all(|f| f.is_finite()) {
                return Err(TermError::NotFinite {
                    what: format!(
                        "the heat of element {} of body \"{}\"",
                        block.label(cell),
                        self.body
                    ),
                });
            }
            s.heat.add_to(out);
            let far = s.now.iter().fold(0.0, |far: f64, t| far.max(t.abs()));
            let size = block.rigidity(&s.x, (self.space, &s.profile)) * self.conductor.largest();
            out.uncertain(&s.heat.dofs, f64::EPSILON * n as f64 * size * far);
            Ok(())
        })
    }

    fn energy(&self, _: usize, _: &State, _: &mut Work) -> Result<Option<f64>, TermError> {
        Ok(None)
    }

    fn report(&self, state: &State, frame: &mut Frame) -> Result<(), TermError> {
        let mut scratch = Scratch::default();
        let nnode = self.layout.nnode();
        frame.temperature.resize(nnode, 0.0);
        frame.heat_flux.resize(nnode, Vec3::ZERO);
        frame.heat_weight.resize(nnode, 0.0);
        let mut flux = Vec::new();
        for chunk in 0..self.chunks.len() {
            self.each(chunk, state, &mut scratch, |block, cell, s| {
                self.flux(block, cell, s, &mut flux)?;
                block.carry_to_nodes(cell, &flux, frame);
                Ok(())
            })?;
        }
        let nodes = self.blocks.iter().flat_map(Block::nodes);
        for &node in nodes {
            let value = state.u.get(self.layout.temperature(node) as usize);
            if let (Some(to), Some(value)) = (frame.temperature.get_mut(node as usize), value) {
                *to = *value;
            }
        }
        frame.heat_stored += self.stored;
        Ok(())
    }

    fn capabilities(&self) -> Capabilities<'_> {
        Capabilities {
            stored: Some(self),
            conducting: Some(self),
            sampled_heat: Some(self),
            ..Capabilities::default()
        }
    }

    fn stored(&mut self) -> Option<&mut dyn Stored> {
        Some(self)
    }
}

impl Conducting for HeatInBody {
    fn flows(&self) -> SizedFlows {
        self.taken
    }
}

impl SampledHeat for HeatInBody {
    fn sample_heat(
        &self,
        state: &State,
        cells: &[CellId],
        out: &mut Samples<Vec3>,
    ) -> Result<(), TermError> {
        let (mut scratch, mut flux) = (Scratch::default(), Vec::new());
        for chunk in 0..self.nchunk() {
            self.each(chunk, state, &mut scratch, |block, cell, s| {
                let wanted = block.id(cell).filter(|id| cells.binary_search(id).is_ok());
                if let Some(id) = wanted {
                    self.flux(block, cell, s, &mut flux)?;
                    out.push(id, block.rule(), flux.drain(..));
                }
                Ok(())
            })?;
        }
        Ok(())
    }
}

impl Stored for HeatInBody {
    fn accept(&mut self, state: &State) -> Result<(), TermError> {
        self.taken = SizedFlows::default();
        // what is stored is a matter of temperatures, however they come about
        if self.conductor.stores() && self.step.scheme.is_none() && self.dt > 0.0 {
            let taken = self.taken_up(state)?;
            self.stored += taken.sum.stored * self.dt;
            if self.is_transient() {
                self.taken = taken;
            }
        }
        Ok(())
    }

    fn save(&self, out: &mut Archive) {
        out.put(format!("heat.{}", self.body), &[self.stored]);
    }

    fn load(&mut self, from: &Archive) -> Result<(), ArchiveError> {
        let mut stored = [0.0];
        from.get(&format!("heat.{}", self.body), &mut stored)?;
        [self.stored] = stored;
        Ok(())
    }
}
