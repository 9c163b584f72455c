//! (E1) to (E4) of the room, at one configuration.

use super::facets::corner_normal;
use super::integrals::{self, Integrator};
use super::{Mortar, Normals};
use crate::contact::discretization::{Anchored, SurfacePair};
use crate::contact::mortar::{Derivatives, OfFacet, OfRow, Weights};
use crate::contact::row::{Row, RowOrder, Wanted};
use signorini_geometry::mesh::NodeId;
use signorini_geometry::surface::{ContactSurface, Facets, Placement, SurfaceError};
use signorini_geometry::tensor::Vec3;

/// What one thread works with, row after row.
#[derive(Default)]
pub(super) struct Workspace {
    /// Who takes part in the row: all nodes of the present weights, then those of the accepted ones alone.
    pub participants: Vec<NodeId>,
    /// The place among the nodes of the row of each node of a facet and of those that it meets.
    places: Vec<usize>,
    /// dD_j, dN and dw: one entry for each column.
    d: Vec<f64>,
    normal: Vec<Vec3>,
    way: Vec<Vec3>,
    /// dν of a facet for rows whose normals have turned, component by component.
    turned: [Vec<f64>; 3],
    integrator: Integrator,
}

/// A row at a configuration.
pub(super) struct Place<'a> {
    pub mortar: &'a Mortar,
    pub row: usize,
    pub pair: &'a SurfacePair,
    pub at: &'a Placement<'a>,
    pub weights: &'a Weights,
    pub now: &'a OfRow,
    pub past: Option<&'a OfRow>,
    pub anchor: Option<&'a Anchored>,
    pub bond: bool,
}

impl Place<'_> {
    fn x(&self, node: NodeId) -> Vec3 {
        self.at.x.get(node as usize).copied().unwrap_or_default()
    }

    /// x_j.
    fn centre(&self) -> Vec3 {
        self.x(self.mortar.nodes[self.row])
    }

    fn way(&self, weights: &OfRow) -> Vec3 {
        weights.way(self.centre(), &|n| self.x(n))
    }

    pub fn gap(&self) -> f64 {
        self.now.gap(self.centre(), &|n| self.x(n)) / self.now.d
    }

    /// The way that has been slipped, normal part and elastic slip included; `None` without a past.
    fn slipped(&self) -> Option<Vec3> {
        self.anchor?;
        let now = self.way(self.now);
        if self.mortar.held.is_some() {
            return Some(now / self.now.d);
        }
        self.past.map(|past| (self.way(past) - now) / self.now.d)
    }

    pub fn participants(&self, out: &mut Vec<NodeId>) {
        out.clear();
        out.extend_from_slice(&self.now.nodes);
        let secondary = self.now.nsecondary;
        for node in self.past.iter().flat_map(|p| &p.nodes[secondary..]) {
            if !out[secondary..].contains(node) {
                out.push(*node);
            }
        }
    }

    /// (E1), (E2), (E4).
    pub fn fill(
        &self,
        row: &mut Row,
        wanted: Wanted,
        work: &mut Workspace,
    ) -> Result<(), SurfaceError> {
        let area = self.mortar.area[self.row];
        row.coverage = self.now.d / area;
        for (k, (&scalar, vector)) in self.now.scalar.iter().zip(&self.now.vector).enumerate() {
            for c in 0..3 {
                row.weights[3 * k + c] = vector[c] / area;
                row.sliding.operator[3 * k + c] = Vec3::unit(c) * (scalar / area);
            }
        }
        let slipped = self.slipped().filter(|_| wanted.slip);
        let offset = self.anchor.map_or(Vec3::ZERO, |a| a.offset);
        let q = slipped.map_or(Vec3::ZERO, |s| s - offset);
        row.sliding.free = slipped.is_none();
        row.sliding.slip = match self.bond {
            true => q,
            false => q - row.normal * row.normal.dot(q),
        };
        if wanted.order < RowOrder::Tangent {
            return Ok(());
        }
        if self.mortar.held.is_some() {
            self.differentiate_held(row);
            return Ok(());
        }
        self.differentiate(row, wanted.slip, work)?;
        if slipped.is_some() {
            self.differentiate_slip(row, q, q + offset, work);
        }
        Ok(())
    }

    fn differentiate_held(&self, row: &mut Row) {
        let nu = row.normal;
        for (k, (&scalar, vector)) in self.now.scalar.iter().zip(&self.now.vector).enumerate() {
            for c in 0..3 {
                row.gradient[3 * k + c] = vector[c] / self.now.d;
                let along = if self.bond { 0.0 } else { nu[c] };
                let moved = Vec3::unit(c) - nu * along;
                row.sliding.dslip[3 * k + c] = moved * (scalar / self.now.d);
            }
        }
    }

    /// (E3), dν, and what (E4) needs.
    fn differentiate(
        &self,
        row: &mut Row,
        slips: bool,
        work: &mut Workspace,
    ) -> Result<(), SurfaceError> {
        let n = row.gradient.len();
        let nodal = self.mortar.form.normals == Normals::Nodal;
        work.d.clear();
        work.d.resize(n, 0.0);
        for vectors in [&mut work.normal, &mut work.way] {
            vectors.clear();
            vectors.resize(n, Vec3::ZERO);
        }
        if slips || nodal {
            row.sliding.dscale.resize(n / 3 * n, 0.0);
        }
        let Some(facets) = &self.pair.secondary else {
            return Ok(());
        };
        let around = &self.mortar.around[self.row];
        for (facet, place, share) in self.weights.guests.of(self.row, around) {
            let of = match self.weights.facets.get(facet as usize) {
                Some(of) if !of.met.is_empty() => of,
                _ => continue,
            };
            let nodes = facets.nodes(facet);
            work.places.clear();
            let known = |node: &NodeId, of: &[NodeId]| of.iter().position(|n| n == node);
            let (secondary, primary) = self.now.nodes.split_at(self.now.nsecondary);
            let own = nodes.iter().map(|n| known(n, secondary));
            let others = of.nodes.iter();
            let others = others.map(|n| known(n, primary).map(|k| secondary.len() + k));
            // every node is known: it was collected from the same facets
            let places = own.chain(others).map(Option::unwrap_or_default);
            work.places.extend(places);
            let sums = Sums {
                places: &work.places,
                d: &mut work.d,
                normal: &mut work.normal,
                way: &mut work.way,
                turned: &mut work.turned,
                row,
            };
            let integrate = |integrator: &mut Integrator| {
                let Mortar { measure, form, .. } = self.mortar;
                integrator.covered.measured(*measure, form.basis);
                integrator.near.clone_from(&of.met);
                let turning = self.weights.guests.turns_on(facet);
                let wanted = integrals::Wanted::derivatives(turning);
                integrator.integrate(facets, facet, self.pair, self.at, wanted)
            };
            let add =
                |with: &Derivatives| self.add(sums, facets, (facet, place, share), (of, with));
            let of_facet = (facet, self.weights);
            let integrator = &mut work.integrator;
            self.mortar
                .kept
                .with(of_facet, integrator, integrate, add)??;
        }
        let (sum, g) = (self.now.normal.norm(), self.gap());
        let nu = row.normal;
        for (dnormal, dsum) in row.sliding.dnormal.iter_mut().zip(&work.normal) {
            *dnormal = (*dsum - nu * nu.dot(*dsum)) / sum;
        }
        if nodal {
            self.differentiate_nodal(row, &work.way);
        }
        for (gradient, dd) in row.gradient.iter_mut().zip(&work.d) {
            *gradient = (*gradient - g * dd) / self.now.d;
        }
        Ok(())
    }

    /// What a facet adds.
    fn add(
        &self,
        mut to: Sums<'_>,
        facets: &Facets,
        (facet, place, share): (u32, usize, f64),
        (of, with): (&OfFacet, &Derivatives),
    ) -> Result<(), SurfaceError> {
        let (nodes, area) = (facets.nodes(facet), self.mortar.area[self.row]);
        let n = to.row.gradient.len();
        let nodal = self.mortar.form.normals == Normals::Nodal;
        let turn = self.weights.guests.turn(self.row);
        let (dd, nu) = (with.dd(place), of.turned(turn));
        let d = share * of.d[place];
        let turned = std::mem::take(to.turned);
        let turned = differentiate_turned(turned, (of, with), turn);
        let dnormal = |a: usize| match turn {
            0.0 => with.dnormal(a),
            _ => &turned[a],
        };
        let dnu = |i: usize| Vec3::new(dnormal(0)[i], dnormal(1)[i], dnormal(2)[i]);
        scatter(to.d, to.places, share, dd);
        let inverse = &self.mortar.inverse(facet)[place];
        let m = &of.m[place * of.nodes.len()..][..of.nodes.len()];
        let own = nodes.len();
        let centre = self.centre();
        let mut way = Vec3::ZERO;
        for (k, &line) in to.places.iter().enumerate() {
            let x = self.x(self.now.nodes[line]) - centre;
            let (c, factor, dc) = match k.checked_sub(own) {
                None => (inverse[k] * d, share * inverse[k], dd),
                Some(l) => (-share * m[l], -share, with.dm(place, l)),
            };
            if factor == 0.0 {
                continue;
            }
            way += x * c;
            let along = nu.dot(x) * factor;
            scatter(&mut to.row.gradient, to.places, along, dc);
            to.scatter_way(x * factor, dc);
            for a in 0..3 {
                to.row.gradient[3 * line + a] += nu[a] * c;
                to.way[3 * line + a][a] += c;
            }
            if let Some(dscale) = to.row.sliding.dscale.get_mut(line * n..(line + 1) * n) {
                scatter(dscale, to.places, factor / area, dc);
            }
            if nodal {
                continue;
            }
            for a in 0..3 {
                let dweights = &mut to.row.dweights[(3 * line + a) * n..][..n];
                scatter(dweights, to.places, nu[a] * factor / area, dc);
                scatter(dweights, to.places, c / area, dnormal(a));
            }
        }
        if nodal {
            return self.turn(to, facets, (facet, place, share));
        }
        for (i, column) in columns(to.places).enumerate().take(dnormal(0).len()) {
            to.row.gradient[column] += dnu(i).dot(way);
            to.normal[column] += dnu(i) * d;
        }
        for (column, dd) in columns(to.places).zip(dd) {
            to.normal[column] += nu * (share * dd);
        }
        *to.turned = turned;
        Ok(())
    }

    /// dN of nodal normals.
    fn turn(
        &self,
        to: Sums<'_>,
        facets: &Facets,
        (facet, place, share): (u32, usize, f64),
    ) -> Result<(), SurfaceError> {
        let (normal, jet) = corner_normal(facets, facet, place, self.at)?;
        let t2 = match facets.ntan() {
            1 => Vec3::unit(2),
            _ => jet.tangent[1],
        };
        let size = jet.tangent[0].cross(t2).norm();
        for (i, column) in columns(&to.places[..jet.nnode]).enumerate() {
            let (unit, d) = (Vec3::unit(i % 3), jet.dshape[i / 3]);
            let mut change = unit.cross(t2) * d[0];
            if facets.ntan() == 2 {
                change += jet.tangent[0].cross(unit) * d[1];
            }
            to.normal[column] -= (change - normal * normal.dot(change)) * (share / size);
        }
        Ok(())
    }

    /// G D_j and ∂b where normals are those of nodes.
    fn differentiate_nodal(&self, row: &mut Row, way: &[Vec3]) {
        let (nu, n) = (row.normal, row.gradient.len());
        let area = self.mortar.area[self.row];
        let whole = self.way(self.now);
        for (j, gradient) in row.gradient.iter_mut().enumerate() {
            *gradient = nu.dot(way[j]) + row.sliding.dnormal[j].dot(whole);
        }
        for (k, scalar) in self.now.scalar.iter().enumerate() {
            for a in 0..3 {
                let dweights = &mut row.dweights[(3 * k + a) * n..][..n];
                for (j, dweight) in dweights.iter_mut().enumerate() {
                    let dscale = row.sliding.dscale[k * n + j];
                    *dweight = nu[a] * dscale + row.sliding.dnormal[j][a] * (scalar / area);
                }
            }
        }
    }

    /// de of (E4), where `raw` is what has been slipped and `q` that without the elastic part.
    fn differentiate_slip(&self, row: &mut Row, q: Vec3, raw: Vec3, work: &mut Workspace) {
        let (nu, d) = (row.normal, self.now.d);
        let dslip = &mut row.sliding.dslip;
        for (de, (way, dd)) in dslip.iter_mut().zip(work.way.iter().zip(&work.d)) {
            *de = (*way + raw * *dd) * (-1.0 / d);
        }
        if let Some(past) = self.past {
            let secondary = self.now.nsecondary;
            for (k, (node, c)) in past.nodes.iter().zip(&past.scalar).enumerate() {
                let later = &work.participants[secondary..];
                let place = match later.iter().position(|n| n == node) {
                    Some(place) if k >= secondary => secondary + place,
                    _ => k,
                };
                for a in 0..3 {
                    dslip[3 * place + a][a] += c / d;
                }
            }
        }
        for (de, dnu) in dslip.iter_mut().zip(&row.sliding.dnormal) {
            *de = *de - nu * (nu.dot(*de) + dnu.dot(q)) - *dnu * nu.dot(q);
        }
    }
}

/// Where derivatives of a row are added up.
struct Sums<'a> {
    /// The place of each node of the facet and of those that it meets among the nodes of the row.
    places: &'a [usize],
    d: &'a mut [f64],
    normal: &'a mut [Vec3],
    way: &'a mut [Vec3],
    turned: &'a mut [Vec<f64>; 3],
    row: &'a mut Row,
}

impl Sums<'_> {
    fn scatter_way(&mut self, factor: Vec3, from: &[f64]) {
        let to = self.way.as_chunks_mut::<3>().0;
        for (&place, from) in self.places.iter().zip(from.as_chunks::<3>().0) {
            if let Some(to) = to.get_mut(place) {
                for (to, from) in to.iter_mut().zip(from) {
                    *to += factor * *from;
                }
            }
        }
    }
}

/// dν of [`OfFacet::turned`], component by component:
/// `dν = (I − ν νᵀ) ((1 − s) dν_e + s (I − μ μᵀ) dm/|m|)/|q|` with `μ = m/|m|`.
fn differentiate_turned(
    mut out: [Vec<f64>; 3],
    (of, with): (&OfFacet, &Derivatives),
    s: f64,
) -> [Vec<f64>; 3] {
    if s == 0.0 {
        return out;
    }
    let (size, nu) = (of.opposite.norm(), of.turned(s));
    let mu = of.opposite.normalized().unwrap_or(of.normal);
    let length = (of.normal * (1.0 - s) + mu * s).norm();
    let n = with.dopposite(0).len();
    out.iter_mut().for_each(|d| {
        d.clear();
        d.resize(n, 0.0);
    });
    let of_component = |lines: [&[f64]; 3], i: usize| {
        Vec3::from(lines.map(|line| line.get(i).copied().unwrap_or(0.0)))
    };
    for i in 0..n {
        let dm = of_component([0, 1, 2].map(|a| with.dopposite(a)), i);
        let dmu = (dm - mu * mu.dot(dm)) / size;
        let dq = of_component([0, 1, 2].map(|a| with.dnormal(a)), i) * (1.0 - s) + dmu * s;
        let dnu = (dq - nu * nu.dot(dq)) / length;
        for (a, to) in out.iter_mut().enumerate() {
            to[i] = dnu[a];
        }
    }
    out
}

/// Adds a multiple of nodal values, three numbers each, where these are.
fn scatter(to: &mut [f64], places: &[usize], factor: f64, from: &[f64]) {
    let to = to.as_chunks_mut::<3>().0;
    for (&place, from) in places.iter().zip(from.as_chunks::<3>().0) {
        if let Some(to) = to.get_mut(place) {
            for (to, from) in to.iter_mut().zip(from) {
                *to += factor * from;
            }
        }
    }
}

/// The columns of nodes at these places.
fn columns(places: &[usize]) -> impl Iterator<Item = usize> {
    places.iter().flat_map(|&k| [3 * k, 3 * k + 1, 3 * k + 2])
}
