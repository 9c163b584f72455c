//! Version 2.2.
//!
//! ```text
//! $Nodes             number of nodes, then            node x y z
//! $ParametricNodes   the same, followed by            dimension entity parameters
//! $Elements          number of elements, then  text   element type ntag tags nodes
//!                                              binary type count ntag, then count times: element tags nodes
//! ```
//!
//! The first tag is the physical group (0: none), the second the entity. Counts are text in binary files too. An
//! element in several groups comes several times in a row, with other numbers; it becomes one cell in several sets.

use super::builder::{Builder, Owner};
use super::cursor::Cursor;
use super::kind::Kind;
use crate::readers::MeshError;

type Result<T> = std::result::Result<T, MeshError>;

/// The count that opens a section, with its line.
fn count(cursor: &mut Cursor<'_>, wanted: &'static str) -> Result<u64> {
    let count = cursor.text_int(wanted)?;
    let range = "0 to 2^63 - 1";
    let count = u64::try_from(count).map_err(|_| cursor.out_of_range(wanted, count, range))?;
    if cursor.binary.is_some() {
        cursor.line();
    }
    Ok(count)
}

/// `$Nodes` or `$ParametricNodes`.
pub(super) fn nodes(
    cursor: &mut Cursor<'_>,
    builder: &mut Builder,
    parametric: bool,
) -> Result<()> {
    let wanted = "the number of nodes";
    let announced = count(cursor, wanted)?;
    let least = if cursor.binary.is_some() { 28 } else { 8 };
    let announced = cursor.check_count(wanted, announced, least)?;
    builder.reserve_nodes(announced);
    for _ in 0..announced {
        let label = cursor.small_size("a node number")?;
        builder.push_node(cursor, label)?;
        builder.push_point(cursor.point(label)?);
        if parametric {
            let dim = cursor.small_size("the dimension of an entity")?;
            cursor.int("the tag of an entity")?;
            cursor.skip_reals(if dim < 3 { dim } else { 0 }, "a parameter")?;
        }
    }
    builder.index_nodes();
    Ok(())
}

/// Tags of an element: its owner and its entity.
fn tags(cursor: &mut Cursor<'_>, ntag: u64, dim: u8) -> Result<(Owner, i64)> {
    let (mut physical, mut entity) = (0, 0);
    for i in 0..ntag {
        let tag = cursor.int("a tag")?;
        match i {
            0 => physical = tag.saturating_abs(),
            1 => entity = tag,
            _ => {}
        }
    }
    Ok(((dim, physical), entity))
}

/// Which element came last; one that differs in its group only is the same cell.
#[derive(Clone, Copy, PartialEq)]
struct Last {
    number: u32,
    owner: Owner,
    entity: i64,
}

impl Last {
    fn may_be_twin_of(&self, last: Option<&Self>) -> bool {
        last.is_some_and(|last| {
            last.number == self.number && last.entity == self.entity && last.owner != self.owner
        })
    }
}

/// `$Elements`.
pub(super) fn elements(cursor: &mut Cursor<'_>, builder: &mut Builder) -> Result<()> {
    let wanted = "the number of elements";
    let announced = count(cursor, wanted)?;
    let least = if cursor.binary.is_some() { 8 } else { 6 };
    let announced = cursor.check_count(wanted, announced, least)? as u64;
    let mut reader = Elements {
        builder,
        last: None,
    };
    if cursor.binary.is_none() {
        let mut kind: Option<Kind> = None;
        for _ in 0..announced {
            let label = cursor.small_size("an element number")?;
            let number = cursor.int("an element type")?;
            let known = match kind {
                Some(kind) if i64::from(kind.number) == number => kind,
                _ => reader.builder.kind(cursor, number)?,
            };
            kind = Some(known);
            let ntag = cursor.small_size("the number of tags")?;
            reader.read(cursor, &known, label, ntag)?;
        }
        return Ok(());
    }
    let mut found = 0;
    while found < announced {
        let number = cursor.int("an element type")?;
        let kind = reader.builder.kind(cursor, number)?;
        let count = cursor.small_size("the number of elements of one type")?;
        let ntag = cursor.small_size("the number of tags")?;
        found += count;
        if found > announced {
            return Err(cursor.count("elements", announced, found));
        }
        for _ in 0..count {
            let label = cursor.small_size("an element number")?;
            reader.read(cursor, &kind, label, ntag)?;
        }
    }
    Ok(())
}

struct Elements<'b> {
    builder: &'b mut Builder,
    last: Option<Last>,
}

impl Elements<'_> {
    /// The tags and the nodes of one element.
    fn read(&mut self, cursor: &mut Cursor<'_>, kind: &Kind, label: u64, ntag: u64) -> Result<()> {
        let (owner, entity) = tags(cursor, ntag, kind.dim)?;
        let this = Last {
            number: kind.number,
            owner,
            entity,
        };
        if self.last.is_none_or(|last| last.owner != owner) && owner.1 != 0 {
            self.builder.groups.insert(owner, vec![owner.1]);
        }
        let twin = this.may_be_twin_of(self.last.as_ref());
        self.last = Some(this);
        let node = |cursor: &mut Cursor<'_>| cursor.small_size("a node number");
        self.builder
            .read_cell(cursor, kind, owner, label, twin, node)
    }
}
