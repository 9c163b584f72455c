//! A surface made of facets of elements: faces of solids in space, edges of solids in the plane.

use super::{
    Anchor, Carrier, ContactSurface, Feature, Outward, Placement, Projection, SurfaceError,
    SurfaceJet, pair,
};
use crate::element::{Element, Family, MAX_FACET_NODES};
use crate::mesh::{Face, Mesh, NodeId};
use crate::proximity::Aabb;
use crate::tensor::{Sym3, Vec3};
use std::collections::HashMap;
use thiserror::Error;

/// The extent of a facet across the plane where its nodes have these shape functions, at a position.
pub type Extent<'a> = dyn Fn(u32, &[f64], Vec3) -> f64 + 'a;

/// Facets of elements, with who is whose neighbour.
///
/// # Example
/// ```
/// use signorini_geometry::element::by_name;
/// use signorini_geometry::mesh::{Mesh, boundary};
/// use signorini_geometry::tensor::Vec3;
///
/// let brick = by_name("hex8").ok_or("not in the table")?;
/// let mut mesh = Mesh::default();
/// for z in 0..3 {
///     for [x, y] in [[0, 0], [1, 0], [1, 1], [0, 1]] {
///         mesh.points.push(Vec3::from([x, y, z].map(f64::from)));
///         mesh.node_labels.push(mesh.points.len() as u64);
///     }
/// }
/// mesh.push_cell(brick, &[0, 1, 2, 3, 4, 5, 6, 7], 1);
/// mesh.push_cell(brick, &[4, 5, 6, 7, 8, 9, 10, 11], 2);
///
/// use signorini_geometry::surface::{ContactSurface, Facets, Placement, SurfaceJet};
///
/// let surface = Facets::new(&mesh, &boundary(&mesh, mesh.cells(3)))?;
/// let at = Placement { x: &mesh.points, poses: &[] };
/// let point = Vec3::new(0.25, 0.75, 2.5);
/// let mut jet = SurfaceJet::default();
/// let mut distances = Vec::new();
/// for facet in 0..surface.nfacet() as u32 {
///     let found = surface.project(&at, facet, point, None, &mut jet)?;
///     distances.extend(found.map(|found| found.distance));
/// }
/// // the top, at z = 2, is closest
/// assert_eq!(distances.into_iter().fold(f64::INFINITY, f64::min), 0.5);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Facets {
    ntan: usize,
    elements: Vec<Element>,
    // nodes of facet f: nodes[first[f]..first[f + 1]]
    first: Vec<u32>,
    nodes: Vec<NodeId>,
    neighbour_first: Vec<u32>,
    neighbours: Vec<u32>,
    /// Corners at which the surface ends.
    rim_nodes: Vec<NodeId>,
    faces: Vec<Face>,
}

/// Why a surface cannot be made.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum FacetsError {
    /// Nothing to make it of.
    #[error("the surface has no faces")]
    Empty,
    /// A face that the mesh does not have.
    #[error("element {label} has no side {side}")]
    NoSuchFace {
        /// Its number in the input.
        label: u64,
        /// Number of the side, from 1.
        side: u8,
    },
}

impl Facets {
    /// The surface made of these faces of a mesh. Facet `i` is `faces[i]`.
    ///
    /// # Errors
    /// No faces, or a face that the mesh does not have.
    pub fn new(mesh: &Mesh, faces: &[Face]) -> Result<Self, FacetsError> {
        let mut elements = Vec::with_capacity(faces.len());
        let mut first = vec![0u32];
        let mut nodes = Vec::new();
        for &face in faces {
            let missing = || FacetsError::NoSuchFace {
                label: mesh.cell_label(face.cell).unwrap_or(0),
                side: face.side + 1,
            };
            let (element, of_face) = mesh.face(face).ok_or_else(missing)?;
            elements.push(element);
            nodes.extend(of_face);
            first.push(nodes.len() as u32);
        }
        Self::connected(elements, first, nodes, faces.to_vec()).ok_or(FacetsError::Empty)
    }

    /// The surface of triangles that are sides of nothing. `None` where there are none.
    pub(super) fn of_triangles(triangles: &[[NodeId; 3]]) -> Option<Self> {
        let elements = vec![Family::Triangle.linear(); triangles.len()];
        let first = (0..=triangles.len() as u32).map(|f| 3 * f).collect();
        Self::connected(elements, first, triangles.concat(), Vec::new())
    }

    /// The surface of these facets; `None` where there are none.
    pub(super) fn connected(
        elements: Vec<Element>,
        first: Vec<u32>,
        nodes: Vec<NodeId>,
        faces: Vec<Face>,
    ) -> Option<Self> {
        let ntan = elements.first()?.dim();
        let mut surface = Self {
            ntan,
            elements,
            first,
            nodes,
            neighbour_first: Vec::new(),
            neighbours: Vec::new(),
            rim_nodes: Vec::new(),
            faces,
        };
        surface.connect();
        Some(surface)
    }

    /// Finds neighbours and rims.
    fn connect(&mut self) {
        let nfacet = self.elements.len() as u32;
        let mut facets_of: HashMap<NodeId, Vec<u32>> = HashMap::new();
        let mut edges: HashMap<[NodeId; 2], u32> = HashMap::new();
        for f in 0..nfacet {
            for &n in self.corners(f) {
                facets_of.entry(n).or_default().push(f);
            }
            for edge in self.edges(f) {
                *edges.entry(edge).or_default() += 1;
            }
        }
        self.neighbour_first.push(0);
        let mut near: Vec<u32> = Vec::new();
        for f in 0..nfacet {
            near.clear();
            for n in self.corners(f) {
                near.extend(facets_of.get(n).into_iter().flatten());
            }
            near.sort_unstable();
            near.dedup();
            near.retain(|&g| g != f);
            self.neighbours.extend_from_slice(&near);
            self.neighbour_first.push(self.neighbours.len() as u32);
        }
        if self.ntan == 1 {
            let single = facets_of.iter().filter(|(_, f)| f.len() == 1);
            self.rim_nodes = single.map(|(&n, _)| n).collect();
        } else {
            let single = edges.iter().filter(|&(_, &count)| count == 1);
            self.rim_nodes = single.flat_map(|(&e, _)| e).collect();
        }
        self.rim_nodes.sort_unstable();
        self.rim_nodes.dedup();
    }

    /// The nodes of a facet.
    #[must_use]
    pub fn nodes(&self, facet: u32) -> &[NodeId] {
        let f = facet as usize;
        match (self.first.get(f), self.first.get(f + 1)) {
            (Some(&a), Some(&b)) => self.nodes.get(a as usize..b as usize).unwrap_or(&[]),
            _ => &[],
        }
    }

    /// The nodes in which the edges of a facet end.
    fn corners(&self, facet: u32) -> &[NodeId] {
        let ncorner = self.element(facet).map_or(0, |e| e.ncorner());
        self.nodes(facet).get(..ncorner).unwrap_or(&[])
    }

    /// The reference element of a facet.
    #[must_use]
    pub fn element(&self, facet: u32) -> Option<Element> {
        self.elements.get(facet as usize).copied()
    }

    /// The face of the mesh that a facet is; `None` for triangles that are sides of nothing.
    #[must_use]
    pub fn face(&self, facet: u32) -> Option<Face> {
        self.faces.get(facet as usize).copied()
    }

    /// All nodes of the surface, sorted, each once.
    #[must_use]
    pub fn all_nodes(&self) -> Vec<NodeId> {
        let mut nodes = self.nodes.clone();
        nodes.sort_unstable();
        nodes.dedup();
        nodes
    }

    /// `∫ N_i e dA` of every node over all facets, in the order of [`Facets::all_nodes`]; `dA` is a length in the plane,
    /// and `e` the [`Extent`] across it (thickness, circumference; 1 in space). These are the forces
    /// of a unit traction: at the corners of tri6 and quad8 they vanish or are negative.
    ///
    /// # Errors
    /// A facet without a normal.
    ///
    /// # Example
    /// ```
    /// use signorini_geometry::element::by_name;
    /// use signorini_geometry::mesh::{Mesh, boundary};
    /// use signorini_geometry::surface::Facets;
    /// use signorini_geometry::tensor::Vec3;
    ///
    /// let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    /// let mut mesh = Mesh {
    ///     points: corners.map(Vec3::from).to_vec(),
    ///     node_labels: vec![1, 2, 3, 4],
    ///     ..Mesh::default()
    /// };
    /// mesh.push_cell(by_name("tet4").ok_or("not in the table")?, &[0, 1, 2, 3], 1);
    /// let surface = Facets::new(&mesh, &boundary(&mesh, mesh.cells(3)))?;
    /// let areas = surface.nodal_areas(&mesh.points, &|_, _, _| 1.0)?;
    /// // three right-angled triangles and one with sides √2
    /// let exact = 1.5 + 3_f64.sqrt() / 2.0;
    /// assert!((areas.iter().map(|(_, area)| area).sum::<f64>() - exact).abs() < 1e-14);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn nodal_areas(
        &self,
        x: &[Vec3],
        extent: &Extent<'_>,
    ) -> Result<Vec<(NodeId, f64)>, SurfaceError> {
        self.gather(|facet| Ok(self.integrals(x, facet, extent)?.0))
    }

    /// Positive areas of every node that sum to the area, in the order and with the extent of [`Facets::nodal_areas`]. On
    /// facets with mid nodes, the area of the facet in the ratio of `∫ N_i² e dA`; on the others, whose shape functions
    /// are nowhere negative, the same areas. An undistorted line3 or quad9 has the same areas too.
    ///
    /// # Errors
    /// A facet without a normal.
    ///
    /// # Source
    /// Hinton, Rock, Zienkiewicz, Earthquake Eng. Struct. Dyn. 4, 1976.
    pub fn lumped_areas(
        &self,
        x: &[Vec3],
        extent: &Extent<'_>,
    ) -> Result<Vec<(NodeId, f64)>, SurfaceError> {
        self.gather(|facet| {
            let (consistent, squares) = self.integrals(x, facet, extent)?;
            if self.element(facet).is_none_or(|e| e.is_linear()) {
                return Ok(consistent);
            }
            let area: f64 = consistent.iter().sum();
            let sum: f64 = squares.iter().sum();
            Ok(squares.map(|s| s * (area / sum)))
        })
    }

    /// Shape functions at a point of a facet, 0 beyond its last node, and area (length, in the plane) per unit of the
    /// parameters there.
    ///
    /// # Errors
    /// A facet that does not exist or has no normal.
    pub fn sample(
        &self,
        x: &[Vec3],
        facet: u32,
        local: Vec3,
    ) -> Result<([f64; MAX_FACET_NODES], f64), SurfaceError> {
        let mut jet = SurfaceJet::default();
        let at = Placement { x, poses: &[] };
        self.jet(&at, &Anchor { facet, local }, &mut jet)?;
        jet.shape[jet.nnode..].fill(0.0);
        Ok((jet.shape, area_factor(&jet, self.ntan)))
    }

    /// Adds up what each facet gives its nodes, in the order of [`Facets::all_nodes`].
    fn gather(
        &self,
        of_facet: impl Fn(u32) -> Result<[f64; MAX_FACET_NODES], SurfaceError>,
    ) -> Result<Vec<(NodeId, f64)>, SurfaceError> {
        let mut sums: Vec<(NodeId, f64)> = self.all_nodes().into_iter().map(|n| (n, 0.0)).collect();
        for facet in 0..self.elements.len() as u32 {
            for (node, value) in self.nodes(facet).iter().zip(of_facet(facet)?) {
                if let Ok(k) = sums.binary_search_by_key(node, |a| a.0) {
                    sums[k].1 += value;
                }
            }
        }
        Ok(sums)
    }

    /// `∫ N_i e dA` and `∫ N_i² e dA` over a facet, 0 beyond its last node.
    fn integrals(
        &self,
        x: &[Vec3],
        facet: u32,
        extent: &Extent<'_>,
    ) -> Result<([f64; MAX_FACET_NODES], [f64; MAX_FACET_NODES]), SurfaceError> {
        let missing = SurfaceError::NoSuchFacet { facet };
        let element = self.element(facet).ok_or(missing)?;
        let at = Placement { x, poses: &[] };
        let mut jet = SurfaceJet::default();
        let (mut first, mut second) = ([0.0; MAX_FACET_NODES], [0.0; MAX_FACET_NODES]);
        for (xi, weight) in element.surface_rule().iter() {
            let anchor = Anchor { facet, local: *xi };
            self.jet(&at, &anchor, &mut jet)?;
            let area = weight
                * area_factor(&jet, self.ntan)
                * extent(facet, &jet.shape[..jet.nnode], jet.position);
            for (i, n) in jet.shape.iter().take(jet.nnode).enumerate() {
                first[i] += n * area;
                second[i] += n * n * area;
            }
        }
        Ok((first, second))
    }

    /// The edges of a facet as sorted pairs of end nodes.
    fn edges(&self, facet: u32) -> impl Iterator<Item = [NodeId; 2]> + '_ {
        let nodes = self.nodes(facet);
        let edges = self.element(facet).map_or(&[][..], |e| e.edges());
        edges.iter().filter_map(|&[a, b]| {
            let (a, b) = (*nodes.get(a)?, *nodes.get(b)?);
            Some([a.min(b), a.max(b)])
        })
    }

    /// The nodes of a facet whose shape functions do not vanish at a point of it.
    fn support<'a>(
        &'a self,
        facet: u32,
        jet: &'a SurfaceJet,
    ) -> impl Iterator<Item = NodeId> + Clone + 'a {
        let weights = jet.shape.iter().take(jet.nnode);
        let nodes = self.nodes(facet).iter().zip(weights);
        nodes.filter(|(_, n)| n.abs() > 1e-9).map(|(&n, _)| n)
    }

    /// The end nodes of the edge of a facet that runs through a point of it in this direction. Where the point is an
    /// end of the edge, shape functions alone do not show which edge that is.
    fn edge_ends(&self, facet: u32, local: Vec3, direction: [f64; 2]) -> Option<[NodeId; 2]> {
        let (element, nodes) = (self.element(facet)?, self.nodes(facet));
        let corners = element.nodes();
        let offset = |&[a, b]: &[usize; 2]| {
            let (from, along) = (local - corners[a], corners[b] - corners[a]);
            let turned = along.x * direction[1] - along.y * direction[0];
            turned.abs() + (along.x * from.y - along.y * from.x).abs()
        };
        let nearer = |p: &&[usize; 2], q: &&[usize; 2]| offset(p).total_cmp(&offset(q));
        let &[a, b] = element.edges().iter().min_by(nearer)?;
        Some([*nodes.get(a)?, *nodes.get(b)?])
    }

    /// The angle between the edges of a facet that meet at one of its nodes.
    fn corner_angle(
        &self,
        facet: u32,
        node: NodeId,
        at: &Placement,
    ) -> Result<(f64, Vec3), SurfaceError> {
        let missing = SurfaceError::NoSuchFacet { facet };
        let element = self.element(facet).ok_or(missing.clone())?;
        let place = self.nodes(facet).iter().position(|&n| n == node);
        let k = place.ok_or(missing)?;
        let nodes = element.nodes();
        let mut jet = SurfaceJet::default();
        let anchor = Anchor {
            facet,
            local: nodes[k],
        };
        self.jet(at, &anchor, &mut jet)?;
        let mut directions = element.edges().iter().filter(|e| e.contains(&k)).map(|e| {
            let other = if e[0] == k { e[1] } else { e[0] };
            let d = nodes[other] - nodes[k];
            jet.tangent[0] * d.x + jet.tangent[1] * d.y
        });
        let angle = match (directions.next(), directions.next()) {
            (Some(a), Some(b)) => a.cross(b).norm().atan2(a.dot(b)),
            _ => 1.0, // in the plane both sides weigh the same
        };
        Ok((angle, jet.normal))
    }
}

/// A box around a facet. A polynomial facet lies in the convex hull of its control points: those of degree 2 are
///
/// ```text
/// b_e = 2 x_e − ½ (x_a + x_b)                 on the edge from a to b with mid node e
/// b_c = 4 ρ(0) − Σ x_e + ¼ Σ x_a              in the middle of a quadrilateral
/// ```
///
/// and the corners, as a comparison of the quadratic Lagrange and Bernstein polynomials along each axis shows.
///
/// Above degree 2, with the map `L` of the linear element through the corners,
///
/// ```text
/// |ρ − L| = |Σ N_i (x_i − L(ξ_i))| ≤ max |N_i| Σ |x_i − L(ξ_i)|       over the other nodes i, for each coordinate
/// ```
fn box_around(element: Element, x: &[Vec3]) -> Aabb {
    let ncorner = element.ncorner();
    if element.is_linear() {
        return Aabb::around(x.iter().copied());
    }
    let (corners, others) = x.split_at(ncorner);
    if element.order() > 2 {
        let linear = element.family().linear();
        let mut shape = [0.0; MAX_FACET_NODES];
        let mut most = Vec3::ZERO;
        for (xi, &x) in element.nodes().iter().skip(ncorner).zip(others) {
            linear.shape(xi, &mut shape[..ncorner]);
            let on_linear: Vec3 = corners.iter().zip(shape).map(|(&x, n)| x * n).sum();
            let away = (x - on_linear).to_array().map(f64::abs);
            most += Vec3::from(away) * LARGEST_SHAPE;
        }
        let bounds = Aabb::around(corners.iter().copied());
        return Aabb::around([bounds.min - most, bounds.max + most]);
    }
    let edges = element
        .mid_nodes()
        .map(|(m, [a, b])| x[m] * 2.0 - (x[a] + x[b]) * 0.5);
    let middle = (element.family() == Family::Quadrilateral).then(|| {
        let mut shape = [0.0; MAX_FACET_NODES];
        element.shape(&Vec3::ZERO, &mut shape[..x.len()]);
        let centre: Vec3 = x.iter().zip(shape).map(|(&x, n)| x * n).sum();
        let of_edges: Vec3 = others.iter().take(4).copied().sum();
        centre * 4.0 - of_edges + corners.iter().copied().sum::<Vec3>() * 0.25
    });
    Aabb::around(corners.iter().copied().chain(edges).chain(middle))
}

/// A bound of the shape functions of nodes that are no corners, of facets above degree 2: in the domain those of equal
/// distances reach 1.06 for cubic ones.
pub(super) const LARGEST_SHAPE: f64 = 1.1;

/// Area (length, in the plane) per unit of the parameters.
fn area_factor(jet: &SurfaceJet, ntan: usize) -> f64 {
    if ntan == 1 {
        jet.tangent[0].norm()
    } else {
        jet.tangent[0].cross(jet.tangent[1]).norm()
    }
}

impl ContactSurface for Facets {
    fn ntan(&self) -> usize {
        self.ntan
    }

    fn nfacet(&self) -> usize {
        self.elements.len()
    }

    fn carrier(&self, facet: u32) -> Carrier<'_> {
        Carrier::Nodes(self.nodes(facet))
    }

    fn aabb(&self, at: &Placement, facet: u32) -> Aabb {
        let mut x = [Vec3::ZERO; MAX_FACET_NODES];
        let nodes = self.nodes(facet);
        for (x, &node) in x.iter_mut().zip(nodes) {
            *x = at.x.get(node as usize).copied().unwrap_or_default();
        }
        let element = self.element(facet);
        element.map_or(Aabb::EMPTY, |e| box_around(e, &x[..nodes.len()]))
    }

    fn size(&self, at: &Placement, facet: u32) -> f64 {
        let Some(element) = self.element(facet) else {
            return 0.0;
        };
        let mut jet = SurfaceJet::default();
        let mut area = 0.0;
        for (xi, weight) in element.surface_rule().iter() {
            let anchor = Anchor { facet, local: *xi };
            if self.jet(at, &anchor, &mut jet).is_ok() {
                area += weight * area_factor(&jet, self.ntan);
            }
        }
        if self.ntan == 1 { area } else { area.sqrt() }
    }

    fn jet(
        &self,
        at: &Placement,
        point: &Anchor,
        out: &mut SurfaceJet,
    ) -> Result<(), SurfaceError> {
        let facet = point.facet;
        let missing = SurfaceError::NoSuchFacet { facet };
        let nodes = self.nodes(facet);
        let element = self.element(facet).ok_or(missing.clone())?;
        let n = nodes.len();
        let mut dshape = [Vec3::ZERO; MAX_FACET_NODES];
        let mut ddshape = [Sym3::ZERO; MAX_FACET_NODES];
        element.shape(&point.local, &mut out.shape[..n]);
        element.dshape(&point.local, &mut dshape[..n]);
        element.ddshape(&point.local, &mut ddshape[..n]);
        out.nnode = n;
        out.position = Vec3::ZERO;
        out.tangent = [Vec3::ZERO; 2];
        out.curvature = [Vec3::ZERO; 3];
        for (i, &node) in nodes.iter().enumerate() {
            let x = *at.x.get(node as usize).ok_or(missing.clone())?;
            let (d, dd) = (dshape[i], ddshape[i]);
            out.dshape[i] = [d.x, d.y];
            out.position += x * out.shape[i];
            out.tangent[0] += x * d.x;
            out.tangent[1] += x * d.y;
            out.curvature[pair(0, 0)] += x * dd.xx();
            out.curvature[pair(1, 1)] += x * dd.yy();
            out.curvature[pair(0, 1)] += x * dd.xy();
        }
        let [t1, t2] = out.tangent;
        let (direction, scale) = if self.ntan == 1 {
            (t1.cross(Vec3::unit(2)), t1.norm())
        } else {
            (t1.cross(t2), t1.norm() * t2.norm())
        };
        let length = direction.norm();
        // a facet is degenerate when its tangents are parallel to round-off
        if length <= 1e-12 * scale || !length.is_finite() {
            return Err(SurfaceError::Degenerate { facet });
        }
        out.normal = direction / length;
        out.metric = [t1.dot(t1), t2.dot(t2), t1.dot(t2)];
        Ok(())
    }

    fn domain(&self, facet: u32) -> Option<Element> {
        self.element(facet)
    }

    fn crossing(&self, at: &Placement, facet: u32, origin: Vec3, direction: Vec3) -> Option<f64> {
        self.crossed_at(at.x, facet, origin, direction)
    }

    fn neighbours(&self, facet: u32) -> &[u32] {
        let f = facet as usize;
        match (self.neighbour_first.get(f), self.neighbour_first.get(f + 1)) {
            (Some(&a), Some(&b)) => self.neighbours.get(a as usize..b as usize).unwrap_or(&[]),
            _ => &[],
        }
    }

    fn outward(&self, at: &Placement, found: &Projection) -> Result<Outward, SurfaceError> {
        let facet = found.anchor.facet;
        let mut jet = SurfaceJet::default();
        self.jet(at, &found.anchor, &mut jet)?;
        if found.feature == Feature::Face {
            return Ok(Outward {
                direction: jet.normal,
                rim: false,
            });
        }
        if let Feature::Edge { direction } = found.feature {
            let ends = self.edge_ends(facet, found.anchor.local, direction);
            let ends = ends.ok_or(SurfaceError::NoSuchFacet { facet })?;
            let around = |g: &&u32| ends.iter().all(|n| self.nodes(**g).contains(n));
            let neighbours = self.neighbours(facet).iter().filter(around).copied();
            let mut direction = jet.normal;
            let mut other = SurfaceJet::default();
            let mut count = 0;
            for g in neighbours {
                count += 1;
                if self
                    .project(at, g, jet.position, None, &mut other)?
                    .is_some()
                {
                    direction += other.normal;
                }
            }
            return Ok(Outward {
                direction,
                rim: count == 0,
            });
        }
        let node = self.support(facet, &jet).next();
        let node = node.ok_or(SurfaceError::NoSuchFacet { facet })?;
        let mut direction = Vec3::ZERO;
        let around = |g: &&u32| self.nodes(**g).contains(&node);
        let neighbours = self.neighbours(facet).iter().filter(around);
        for g in neighbours.copied().chain([facet]) {
            let (angle, normal) = self.corner_angle(g, node, at)?;
            direction += normal * angle;
        }
        Ok(Outward {
            direction,
            rim: self.rim_nodes.binary_search(&node).is_ok(),
        })
    }
}
