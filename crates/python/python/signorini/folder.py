"""Reading a folder of results back, without VTK."""

from __future__ import annotations

import builtins
import json
import os
import xml.etree.ElementTree as xml
from collections.abc import Iterator, Mapping, Sequence
from functools import cached_property
from typing import TYPE_CHECKING, Any, overload

import numpy as np
from numpy.typing import NDArray

from ._elements import BY_VTK, VTK_ORDERS
from .errors import InputError
from .result import Frame, Result

if TYPE_CHECKING:
    from .history import History
    from .mesh import Mesh

Array = NDArray[Any]


def open(folder: str | os.PathLike[str]) -> Result:
    """Opens a folder of results, as `Case.run` and `signorini run` write it. Frames are read when they are asked for.

    Works while a run goes on, and after one that was killed.
    """
    folder = os.path.abspath(folder)
    collection = os.path.join(folder, "results.pvd")
    if not os.path.isfile(collection):
        there = "has no results.pvd: the case may not write vtu" if os.path.isdir(folder) else "is not a folder"
        raise InputError(f"{folder} {there}")
    summary = _json(os.path.join(folder, "summary.json"))
    result = Result(
        status=str(summary.get("status", "running")),
        exit_code=int(summary.get("exit_code", 0)),
        diagnostics=_diagnostics(folder),
        summary=summary,
        history=_text(os.path.join(folder, "history.csv")),
        convergence=_text(os.path.join(folder, "convergence.csv")),
        folder=folder,
    )
    files = _files(collection)
    contacts = dict(_files(os.path.join(folder, "contact.pvd")))
    if files:
        reader = _Reader(folder, result.history, _space(folder))
        paths = [(time, path, contacts.get(time)) for time, path in files]
        result._frames = _Frames(reader, paths)
        result.mesh = _mesh(reader.vtu(files[0][1]))
        reader.mesh = result.mesh
    return result


def _text(path: str) -> str:
    try:
        with builtins.open(path, encoding="utf-8") as file:
            return file.read()
    except FileNotFoundError:
        return ""


def _json(path: str) -> dict[str, Any]:
    text = _text(path)
    return json.loads(text) if text else {}


def _diagnostics(folder: str) -> list[dict[str, Any]]:
    """Warnings and errors in their order, with their severity and place."""
    events = _text(os.path.join(folder, "events.jsonl")).splitlines()
    # the last line may be in the middle of being written, and a resumed run repeats what it finds before its first step
    lines = dict.fromkeys(line for line in events if '"ev":"diagnostic"' in line and line.endswith("}"))
    return [{key: value for key, value in json.loads(line).items() if key not in ("v", "ev")} for line in lines]


def _files(path: str) -> list[tuple[float, str]]:
    """Times and paths of a collection."""
    if not os.path.isfile(path):
        return []
    found = xml.parse(path).getroot().iter("DataSet")
    return [(float(one.get("timestep", "0")), one.get("file", "")) for one in found]


def _space(folder: str) -> str:
    text = _text(os.path.join(folder, "case.resolved.toml"))
    if not text:
        return "3d"
    from . import _native

    return str(_native.parse(text).get("model", {}).get("space", "3d"))


def _mesh(vtu: dict[str, Any]) -> Mesh:
    """The cells of a file, in blocks of one type."""
    from .mesh import Mesh

    types, offsets, connectivity = (np.asarray(vtu[name]) for name in ("types", "offsets", "connectivity"))
    cuts = np.flatnonzero(np.diff(types)) + 1
    blocks: list[tuple[str, Array]] = []
    labels: list[Array] = []
    numbers = np.asarray(vtu["cell_data"].get("element_id", np.arange(1, len(types) + 1)))
    for start, end in zip([0, *cuts], [*cuts, len(types)], strict=True):
        if start == end:
            continue
        kind = int(types[start])
        found = BY_VTK[kind]
        cells = np.reshape(connectivity[offsets[start] : offsets[end]], (-1, found.nnode))
        order = VTK_ORDERS.get(kind)
        blocks.append((found.name, cells if order is None else np.ascontiguousarray(cells[:, order])))
        labels.append(numbers[start:end])
    nodes = vtu["point_data"].get("node_id")
    return Mesh(vtu["points"], blocks, node_labels=nodes, cell_labels=labels)


class _Reader:
    """What the frames of a folder share."""

    def __init__(self, folder: str, history: History, space: str) -> None:
        self.folder = folder
        self.history = history
        self.space = space
        self.mesh: Mesh | None = None
        self.names = [column[: -len(".gap_min")] for column in history if column.endswith(".gap_min")]

    def vtu(self, path: str) -> dict[str, Any]:
        """The arrays of a file."""
        from . import _native

        return _native.read_vtu(os.path.join(self.folder, path))

    def row(self, time: float) -> int | None:
        """The row of the history at a time."""
        if "time" not in self.history:
            return None
        times = self.history["time"]
        found = np.flatnonzero(np.abs(times - time) <= 1e-12 * max(1.0, abs(time)))
        return int(found[-1]) if len(found) else None

    @cached_property
    def places(self) -> dict[int, int]:
        """Indices of nodes by their numbers."""
        assert self.mesh is not None
        return {int(label): index for index, label in enumerate(self.mesh.node_labels)}


class _Frames(Sequence[Frame]):
    """Frames that are read when they are asked for."""

    def __init__(self, reader: _Reader, paths: list[tuple[float, str, str | None]]) -> None:
        self._reader = reader
        self._paths = paths

    @overload
    def __getitem__(self, index: int) -> Frame: ...
    @overload
    def __getitem__(self, index: slice) -> list[Frame]: ...  # pyright: ignore[reportIncompatibleMethodOverride]
    def __getitem__(self, index: int | slice) -> Frame | list[Frame]:
        if isinstance(index, slice):
            return [self[k] for k in range(*index.indices(len(self)))]
        assert self._reader.mesh is not None
        return Frame(_FileFrame(self._reader, *self._paths[index]), self._reader.mesh, self._reader.space)

    def __len__(self) -> int:
        return len(self._paths)

    def __iter__(self) -> Iterator[Frame]:
        return (self[k] for k in range(len(self)))


class _FileFrame:
    """A frame of a file, with the interface of one in memory."""

    def __init__(self, reader: _Reader, time: float, path: str, contact: str | None) -> None:
        self.time = time
        self._reader = reader
        self._path = path
        self._contact = contact
        row = reader.row(time)
        self._row = row
        self.step = "" if row is None else str(reader.history["step"][row])
        self.increment = 0 if row is None else int(reader.history["increment"][row])

    @cached_property
    def _vtu(self) -> dict[str, Any]:
        return self._reader.vtu(self._path)

    def names(self) -> list[str]:
        return list(self._vtu["point_data"])

    def field(self, name: str) -> Array:
        return self._vtu["point_data"][name]

    def cell_names(self) -> list[str]:
        return list(self._vtu["cell_data"])

    def cell_field(self, name: str) -> Array:
        return self._vtu["cell_data"][name]

    @cached_property
    def contacts(self) -> list[Any]:
        if self._contact is None:
            return []
        vtu = self._reader.vtu(self._contact)
        pairs = np.asarray(vtu["point_data"]["contact_pair"])
        names = self._reader.names or [f"{k}" for k in range(int(pairs.max(initial=-1)) + 1)]
        return [_FileContact(self._reader, name, vtu, pairs == k, self._row) for k, name in enumerate(names)]


ARRAYS = {
    "displacement": "displacement",
    "gap": "contact_gap",
    "pressure": "contact_pressure",
    "pressure_max": "contact_pressure_max",
    "multiplier": "contact_multiplier",
    "multiplier_traction": "contact_multiplier_traction",
    "traction": "contact_traction",
    "slip": "contact_slip",
    "status": "contact_status",
    "area": "contact_area",
    "nodal_force": "contact_force",
}
# what only some contacts have
SPECIAL = {
    "damage": "contact_damage",
    "heat_flux": "contact_heat_flux",
    "conductance": "contact_conductance",
    "friction_heat": "contact_friction_heat",
}
NUMBERS = {"peak": "pressure_max"} | {
    name: name for name in ("gap_min", "slip_max", "area_open", "area_stick", "area_slip", "work_friction")
}
VECTORS = ("force", "moment", "center")


class _FileContact:
    """A contact of a file: arrays from the frame, resultants from the history."""

    def __init__(self, reader: _Reader, name: str, vtu: Mapping[str, Any], mask: Array, row: int | None) -> None:
        self.name = name
        self._reader = reader
        self._vtu = vtu
        self._mask = mask
        self._row = row

    def _array(self, name: str) -> Array:
        array = np.asarray(self._vtu["point_data"][name])[self._mask]
        array.flags.writeable = False
        return array

    def _number(self, column: str) -> float:
        return 0.0 if self._row is None else float(self._reader.history[f"{self.name}.{column}"][self._row])

    def __getattr__(self, name: str) -> Any:
        if name in SPECIAL:
            return self._array(SPECIAL[name]) if SPECIAL[name] in self._vtu["point_data"] else np.zeros(0)
        if name in ("work_damage", "work_viscous", "heat", "heat_friction"):
            return self._number(name) if f"{self.name}.{name}" in self._reader.history else 0.0
        if name in ARRAYS:
            return self._array(ARRAYS[name])
        if name in NUMBERS:
            return self._number(NUMBERS[name])
        if name in VECTORS:
            return np.array([self._number(f"{name}_{axis}") for axis in "xyz"])
        raise AttributeError(f"{name!r} of a contact is not in files of results")

    @property
    def nodes(self) -> Array:
        places = self._reader.places
        return np.array([places[int(label)] for label in self._array("node_id")], dtype=np.int64)

    @property
    def points(self) -> Array:
        return np.asarray(self._vtu["points"])[self._mask] + self._array("displacement")

    @property
    def facets(self) -> list[tuple[str, Array]]:
        place = np.cumsum(self._mask) - 1
        types, offsets, connectivity = (np.asarray(self._vtu[name]) for name in ("types", "offsets", "connectivity"))
        out: dict[str, list[Array]] = {}
        for kind, start, end in zip(types, offsets[:-1], offsets[1:], strict=True):
            nodes = connectivity[start:end]
            if int(kind) in BY_VTK and self._mask[nodes].all():
                out.setdefault(BY_VTK[int(kind)].name, []).append(place[nodes])
        return [(name, np.array(rows)) for name, rows in out.items()]
