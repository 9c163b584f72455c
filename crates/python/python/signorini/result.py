"""Results: frames over time, the history, and what a run ended with. From memory or from a folder."""

from __future__ import annotations

import json
import os
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any, TypeAlias, overload

import numpy as np
from numpy.typing import NDArray

from . import _html, errors
from ._elements import ELEMENTS
from ._optional import need
from ._optional import off_screen as without_window
from ._table import did_you_mean
from .history import History

if TYPE_CHECKING:
    from .case import Case
    from .mesh import Mesh

Array: TypeAlias = NDArray[Any]
Floats: TypeAlias = NDArray[np.float64]

CLOSED = 0
"""Statuses above are closed: 1 stick, 2 slip, 3 tied."""

PLOTTED = ("gap", "pressure", "pressure_max", "traction", "slip", "status", "area", "nodal_force")
"""Arrays of a contact that a data set of PyVista has."""


class ContactFrame:
    """One contact at one time. Arrays are over the nodes of its secondary side.

    Everything is in the units of the case; vectors are global.
    """

    def __init__(self, source: Any, space: str = "3d") -> None:
        self._source = source
        self._space = space

    @property
    def name(self) -> str:
        """The name of the contact."""
        return str(self._source.name)

    @property
    def nodes(self) -> Array:
        """Indices of its nodes in the mesh, from 0."""
        return self._source.nodes

    @property
    def points(self) -> Floats:
        """Present positions `(n, 3)` (length)."""
        return self._source.points

    @property
    def displacement(self) -> Floats:
        """Displacements `(n, 3)` (length)."""
        return self._source.displacement

    @property
    def normal(self) -> Floats:
        """Unit normals `(n, 3)` out of the primary side. Not in files."""
        return self._source.normal

    @property
    def gap(self) -> Floats:
        """Gaps `(n,)` (length): positive open, negative penetration, NaN where nothing is within reach."""
        return self._source.gap

    @property
    def pressure(self) -> Floats:
        """Pressures `(n,)` (stress), at least 0; forces where the secondary side has no area."""
        return self._source.pressure

    @property
    def pressure_max(self) -> Floats:
        """The largest pressure of the points around each node `(n,)` (stress)."""
        return self._source.pressure_max

    @property
    def multiplier(self) -> Floats:
        """Pressures in the equations, never smoothed `(n,)` (stress)."""
        return self._source.multiplier

    @property
    def traction(self) -> Floats:
        """Tractions on the secondary side `(n, 3)` (stress)."""
        return self._source.traction

    @property
    def slip(self) -> Floats:
        """Accumulated slip `(n, 3)` (length)."""
        return self._source.slip

    @property
    def status(self) -> Array:
        """0 open, 1 stick, 2 slip, 3 tied, -1 nothing within reach `(n,)`."""
        return self._source.status

    @property
    def area(self) -> Floats:
        """Tributary areas `(n,)`; of the full circumference in bodies of revolution."""
        return self._source.area

    @property
    def damage(self) -> Floats:
        """Damage of a joint that may break, from 0 to 1 `(n,)`; empty where no joint may."""
        return self._source.damage

    @property
    def heat_flux(self) -> Floats:
        """Heat per time and area to the primary side, without that of friction `(n,)`; empty where no step finds temperatures."""
        return self._source.heat_flux

    @property
    def conductance(self) -> Floats:
        """Heat per time, area and temperature across the contact `(n,)`; empty where no step finds temperatures."""
        return self._source.conductance

    @property
    def friction_heat(self) -> Floats:
        """Heat of friction per time and area `(n,)`; empty where no step finds temperatures."""
        return self._source.friction_heat

    @property
    def nodal_force(self) -> Floats:
        """Contact forces at the nodes `(n, 3)` (force); their sum is `force`."""
        return self._source.nodal_force

    @property
    def facets(self) -> list[tuple[str, Array]]:
        """Element types and indices `(m, k)` into the nodes here; empty where the side is bare nodes."""
        return self._source.facets

    @property
    def force(self) -> Floats:
        """What the primary side exerts on the secondary side `(3,)` (force)."""
        return self._source.force

    @property
    def moment(self) -> Floats:
        """Its moment about the origin `(3,)` (force · length)."""
        return self._source.moment

    @property
    def center(self) -> Floats:
        """The centre of pressure `(3,)` (length)."""
        return self._source.center

    @property
    def area_open(self) -> float:
        """Open area."""
        return float(self._source.area_open)

    @property
    def area_stick(self) -> float:
        """Sticking area."""
        return float(self._source.area_stick)

    @property
    def area_slip(self) -> float:
        """Slipping area; without friction all that is closed."""
        return float(self._source.area_slip)

    @property
    def gap_min(self) -> float:
        """The smallest gap (length)."""
        return float(self._source.gap_min)

    @property
    def slip_max(self) -> float:
        """The largest accumulated slip (length)."""
        return float(self._source.slip_max)

    @property
    def peak(self) -> float:
        """The largest pressure of any point (stress): `pressure_max` of the history."""
        return float(self._source.peak)

    @property
    def work_friction(self) -> float:
        """Work spent in friction since the start (energy)."""
        return float(self._source.work_friction)

    @property
    def work_damage(self) -> float:
        """Energy that damage of the joint has taken since the start (energy)."""
        return float(self._source.work_damage)

    @property
    def work_viscous(self) -> float:
        """Work spent since the start by the viscosity that delays damage (energy)."""
        return float(self._source.work_viscous)

    @property
    def heat(self) -> float:
        """Heat per time from the secondary side to the primary, without that of friction."""
        return float(self._source.heat)

    @property
    def heat_friction(self) -> float:
        """Heat per time that friction sets free."""
        return float(self._source.heat_friction)

    @property
    def closed(self) -> NDArray[np.bool_]:
        """Which nodes are closed `(n,)`."""
        return self.status > CLOSED

    @property
    def radius(self) -> float:
        """The radius of the closed area (length), or its half-width in plane models; 0 where nothing is closed.

        √2 times the radius of gyration of the closed area about the point of largest pressure; √3 times in the plane.
        Exact for a disc and for any sector of one about its apex, so for half and quarter models too. The point is the
        vertex of the paraboloid that is closest to the squared pressures, exact for Hertz; where they have none, the
        node of largest pressure. In bodies of revolution it is on the axis.
        """
        closed = self.closed
        area = self.area[closed]
        total = float(area.sum())
        if not total > 0.0:
            return 0.0
        points = self.points[closed]
        factor = 3.0 if self._space.startswith("plane") else 2.0
        if self._space == "axisymmetric":
            distance = points[:, 0] ** 2
        else:
            center = apex(points, self.pressure[closed], 1 if factor == 3.0 else 2)
            distance = ((points - center) ** 2).sum(axis=1)
        return float(np.sqrt(factor * (area @ distance) / total))

    def to_pyvista(self, warp: float = 1.0) -> Any:
        """The secondary side as a data set of PyVista, moved by `warp` times its displacements."""
        pv = need("pyvista", "ContactFrame.to_pyvista")
        points = self.points + (warp - 1.0) * self.displacement
        from .mesh import Mesh

        if self.facets:
            grid = Mesh(points, self.facets).to_pyvista()
        else:
            grid = pv.PolyData(np.array(points))
        for name in PLOTTED:
            grid.point_data[f"contact_{name}"] = np.asarray(getattr(self, name))
        return grid

    def plotter(
        self,
        name: str = "pressure",
        warp: float = 1.0,
        *,
        component: int | None = None,
        off_screen: bool | None = None,
        **options: Any,
    ) -> Any:
        """A plotter of PyVista with a quantity on the secondary side alone, which no body hides."""
        need("pyvista", "ContactFrame.plot")
        name = name.removeprefix("contact_")
        if name not in PLOTTED:
            raise KeyError(f"a contact has no {name!r} to plot{did_you_mean(name, PLOTTED)}")
        is_flat = self._space != "3d"
        width = {"line_width": 6, "show_edges": False} if is_flat else {}
        scalars = f"contact_{name}"
        return plotter_of(
            self.to_pyvista(warp=warp), scalars, component, self.name, is_flat, off_screen, {**width, **options}
        )

    def plot(self, name: str = "pressure", warp: float = 1.0, *, component: int | None = None, **options: Any) -> Any:
        """Shows a quantity on the secondary side, deformed `warp` times; further options are those of `add_mesh`.

        `name`: gap, pressure, pressure_max, traction, slip, status, area or nodal_force.
        """
        return self.plotter(name, warp, component=component, **options).show()

    show = plot

    def screenshot(
        self,
        path: str | os.PathLike[str],
        name: str = "pressure",
        warp: float = 1.0,
        *,
        component: int | None = None,
        **options: Any,
    ) -> str:
        """Writes a picture of a quantity on the secondary side and returns its path; see `plot`."""
        return picture_of(self.plotter(name, warp, component=component, off_screen=True, **options), path)

    def __repr__(self) -> str:
        force = ", ".join(f"{x:.6g}" for x in self.force)
        return f"<contact {self.name}: force ({force}), peak {self.peak:.6g}, {int(self.closed.sum())} of {len(self.nodes)} closed>"


def plotter_of(
    grid: Any,
    name: str,
    component: int | None,
    title: str,
    is_flat: bool,
    off_screen: bool | None,
    options: Mapping[str, Any],
) -> Any:
    """A plotter of PyVista with an array of a data set, or one of its components."""
    pv = need("pyvista", "plot")
    plotter = pv.Plotter(off_screen=without_window() if off_screen is None else off_screen)
    if component is not None:
        data = grid.point_data if name in grid.point_data else grid.cell_data
        data[f"{name}[{component}]"] = np.array(data[name][:, component])
        name = f"{name}[{component}]"
    # an even number of labels leaves the middle of the bar to its title
    bar = {"n_labels": 4}
    plotter.add_mesh(grid, **{"scalars": name, "show_edges": True, "scalar_bar_args": bar, **options})
    plotter.add_text(title, font_size=9)
    if is_flat:
        plotter.view_xy()
    return plotter


def picture_of(plotter: Any, path: str | os.PathLike[str]) -> str:
    """Writes what a plotter shows, closes it and returns the path."""
    plotter.screenshot(os.fspath(path))
    plotter.close()
    return os.fspath(path)


def apex(points: Floats, pressure: Floats, dim: int) -> Floats:
    """Where pressures at points of a surface of this dimension are largest.

    The vertex of the paraboloid closest to the squared pressures, in the plane closest to the points. Where that is no
    maximum, or lies away from the points, the point of largest pressure.
    """
    peak = points[int(np.argmax(pressure))]
    if len(points) < dim + 3:
        return peak
    middle = points.mean(axis=0)
    _, sizes, axes = np.linalg.svd(points - middle, full_matrices=False)
    if not sizes[dim - 1] > 1e-9 * sizes[0]:
        return peak
    flat: Floats = np.asarray((points - middle) @ np.transpose(axes[:dim]))
    columns = np.column_stack([np.ones(len(flat)), flat, (flat**2).sum(axis=1)])
    fit = np.linalg.lstsq(columns, pressure**2, rcond=None)[0]
    if not fit[-1] < 0.0:
        return peak
    vertex = -0.5 * fit[1:-1] / fit[-1]
    near = np.sort(((flat - vertex) ** 2).sum(axis=1))
    spacing = (np.ptp(flat, axis=0) ** 2).sum() / len(points) ** (2.0 / dim)
    return middle + vertex @ axes[:dim] if near[0] <= 4.0 * spacing else peak


class _Contacts(Mapping[str, ContactFrame]):
    """Contacts by name, or by index."""

    def __init__(self, sources: Sequence[Any], space: str) -> None:
        self._all = {source.name: ContactFrame(source, space) for source in sources}

    def __getitem__(self, name: str | int) -> ContactFrame:
        if isinstance(name, int):
            return list(self._all.values())[name]
        if name not in self._all:
            raise KeyError(f"no contact is called {name!r}{did_you_mean(name, self._all)}")
        return self._all[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._all)

    def __len__(self) -> int:
        return len(self._all)

    def __repr__(self) -> str:
        return f"<contacts {', '.join(self._all)}>"


class Frame:
    """The results at one time. `frame["displacement"]` is a read-only array over the nodes.

    Fields at nodes: displacement, reaction_force, contact_force, contact_pressure, stress and strain (xx yy zz xy yz
    xz), von_mises, principal_stress, plastic_strain, temperature; `names` lists those that there are.
    """

    def __init__(self, source: Any, mesh: Mesh, space: str = "3d") -> None:
        self._source = source
        self._mesh = mesh
        self._space = space

    @property
    def time(self) -> float:
        """Total time."""
        return float(self._source.time)

    @property
    def step(self) -> str:
        """The name of the step."""
        return str(self._source.step)

    @property
    def increment(self) -> int:
        """The number of the increment in its step, from 1; 0 for the undeformed state."""
        return int(self._source.increment)

    @property
    def mesh(self) -> Mesh:
        """The mesh."""
        return self._mesh

    @property
    def points(self) -> Floats:
        """Coordinates at the start `(n, 3)` (length); add the displacements for the present ones."""
        return self._mesh.points

    @property
    def names(self) -> list[str]:
        """The fields at nodes."""
        return list(self._source.names())

    @property
    def cell_names(self) -> list[str]:
        """The fields of cells."""
        return list(self._source.cell_names())

    def __getitem__(self, name: str) -> Floats:
        """A field at the nodes."""
        if name not in self.names:
            raise KeyError(f"no field is called {name!r}{did_you_mean(name, self.names)}")
        return self._source.field(name)

    def __contains__(self, name: object) -> bool:
        return name in self.names

    def __iter__(self) -> Iterator[str]:
        return iter(self.names)

    def cell(self, name: str) -> Floats:
        """A field of the cells of the highest dimension, block by block: means over their volumes."""
        if name not in self.cell_names:
            raise KeyError(f"no field of cells is called {name!r}{did_you_mean(name, self.cell_names)}")
        return self._source.cell_field(name)

    @property
    def contact(self) -> Mapping[str, ContactFrame]:
        """The contacts by name: `frame.contact["foot"].pressure`."""
        return _Contacts(self._source.contacts, self._space)

    def to_pyvista(self, warp: float = 0.0) -> Any:
        """An unstructured grid of PyVista with all fields, moved by `warp` times the displacements."""
        need("pyvista", "Frame.to_pyvista")
        grid = self._mesh.to_pyvista()
        for name in self.names:
            grid.point_data[name] = np.array(self[name])
        for name in self.cell_names:
            grid.cell_data[name] = np.array(self.cell(name))
        grid.field_data["TimeValue"] = np.array([self.time])
        if warp:
            grid.points = grid.points + warp * self["displacement"]
        return grid

    def to_meshio(self, warp: float = 0.0) -> Any:
        """A mesh of meshio with all fields at nodes and in cells."""
        meshio = need("meshio", "Frame.to_meshio")
        from .mesh import to_vtk

        blocks = self._mesh.solids()
        bounds = np.cumsum([0, *(len(block) for _, block in blocks)])
        cells = [(ELEMENTS[name].meshio, to_vtk(name, block).astype(np.int64)) for name, block in blocks]
        points = self.points + warp * self["displacement"]
        parts = {
            name: [np.array(self.cell(name)[a:b]) for a, b in zip(bounds[:-1], bounds[1:], strict=True)]
            for name in self.cell_names
        }
        return meshio.Mesh(
            points, cells, point_data={name: np.array(self[name]) for name in self.names}, cell_data=parts
        )

    def shown(self, name: str) -> Floats:
        """A field at nodes, or else in cells. Raises `KeyError` with the closest name where there is none."""
        known = [*self.names, *self.cell_names]
        if name not in known:
            raise KeyError(f"no field is called {name!r}{did_you_mean(name, known)}")
        return self[name] if name in self else self.cell(name)

    def plotter(
        self,
        name: str = "von_mises",
        warp: float = 0.0,
        *,
        component: int | None = None,
        off_screen: bool | None = None,
        **options: Any,
    ) -> Any:
        """A plotter of PyVista with a field on the deformed mesh; without a window where there is no display."""
        need("pyvista", "Frame.plot")
        self.shown(name)
        title = f"{self.step}  t = {self.time:g}"
        grid = self.to_pyvista(warp=warp)
        return plotter_of(grid, name, component, title, self._mesh.dim == 2, off_screen, options)

    def plot(self, name: str = "von_mises", warp: float = 0.0, *, component: int | None = None, **options: Any) -> Any:
        """Shows a field on the mesh, deformed `warp` times; further options are those of PyVista's `add_mesh`."""
        return self.plotter(name, warp, component=component, **options).show()

    show = plot

    def screenshot(
        self,
        path: str | os.PathLike[str],
        name: str = "von_mises",
        warp: float = 0.0,
        *,
        component: int | None = None,
        **options: Any,
    ) -> str:
        """Writes a picture of a field and returns its path."""
        return picture_of(self.plotter(name, warp, component=component, off_screen=True, **options), path)

    def __repr__(self) -> str:
        place = f"{self.step}, increment {self.increment}, " if self.step else ""
        return f"<Frame: {place}time {self.time:g}, {len(self.points)} nodes>"


class Increment:
    """A converged increment, as `on_increment` receives it."""

    def __init__(self, frame: Frame, record: Mapping[str, Any]) -> None:
        self.frame = frame
        self.record = dict(record)

    @property
    def step(self) -> str:
        """The name of the step."""
        return self.frame.step

    @property
    def time(self) -> float:
        """Total time."""
        return self.frame.time

    @property
    def increment(self) -> int:
        """The number of the increment in its step, from 1."""
        return self.frame.increment

    @property
    def newton_iterations(self) -> int:
        """Linear solves it took."""
        return int(self.record.get("iterations", 0))

    @property
    def contact(self) -> Mapping[str, ContactFrame]:
        """The contacts by name."""
        return self.frame.contact

    def __repr__(self) -> str:
        return f"<Increment {self.increment} of {self.step}: time {self.time:g}, {self.newton_iterations} iterations>"


class ContactHistory:
    """Columns of the history that belong to a contact or a reference: `.force` is `(n_inc, 3)`."""

    def __init__(self, history: History, name: str) -> None:
        self._history = history
        self.name = name

    def _vector(self, quantity: str) -> Floats:
        return np.column_stack([self._history[f"{self.name}.{quantity}_{axis}"] for axis in "xyz"])

    @property
    def force(self) -> Floats:
        """Forces `(n_inc, 3)` on the secondary side."""
        return self._vector("force")

    @property
    def moment(self) -> Floats:
        """Moments `(n_inc, 3)` about the origin."""
        return self._vector("moment")

    @property
    def center(self) -> Floats:
        """Centres of pressure `(n_inc, 3)`."""
        return self._vector("center")

    @property
    def displacement(self) -> Floats:
        """Displacements `(n_inc, 3)` of a reference."""
        return self._vector("displacement")

    @property
    def rotation(self) -> Floats:
        """Rotations `(n_inc, 3)` of a reference (radian)."""
        return self._vector("rotation")

    @property
    def reaction_force(self) -> Floats:
        """Forces `(n_inc, 3)` of supports and prescribed motions on a reference."""
        return self._vector("reaction_force")

    @property
    def reaction_moment(self) -> Floats:
        """Moments `(n_inc, 3)` of supports and prescribed motions on a reference, about its point."""
        return self._vector("reaction_moment")

    @property
    def quantities(self) -> list[str]:
        """The columns there are: pressure_max, gap_min, slip_max, area_open, area_stick, area_slip, …"""
        start = f"{self.name}."
        return [column[len(start) :] for column in self._history if column.startswith(start)]

    def __getitem__(self, quantity: str) -> Floats:
        """A column: `result.contact["foot"]["pressure_max"]`."""
        return self._history[f"{self.name}.{quantity}"]

    def __getattr__(self, name: str) -> Floats:
        column = f"{self.name}.{name}"
        if name.startswith("_") or column not in self._history:
            raise AttributeError(
                f"{self.name} has no {name!r}{did_you_mean(name, [] if name.startswith('_') else self.quantities)}"
            )
        return self._history[column]

    def __repr__(self) -> str:
        return f"<history of {self.name}: {', '.join(self.quantities)}>"


class _Histories(Mapping[str, ContactHistory]):
    """Contacts or references by name."""

    def __init__(self, history: History, mark: str) -> None:
        ends = f".{mark}"
        self._all = {c[: -len(ends)]: ContactHistory(history, c[: -len(ends)]) for c in history if c.endswith(ends)}

    def __getitem__(self, name: str) -> ContactHistory:
        if name not in self._all:
            raise KeyError(f"nothing is called {name!r} in the history{did_you_mean(name, self._all)}")
        return self._all[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._all)

    def __len__(self) -> int:
        return len(self._all)

    def __repr__(self) -> str:
        return f"<histories of {', '.join(self._all)}>"


class Result(Sequence[Frame]):
    """What a run computed: a sequence of frames, the undeformed one first, with the history of all increments.

    `result[-1]["displacement"]`, `result.history["floor.force_x"]`, `result.contact["floor"].force`.
    """

    def __init__(
        self,
        frames: Sequence[Frame] = (),
        *,
        status: str = "failed",
        exit_code: int = 70,
        diagnostics: Sequence[Mapping[str, Any]] = (),
        summary: str | Mapping[str, Any] = "",
        history: str = "",
        convergence: str = "",
        worst_nodes: Sequence[int] = (),
        folder: str | None = None,
        mesh: Mesh | None = None,
        error: BaseException | None = None,
    ) -> None:
        self._frames = frames
        self.status = status
        self.exit_code = exit_code
        self.diagnostics = [errors.Diagnostic(one) for one in diagnostics]
        self.summary: dict[str, Any] = json.loads(summary or "{}") if isinstance(summary, str) else dict(summary)
        self.history = History(history)
        self.convergence = History(convergence)
        self.worst_nodes = list(worst_nodes)
        self.folder = folder
        self.mesh = mesh
        self.error = error

    @classmethod
    def failed(cls, error: BaseException) -> Result:
        """What stands for a run that failed: its converged frames, if any, and the error."""
        found = getattr(error, "_result", None)
        out = found if isinstance(found, Result) else cls(diagnostics=getattr(error, "diagnostics", ()))
        out.exit_code = getattr(error, "exit_code", out.exit_code)
        out.error = error
        return out

    @property
    def ok(self) -> bool:
        """Whether the case was solved and all its expectations are met: exit code 0."""
        return self.exit_code == 0 and self.error is None

    @property
    def expectations(self) -> list[dict[str, Any]]:
        """The `[[expect]]` of the case: what, value, got, ok."""
        return list(self.summary.get("expectations", ()))

    @property
    def contact(self) -> Mapping[str, ContactHistory]:
        """Contacts over time, by name: `result.contact["floor"].force` is `(n_inc, 3)`."""
        return _Histories(self.history, "gap_min")

    @property
    def reference(self) -> Mapping[str, ContactHistory]:
        """References and rigid bodies over time, by name: force, moment, displacement, rotation, reaction_force, reaction_moment."""
        return _Histories(self.history, "rotation_z")

    @property
    def times(self) -> Floats:
        """Total times of the frames."""
        return np.array([frame.time for frame in self._frames])

    @overload
    def __getitem__(self, index: int) -> Frame: ...
    @overload
    def __getitem__(self, index: slice) -> list[Frame]: ...  # pyright: ignore[reportIncompatibleMethodOverride]
    def __getitem__(self, index: int | slice) -> Frame | list[Frame]:
        if isinstance(index, slice):
            return list(self._frames[index])
        if not len(self._frames):
            raise IndexError(f"there are no frames: {self.error or self.status}")
        return self._frames[index]

    def __len__(self) -> int:
        return len(self._frames)

    def __bool__(self) -> bool:
        return True

    def to_pandas(self) -> Any:
        """The history as a data frame of pandas."""
        return self.history.to_pandas()

    def to_polars(self) -> Any:
        """The history as a data frame of Polars."""
        return self.history.to_polars()

    def to_pyvista(self, warp: float = 0.0) -> Any:
        """All frames as blocks of a multi-block data set of PyVista."""
        pv = need("pyvista", "Result.to_pyvista")
        blocks = pv.MultiBlock()
        for frame in self:
            blocks.append(frame.to_pyvista(warp=warp), f"{frame.time:g}")
        return blocks

    def to_meshio(self, warp: float = 0.0) -> list[Any]:
        """All frames as meshes of meshio."""
        return [frame.to_meshio(warp=warp) for frame in self]

    def plot(self, name: str = "von_mises", warp: float = 0.0, **options: Any) -> Any:
        """Shows the last frame; see `Frame.plot`."""
        return self[-1].plot(name, warp, **options)

    show = plot

    def screenshot(
        self, path: str | os.PathLike[str], name: str = "von_mises", warp: float = 0.0, **options: Any
    ) -> str:
        """Writes a picture of the last frame; see `Frame.screenshot`."""
        return self[-1].screenshot(path, name, warp, **options)

    def animate(
        self,
        path: str | os.PathLike[str],
        name: str = "von_mises",
        warp: float = 1.0,
        *,
        component: int | None = None,
        every: int = 1,
        fps: float = 12.0,
        size: tuple[int, int] = (640, 480),
        **options: Any,
    ) -> str:
        """Writes frames as an animated picture, .gif, .webp or .png by the ending of the path, and returns the path.

        All frames, or one of `every` so many, show a field on the mesh, deformed `warp` times, from one place and with one range
        of colours. `size` is in pixels; further options are those of PyVista's `add_mesh`.

        Raises `ValueError` for another ending, and where there are no frames.
        """
        from ._animation import write

        if not len(self):
            raise ValueError(f"there are no frames: {self.error or self.status}")
        return write(path, self[::every], name, warp, component=component, fps=fps, size=size, **options)

    def report(self, path: str | os.PathLike[str], *, compare: Result | str | os.PathLike[str] | None = None) -> str:
        """Writes the report as one HTML page that works offline, and returns its path.

        The run must have been saved into a folder; `compare` is another run or its folder, whose histories are drawn
        next to these.

        Raises `ValueError` for a result that is in memory only, or a folder without results.
        """
        from . import _native

        other = compare._saved() if isinstance(compare, Result) else None if compare is None else os.fspath(compare)
        page = _native.report(self._saved(), other)
        with open(path, "wb") as file:
            file.write(page)
        return os.fspath(path)

    def _saved(self) -> str:
        """The folder of a run that was saved."""
        if self.folder is None:
            raise ValueError('this result is in memory only: save the run in a folder, as in case.run("case.out")')
        return self.folder

    def __repr__(self) -> str:
        where = f", {self.folder}" if self.folder else ""
        why = f", {type(self.error).__name__}" if self.error is not None else ""
        warnings = sum(one.severity == "warning" for one in self.diagnostics)
        found = "" if not warnings else f", {warnings} warning{'s' if warnings > 1 else ''}"
        return f"<Result: {self.status}{why}, {len(self)} frames, {self.history.nrow} increments{found}{where}>"

    def _repr_html_(self) -> str:
        from .notebook import thumbnail

        steps = self.summary.get("steps", [])
        rows: list[tuple[str, object]] = [("status", f"{self.status} (exit code {self.exit_code})")]
        rows += [
            (
                f"step {step['name']}",
                f"{step['increments']} increments, {step['iterations']} iterations, {step['cutbacks']} cut-backs",
            )
            for step in steps
        ]
        for name, one in self.summary.get("contacts", {}).items():
            force = ", ".join(f"{x:.5g}" for x in one["force"])
            rows.append(
                (
                    name,
                    f"force ({force}), largest pressure {one['pressure_max']:.5g}, smallest gap {one['gap_min']:.3g}",
                )
            )
        rows += [
            (f"expect {one['what']}", f"{one['got']} ({one['value']}) {'✓' if one['ok'] else '✗'}")
            for one in self.expectations
        ]
        rows += [(f"{one.severity} {one.code}", one.message) for one in self.diagnostics]
        rows += [("folder", self.folder)] if self.folder else []
        moved = self[-1]["displacement"] if len(self) else None
        return _html.document("Result", rows, picture=thumbnail(self.mesh, moved))


def run(
    case: Case,
    folder: str | None,
    *,
    on_increment: Callable[[Increment], object] | None = None,
    on_iteration: Callable[[dict[str, Any]], object] | None = None,
    fresh: bool = False,
    resume: bool = False,
    threads: int | None = None,
    progress: bool | None = None,
    keep: bool = True,
) -> Result:
    """Runs a case; see `Case.run`."""
    from . import _native
    from .notebook import listener

    threads = threads_of(case, threads)
    job = case.job(saved=folder is not None)
    mesh: Mesh = case.mesh
    space = str(case.model.space)
    shown = listener(case, progress)

    def heard(frame: Any, record: dict[str, Any]) -> bool:
        assert on_increment is not None
        return bool(on_increment(Increment(Frame(frame, mesh, space), record)))

    def iterated(record: dict[str, Any]) -> bool:
        assert on_iteration is not None
        return bool(on_iteration(record))

    try:
        outcome = _native.run(
            job,
            folder,
            fresh=fresh,
            resume=resume,
            threads=threads,
            keep=keep,
            on_event=None if shown is None else shown.hear,
            on_iteration=None if on_iteration is None else iterated,
            on_increment=None if on_increment is None else heard,
        )
    finally:
        if shown is not None:
            shown.close()
    result = Result(
        [Frame(one, mesh, space) for one in outcome.frames],
        status=outcome.status,
        exit_code=outcome.exit_code,
        diagnostics=outcome.diagnostics,
        summary=outcome.summary,
        history=outcome.history,
        convergence=outcome.convergence,
        worst_nodes=outcome.worst_nodes,
        folder=folder,
        mesh=mesh,
        error=outcome.error,
    )
    if folder is not None and (resume or not keep) and os.path.isfile(os.path.join(folder, "results.pvd")):
        # a resumed run has made the later frames only
        from .folder import open as folder_of_results

        result._frames = folder_of_results(folder)._frames
    if outcome.error is not None:
        raise outcome.error
    error = _failure(result)
    if error is not None:
        result.error = error
        raise error
    return result


def threads_of(case: Case, wanted: int | None) -> int | None:
    """How many threads a case runs on: as many as wanted, else as the case says; None: as the environment says."""
    if wanted is None:
        given = case.solver.threads
        return None if given == "auto" else given
    if wanted < 1:
        raise ValueError(f"a run has at least one thread, found {wanted}")
    return wanted


def _failure(result: Result) -> errors.SignoriniError | None:
    """The exception of an exit code, where it is one."""
    found = [one for one in result.diagnostics if one.severity == "error"] or result.diagnostics
    reason = found[-1].message if found else result.status
    match result.exit_code:
        case 5:
            return errors.NotConverged(result, reason, result.worst_nodes, diagnostics=found)
        case 3:
            return errors.InputError(reason, found)
        case 4:
            return errors.ModelError(reason, diagnostics=found)
        case 6:
            return errors.OutputError(reason, result, diagnostics=found)
        case 7:
            return errors.RestartError(reason, result, diagnostics=found)
        case 8:
            return errors.LimitError(reason, result, diagnostics=found)
        case 70:
            return errors.InternalError(reason, result, diagnostics=found)
        case _:
            return None
