//! What a deck defines as sets and surfaces becomes sets of the mesh.

use super::space::{Named, Space};
use super::{Assembly, Result};
use crate::readers::MeshError;
use crate::readers::inp::card::key;
use crate::readers::inp::definition::{Definition, Family, Region, Side};
use crate::readers::inp::directory::of_instance;
use crate::readers::labels::Lookup;
use signorini_geometry::mesh::{CellId, Face, Set, boundary};
use std::mem::take;

impl Assembly<'_> {
    /// Makes the sets of a family: those of instances first, for the assembly names them; and in each what *NODE and
    /// *ELEMENT name first, as CalculiX sorts its cards.
    pub(super) fn define_all(&mut self, family: Family) -> Result<()> {
        let nspace = self.spaces.len();
        let scopes = take(&mut self.deck.scopes);
        for number in (1..nspace).chain([0]) {
            let definitions = scopes.get(number).map_or(&[][..], |s| &s.definitions);
            let of_family = || definitions.iter().filter(|d| d.family == family);
            for definition in of_family().filter(|d| !d.added.is_empty()) {
                self.define(number, definition)?;
            }
            for definition in of_family().filter(|d| d.added.is_empty()) {
                self.define(number, definition)?;
            }
        }
        self.deck.scopes = scopes;
        Ok(())
    }

    fn define(&mut self, number: usize, definition: &Definition) -> Result<()> {
        let target = match &definition.instance {
            None => number,
            Some(name) => match self.instances.get(&key(name)) {
                Some(space) => *space,
                None => return Err(self.undefined(definition, "instance", name)),
            },
        };
        let mut found = Set::default();
        match definition.family {
            Family::Cells => self.cells(target, definition, &mut found)?,
            Family::Nodes | Family::Points => self.nodes(target, definition, &mut found)?,
            Family::Faces => {
                for (region, side) in &definition.sides {
                    self.side(target, definition, region, *side, &mut found)?;
                }
            }
        }
        let Some(space) = self.spaces.get_mut(number) else {
            return Ok(());
        };
        let named = (space.names(definition.family))
            .entry(key(&definition.name))
            .or_insert_with(|| Named {
                name: definition.name.clone(),
                set: Set::default(),
            });
        named.set.nodes.append(&mut found.nodes);
        named.set.cells.append(&mut found.cells);
        named.set.faces.append(&mut found.faces);
        Ok(())
    }

    /// A set by its name, as seen from a space.
    pub(super) fn find(&self, number: usize, family: Family, name: &str) -> Option<&Set> {
        let found = self.spaces.get(number)?.get(family, &key(name));
        found.or_else(|| {
            let (space, rest) = of_instance(&self.instances, name).filter(|_| number == 0)?;
            self.spaces.get(space)?.get(family, &key(rest))
        })
    }

    fn undefined(&self, definition: &Definition, what: &'static str, name: &str) -> MeshError {
        let names = |family| {
            let named = self.spaces.iter().flat_map(move |space| match family {
                Family::Nodes => space.node_sets.values(),
                Family::Cells => space.cell_sets.values(),
                Family::Faces => space.surfaces.values(),
                Family::Points => space.surfaces_of_nodes.values(),
            });
            named.map(|named| named.name.as_str()).take(11)
        };
        let mut known: Vec<&str> = match what {
            "node set" => names(Family::Nodes).collect(),
            "element set" => names(Family::Cells).collect(),
            "instance" => (self.deck.instances.iter().map(|i| i.name.as_str()).take(11)).collect(),
            _ => Vec::new(),
        };
        if known.len() > 10 {
            known.truncate(10);
            known.push("…");
        }
        let known = match known.is_empty() {
            true => String::new(),
            false => format!(" before this line; there are {}", known.join(", ")),
        };
        MeshError::Undefined {
            place: self.files.place(definition.spot),
            what,
            name: name.chars().take(80).collect(),
            known,
        }
    }

    fn miss(&mut self, definition: &Definition, label: u64) {
        let of = (definition.name.clone(), definition.family.word());
        let entry = self.missing.entry(of).or_insert((0, label));
        entry.0 += 1;
    }

    /// Places of the numbers and ranges of a definition.
    fn places(&mut self, number: usize, definition: &Definition) -> Result<Vec<u32>> {
        let mut places: Vec<u32> = Vec::with_capacity(definition.labels.len());
        places.extend(definition.added.clone().map(|place| place as u32));
        for &label in &definition.labels {
            let lookup = self
                .spaces
                .get(number)
                .map(|space| match definition.family {
                    Family::Cells => &space.elements,
                    _ => &space.nodes,
                });
            match lookup.and_then(|lookup| lookup.find(label)) {
                Some(place) => places.push(place),
                None => self.miss(definition, label),
            }
        }
        self.spend(places.len(), definition.spot, "the sets")?;
        for &[first, last, step] in &definition.ranges {
            let before = places.len();
            if let Some(space) = self.spaces.get(number) {
                match definition.family {
                    Family::Cells => space.elements.range(first, last, step, &mut places),
                    _ => space.nodes.range(first, last, step, &mut places),
                }
            }
            self.spend(places.len() - before, definition.spot, "the sets")?;
        }
        Ok(places)
    }

    fn cells(&mut self, number: usize, definition: &Definition, out: &mut Set) -> Result<()> {
        let places = self.places(number, definition)?;
        let cells = self.spaces.get(number).map(|space| &space.cells);
        let cell = |place: &u32| cells?.get(*place as usize).copied().flatten();
        out.cells.extend(places.iter().filter_map(cell));
        self.note_special(number, &places, definition);
        for name in &definition.names {
            self.note_special_of(number, name, definition);
            let found = match self.find(number, Family::Cells, name) {
                Some(set) => set.cells.clone(),
                None => match self.single(number, name, |space| &space.elements) {
                    Some((space, at)) => {
                        let cells = self.spaces.get(space).map(|space| &space.cells);
                        let cell = cells.and_then(|cells| cells.get(at as usize));
                        cell.copied().flatten().into_iter().collect()
                    }
                    None => return Err(self.undefined(definition, "element set", name)),
                },
            };
            self.spend(found.len(), definition.spot, "the sets")?;
            out.cells.extend(found);
        }
        Ok(())
    }

    /// Remembers the elements of a set that are no cells.
    fn note_special(&mut self, number: usize, places: &[u32], definition: &Definition) {
        let Some(space) = self.spaces.get_mut(number) else {
            return;
        };
        if !space.special.is_empty() {
            let labels = places.iter().filter_map(|place| space.special.get(place));
            let of_set = space.special_sets.entry(key(&definition.name)).or_default();
            of_set.extend(labels);
        }
    }

    /// The same for those of a set within a set, or for a single one of an instance.
    fn note_special_of(&mut self, number: usize, name: &str, definition: &Definition) {
        let of = |space: usize, name: &str| self.spaces.get(space)?.special_sets.get(&key(name));
        let within = || of_instance(&self.instances, name).filter(|_| number == 0);
        let of_set =
            of(number, name).or_else(|| within().and_then(|(space, rest)| of(space, rest)));
        let single = || {
            let (space, place) = self.single(number, name, |space| &space.elements)?;
            self.spaces.get(space)?.special.get(&place).copied()
        };
        let found: Vec<u64> = match of_set {
            Some(labels) => labels.clone(),
            None => single().into_iter().collect(),
        };
        if let Some(space) = self.spaces.get_mut(number)
            && !found.is_empty()
        {
            let of_set = space.special_sets.entry(key(&definition.name)).or_default();
            of_set.extend(found);
        }
    }

    fn nodes(&mut self, number: usize, definition: &Definition, out: &mut Set) -> Result<()> {
        let places = self.places(number, definition)?;
        let ids = self.spaces.get(number).map(|space| &space.node_ids);
        let id = |place: &u32| ids?.get(*place as usize).copied();
        out.nodes.extend(places.iter().filter_map(id));
        for name in &definition.names {
            let found = match self.find(number, Family::Nodes, name) {
                Some(set) => set.nodes.clone(),
                None => match self.single(number, name, |space| &space.nodes) {
                    Some((space, at)) => {
                        let ids = self.spaces.get(space).map(|space| &space.node_ids);
                        let id = ids.and_then(|ids| ids.get(at as usize));
                        id.copied().into_iter().collect()
                    }
                    None => return Err(self.undefined(definition, "node set", name)),
                },
            };
            self.spend(found.len(), definition.spot, "the sets")?;
            out.nodes.extend(found);
        }
        for name in &definition.elsets {
            let Some(set) = self.find(number, Family::Cells, name) else {
                return Err(self.undefined(definition, "element set", name));
            };
            let found = self.mesh.nodes_of(set);
            let work = set.cells.len().saturating_mul(8) + found.len();
            self.spend(work, definition.spot, "the sets")?;
            out.nodes.extend(found);
        }
        Ok(())
    }

    /// A single number of an instance: `part-1.12`.
    fn single(
        &self,
        number: usize,
        name: &str,
        lookup: impl Fn(&Space) -> &Lookup,
    ) -> Option<(usize, u32)> {
        let (space, label) = of_instance(&self.instances, name).filter(|_| number == 0)?;
        let place = lookup(self.spaces.get(space)?).find(label.parse().ok()?)?;
        Some((space, place))
    }

    /// One line of a surface.
    fn side(
        &mut self,
        number: usize,
        definition: &Definition,
        region: &Region,
        side: Side,
        out: &mut Set,
    ) -> Result<()> {
        let one;
        let cells = match region {
            Region::Label(label) => {
                let space = self.spaces.get(number);
                let place = space.and_then(|space| space.elements.find(*label));
                let cell = space
                    .zip(place)
                    .and_then(|(s, at)| s.cells.get(at as usize));
                let Some(cell) = cell else {
                    return Err(self.undefined(definition, "element", &label.to_string()));
                };
                one = cell.map_or(Vec::new(), |cell| vec![cell]);
                one
            }
            Region::Name(name) => match self.find(number, Family::Cells, name) {
                Some(set) => set.cells.clone(),
                None => return Err(self.undefined(definition, "element set", name)),
            },
        };
        self.spend(cells.len() + 1, definition.spot, "the sets")?;
        let dim = self.dim();
        let (shells, cells): (Vec<CellId>, Vec<CellId>) =
            (cells.into_iter()).partition(|cell| self.directory.is_shell(*cell));
        for cell in shells {
            out.faces
                .extend(self.side_of_shell(cell, side, definition)?);
        }
        if side == Side::Free {
            return self.free_sides(definition, cells, out);
        }
        for cell in cells {
            let Some(element) = self.mesh.element(cell) else {
                continue;
            };
            let nside = element.sides().len();
            match side {
                Side::Number(n) if element.dim() == dim && usize::from(n) <= nside => {
                    out.faces.push(Face { cell, side: n - 1 });
                }
                Side::Number(1 | 2) | Side::Positive | Side::Negative
                    if element.dim() + 1 == dim =>
                {
                    out.cells.push(cell);
                }
                _ => {
                    let hint = match element.dim() == dim {
                        true => format!("; its sides are S1 to S{nside}"),
                        false => "; name a side of the solid".to_owned(),
                    };
                    return Err(self.no_such_side(cell, side, definition, hint));
                }
            }
        }
        Ok(())
    }

    /// The sides of these cells that no other cell has.
    fn free_sides(
        &mut self,
        definition: &Definition,
        mut cells: Vec<CellId>,
        out: &mut Set,
    ) -> Result<()> {
        cells.sort_unstable();
        cells.dedup();
        let (mesh, dim) = (&self.mesh, self.dim());
        let free = (self.free).get_or_insert_with(|| boundary(mesh, mesh.cells(dim)));
        let before = out.faces.len();
        for cell in cells {
            let start = free.partition_point(|face| face.cell < cell);
            let of_cell = free.iter().skip(start).take_while(|face| face.cell == cell);
            out.faces.extend(of_cell);
        }
        self.spend(out.faces.len() - before, definition.spot, "the sets")
    }
}
