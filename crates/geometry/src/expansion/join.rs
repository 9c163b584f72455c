//! Which cells have one director at a node.

use super::edges::Table;
use super::input::Joining;
use super::sheet::{Sheet, Station};
use crate::mesh::NodeId;
use crate::tensor::Vec3;

/// Within which prescribed normals join: half a degree.
const PRESCRIBED: f64 = std::f64::consts::PI / 360.0;
/// By how much the cosine of an angle may fall short through rounding, so that normals at the very limit join.
const ROUNDING: f64 = 1e-9;

/// What joins.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Joins {
    /// Cells of one smooth surface, whatever their thickness, offset and orientation.
    Surface,
    /// Cells that have one director.
    Directors,
}

/// Stations of one node that have one director.
#[derive(Clone, Copy)]
pub(super) struct Group {
    pub node: NodeId,
    pub normal: Vec3,
    pub thickness: f64,
    pub offset: f64,
}

/// The groups of all nodes, in the order of nodes.
pub(super) struct Joined {
    pub groups: Vec<Group>,
    /// The group of each station, [`Joined::NO`] for stations without a normal.
    pub of: Vec<u32>,
}

impl Joined {
    /// No group.
    pub(super) const NO: u32 = u32::MAX;

    /// Joins the stations that have a normal, (E2).
    pub(super) fn new(sheet: &Sheet<'_>, joining: &Joining<'_>, joins: Joins) -> Self {
        let ordered = sheet.by_label();
        let nodes = ordered
            .iter()
            .map(|&s| sheet.stations[s as usize].node as usize);
        let at_nodes = Table::new(sheet.points.len(), nodes);
        let mut this = Self {
            groups: Vec::with_capacity(sheet.points.len()),
            of: vec![Self::NO; sheet.stations.len()],
        };
        let limits = [joining.angle, PRESCRIBED].map(|angle| angle.cos() - ROUNDING);
        let mut here = Vec::new();
        for node in 0..sheet.points.len() {
            let stations = at_nodes.row(node).iter().map(|&i| ordered[i as usize]);
            here.clear();
            here.extend(stations.filter(|&s| sheet.stations[s as usize].has_normal()));
            this.split(&sheet.stations, &mut here, limits, joins);
        }
        this
    }

    /// Makes groups of these stations of one node, which are in the order of the labels of their cells. The limits are
    /// those for normals of cells and for prescribed ones.
    fn split(&mut self, stations: &[Station], here: &mut Vec<u32>, limits: [f64; 2], joins: Joins) {
        let is_prescribed = |s: &&u32| stations[**s as usize].prescribed;
        while let Some(&first) = here.iter().find(is_prescribed).or(here.first()) {
            let reference = &stations[first as usize];
            let limit = limits[usize::from(reference.prescribed)];
            let number = self.groups.len() as u32;
            let mut sum = Vec3::ZERO;
            here.retain(|&s| {
                let station = &stations[s as usize];
                let cosine = station.normal.dot(reference.normal);
                let has_joined = s == first
                    || match joins {
                        Joins::Surface => cosine.abs() >= limit,
                        Joins::Directors => {
                            cosine >= limit
                                && station.thickness == reference.thickness
                                && station.offset == reference.offset
                        }
                    };
                if has_joined {
                    sum += station.normal * cosine.signum();
                    self.of[s as usize] = number;
                }
                !has_joined
            });
            self.groups.push(Group {
                node: reference.node,
                normal: sum.normalized().unwrap_or(reference.normal),
                thickness: reference.thickness,
                offset: reference.offset,
            });
        }
    }
}
