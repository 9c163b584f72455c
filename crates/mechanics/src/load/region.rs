use crate::system::{Idealisation, profile_at};
use signorini_geometry::element::Element;
use signorini_geometry::element::quadrature::Rule;
use signorini_geometry::mesh::NodeId;
use signorini_geometry::tensor::Vec3;

/// Pieces evaluated together: enough to be worth a task, few enough to stay in cache.
const CHUNK: usize = 64;

/// Where a load acts: faces or cells, sorted by their elements.
#[derive(Default)]
pub struct Region {
    patches: Vec<Patch>,
}

/// Pieces of one element and idealisation.
pub(super) struct Patch {
    element: Element,
    rule: &'static Rule,
    /// What the plane of its pieces stands for.
    space: Idealisation,
    /// At each quadrature point, those of all nodes.
    shape: Vec<f64>,
    dshape: Vec<Vec3>,
    nodes: Vec<NodeId>,
    /// What the measure of each piece is multiplied by.
    factors: Vec<f64>,
    /// What the thickness is multiplied by at the nodes of each piece; empty where that is 1.
    profiles: Vec<f64>,
}

/// A face or a cell.
#[derive(Clone, Copy)]
pub(super) struct Piece<'a> {
    pub nodes: &'a [NodeId],
    factor: f64,
    profile: &'a [f64],
}

/// A quadrature point of a reference element.
pub(super) struct Sample<'a> {
    pub shape: &'a [f64],
    pub dshape: &'a [Vec3],
    pub weight: f64,
}

impl Region {
    /// Adds a face or a cell. Its measure counts `factor` times: the cross-section of a bar, a density.
    pub fn push(&mut self, element: Element, space: Idealisation, nodes: &[NodeId], factor: f64) {
        let rule = element.surface_rule();
        self.push_by((element, rule), (space, None), nodes, factor);
    }

    /// The same, integrated by this rule, with what the thickness is multiplied by at every node of the mesh; none: 1.
    pub fn push_by(
        &mut self,
        (element, rule): (Element, &'static Rule),
        (space, profile): (Idealisation, Option<&[f64]>),
        nodes: &[NodeId],
        factor: f64,
    ) {
        debug_assert_eq!(nodes.len(), element.nnode());
        let alike = |p: &Patch| {
            let has_profile = !p.profiles.is_empty();
            let alike = *p.element == *element && std::ptr::eq(p.rule, rule) && p.space == space;
            alike && has_profile == profile.is_some()
        };
        let at = self.patches.iter().position(alike).unwrap_or_else(|| {
            self.patches.push(Patch::new(element, rule, space));
            self.patches.len() - 1
        });
        let patch = &mut self.patches[at];
        patch.nodes.extend_from_slice(nodes);
        patch.factors.push(factor);
        if let Some(profile) = profile {
            let at = |&node: &NodeId| profile.get(node as usize).copied().unwrap_or(1.0);
            patch.profiles.extend(nodes.iter().map(at));
        }
    }

    /// Whether nothing is in it.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.patches.is_empty()
    }

    pub(super) fn patches(&self) -> &[Patch] {
        &self.patches
    }

    /// Patch, first and last piece of each chunk.
    pub(super) fn chunks(&self) -> Vec<(usize, usize, usize)> {
        let of_patch = |(number, patch): (usize, &Patch)| {
            let n = patch.npiece();
            let starts = (0..n).step_by(CHUNK);
            starts
                .map(move |first| (number, first, (first + CHUNK).min(n)))
                .collect::<Vec<_>>()
        };
        self.patches.iter().enumerate().flat_map(of_patch).collect()
    }

    /// Every piece, with its quadrature points.
    pub(super) fn pieces(&self) -> impl Iterator<Item = (&Patch, Piece<'_>)> {
        self.patches.iter().flat_map(|patch| {
            let pieces = patch.pieces(0, patch.npiece());
            pieces.map(move |piece| (patch, piece))
        })
    }
}

impl Patch {
    fn new(element: Element, rule: &'static Rule, space: Idealisation) -> Self {
        let n = element.nnode();
        let mut shape = vec![0.0; n * rule.npoint()];
        let mut dshape = vec![Vec3::ZERO; n * rule.npoint()];
        let at_points = shape.chunks_exact_mut(n).zip(dshape.chunks_exact_mut(n));
        for (xi, (shape, dshape)) in rule.points.iter().zip(at_points) {
            element.shape(xi, shape);
            element.dshape(xi, dshape);
        }
        Self {
            element,
            rule,
            space,
            shape,
            dshape,
            nodes: Vec::new(),
            factors: Vec::new(),
            profiles: Vec::new(),
        }
    }

    pub fn space(&self) -> Idealisation {
        self.space
    }

    pub fn nnode(&self) -> usize {
        self.element.nnode()
    }

    fn npiece(&self) -> usize {
        self.factors.len()
    }

    /// Some of its pieces.
    pub fn pieces(&self, first: usize, last: usize) -> impl Iterator<Item = Piece<'_>> {
        let n = self.nnode();
        let nodes = self.nodes[first * n..last * n].chunks_exact(n);
        let numbered = nodes.zip(&self.factors[first..last]).zip(first..);
        numbered.map(move |((nodes, &factor), piece)| Piece {
            nodes,
            factor,
            profile: self
                .profiles
                .get(piece * n..(piece + 1) * n)
                .unwrap_or_default(),
        })
    }

    pub fn samples(&self) -> impl Iterator<Item = Sample<'_>> {
        let n = self.nnode();
        let at_points = self.shape.chunks_exact(n).zip(self.dshape.chunks_exact(n));
        at_points
            .zip(self.rule.weights)
            .map(|((shape, dshape), &weight)| Sample {
                shape,
                dshape,
                weight,
            })
    }

    /// dV of a cell at a quadrature point, from the positions of its nodes: a volume, in the plane an area times its
    /// extent, of a bar a length; times the factors of the piece.
    pub fn volume(&self, piece: &Piece<'_>, sample: &Sample<'_>, x: &[Vec3]) -> f64 {
        let t = |a| sample.tangent(x, a);
        let measure = match self.element.dim() {
            3 => t(0).cross(t(1)).dot(t(2)),
            2 => t(0).cross(t(1)).z * self.space.extent(sample.position(x)),
            _ => t(0).norm(),
        };
        measure * sample.weight_in(piece)
    }
}

impl Sample<'_> {
    /// Quadrature weight, times what the measure of a piece is multiplied by here.
    pub fn weight_in(&self, piece: &Piece<'_>) -> f64 {
        self.weight * piece.factor * profile_at(piece.profile, self.shape)
    }

    pub fn position(&self, x: &[Vec3]) -> Vec3 {
        x.iter().zip(self.shape).map(|(x, n)| *x * *n).sum()
    }

    /// ∂x/∂ξ_a
    pub fn tangent(&self, x: &[Vec3], a: usize) -> Vec3 {
        x.iter().zip(self.dshape).map(|(x, dn)| *x * dn[a]).sum()
    }

    /// t1 and t2 of a face (E3): `t1 × t2` is its directed area. In the plane t2 is what lies across it.
    pub fn tangents(&self, space: Idealisation, x: &[Vec3]) -> (Vec3, Vec3) {
        let across = match space {
            Idealisation::Space => self.tangent(x, 1),
            _ => Vec3::unit(2) * space.extent(self.position(x)),
        };
        (self.tangent(x, 0), across)
    }
}
