use super::{Archive, ArchiveError};
use signorini_geometry::mesh::NodeId;
use signorini_geometry::surface::RigidId;

/// The number of an unknown, prescribed ones included.
pub type Dof = u32;

/// No unknown: what is added to it is dropped (the third direction of a problem in the plane).
pub const NO_DOF: Dof = u32::MAX;

/// The number of fields that a [`Layout`] has room for.
pub const MAX_FIELDS: usize = 8;

/// One value for each scale of a layout, by [`Layout::scale`]; 0 where there is no such scale.
pub type ByScale = [f64; MAX_FIELDS];

/// What a field has values at.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Site {
    /// The nodes of the mesh.
    Nodes,
    /// Rigid bodies, and what else nodes follow.
    Carriers,
    /// The rows of constraints.
    Rows,
}

/// What residuals of a field are compared with. Fields that share a scale have equations of the same unit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scale {
    /// The mean force.
    Force,
    /// The mean moment: a sum of forces times distances.
    Moment,
    /// The mean of the equations of multipliers, which are constraints.
    Multiplier,
    /// The mean of the field's own equations.
    Own,
}

/// A named field of unknowns.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Field {
    /// Its name in messages and files.
    pub name: &'static str,
    /// What it has values at.
    pub on: Site,
    /// The number of its components at each of these.
    pub ncomponent: usize,
    /// What its residuals are compared with.
    pub scale: Scale,
}

/// The number of a field in a [`Layout`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct FieldId(u8);

impl FieldId {
    /// Displacement of the nodes; a component is one along an axis.
    pub const DISPLACEMENT: Self = Self(0);
    /// Translation of the carriers, likewise.
    pub const TRANSLATION: Self = Self(1);
    /// Rotation of the carriers; a component is one about an axis, in the plane about `z` alone.
    pub const ROTATION: Self = Self(2);
    /// Multipliers of constraints.
    pub const MULTIPLIER: Self = Self(3);

    /// Its place in the table of fields.
    #[must_use]
    pub const fn index(self) -> usize {
        self.0 as usize
    }
}

/// What a raw dof is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DofName {
    /// The field.
    pub field: FieldId,
    /// The node, the carrier or the row.
    pub entity: u32,
    /// The component: the axis where the field is a vector, else 0.
    pub component: usize,
}

impl DofName {
    /// Field, entity and component.
    #[must_use]
    pub const fn parts(self) -> (FieldId, u32, usize) {
        (self.field, self.entity, self.component)
    }

    /// Node and axis of a displacement.
    #[must_use]
    pub fn displacement(self) -> Option<(NodeId, usize)> {
        self.of(FieldId::DISPLACEMENT)
    }

    /// Carrier and axis of a translation.
    #[must_use]
    pub fn translation(self) -> Option<(RigidId, usize)> {
        self.of(FieldId::TRANSLATION)
    }

    /// Carrier and axis of a rotation.
    #[must_use]
    pub fn rotation(self) -> Option<(RigidId, usize)> {
        self.of(FieldId::ROTATION)
    }

    /// The number of a multiplier.
    #[must_use]
    pub fn multiplier(self) -> Option<usize> {
        self.of(FieldId::MULTIPLIER)
            .map(|(number, _)| number as usize)
    }

    fn of(self, field: FieldId) -> Option<(u32, usize)> {
        (self.field == field).then_some((self.entity, self.component))
    }
}

/// A field and where its dofs are: `first + entity · stride + component − axis`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Slot {
    field: Field,
    first: Dof,
    stride: u32,
    /// The number of its first component.
    axis: u8,
    /// The number of its scale.
    scale: u8,
}

impl Slot {
    const EMPTY: Self = Self {
        field: Field {
            name: "",
            on: Site::Rows,
            ncomponent: 0,
            scale: Scale::Own,
        },
        first: 0,
        stride: 1,
        axis: 0,
        scale: 0,
    };

    #[inline]
    const fn dof(&self, entity: u32, component: usize) -> Dof {
        let at = component.wrapping_sub(self.axis as usize);
        if at < self.field.ncomponent {
            self.first + entity * self.stride + at as u32
        } else {
            NO_DOF
        }
    }

    /// Entity and component of a dof, where there are this many entities.
    fn find(&self, dof: Dof, count: usize) -> Option<(u32, usize)> {
        let at = dof.checked_sub(self.first)?;
        if at as usize >= count * self.stride as usize {
            return None;
        }
        let (entity, at) = (at / self.stride, (at % self.stride) as usize);
        let is_own = at < self.field.ncomponent;
        is_own.then_some((entity, at + self.axis as usize))
    }
}

/// Which raw dof is which: a table of named fields.
///
/// Displacements come first, node by node; then carriers, each with its translation before its rotation
/// (`x y z θx θy θz` in space, `x y θz` in the plane); then the fields added by [`Layout::with_field`], one after the
/// other; multipliers come last.
///
/// Velocities and accelerations are states of a field, not fields.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Layout {
    ndim: usize,
    nnode: usize,
    nrigid: usize,
    nmultiplier: usize,
    nfield: usize,
    /// The number of the field of temperatures; [`MAX_FIELDS`] where there is none.
    heat: usize,
    slots: [Slot; MAX_FIELDS],
}

impl Layout {
    /// The field of temperatures: one at each node.
    pub const TEMPERATURE: Field = Field {
        name: "temperature",
        on: Site::Nodes,
        ncomponent: 1,
        scale: Scale::Own,
    };

    /// The scale of displacements and translations, forces.
    pub const FORCES: usize = 0;
    /// The scale of rotations, moments.
    pub const MOMENTS: usize = 1;
    /// The scale of multipliers.
    pub const MULTIPLIERS: usize = 2;
    /// The first scale of a field with one of its own; the others follow.
    pub const OWN: usize = 3;

    /// The fields of mechanics in `ndim` dimensions, 2 or 3: displacement of the nodes, translation and rotation of the
    /// carriers, and multipliers, of which there are none yet.
    #[must_use]
    pub const fn new(ndim: usize, nnode: usize, nrigid: usize) -> Self {
        let (nrotation, about) = if ndim == 3 { (3, 0) } else { (1, 2) };
        let width = (ndim + nrotation) as u32;
        let carriers = (nnode * ndim) as Dof;
        let rows = carriers + nrigid as Dof * width;
        let table = [
            ("displacement", Site::Nodes, ndim, Scale::Force),
            ("translation", Site::Carriers, ndim, Scale::Force),
            ("rotation", Site::Carriers, nrotation, Scale::Moment),
            ("multiplier", Site::Rows, 1, Scale::Multiplier),
        ];
        let places = [
            (0, ndim as u32, 0, Self::FORCES),
            (carriers, width, 0, Self::FORCES),
            (carriers + ndim as Dof, width, about, Self::MOMENTS),
            (rows, 1, 0, Self::MULTIPLIERS),
        ];
        let mut slots = [Slot::EMPTY; MAX_FIELDS];
        let mut k = 0;
        while k < table.len() {
            let (name, on, ncomponent, scale) = table[k];
            let (first, stride, axis, of) = places[k];
            slots[k] = Slot {
                field: Field {
                    name,
                    on,
                    ncomponent,
                    scale,
                },
                first,
                stride,
                axis,
                scale: of as u8,
            };
            k += 1;
        }
        Self {
            ndim,
            nnode,
            nrigid,
            nmultiplier: 0,
            nfield: table.len(),
            heat: MAX_FIELDS,
            slots,
        }
    }

    /// The same with this many multipliers.
    #[must_use]
    pub const fn with_multipliers(mut self, nmultiplier: usize) -> Self {
        self.nmultiplier = nmultiplier;
        self
    }

    /// The same with one more field, of nodes or carriers; its dofs come before the multipliers.
    ///
    /// `None` where the table is full, a field has this name, it is one of rows, which are multipliers alone, or has no
    /// component.
    #[must_use]
    pub fn with_field(mut self, field: Field) -> Option<Self> {
        let is_refused =
            field.on == Site::Rows || field.ncomponent == 0 || self.find(field.name).is_some();
        let scales = self.slots().iter().map(|slot| slot.scale as usize + 1);
        let scale = match field.scale {
            Scale::Force => Self::FORCES,
            Scale::Moment => Self::MOMENTS,
            Scale::Multiplier => Self::MULTIPLIERS,
            Scale::Own => scales.fold(Self::OWN, usize::max),
        };
        let rows = &mut self.slots[FieldId::MULTIPLIER.index()].first;
        let slot = Slot {
            field,
            first: *rows,
            stride: field.ncomponent as u32,
            axis: 0,
            scale: scale as u8,
        };
        let count = self.count(field.on) as u32;
        self.slots[FieldId::MULTIPLIER.index()].first += count * slot.stride;
        *self.slots.get_mut(self.nfield)? = slot;
        if field == Self::TEMPERATURE {
            self.heat = self.nfield;
        }
        self.nfield += 1;
        (!is_refused).then_some(self)
    }

    /// Dimension of space: 2 or 3.
    #[inline]
    #[must_use]
    pub const fn ndim(&self) -> usize {
        self.ndim
    }

    /// The number of nodes.
    #[inline]
    #[must_use]
    pub const fn nnode(&self) -> usize {
        self.nnode
    }

    /// The number of carriers: of rigid bodies, and of what else nodes follow.
    #[inline]
    #[must_use]
    pub const fn nrigid(&self) -> usize {
        self.nrigid
    }

    /// The number of multipliers.
    #[inline]
    #[must_use]
    pub const fn nmultiplier(&self) -> usize {
        self.nmultiplier
    }

    /// The number of entities of a site.
    #[must_use]
    pub const fn count(&self, on: Site) -> usize {
        match on {
            Site::Nodes => self.nnode,
            Site::Carriers => self.nrigid,
            Site::Rows => self.nmultiplier,
        }
    }

    /// The number of raw dofs.
    #[must_use]
    pub const fn ndof(&self) -> usize {
        self.multiplier(self.nmultiplier) as usize
    }

    /// The fields in the order of their numbers.
    pub fn fields(&self) -> impl Iterator<Item = (FieldId, &Field)> {
        let slots = self.slots().iter().enumerate();
        slots.map(|(k, slot)| (FieldId(k as u8), &slot.field))
    }

    /// The fields of nodes besides the displacement.
    pub fn other_nodal(&self) -> impl Iterator<Item = (FieldId, &Field)> {
        let all = self.fields();
        all.filter(|(id, field)| field.on == Site::Nodes && *id != FieldId::DISPLACEMENT)
    }

    /// The field with this number.
    #[must_use]
    pub fn field(&self, id: FieldId) -> Option<&Field> {
        self.slots().get(id.index()).map(|slot| &slot.field)
    }

    /// The field with this name.
    #[must_use]
    pub fn find(&self, name: &str) -> Option<FieldId> {
        let mut all = self.fields();
        all.find(|(_, field)| field.name == name).map(|(id, _)| id)
    }

    /// A component of a field at a node, a carrier or a row; [`NO_DOF`] where the field has no such component.
    #[must_use]
    pub fn dof(&self, field: FieldId, entity: u32, component: usize) -> Dof {
        let slot = self.slots().get(field.index());
        slot.map_or(NO_DOF, |slot| slot.dof(entity, component))
    }

    /// The dofs of a field: entity by entity, component by component.
    pub fn dofs(&self, field: FieldId) -> impl Iterator<Item = Dof> + use<> {
        let slot = self.slots().get(field.index()).copied();
        let slot = slot.unwrap_or(Slot::EMPTY);
        let (count, n) = (
            self.count(slot.field.on) as u32,
            slot.field.ncomponent as u32,
        );
        (0..count).flat_map(move |entity| {
            let first = slot.first + entity * slot.stride;
            first..first + n
        })
    }

    /// Displacement of a node along an axis; none along `z` in the plane.
    #[inline]
    #[must_use]
    pub const fn node(&self, node: NodeId, axis: usize) -> Dof {
        self.slots[FieldId::DISPLACEMENT.index()].dof(node, axis)
    }

    /// Temperature of a node; [`NO_DOF`] where temperatures are no unknowns.
    #[inline]
    #[must_use]
    pub fn temperature(&self, node: NodeId) -> Dof {
        let slot = self.slots.get(self.heat);
        slot.map_or(NO_DOF, |slot| slot.dof(node, 0))
    }

    /// Whether temperatures are unknowns.
    #[must_use]
    pub const fn has_temperatures(&self) -> bool {
        self.heat < MAX_FIELDS
    }

    /// Translation of a rigid body along an axis; none along `z` in the plane.
    #[must_use]
    pub const fn translation(&self, body: RigidId, axis: usize) -> Dof {
        self.slots[FieldId::TRANSLATION.index()].dof(body, axis)
    }

    /// Rotation of a rigid body about an axis; in the plane only about `z`.
    #[must_use]
    pub const fn rotation(&self, body: RigidId, axis: usize) -> Dof {
        self.slots[FieldId::ROTATION.index()].dof(body, axis)
    }

    /// A motion of a carrier: of 0 to 2 a translation along an axis, from 3 on a rotation about one.
    #[must_use]
    pub const fn carrier_motion(&self, carrier: RigidId, component: usize) -> Dof {
        match component {
            0..3 => self.translation(carrier, component),
            _ => self.rotation(carrier, component - 3),
        }
    }

    /// All six motions of a carrier.
    #[must_use]
    pub fn of_carrier(&self, carrier: RigidId) -> [Dof; 6] {
        std::array::from_fn(|component| self.carrier_motion(carrier, component))
    }

    /// A multiplier.
    #[must_use]
    pub const fn multiplier(&self, number: usize) -> Dof {
        self.slots[FieldId::MULTIPLIER.index()].first + number as Dof
    }

    /// The number of displacements, translations and rotations: the raw dofs before those of all other fields.
    #[must_use]
    pub const fn nmotion(&self) -> usize {
        let carriers = &self.slots[FieldId::TRANSLATION.index()];
        carriers.first as usize + self.nrigid * carriers.stride as usize
    }

    /// The rigid body whose translation or rotation a raw dof is.
    #[must_use]
    pub const fn carrier(&self, dof: Dof) -> Option<RigidId> {
        let carriers = &self.slots[FieldId::TRANSLATION.index()];
        if dof < carriers.first || dof as usize >= self.nmotion() {
            return None;
        }
        Some((dof - carriers.first) / carriers.stride)
    }

    /// What a raw dof is; `None` beyond the last.
    #[must_use]
    pub fn name(&self, dof: Dof) -> Option<DofName> {
        self.slots().iter().enumerate().find_map(|(k, slot)| {
            let (entity, component) = slot.find(dof, self.count(slot.field.on))?;
            Some(DofName {
                field: FieldId(k as u8),
                entity,
                component,
            })
        })
    }

    /// The number of the scale by which the residual at a raw dof is judged; that of forces beyond the last.
    #[must_use]
    pub fn scale(&self, dof: Dof) -> usize {
        // most are displacements
        if dof < self.slots[FieldId::TRANSLATION.index()].first {
            return Self::FORCES;
        }
        let name = self.name(dof);
        name.map_or(Self::FORCES, |name| self.scale_of(name.field))
    }

    /// The number of the scale of a field.
    #[must_use]
    pub fn scale_of(&self, field: FieldId) -> usize {
        let slot = self.slots().get(field.index());
        slot.map_or(Self::FORCES, |slot| slot.scale as usize)
    }

    /// The number of scales: those of mechanics, and those that fields have of their own.
    #[must_use]
    pub fn nscale(&self) -> usize {
        let scales = self.slots().iter().map(|slot| slot.scale as usize + 1);
        scales.fold(Self::OWN, usize::max)
    }

    /// The largest value of the fields of each scale, in its absolute size; those of motions, forces and moments alike,
    /// share that of forces, and multipliers have none.
    #[must_use]
    pub fn largest(&self, value: impl Fn(usize) -> f64) -> ByScale {
        let most = |m: f64, dof: usize| m.max(value(dof).abs());
        let mut largest = ByScale::default();
        largest[Self::FORCES] = (0..self.nmotion()).fold(0.0, most);
        for (id, _) in self.fields().skip(FieldId::MULTIPLIER.index() + 1) {
            let dofs = self.dofs(id).map(|dof| dof as usize);
            if let Some(of) = largest.get_mut(self.scale_of(id)) {
                *of = dofs.fold(*of, most);
            }
        }
        largest
    }

    /// Stores the values of all raw dofs, each field under its name.
    pub fn save(&self, prefix: &str, values: &[f64], out: &mut Archive) {
        for (id, field) in self.fields() {
            let of = self.dofs(id).filter_map(|dof| values.get(dof as usize));
            let of: Vec<f64> = of.copied().collect();
            out.put(format!("{prefix}.{}", field.name), &of);
        }
    }

    /// Takes the values of all raw dofs back.
    ///
    /// # Errors
    /// A field that the archive does not have, or has of another size.
    pub fn load(
        &self,
        prefix: &str,
        values: &mut [f64],
        from: &Archive,
    ) -> Result<(), ArchiveError> {
        for (id, field) in self.fields() {
            let mut of = vec![0.0; self.dofs(id).count()];
            from.get(&format!("{prefix}.{}", field.name), &mut of)?;
            for (dof, value) in self.dofs(id).zip(of) {
                if let Some(to) = values.get_mut(dof as usize) {
                    *to = value;
                }
            }
        }
        Ok(())
    }

    fn slots(&self) -> &[Slot] {
        self.slots.get(..self.nfield).unwrap_or_default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const HEAT: Field = Layout::TEMPERATURE;

    fn layout(ndim: usize) -> Layout {
        Layout::new(ndim, 5, 2).with_multipliers(3)
    }

    #[test]
    fn names_invert_numbers() {
        for ndim in [2, 3] {
            for layout in [layout(ndim), layout(ndim).with_field(HEAT).unwrap()] {
                let mut seen = vec![0; layout.ndof()];
                for dof in 0..layout.ndof() as Dof {
                    let name = layout.name(dof).unwrap();
                    let back = layout.dof(name.field, name.entity, name.component);
                    assert_eq!(back, dof);
                    let carrier = name.translation().or(name.rotation()).map(|(b, _)| b);
                    assert_eq!(layout.carrier(dof), carrier);
                    let motion = carrier.or(name.displacement().map(|(n, _)| n));
                    assert_eq!(motion.is_some(), (dof as usize) < layout.nmotion());
                    assert_eq!(layout.scale(dof), layout.scale_of(name.field));
                }
                for (id, _) in layout.fields() {
                    layout.dofs(id).for_each(|dof| seen[dof as usize] += 1);
                }
                assert!(seen.iter().all(|&n| n == 1));
                assert_eq!(layout.name(layout.ndof() as Dof), None);
            }
        }
    }

    #[test]
    fn carriers_have_translations_before_rotations_and_multipliers_come_last() {
        let [plane, space] = [2, 3].map(layout);
        assert_eq!([0, 1, 2].map(|k| plane.translation(1, k)), [13, 14, NO_DOF]);
        assert_eq!(
            [0, 1, 2].map(|k| plane.rotation(1, k)),
            [NO_DOF, NO_DOF, 15]
        );
        assert_eq!([0, 1, 2].map(|k| space.translation(1, k)), [21, 22, 23]);
        assert_eq!([0, 1, 2].map(|k| space.rotation(1, k)), [24, 25, 26]);
        assert_eq!((plane.node(1, 2), space.node(1, 2)), (NO_DOF, 5));
        assert_eq!((plane.multiplier(2), plane.ndof()), (18, 19));
    }

    #[test]
    fn a_field_more_changes_no_number_but_those_of_multipliers() {
        let before = layout(3);
        let after = before.with_field(HEAT).unwrap();
        for dof in 0..before.nmotion() as Dof {
            assert_eq!(after.name(dof), before.name(dof));
        }
        let heat = after.find("temperature").unwrap();
        assert_eq!(
            (before.has_temperatures(), after.has_temperatures()),
            (false, true)
        );
        assert_eq!(
            (before.temperature(3), after.temperature(3)),
            (NO_DOF, after.dof(heat, 3, 0))
        );
        let dofs: Vec<Dof> = after.dofs(heat).collect();
        let first = before.nmotion() as Dof;
        assert_eq!(dofs, (first..first + 5).collect::<Vec<_>>());
        assert_eq!(after.multiplier(0), first + 5);
        assert_eq!((before.nscale(), after.nscale()), (3, 4));
        assert_eq!(after.with_field(HEAT), None);
        let rows = Field {
            name: "flux",
            on: Site::Rows,
            ..HEAT
        };
        assert_eq!(after.with_field(rows), None);
    }

    #[test]
    fn a_full_table_takes_no_field() {
        let names = ["a", "b", "c", "d", "e"];
        let mut all = names.iter().map(|&name| Field { name, ..HEAT });
        let full = all.try_fold(layout(2), |layout, field| layout.with_field(field));
        assert_eq!(full, None);
    }

    #[test]
    fn values_come_back_from_an_archive_field_by_field() {
        let layout = layout(2).with_field(HEAT).unwrap();
        let values: Vec<f64> = (0..layout.ndof()).map(|k| k as f64).collect();
        let mut archive = Archive::default();
        layout.save("u", &values, &mut archive);
        assert_eq!(archive.length("u.temperature"), Ok(5));
        let mut back = vec![0.0; values.len()];
        layout.load("u", &mut back, &archive).unwrap();
        assert_eq!(back, values);
        let other = layout.with_multipliers(4);
        assert!(other.load("u", &mut back, &archive).is_err());
    }
}
