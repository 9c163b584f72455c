"""Cases: what is run, built in Python or read from a file."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any, Literal, TypeAlias, TypeVar, cast

from . import _html
from . import keys as k
from ._documented import documented
from ._table import Items, Key, MaterialTable, Shape, Table, TableDict, TableList, dump, plain
from .physics import KINDS, Course, Physics
from .physics import Material as OwnMaterial

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray
    from typing_extensions import Self, Unpack

    from . import _native
    from .errors import Diagnostic
    from .mesh import Mesh
    from .physics import Projection, SignedDistance
    from .result import Increment, Result
    from .stepper import Stepper

    Vector: TypeAlias = "Sequence[float] | NDArray[np.float64]"
    Scalar: TypeAlias = "float | Sequence[Sequence[float]] | NDArray[np.float64] | Course | Mapping[str, Any]"
    Directions: TypeAlias = "str | Sequence[str]"

T = TypeVar("T", bound=Table)
AXES = "xyz"


class _MeshKey(Key[Any, Any]):
    """The mesh: an object, not a table."""

    def read(self, table: Table) -> Any:
        return cast("Case", table)._mesh

    def write(self, table: Table, value: Any) -> None:
        object.__setattr__(table, "_mesh", _mesh(value))


def _mesh(value: Any) -> Mesh | None:
    from .mesh import Mesh

    if value is None or isinstance(value, Mesh):
        return value
    if isinstance(value, (str, os.PathLike)):
        return Mesh.read(cast("str", value))
    if isinstance(value, Mapping):
        return Mesh.read(cast("Mapping[str, str]", value)["file"])
    if hasattr(value, "cells_dict") and hasattr(value, "point_sets"):
        return Mesh.from_meshio(value)
    if hasattr(value, "cast_to_unstructured_grid"):
        return Mesh.from_pyvista(value)
    raise TypeError(
        f"a mesh has to be a signorini.Mesh, the path of a file, or one of pyvista or meshio, found {type(value).__name__}"
    )


def _directions(u: Directions) -> str | list[str]:
    """`"all"`, `"xy"` or `["x", "y"]` as a case has them."""
    if isinstance(u, str):
        if u == "all":
            return u
        u = list(u)
    for one in u:
        if one not in AXES:
            raise ValueError(f'directions are "all", or some of x, y, z as in "xz", found {one!r}')
    return list(u)


def _increments(value: Any) -> Any:
    """`(initial, min, max)` as a table."""
    if isinstance(value, tuple):
        given = cast("tuple[float, ...]", value)
        if not 1 <= len(given) <= 3:
            raise ValueError(f"increments are a number, (initial, min, max) or a table, found {value!r}")
        return dict(zip(("initial", "min", "max"), given, strict=False))
    return value


def _some(**values: Any) -> dict[str, Any]:
    """What is not None."""
    return {key: value for key, value in values.items() if value is not None}


class Step(k.Step):
    """A step of a run. Supports, motions and loads stay in later steps until they are changed there.

    TOML: `[[step]]`. Made by `Case.step`.
    """

    _toml = "step"

    def fix(self, on: str, u: Directions | None = None, rot: Directions | None = None) -> k.Fix:
        """Holds displacements, or rotations `rot` of a reference or rigid body, at their present values.

        `u`: "all" (where neither is given), or some of x, y, z as in "xy" or ["x", "y"].

        TOML: `[[step.fix]]`.
        """
        if u is None and rot is None:
            u = "all"
        given = _some(u=None if u is None else _directions(u), rot=None if rot is None else _directions(rot))
        return self.fixes.add(k.Fix(on=on, **given))

    def move(
        self,
        on: str,
        x: Scalar | None = None,
        y: Scalar | None = None,
        z: Scalar | None = None,
        *,
        ux: Scalar | None = None,
        uy: Scalar | None = None,
        uz: Scalar | None = None,
        rx: Scalar | None = None,
        ry: Scalar | None = None,
        rz: Scalar | None = None,
        from_: k.MoveFrom | Mapping[str, Any] | None = None,
    ) -> k.Move:
        """Prescribes displacements `x`, `y`, `z` (length; also `ux`, …) or rotations `rx`, … (radian).

        A number is reached linearly over the step; rows `[[time, value], ...]` and functions of the time give the
        course; `{"amplitude": "saw", "value": 8.0}` scales an amplitude. `from_={"file": "global.frd", "step": 1}` takes the
        displacements from the results of another model.

        TOML: `[[step.move]]`.
        """
        for short, long, name in ((x, ux, "x"), (y, uy, "y"), (z, uz, "z")):
            if short is not None and long is not None:
                raise TypeError(f"{name} and u{name} are the same: give one of them")
        first = _some(ux=x, uy=y, uz=z)
        given = {**first, **_some(ux=ux, uy=uy, uz=uz, rx=rx, ry=ry, rz=rz)}
        given |= _some(from_=from_)
        if not given:
            raise TypeError("move needs at least one of x, y, z, rx, ry, rz, from_")
        return self.moves.add(k.Move(on=on, **given))

    def load(
        self,
        on: str,
        *,
        force: Vector | None = None,
        traction: Vector | None = None,
        pressure: Scalar | None = None,
        moment: Vector | None = None,
        per_node: Vector | None = None,
        body_force: Vector | None = None,
        gravity: Vector | None = None,
        centrifugal: k.LoadCentrifugal | Mapping[str, Any] | None = None,
        amplitude: str | Sequence[Sequence[float]] | Course | None = None,
        coupling: Literal["none", "rigid-x", "rigid-y", "rigid-z"] | None = None,
        follows: bool | None = None,
        name: str | None = None,
    ) -> k.Load:
        """Applies one load, reached linearly over the step.

        Parameters
        ----------
        force: the total force [x, y, z], spread over `on` (force)
        traction: force per area (stress); pressure: positive inwards (stress)
        moment: about the centre of `on` (force · length); per_node: the same force at every node
        body_force: force per volume; gravity: acceleration; centrifugal: {"speed", "axis", "point"}
        amplitude: the factor over time: a name, rows [[time, factor], ...], or a function of the time of the step
        coupling: "rigid-z": the loaded set keeps one common displacement along z
        follows: whether a pressure turns with the surface
        name: a later load of this name replaces this one

        TOML: `[[step.load]]`.
        """
        given = _some(
            force=force,
            traction=traction,
            pressure=pressure,
            moment=moment,
            per_node=per_node,
            body_force=body_force,
            gravity=gravity,
            centrifugal=centrifugal,
        )
        if len(given) != 1:
            found = ", ".join(given) or "none"
            raise TypeError(
                f"a load is one of force, traction, pressure, moment, per_node, body_force, gravity, centrifugal; found {found}"
            )
        course = plain(pressure)
        if callable(course) or isinstance(course, list):
            if amplitude is not None:
                raise TypeError("give the course of a pressure either as its value or as amplitude")
            given, amplitude = {"pressure": 1.0}, cast("Any", course)
        over: dict[str, Any] = {}
        if amplitude is not None:
            is_table = not isinstance(amplitude, str) and not callable(amplitude)
            over = {"table" if is_table else "amplitude": amplitude}
        more = _some(name=name, coupling=coupling, follows=follows)
        return self.loads.add(k.Load({**more, "on": on, **given, **over}))

    def free(self, on: str, u: Directions | None = None, rot: Directions | None = None) -> k.Free:
        """Ends supports and motions of earlier steps.

        TOML: `[[step.free]]`.
        """
        if u is None and rot is None:
            u = "all"
        given = _some(u=None if u is None else _directions(u), rot=None if rot is None else _directions(rot))
        return self.frees.add(k.Free(on=on, **given))

    def contact(
        self,
        name: str | k.Contact,
        *,
        active: bool | None = None,
        friction: float | Mapping[str, Any] | Physics | None = None,
    ) -> k.ContactChange:
        """Changes a contact from this step on.

        TOML: `[[step.contact]]`.
        """
        named = name if isinstance(name, str) else name.name
        return self.contacts.add(k.ContactChange(name=named, **_some(active=active, friction=friction)))

    def temperature(self, value: float, on: str = "all") -> k.Temperature:
        """Prescribes a temperature, reached linearly over the step.

        TOML: `[[step.temperature]]`.
        """
        return self.temperatures.add(k.Temperature(on=on, value=value))

    def material(self, group: str, material: str | k.Material | OwnMaterial) -> k.MaterialChange:
        """Gives a body another material from this step on.

        TOML: `[[step.material]]`.
        """
        return self.materials.add(k.MaterialChange(group=group, material=material))

    def deactivate(self, group: str, *, ramp: bool | None = None) -> k.Deactivate:
        """Removes elements, with their loads and contact faces, from this step on.

        `ramp`: whether what they exert falls to zero over the step, as it does where it is not given, or is gone at once.

        TOML: `[[step.deactivate]]`.
        """
        return self.deactivations.add(k.Deactivate(group=group, **_some(ramp=ramp)))

    def activate(self, group: str, *, strain: Literal["free", "keep"] | None = None) -> k.Activate:
        """Adds elements that were removed, from this step on.

        `strain`: "free", as where it is not given, without stress where they are, as new; "keep" with what they had.

        TOML: `[[step.activate]]`.
        """
        return self.activations.add(k.Activate(group=group, **_some(strain=strain)))

    @documented(k.Print, "on")
    def print(self, on: str | None = None, **keys: Unpack[k.PrintKeys]) -> k.Print:
        """Prints tables in NAME.dat, in CalculiX's format.

        TOML: `[[step.print]]`.
        """
        return self.prints.add(k.Print({**_some(on=on), **cast("dict[str, Any]", keys)}))


class Case(k.CaseTable):
    """A case: mesh, bodies, contacts, steps and how they are solved.

    Parameters
    ----------
    mesh: a `Mesh`, the path of a mesh file, or a mesh of PyVista or meshio
    title, units: labels; `units` such as "mm-N-MPa" serves plausibility checks, nothing is converted
    keys: any other key of the case format by its name

    Everything that a case file can say is an attribute of the same name: `case.solver.newton.max_iterations = 20`.
    Lists have plural names: `case.contacts["foot"].friction = 0.3`.

    >>> case = Case(units="mm-N-MPa")
    >>> body = case.body("block", k.LinearElastic(E=210e3, nu=0.3))
    >>> floor = case.contact("foot", k.Plane(normal=(0, 0, 1)), name="floor", friction=0.2)
    >>> press = case.step("press", increments=5)
    >>> move = press.move("head", z=-0.4)
    >>> case.steps["press"].moves[0].uz
    -0.4
    >>> case.materials
    {'linear-elastic': LinearElastic(E=210000.0, nu=0.3)}
    """

    _toml = ""
    _mesh: Mesh | None
    _path: str | None
    _folder: str | None
    _diagnostics: list[Diagnostic]
    mesh: Key[Any, Any] = _MeshKey("Nodes, cells and sets", "a Mesh")  # pyright: ignore[reportIncompatibleVariableOverride]
    steps: Items[Step] = Items(  # type: ignore[assignment]  # pyright: ignore[reportIncompatibleVariableOverride]
        Step, "What happens, in order; a step keeps what earlier ones set", "list of a table", key="step"
    )

    def __init__(
        self,
        mesh: Mesh | str | os.PathLike[str] | Any | None = None,
        title: str = "",
        units: str = "",
        **keys: Any,
    ) -> None:
        object.__setattr__(self, "_mesh", None)
        object.__setattr__(self, "_path", None)
        object.__setattr__(self, "_folder", None)
        object.__setattr__(self, "_diagnostics", [])
        super().__init__({**_some(title=title or None, units=units or None), **keys})
        self["mesh"] = mesh

    # -- what it is made of -------------------------------------------------------------------------------------

    @documented(k.Body, "group", "material")
    def body(
        self,
        group: str | Sequence[str],
        material: str | k.Material | OwnMaterial | None = None,
        **keys: Unpack[k.BodyKeys],
    ) -> k.Body:
        """Adds a solid, bars or a rigid tool: a group of cells, or "all" of them.

        `material`: an object such as `LinearElastic(E=210e3, nu=0.3)`, or the name of one of the case.

        TOML: `[[body]]`.
        """
        given: dict[str, Any] = {"group": group}
        if material is not None:
            given["material"] = material if isinstance(material, str) else self._named(material)
        return self.bodies.add(k.Body({**given, **cast("dict[str, Any]", keys)}))

    @documented(k.Contact, "secondary", "primary", "name")
    def contact(
        self,
        secondary: str,
        primary: str | k.Surface | Shape | SignedDistance | Projection,
        *,
        name: str | None = None,
        **keys: Unpack[k.ContactKeys],
    ) -> k.Contact:
        """Adds a pair of surfaces that may touch.

        `secondary`: the side that carries the points, the finer, softer or more curved one. `primary`: the side they
        may not pass through: a set, a surface of the case, "self", or an object such as `Plane(normal=(0, 0, 1))`.

        TOML: `[[contact]]`.
        """
        if name is None:
            called = primary if isinstance(primary, str) else type(primary).__name__.lower()
            name = self._free_name(f"{secondary}-{called}", self.contacts.names())
        if isinstance(primary, k.Surface):
            primary = cast("str", primary.name)
        elif not isinstance(primary, str):
            taken = [*self.surfaces.names(), *self.sets, *self.references]
            taken += [] if self._mesh is None else self._mesh.set_names
            primary = cast("str", self.surface(self._free_name(f"{name}-surface", taken), primary).name)
        given = {"name": name, "secondary": secondary, "primary": primary}
        return self.contacts.add(k.Contact({**given, **cast("dict[str, Any]", keys)}))

    def step(
        self,
        name: str | None = None,
        *,
        increments: int | tuple[float, ...] | Mapping[str, Any] | None = None,
        geometry: Literal["auto", "linear", "nonlinear"] | None = None,
        duration: float | None = None,
        **keys: Any,
    ) -> Step:
        """Adds a step.

        Parameters
        ----------
        increments: a number n (smaller ones where needed), (initial, min, max) in the time of the step, or
            {"fixed": n} for exactly n
        geometry: "linear" (small displacements) or "nonlinear"
        duration: how long it takes, by default 1

        TOML: `[[step]]`.
        """
        name = name or self._free_name(f"step {len(self.steps) + 1}", self.steps.names())
        given = _some(geometry=geometry, duration=duration, increments=_increments(increments))
        return self.steps.add(Step({"name": name, **given, **keys}))

    def material(self, name: str, model: str | k.Material | OwnMaterial, **constants: Any) -> k.Material:
        """Adds a material by name: of an object, or of a model and its constants.

        TOML: `[material.NAME]`.
        """
        made: Any = {"model": model, **constants} if isinstance(model, str) else model
        self.materials[name] = made
        return self.materials[name]

    def surface(
        self, name: str, shape: Shape | SignedDistance | Projection | Mapping[str, Any], *, reference: str | None = None
    ) -> k.Surface:
        """Adds a rigid surface without a mesh: `Plane`, `Sphere`, `Cylinder`, …, or an own one.

        `reference`: the reference it moves with; absent: it is fixed in space.

        TOML: `[[surface]]`.
        """
        return self.surfaces.add(k.Surface({"name": name, "shape": shape, **_some(reference=reference)}))

    def amplitude(
        self,
        name: str,
        course: Sequence[Sequence[float]] | NDArray[np.float64] | Course,
        *,
        time: Literal["step", "total"] | None = None,
    ) -> k.Amplitude:
        """Adds a factor over time: rows [[time, factor], ...] or a function of the time.

        TOML: `[amplitude.NAME]`.
        """
        key = "own" if callable(course) else "table"
        self.amplitudes[name] = k.Amplitude({key: course, **_some(time=time)})
        return self.amplitudes[name]

    def reference(
        self, name: str, at: Vector | None = None, *, node: int | None = None, rotations: int | None = None
    ) -> k.Reference:
        """Adds a named point with translations and rotations of its own: at coordinates (length) or at a node.

        TOML: `[reference.NAME]`.
        """
        self.references[name] = k.Reference(_some(at=at, node=node, rotations=rotations))
        return self.references[name]

    @documented(k.Constraint, "kind", "on")
    def constraint(
        self, kind: str | None = None, on: str | None = None, **keys: Unpack[k.ConstraintKeys]
    ) -> k.Constraint:
        """Adds a constraint between displacements.

        TOML: `[[constraint]]`.
        """
        return self.constraints.add(k.Constraint({**_some(kind=kind, on=on), **cast("dict[str, Any]", keys)}))

    @documented(k.Spring, "name")
    def spring(self, name: str, **keys: Unpack[k.SpringKeys]) -> k.Spring:
        """Adds springs between nodes or to the ground.

        TOML: `[[spring]]`.
        """
        return self.springs.add(k.Spring({"name": name, **cast("dict[str, Any]", keys)}))

    @documented(k.Set)
    def set(self, name: str, **keys: Unpack[k.SetKeys]) -> k.Set:
        """Adds a set by geometry or by numbers; sets by indices belong to the mesh.

        TOML: `[sets]`.
        """
        self.sets[name] = k.Set(cast("dict[str, Any]", keys))
        return self.sets[name]

    @documented(k.Orientation)
    def orientation(self, name: str, **keys: Unpack[k.OrientationKeys]) -> k.Orientation:
        """Adds axes of materials that bodies name.

        TOML: `[orientation.NAME]`.
        """
        self.orientations[name] = k.Orientation(cast("dict[str, Any]", keys))
        return self.orientations[name]

    def expect(
        self,
        what: str,
        value: float,
        *,
        rel: float | None = None,
        abs: float | None = None,
        at: int | None = None,
        time: float | None = None,
    ) -> k.Expect:
        """Adds a value to check at the end, within `rel` (relative) or `abs` (in its unit).

        `what`: a column of the history such as "floor.force_z", or "displacement.z @ node 5".

        TOML: `[[expect]]`.
        """
        tol = _some(rel=rel, abs=abs)
        return self.expects.add(k.Expect({"what": what, "value": value, **_some(at=at, time=time, tol=tol or None)}))

    def history(
        self,
        name: str,
        quantity: str | Sequence[str],
        *,
        contact: str | None = None,
        node: int | None = None,
        set: str | None = None,
        reference: str | None = None,
    ) -> k.OutputHistory:
        """Adds columns `name.quantity` to the history, of a contact, a node, a set or a reference.

        TOML: `[[output.history]]`.
        """
        of = _some(contact=contact, node=node, set=set, reference=reference)
        return self.output.history.add(k.OutputHistory({"name": name, "quantity": quantity, **of}))

    def _named(self, material: Any) -> str:
        """The name of a material object, which is added where it is not there yet."""
        for name, known in self.materials.items():
            if known is material or (isinstance(material, OwnMaterial) and known._values.get("own") is material):
                return name
        base = (material._model or str(material.model)) if isinstance(material, k.Material) else "own"
        name = self._free_name(base, self.materials)
        self.materials[name] = cast("k.Material", material)
        return name

    @staticmethod
    def _free_name(base: str, taken: Any) -> str:
        names, number = set(taken), 2
        name = base
        while name in names:
            name, number = f"{base}-{number}", number + 1
        return name

    # -- from and to text ---------------------------------------------------------------------------------------

    @classmethod
    def from_dict(cls, values: Mapping[str, Any], mesh: Mesh | None = None) -> Case:
        """A case of dictionaries as TOML has them. A key `mesh` is read unless a mesh is given."""
        case = cls()
        table = {key: value for key, value in values.items() if not (key == "mesh" and mesh is not None)}
        case.update(table)
        if mesh is not None:
            case.mesh = mesh
        return case

    @classmethod
    def from_toml(cls, text: str, folder: str | os.PathLike[str] = ".") -> Case:
        """A case of a text in TOML; paths in it are relative to `folder`."""
        import tempfile

        # the native loader reads files: messages name the place in this text
        with tempfile.TemporaryDirectory() as place:
            path = os.path.join(place, "case.toml")
            values = _parse(text)
            table = values.get("mesh")
            if isinstance(table, dict) and "file" in table:
                file = os.path.join(os.path.abspath(folder), cast("str", table["file"]))
                from .mesh import Mesh

                case = cls.from_dict(values, Mesh.read(file))
            else:
                with open(path, "w", encoding="utf-8") as out:
                    out.write(text)
                case = load(path)
        object.__setattr__(case, "_path", None)
        object.__setattr__(case, "_folder", os.path.abspath(folder))
        return case

    def to_dict(self) -> dict[str, Any]:
        """The case as dictionaries, without its mesh. Own physics appear by name."""
        return self._resolved()[0]

    def to_toml(self, path: str | os.PathLike[str] | None = None) -> str:
        """The case as TOML; written to a file where a path is given.

        A mesh from a file is named, as long as its sets are those of the file; any other mesh is written in place.
        """
        values, _ = self._resolved()
        folder = self._folder if path is None else os.path.dirname(os.path.abspath(path))
        if path is not None and self._folder is not None:
            _move_paths(values, self._folder, cast("str", folder))
        text = self._text(values, folder)
        if path is not None:
            with open(path, "w", encoding="utf-8") as out:
                out.write(text)
        return text

    def _resolved(self) -> tuple[dict[str, Any], dict[str, dict[str, Any]]]:
        """The case without mesh, and its own physics by kind and name."""
        resolver = _Resolver(self)
        values = resolver.resolve()
        return {"format": 1, **values}, resolver.own

    def job(self, *, saved: bool = False) -> _native.Job:
        """What the Rust module runs. `saved`: with the text that a folder of results keeps, to be resumed from."""
        from . import _native
        from .errors import InputError

        if self._mesh is None:
            raise InputError('the case has no mesh: give one, as in Case(mesh) or case.mesh = Mesh.read("part.msh")')
        values, own = self._resolved()
        folder = self._folder or os.getcwd()
        record = self._text(values, folder) if saved else None
        return _native.Job(_native.write(_in_order(values)), self.name, folder, self._mesh.native(), record, own)

    def fingerprint(self) -> tuple[str, tuple[int, ...], int]:
        """What changes where the case does: its text, its own physics, its mesh."""
        values, own = self._resolved()
        objects = tuple(id(one) for kind in own.values() for one in kind.values())
        return repr(values), objects, id(self._mesh)

    def _text(self, values: dict[str, Any], folder: str | None) -> str:
        """The case in TOML with the file of its mesh, or with the mesh in place behind it."""
        from . import _native

        if self._mesh is None:
            return _native.write(_in_order(values))
        if self._mesh.file is not None:
            file = self._mesh.file if folder is None else _relative(self._mesh.file, folder)
            return _native.write(_in_order({**values, "mesh": {"file": file.replace(os.sep, "/")}}))
        inline, unions = self._mesh.in_place()
        sets = {**unions, **values.get("sets", {})}
        if set(values.get("sets", {})).isdisjoint(self._mesh.set_names):
            # the text of the mesh ends with its sets, to which those of the case are added
            rest = {key: value for key, value in values.items() if key != "sets"}
            more = _native.write({"sets": sets}) if sets else ""
            more = more.removeprefix("[sets]").lstrip()
            return f"{_native.write(_in_order(rest))}\n{inline}{more}"
        found = _parse(inline)
        both = {**values, "mesh": found["mesh"], "sets": {**found.get("sets", {}), **sets}}
        return _native.write(_in_order(both))

    @property
    def name(self) -> str:
        """The name of its results: that of its file, else "signorini"."""
        return "signorini" if self._path is None else os.path.splitext(os.path.basename(self._path))[0]

    @property
    def default_output(self) -> str:
        """The folder of results where none is given: NAME.out next to the case file, else signorini.out here."""
        folder = os.getcwd() if self._path is None else os.path.dirname(self._path)
        return os.path.join(folder, f"{self.name}.out")

    @property
    def diagnostics(self) -> list[Diagnostic]:
        """Findings of reading the file."""
        return list(self._diagnostics)

    def copy(self) -> Self:
        """A copy; the mesh, functions and own physics are shared."""
        twin = super().copy()
        for name in ("_mesh", "_path", "_folder", "_diagnostics"):
            object.__setattr__(twin, name, getattr(self, name))
        return twin

    __copy__ = copy

    # -- what is done with it -----------------------------------------------------------------------------------

    def check(self) -> Preview:
        """Reads everything and solves nothing: mesh quality, free motions, a preview of contacts, cost."""
        from . import _native

        lines, found = _native.check(self.job())
        return Preview(lines, found)

    def run(
        self,
        output: str | os.PathLike[str] | None = None,
        *,
        on_increment: Callable[[Increment], object] | None = None,
        on_iteration: Callable[[dict[str, Any]], object] | None = None,
        fresh: bool = False,
        resume: bool = False,
        threads: int | None = None,
        save: bool = True,
        keep: bool = True,
        progress: bool | None = None,
    ) -> Result:
        """Solves the case.

        Parameters
        ----------
        output: the folder of results; absent: NAME.out next to the case file, or signorini.out
        on_increment: receives each converged increment; returning True stops the run, with its state saved
        on_iteration: receives a dict for each Newton iteration; returning True stops likewise
        fresh: start again in a folder that has results of another case; resume: go on from its last checkpoint
        threads: the number of threads; absent: all cores
        save: False writes no file
        keep: False reads frames from the folder when they are asked for: for runs whose frames fill the memory
        progress: True shows it, False not; absent: a plot in notebooks with ipywidgets, lines in a terminal

        Raises `InputError`, `ModelError`, `NotConverged` (with the converged frames in `.result`), `OutputError`,
        `RestartError`, and what a callback or own physics raise. Ctrl-C leaves a folder that can be resumed.
        """
        from .result import run

        folder = None if not save else os.fspath(output) if output is not None else self.default_output
        return run(
            self,
            folder,
            on_increment=on_increment,
            on_iteration=on_iteration,
            fresh=fresh,
            resume=resume,
            threads=threads,
            progress=progress,
            keep=keep or folder is None,
        )

    def stepper(self, threads: int | None = None) -> Stepper:
        """Drives the case from Python, increment by increment: for coupling and optimisation."""
        from .stepper import Stepper

        return Stepper(self, threads=threads)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Case):
            return NotImplemented
        return self._mesh is other._mesh and self.to_dict() == other.to_dict()

    __hash__ = None  # type: ignore[assignment]  # pyright: ignore[reportAssignmentType]

    def __repr__(self) -> str:
        parts = [repr(self.title)] if self.title else []
        parts += [repr(self._mesh)] if self._mesh is not None else []
        for name, items in (("bodies", self.bodies), ("contacts", self.contacts), ("steps", self.steps)):
            if len(items):
                parts.append(f"{name} {', '.join(items.names())}")
        return f"<Case: {', '.join(parts)}>" if parts else "<Case>"

    def _repr_html_(self) -> str:
        from .notebook import thumbnail

        rows: list[tuple[str, object]] = [("units", self.units)] if self.units else []
        rows += [("body", f"{', '.join(_list(one.group))}: {one.material or 'rigid'}") for one in self.bodies]
        rows += [(f"material {name}", _described(one)) for name, one in self.materials.items()]
        rows += [
            ("contact", f"{one.name}: {one.secondary} on {one.primary}, {_described(one)}") for one in self.contacts
        ]
        for step in self.steps:
            rows.append(("step", step.name))
            rows += [("fix", f"{one.on}: {one.u or ''} {one.rot or ''}") for one in step.fixes]
            rows += [("move", f"{one.on}: {_described(one)}") for one in step.moves]
            rows += [("load", f"{one.on}: {_described(one)}") for one in step.loads]
        return _html.document(self.title or "Case", rows, picture=thumbnail(self._mesh))


class Preview:
    """What `Case.check` found: the lines that `signorini check` prints, and what is unusual in `diagnostics`."""

    def __init__(self, lines: Sequence[str], diagnostics: Sequence[Mapping[str, Any]] = ()) -> None:
        from .errors import Diagnostic

        self.lines = list(lines)
        self.diagnostics: list[Diagnostic] = [Diagnostic(one) for one in diagnostics]

    def __str__(self) -> str:
        return "\n".join([*(str(one) for one in self.diagnostics), *self.lines])

    __repr__ = __str__

    def _repr_html_(self) -> str:
        from html import escape

        return f"<pre>{escape(str(self))}</pre>"


def load(path: str | os.PathLike[str], *, set: Mapping[str, Any] | None = None, compat: str | None = None) -> Case:
    """Reads a case (.toml), a deck of Abaqus or CalculiX (.inp), or one of OOFEM (.in).

    `set`: keys to override as the command's `--set`: `{"material.steel.E": 2000}`; `compat`: "ccx", "abaqus", "oofem".
    """
    from . import _native
    from .errors import Diagnostic
    from .mesh import Mesh

    given = [(key, value if isinstance(value, str) else _toml(value)) for key, value in (set or {}).items()]
    path = os.fspath(path)
    loaded = _native.load(path, given, compat)
    file = loaded.mesh_file
    mesh = Mesh.from_native(loaded.mesh, file=None if file is None else os.path.abspath(file))
    case = Case.from_dict(_parse(loaded.text), mesh)
    for key, value in (set or {}).items():
        _override(case, key, value)
    object.__setattr__(case, "_path", os.path.abspath(path))
    object.__setattr__(case, "_folder", os.path.abspath(loaded.folder or os.path.dirname(path)))
    object.__setattr__(case, "_diagnostics", [Diagnostic(one) for one in loaded.diagnostics])
    return case


class _Resolver:
    """Names the objects of a case: own physics, and materials and shapes that stand where a name is expected."""

    def __init__(self, case: Case) -> None:
        self.case = case
        self.own: dict[str, dict[str, Any]] = {kind: {} for kind in KINDS}
        self.names: dict[int, str] = {}
        self.amplitudes: dict[str, Any] = {}
        self.materials: dict[str, Any] = {}
        self.surfaces: list[dict[str, Any]] = []

    def resolve(self) -> dict[str, Any]:
        """The case as plain data."""
        values: dict[str, Any] = dump(self.case, self.leaf)
        if self.materials:
            values["material"] = {**values.get("material", {}), **self.materials}
        if self.amplitudes:
            values["amplitude"] = {**values.get("amplitude", {}), **self.amplitudes}
        if self.surfaces:
            values["surface"] = [*values.get("surface", []), *self.surfaces]
        return values

    def leaf(self, value: Any, key: str, table: Table | None) -> Any:
        """What stands for an object."""
        if isinstance(value, MaterialTable):
            return self.material(value, lambda: dump(value, self.leaf))
        if isinstance(value, OwnMaterial) and key != "own":
            return self.material(value, lambda: dump(k.Material(value.as_table()), self.leaf))
        if key == "primary":
            return self.surface(value)
        if isinstance(value, Physics):
            name = self.name(value.kind, value, key, table)
            return name if key == "own" else {"own": name}
        if callable(value):
            name = self.name("course", value, key, table)
            if key == "own":
                return name
            self.amplitudes[name] = {"own": name}
            return name if key == "amplitude" else {"amplitude": name}
        raise TypeError(f"`{key}` of {type(table).__name__} cannot be written to a case: {type(value).__name__}")

    def name(self, kind: str, value: Any, key: str, table: Table | None) -> str:
        """The name of an object; one object has one name."""
        if id(value) not in self.names:
            owner = None if table is None else table._values.get("name")
            base = owner if isinstance(owner, str) else kind
            taken = [*self.own[kind], *(self.case.amplitudes if kind == "course" else ())]
            self.names[id(value)] = Case._free_name(base, taken)
        name = self.names[id(value)]
        self.own[kind][name] = value
        return name

    def material(self, value: Any, table: Callable[[], Any]) -> str:
        for name, known in self.case.materials.items():
            if known is value or known._values.get("own") is value:
                return name
        if id(value) not in self.names:
            base = getattr(value, "_model", "") or "material"
            self.names[id(value)] = Case._free_name(base, [*self.case.materials, *self.materials])
            self.materials[self.names[id(value)]] = table()
        return self.names[id(value)]

    def surface(self, value: Any) -> str:
        if id(value) not in self.names:
            taken = [*self.case.surfaces.names(), *(one["name"] for one in self.surfaces)]
            name = self.names[id(value)] = Case._free_name("surface", taken)
            if isinstance(value, Physics):
                self.own[value.kind][name] = value
                self.surfaces.append({"name": name, "shape": {"own": name}})
            else:
                self.surfaces.append(dump(k.Surface(name=name, shape=value), self.leaf))
        return self.names[id(value)]


def _parse(text: str) -> dict[str, Any]:
    from . import _native

    return _native.parse(text)


def _toml(value: Any) -> str:
    from . import _native

    return _native.write({"x": plain(value)}).partition("=")[2].strip()


def _override(case: Case, path: str, value: Any) -> None:
    """Sets the key at a path that the loader has accepted."""
    segments: list[str] = []
    nested: Any = _parse(f"{path} = 0")
    while isinstance(nested, dict):
        (segment, nested), *_ = cast("dict[str, Any]", nested).items()
        segments.append(segment)
    place: Any = case
    for segment in segments[:-1]:
        if isinstance(place, TableList):
            tables = cast("TableList[Any]", place)
            place = tables[segment] if segment in tables else tables[int(segment)]
        elif isinstance(place, TableDict):
            place = cast("TableDict[Any]", place)[segment]
        else:
            place = place._find(segment).read(place)
    place[segments[-1]] = value


ORDER = ("format", "title", "units", "allow", "mesh", "model", "sets", "reference", "amplitude", "material", "body")


def _in_order(values: Mapping[str, Any]) -> dict[str, Any]:
    """Keys in the order in which a case is read best."""
    first = {key: values[key] for key in ORDER if key in values}
    last = ("solver", "output", "checkpoint", "expect")
    rest = {key: value for key, value in values.items() if key not in first and key not in last}
    return {**first, **rest, **{key: values[key] for key in last if key in values}}


def _move_paths(values: dict[str, Any], old: str, new: str) -> None:
    """Paths of triangulated surfaces and of results of other models relative to another folder."""
    for step in values.get("step", []):
        for motion in step.get("move", []):
            source = motion.get("from", {})
            if isinstance(source.get("file"), str):
                source["file"] = _relative(os.path.join(old, source["file"]), new).replace(os.sep, "/")
    for surface in values.get("surface", []):
        shape = surface.get("shape", {})
        if isinstance(shape.get("stl"), str):
            shape["stl"] = _relative(os.path.join(old, shape["stl"]), new).replace(os.sep, "/")


def _relative(path: str, folder: str) -> str:
    """A path relative to a folder; as it is on another drive."""
    try:
        return os.path.relpath(path, folder)
    except ValueError:
        return path


def _list(value: Any) -> list[str]:
    return [] if value is None else [value] if isinstance(value, str) else list(value)


def _described(table: Table) -> str:
    skipped = ("name", "on", "secondary", "primary", "model")
    given: Iterator[tuple[str, Any]] = (
        (key, value) for key, value in table.to_dict_raw().items() if key not in skipped
    )
    return ", ".join(f"{key} {value}" for key, value in given)
