//! The shells as they are given.

use super::error::ExpansionError;
use super::input::{Section, ShellCell};
use crate::element::{Element, Family};
use crate::mesh::{CellId, Mesh, NodeId};

/// A shell.
#[derive(Clone, Copy)]
pub(super) struct Shell<'a> {
    pub label: u64,
    pub element: Element,
    pub nodes: &'a [NodeId],
    pub section: &'a Section<'a>,
}

/// The shells of a list, and which cells of the mesh they are.
pub(super) struct Shells<'a> {
    pub list: Vec<Shell<'a>>,
    /// The shell at each cell of each block, [`Shells::NO`] for other cells; empty for blocks without shells.
    pub numbers: Vec<Vec<u32>>,
}

/// Whether shells can be of this element.
fn is_shell(element: Element) -> bool {
    let is_face = matches!(element.family(), Family::Triangle | Family::Quadrilateral);
    is_face && element.order() <= 2
}

impl<'a> Shells<'a> {
    /// The number of a cell that is no shell.
    const NO: u32 = u32::MAX;

    pub(super) fn new(
        mesh: &'a Mesh,
        cells: &[ShellCell],
        sections: &'a [Section<'a>],
    ) -> Result<Self, ExpansionError> {
        let mut numbers = vec![Vec::new(); mesh.blocks.len()];
        let mut list = Vec::with_capacity(cells.len());
        for (number, &ShellCell { cell, section }) in cells.iter().enumerate() {
            let found = mesh.element(cell).zip(mesh.cell_label(cell));
            let (element, label) = found.ok_or(ExpansionError::NoSuchCell { shell: number })?;
            if !is_shell(element) {
                let element = element.name();
                return Err(ExpansionError::NotAShell { label, element });
            }
            let nodes = mesh.cell(cell);
            let is_node = |&node: &u32| (node as usize) < mesh.nnode();
            if nodes.len() != element.nnode() || !nodes.iter().all(is_node) {
                return Err(ExpansionError::NoSuchNode { label });
            }
            let none = ExpansionError::NoSuchSection { label, section };
            let section = sections.get(section).ok_or(none)?;
            if !section.offset.is_finite() {
                let offset = section.offset;
                return Err(ExpansionError::Offset { label, offset });
            }
            // the cell exists, so the block and its place in it do
            let of_block = &mut numbers[cell.block as usize];
            if of_block.is_empty() {
                of_block.resize(mesh.blocks[cell.block as usize].ncell(), Self::NO);
            }
            let at = &mut of_block[cell.index as usize];
            if *at != Self::NO {
                return Err(ExpansionError::Twice { label });
            }
            *at = number as u32;
            list.push(Shell {
                label,
                element,
                nodes,
                section,
            });
        }
        Ok(Self { list, numbers })
    }

    /// The shell that a cell is.
    pub(super) fn of(&self, cell: CellId) -> Option<usize> {
        let of_block = self.numbers.get(cell.block as usize)?;
        let number = *of_block.get(cell.index as usize)?;
        (number != Self::NO).then_some(number as usize)
    }
}
