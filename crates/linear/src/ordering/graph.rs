//! Graphs of groups of equations.

/// An undirected graph without loops, each edge in the lists of both its ends.
pub(crate) struct Graph {
    pub start: Vec<usize>,
    pub neighbour: Vec<u32>,
    pub weight: Vec<u32>,
}

impl Graph {
    /// The graph of the given edges, which may repeat, be loops or come in either direction.
    pub fn from_pairs(weight: Vec<u32>, pairs: &[(u32, u32)]) -> Self {
        let nvertex = weight.len();
        let mut begin = vec![0usize; nvertex + 1];
        for &(a, b) in pairs {
            begin[a as usize + 1] += 1;
            begin[b as usize + 1] += 1;
        }
        for vertex in 0..nvertex {
            begin[vertex + 1] += begin[vertex];
        }
        let mut next = begin.clone();
        let mut all = vec![0u32; begin[nvertex]];
        for &(a, b) in pairs {
            for (from, to) in [(a as usize, b), (b as usize, a)] {
                all[next[from]] = to;
                next[from] += 1;
            }
        }
        let mut start = Vec::with_capacity(nvertex + 1);
        let mut neighbour = Vec::with_capacity(all.len());
        start.push(0);
        for vertex in 0..nvertex {
            let list = &mut all[begin[vertex]..begin[vertex + 1]];
            list.sort_unstable();
            for (at, &other) in list.iter().enumerate() {
                if other as usize != vertex && (at == 0 || list[at - 1] != other) {
                    neighbour.push(other);
                }
            }
            start.push(neighbour.len());
        }
        Self {
            start,
            neighbour,
            weight,
        }
    }

    pub fn nvertex(&self) -> usize {
        self.weight.len()
    }

    pub fn neighbours(&self, vertex: usize) -> &[u32] {
        &self.neighbour[self.start[vertex]..self.start[vertex + 1]]
    }
}
