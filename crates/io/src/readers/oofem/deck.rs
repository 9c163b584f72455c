//! The records of a deck in their fixed order.

use super::fault::{Fault, RecordError, shown};
use super::record::Record;
use super::text::{Checks, Line, Text};
use std::vec::IntoIter;

/// What a deck is made of, part by part.
#[derive(Clone, Debug)]
pub struct Parts {
    /// What it is about.
    pub description: String,
    /// The analysis.
    pub analysis: Record,
    /// Its metasteps.
    pub metasteps: Vec<Record>,
    /// What is written, and whether values are checked.
    pub modules: Vec<Record>,
    /// The domain.
    pub domain: Record,
    /// How many records of each kind there are.
    pub sizes: Record,
    /// Nodes.
    pub nodes: Vec<Record>,
    /// Elements.
    pub elements: Vec<Record>,
    /// Contact surfaces.
    pub surfaces: Vec<Record>,
    /// Contact segments.
    pub segments: Vec<Record>,
    /// Cross-sections.
    pub sections: Vec<Record>,
    /// Materials.
    pub materials: Vec<Record>,
    /// Boundary conditions, loads, contacts.
    pub conditions: Vec<Record>,
    /// Initial conditions.
    pub initial: Vec<Record>,
    /// Functions of time.
    pub functions: Vec<Record>,
    /// Sets.
    pub sets: Vec<Record>,
    /// The check block.
    pub checks: Option<Checks>,
}

/// Takes lines one after the other.
struct Lines {
    rest: std::iter::Peekable<IntoIter<Line>>,
    last: Option<Record>,
}

impl Lines {
    fn end(&self, wanted: &str) -> Fault {
        let error = RecordError::End {
            wanted: wanted.to_owned(),
        };
        match &self.last {
            Some(record) => record.wrong(error),
            None => Fault {
                place: crate::diagnostic::Place::nowhere(),
                error,
            },
        }
    }

    fn line(&mut self, wanted: &str) -> Result<Line, Fault> {
        self.rest.next().ok_or_else(|| self.end(wanted))
    }

    fn record(&mut self, wanted: &str) -> Result<Record, Fault> {
        let record = self.line(wanted)?.record();
        self.last = Some(record.clone());
        Ok(record)
    }

    /// As many records as their count says: it is believed no further than the file goes.
    fn records(&mut self, count: u64, wanted: &str) -> Result<Vec<Record>, Fault> {
        let mut records = Vec::new();
        for number in 1..=count {
            let wanted = format!("{wanted} {number} of {count}");
            records.push(self.record(&wanted)?);
        }
        Ok(records)
    }

    fn next_is(&mut self, is_meant: impl Fn(&str) -> bool) -> bool {
        let kind = self.rest.peek().map(|line| line.record().kind());
        kind.is_some_and(|kind| is_meant(&kind))
    }
}

/// Sorts the lines of a deck into its parts.
pub(super) fn parts(text: Text) -> Result<Parts, Fault> {
    let mut lines = Lines {
        rest: text.lines.into_iter().peekable(),
        last: None,
    };
    lines.record("the name of the output file")?;
    let description = lines.line("the description")?.raw().to_owned();
    let mut analysis = lines.record("the analysis")?;
    let metasteps = match analysis.whole("nmsteps")? {
        Some(count) => lines.records(count, "metastep")?,
        None => Vec::new(),
    };
    let ninit = analysis.whole("ninitmodules")?.unwrap_or(0);
    lines.records(ninit, "initialization module")?;
    let nmodule = analysis.whole("nmodules")?.unwrap_or(0);
    let modules = lines.records(nmodule, "export module")?;
    let domain = lines.record("the domain")?;
    if domain.kind() != "domain" {
        let error = RecordError::Unexpected {
            found: shown(&domain.kind()),
            wanted: "the record of the domain".into(),
        };
        return Err(domain.wrong(error));
    }
    let manager = lines.record("the output manager")?;
    if manager.kind() != "outputmanager" {
        let error = RecordError::Unexpected {
            found: shown(&manager.kind()),
            wanted: "OutputManager".into(),
        };
        return Err(manager.wrong(error));
    }
    let mut sizes = lines.record("the sizes of the components")?;
    let need = |sizes: &mut Record, keyword| sizes.need_whole(keyword);
    let [nnode, nelement, nsection, nmaterial, ncondition, nfunction] = [
        need(&mut sizes, "ndofman")?,
        need(&mut sizes, "nelem")?,
        need(&mut sizes, "ncrosssect")?,
        need(&mut sizes, "nmat")?,
        need(&mut sizes, "nbc")?,
        need(&mut sizes, "nltf")?,
    ];
    let ninitial = sizes.whole("nic")?.unwrap_or(0);
    let nset = sizes.whole("nset")?.unwrap_or(0);
    let nsurface = sizes.whole("ncontactsurf")?.unwrap_or(0);
    let nsegment = sizes.whole("ncontactseg")?.unwrap_or(0);
    let nodes = lines.records(nnode, "node")?;
    let elements = lines.records(nelement, "element")?;
    let early = nset > 0 && lines.next_is(|kind| kind == "set");
    let mut sets = lines.records(if early { nset } else { 0 }, "set")?;
    let surfaces = lines.records(nsurface, "contact surface")?;
    let segments = lines.records(nsegment, "contact segment")?;
    let sections = lines.records(nsection, "cross-section")?;
    let materials = lines.records(nmaterial, "material")?;
    if let Some(count) = sizes.whole("nbarrier")?.filter(|count| *count > 0) {
        lines.records(count, "barrier")?;
    }
    let conditions = lines.records(ncondition, "boundary condition")?;
    let initial = lines.records(ninitial, "initial condition")?;
    let functions = lines.records(nfunction, "function of time")?;
    if !early {
        sets = lines.records(nset, "set")?;
    }
    if let Some(line) = lines.rest.next() {
        let record = line.record();
        let error = RecordError::Unexpected {
            found: shown(&record.kind()),
            wanted: "the end of the deck".into(),
        };
        return Err(record.wrong(error));
    }
    Ok(Parts {
        description,
        analysis,
        metasteps,
        modules,
        domain,
        sizes,
        nodes,
        elements,
        surfaces,
        segments,
        sections,
        materials,
        conditions,
        initial,
        functions,
        sets,
        checks: text.checks,
    })
}
