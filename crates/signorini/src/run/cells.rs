//! Cells as VTK numbers them.

use signorini_geometry::element::Element;
use signorini_io::vtk::cells::{CellType, VERTEX};

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
        let Some(cell_type) = CellType::of_element(element) else {
            return false;
        };
        let picked = cell_type.places().filter_map(|k| nodes.get(k));
        self.connectivity.extend(picked.map(|n| n + shift));
        self.types.push(cell_type.number);
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
            assert_eq!(cells.offsets, [0, nodes.len()]);
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
