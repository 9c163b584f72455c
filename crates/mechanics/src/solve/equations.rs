//! Which raw dofs are solved for, and the linear system over them.

use crate::system::{Assembler, Assembly, Dof, DofName, FieldId, Symmetry, System};
use signorini_linear::sparsity::NONE;
use signorini_linear::{
    EXACT, FieldBlock, LinearError, LinearSolver, Note, Problem, SolveReport, StartStiffness,
};
use signorini_ranks::Ranks;
use std::time::Instant;

/// Wall time spent in the linear solver, in seconds.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LinearSeconds {
    /// Ordering and symbolic factorization.
    pub analyze: f64,
    /// Numeric factorization.
    pub factorize: f64,
    /// Substitution and refinement.
    pub solve: f64,
}

impl std::ops::AddAssign for LinearSeconds {
    fn add_assign(&mut self, other: Self) {
        self.analyze += other.analyze;
        self.factorize += other.factorize;
        self.solve += other.solve;
    }
}

/// The numbering of the unknowns that are solved for, and the solver.
pub(super) struct Equations {
    /// Equation of each raw dof, or `NONE`.
    equation: Vec<u32>,
    /// Raw dof of each equation.
    dofs: Vec<Dof>,
    sign: Vec<i8>,
    solver: Box<dyn LinearSolver>,
    right: Vec<f64>,
    left: Vec<f64>,
    response: Vec<f64>,
    pub seconds: LinearSeconds,
    /// Iterations of the last solution.
    pub iterations: usize,
}

/// Which factor a solve goes by. The residual that is made small is that of the operator assembled last in both cases.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Factor {
    /// That of this operator.
    New,
    /// That of the last one: an error where it is too far off, or gone.
    Kept,
}

/// How exact a solution is to be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Accuracy {
    /// So far that this part of the error is left, or no force that is larger than `enough`.
    Part {
        /// The part.
        part: f64,
        /// A force.
        enough: f64,
    },
    /// The relative residual.
    Residual(f64),
}

impl Equations {
    pub fn new(solver: Box<dyn LinearSolver>) -> Self {
        Self {
            equation: Vec::new(),
            dofs: Vec::new(),
            sign: Vec::new(),
            solver,
            right: Vec::new(),
            left: Vec::new(),
            response: Vec::new(),
            seconds: LinearSeconds::default(),
            iterations: 0,
        }
    }

    /// The raw dofs that are solved for.
    pub fn dofs(&self) -> &[Dof] {
        &self.dofs
    }

    /// Whether solutions that are less exact are less work.
    pub fn is_iterative(&self) -> bool {
        self.solver.iterative().is_some_and(|s| s.iterates())
    }

    /// The ranks that the solver takes the rows of bodies from, divided; none: it takes all.
    pub fn ranks(&self) -> Option<&'static dyn Ranks> {
        self.solver.iterative().and_then(|s| s.ranks())
    }

    /// What the solver has decided since it was asked last.
    pub fn notes(&mut self) -> Vec<Note> {
        self.solver
            .iterative_mut()
            .map_or_else(Vec::new, |s| s.notes())
    }

    /// Lets the solver forget what it has learned.
    pub fn forget(&mut self) {
        self.solver.forget();
    }

    /// What the solver has learned that stays when it forgets.
    pub fn experience(&self) -> u8 {
        self.solver.iterative().map_or(0, |s| s.experience())
    }

    /// Gives the solver what it had learned in the run that is resumed.
    pub fn recall(&mut self, experience: u8) {
        if let Some(solver) = self.solver.iterative_mut() {
            solver.recall(experience);
        }
    }

    /// Whether the solver asks for the initial stiffness of the bodies with this id.
    pub fn wants_start(&self, id: u64) -> bool {
        self.solver.iterative().is_some_and(|s| s.wants_start(id))
    }

    /// Gives it to the solver.
    pub fn start_from(&mut self, id: u64, bulk: StartStiffness) {
        if let Some(solver) = self.solver.iterative_mut() {
            solver.start_from(id, bulk);
        }
    }

    /// Lets the solver take over what that of equations before has left.
    pub fn inherit(&mut self, mut before: Self) {
        let before = before.solver.iterative_mut();
        let heritage = before.and_then(|solver| solver.bequeath());
        if let Some(heritage) = heritage
            && let Some(solver) = self.solver.iterative_mut()
        {
            solver.inherit(heritage);
        }
    }

    /// Numbers the unknowns, and returns the fields of the nodes besides the displacement.
    pub fn number(
        &mut self,
        system: &System,
        assembler: &Assembler,
        prescribed: &[bool],
    ) -> Vec<FieldBlock> {
        let layout = &system.layout;
        self.equation.clear();
        self.dofs.clear();
        self.sign.clear();
        for dof in 0..layout.ndof() as Dof {
            let name = layout.name(dof);
            let node = name.and_then(DofName::displacement).map(|(node, _)| node);
            let in_bulk = node.is_some_and(|n| assembler.bulk().has_row(n));
            let used = in_bulk || assembler.interface().position(dof, dof).is_some();
            let free = !prescribed.get(dof as usize).copied().unwrap_or(false);
            if used && free {
                self.equation.push(self.dofs.len() as u32);
                self.dofs.push(dof);
                let multiplier = name.is_some_and(|name| name.field == FieldId::MULTIPLIER);
                self.sign.push(if multiplier { -1 } else { 1 });
            } else {
                self.equation.push(NONE);
            }
        }
        let fields = layout.other_nodal().map(|(id, field)| FieldBlock {
            first: layout.dof(id, 0, 0),
            width: field.ncomponent,
        });
        fields.collect()
    }

    /// The equations as they are numbered, with a matrix that is symmetric.
    pub fn symmetric<'a>(
        &'a self,
        system: &'a System,
        assembler: &'a Assembler,
        fields: &'a [FieldBlock],
    ) -> Problem<'a> {
        let numbering = (&self.equation[..], &self.sign[..]);
        let symmetry = symmetry(system).min(Symmetry::Symmetric);
        problem(system, assembler, fields, numbering, symmetry)
    }

    /// Numbers the unknowns and does the symbolic work.
    pub fn analyze(
        &mut self,
        system: &System,
        assembler: &Assembler,
        prescribed: &[bool],
    ) -> Result<(), LinearError> {
        let fields = self.number(system, assembler, prescribed);
        let symmetry = symmetry(system).max(self.turning(system));
        let numbering = (&self.equation[..], &self.sign[..]);
        let problem = problem(system, assembler, &fields, numbering, symmetry);
        let start = Instant::now();
        let outcome = self.solver.analyze(&problem);
        self.seconds.analyze += start.elapsed().as_secs_f64();
        outcome
    }

    /// A moment on a carrier makes the stiffness against its rotations unsymmetric. A rigid body that may turn about some
    /// axes and is held about others carries one at equilibrium; a carrier of deformable nodes carries one as soon as
    /// it may turn at all.
    fn turning(&self, system: &System) -> Symmetry {
        let layout = &system.layout;
        let partly = (0..layout.nrigid() as u32).any(|body| {
            let rotations = (0..3).map(|axis| layout.rotation(body, axis));
            let free =
                rotations.filter(|&d| self.equation.get(d as usize).is_some_and(|e| *e != NONE));
            let felt = system.elimination.is_felt(layout.rotation(body, 2), layout);
            let few = if felt { 4 } else { 3 };
            (1..few).contains(&free.count())
        });
        if partly && layout.ndim() == 3 {
            Symmetry::Unsymmetric
        } else {
            Symmetry::Definite
        }
    }

    /// Solves `K du = −r − K du_p` for the free dofs. `du` holds `du_p` at the prescribed dofs on entry, zero
    /// elsewhere; on return the whole step.
    pub fn solve(
        &mut self,
        assembler: &Assembler,
        assembly: &Assembly,
        with_motion: bool,
        factor: Factor,
        accuracy: Accuracy,
        du: &mut [f64],
    ) -> Result<SolveReport, LinearError> {
        let values = assembly.values();
        self.right.clear();
        let residual = |&dof: &Dof| -assembly.residual[dof as usize];
        self.right.extend(self.dofs.iter().map(residual));
        if with_motion {
            self.response.clear();
            self.response.resize(du.len(), 0.0);
            signorini_linear::apply(
                assembler.bulk(),
                assembler.interface(),
                &values,
                du,
                &mut self.response,
            );
            let bulk = assembler.bulk();
            if let Some(partition) = &bulk.partition {
                partition.complete(bulk.block, [&mut self.response])?;
            }
            for (b, &dof) in self.right.iter_mut().zip(&self.dofs) {
                *b -= self.response[dof as usize];
            }
        }
        self.left.clear();
        self.left.resize(self.dofs.len(), 0.0);
        let start = Instant::now();
        if factor == Factor::New {
            let outcome = self.solver.factorize(&values);
            self.seconds.factorize += start.elapsed().as_secs_f64();
            outcome?;
        }
        let start = Instant::now();
        let (solver, left) = (&mut self.solver, &mut self.left);
        let outcome = match accuracy {
            Accuracy::Part { part, enough } => match solver.iterative_mut() {
                Some(solver) => solver.solve_to(&values, &self.right, left, part, enough),
                None => solver.solve(&values, &self.right, left, EXACT),
            },
            Accuracy::Residual(rtol) => solver.solve(&values, &self.right, left, rtol),
        };
        self.seconds.solve += start.elapsed().as_secs_f64();
        let report = outcome?;
        self.iterations = report.iterations;
        for (x, &dof) in self.left.iter().zip(&self.dofs) {
            du[dof as usize] = *x;
        }
        Ok(report)
    }

    /// The raw dof of an equation that a solver complains of.
    pub fn dof(&self, equation: Option<usize>) -> Option<Dof> {
        equation.and_then(|e| self.dofs.get(e)).copied()
    }
}

/// The most general symmetry of any term.
fn symmetry(system: &System) -> Symmetry {
    let terms = system.terms.iter().map(|t| t.properties().symmetry);
    terms.max().unwrap_or(Symmetry::Definite)
}

/// The problem with this numbering: the equation of each raw dof, and the sign of each equation.
fn problem<'a>(
    system: &'a System,
    assembler: &'a Assembler,
    fields: &'a [FieldBlock],
    (equation, sign): (&'a [u32], &'a [i8]),
    symmetry: Symmetry,
) -> Problem<'a> {
    Problem {
        ndof: system.layout.ndof(),
        bulk: assembler.bulk(),
        interface: assembler.interface(),
        fields,
        equation,
        nequation: sign.len(),
        symmetry,
        sign,
        coordinates: &system.coordinates,
        between: &system.between,
    }
}
