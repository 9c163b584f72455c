//! Two sides with a past: an interface of any method, law and friction over any kind of facets, after one accepted
//! increment and some way into the next.

use super::super::cohesion::Cohesion;
use super::super::discretization::projected::Closest;
use super::super::discretization::{
    Anchored, Discretization, Mortar, NodeNormals, NodeToNode, PointToSegment, SlidingRange,
    SurfacePair, areas_inside, mortar,
};
use super::super::friction::{FrictionLaw, Stick};
use super::super::law::{ContactLaw, Damping, Gasket, Scale};
use super::super::{
    ContactPhase, Fluid, Interface, InterfaceParts, Measure, WearParts, closest_points, nmultiplier,
};
use super::{Random, facets_of, next_increment, with_mid_nodes};
use crate::system::{
    Adaptive, Choices, ContactFrame, Dof, Elimination, Frame, Layout, NO_DOF, Order, PatternSink,
    Phase, RigidBody, Sink, State, StepContext, Stored, Term, Verdict, Work,
};
use signorini_geometry::element::quadrature::{gauss, lobatto, on_facet};
use signorini_geometry::mesh::NodeId;
use signorini_geometry::surface::{
    Analytical, ContactSurface, Facets, Mount, Placement, Side, Sphere, SurfaceJet, Torus,
};
use signorini_geometry::tensor::Vec3;
use std::sync::Arc;

/// ε, or c.
pub(crate) const PENALTY: f64 = 7.0;
/// How far a point that sticks may be from its anchor, about.
pub(crate) const LITTLE: f64 = 0.01;
/// How far others go, at most.
const FAR: f64 = 0.7;

/// What the primary side is made of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    /// Elements of this name.
    Elements(&'static str),
    /// A cylinder across the plane, a sphere, or a torus, carried by rigid body 0.
    Circle,
    Sphere,
    Torus,
}

impl Kind {
    pub(crate) fn ndim(self) -> usize {
        match self {
            Self::Elements("line2" | "line3") | Self::Circle => 2,
            _ => 3,
        }
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Method {
    NodeToSegment,
    SmallSliding,
    OfIncrement,
    Gauss,
    Lobatto,
    GivenNormals,
    PrimaryNormals,
    SecondaryNormals,
    Mortar,
    NodalMortar,
    HeldMortar,
}

impl Method {
    pub(crate) fn is_mortar(self) -> bool {
        matches!(self, Self::Mortar | Self::NodalMortar | Self::HeldMortar)
    }

    pub(crate) fn is_between_nodes(self) -> bool {
        matches!(
            self,
            Self::GivenNormals | Self::PrimaryNormals | Self::SecondaryNormals
        )
    }

    pub(crate) fn is_inside(self) -> bool {
        matches!(self, Self::Gauss | Self::Lobatto)
    }
}

/// What acts.
pub(crate) struct Choice {
    pub law: Box<dyn ContactLaw>,
    pub friction: Option<(Arc<dyn FrictionLaw>, Stick)>,
    pub bond: bool,
    /// The stiffness of a bond within the tangent plane.
    pub tangential: Option<f64>,
    /// What damps along the normal.
    pub damping: Damping,
    /// What comes between the sides.
    pub fluid: Option<Fluid>,
    /// The law, where it is a gasket.
    pub gasket: Option<Arc<Gasket>>,
    /// How a bond breaks.
    pub cohesion: Option<Cohesion>,
    pub wear: Option<Wears>,
}

impl Choice {
    /// This law and nothing more.
    pub(crate) fn of(law: Box<dyn ContactLaw>) -> Choice {
        Choice {
            law,
            friction: None,
            bond: false,
            tangential: None,
            damping: Damping::default(),
            fluid: None,
            gasket: None,
            cohesion: None,
            wear: None,
        }
    }
}

/// How the secondary side wears: depth per pressure and way, and a way that is given.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Wears {
    pub coefficient: f64,
    pub slip: Option<f64>,
}

pub(crate) struct Scene {
    pub interface: Interface,
    pub layout: Layout,
    pub reference: Vec<Vec3>,
    pub elimination: Arc<Elimination>,
    pub state: State,
    /// Nodes of the secondary side, and the way out of the primary side there.
    pub points: Vec<NodeId>,
    pub up: Vec<Vec3>,
    /// Which of them hardly move.
    pub still: Vec<bool>,
    method: Method,
}

/// Corner nodes and facets of the primary side, up the last axis.
fn grid(name: &str, random: &mut Random) -> (Vec<Vec3>, Vec<Vec<NodeId>>) {
    let mut x = Vec::new();
    let mut nodes: Vec<Vec<NodeId>> = Vec::new();
    if name.starts_with("line") {
        for k in 0..7 {
            x.push(Vec3::new(6.0 - f64::from(k), 0.1 * random.signed(), 0.0));
        }
        nodes.extend((0..6).map(|k| vec![k, k + 1]));
    } else {
        let n = if matches!(name, "quad4" | "tri3") {
            3
        } else {
            2
        };
        for k in 0..(n + 1) * (n + 1) {
            let at = Vec3::new(f64::from(k % (n + 1)), f64::from(k / (n + 1)), 0.0);
            x.push(at + random.vector() * 0.08);
        }
        for k in 0..n * n {
            let a = k / n * (n + 1) + k % n;
            let quad = [a, a + 1, a + n + 2, a + n + 1];
            if name.starts_with("tri") {
                nodes.push(vec![quad[0], quad[1], quad[2]]);
                nodes.push(vec![quad[0], quad[2], quad[3]]);
            } else {
                nodes.push(quad.to_vec());
            }
        }
    }
    if matches!(name, "line3" | "tri6" | "quad8" | "quad9") {
        with_mid_nodes(&mut x, &mut nodes, name == "quad9");
    }
    (x, nodes)
}

/// The same facet seen from behind.
fn turned_over(nodes: &[NodeId]) -> Vec<NodeId> {
    let order: &[usize] = match nodes.len() {
        2 => &[1, 0],
        3 => &[0, 2, 1],
        4 => &[0, 3, 2, 1],
        6 => &[0, 2, 1, 5, 4, 3],
        8 => &[0, 3, 2, 1, 7, 6, 5, 4],
        _ => &[0, 3, 2, 1, 7, 6, 5, 4, 8],
    };
    order.iter().map(|&k| nodes[k]).collect()
}

/// The three nodes of line3 are its ends and its middle.
fn turned_line3(nodes: &[NodeId]) -> Vec<NodeId> {
    vec![nodes[1], nodes[0], nodes[2]]
}

/// Two sides before there is an interface between them.
struct Sides {
    x: Vec<Vec3>,
    points: Vec<NodeId>,
    up: Vec<Vec3>,
    secondary: Option<Facets>,
    /// Facets of the primary side.
    first: Option<Facets>,
    bodies: Vec<RigidBody>,
    primary: Arc<dyn ContactSurface>,
}

/// Facets over facets.
fn elements(name: &'static str, ndim: usize, random: &mut Random) -> Sides {
    let (mut points, mut up) = (Vec::new(), Vec::new());
    let (mut x, nodes) = grid(name, random);
    let centre = x.iter().copied().sum::<Vec3>() / x.len() as f64;
    let count = x.len() as NodeId;
    for k in 0..x.len() {
        let shrunk = centre + (x[k] - centre) * 0.8;
        let axis = Vec3::unit(ndim - 1);
        let noise = flat(random.vector(), ndim) * 0.04;
        points.push(x.len() as NodeId);
        x.push(shrunk + axis * (0.1 * random.signed() - 0.05) + noise);
        up.push(axis);
    }
    for x in &mut x[..count as usize] {
        *x += flat(random.vector(), ndim) * 0.03;
    }
    let over = |n: &Vec<NodeId>| {
        let over = if name == "line3" {
            turned_line3(n)
        } else {
            turned_over(n)
        };
        (name, over.iter().map(|k| k + count).collect())
    };
    let over: Vec<(&str, Vec<NodeId>)> = nodes.iter().map(over).collect();
    let named: Vec<_> = nodes.iter().map(|n| (name, n.clone())).collect();
    let facets = facets_of(&mut x, &named);
    Sides {
        secondary: Some(facets_of(&mut x, &over)),
        x,
        points,
        up,
        first: Some(facets.clone()),
        bodies: Vec::new(),
        primary: Arc::new(facets),
    }
}

/// Nodes over a surface of a rigid body.
fn analytical(kind: Kind, random: &mut Random) -> Sides {
    let ndim = kind.ndim();
    let (mut x, mut points, mut up) = (Vec::new(), Vec::new(), Vec::new());
    let origin = flat(random.vector(), ndim);
    let centre = origin + flat(random.vector(), ndim) * 0.3;
    for k in 0..24 {
        let angle = f64::from(k) * 0.25 + 0.1 * random.signed();
        let along = Vec3::new(angle.cos(), angle.sin(), 0.0);
        let (out, at) = match kind {
            Kind::Circle => (along, along * 1.5),
            Kind::Sphere => {
                let out = (along + Vec3::unit(2) * random.signed()).normalized();
                (out.unwrap(), out.unwrap() * 1.5)
            }
            _ => {
                let (s, c) = (3.0 * random.signed()).sin_cos();
                let out = along * c + Vec3::unit(2) * s;
                (out, along * 1.5 + out * 0.6)
            }
        };
        points.push(x.len() as NodeId);
        x.push(centre + at + out * (0.1 * random.signed() - 0.05));
        up.push(out);
    }
    let z = Vec3::unit(2);
    let shape: Box<dyn signorini_geometry::surface::Shape> = match kind {
        Kind::Torus => Box::new(Torus::new(centre, z, 1.5, 0.6, Side::Outside).unwrap()),
        _ => Box::new(Sphere::new(centre, 1.5, Side::Outside).unwrap()),
    };
    let mount = Mount::on(ndim - 1, 0, origin);
    Sides {
        x,
        points,
        up,
        secondary: None,
        first: None,
        bodies: vec![RigidBody {
            reference: origin,
            nodes: Vec::new(),
        }],
        primary: Arc::new(Analytical::new(mount, shape).unwrap()),
    }
}

/// The rows of a method and their areas.
fn rows_of(
    method: Method,
    choice: &Choice,
    pair: &SurfacePair,
    (first, ndim): (Option<Facets>, usize),
    at: &Placement,
) -> (Box<dyn Discretization>, Vec<f64>) {
    let (points, second) = (&pair.points, &pair.secondary);
    let mut area: Vec<f64> = (0..points.len()).map(|k| 1.0 + 0.02 * k as f64).collect();
    let closest = if choice.law.multiplier().is_unknown() {
        Closest::Faces
    } else {
        Closest::Anywhere
    };
    let discretization: Box<dyn Discretization> = match method {
        Method::Mortar | Method::NodalMortar | Method::HeldMortar => {
            let normals = match method {
                Method::NodalMortar => mortar::Normals::Nodal,
                _ => mortar::Normals::Facet,
            };
            let form = mortar::Form {
                normals,
                ..Default::default()
            };
            let (second, primary) = (second.as_ref().unwrap(), pair.primary.as_ref());
            let measure = Default::default();
            let mut mortar = Mortar::new(second, primary, form, measure, at.x).unwrap();
            if choice.bond || method == Method::HeldMortar {
                mortar = mortar.held_at(pair, at, 0.5).unwrap();
            }
            area = mortar.areas().to_vec();
            Box::new(mortar)
        }
        Method::NodeToSegment | Method::SmallSliding | Method::OfIncrement => {
            let mut at_nodes = PointToSegment::at_nodes(points);
            at_nodes.closest = closest;
            at_nodes.sliding = match method {
                Method::SmallSliding => SlidingRange::Small,
                Method::OfIncrement => SlidingRange::Increment,
                _ => SlidingRange::Finite,
            };
            Box::new(at_nodes)
        }
        Method::Gauss | Method::Lobatto => {
            let rule = if method == Method::Gauss {
                gauss(2)
            } else {
                lobatto(3)
            };
            let facets = second.as_ref().unwrap();
            let rule = |e| on_facet(e, &rule);
            let mut inside = PointToSegment::inside(facets, rule);
            inside.closest = closest;
            let points = inside.on_facets().unwrap();
            area = areas_inside(facets, points, at.x, &|_, _, _| 1.0).unwrap();
            Box::new(inside)
        }
        _ => {
            let pairs = points.iter().enumerate();
            let pairs = pairs.map(|(k, &p)| [p, k as NodeId]).collect();
            let normals = match method {
                Method::GivenNormals => {
                    let tilted = Vec3::unit(ndim - 1) + Vec3::new(0.2, 0.1, 0.0);
                    NodeNormals::Given(tilted.normalized().unwrap())
                }
                Method::PrimaryNormals => NodeNormals::Primary(first.unwrap()),
                _ => NodeNormals::Secondary(second.clone().unwrap()),
            };
            Box::new(NodeToNode::new(pairs, normals))
        }
    };
    (discretization, area)
}

impl Scene {
    /// At the start: the secondary side lies about the primary side, a part of it inside.
    pub(crate) fn new(kind: Kind, method: Method, choice: Choice, seed: u64) -> Self {
        let mut random = Random::new(seed);
        let ndim = kind.ndim();
        let Sides {
            x,
            points,
            up,
            secondary,
            first,
            bodies,
            primary,
        } = match kind {
            Kind::Elements(name) => elements(name, ndim, &mut random),
            _ => analytical(kind, &mut random),
        };
        let pose = |body: &RigidBody| signorini_geometry::surface::Pose {
            origin: body.reference,
            rotation: signorini_geometry::tensor::Mat3::IDENTITY,
        };
        let poses: Vec<_> = bodies.iter().map(pose).collect();
        let mut pair = SurfacePair::new(points.clone(), primary, 1.0);
        pair.secondary = secondary;
        let at = Placement {
            x: &x,
            poses: &poses,
        };
        let (discretization, area) = rows_of(method, &choice, &pair, (first, ndim), &at);
        let nrow = discretization.nrow();
        let vectors = choice.bond || choice.friction.is_some();
        let layout = Layout::new(ndim, x.len(), bodies.len())
            .with_multipliers(nrow * nmultiplier(choice.law.as_ref(), vectors, ndim));
        let elimination = Arc::new(Elimination::new(bodies, x.len()));
        let state = State::initial(&layout, &x, &elimination);
        let bond = choice.bond.then(|| {
            let at = state.placement();
            let found = closest_points(discretization.as_ref(), &pair, &at).unwrap();
            let anchor = |(row, found): (usize, &Option<_>)| {
                let found = found.as_ref()?;
                let anchor = discretization.anchor(row, &pair, &at, found, Vec3::ZERO);
                let anchor = anchor.unwrap();
                let offset = anchor.offset + flat(random.vector(), ndim) * 0.02;
                Some(Anchored { offset, ..anchor })
            };
            found.pairs.iter().enumerate().map(anchor).collect()
        });
        let parts = InterfaceParts {
            law: choice.law.into(),
            phases: vec![ContactPhase {
                active: true,
                stands: true,
                present: true,
                friction: choice.friction,
                slip: choice.wear.and_then(|wear| wear.slip),
            }],
            wear: choice.wear.map(|wear| WearParts {
                coefficients: [0.7 * wear.coefficient, 0.3 * wear.coefficient],
                areas: Vec::new(),
            }),
            bond,
            bond_tangential: choice.tangential,
            damping: choice.damping,
            fluid: choice.fluid,
            gasket: choice.gasket,
            cohesion: choice.cohesion,
            measure: Measure::Area,
            area,
            scale: Scale {
                penalty: PENALTY,
                shear: 0.3 * PENALTY,
                length: 1.0,
            },
            ..InterfaceParts::new("rub", pair, discretization, PENALTY)
        };
        let mut interface = Interface::new(parts, layout, elimination.clone());
        interface
            .begin(&Phase::of_step(StepContext::default()), &state)
            .unwrap();
        let still = |(k, node): (usize, &NodeId)| match kind {
            Kind::Elements(_) => x[*node as usize].x < if ndim == 2 { 2.2 } else { 1.1 },
            _ => k.is_multiple_of(2),
        };
        Self {
            still: points.iter().enumerate().map(still).collect(),
            interface,
            layout,
            reference: x,
            elimination,
            state,
            points,
            up,
            method,
        }
    }

    /// After an accepted increment, in the middle of the next: some points stayed where they are, some went on to
    /// other facets.
    pub(crate) fn with_past(kind: Kind, method: Method, choice: Choice, seed: u64) -> Self {
        let mut scene = Self::new(kind, method, choice, seed);
        let mut random = Random::new(seed + 1000);
        let start = scene.state.clone();
        scene.interface.begin(&next_increment(), &start).unwrap();
        scene.state = scene.further(&mut random);
        scene.settle();
        let state = scene.state.clone();
        scene.interface.converged(&state).unwrap();
        scene.interface.accept(&state).unwrap();
        scene.interface.begin(&next_increment(), &state).unwrap();
        scene.state = scene.further(&mut random);
        scene.settle();
        scene
    }

    pub(crate) fn settle(&mut self) {
        self.interface.prepare(&self.state, Order::Tangent).unwrap();
        self.interface.verdict(&self.state);
    }

    /// A state a bit further: some points hardly move, others go far.
    pub(crate) fn further(&self, random: &mut Random) -> State {
        let ndim = self.layout.ndim();
        let mut du = vec![0.0; self.layout.ndof()];
        let together = flat(random.vector(), ndim);
        let still_at = self.points.iter().zip(&self.still).filter(|(_, s)| **s);
        let border = still_at.map(|(&n, _)| self.reference[n as usize].x);
        let border = border.fold(0.0, f64::max);
        let points = self.points.iter().zip(&self.up).zip(&self.still);
        for ((&node, &up), &still) in points {
            let mut way = flat(random.vector(), ndim) * if still { LITTLE } else { FAR };
            if self.method.is_mortar() && !still {
                // facets keep their shape, more or less
                let x = self.reference[node as usize].x;
                way = together * (0.2 * (x - border)) + way * (0.03 / FAR);
            }
            way -= up * (0.95 * way.dot(up));
            for c in 0..ndim {
                du[self.layout.node(node, c) as usize] = way[c];
            }
        }
        for body in 0..self.layout.nrigid() as u32 {
            for c in 0..3 {
                let dofs = [
                    self.layout.translation(body, c),
                    self.layout.rotation(body, c),
                ];
                for dof in dofs.into_iter().filter(|&d| d != NO_DOF) {
                    du[dof as usize] = 0.003 * random.signed();
                }
            }
        }
        let discretization = self.interface.parts().discretization.as_ref();
        let of_row = self.layout.nmultiplier() / discretization.nrow();
        for k in 0..self.layout.nmultiplier() {
            // pressures, and a little along the surface; every fourth row has none
            let (row, along) = (k / of_row, k % of_row);
            let node = discretization.point(row).nodes[0];
            let up = self.up[self.points.binary_search(&node).unwrap()];
            let value = match (row % 4, of_row) {
                (0, _) => 0.0,
                (_, 1) => 0.25 + 0.2 * random.signed(),
                _ => -0.3 * up[along] + 0.04 * random.signed(),
            };
            du[self.layout.multiplier(k) as usize] = value;
        }
        self.moved(&du, 1.0)
    }

    pub(crate) fn moved(&self, du: &[f64], by: f64) -> State {
        let mut state = self.state.clone();
        state.advance_from(
            &self.state,
            du,
            by,
            &self.layout,
            &self.reference,
            &self.elimination,
        );
        state
    }

    /// Everything at a state, after a search of its own.
    pub(crate) fn respond(&mut self, state: &State, order: Order) -> Whole {
        self.interface.prepare(state, Order::Tangent).unwrap();
        let mut whole = Whole::new(self.layout.ndof(), order);
        let mut work = Work::default();
        for chunk in 0..self.interface.nchunk() {
            self.interface
                .evaluate(chunk, state, order, &mut work, &mut whole)
                .unwrap();
        }
        whole
    }

    pub(crate) fn report(&self) -> ContactFrame {
        let mut frame = Frame::new(self.layout.nnode(), &[]);
        self.interface.report(&self.state, &mut frame).unwrap();
        frame.contacts.remove(0)
    }

    /// Force on a node.
    pub(crate) fn on_node(&self, force: &[f64], node: NodeId) -> Vec3 {
        let mut f = Vec3::ZERO;
        for c in 0..self.layout.ndim() {
            f[c] = force[self.layout.node(node, c) as usize];
        }
        f
    }

    /// Sum of all forces, of their moments about the origin, and of their sizes.
    pub(crate) fn resultant(&self, force: &[f64]) -> (Vec3, Vec3, f64) {
        let (mut sum, mut moment, mut size) = (Vec3::ZERO, Vec3::ZERO, 0.0);
        for (node, x) in self.state.x.iter().enumerate() {
            let f = self.on_node(force, node as NodeId);
            sum += f;
            moment += x.cross(f);
            size += f.norm();
        }
        for (body, pose) in self.state.poses.iter().enumerate() {
            let at = |dof: Dof| force.get(dof as usize).copied().unwrap_or(0.0);
            let (mut f, mut m) = (Vec3::ZERO, Vec3::ZERO);
            for c in 0..3 {
                f[c] = at(self.layout.translation(body as u32, c));
                m[c] = at(self.layout.rotation(body as u32, c));
            }
            sum += f;
            moment += pose.origin.cross(f) + m;
        }
        (sum, moment, size)
    }

    /// Σ (r − ρ) × f over the nodes of a method that has one row for each: what the moments of pairs at a distance
    /// add up to.
    pub(crate) fn moment_of_pairs(&self, force: &[f64], between_nodes: bool) -> Vec3 {
        let parts = self.interface.parts();
        let mut jet = SurfaceJet::default();
        let mut moment = Vec3::ZERO;
        for (row, pair) in self.interface.pairing().pairs.iter().enumerate() {
            let Some(pair) = pair else { continue };
            let node = parts.discretization.point(row).nodes[0];
            let from = if between_nodes {
                self.state.x[row]
            } else {
                let at = self.state.placement();
                parts.pair.primary.jet(&at, &pair.anchor, &mut jet).unwrap();
                jet.position
            };
            let away = self.state.x[node as usize] - from;
            moment += away.cross(self.on_node(force, node));
        }
        moment
    }

    /// Which pairs of unknowns the pattern couples.
    pub(crate) fn pattern(&self) -> Coupled {
        let mut pattern = Coupled::new(self.layout.ndof());
        self.interface.pattern(&mut pattern);
        pattern
    }

    /// Whether the choices at a state are those of the one judged before.
    pub(crate) fn is_settled(&mut self, state: &State) -> bool {
        self.interface.verdict(state) == Verdict::Settled
    }
}

fn flat(v: Vec3, ndim: usize) -> Vec3 {
    if ndim == 2 {
        Vec3::new(v.x, v.y, 0.0)
    } else {
        v
    }
}

/// Force and stiffness of all unknowns.
pub(crate) struct Whole {
    pub force: Vec<f64>,
    pub stiffness: Vec<f64>,
    /// The most unknowns that came at once.
    pub most: usize,
}

impl Whole {
    fn new(n: usize, order: Order) -> Self {
        let square = match order {
            Order::Residual => 0,
            Order::Tangent => n * n,
        };
        Self {
            force: vec![0.0; n],
            stiffness: vec![0.0; square],
            most: 0,
        }
    }

    pub(crate) fn along(&self, v: &[f64]) -> Vec<f64> {
        let lines = self.stiffness.chunks_exact(v.len());
        lines
            .map(|line| line.iter().zip(v).map(|(k, v)| k * v).sum())
            .collect()
    }

    /// The largest difference from the transpose, over the largest entry, among these unknowns.
    pub(crate) fn asymmetry(&self) -> f64 {
        let n = self.force.len();
        let mut odd = 0.0f64;
        for i in 0..n {
            for j in 0..i {
                odd = odd.max((self.stiffness[i * n + j] - self.stiffness[j * n + i]).abs());
            }
        }
        odd / super::largest(&self.stiffness)
    }
}

impl Sink for Whole {
    fn add(&mut self, dofs: &[Dof], force: &[f64], stiffness: &[f64]) {
        let n = self.force.len();
        self.most = self.most.max(dofs.len());
        for (i, &p) in dofs.iter().enumerate().filter(|d| *d.1 != NO_DOF) {
            self.force[p as usize] += force[i];
            if stiffness.is_empty() {
                continue;
            }
            for (j, &q) in dofs.iter().enumerate().filter(|d| *d.1 != NO_DOF) {
                self.stiffness[p as usize * n + q as usize] += stiffness[i * dofs.len() + j];
            }
        }
    }

    fn couple(&mut self, rows: &[Dof], columns: &[Dof], stiffness: &[f64]) {
        crate::system::couple_as_square(self, rows, columns, stiffness);
    }

    fn uncertain(&mut self, _: &[Dof], _: f64) {}
}

/// A dense pattern.
pub(crate) struct Coupled {
    n: usize,
    pairs: Vec<bool>,
}

impl Coupled {
    fn new(n: usize) -> Self {
        Self {
            n,
            pairs: vec![false; n * n],
        }
    }

    pub(crate) fn covers(&self, whole: &Whole) -> bool {
        let entries = whole.stiffness.iter().zip(&self.pairs);
        entries
            .into_iter()
            .all(|(k, coupled)| *coupled || *k == 0.0)
    }
}

impl PatternSink for Coupled {
    fn bulk(&mut self, _: &[NodeId]) {}

    fn coupling(&mut self, ones: &[Dof], others: &[Dof]) {
        self.interface(&[ones, others].concat());
    }

    fn interface(&mut self, dofs: &[Dof]) {
        for &p in dofs.iter().filter(|d| **d != NO_DOF) {
            for &q in dofs.iter().filter(|d| **d != NO_DOF) {
                self.pairs[p as usize * self.n + q as usize] = true;
            }
        }
    }
}
