//! Cells as VTK numbers them.

use signorini_geometry::element::Element;

/// The type and the order of nodes that VTK has for an element.
///
/// VTK's hexahedron of 27 nodes has the centres of its sides at -x, +x, -y, +y, -z, +z. Its wedge has the normal of the
/// first triangle pointing in, by its shape functions and its quality measures as by ours; the faces and the volume that
/// VTK 9.2 and older give it are turned inside out.
#[rustfmt::skip]
const TABLE: [(&str, u8, &[usize]); 14] = [
    ("line2", 3, &[0, 1]),
    ("line3", 21, &[0, 1, 2]),
    ("tri3", 5, &[0, 1, 2]),
    ("tri6", 22, &[0, 1, 2, 3, 4, 5]),
    ("quad4", 9, &[0, 1, 2, 3]),
    ("quad8", 23, &[0, 1, 2, 3, 4, 5, 6, 7]),
    ("quad9", 28, &[0, 1, 2, 3, 4, 5, 6, 7, 8]),
    ("tet4", 10, &[0, 1, 2, 3]),
    ("tet10", 24, &[0, 1, 2, 3, 4, 5, 6, 7, 8, 9]),
    ("hex8", 12, &[0, 1, 2, 3, 4, 5, 6, 7]),
    ("hex20", 25, &[0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17, 18, 19]),
    ("hex27", 29, &[0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17, 18, 19, 25, 23, 22, 24, 20, 21, 26]),
    ("wedge6", 13, &[0, 1, 2, 3, 4, 5]),
    ("wedge15", 26, &[0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14]),
];

/// VTK's type of a single point.
const VERTEX: u8 = 1;

/// Cells in the making.
#[derive(Clone, Debug, PartialEq)]
pub struct Cells {
    /// VTK's type of each.
    pub types: Vec<u8>,
    /// Where the nodes of each start; one more than cells.
    pub offsets: Vec<usize>,
    /// Nodes in VTK's order.
    pub connectivity: Vec<u32>,
}

impl Default for Cells {
    fn default() -> Self {
        Self {
            types: Vec::new(),
            offsets: vec![0],
            connectivity: Vec::new(),
        }
    }
}

impl Cells {
    /// Appends a cell; says whether VTK has such cells.
    pub fn push(&mut self, element: Element, nodes: &[u32], shift: u32) -> bool {
        let Some((_, kind, order)) = TABLE.iter().find(|(name, ..)| *name == element.name()) else {
            return false;
        };
        let picked = order.iter().filter_map(|&k| nodes.get(k));
        self.connectivity.extend(picked.map(|n| n + shift));
        self.types.push(*kind);
        self.offsets.push(self.connectivity.len());
        true
    }

    /// Appends a point.
    pub fn push_vertex(&mut self, node: u32) {
        self.connectivity.push(node);
        self.types.push(VERTEX);
        self.offsets.push(self.connectivity.len());
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use signorini_geometry::element;
    use signorini_io::fs::{Fs, RealFs};
    use signorini_io::writers::vtu;

    #[test]
    fn every_element_has_a_cell_of_vtk_with_as_many_nodes() {
        for element in element::TABLE {
            let mut cells = Cells::default();
            let nodes: Vec<u32> = (0..element.nnode() as u32).collect();
            assert!(cells.push(element, &nodes, 10), "{}", element.name());
            assert_eq!(vtu::nnode_of(cells.types[0]), Some(nodes.len()));
            let mut seen = cells.connectivity.clone();
            seen.sort_unstable();
            assert!(seen.iter().zip(&nodes).all(|(a, b)| *a == b + 10));
        }
    }

    /// Writes `sample_cells.vtu` with a cell of every element, curved where it can be, and `sample_cells.json` for
    /// `scripts/check_vtu.py` into the folder SIGNORINI_SAMPLES. A map `(x + f(y, z), y + g(z), z)` keeps the measure.
    #[test]
    #[ignore = "writes files for viewers: into the folder SIGNORINI_SAMPLES, else a temporary one"]
    fn a_sample_of_every_cell_is_written() {
        let (mut cells, mut points, mut measures) = (Cells::default(), Vec::new(), Vec::new());
        for element in element::TABLE {
            let shift = points.len() as u32;
            let nodes: Vec<u32> = (0..element.nnode() as u32).collect();
            let bend = if element.nnode() > element.ncorner() {
                0.2
            } else {
                0.0
            };
            for xi in element.nodes() {
                let x = xi.x + bend * (xi.y * xi.y + 0.7 * xi.z * xi.z);
                points.push([x, xi.y + 0.9 * bend * xi.z * xi.z, xi.z]);
            }
            assert!(cells.push(element, &nodes, shift));
            measures.push(element.full_rule().weights.iter().sum::<f64>());
        }
        let folder = std::env::var_os("SIGNORINI_SAMPLES").map_or_else(
            || std::env::temp_dir().join("signorini-samples"),
            std::path::PathBuf::from,
        );
        RealFs.create_dir_all(&folder).unwrap();
        let grid = vtu::Grid {
            points: &points,
            types: &cells.types,
            offsets: &cells.offsets,
            connectivity: &cells.connectivity,
            ..vtu::Grid::default()
        };
        let path = folder.join("sample_cells.vtu");
        vtu::write(&RealFs, &path, &grid, &vtu::Options::default()).unwrap();
        let expected = format!(
            r#"{{ "points": {points:?}, "types": {:?}, "measures": {measures:?} }}"#,
            cells.types
        );
        let path = folder.join("sample_cells.json");
        RealFs.write_atomic(&path, expected.as_bytes()).unwrap();
    }
}
