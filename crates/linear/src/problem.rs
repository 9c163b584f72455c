//! What is solved: patterns, equations and values of the operator.

use crate::error::LinearError;
use crate::sparsity::{BlockPattern, NONE, Pattern};

/// What is known of the matrix; the more general comes later, so that `max` combines terms.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Symmetry {
    /// Symmetric, and positive definite in a stable state.
    Definite,
    /// Symmetric, with multipliers or otherwise indefinite.
    Symmetric,
    /// Values are not symmetric.
    Unsymmetric,
}

/// Where the unknowns of a field of the nodes are that is not in the bulk: `first + node · width + component`.
///
/// Its coefficients, and those that couple it with other fields, are in the interface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FieldBlock {
    /// The first raw degree of freedom.
    pub first: u32,
    /// The number of components of a node.
    pub width: usize,
}

impl FieldBlock {
    /// Its raw degrees of freedom, where there are this many nodes.
    fn dofs(&self, nnode: usize) -> std::ops::Range<usize> {
        let first = self.first as usize;
        first..first.saturating_add(nnode.saturating_mul(self.width))
    }
}

/// What a solver knows before it sees values.
///
/// # Example
/// ```
/// use signorini_linear::sparsity::{BlockPattern, NONE, Pattern};
/// use signorini_linear::{LinearKind, Problem, Symmetry, Values, choose};
///
/// // four springs in a row, k = 2, held at node 0
/// let bulk = BlockPattern::from_cliques(5, 1, &[0, 1, 1, 2, 2, 3, 3, 4], &[0, 2, 4, 6, 8]);
/// let interface = Pattern::empty(5);
/// let mut stiffness = vec![0.0; bulk.nvalue()];
/// for spring in 0..4 {
///     for (row, column, k) in [(0, 0, 2.0), (0, 1, -2.0), (1, 0, -2.0), (1, 1, 2.0)] {
///         let at = bulk.position(spring + row, spring + column).ok_or("not in the pattern")?;
///         stiffness[at] += k;
///     }
/// }
/// let values = Values { bulk: &stiffness, interface: &[] };
/// let problem = Problem {
///     ndof: 5,
///     bulk: &bulk,
///     interface: &interface,
///     fields: &[],
///     equation: &[NONE, 0, 1, 2, 3],
///     nequation: 4,
///     symmetry: Symmetry::Definite,
///     sign: &[1; 4],
///     coordinates: &[[0.0; 3]; 5],
///     between: &[],
/// };
/// problem.check()?;
///
/// let mut solver = choose(LinearKind::Direct);
/// solver.analyze(&problem)?;
/// solver.factorize(&values)?;
/// let mut x = [0.0; 4];
/// solver.solve(&values, &[0.0, 0.0, 0.0, 3.0], &mut x, 1e-12)?;
/// // a force of 3 at the end: u = F n/k at node n
/// for (n, u) in (1..).zip(x) {
///     assert!((u - 1.5 * f64::from(n)).abs() < 1e-12);
/// }
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Problem<'a> {
    /// The number of raw degrees of freedom.
    pub ndof: usize,
    /// The pattern of the bulk; it covers the first `nrow * block` raw degrees of freedom.
    pub bulk: &'a BlockPattern,
    /// The pattern of the interface.
    pub interface: &'a Pattern,
    /// The fields of the nodes besides that of the bulk.
    pub fields: &'a [FieldBlock],
    /// The equation of each raw degree of freedom, [`NONE`] where it has none (prescribed, dependent, unused).
    pub equation: &'a [u32],
    /// The number of equations.
    pub nequation: usize,
    /// The most general symmetry of any term.
    pub symmetry: Symmetry,
    /// Per equation: +1 for a displacement, −1 for a multiplier.
    pub sign: &'a [i8],
    /// Where each node is.
    pub coordinates: &'a [[f64; 3]],
    /// The corners that a node of quadratic elements is halfway between, [`NONE`] where it is a corner itself; may be empty.
    pub between: &'a [[u32; 2]],
}

impl Problem<'_> {
    /// Checks that all parts fit together.
    ///
    /// # Errors
    /// `Shape` names the part that does not.
    pub fn check(&self) -> Result<(), LinearError> {
        let shape = |what, got: usize, wanted: usize| {
            if got == wanted {
                Ok(())
            } else {
                Err(LinearError::Shape { what, got, wanted })
            }
        };
        let below = |what, numbers: &[u32], end: usize, exempt: Option<u32>| {
            let outside = |number: &&u32| **number as usize >= end && Some(**number) != exempt;
            match numbers.iter().find(outside) {
                Some(&number) => Err(LinearError::Range {
                    what,
                    number: number as usize,
                    end,
                }),
                None => Ok(()),
            }
        };
        let rows = |what, row_start: &[usize], ncolumn: usize| {
            let rising = row_start.windows(2).all(|pair| pair[0] <= pair[1]);
            shape(what, row_start.last().copied().unwrap_or(0), ncolumn)?;
            shape(what, row_start.first().copied().unwrap_or(0), 0)?;
            if rising {
                Ok(())
            } else {
                Err(LinearError::Range {
                    what,
                    number: 0,
                    end: ncolumn,
                })
            }
        };
        let nbulk = self.bulk.nrow() * self.bulk.block;
        if !(1..=3).contains(&self.bulk.block) {
            return Err(LinearError::Range {
                what: "width of a block",
                number: self.bulk.block,
                end: 4,
            });
        }
        if nbulk > self.ndof {
            return Err(LinearError::Range {
                what: "bulk degrees of freedom",
                number: nbulk,
                end: self.ndof + 1,
            });
        }
        let fields = self.fields.iter();
        let mut outside = fields.map(|field| field.dofs(self.bulk.nrow()));
        if let Some(dofs) = outside.find(|dofs| dofs.start < nbulk || dofs.end > self.ndof) {
            return Err(LinearError::Range {
                what: "degrees of freedom of a field",
                number: dofs.start,
                end: self.ndof,
            });
        }
        if self.interface.nrow > self.ndof {
            return Err(LinearError::Range {
                what: "interface rows",
                number: self.interface.nrow,
                end: self.ndof + 1,
            });
        }
        shape(
            "equations of degrees of freedom",
            self.equation.len(),
            self.ndof,
        )?;
        shape("signs", self.sign.len(), self.nequation)?;
        shape(
            "interface rows",
            self.interface.row_start.len(),
            self.interface.nrow + 1,
        )?;
        rows("bulk rows", &self.bulk.row_start, self.bulk.nblock())?;
        rows(
            "interface rows",
            &self.interface.row_start,
            self.interface.nentry(),
        )?;
        below("equation", self.equation, self.nequation, Some(NONE))?;
        below("bulk column", &self.bulk.column, self.bulk.nrow(), None)?;
        below("interface column", &self.interface.column, self.ndof, None)
    }
}

/// The values of the operator, in the order of the two patterns.
#[derive(Clone, Copy, Debug)]
pub struct Values<'a> {
    /// Block after block, each row-major.
    pub bulk: &'a [f64],
    /// Entry after entry.
    pub interface: &'a [f64],
}

/// The parts of a [`Problem`] that outlive the call, kept to measure residuals and to recognize the same problem.
#[derive(Clone, Debug)]
pub(crate) struct Kept {
    pub bulk: BlockPattern,
    pub interface: Pattern,
    pub fields: Vec<FieldBlock>,
    pub equation: Vec<u32>,
    pub symmetry: Symmetry,
    pub sign: Vec<i8>,
    pub coordinates: Vec<[f64; 3]>,
    pub between: Vec<[u32; 2]>,
}

impl Kept {
    pub fn new(problem: &Problem) -> Self {
        Self {
            bulk: problem.bulk.clone(),
            interface: problem.interface.clone(),
            fields: problem.fields.to_vec(),
            equation: problem.equation.to_vec(),
            symmetry: problem.symmetry,
            sign: problem.sign.to_vec(),
            coordinates: problem.coordinates.to_vec(),
            between: problem.between.to_vec(),
        }
    }

    pub fn is(&self, problem: &Problem) -> bool {
        self.symmetry == problem.symmetry
            && self.equation == problem.equation
            && self.sign == problem.sign
            && self.fields == problem.fields
            && self.interface == *problem.interface
            && self.bulk == *problem.bulk
    }

    /// Checks that the lists of a solution fit.
    pub fn check_solution(
        &self,
        values: &Values,
        rhs: &[f64],
        x: &[f64],
    ) -> Result<(), LinearError> {
        self.check(values)?;
        let wanted = self.sign.len();
        for (what, got) in [("right-hand sides", rhs.len()), ("unknowns", x.len())] {
            if got != wanted {
                return Err(LinearError::Shape { what, got, wanted });
            }
        }
        Ok(())
    }

    /// Checks that values belong to the patterns.
    pub fn check(&self, values: &Values) -> Result<(), LinearError> {
        for (what, got, wanted) in [
            ("bulk values", values.bulk.len(), self.bulk.nvalue()),
            (
                "interface values",
                values.interface.len(),
                self.interface.nentry(),
            ),
        ] {
            if got != wanted {
                return Err(LinearError::Shape { what, got, wanted });
            }
        }
        Ok(())
    }

    /// Raw columns of the row of a dof in the bulk, and where their values are.
    pub fn bulk_row(&self, dof: u32) -> impl Iterator<Item = (u32, usize)> + '_ {
        self.bulk.row_of_dof(dof)
    }

    /// Raw columns of the row of a dof in the interface, and where their values are.
    pub fn interface_row(&self, dof: u32) -> impl Iterator<Item = (u32, usize)> + '_ {
        let range = match self.interface.row_start.get(dof as usize..dof as usize + 2) {
            Some(&[begin, end]) => begin..end,
            _ => 0..0,
        };
        range.map(|at| (self.interface.column[at], at))
    }

    /// The problem again.
    pub fn problem(&self) -> Problem<'_> {
        Problem {
            ndof: self.equation.len(),
            bulk: &self.bulk,
            interface: &self.interface,
            fields: &self.fields,
            equation: &self.equation,
            nequation: self.sign.len(),
            symmetry: self.symmetry,
            sign: &self.sign,
            coordinates: &self.coordinates,
            between: &self.between,
        }
    }

    /// Whether some equation is that of several raw dofs: then nothing is eliminated.
    pub fn shares_equations(&self) -> bool {
        let used = self.equation.iter().filter(|&&e| e != NONE).count();
        used > self.sign.len()
    }

    /// Whether a raw dof is an unknown with the sign of a displacement.
    pub fn is_displacement(&self, dof: u32) -> bool {
        let equation = self.equation[dof as usize];
        equation != NONE && self.sign[equation as usize] >= 0
    }

    /// The node of a raw dof; beyond the bulk, each dof is a node of its own.
    pub fn node_of(&self, dof: u32) -> u32 {
        let (block, nrow) = (self.bulk.block as u32, self.bulk.nrow() as u32);
        if dof < nrow * block {
            dof / block
        } else {
            nrow + (dof - nrow * block)
        }
    }

    /// The dofs of a node that have an equation.
    pub fn equations_of(&self, node: u32) -> Vec<u32> {
        let (block, nrow) = (self.bulk.block as u32, self.bulk.nrow() as u32);
        let dofs = if node < nrow {
            node * block..(node + 1) * block
        } else {
            let dof = nrow * block + (node - nrow);
            dof..dof + 1
        };
        dofs.filter(|&d| self.is_displacement(d)).collect()
    }

    /// Whether operator and block are symmetric and positive definite in a stable state.
    pub fn is_definite(&self) -> bool {
        self.symmetry == Symmetry::Definite && self.sign.iter().all(|&sign| sign > 0)
    }

    /// Whether a raw dof is that of a field of the nodes besides the bulk.
    pub fn is_of_field(&self, dof: u32) -> bool {
        let mut fields = self.fields.iter();
        fields.any(|field| field.dofs(self.bulk.nrow()).contains(&(dof as usize)))
    }

    /// Whether a raw dof is solved for.
    pub fn is_free(&self, dof: usize) -> bool {
        self.equation.get(dof).is_some_and(|&e| e != NONE)
    }

    /// Whether a raw dof is a multiplier that is solved for.
    pub fn is_multiplier(&self, dof: usize) -> bool {
        let equation = self.equation.get(dof).filter(|&&e| e != NONE);
        let sign = equation.and_then(|&e| self.sign.get(e as usize));
        sign.is_some_and(|&sign| sign < 0)
    }

    /// The largest value at equations of displacements.
    pub fn largest_at_displacements(&self, values: &[f64]) -> f64 {
        let forces = values.iter().zip(&self.sign).filter(|(_, s)| **s > 0);
        forces.fold(0.0, |largest: f64, (v, _)| largest.max(v.abs()))
    }
}
