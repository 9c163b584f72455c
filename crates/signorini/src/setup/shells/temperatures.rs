//! Temperatures of shells: those of the middle, and a change along the normal.

use super::solids::Shells;
use signorini_geometry::expansion::Director;
use signorini_geometry::mesh::NodeId;
use signorini_mechanics::solve::Motion;
use std::collections::HashMap;

impl Shells {
    /// Gives nodes between those of the input the mean of their values, and the ends of directors what a gradient makes of those of
    /// their nodes.
    pub fn spread(&self, temperature: &mut [f64], gradient: &HashMap<NodeId, f64>) {
        let mut gradient = gradient.clone();
        for (node, parents) in self.between() {
            let count = parents.len().max(1) as f64;
            let of_parent = |parent: &NodeId| temperature.get(*parent as usize).copied();
            let mean = parents.iter().filter_map(of_parent).sum::<f64>() / count;
            let slopes = parents.iter().filter_map(|parent| gradient.get(parent));
            let slope = slopes.sum::<f64>() / count;
            if let Some(to) = temperature.get_mut(node as usize) {
                *to = mean;
            }
            if slope != 0.0 {
                gradient.insert(node, slope);
            }
        }
        for director in self.directors() {
            let Some(&middle) = temperature.get(director.node as usize) else {
                continue;
            };
            let slope = gradient.get(&director.node).copied().unwrap_or_default();
            for (node, more) in at_nodes(director, slope) {
                if let Some(to) = temperature.get_mut(node as usize) {
                    *to = middle + more;
                }
            }
        }
    }

    /// The same of courses of nodes, each with its gradient; `None` where a course is no number and has a gradient.
    pub fn spread_courses(
        &self,
        given: Vec<(NodeId, Motion, f64)>,
    ) -> Option<Vec<(NodeId, Motion)>> {
        if self.is_empty() {
            let plain = given.into_iter();
            return Some(plain.map(|(node, course, _)| (node, course)).collect());
        }
        let mut all: HashMap<NodeId, (Motion, f64)> = HashMap::new();
        for (node, course, slope) in &given {
            all.insert(*node, (course.clone(), *slope));
        }
        let mut of_nodes = given;
        for (node, parents) in self.between() {
            let courses = parents.iter().map(|parent| all.get(parent));
            let Some(courses) = courses.collect::<Option<Vec<_>>>() else {
                continue;
            };
            let count = courses.len().max(1) as f64;
            let slope = courses.iter().map(|(_, slope)| slope).sum::<f64>() / count;
            let numbers = courses.iter().map(|(course, _)| number(course));
            let numbers: Option<Vec<f64>> = numbers.collect();
            let course = match (courses.first(), numbers) {
                (Some((first, _)), _) if courses.iter().all(|(course, _)| course == first) => {
                    first.clone()
                }
                (Some((first, _)), Some(numbers)) => {
                    shifted(first, numbers.iter().sum::<f64>() / count - numbers[0])?
                }
                _ => return None,
            };
            all.insert(node, (course.clone(), slope));
            of_nodes.push((node, course, slope));
        }
        let mut everywhere = Vec::with_capacity(5 * of_nodes.len());
        for (node, course, slope) in of_nodes {
            for director in self.directors_at(node) {
                for (end, more) in at_nodes(director, slope) {
                    let course = match more == 0.0 {
                        true => course.clone(),
                        false => shifted(&course, more)?,
                    };
                    if end != node {
                        everywhere.push((end, course));
                    }
                }
            }
            everywhere.push((node, course));
        }
        Some(everywhere)
    }
}

/// The nodes of a director with what a gradient adds at them.
fn at_nodes(director: &Director, slope: f64) -> [(NodeId, f64); 4] {
    let half = 0.5 * director.thickness * slope;
    [
        (director.negative, -half),
        (director.positive, half),
        (director.middle, 0.0),
        (director.half, 0.0),
    ]
}

/// The number that a course leads to.
fn number(course: &Motion) -> Option<f64> {
    match course {
        Motion::Ramp(to) => Some(*to),
        Motion::Table(rows) => match rows[..] {
            [[_, to]] => Some(to),
            _ => None,
        },
        _ => None,
    }
}

/// A course to another number.
fn shifted(course: &Motion, more: f64) -> Option<Motion> {
    match course {
        Motion::Ramp(to) => Some(Motion::Ramp(to + more)),
        Motion::Table(rows) => match rows[..] {
            [[time, to]] => Some(Motion::Table(vec![[time, to + more]])),
            _ => None,
        },
        _ => None,
    }
}
