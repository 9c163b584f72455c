//! Version 4.1.
//!
//! ```text
//! $Entities   npoint ncurve nsurface nvolume, then for each: tag, position or box, physical groups, boundary
//! $Nodes      nblock nnode min max, then blocks:    dimension entity parametric n, n numbers, n positions
//! $Elements   nblock nelement min max, then blocks: dimension entity type n, n times: number, nodes
//! ```
//!
//! An element belongs to the physical groups of its entity. Files in partitions have `$PartitionedEntities`, whose
//! entities name their groups in the same way.

use super::builder::{Builder, Owner};
use super::cursor::Cursor;
use crate::readers::MeshError;

type Result<T> = std::result::Result<T, MeshError>;

/// A tag of an entity with its dimension.
fn owner(cursor: &mut Cursor<'_>) -> Result<Owner> {
    let wanted = "the dimension of an entity";
    let dim = cursor.int(wanted)?;
    match u8::try_from(dim) {
        Ok(dim @ 0..=3) => Ok((dim, cursor.int("the tag of an entity")?)),
        _ => Err(cursor.out_of_range(wanted, dim, "0 to 3")),
    }
}

/// `n` whole numbers that do not matter.
fn skip_ints(cursor: &mut Cursor<'_>, wanted: &'static str) -> Result<()> {
    let n = cursor.size(wanted)?;
    (0..n).try_for_each(|_| cursor.int("the tag of an entity").map(drop))
}

/// `$Entities` or `$PartitionedEntities`.
pub(super) fn entities(
    cursor: &mut Cursor<'_>,
    builder: &mut Builder,
    partitioned: bool,
) -> Result<()> {
    if partitioned {
        cursor.size("the number of partitions")?;
        for _ in 0..cursor.size("the number of ghost entities")? {
            cursor.int("the tag of an entity")?;
            cursor.int("a partition")?;
        }
    }
    let mut counts = [0; 4];
    let least = if cursor.binary.is_some() { 32 } else { 8 };
    for count in &mut counts {
        let wanted = "the number of entities";
        *count = cursor.size(wanted)?;
        cursor.check_count(wanted, *count, least)?;
    }
    for (dim, count) in (0_u8..).zip(counts) {
        for _ in 0..count {
            let tag = cursor.int("the tag of an entity")?;
            if partitioned {
                cursor.int("the dimension of an entity")?;
                cursor.int("the tag of an entity")?;
                skip_ints(cursor, "the number of partitions")?;
            }
            cursor.skip_reals(if dim == 0 { 3 } else { 6 }, "a coordinate")?;
            let mut groups = Vec::new();
            for _ in 0..cursor.size("the number of physical groups")? {
                groups.push(cursor.int("the tag of a physical group")?.saturating_abs());
            }
            if dim > 0 {
                skip_ints(cursor, "the number of bounding entities")?;
            }
            groups.sort_unstable();
            groups.dedup();
            if !groups.is_empty() {
                builder.groups.insert((dim, tag), groups);
            }
        }
    }
    Ok(())
}

/// The four numbers that open `$Nodes` and `$Elements`: how many blocks and items there are.
fn header(
    cursor: &mut Cursor<'_>,
    wanted: &'static str,
    least: [usize; 2],
) -> Result<(u64, usize)> {
    let nblock = cursor.size("the number of blocks")?;
    let announced = cursor.size(wanted)?;
    let least = least[usize::from(cursor.binary.is_some())];
    let nitem = cursor.check_count(wanted, announced, least)?;
    cursor.size("the smallest number")?;
    cursor.size("the largest number")?;
    Ok((nblock, nitem))
}

/// `$Nodes`.
pub(super) fn nodes(cursor: &mut Cursor<'_>, builder: &mut Builder) -> Result<()> {
    let (nblock, announced) = header(cursor, "the number of nodes", [8, 28])?;
    builder.reserve_nodes(announced);
    let announced = announced as u64;
    let mut found = 0_u64;
    for _ in 0..nblock {
        let (dim, _) = owner(cursor)?;
        let parametric = cursor.int("whether nodes have parameters (0 or 1)")? != 0;
        let count = cursor.size("the number of nodes of a block")?;
        found = found.saturating_add(count);
        if found > announced {
            return Err(cursor.count("nodes", announced, found));
        }
        for _ in 0..count {
            let label = cursor.size("a node number")?;
            builder.push_node(cursor, label)?;
        }
        for _ in 0..count {
            builder.push_point(cursor.point(builder.next_node())?);
            if parametric {
                cursor.skip_reals(u64::from(dim), "a parameter")?;
            }
        }
    }
    if found < announced {
        return Err(cursor.count("nodes", announced, found));
    }
    builder.index_nodes();
    Ok(())
}

/// `$Elements`.
pub(super) fn elements(cursor: &mut Cursor<'_>, builder: &mut Builder) -> Result<()> {
    let (nblock, announced) = header(cursor, "the number of elements", [4, 8])?;
    let announced = announced as u64;
    let mut found = 0_u64;
    for _ in 0..nblock {
        let owner = owner(cursor)?;
        let number = cursor.int("an element type")?;
        let kind = builder.kind(cursor, number)?;
        if kind.dim != owner.0 {
            return Err(MeshError::WrongDimension {
                place: cursor.place(),
                element: kind.in_words(),
                dim: owner.0,
            });
        }
        let count = cursor.size("the number of elements of a block")?;
        found = found.saturating_add(count);
        if found > announced {
            return Err(cursor.count("elements", announced, found));
        }
        let node = |cursor: &mut Cursor<'_>| cursor.size("a node number");
        for _ in 0..count {
            let label = cursor.size("an element number")?;
            builder.read_cell(cursor, &kind, owner, label, false, node)?;
        }
    }
    if found < announced {
        return Err(cursor.count("elements", announced, found));
    }
    Ok(())
}
