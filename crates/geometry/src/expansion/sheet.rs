//! The surface of all shells, with the stations at which their quadrilaterals have corners.

use super::edges::{Middles, NONE};
use super::error::ExpansionError;
use super::input::Joining;
use super::pattern::{ACROSS, ALONG, FOUR, Pattern, THREE, WHOLE};
use super::shell::Shell;
use crate::element::{Element, Family, TABLE};
use crate::mesh::{CellId, Mesh, NodeId};
use crate::tensor::Vec3;

/// The most nodes of a shell.
const NPLACE: usize = 9;
/// The sine of the angle between edges below which a cell has no area.
const FLAT: f64 = 1e-10;

/// A corner of a quadrilateral.
#[derive(Clone, Copy)]
pub(super) struct Station {
    pub node: NodeId,
    pub thickness: f64,
    pub offset: f64,
    /// The unit normal of the cell here; zero until it is known.
    pub normal: Vec3,
    /// Whether this is a prescribed normal.
    pub prescribed: bool,
}

impl Station {
    pub(super) fn has_normal(&self) -> bool {
        self.normal != Vec3::ZERO
    }
}

/// A shell with its division.
#[derive(Clone, Copy)]
pub(super) struct Piece<'a> {
    pub shell: Shell<'a>,
    /// The element through all of its stations.
    surface: Element,
    pub pattern: &'static Pattern,
    /// Its first station.
    pub first: usize,
}

impl Piece<'_> {
    /// Where a node of the surface's element lies in the reference domain; the centre after the last one.
    fn place(&self, node: usize) -> Vec3 {
        let nodes = self.surface.nodes();
        nodes
            .get(node)
            .copied()
            .unwrap_or_else(|| self.surface.centre())
    }
}

/// The surface.
pub(super) struct Sheet<'a> {
    mesh: &'a Mesh,
    pub pieces: Vec<Piece<'a>>,
    /// The nodes of the mesh, then those in the middles of edges, then those in the middles of cells.
    pub points: Vec<Vec3>,
    pub stations: Vec<Station>,
    /// The shells that the nodes in the middles of cells lie in.
    pub centres: Vec<usize>,
}

/// The quadratic element with these corners and edges.
fn quadratic(family: Family) -> Option<Element> {
    let fits = |e: &Element| e.family() == family && e.order() == 2 && e.nnode() == 2 * e.ncorner();
    TABLE.iter().copied().find(fits)
}

impl<'a> Sheet<'a> {
    /// Divides the shells. New nodes have no position and stations no normal yet.
    pub(super) fn new(
        mesh: &'a Mesh,
        shells: &[Shell<'a>],
        middles: &Middles,
    ) -> Result<Self, ExpansionError> {
        let mut points = mesh.points.clone();
        points.resize(mesh.nnode() + middles.ends.len(), Vec3::ZERO);
        let mut this = Self {
            mesh,
            pieces: Vec::with_capacity(shells.len()),
            points,
            stations: Vec::with_capacity(4 * shells.len()),
            centres: Vec::new(),
        };
        for (number, &shell) in shells.iter().enumerate() {
            let is_divided = |k| middles.of(number, k) != NONE;
            let pattern = match shell.element.family() {
                Family::Triangle => &THREE,
                _ => match (is_divided(0), is_divided(1)) {
                    (true, true) => &FOUR,
                    (true, false) => &ALONG,
                    (false, true) => &ACROSS,
                    (false, false) => &WHOLE,
                },
            };
            let is_bent = shell.element.is_linear() && *pattern != WHOLE;
            let bent = is_bent.then(|| quadratic(shell.element.family())).flatten();
            let piece = Piece {
                shell,
                surface: bent.unwrap_or(shell.element),
                pattern,
                first: this.stations.len(),
            };
            this.add(piece, |k| middles.of(number, k))?;
        }
        Ok(this)
    }

    /// Adds a shell with its stations.
    fn add(
        &mut self,
        piece: Piece<'a>,
        middle: impl Fn(usize) -> NodeId,
    ) -> Result<(), ExpansionError> {
        let shell = piece.shell;
        let ncorner = shell.element.ncorner();
        for &at in piece.pattern.nodes {
            let node = match shell.nodes.get(at) {
                Some(&node) => node,
                None if at < 2 * ncorner => middle(at - ncorner),
                None => {
                    self.points.push(Vec3::ZERO);
                    self.centres.push(self.pieces.len());
                    (self.points.len() - 1) as NodeId
                }
            };
            let thickness = if (node as usize) < self.mesh.nnode() {
                shell.section.thickness_at(node)
            } else {
                interpolated(&shell, &piece.place(at))
            };
            if !(thickness > 0.0 && thickness.is_finite()) {
                let thinnest = shell.nodes.iter().copied().min_by(|&a, &b| {
                    let thickness = |node| shell.section.thickness_at(node);
                    thickness(a).total_cmp(&thickness(b))
                });
                let known = Some(node).filter(|&n| (n as usize) < self.mesh.nnode());
                return Err(ExpansionError::Thickness {
                    label: shell.label,
                    node: self.label(known.or(thinnest).unwrap_or(node)),
                    thickness,
                });
            }
            self.stations.push(Station {
                node,
                thickness,
                offset: shell.section.offset,
                normal: Vec3::ZERO,
                prescribed: false,
            });
        }
        self.pieces.push(piece);
        Ok(())
    }

    /// The number of a node of the mesh in the input.
    fn label(&self, node: NodeId) -> u64 {
        let label = self.mesh.node_labels.get(node as usize);
        label.copied().unwrap_or(u64::from(node) + 1)
    }

    /// The number in the input of the node at a station, or of the closest corner of its cell where it is new.
    pub(super) fn node_label(&self, piece: &Piece<'_>, station: usize) -> u64 {
        let node = self.stations[station].node;
        if (node as usize) < self.mesh.nnode() {
            return self.label(node);
        }
        let distance =
            |&n: &NodeId| (self.points[n as usize] - self.points[node as usize]).norm_squared();
        let corners = piece.shell.nodes.iter().copied();
        let closest = corners.min_by(|a, b| distance(a).total_cmp(&distance(b)));
        self.label(closest.unwrap_or(node))
    }

    /// All stations in the order of the labels of their cells.
    pub(super) fn by_label(&self) -> Vec<u32> {
        let mut order: Vec<u32> = (0..self.pieces.len() as u32).collect();
        order.sort_by_key(|&p| self.pieces[p as usize].shell.label);
        let stations = order.iter().flat_map(|&p| {
            let piece = &self.pieces[p as usize];
            (piece.first..piece.first + piece.pattern.nodes.len()).map(|s| s as u32)
        });
        stations.collect()
    }

    /// The normals of cells at their own nodes, and those prescribed. `cells` are those of the shells.
    pub(super) fn find_normals(
        &mut self,
        cells: impl Iterator<Item = CellId>,
        joining: &Joining<'_>,
    ) -> Result<(), ExpansionError> {
        for (piece, cell) in self.pieces.iter().zip(cells) {
            let shell = &piece.shell;
            let mut places = [Vec3::ZERO; NPLACE];
            for (place, &node) in places.iter_mut().zip(shell.nodes) {
                *place = self.points[node as usize];
            }
            for (i, &at) in piece.pattern.nodes.iter().enumerate() {
                let (Some(&node), Some(xi)) = (shell.nodes.get(at), shell.element.nodes().get(at))
                else {
                    continue;
                };
                let label = shell.label;
                let normal = normal(shell.element, &places, xi).ok_or_else(|| {
                    let node = self.label(node);
                    ExpansionError::NoArea { label, node }
                })?;
                let station = &mut self.stations[piece.first + i];
                station.normal = normal;
                if let Some(given) = joining.given.get(&(cell, node)) {
                    station.prescribed = true;
                    station.normal = given.normalized().ok_or_else(|| {
                        let node = self.mesh.node_labels.get(node as usize);
                        let node = node.copied().unwrap_or(0);
                        ExpansionError::NoDirection { label, node }
                    })?;
                }
            }
        }
        Ok(())
    }

    /// Places the nodes in the middles of cells, and finds the normals that are missing. The nodes in the middles of edges
    /// have their positions.
    pub(super) fn complete(&mut self) -> Result<(), ExpansionError> {
        for p in 0..self.pieces.len() {
            let piece = self.pieces[p];
            let stations = piece.first..piece.first + piece.pattern.nodes.len();
            if self.stations[stations].iter().all(Station::has_normal) {
                continue;
            }
            let places = self.places(&piece);
            for (i, &at) in piece.pattern.nodes.iter().enumerate() {
                let s = piece.first + i;
                if self.stations[s].has_normal() {
                    continue;
                }
                let xi = piece.place(at);
                if at == piece.surface.nnode() {
                    let mut shape = [0.0; NPLACE];
                    piece.surface.shape(&xi, &mut shape[..at]);
                    let centre = places.iter().zip(shape).map(|(x, n)| *x * n).sum();
                    self.points[self.stations[s].node as usize] = centre;
                }
                let normal = normal(piece.surface, &places, &xi);
                self.stations[s].normal = normal.ok_or_else(|| ExpansionError::NoArea {
                    label: piece.shell.label,
                    node: self.node_label(&piece, s),
                })?;
            }
        }
        Ok(())
    }

    /// The nodes of the surface's element; edges that are not divided are straight.
    fn places(&self, piece: &Piece<'_>) -> [Vec3; NPLACE] {
        let mut places = [Vec3::ZERO; NPLACE];
        let corners = piece.shell.nodes.iter().take(piece.shell.element.ncorner());
        for (place, &node) in places.iter_mut().zip(corners) {
            *place = self.points[node as usize];
        }
        for (mid, [start, end]) in piece.surface.mid_nodes() {
            places[mid] = (places[start] + places[end]) * 0.5;
        }
        for (i, &at) in piece.pattern.nodes.iter().enumerate() {
            if at < piece.surface.nnode() {
                places[at] = self.points[self.stations[piece.first + i].node as usize];
            }
        }
        places
    }
}

/// The thickness inside a shell from that at its nodes.
fn interpolated(shell: &Shell<'_>, xi: &Vec3) -> f64 {
    let section = shell.section;
    if section.at_nodes.is_none() {
        return section.thickness;
    }
    let mut shape = [0.0; NPLACE];
    let n = shell.element.nnode();
    shell.element.shape(xi, &mut shape[..n]);
    let thickness = |(&node, n): (&NodeId, f64)| section.thickness_at(node) * n;
    shell.nodes.iter().zip(shape).map(thickness).sum()
}

/// The unit normal of an element in space; `None` where it has no area.
fn normal(element: Element, places: &[Vec3; NPLACE], xi: &Vec3) -> Option<Vec3> {
    let mut slopes = [Vec3::ZERO; NPLACE];
    element.dshape(xi, &mut slopes[..element.nnode()]);
    let (mut a, mut b) = (Vec3::ZERO, Vec3::ZERO);
    for (place, slope) in places.iter().zip(slopes) {
        a += *place * slope.x;
        b += *place * slope.y;
    }
    let (a, b) = (a.normalized()?, b.normalized()?);
    let normal = a.cross(b);
    (normal.norm() > FLAT)
        .then(|| normal.normalized())
        .flatten()
}
